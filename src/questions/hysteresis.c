/* hysteresis.c -- the state of a pendulum along a path of a parameter; see hysteresis.h. */
#include <pendres/hysteresis.h>

#include <math.h>
#include <stdlib.h>

#include "continuation/continuation_parameter.h"
#include "engine/context_internal.h"
#include "questions/hysteresis_chaos.h"
#include "questions/hysteresis_circle.h"
#include "questions/hysteresis_left.h"
#include "questions/hysteresis_rotation.h"
#include "model/model.h"

enum {
  MOST_JUMPS = 256, /* between two values of the path */
  MOST_TRIES = 4    /* to come from chaos to an orbit on the way from one value to the next */
};

/* Rotations without a lock are computed side by side at values this close, in the parameter's
   scale. */
static const double close_by = 0.1;
/* A state is followed to values this close at once, in the same scale; the work for one further
   away is counted as its own. */
static const double in_sight = 100.0;

const char *pendres_jump_kind_name(pendres_jump_kind kind)
{
  static const char *const names[PENDRES_JUMP_COUNT] = {
#define NAME(code, name) name,
    PENDRES_JUMP_LIST(NAME)
#undef NAME
  };
  return (unsigned)kind < PENDRES_JUMP_COUNT ? names[kind] : NULL;
}

void pendres_hysteresis_free(pendres_hysteresis *h)
{
  if (h == NULL) return;
  free(h->point);
  free(h->jump);
  free(h->stretch);
  free(h->jump_from);
  free(h->jump_to);
  free(h);
}

size_t pendres_hysteresis_count(const pendres_hysteresis *h)
{
  return h != NULL ? h->count : 0;
}

const pendres_hysteresis_point *pendres_hysteresis_get(const pendres_hysteresis *h, size_t i)
{
  return h != NULL && i < h->count ? &h->point[i] : NULL;
}

size_t pendres_hysteresis_jumps(const pendres_hysteresis *h)
{
  return h != NULL ? h->jumps : 0;
}

const pendres_jump *pendres_hysteresis_jump(const pendres_hysteresis *h, size_t i)
{
  return h != NULL && i < h->jumps ? &h->jump[i] : NULL;
}

/* ---- along the path ---- */

typedef pendres_path path;

/* Whether a stretch ends at one of the later doublings of a cascade. */
static int cascades(const pendres_stretch *s)
{
  return s->end == PENDRES_STRETCH_BIFURCATION &&
         s->bifurcation.kind == PENDRES_PERIOD_DOUBLING &&
         2 * s->period > PENDRES_HYSTERESIS_PERIOD;
}

/* The stretch that a pendulum goes over to without a jump: that of an orbit born at the end of its
   own stretch, or of the orbit from which its own was born. PENDRES_NOT_FOUND: it jumps. */
static pendres_status go_over(path *w, const pendres_bifurcation *end, double limit,
                              pendres_stretch *next)
{
  const int doubled = end->kind == PENDRES_PERIOD_DOUBLING ? 2 : 1;
  if (end->kind != PENDRES_PERIOD_DOUBLING && end->kind != PENDRES_SYMMETRY_BREAKING)
    return PENDRES_NOT_FOUND;
  if (w->stretch.end != PENDRES_STRETCH_BIRTH)
    return doubled * end->orbit.period <= PENDRES_HYSTERESIS_PERIOD
             ? pendres_stretch_born(w->ctx, end, limit, next)
             : PENDRES_NOT_FOUND;
  const pendres_status status =
    pendres_stretch_from(w->ctx, &end->orbit, w->parameter, limit, next);
  if (status != PENDRES_OK || next->points > 1) return status;
  pendres_stretch_free(next);
  return PENDRES_NOT_FOUND;
}

