/*
 * lyapunov_watch.h -- whether chaos stays as it is.
 *
 * Owns: how sums of batches show a change in the course of time, and following chaotic pendulums on
 * after their exponent is known. That takes states alone. What has turned into something else has
 * another mean square of its velocity, or turns by another angle.
 */
#ifndef PENDRES_LYAPUNOV_WATCH_H
#define PENDRES_LYAPUNOV_WATCH_H

#include "analysis/chaos/lyapunov_runner.h"

/* The mean of the batches' sums a period, and its standard error. */
double pendres_batches_mean(const double sum[PENDRES_RUNNER_BATCHES], long batch, double *error);

/*
 * Whether batches before and after some one of them differ by more than chance makes them, by
 * Student's t of the means of both parts. Such a pendulum has gone from one chaotic motion to
 * another, and its mean is that of neither. Source: Worsley, Journal of the American Statistical
 * Association 74 (1979) 365.
 */
int pendres_batches_change(const double sum[PENDRES_RUNNER_BATCHES]);

/*
 * Follow the runners with the numbers `which`, whose averages over batches of `batch` periods are
 * known, for this many batches' worth more. Those that do not go on as they were are left moving,
 * away, lost or, where they have come back, caught; the others keep their state.
 */
pendres_status pendres_runners_watch(pendres_context *ctx, size_t n, const size_t *which,
                                     pendres_runner *runners, long batch, long longer);

#endif
