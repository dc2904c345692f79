/*
 * settle.h -- settling many pendulums of many parameter sets at once.
 */
#ifndef PENDRES_SETTLE_H
#define PENDRES_SETTLE_H

#include "settling/settle_lanes.h"

/*
 * Label pendulums of parameter sets that have a set of attractors each. Attractors that are found
 * on the way are added to these sets. outcome[i].attractor is the number within its set.
 */
pendres_status pendres_settle_batch(pendres_context *ctx, size_t sets,
                                    pendres_attractor_set *attractor_sets,
                                    const pendres_settle_starts *starts,
                                    pendres_settled *outcome);

/* For how many periods pendulums are followed that may only settle on known attractors. */
typedef enum pendres_settle_budget {
  PENDRES_SETTLE_SHORT, /* enough for almost all pendulums; the others stay unresolved */
  PENDRES_SETTLE_FULL
} pendres_settle_budget;

/* Label pendulums of one parameter set, integrated with this error a period. The set of attractors
   is only read. */
pendres_status pendres_settle_known(pendres_context *ctx,
                                    const pendres_attractor_set *attractor_set,
                                    const pendres_settle_starts *starts, double accuracy,
                                    pendres_settle_budget budget, pendres_settled *outcome);

#endif
