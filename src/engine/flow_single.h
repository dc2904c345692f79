/*
 * flow_single.h -- the methods to compare with: one ARKODE or CVODE
 * problem a pendulum.
 */
#ifndef PENDRES_FLOW_SINGLE_H
#define PENDRES_FLOW_SINGLE_H

#include <pendres/context.h>

#include "engine/strobe_run.h"

/* As pendres_strobe_run, by the context's method, one of the singles. */
pendres_status pendres_flow_single_run(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                       pendres_strobe_visit *visit, void *arg);

#endif
