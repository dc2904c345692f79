/*
 * escape.h -- pendulums on their way to infinity, where a force lets them go.
 *
 * Owns: what is beyond all numbers, and what was for certain on its way there before.
 */
#ifndef PENDRES_ESCAPE_H
#define PENDRES_ESCAPE_H

#include <pendres/context.h>

#include "engine/strobe_run.h"

/*
 * Motions beside a spring that a parametric drive makes grow: a force that is a spring a1 y but for
 * a part that has a bound. Strobe points with |by_y y + by_w w| > 1 go on to infinity for certain;
 * both are 0 where none do.
 */
typedef struct pendres_escape_beside {
  double by_y, by_w;
} pendres_escape_beside;

/* Nothing is integrated for a pendulum without such a force, or without such a drive. */
pendres_status pendres_escape_beside_find(pendres_context *ctx, const pendres_pendulum *p,
                                          pendres_escape_beside *out);

/* Whether a pendulum at a strobe point is on its way to infinity for certain. */
int pendres_escape_certain(const pendres_pendulum *p, const pendres_escape_beside *beside, double y,
                           double w);

/* Whether pendulums of this force may escape at all: others turn round instead. */
int pendres_escape_possible(const pendres_pendulum *p);

/* Whether a state of a pendulum that may escape is beyond all lengths of its force, or no number.
 */
int pendres_escape_lost(double y, double w);

/* *away: whether a lane that is lost was on its way to infinity for certain at a step of its last
   period, which began at y and w. */
pendres_status pendres_escape_within(pendres_context *ctx, const pendres_strobe_lane *lane,
                                     double y, double w, int *away);

#endif
