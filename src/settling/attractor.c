/* attractor.c -- the attractors of parameter sets and what goes there; see attractor.h. */
#include <pendres/attractor.h>

#include <math.h>
#include <stdlib.h>

#include "settling/attractor_internal.h"
#include "base/numbers.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/door.h"
#include "settling/settle.h"
#include "engine/kernels/coordinates.h"
#include "model/equation.h"
#include "model/model.h"

enum { BATCH_SETS = 64 /* parameter sets worked on at a time */ };

static pendres_status check_states(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                   size_t stride, const double *x, const double *v)
{
  for (size_t i = 0; i < n; i++) {
    const char *why = NULL;
    if (pendres_pendulum_check(&p[i * stride], &why) == PENDRES_OK)
      why = pendres_coordinates_refuses(&p[i * stride], x[i], v[i]);
    if (why == NULL) why = pendres_equation_undamped(&p[i * stride]);
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "pendulum %zu: %s", i, why);
  }
  return PENDRES_OK;
}

void pendres_attractors_free(pendres_attractors *set)
{
  if (set == NULL) return;
  for (size_t i = 0; i < set->sets; i++) pendres_attractor_set_clear(&set->attractor_sets[i]);
  free(set->attractor_sets);
  free(set->units);
  free(set->attractors);
  free(set->shown);
  free(set);
}

size_t pendres_attractors_count(const pendres_attractors *set)
{
  return set != NULL ? set->count : 0;
}

const pendres_attractor *pendres_attractors_get(const pendres_attractors *set, size_t i)
{
  return set != NULL && i < set->count ? set->attractors[i] : NULL;
}

size_t pendres_attractors_count_of(const pendres_attractors *set, size_t i)
{
  return set != NULL && i < set->sets ? set->attractor_sets[i].count : 0;
}

static pendres_attractors *create_sets(size_t sets)
{
  pendres_attractors *set = calloc(1, sizeof *set);
  if (set == NULL) return NULL;
  set->attractor_sets = calloc(sets + 1, sizeof *set->attractor_sets);
  set->units = malloc((sets + 1) * sizeof *set->units);
  if (set->attractor_sets == NULL || set->units == NULL) {
    pendres_attractors_free(set);
    return NULL;
  }
  set->sets = sets;
  for (size_t i = 0; i < sets; i++) set->units[i] = (pendres_units){1.0, 1.0};
  return set;
}

/* Make the list of all attractors, after all of them have been found, as their caller sees them. */
static int index_sets(pendres_attractors *set)
{
  size_t count = 0;
  int others = 0;
  for (size_t i = 0; i < set->sets; i++) {
    count += set->attractor_sets[i].count;
    others |= !pendres_units_trivial(&set->units[i]);
  }
  free(set->attractors);
  free(set->shown);
  set->attractors = malloc((count + 1) * sizeof *set->attractors);
  set->shown = others ? malloc((count + 1) * sizeof *set->shown) : NULL;
  set->count = 0;
  if (set->attractors == NULL || (others && set->shown == NULL)) return -1;
  for (size_t i = 0; i < set->sets; i++) {
    const pendres_scales scales = {set->units[i], 1.0, 1.0};
    for (size_t j = 0; j < set->attractor_sets[i].count; j++) {
      const pendres_attractor *a = &set->attractor_sets[i].attractors[j];
      if (others) {
        set->shown[set->count] = *a;
        pendres_units_out(&scales, &pendres_dim_attractor, 1, &set->shown[set->count]);
        a = &set->shown[set->count];
      }
      set->attractors[set->count++] = a;
    }
  }
  return 0;
}

pendres_door pendres_attractors_open(pendres_context *ctx, const pendres_attractors *set)
{
  const pendres_units none = {1.0, 1.0};
  return pendres_door_open_in(ctx, set != NULL && set->sets == 1 ? set->units[0] : none);
}

const pendres_attractors *pendres_attractors_inside(pendres_door *d, const pendres_attractors *set)
{
  if (set == NULL || d->status != PENDRES_OK || !pendres_door_changes(d)) return set;
  pendres_attractors *inside = pendres_door_memory(d, sizeof *inside);
  const pendres_attractor **list = pendres_door_memory(d, (set->count + 1) * sizeof *list);
  pendres_units *units = pendres_door_memory(d, sizeof *units);
  if (d->status != PENDRES_OK) return NULL;
  *units = (pendres_units){1.0, 1.0};
  *inside = *set;
  inside->units = units;
  inside->shown = NULL;
  inside->attractors = list;
  for (size_t j = 0; j < set->count; j++) list[j] = &set->attractor_sets[0].attractors[j];
  return inside;
}

