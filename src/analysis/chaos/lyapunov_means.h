/*
 * lyapunov_means.h -- rotations that are not locked to the drive, by their means over time.
 *
 * Owns: whether the means of a runner are those of such a rotation or of chaos, by how many of
 * their digits are known (orbits/mean.h), and what errors of the integration do to them.
 */
#ifndef PENDRES_LYAPUNOV_MEANS_H
#define PENDRES_LYAPUNOV_MEANS_H

#include <pendres/lyapunov.h>

#include "analysis/chaos/lyapunov_runner.h"

/* To how much the mean turns a period of a rotation must be known at least. */
double pendres_means_least(void);
/* As exactly as is wanted: no more than what errors of the integration leave of them. */
double pendres_means_wanted(const pendres_context *ctx);

/* Whether a runner that has been averaged over this many periods is on such a rotation: its mean
   turns are known to `enough`. One whose mean is a fraction of small numbers is caught: it may be
   on its slow way to an orbit. */
int pendres_means_tell(pendres_runner *r, long periods, double enough, pendres_lyapunov *out);

/* Whether one that may be next to such a rotation is certainly on none: it is on chaos. */
int pendres_means_scatter(const pendres_runner *r, long periods);

/*
 * Average all of n runners that are `rough` again, over the same time with more steps. These means
 * take the place of the former ones, and their distance tells the error. A runner whose means do
 * not agree is unresolved, and moves on.
 */
pendres_status pendres_means_refine(pendres_context *ctx, size_t n, pendres_runner *runners,
                                    long batch, pendres_lyapunov *out);

#endif
