/*
 * strobe_run.h -- the engine under every analysis: lanes run from strobe to strobe.
 *
 * A caller passes a list of lanes and a function that is called for each of them after every drive
 * period and returns whether the lane is done.
 */
#ifndef PENDRES_STROBE_RUN_H
#define PENDRES_STROBE_RUN_H

#include <pendres/context.h>
#include <pendres/pendulum.h>

#include "engine/method.h"

/*
 * Run n lanes with the context's method, at the context's tolerance, until visit() has returned for
 * each of them that it is done. Lanes keep their final state.
 */
pendres_status pendres_strobe_run(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                  pendres_strobe_visit *visit, void *arg);

/* Run them to the end of that period. */
pendres_status pendres_strobe_run_until(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                        long period);

/* Run only those n of these lanes whose numbers are in `which`. */
pendres_status pendres_strobe_run_some(pendres_context *ctx, size_t n, const size_t *which,
                                       pendres_strobe_lane *lanes, pendres_strobe_visit *visit,
                                       void *arg);

/* Run all of them at another tolerance, which matters for methods that choose their own steps. */
pendres_status pendres_strobe_run_within(pendres_context *ctx, double tolerance, size_t n,
                                         pendres_strobe_lane *lanes, pendres_strobe_visit *visit,
                                         void *arg);

/*
 * Choose the steps of a lane as pendres_steps_choose() does, and the fastest way that is as exact
 * in so many: for bulk work, from which no published digit comes.
 */
pendres_status pendres_strobe_choose(pendres_context *ctx, double speed, double tolerance,
                                     pendres_strobe_lane *lane);
/* That way: a Nystrom method (kernels_nystrom.h), unless the caller has asked for a method, a table
   or steps, or there is friction other than damping x'. Without a drive, what is at rest stays
   there by tables alone. */
pendres_flow_way pendres_strobe_way(const pendres_context *ctx, const pendres_pendulum *p);

/* The speed up to which single precision is exact enough. */
double pendres_strobe_single_fastest(const pendres_pendulum *p);

/* Choose both for a lane in chaos, where a trajectory counts only as one of many: such an error a
   period of what does not depend on where it is, as exponents. No errors are carried. */
pendres_status pendres_strobe_choose_average(pendres_context *ctx, double speed, double tolerance,
                                             pendres_strobe_lane *lane);

/* A lane at a state (x, v), without its whole turns; the caller sets steps and errors. */
pendres_strobe_lane pendres_strobe_lane_at(const pendres_pendulum *p, double x, double v);
/* The present state of a lane. */
void pendres_strobe_lane_out(const pendres_strobe_lane *l, double *x, double *v);

/*
 * The error estimate of a run at this distance from a more exact one. The error of the more exact
 * run is less than half of the other's: with twice the steps a hundredth or less at order eight, a
 * thirtieth at order five; with a tenth of the tolerance somewhat more than a tenth. The distance
 * is therefore at least half the error. Runs that are a tenth of a radian apart have separated, and
 * the estimate is infinite.
 */
double pendres_strobe_error(double distance);

/* Fail with the message that the state of a pendulum is not a number after `period` periods. */
pendres_status pendres_strobe_lost(pendres_context *ctx, const pendres_pendulum *p, long period);

#endif
