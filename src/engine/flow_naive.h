/*
 * flow_naive.h -- how one would integrate a pendulum without further thought: a yardstick.
 */
#ifndef PENDRES_FLOW_NAIVE_H
#define PENDRES_FLOW_NAIVE_H

#include <pendres/context.h>

#include "engine/strobe_run.h"

/* As pendres_strobe_run, by ARKODE with everything but the tolerance as it comes. */
pendres_status pendres_flow_naive_run(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                      pendres_strobe_visit *visit, void *arg);

#endif
