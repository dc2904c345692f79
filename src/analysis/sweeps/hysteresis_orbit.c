/* hysteresis_orbit.c -- a pendulum on a closed orbit along a path; see hysteresis_orbit.h. */
#include "analysis/sweeps/hysteresis_orbit.h"

#include <math.h>
#include <stdlib.h>

#include "continuation/parameter.h"
#include "engine/context_internal.h"
#include "model/model.h"
#include "orbits/orbit_same.h"
#include "analysis/sweeps/hysteresis_left.h"
#include "analysis/sweeps/hysteresis_rotation.h"
#include "analysis/sweeps/numbers.h"

/* Whether a part ends at one of the later doublings of a cascade. */
static int cascades(const pendres_path *w)
{
  const pendres_part *s = &w->part;
  return s->end == PENDRES_PART_BIFURCATION &&
         s->bifurcation.kind == PENDRES_PERIOD_DOUBLING &&
         2 * pendres_part_period(s) > pendres_path_longest(w);
}

/* The part that a pendulum goes over to without a jump: that of an orbit born at the end of its
   own part, or of the orbit from which its own was born. PENDRES_NOT_FOUND: it jumps. */
static pendres_status go_over(pendres_path *w, const pendres_bifurcation *end, double limit,
                              pendres_part *next)
{
  const int doubled = end->kind == PENDRES_PERIOD_DOUBLING ? 2 : 1;
  if (end->kind != PENDRES_PERIOD_DOUBLING && end->kind != PENDRES_SYMMETRY_BREAKING &&
      end->kind != PENDRES_BRANCH_POINT)
    return PENDRES_NOT_FOUND;
  if (w->part.end != PENDRES_PART_BIRTH)
    return doubled * end->orbit.period <= pendres_path_longest(w)
             ? pendres_part_born(w->ctx, end, limit, next)
             : PENDRES_NOT_FOUND;
  const pendres_status status =
    pendres_part_from(w->ctx, &end->orbit, w->parameter, limit, next);
  if (status != PENDRES_OK || next->points > 1) return status;
  pendres_part_free(next);
  return PENDRES_NOT_FOUND;
}

/* Whether two orbits swing about one place, or about places that are mirror images: states of rest
   have no amplitude that would tell them apart. */
static int about_one_place(const pendres_orbit *a, const pendres_orbit *b)
{
  const double turn = pendres_model_turn(&a->pendulum);
  const double middle = 0.5 * (a->mean_angle + b->mean_angle);
  const double bound = pendres_orbit_slack(a->amplitude_error + b->amplitude_error);
  if (fabs(remainder(a->mean_angle - b->mean_angle, turn)) < bound) return 1;
  if (!pendres_pendulum_symmetric(&a->pendulum)) return 0;
  const double aside = middle - pendres_model_centre(&a->pendulum, middle);
  return fabs(remainder(2.0 * aside, turn)) < bound;
}

/*
 * Whether the state that a pendulum has gone to is the one that it came from: followed back to
 * where that was last, it is the same orbit there, or its mirror image. It did not end then,
 * whatever was found.
 */
static pendres_status same_state(const pendres_path *w, const pendres_attractor *old, int *same)
{
  pendres_part back = pendres_part_none;
  pendres_orbit there;
  const double value = pendres_parameter_get(w->parameter, &old->orbit.pendulum);
  int found = 0;
  *same = 0;
  if (!pendres_attractor_closes(old) || !pendres_arrival_alike(old, &w->state.attractor))
    return PENDRES_OK;
  pendres_status status =
    pendres_part_from(w->ctx, &w->state.attractor.orbit, w->parameter, value, &back);
  if (status == PENDRES_OK && back.end == PENDRES_PART_LIMIT)
    status = pendres_part_orbits(w->ctx, &back, 1, &value, &there, &found);
  pendres_part_free(&back);
  if (status == PENDRES_NOT_CONVERGED) return PENDRES_OK;
  *same = found && pendres_orbit_as_wide(&there, &old->orbit) &&
          about_one_place(&there, &old->orbit);
  return status;
}