/* At the end of the stretch: which bifurcation it is, and what the pendulum goes to. */
static pendres_status end_stretch(path *w, size_t step, double limit)
{
  static const pendres_jump_kind kinds[] = {
    [PENDRES_REGULAR] = PENDRES_JUMP_OTHER, [PENDRES_FOLD] = PENDRES_JUMP_FOLD,
    [PENDRES_PERIOD_DOUBLING] = PENDRES_JUMP_FLIP,
    [PENDRES_SYMMETRY_BREAKING] = PENDRES_JUMP_SYMMETRY,
    [PENDRES_BRANCH_POINT] = PENDRES_JUMP_BRANCH_POINT};
  const pendres_stretch *s = &w->stretch;
  pendres_bifurcation end = s->bifurcation;
  if (s->end == PENDRES_STRETCH_LOST)
    end = (pendres_bifurcation){.kind = PENDRES_REGULAR, .parameter = w->parameter,
                                .value = s->end_value, .value_error = s->end_error,
                                .orbit = w->state.attractor.orbit};
  pendres_jump j = {.step = step, .direction = s->direction, .kind = kinds[end.kind],
                    .value = end.value, .value_error = end.value_error,
                    .from = w->state.attractor.label, .share = NAN};
  pendres_stretch next = pendres_stretch_none;
  int goes_on = 0;
  pendres_status status = go_over(w, &end, limit, &next);
  pendres_orbit arrived;
  if (status == PENDRES_OK) status = pendres_stretch_arrive(w->ctx, &next, &arrived);
  if (status == PENDRES_OK) {
    w->state.attractor = pendres_settled_orbit(&arrived);
    w->at = end.value;
    j.gradual = j.certain = 1;
    j.share = 1.0;
    j.to = w->state.attractor.label;
    j.to_period = next.period;
  } else if (status == PENDRES_NOT_FOUND && cascades(&w->stretch)) {
    /* What it goes to is found at the next value. */
    w->state.attractor = pendres_settled_nothing(&end.orbit.pendulum);
    w->state.x = end.orbit.x;
    w->state.v = end.orbit.v;
    w->at = end.value;
    j.to = PENDRES_LABEL_UNRESOLVED;
    status = PENDRES_OK;
  } else if (status == PENDRES_NOT_FOUND) {
    const pendres_attractor old = w->state.attractor;
    int done = 0;
    pendres_path_into_rotation(w, &end, &j, &done);
    status = PENDRES_OK;
    if (!done) status = pendres_path_onto_circle(w, &end, s->direction, &j, &done);
    if (status == PENDRES_OK && !done)
      status = pendres_jump_try(w->ctx, &end, s->direction, &w->state, &j);
    w->at = pendres_parameter_get(w->parameter, &w->state.pendulum);
    /* A state that exists but could not be followed further has not ended. */
    goes_on = s->end == PENDRES_STRETCH_LOST && old.orbit.period > 1 &&
              pendres_settled_alike(&old, &w->state.attractor);
  }
  if (status == PENDRES_OK && !goes_on) status = pendres_path_note(w, &j);
  if (goes_on) pendres_stretch_free(&w->stretch);
  else pendres_path_leave(w);
  w->stretch = next;
  return status;
}

/* Whether a value is the fold's at which the stretch ends, where the orbit cannot be told from the
   one that it meets. */
static int at_fold(const pendres_stretch *s, double value)
{
  return s->end == PENDRES_STRETCH_BIFURCATION && s->bifurcation.kind == PENDRES_FOLD &&
         fabs(value - s->end_value) <= s->end_error;
}

/* Put the values from number i on that the stretch holds into the results; returns the number after
   the last of them. */
static size_t held(const path *w, size_t i)
{
  const int direction = w->stretch.direction;
  double last = w->at;
  for (; i < w->n && pendres_stretch_holds(&w->stretch, w->value[i]); i++) {
    if ((w->value[i] - last) * direction < 0.0 || at_fold(&w->stretch, w->value[i])) break;
    last = w->value[i];
  }
  return i;
}

