/* hysteresis_chaos.c -- from chaos to an orbit; see hysteresis_chaos.h. */
#include "questions/hysteresis_chaos.h"

#include <math.h>

#include "continuation/continuation_parameter.h"
#include "questions/stretch.h"

enum { HALVINGS = 8 /* of the distance of two values between which chaos ends */ };

/* The distance of trials from the birth of an orbit, in the parameter's scale. */
static const double beside = 1e-4;

/* Whether the orbit is born between the values, and the pendulum goes to it there. */
static pendres_status try_birth(pendres_context *ctx, pendres_parameter parameter,
                                const pendres_settled *old, double from,
                                const pendres_settled *state, pendres_jump *jump)
{
  const double to = pendres_parameter_get(parameter, &state->pendulum);
  const double small = beside * pendres_parameter_scale(parameter);
  const int direction = to > from ? 1 : -1;
  pendres_stretch s = pendres_stretch_none;
  pendres_settled before, behind;
  pendres_status status =
    pendres_stretch_from(ctx, &state->attractor.orbit, parameter, from, &s);
  if (status == PENDRES_OK && s.end == PENDRES_STRETCH_BIFURCATION &&
      fabs(to - s.end_value) > small && fabs(from - s.end_value) > small) {
    const double aside = direction * small;
    const pendres_pendulum p =
      pendres_parameter_with(&state->pendulum, parameter, s.end_value - aside);
    const pendres_pendulum q =
      pendres_parameter_with(&state->pendulum, parameter, s.end_value + aside);
    status = pendres_settled_find(ctx, &p, old->x, old->v, &before);
    if (status == PENDRES_OK) status = pendres_settled_find(ctx, &q, old->x, old->v, &behind);
    const pendres_orbit *born = &pendres_stretch_last(&s)->orbit;
    if (status == PENDRES_OK && !pendres_settled_closed(&before.attractor) &&
        pendres_settled_closed(&behind.attractor) &&
        behind.attractor.orbit.period == born->period) {
      jump->value = s.end_value;
      jump->value_error = s.end_error;
      jump->certain = 1;
      jump->share = 1.0;
    }
  }
  pendres_stretch_free(&s);
  return status;
}

/* Halve the interval from the last value known to be before the end to the first known to be after
   it. */
static pendres_status halve(pendres_context *ctx, pendres_parameter parameter,
                            const pendres_settled *old, double from, pendres_settled *state,
                            pendres_jump *jump)
{
  double to = pendres_parameter_get(parameter, &state->pendulum);
  pendres_settled before = *old;
  pendres_status status = PENDRES_OK;
  for (int k = 0; k < HALVINGS && status == PENDRES_OK; k++) {
    const double middle = 0.5 * (from + to);
    const pendres_pendulum p = pendres_parameter_with(&state->pendulum, parameter, middle);
    pendres_settled there;
    status = pendres_settled_find(ctx, &p, before.x, before.v, &there);
    if (status != PENDRES_OK) break;
    if (pendres_settled_closed(&there.attractor) &&
        !pendres_settled_alike(&there.attractor, &old->attractor)) {
      to = middle;
      *state = there;
    } else {
      from = middle;
      before = there;
    }
  }
  jump->value = 0.5 * (from + to);
  jump->value_error = 0.5 * fabs(to - from);
  return status;
}

pendres_status pendres_chaos_end(pendres_context *ctx, pendres_parameter parameter,
                                 const pendres_settled *old, double from, pendres_settled *state,
                                 pendres_jump *jump)
{
  jump->from = old->attractor.label;
  jump->share = NAN;
  jump->certain = 0;
  pendres_status status = PENDRES_OK;
  if (state->attractor.orbit.period <= PENDRES_HYSTERESIS_PERIOD)
    status = try_birth(ctx, parameter, old, from, state, jump);
  if (status == PENDRES_OK && !jump->certain)
    status = halve(ctx, parameter, old, from, state, jump);
  jump->to = state->attractor.label;
  jump->to_period = state->attractor.orbit.period;
  return status;
}
