/*
 * scatter.h -- how sums over the rows of a grid, or over random states, scatter.
 *
 * Owns: covariances from differences between consecutive groups, and the exponent of the shares of
 * uncertain states as a function of distance.
 *
 * A grid is not a random sample: slow changes over its rows are sampled well, and only differences
 * between neighbouring groups of rows are scatter. It is estimated from second differences between
 * groups, which eliminate a trend. As measured on grids that were shifted by fractions of a step,
 * such errors are 0.8 to 2 times the scatter; for independent groups they are the usual ones.
 * Source: Wolter, Introduction to Variance Estimation, 2nd edition (2007), section 8.2, on
 * systematic samples.
 */
#ifndef PENDRES_BASIN_SCATTER_H
#define PENDRES_BASIN_SCATTER_H

#include <pendres/basin.h>

/* Quantities of a group: counts of uncertain states at each distance, entropy, boundary boxes. */
enum {
  PENDRES_SCATTER_ENTROPY = PENDRES_BASIN_SCALES,
  PENDRES_SCATTER_BOUNDARY_BOXES,
  PENDRES_SCATTER_QUANTITIES
};

typedef struct pendres_scatter {
  size_t groups;
  double total[PENDRES_SCATTER_QUANTITIES];
  /* Set by the caller: of the counts at each distance, those with an uncertain outcome, which
     errors move across boundaries either way, and those with an unknown one. */
  double uncertain[PENDRES_BASIN_SCALES], unknown[PENDRES_BASIN_SCALES];
  double last[2][PENDRES_SCATTER_QUANTITIES]; /* the two groups before */
  double square[PENDRES_SCATTER_QUANTITIES][PENDRES_SCATTER_QUANTITIES]; /* of differences */
} pendres_scatter;

/* Add a group's quantities. */
void pendres_scatter_add(pendres_scatter *s, const double *group);

/* The variance of sum weight[k] total[k], with Student's factor; NaN if there are fewer than four
   groups. */
double pendres_scatter_variance(const pendres_scatter *s, const double *weight);

/*
 * The exponent alpha in f ~ distance^alpha over the smallest distances that are usable, from totals
 * of uncertain states and the numbers tried; NaN if fewer than three are.
 *
 * Its error consists of the scatter, of the differences between slopes at neighbouring distances
 * beyond their scatter, since a power law holds only within limits, and of the uncertain and
 * unknown states. The number of distances used, from the smallest on, is that with the least error.
 */
void pendres_scatter_exponent(const pendres_scatter *s, int scales, const double *distance,
                              const double *tried, double *exponent, double *error);

#endif
