/* attractor.c -- the attractors of parameter sets and what goes there; see attractor.h. */
#include <pendres/attractor.h>

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "orbits/attractor_internal.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "orbits/settle.h"
#include "engine/passage.h"
#include "model/model.h"

enum { BATCH_SETS = 64 /* parameter sets worked on at a time */ };

static pendres_status check_states(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                   size_t stride, const double *x, const double *v)
{
  for (size_t i = 0; i < n; i++) {
    const char *why = NULL;
    if (pendres_pendulum_check(&p[i * stride], &why) == PENDRES_OK)
      why = pendres_passage_refuses(&p[i * stride], x[i], v[i]);
    if (why == NULL && p[i * stride].damping == 0.0)
      why = "without damping nothing settles";
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "pendulum %zu: %s", i, why);
  }
  return PENDRES_OK;
}

void pendres_attractors_free(pendres_attractors *set)
{
  if (set == NULL) return;
  for (size_t i = 0; i < set->sets; i++) pendres_catalogue_clear(&set->catalogues[i]);
  free(set->catalogues);
  free(set->attractors);
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

static pendres_attractors *create_sets(size_t sets)
{
  pendres_attractors *set = calloc(1, sizeof *set);
  if (set == NULL) return NULL;
  set->catalogues = calloc(sets + 1, sizeof *set->catalogues);
  if (set->catalogues == NULL) {
    free(set);
    return NULL;
  }
  set->sets = sets;
  return set;
}

/* Make the list of all attractors, after all of them have been found. */
static int index_sets(pendres_attractors *set)
{
  size_t count = 0;
  for (size_t i = 0; i < set->sets; i++) count += set->catalogues[i].count;
  free(set->attractors);
  set->attractors = malloc((count + 1) * sizeof *set->attractors);
  set->count = 0;
  if (set->attractors == NULL) return -1;
  for (size_t i = 0; i < set->sets; i++)
    for (size_t j = 0; j < set->catalogues[i].count; j++)
      set->attractors[set->count++] = &set->catalogues[i].attractors[j];
  return 0;
}

/* Scouts that start all over a well, at rest and moving either way. */
static size_t default_scouts(const pendres_pendulum *p, double x[64], double v[64])
{
  size_t n = 0;
  const double scale = pendres_model_scale(p);
  for (int i = 0; i < 12; i++)
    for (int j = -1; j <= 1; j++) {
      x[n] = pendres_model_origin(p) + scale * two_pi * (i - 5.5) / 12.0;
      v[n++] = 1.3 * j * scale;
    }
  return n;
}

static pendres_status attractors_find(pendres_context *ctx, const pendres_pendulum *p, size_t n,
                                      const double *x, const double *v, pendres_attractors **out)
{
  double default_x[64], default_v[64];
  if (p == NULL || out == NULL || (n > 0 && (x == NULL || v == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "pendulum, x, v and out");
  *out = NULL;
  const char *why = NULL;
  if (pendres_pendulum_check(p, &why) != PENDRES_OK)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
  if (n == 0) {
    n = default_scouts(p, default_x, default_v);
    x = default_x;
    v = default_v;
  }
  pendres_status status = check_states(ctx, n, p, 0, x, v);
  if (status != PENDRES_OK) return status;

  pendres_attractors *set = create_sets(1);
  size_t *zero = calloc(n, sizeof *zero);
  pendres_outcome *outcome = malloc(n * sizeof *outcome);
  if (set == NULL || zero == NULL || outcome == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
    goto done;
  }
  set->catalogues[0].pendulum = *p;
  /* Whoever asks for attractors alone has many pendulums to come. */
  set->catalogues[0].effort = PENDRES_TRAP_MANY;
  const pendres_settle_starts starts = {.n = n, .set = zero, .x = x, .v = v};
  status = pendres_settle_batch(ctx, 1, set->catalogues, &starts, outcome);
  if (status == PENDRES_OK && index_sets(set) != 0)
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  if (status == PENDRES_OK) {
    *out = set;
    set = NULL;
  }
done:
  pendres_attractors_free(set);
  free(zero);
  free(outcome);
  return status;
}

pendres_status pendres_attractors_find(pendres_context *ctx, const pendres_pendulum *p, size_t n,
                                       const double *x, const double *v, pendres_attractors **out)
{
  return PENDRES_CONTEXT_CALL(ctx, attractors_find(ctx, p, n, x, v, out));
}

static pendres_status attractors_settle(pendres_context *ctx, const pendres_attractors *set,
                                        size_t n, const double *x, const double *v,
                                        pendres_outcome *outcome)
{
  if (set == NULL || (n > 0 && (x == NULL || v == NULL || outcome == NULL)))
    return PENDRES_CONTEXT_NULL(ctx, "attractors, x, v and outcome");
  if (set->sets != 1)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "these are attractors of several parameter sets");
  pendres_status status = check_states(ctx, n, &set->catalogues[0].pendulum, 0, x, v);
  if (status != PENDRES_OK || n == 0) return status;
  const pendres_settle_starts starts = {.n = n, .x = x, .v = v};
  return pendres_settle_known(ctx, set->catalogues, &starts, pendres_accuracy_to_settle(ctx),
                              PENDRES_SETTLE_FULL, outcome);
}

pendres_status pendres_attractors_settle(pendres_context *ctx, const pendres_attractors *set,
                                         size_t n, const double *x, const double *v,
                                         pendres_outcome *outcome)
{
  return PENDRES_CONTEXT_CALL(ctx, attractors_settle(ctx, set, n, x, v, outcome));
}

static pendres_status attractors_point(pendres_context *ctx, const pendres_attractors *set,
                                       size_t i, pendres_state *out)
{
  enum { STARTS = 256 };
  double x[STARTS], v[STARTS];
  pendres_outcome outcome[STARTS];
  if (set == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "attractors and out");
  const pendres_attractor *a = pendres_attractors_get(set, i);
  if (a == NULL)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "there is no attractor %zu", i);
  if (a->label != PENDRES_LABEL_CHAOTIC) {
    *out = (pendres_state){a->orbit.x, a->orbit.v};
    return PENDRES_OK;
  }
  for (int k = 0; k < STARTS; k++) {
    /* The two-dimensional golden ratio. */
    x[k] = pi * (2.0 * fmod(0.5 + 0.7548776662466927 * k, 1.0) - 0.5);
    v[k] = 4.0 * fmod(0.5 + 0.5698402909980532 * k, 1.0) - 2.0;
  }
  pendres_status status = attractors_settle(ctx, set, STARTS, x, v, outcome);
  if (status != PENDRES_OK) return status;
  for (int k = 0; k < STARTS; k++) {
    double error;
    if (outcome[k].attractor != (int)i) continue;
    status = pendres_strobe_advance(ctx, 1, &set->catalogues[0].pendulum, &x[k], &v[k],
                                    outcome[k].settling_periods, &error);
    if (status == PENDRES_OK) *out = (pendres_state){x[k], v[k]};
    return status;
  }
  return pendres_context_fail(ctx, PENDRES_NOT_FOUND, "no start is found that leads to it");
}

pendres_status pendres_attractors_point(pendres_context *ctx, const pendres_attractors *set,
                                        size_t i, pendres_state *out)
{
  return PENDRES_CONTEXT_CALL(ctx, attractors_point(ctx, set, i, out));
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
  size_t *zero = calloc(n + 1, sizeof *zero);
  pendres_outcome *outcome = malloc((n + 1) * sizeof *outcome);
  const pendres_settle_starts starts = {.n = n, .set = zero, .x = x, .v = v};
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (zero == NULL || outcome == NULL)
    (void)pendres_context_fail(ctx, status, "out of memory for attractors");
  else
    status = pendres_settle_batch(ctx, 1, set->catalogues, &starts, outcome);
  if (status == PENDRES_OK && index_sets(set) != 0)
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  free(zero);
  free(outcome);
  return status;
}

/* Number of runs of equal parameters. */
static size_t count_sets(size_t n, const pendres_pendulum *p)
{
  size_t sets = n > 0;
  for (size_t i = 1; i < n; i++) sets += !pendres_model_same(&p[i], &p[i - 1]);
  return sets;
}

static pendres_status settle_all(pendres_context *ctx, size_t n,
                                    const pendres_pendulum *pendulums, const double *x,
                                    const double *v, pendres_outcome *outcome,
                                    pendres_attractors **found)
{
  if (n > 0 && (pendulums == NULL || x == NULL || v == NULL || outcome == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, x, v and outcome");
  pendres_status status = check_states(ctx, n, pendulums, 1, x, v);
  if (status != PENDRES_OK) return status;

  pendres_attractors *all = create_sets(count_sets(n, pendulums));
  size_t *set = malloc((n + 1) * sizeof *set);
  if (all == NULL || set == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
    goto done;
  }
  size_t offset = 0; /* attractors of earlier sets */
  for (size_t first = 0, last, next_set = 0; first < n && status == PENDRES_OK; first = last) {
    const size_t base = next_set;
    for (last = first; last < n; last++) {
      if (last == first || !pendres_model_same(&pendulums[last], &pendulums[last - 1])) {
        if (next_set - base == BATCH_SETS) break;
        all->catalogues[next_set++].pendulum = pendulums[last];
      }
      set[last] = next_set - 1 - base;
    }
    pendres_catalogue *c = all->catalogues + base;
    const pendres_settle_starts some = {
      .n = last - first, .set = set + first, .x = x + first, .v = v + first};
    status = pendres_settle_batch(ctx, next_set - base, c, &some, outcome + first);
    /* Numbers within a set become numbers in the list of all attractors. */
    size_t starts[BATCH_SETS];
    for (size_t s = 0; s < next_set - base; s++) {
      starts[s] = offset;
      offset += c[s].count;
    }
    for (size_t i = first; i < last && status == PENDRES_OK; i++)
      if (outcome[i].attractor >= 0) outcome[i].attractor += (int)starts[set[i]];
  }
  if (status == PENDRES_OK && index_sets(all) != 0)
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for attractors");
  if (status == PENDRES_OK && found != NULL) {
    *found = all;
    all = NULL;
  }
done:
  pendres_attractors_free(all);
  free(set);
  return status;
}

pendres_status pendres_settle(pendres_context *ctx, size_t n, const pendres_pendulum *pendulums,
                              const double *x, const double *v, pendres_outcome *outcome,
                              pendres_attractors **found)
{
  if (found != NULL) *found = NULL;
  return PENDRES_CONTEXT_CALL(ctx, settle_all(ctx, n, pendulums, x, v, outcome, found));
}