static pendres_status put_stretch(path *w, size_t first, size_t last)
{
  const size_t n = last - first;
  pendres_orbit *orbit = malloc((n + 1) * sizeof *orbit);
  int *found = calloc(n + 1, sizeof *found);
  pendres_status status = pendres_context_poll(w->ctx);
  pendres_path_allow_all(w); /* they are known to be near, however many */
  if (status != PENDRES_OK) goto done;
  status = PENDRES_OUT_OF_MEMORY;
  if (orbit == NULL || found == NULL)
    (void)pendres_context_fail(w->ctx, status, "out of memory for %zu orbits", n);
  else
    status = pendres_stretch_orbits(w->ctx, &w->stretch, n, w->value + first, orbit, found);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    const pendres_pendulum p = pendres_path_pendulum(w, w->value[first + i]);
    const pendres_attractor a =
      found[i] ? pendres_settled_orbit(&orbit[i]) : pendres_settled_nothing(&p);
    pendres_path_put(w, first + i, &a);
    if (!found[i]) continue;
    w->state = (pendres_settled){
      .pendulum = p, .attractor = a, .x = orbit[i].x, .v = orbit[i].v};
    w->at = w->value[first + i];
  }
done:
  free(orbit);
  free(found);
  return status;
}

/* The last value from number i on before the path turns round or takes a long step. */
static double turning_point(const path *w, size_t i)
{
  const int up = w->value[i] > w->at;
  const double most = in_sight * pendres_parameter_scale(w->parameter);
  while (i + 1 < w->n && fabs(w->value[i + 1] - w->value[i]) <= most &&
         (up ? w->value[i + 1] >= w->value[i] : w->value[i + 1] <= w->value[i]))
    i++;
  return w->value[i];
}

/* Whether an attractor is an orbit that can be followed. */
static int is_short(const pendres_attractor *a)
{
  return pendres_settled_closed(a) && a->orbit.period <= PENDRES_HYSTERESIS_PERIOD;
}

/* Whether it is a rotation without a drive. */
static int rotates_freely(const pendres_attractor *a)
{
  return a->label == PENDRES_LABEL_RUNNING && !pendres_settled_closed(a);
}

/* Whether the path goes up (1) or down (-1) to value number i. */
static int direction_to(const path *w, size_t i)
{
  const double from = i > 0 ? w->value[i - 1] : w->at;
  return w->value[i] >= from ? 1 : -1;
}

/*
 * Follow a closed orbit to value number *i and as far beyond as possible, through jumps at its
 * ends. If the trials of a jump have gone beyond that value, the orbit is followed back to it; an
 * end that it meets on the way back is no jump of the path.
 */
static pendres_status follow_closed(path *w, size_t *i)
{
  const size_t start = *i;
  for (int ends = 0; ends < MOST_JUMPS && *i == start; ends++) {
    const double limit = turning_point(w, *i);
    const int direction = w->value[*i] >= w->at ? 1 : -1;
    pendres_status status = PENDRES_OK;
    if (w->stretch.branch != NULL && w->stretch.direction != direction)
      pendres_stretch_free(&w->stretch);
    if (w->stretch.branch == NULL)
      status = pendres_stretch_from(w->ctx, &w->state.attractor.orbit, w->parameter, limit,
                                    &w->stretch);
    if (status != PENDRES_OK) return status;
    size_t last = held(w, *i);
    if (last > *i) {
      status = put_stretch(w, *i, last);
      if (pendres_path_own(status) && last > *i + 1) status = put_stretch(w, *i, last = *i + 1);
      *i = last;
    } else if (direction != direction_to(w, *i)) {
      return PENDRES_OK;
    } else {
      status = end_stretch(w, *i, limit);
    }
    if (status != PENDRES_OK || !is_short(&w->state.attractor)) return status;
  }
  return PENDRES_OK;
}

/* Chaos has ended between the last value and this one, at which the pendulum is on an orbit.
   w->state becomes the first orbit that it goes to, at this value or an earlier one. */
static pendres_status end_chaos(path *w, size_t step, const pendres_settled *old)
{
  const double to = w->value[step];
  pendres_jump j = {
    .step = step, .direction = direction_to(w, step), .kind = PENDRES_JUMP_OTHER, .share = NAN};
  pendres_status status = PENDRES_OK;
  const int back = (to - w->at) * j.direction <= 0.0; /* from trials beyond the value */
  if (w->tries <= MOST_TRIES && !(back && pendres_settled_closed(&old->attractor))) {
    status = pendres_chaos_end(w->ctx, w->parameter, old, w->at, &w->state, &j);
  } else { /* chaos and windows of orbits in turn, or one orbit and another: somewhere between */
    j.from = old->attractor.label;
    j.to = w->state.attractor.label;
    j.to_period = w->state.attractor.orbit.period;
    j.value = 0.5 * (w->at + to);
    j.value_error = 0.5 * fabs(to - w->at);
  }
  return status == PENDRES_OK ? pendres_path_note(w, &j) : status;
}

