/*
 * unstable.h -- pendulums that rest where nothing attracts.
 */
#ifndef PENDRES_UNSTABLE_H
#define PENDRES_UNSTABLE_H

#include <pendres/attractor.h>

#include "engine/strobe_run.h"

static const pendres_settled pendres_settle_unresolved = {
  .label = PENDRES_LABEL_UNRESOLVED, .attractor = PENDRES_ATTRACTOR_UNKNOWN,
  .settling_periods = -1};

/* Whether a lane is done: it is on an attractor, has escaped, or never leaves an unstable state. */
static inline int pendres_settle_ended(const pendres_settled *o)
{
  return o->attractor != PENDRES_ATTRACTOR_UNKNOWN;
}

/*
 * Of lanes that have not settled, label those that are at rest in an unstable state, without a
 * drive: they began there, or on its stable side, and never leave. For that they are watched for as
 * long as rounding would take to grow until it is seen. state: receives the state of each that is
 * labelled; may be NULL.
 */
pendres_status pendres_settle_unstable(pendres_context *ctx, size_t n,
                                       const pendres_strobe_lane *lanes, pendres_settled *outcome,
                                       pendres_orbit *state);

#endif