/* At the end of the part: which bifurcation it is, and what the pendulum goes to. */
static pendres_status end_part(pendres_path *w, size_t step, double limit)
{
  static const pendres_jump_kind kinds[] = {
    [PENDRES_REGULAR] = PENDRES_JUMP_OTHER, [PENDRES_FOLD] = PENDRES_JUMP_FOLD,
    [PENDRES_PERIOD_DOUBLING] = PENDRES_JUMP_FLIP,
    [PENDRES_SYMMETRY_BREAKING] = PENDRES_JUMP_SYMMETRY,
    [PENDRES_BRANCH_POINT] = PENDRES_JUMP_BRANCH_POINT};
  const pendres_part *s = &w->part;
  const pendres_branch_point *last = pendres_part_last(s);
  pendres_bifurcation end = s->bifurcation;
  if (s->end == PENDRES_PART_UNLOCATED)
    end = (pendres_bifurcation){.kind = PENDRES_REGULAR, .parameter = w->parameter,
                                .value = s->end_value, .value_error = s->end_error,
                                .orbit = last != NULL ? last->orbit : w->state.attractor.orbit};
  pendres_jump j = {.step = step, .direction = s->direction, .kind = kinds[end.kind],
                    .value = end.value, .value_error = end.value_error,
                    .from = w->state.attractor.label, .share = NAN};
  pendres_part next = pendres_part_none;
  int goes_on = 0, failed = 0;
  pendres_path_search_beyond(w, s->direction, s->end_value);
  pendres_status status = go_over(w, &end, limit, &next);
  pendres_orbit arrived;
  if (status == PENDRES_OK) status = pendres_part_arrive(w->ctx, &next, &arrived);
  if (status == PENDRES_OK) {
    w->state.attractor = pendres_arrival_orbit(&arrived);
    w->at = end.value;
    j.gradual = j.certain = 1;
    j.share = 1.0;
    j.to = w->state.attractor.label;
    j.to_period = pendres_part_period(&next);
  } else if (status == PENDRES_NOT_FOUND && cascades(w)) {
    /* What it goes to is found at the next value. */
    w->state.attractor = pendres_arrival_nothing(&end.orbit.pendulum);
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
    if (!done)
      status = pendres_jump_try(w->ctx, &end, s->direction, &w->state, &j);
    failed = pendres_path_own(status); /* as it would on the way to any other value */
    w->at = pendres_parameter_get(w->parameter, &w->state.pendulum);
    if (status == PENDRES_OK) status = same_state(w, &old, &goes_on);
  }
  if (status == PENDRES_OK && !goes_on) status = pendres_path_note(w, &j);
  if (goes_on) pendres_part_free(&w->part);
  else pendres_path_leave(w);
  w->part = next;
  if (!failed) pendres_path_search_beyond(w, 0, NAN);
  return status;
}

/* Whether a value is the fold's at which the part ends, where the orbit cannot be told from the
   one that it meets. */
static int at_fold(const pendres_part *s, double value)
{
  return s->end == PENDRES_PART_BIFURCATION && s->bifurcation.kind == PENDRES_FOLD &&
         fabs(value - s->end_value) <= s->end_error;
}

/* The number after the last of the values from number i on that the part holds: those that are
   computed side by side. */
static size_t held(const pendres_path *w, size_t i)
{
  const int direction = w->part.direction;
  double last = w->at;
  const size_t most = i + SWEEP_HELD < w->n ? i + SWEEP_HELD : w->n;
  for (; i < most && pendres_part_holds(&w->part, w->value[i]); i++) {
    if ((w->value[i] - last) * direction < 0.0 || at_fold(&w->part, w->value[i])) break;
    last = w->value[i];
  }
  return i;
}

/* The orbit at a value that cannot be told from that of a bifurcation at which the part begins or
   ends: it is the bifurcation's, where Newton's method finds none. NULL: there is none. */
