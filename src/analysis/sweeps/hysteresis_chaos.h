/*
 * hysteresis_chaos.h -- where a pendulum goes from chaos, or from another state that cannot be
 * followed.
 */
#ifndef PENDRES_HYSTERESIS_CHAOS_H
#define PENDRES_HYSTERESIS_CHAOS_H

#include "analysis/sweeps/hysteresis_jump.h"

/* Whether a pendulum that settles on `there` has left a state that is not followed: for another
   closed orbit, for infinity, or from an orbit that could not be followed for anything else. */
int pendres_chaos_ends(const pendres_attractor *old, const pendres_attractor *there);

/*
 * A pendulum was in a state that is not followed at one value of a parameter, and has left it at
 * another value, that of state->pendulum. If it is on an orbit that is born between the two, or was
 * born of one that is, and goes to it just after its birth but not just before, its birth is where
 * the old state ends; so is the place where the doublings of its period accumulate. Otherwise the
 * interval is halved, since the pendulum may have gone to another orbit first.
 * *state becomes the first state that it goes to, at a value just after the end. Windows of orbits
 * that the halving does not meet are not found. A chaotic state that ends while the other state is
 * there on both sides ends in a crisis; the error then includes what the time leaves open for which
 * chaos is watched. Sets kind (which the caller has set to what it is otherwise), value,
 * value_error, from, to, to_period, share and certain of the jump.
 */
pendres_status pendres_chaos_end(pendres_context *ctx, pendres_parameter parameter,
                                 const pendres_arrival *old, double from, pendres_arrival *state,
                                 pendres_jump *jump);

/* n states that a pendulum in chaos comes through, at most LIVES, far enough apart for that to have
   lost its memory. */
pendres_status pendres_chaos_spread(pendres_context *ctx, const pendres_arrival *from, int n,
                                    double *x, double *v);

#endif
