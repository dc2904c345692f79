/*
 * carried.h -- the error of the integration that a lane carries, and whether it decides.
 *
 * Owns: how large it may be, and how exactly a lane is run again where it is larger.
 */
#ifndef PENDRES_CARRIED_H
#define PENDRES_CARRIED_H

#include <pendres/context.h>

/* Whether errors are propagated: not with adaptive steps, and not where the caller has given the
   number of steps, as the error of one such step is not known. */
int pendres_settle_carries(const pendres_context *ctx);

/* The variance of the error that a step adds. */
double pendres_settle_added(const pendres_context *ctx, double accuracy, int steps);

/* The error that a lane has carried, over the largest one that cannot change where it goes, from
   the largest variance that it has had so far. */
double pendres_settle_error_ratio(double worst);

/*
 * The error a period that should leave no label uncertain: a power of ten, so that many pendulums
 * share it and blocks stay full. Where the error has grown beyond all bounds, it is not known how
 * much more exact the next run must be: the most exact one follows. A ratio that was not kept, as
 * that of lanes whose attractor was searched for, is NaN, which leaves at_least.
 */
double pendres_settle_tighter(double accuracy, double error_ratio);

#endif