/*
 * A pendulum on a rotation that is not locked to the drive: the close values from number *i on are
 * computed side by side, as long as it stays on such a rotation. There is at most one at each
 * value, so that a start on one leads to the next.
 */
static pendres_status follow_rotation(path *w, size_t *i)
{
  const double most = close_by * pendres_parameter_scale(w->parameter);
  pendres_settled s[PENDRES_HYSTERESIS_TRIALS];
  size_t n = 0;
  for (; n < PENDRES_HYSTERESIS_TRIALS && *i + n < w->n; n++) {
    if (n > 0 && fabs(w->value[*i + n] - w->at) > most) break;
    const pendres_pendulum p = pendres_path_pendulum(w, w->value[*i + n]);
    s[n] = pendres_settled_nothing_at(&p, w->state.x, w->state.v);
  }
  const pendres_status status = pendres_settled_rotations(w->ctx, n, s);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++, (*i)++) {
    if (s[k].attractor.label != PENDRES_LABEL_QUASI_PERIODIC) break;
    w->state = s[k];
    w->at = w->value[*i];
    pendres_path_put(w, *i, &s[k].attractor);
  }
  return status;
}

/* A pendulum that has escaped does not return, whatever the parameter does. */
static void stay_away(path *w, size_t *i)
{
  const pendres_pendulum p = pendres_path_pendulum(w, w->value[*i]);
  w->state = pendres_settled_nothing_at(&p, w->state.x, w->state.v);
  w->state.attractor.label = PENDRES_LABEL_ESCAPE;
  w->at = w->value[*i];
  pendres_path_put(w, (*i)++, &w->state.attractor);
}

/* Find what the pendulum settles on at value number *i, from its present state, or the orbit that
   it goes to on the way there, which is to be followed first. */
static pendres_status settle_at(path *w, size_t *i)
{
  const pendres_pendulum p = pendres_path_pendulum(w, w->value[*i]);
  const pendres_settled old = w->state;
  pendres_status status = pendres_settled_find(w->ctx, &p, old.x, old.v, &w->state);
  const int same = pendres_settled_closed(&old.attractor) &&
                   pendres_settled_alike(&old.attractor, &w->state.attractor);
  if (status == PENDRES_OK && w->settled && pendres_settled_closed(&w->state.attractor) && !same) {
    if (w->tried != *i) w->tries = 0;
    w->tried = *i;
    w->tries++;
    status = end_chaos(w, *i, &old);
    pendres_path_leave(w);
  }
  w->at = pendres_parameter_get(w->parameter, &w->state.pendulum);
  if (status == PENDRES_OK && w->at == w->value[*i])
    pendres_path_put(w, (*i)++, &w->state.attractor);
  return status;
}

/* One step of the path: to value number *i, beyond it, or nearer to it. */
static pendres_status go_on(path *w, size_t *i)
{
  const size_t before = *i;
  pendres_status status = pendres_context_poll(w->ctx);
  if (status != PENDRES_OK || !w->settled) return status == PENDRES_OK ? settle_at(w, i) : status;
  if (w->value[*i] == w->value[*i - 1]) {
    pendres_path_put(w, *i, &w->h->point[*i - 1].attractor);
    ++*i;
    return PENDRES_OK;
  }
  const int rotates = w->state.attractor.label == PENDRES_LABEL_QUASI_PERIODIC;
  if (rotates_freely(&w->state.attractor)) return pendres_path_rotation(w, i);
  if (w->on_circle || rotates) status = pendres_path_circle(w, i);
  if (status != PENDRES_OK || *i > before) return status;
  if (w->state.attractor.label == PENDRES_LABEL_ESCAPE) {
    stay_away(w, i);
    return PENDRES_OK;
  }
  if (is_short(&w->state.attractor)) status = follow_closed(w, i);
  else if (rotates) status = follow_rotation(w, i);
  if (status != PENDRES_OK || *i > before || rotates_freely(&w->state.attractor)) return status;
  return settle_at(w, i);
}