static pendres_status attractors_find(pendres_door *d, const pendres_pendulum *p, size_t n,
                                      const double *x, const double *v, pendres_attractors **out)
{
  pendres_context *ctx = d->ctx;
  double default_x[PENDRES_ATTRACTOR_SET_STARTS], default_v[PENDRES_ATTRACTOR_SET_STARTS];
  if (p == NULL || out == NULL || (n > 0 && (x == NULL || v == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "pendulum, x, v and out");
  *out = NULL;
  const char *why = NULL;
  if (pendres_pendulum_check(p, &why) != PENDRES_OK)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
  if (n == 0) {
    n = pendres_attractor_set_starts(p, default_x, default_v);
    x = default_x;
    v = default_v;
  }
  pendres_status status = check_states(ctx, n, p, 0, x, v);
  if (status != PENDRES_OK) return status;

  pendres_attractors *set = create_sets(1);
  if (set == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  set->units[0] = d->scales.unit;
  set->attractor_sets[0].pendulum = *p;
  /* A caller that asks for attractors only will probably label many pendulums with them. */
  set->attractor_sets[0].effort = PENDRES_TRAPPING_MANY;
  status = pendres_attractors_extend(ctx, set, n, x, v);
  if (status == PENDRES_OK) *out = set;
  else pendres_attractors_free(set);
  return status;
}

pendres_status pendres_attractors_find(pendres_context *ctx, const pendres_pendulum *p, size_t n,
                                       const double *x, const double *v, pendres_attractors **out)
{
  pendres_door d = pendres_door_open(ctx, p);
  PENDRES_DOOR_IN(&d, pendulum, 1, p);
  PENDRES_DOOR_IN(&d, length, n, x);
  PENDRES_DOOR_IN(&d, speed, n, v);
  return PENDRES_DOOR_END(&d, attractors_find(&d, p, n, x, v, out));
}

/* What is told of pendulums by the attractors that they are on, of one set. */
static void describe(const pendres_attractor_set *c, size_t n, pendres_settled *out)
{
  for (size_t i = 0; i < n; i++) {
    pendres_settled *o = &out[i];
    o->exponent = o->exponent_error = o->rotation = o->rotation_error = NAN;
    if (o->attractor < 0) continue;
    const pendres_attractor *a = &c->attractors[o->attractor];
    o->exponent = a->lyapunov;
    o->exponent_error = a->lyapunov_error;
    o->rotation = a->drift;
    o->rotation_error = a->drift_error;
    if (!pendres_attractor_closes(a)) continue;
    o->period = a->orbit.period;
    o->winding = a->orbit.winding;
    o->rotation = (double)o->winding / o->period;
    o->rotation_error = last_place_of_one * fabs(o->rotation);
  }
}

static pendres_status attractors_settle(pendres_context *ctx, const pendres_attractors *set,
                                        size_t n, const double *x, const double *v,
                                        pendres_settled *outcome)
{
  if (set == NULL || (n > 0 && (x == NULL || v == NULL || outcome == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "attractors, x, v and outcome");
  if (set->sets != 1)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "these are attractors of several parameter sets");
  pendres_status status = check_states(ctx, n, &set->attractor_sets[0].pendulum, 0, x, v);
  if (status != PENDRES_OK || n == 0) return status;
  const pendres_settle_starts starts = {.n = n, .x = x, .v = v};
  status = pendres_settle_known(ctx, set->attractor_sets, &starts, pendres_accuracy_to_settle(ctx),
                                PENDRES_SETTLE_FULL, outcome);
  if (status == PENDRES_OK) describe(set->attractor_sets, n, outcome);
  return status;
}

pendres_status pendres_attractors_settle(pendres_context *ctx, const pendres_attractors *set,
                                         size_t n, const double *x, const double *v,
                                         pendres_settled *outcome)
{
  pendres_door d = pendres_attractors_open(ctx, set);
  PENDRES_DOOR_IN(&d, length, n, x);
  PENDRES_DOOR_IN(&d, speed, n, v);
  PENDRES_DOOR_OUT(&d, settled, n, outcome);
  return PENDRES_DOOR_END(&d, attractors_settle(ctx, set, n, x, v, outcome));
}

static pendres_status attractors_point(pendres_context *ctx, const pendres_attractors *set,
                                       size_t i, pendres_state *out)
{
  if (set == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "attractors and out");
  const pendres_attractor *a = pendres_attractors_get(set, i);
  if (a == NULL || set->sets != 1)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "there is no attractor %zu of one parameter set", i);
  const pendres_attractor_set *c = set->attractor_sets;
  *out = (pendres_state){a->orbit.x, a->orbit.v};
  for (size_t k = 0; k < c->covers; k++) {
    const pendres_coordinates at = {.y = c->cover[k]->y, .w = c->cover[k]->w};
    if (c->cover[k]->attractor == (int)i)
      pendres_coordinates_out(&c->pendulum, &at, &out->x, &out->v);
  }
  return PENDRES_OK;
}

pendres_status pendres_attractors_point_find(pendres_context *ctx, const pendres_attractors *set,
                                             size_t i, pendres_state *out)
{
  pendres_door d = pendres_attractors_open(ctx, set);
  const pendres_attractors *inside = pendres_attractors_inside(&d, set);
  PENDRES_DOOR_OUT(&d, state, 1, out);
  return PENDRES_DOOR_END(&d, attractors_point(ctx, inside, i, out));
}

double pendres_attractors_weakest_multiplier(const pendres_attractors *set)
{
  double weakest = NAN;
  for (size_t i = 0; i < pendres_attractors_count(set); i++)
    weakest = fmax(weakest, pendres_attractor_multiplier(pendres_attractors_get(set, i)));
  return weakest;
}

pendres_status pendres_attractors_extend(pendres_context *ctx, pendres_attractors *set, size_t n,
                                         const double *x, const double *v)
{
  pendres_room room = pendres_room_open(ctx, "attractors");
  size_t *zero = pendres_room_take(&room, n, sizeof *zero);
  pendres_settled *outcome = pendres_room_take(&room, n, sizeof *outcome);
  const pendres_settle_starts starts = {
    .n = n, .set = zero, .x = x, .v = v, .wanted = PENDRES_SETTLE_NOTHING};
  pendres_status status = room.status;
  if (status == PENDRES_OK)
    status = pendres_settle_batch(ctx, 1, set->attractor_sets, &starts, outcome);
  if (status == PENDRES_OK && index_sets(set) != 0)
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  return pendres_room_close(&room, status);
}

/* Number of runs of equal parameters. */
static size_t count_sets(size_t n, const pendres_pendulum *p)
{
  size_t sets = n > 0;
  for (size_t i = 1; i < n; i++) sets += !pendres_model_same(&p[i], &p[i - 1]);
  return sets;
}

/* Pendulums of a stretch with their starts, and the sets that are made of them. */
typedef struct settling {
  size_t n;
  const pendres_pendulum *pendulums;
  const double *x, *v;
  pendres_settled *outcome;
  pendres_attractors *all;
  size_t sets;   /* those of earlier stretches, */
  size_t offset; /* and their attractors */
  pendres_settle_wanted wanted;
} settling;

static pendres_status settle_stretch(pendres_door *d, settling *s)
{
  pendres_context *ctx = d->ctx;
  const size_t n = s->n;
  const pendres_pendulum *pendulums = s->pendulums;
  pendres_attractors *all = s->all;
  pendres_status status = PENDRES_OK;
  size_t *set = malloc((n + 1) * sizeof *set);
  if (set == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  for (size_t first = 0, last; first < n && status == PENDRES_OK; first = last) {
    const size_t base = s->sets;
    for (last = first; last < n; last++) {
      if (last == first || !pendres_model_same(&pendulums[last], &pendulums[last - 1])) {
        if (s->sets - base == BATCH_SETS) break;
        all->units[s->sets] = d->scales.unit;
        all->attractor_sets[s->sets++].pendulum = pendulums[last];
      }
      set[last] = s->sets - 1 - base;
    }
    pendres_attractor_set *c = all->attractor_sets + base;
    const pendres_settle_starts some = {
      .n = last - first, .set = set + first, .x = s->x + first, .v = s->v + first,
      .wanted = s->wanted};
    status = pendres_settle_batch(ctx, s->sets - base, c, &some, s->outcome + first);
    /* Numbers within a set become numbers in the list of all attractors. */
    size_t starts[BATCH_SETS];
    for (size_t k = 0; k < s->sets - base; k++) {
      starts[k] = s->offset;
      s->offset += c[k].count;
    }
    for (size_t i = first; i < last && status == PENDRES_OK; i++) {
      describe(&c[set[i]], 1, &s->outcome[i]);
      if (s->outcome[i].attractor >= 0) s->outcome[i].attractor += (int)starts[set[i]];
    }
  }
  free(set);
  return status;
}

/* The same from the built-in starts of each pendulum. Chaos need not be known better than that it
   lasts. */
static pendres_status settle_from_all_sides(pendres_door *d, settling *s)
{
  enum { EACH = PENDRES_ATTRACTOR_SET_STARTS };
  const double exponent_error = d->ctx->options.exponent_error;
  settling all = *s;
  all.wanted = PENDRES_SETTLE_NOTHING;
  const size_t most = s->n * EACH;
  pendres_pendulum *p = pendres_door_memory(d, (most + 1) * sizeof *p);
  double *x = pendres_door_memory(d, (2 * most + 1) * sizeof *x);
  all.outcome = pendres_door_memory(d, (most + 1) * sizeof *all.outcome);
  if (d->status != PENDRES_OK) return d->status;
  double *v = x + most;
  all.n = 0;
  for (size_t i = 0; i < s->n; i++) {
    const size_t n = pendres_attractor_set_starts(&s->pendulums[i], x + all.n, v + all.n);
    for (size_t k = 0; k < n; k++) p[all.n++] = s->pendulums[i];
  }
  all.pendulums = p;
  all.x = x;
  all.v = v;
  d->ctx->options.exponent_error = 1.0;
  const pendres_status status = settle_stretch(d, &all);
  d->ctx->options.exponent_error = exponent_error;
  s->sets = all.sets;
  s->offset = all.offset;
  return status;
}

/* Checks before anything is computed; the sets are made for all of the pendulums. */
static pendres_status settle_begin(pendres_context *ctx, settling *s, int starts)
{
  const int given = s->x != NULL && s->v != NULL && s->outcome != NULL;
  if (s->n > 0 && (s->pendulums == NULL || !(given || starts)))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, x, v and outcome");
  const double rest = 0.0;
  pendres_status status =
    starts ? PENDRES_OK : check_states(ctx, s->n, s->pendulums, 1, s->x, s->v);
  for (size_t i = 0; i < s->n && starts && status == PENDRES_OK; i++)
    status = check_states(ctx, 1, &s->pendulums[i], 0, &rest, &rest);
  if (status != PENDRES_OK) return status;
  s->all = create_sets(count_sets(s->n, s->pendulums));
  if (s->all != NULL) return PENDRES_OK;
  return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
}

pendres_status pendres_settle(pendres_context *ctx, size_t n, const pendres_pendulum *pendulums,
                              const double *x, const double *v, pendres_settled *outcome,
                              pendres_attractors **found)
{
  settling s = {.n = n, .pendulums = pendulums, .x = x, .v = v, .outcome = outcome};
  const int starts = x == NULL && v == NULL && outcome == NULL && found != NULL;
  if (found != NULL) *found = NULL;
  pendres_door d = pendres_door_open_many(ctx, n, pendulums, sizeof *pendulums);
  PENDRES_DOOR_CALL(&d, settle_begin(ctx, &s, starts));
  while (pendres_door_next(&d)) {
    s.n = d.count;
    s.pendulums = pendres_door_in_run(&d, &pendres_dim_pendulum, pendulums);
    s.x = pendres_door_in_run(&d, &pendres_dim_length, x);
    s.v = pendres_door_in_run(&d, &pendres_dim_speed, v);
    s.outcome = pendres_door_out_run(&d, &pendres_dim_settled, outcome);
    PENDRES_DOOR_CALL(&d, starts ? settle_from_all_sides(&d, &s) : settle_stretch(&d, &s));
  }
  if (d.status == PENDRES_OK && index_sets(s.all) != 0)
    d.status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  if (d.status == PENDRES_OK && found != NULL) {
    *found = s.all;
    s.all = NULL;
  }
  pendres_attractors_free(s.all);
  return pendres_door_close(&d);
}
