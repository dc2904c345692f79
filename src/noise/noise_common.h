/*
 * noise_common.h -- what all computations of noise around an attractor have in common.
 *
 * Owns: the ids of trajectories, how long they settle, how many steps a period they take, and the
 * parts into which they are divided.
 */
#ifndef PENDRES_NOISE_COMMON_H
#define PENDRES_NOISE_COMMON_H

#include <pendres/langevin.h>
#include <pendres/orbit.h>

#include "noise/numbers.h"

/* The first id of trajectories of a pendulum that start on attractor number `attractor` of its
 * set. Ids follow from the parameters, so that results do not depend on what else is computed. */
uint64_t pendres_noise_first_id(const pendres_pendulum *p, size_t attractor);

/* NULL, or why noise has no steady state around the attractors of a pendulum: beyond some position
   its force leads to infinity, or grow oscillations, and noise eventually drives it there. */
const char *pendres_noise_refuses(const pendres_pendulum *p);

/* Drive periods until the influence of the starting point on a cloud around the orbit has fallen to
   1e-5. */
long pendres_noise_settle(const pendres_orbit *orbit);

/*
 * Choose steps per period, in bias->steps_per_period: those of the request or, if these are 0,
 * enough for a bias of the statistics (a set of bits) that is below tolerance times their scale.
 * They are chosen at the request's temperature or, where that is too high, at a lower one. *bias
 * is the bias at the request's own temperature; its numbers are NaN if no trajectory stays on the
 * attractor there. If no number of steps meets the tolerance, the last one is taken; the bias
 * shows this.
 */
pendres_status pendres_noise_choose_steps(pendres_context *ctx,
                                          const pendres_langevin_request *request,
                                          unsigned statistics, double tolerance,
                                          pendres_langevin_bias *bias);

/* The search begins with the fewest steps that may resolve the well and the friction. */
int pendres_noise_first_steps(const pendres_pendulum *p);

/*
 * The same by linear theory, without trajectories, for an orbit whose relaxation takes so long that
 * the scatter of trajectories would hide a bias: steps with which the widths of a small cloud are
 * right to `tolerance`. 0 where there are none.
 */
pendres_status pendres_noise_steps_by_orbit(pendres_context *ctx, const pendres_orbit *orbit,
                                            double tolerance, int *steps);

/* Trajectories are divided into parts of at most `most`: how many parts there are, and of one part
 * the number of its first trajectory and how many it has. A part has two or more, if there are two
 * or more in all and `most` is 4 or more. */
size_t pendres_noise_parts(size_t trajectories, size_t most);
size_t pendres_noise_part(size_t trajectories, size_t most, size_t part, size_t *first);

/*
 * Solve sigma = M sigma M^T + Q (the discrete Lyapunov equation): sigma is the covariance that a
 * linear map M with noise of covariance Q settles to. m holds M row by row (xx, xv, vx, vv).
 *
 * Errors: PENDRES_INVALID_ARGUMENT; PENDRES_NOT_FOUND if M does not contract.
 */
pendres_status pendres_langevin_lyapunov(const double m[4], const pendres_langevin_covariance *q,
                                         pendres_langevin_covariance *sigma);

/*
 * The derivative M of a closed orbit over its cycle and the covariance that noise adds, in *out,
 * whether it is stable or not: its covariance then is not defined.
 *
 * Errors: PENDRES_TOLERANCE_UNREACHABLE.
 */
pendres_status pendres_noise_cycle(const pendres_pendulum *p, double x, double v, int cycle,
                                   pendres_langevin_linear *out);

/*
 * Merge n clouds of one pendulum, whose trajectories started at one point, into the cloud of all of
 * them. Errors of the parts combine as those of independent means. Parts that are empty, since all
 * trajectories have left, count in `left` and `exposure` only.
 *
 * Errors: PENDRES_INVALID_ARGUMENT if out is NULL, or parts is NULL and n > 0.
 */
pendres_status pendres_langevin_merge(size_t n, const pendres_langevin_cloud *parts,
                                      pendres_langevin_cloud *out);

/*
 * Bias of n = request->steps_per_period steps a period for the cloud of a request, from pairs of
 * trajectories with n and 2 n steps and the same noise. At order four their difference is 15/16 of
 * the bias; *bias holds 16/15 of it. The noise differs from that of pendres_langevin_cloud_find.
 *
 * Errors: as pendres_langevin_cloud_find.
 */
pendres_status pendres_langevin_measure_bias(pendres_context *ctx,
                                             const pendres_langevin_request *request,
                                             pendres_langevin_bias *bias);

/*
 * Rate of rare independent events, and its exact (Poisson) confidence interval of the given level,
 * 0 < level < 1. Garwood, Biometrika 28 (1936) 437; from 500 events on by Wilson and Hilferty's
 * approximation, whose error is below 1e-4 of the interval's width at levels from 0.1 to 0.999,
 * below 1e-3 beyond. events may be a fraction: a count divided by its dispersion.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (then all of *rate is NaN, unless rate is NULL),
 * PENDRES_OUT_OF_MEMORY.
 */
pendres_status pendres_langevin_rate(double events, double exposure, double level,
                                     pendres_langevin_interval *rate);

#endif
