/*
 * hysteresis_chaos.h -- where a pendulum goes from chaos, or from another state that cannot be
 * followed, to a closed orbit.
 */
#ifndef PENDRES_HYSTERESIS_CHAOS_H
#define PENDRES_HYSTERESIS_CHAOS_H

#include "questions/hysteresis_jump.h"

/*
 * A pendulum was in a state without a closed orbit at one value of a parameter, and is on an orbit
 * at another value, that of state->pendulum. If this orbit is born between the two, and the
 * pendulum goes to it just after its birth but not just before, its birth is where the old state
 * ends. Otherwise the interval is halved, since the pendulum may have gone to another orbit first,
 * say to one of a higher period if the parameter enters a cascade of doublings from its chaotic
 * end. *state becomes the first orbit that it goes to, at a value just after the end. Windows of
 * orbits that the halving does not meet are not found. Sets value, value_error, from, to,
 * to_period, share and certain of the jump.
 */
pendres_status pendres_chaos_end(pendres_context *ctx, pendres_parameter parameter,
                                 const pendres_settled *old, double from, pendres_settled *state,
                                 pendres_jump *jump);

#endif
