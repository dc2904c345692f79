/**
 * @file dimension.h
 * @brief How many dimensions a chaotic attractor has.
 *
 * Owns: the correlation dimension of points in a plane, from how the number of close pairs grows
 * with distance, and the Lyapunov dimension, from exponents.
 *
 * Both are dimensions of the Poincaré section, between 0 and 2; the motion in time, of which the
 * section is a cut, has one more. The correlation dimension is at most the information dimension,
 * which as a rule is the Lyapunov dimension.
 *
 * Sources: Grassberger and Procaccia, Physical Review Letters 50 (1983) 346; Theiler, Journal of
 * the Optical Society of America A 7 (1990) 1055; Kaplan and Yorke, Lecture Notes in Mathematics
 * 730 (1979) 204.
 */
#ifndef PENDRES_DIMENSION_H
#define PENDRES_DIMENSION_H

#include <stddef.h>

#include <pendres/context.h>
#include <pendres/pendulum.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

enum { PENDRES_CORRELATION_SCALES = 64 /**< distances of a correlation sum at most */ };

/** The correlation dimension and the sums from which it comes. Plain data. */
typedef struct pendres_correlation {
  double dimension;       /**< correlation dimension; NaN if there are too few points */
  double dimension_error; /**< its error: two standard errors, and the difference of the dimension
                               between parts of the range of distances */
  double shortest;        /**< range of distances that the dimension comes from, lower end ... */
  double longest;         /**< ... and upper end; NaN without a dimension */
  int scales;             /**< how many distances follow */
  double distance[PENDRES_CORRELATION_SCALES];  /**< ascending, each sqrt(2) times the one before */
  double sum[PENDRES_CORRELATION_SCALES];       /**< share of pairs that are closer than that */
  double sum_error[PENDRES_CORRELATION_SCALES]; /**< standard error of the share */
} pendres_correlation;

/** A stroboscopic section: points in the order of time, as pendres_strobe_record() with one sample
    a period makes them. */
typedef struct pendres_section {
  size_t n;        /**< how many points */
  const double *x; /**< [n] positions */
  const double *v; /**< [n] velocities */
  double turn;     /**< length of the circle that x lies on: 2 pi for the pendulum; 0: x is not an
                        angle */
} pendres_section;

/**
 * The correlation dimension of the points of a section. Distances are sqrt(dx^2 + dv^2) with dx
 * taken around the circle. Distances below `resolution`, the error of the points, are not used (0:
 * all are).
 *
 * Pairs less than 32 apart in time are left out, as they are close for another reason. The
 * dimension is the slope of log sum against log distance, from a thirty-second of the points'
 * extent down to where some 500 pairs are left. Standard errors are those of a jackknife over 16
 * intervals of time; the difference of the slopes in the upper and the lower half of the range is
 * added, since sums of fractal sets oscillate about a straight line. The cost is n^2 / 2 distances
 * of some two nanoseconds each.
 *
 * The section is read, *out is written. Errors: PENDRES_INVALID_ARGUMENT (fewer than two points,
 * one that is not a number, a turn or a resolution below 0), PENDRES_OUT_OF_MEMORY,
 * PENDRES_INTERRUPTED. Thread safety: as for the context.
 */
pendres_status pendres_correlation_find(pendres_context *ctx, const pendres_section *section,
                                        double resolution, pendres_correlation *out);

/**
 * The Lyapunov dimension of a pendulum's attractor from its largest exponent per unit time, by
 * Kaplan and Yorke's formula. Areas shrink at the rate of the damping, so that the two exponents
 * add up to minus the damping, and an exponent L > 0 means a dimension 1 + L / (L + damping). It is
 * 0 where the exponent is negative: a periodic orbit.
 *
 * *error, if not NULL, receives its error for an error of the exponent, with the same confidence.
 * NaN, with the error NaN, if the pendulum is not valid, its damping is 0, or the exponent is NaN
 * or
 * 0. No other errors; thread safe.
 */
double pendres_lyapunov_dimension(const pendres_pendulum *p, double exponent,
                                  double exponent_error, double *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