static pendres_status follow_path(path *w, pendres_path_left *left)
{
  pendres_status status = PENDRES_OK;
  pendres_path_mark mark = pendres_path_mark_here(w);
  size_t at = 0;
  pendres_path_allow(w);
  for (size_t i = 0; i < w->n && status == PENDRES_OK;) {
    status = go_on(w, &i);
    const int came = pendres_path_came(w, left, &mark, at, &status);
    if (!came) i = at;
    if (came && i == at) continue;
    w->settled = i > 0;
    at = i;
    mark = pendres_path_mark_here(w);
    pendres_path_allow(w);
  }
  pendres_path_allow_all(w);
  pendres_stretch_free(&w->stretch);
  pendres_circles_free(w->circles);
  pendres_rotation_table_free(w->rotations);
  return status;
}

/* ---- the call ---- */

static pendres_hysteresis *create(size_t n)
{
  pendres_hysteresis *h = calloc(1, sizeof *h);
  if (h == NULL) return NULL;
  h->count = n;
  h->point = calloc(n + 1, sizeof *h->point);
  h->stretch = calloc(n + 1, sizeof *h->stretch);
  for (size_t i = 0; i < n && h->point != NULL; i++) h->point[i].value = NAN; /* not reached */
  if (h->point != NULL && h->stretch != NULL) return h;
  pendres_hysteresis_free(h);
  return NULL;
}

pendres_status pendres_path_run(pendres_path *w, double x, double v, pendres_hysteresis **out)
{
  w->state = (pendres_settled){.x = x, .v = v};
  for (size_t i = 0; i < w->n; i++) {
    const char *why = NULL;
    const pendres_pendulum p = pendres_path_pendulum(w, w->value[i]);
    if (pendres_pendulum_check(&p, &why) == PENDRES_OK && p.damping == 0.0)
      why = "without damping nothing settles";
    if (why != NULL)
      return pendres_context_fail(w->ctx, PENDRES_INVALID_ARGUMENT, "value %zu of the path: %s", i,
                                  why);
  }
  w->h = create(w->n);
  if (w->h == NULL)
    return pendres_context_fail(w->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu values",
                                w->n);
  pendres_path_left left;
  pendres_status status = pendres_path_left_open(w, &left);
  if (status == PENDRES_OK) status = follow_path(w, &left);
  const int interrupted = status == PENDRES_INTERRUPTED;
  if (status == PENDRES_OK || interrupted) {
    pendres_path_number(w, &left);
    const pendres_status named = pendres_hysteresis_name(w->ctx, w->h);
    if (named != PENDRES_OK) status = named;
  }
  if (status == PENDRES_OK || status == PENDRES_INTERRUPTED) *out = w->h;
  else pendres_hysteresis_free(w->h);
  pendres_path_left_close(&left);
  return status;
}

static pendres_status checked(pendres_context *ctx, const pendres_pendulum *p,
                              const pendres_state *start, const pendres_hysteresis_path *along,
                              pendres_hysteresis **out)
{
  if (p == NULL || start == NULL || along == NULL || out == NULL ||
      (along->n > 0 && along->value == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "pendulum, start, path, its values and out");
  *out = NULL;
  if ((unsigned)along->parameter >= PENDRES_PARAMETER_COUNT)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "unknown parameter");
  path w = {.ctx = ctx, .pendulum = *p, .parameter = along->parameter, .all = along->value,
            .n = along->n, .value = along->value};
  return pendres_path_run(&w, start->x, start->v, out);
}

pendres_status pendres_hysteresis_follow(pendres_context *ctx, const pendres_pendulum *p,
                                         const pendres_state *start,
                                         const pendres_hysteresis_path *along,
                                         pendres_hysteresis **out)
{
  return PENDRES_CONTEXT_CALL(ctx, checked(ctx, p, start, along, out));
}
