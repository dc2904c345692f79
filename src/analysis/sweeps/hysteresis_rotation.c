/* hysteresis_rotation.c -- rotations without a drive along a path; see hysteresis_rotation.h. */
#include "analysis/sweeps/hysteresis_rotation.h"

#include <math.h>

#include "base/angles.h"
#include "continuation/parameter.h"
#include "engine/context_internal.h"
#include "analysis/sweeps/hysteresis_left.h"
#include "analysis/sweeps/numbers.h"
#include "settling/exponents/undriven.h"

/* The lower equilibrium; at a torque of 1 exactly it is the upper one, too. */
static pendres_status stand_still(const pendres_path *w, double at, pendres_arrival *out)
{
  const pendres_pendulum p = pendres_path_pendulum(w, at);
  const pendres_orbit_guess guess = {
    .pendulum = p, .x = half_pi + asin(fmax(-1.0, fmin(1.0, p.torque))), .period = 1};
  pendres_orbit orbit;
  pendres_status outcome;
  const pendres_status status =
    pendres_orbit_find(w->ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome);
  if (status != PENDRES_OK) return status;
  *out = pendres_arrival_at(&p, guess.x, 0.0);
  if (outcome != PENDRES_NOT_CONVERGED && (orbit.stable || fabs(p.torque) == 1.0))
    out->attractor = pendres_arrival_orbit(&orbit);
  return PENDRES_OK;
}

/* Where rotations end. */
typedef struct rotation_limit {
  double value, error;      /* of the parameter */
  pendres_rotation_end end; /* how */
} rotation_limit;

/* The damping at which the least torque is that of p, between one with a rotation and one
   without. */
static pendres_status limit_of_damping(const pendres_pendulum *p, double with, double without,
                                       rotation_limit *out)
{
  pendres_rotation_onset o = {.torque = NAN};
  double slope = NAN;
  for (int k = 0; k < ITERATIONS; k++) {
    const double middle = 0.5 * (with + without);
    if (middle == with || middle == without) break;
    const double before = o.torque, from = out->value;
    out->value = middle;
    if (pendres_rotation_onset_find(middle, &o) != PENDRES_OK) return PENDRES_NOT_FOUND;
    if (middle != from && o.torque != before) slope = (o.torque - before) / (middle - from);
    if (o.torque <= fabs(p->torque)) with = middle;
    else without = middle;
    if (fabs(o.torque - fabs(p->torque)) <= o.torque_error) break;
  }
  out->end = PENDRES_ROTATION_HOMOCLINIC;
  out->error = fabs(with - without) + 2.0 * o.torque_error / fabs(slope);
  return isfinite(out->error) ? PENDRES_OK : PENDRES_NOT_FOUND;
}

/* The end between a value at which there is a rotation and one at which there is none, or one in
   the other direction. PENDRES_NOT_FOUND if the end does not depend on the parameter. */
static pendres_status limit_between(const pendres_path *w, double with, double without,
                                    rotation_limit *out)
{
  const pendres_pendulum *p = &w->pendulum;
  const pendres_parameter parameter = w->parameter;
  *out = (rotation_limit){.value = NAN, .error = NAN};
  if (parameter == PENDRES_DAMPING) return limit_of_damping(p, with, without, out);
  pendres_rotation_onset o;
  if (parameter != PENDRES_TORQUE) return PENDRES_NOT_FOUND;
  const pendres_status status = pendres_rotation_onset_find(p->damping, &o);
  if (status != PENDRES_OK) return status;
  *out = (rotation_limit){
    .value = copysign(o.torque, with), .error = o.torque_error, .end = o.end};
  return PENDRES_OK;
}

/* At value number i there is no rotation any more: the pendulum comes to rest. */
static pendres_status end_rotation(pendres_path *w, size_t i)
{
  rotation_limit limit;
  pendres_jump j = {.step = i, .direction = w->value[i] > w->at ? 1 : -1,
                    .kind = PENDRES_JUMP_OTHER, .from = w->state.attractor.label, .share = 1.0,
                    .certain = 1};
  pendres_status status = limit_between(w, w->at, w->value[i], &limit);
  double at = w->value[i];
  if (status == PENDRES_NOT_FOUND) { /* it ends somewhere in between */
    limit.value = 0.5 * (w->at + w->value[i]);
    limit.error = 0.5 * fabs(w->value[i] - w->at);
    status = PENDRES_OK;
  } else if (status == PENDRES_OK) {
    j.kind = limit.end == PENDRES_ROTATION_SADDLE_NODE ? PENDRES_JUMP_FOLD
                                                       : PENDRES_JUMP_HOMOCLINIC;
    const double step = just_beyond * pendres_parameter_scale(w->parameter);
    const double next = limit.value + j.direction * step;
    if ((at - next) * j.direction > 0.0) at = next;
  }
  if (status == PENDRES_OK) status = stand_still(w, at, &w->state);
  w->at = at;
  j.value = limit.value;
  j.value_error = limit.error;
  j.to = w->state.attractor.label;
  j.to_period = pendres_attractor_closes(&w->state.attractor) ? 1 : 0;
  if (status == PENDRES_OK) status = pendres_path_note(w, &j);
  pendres_path_leave(w);
  return status;
}

/* Value number i is the torque of 1, at which rotations end in a saddle-node: the pendulum is at
   rest there, and the path goes on in either direction. */
static pendres_status put_end(pendres_path *w, size_t i)
{
  const pendres_arrival rotating = w->state;
  const pendres_status status = stand_still(w, w->value[i], &w->state);
  if (status != PENDRES_OK) return status;
  pendres_path_leave(w);
  pendres_path_put(w, i, &w->state.attractor);
  pendres_path_leave(w);
  w->state = rotating;
  w->at = w->value[i];
  return PENDRES_OK;
}

pendres_status pendres_path_rotation(pendres_path *w, size_t *i)
{
  const int forwards = w->state.pendulum.torque > 0.0;
  pendres_status status = pendres_context_poll(w->ctx);
  for (; *i < w->n && status == PENDRES_OK; (*i)++) {
    const pendres_pendulum p = pendres_path_pendulum(w, w->value[*i]);
    const int same_way = (p.torque > 0.0) == forwards;
    pendres_rotation r;
    if (!pendres_undriven(&p)) {
      w->state.attractor = pendres_arrival_nothing(&p);
      return status;
    }
    if (!same_way) return end_rotation(w, *i);
    if (pendres_rotation_find(&p, &r, NULL) != PENDRES_OK) {
      if (fabs(p.torque) != 1.0) return end_rotation(w, *i);
      status = put_end(w, *i);
      continue;
    }
    w->state = pendres_arrival_turning(&p, &r);
    w->at = w->value[*i];
    pendres_path_put(w, *i, &w->state.attractor);
    status = pendres_context_poll(w->ctx);
  }
  return status;
}

void pendres_path_into_rotation(pendres_path *w, const pendres_bifurcation *end,
                                pendres_jump *jump, int *done)
{
  const pendres_orbit *o = &end->orbit;
  const pendres_rotation slowest = {.mean_velocity = NAN, .mean_velocity_error = NAN, .v = o->v};
  *done = end->kind == PENDRES_FOLD && end->parameter == PENDRES_TORQUE &&
          pendres_undriven(&o->pendulum) && o->period == 1 && o->winding == 0;
  if (!*done) return;
  w->state = pendres_arrival_turning(&o->pendulum, &slowest);
  jump->to = w->state.attractor.label;
  jump->to_period = 0;
  jump->share = 1.0;
  jump->certain = 1;
}
