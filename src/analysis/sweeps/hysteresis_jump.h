/*
 * hysteresis_jump.h -- where a pendulum goes when the state that it is in ends.
 *
 * Owns: the trials that decide it.
 */
#ifndef PENDRES_HYSTERESIS_JUMP_H
#define PENDRES_HYSTERESIS_JUMP_H

#include <pendres/hysteresis.h>

#include "settling/arrival.h"

/* Find where most trials go from an orbit that ends at a bifurcation; where only the place of the
   end is known, at->orbit is the last orbit known before it. Sets to, share and certain of the
   jump. */
pendres_status pendres_jump_try(pendres_context *ctx, const pendres_bifurcation *at, int direction,
                                pendres_arrival *to, pendres_jump *jump);

/* The same of one pendulum, which was in the state jump->from, from as many states as a jump has
   trials. */
pendres_status pendres_jump_try_from(pendres_context *ctx, const pendres_pendulum *p,
                                     const double *x, const double *v, pendres_arrival *to,
                                     pendres_jump *jump);

#endif
