/*
 * escape.h -- pendulums on their way to infinity, where a force lets them go.
 *
 * Owns: what is beyond all numbers, and what was for certain on its way there before.
 */
#ifndef PENDRES_ESCAPE_H
#define PENDRES_ESCAPE_H

#include <pendres/context.h>

#include "engine/strobe_run.h"

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