static const pendres_orbit *at_bifurcation(const pendres_path *w, double value)
{
  const pendres_part *s = &w->part;
  const double same = pendres_part_same(s);
  const double beginning = pendres_parameter_get(w->parameter, &s->at.pendulum);
  if (fabs(value - beginning) <= same) return &s->at;
  const int ends = s->end == PENDRES_PART_BIFURCATION && fabs(value - s->end_value) <= same;
  return ends ? &s->bifurcation.orbit : NULL;
}

static pendres_status put_part(pendres_path *w, size_t first, size_t last)
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
    status = pendres_part_orbits(w->ctx, &w->part, n, w->value + first, orbit, found);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    const pendres_pendulum p = pendres_path_pendulum(w, w->value[first + i]);
    const pendres_orbit *there = found[i] ? NULL : at_bifurcation(w, w->value[first + i]);
    if (there != NULL) {
      orbit[i] = *there;
      orbit[i].pendulum = p;
      found[i] = 1;
    }
    const pendres_attractor a =
      found[i] ? pendres_arrival_orbit(&orbit[i]) : pendres_arrival_nothing(&p);
    pendres_path_put(w, first + i, &a);
    if (!found[i]) continue;
    w->state = (pendres_arrival){
      .pendulum = p, .attractor = a, .x = orbit[i].x, .v = orbit[i].v};
    w->at = w->value[first + i];
  }
done:
  free(orbit);
  free(found);
  return status;
}

/* The last value from number i on before the path turns round or takes a long step. */
static double turning_point(const pendres_path *w, size_t i)
{
  const int up = w->value[i] > w->at;
  const double most = sweep_in_sight * pendres_parameter_scale(w->parameter);
  while (i + 1 < w->n && fabs(w->value[i + 1] - w->value[i]) <= most &&
         (up ? w->value[i + 1] >= w->value[i] : w->value[i + 1] <= w->value[i]))
    i++;
  return w->value[i];
}

int pendres_path_short(const pendres_path *w, const pendres_attractor *a)
{
  return pendres_attractor_closes(a) && a->orbit.period <= pendres_path_longest(w);
}

pendres_status pendres_path_orbit(pendres_path *w, size_t *i)
{
  const size_t start = *i;
  for (int ends = 0; ends < SWEEP_MOST_JUMPS && *i == start; ends++) {
    const double limit = turning_point(w, *i);
    const int direction = w->value[*i] >= w->at ? 1 : -1;
    pendres_status status = PENDRES_OK;
    /* A part leads one way, and to its limit. */
    if (w->part.branch != NULL &&
        (w->part.direction != direction || (w->part.end == PENDRES_PART_LIMIT &&
                                            !pendres_part_holds(&w->part, w->value[*i]))))
      pendres_part_free(&w->part);
    if (w->part.branch == NULL)
      status = pendres_part_from(w->ctx, &w->state.attractor.orbit, w->parameter, limit,
                                    &w->part);
    if (status != PENDRES_OK) return status;
    size_t last = held(w, *i);
    if (last > *i) {
      status = put_part(w, *i, last);
      if (pendres_path_own(status) && last > *i + 1) status = put_part(w, *i, last = *i + 1);
      *i = last;
    } else if (direction != pendres_path_direction(w, *i)) {
      return PENDRES_OK;
    } else if (w->part.end == PENDRES_PART_STOPPED) {
      /* Where the computation leads no further the pendulum settles at the next value. */
      status = pendres_part_extend(w->ctx, &w->part, limit);
      if (status != PENDRES_OK) pendres_part_free(&w->part);
      if (status != PENDRES_OK) return status == PENDRES_NOT_FOUND ? PENDRES_OK : status;
    } else {
      status = end_part(w, *i, limit);
    }
    if (status != PENDRES_OK || !pendres_path_short(w, &w->state.attractor)) return status;
  }
  return PENDRES_OK;
}
