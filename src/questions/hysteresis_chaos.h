/*
 * hysteresis_chaos.h -- where a pendulum comes from chaos, or from what cannot be followed, to an
 * orbit.
 */
#ifndef PENDRES_HYSTERESIS_CHAOS_H
#define PENDRES_HYSTERESIS_CHAOS_H

#include "questions/hysteresis_jump.h"

/*
 * A pendulum that was in a state without an orbit at a value of a parameter is on an orbit at
 * another, state->pendulum's. If that orbit is born between them, and the pendulum goes to it just
 * beyond and does not just before, that is where the state ends. Else this is halved down to, for
 * the pendulum may have gone to another orbit first, as to one of a higher period where a cascade
 * of doublings is met from its end: *state becomes the orbit that it goes to first, at a value just
 * behind, and windows of orbits that the halving does not meet are not told.
 * Sets value, value_error, from, to, to_period, share and certain of the jump.
 */
pendres_status pendres_chaos_end(pendres_context *ctx, pendres_parameter parameter,
                                 const pendres_settled *old, double from, pendres_settled *state,
                                 pendres_jump *jump);

#endif
