/**
 * @file basin.h
 * @brief Basins of attraction over a grid of initial states, and their statistics.
 *
 * Owns: labelling of grids in pieces, adaptive refinement, basin fractions, boundary basin
 * entropy, and the uncertainty exponent of the boundary.
 *
 * A grid is worked on row by row (a row has one x and all v), so that memory stays bounded
 * whatever its size, in any number of threads:
 *
 *   1. pendres_basin_attractors: the set of attractors, from initial guesses spread over the grid
 *   2. pendres_basin_rows: most states settle within a short budget; the few others are marked
 *      as deferred, so that they do not hold up the rest
 *   3. pendres_basin_states: the deferred ones, many at a time, with all their budget
 *   4. what is still unresolved: pendres_basin_extend; if it finds an attractor, all again
 *
 * pendres_basin_find does these steps on one thread for a grid that fits into memory.
 * Results depend only on the grid, its attractors and the tolerance, not on how it is divided.
 */
#ifndef PENDRES_BASIN_H
#define PENDRES_BASIN_H

#include <stdint.h>

#include <pendres/attractor.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** When two states are alike: what statistics count as the same outcome. */
typedef enum pendres_basin_end {
  PENDRES_BASIN_BY_ATTRACTOR = 0, /**< when they settle on the same attractor modulo one turn */
  PENDRES_BASIN_BY_WELL,          /**< when they settle on it in the same well, too */
  PENDRES_BASIN_END_COUNT         /**< how many there are */
} pendres_basin_end;

/** States (x[i], v[j]) at drive phase 0, 0 <= i < nx, 0 <= j < nv; number i * nv + j. */
typedef struct pendres_basin_grid {
  size_t nx;       /**< how many positions */
  size_t nv;       /**< how many velocities */
  const double *x; /**< [nx] positions, rad; not owned */
  const double *v; /**< [nv] velocities; not owned */
  pendres_basin_end by; /**< what statistics of the grid count as the same outcome; labels do not
                             depend on it */
} pendres_basin_grid;

/** How a state was found. */
typedef enum pendres_basin_how {
  PENDRES_BASIN_INTEGRATED = 0, /**< by integration, and it is certain */
  PENDRES_BASIN_FILLED = 1,  /**< copied from its neighbours (only in refinement) */
  PENDRES_BASIN_DEFERRED = 2, /**< not settled within the short budget of pendres_basin_rows */
  PENDRES_BASIN_UNCERTAIN = 3, /**< integrated, but may belong to another basin: the errors that it
                                    carried were not small (pendres_settled.certain) */
  PENDRES_BASIN_HOW_COUNT      /**< how many there are */
} pendres_basin_how;

/** The outcome for a state; compact, since there are many. */
typedef struct pendres_basin_state {
  int32_t well;             /**< as in pendres_settled; a state that settles in a well whose number
                                 needs more than 32 bits is unresolved */
  int32_t settling_periods; /**< -1: unresolved; -2: filled */
  int16_t attractor;        /**< index in the set; PENDRES_ATTRACTOR_UNKNOWN (deferred, too),
                                 PENDRES_ATTRACTOR_ESCAPED or PENDRES_ATTRACTOR_UNSTABLE */
  int8_t label;             /**< a pendres_label */
  int8_t how;               /**< a pendres_basin_how */
} pendres_basin_state;

/**
 * The attractors that the states of a grid go to, from initial guesses spread evenly over it. *out
 * is to be freed by pendres_attractors_free.
 */
pendres_status pendres_basin_attractors(pendres_context *ctx, const pendres_pendulum *p,
                                        const pendres_basin_grid *grid, pendres_attractors **out);

/**
 * Rows first .. first + rows - 1 of a grid; state[rows * nv] is written. Where very many do not
 * settle soon they are given all their budget immediately, and none is deferred.
 */
pendres_status pendres_basin_rows(pendres_context *ctx, const pendres_attractors *set,
                                  const pendres_basin_grid *grid, size_t first, size_t rows,
                                  pendres_basin_state *state);

/** States number index[0 .. n) of a grid, with all their budget; state[n] is written. */
pendres_status pendres_basin_states(pendres_context *ctx, const pendres_attractors *set,
                                    const pendres_basin_grid *grid, size_t n,
                                    const size_t *index, pendres_basin_state *state);

/**
 * Look for further attractors from the states index[0 .. n) of a grid. *grown: how many were
 * found; if any, all numbers of attractors may have changed.
 */
pendres_status pendres_basin_extend(pendres_context *ctx, pendres_attractors *set,
                                    const pendres_basin_grid *grid, size_t n,
                                    const size_t *index, size_t *grown);

/** A whole grid in memory on this thread; state[nx * nv] is written, *set may grow. */
pendres_status pendres_basin_find(pendres_context *ctx, pendres_attractors *set,
                                  const pendres_basin_grid *grid, pendres_basin_state *state);

/* ---- Refinement ------------------------------------------------------------------------------ */

/**
 * Opaque: a plan by which the labels of rows of a grid are found without integrating all states. A
 * coarse lattice is integrated first. Cells whose corners differ are halved down to single states;
 * the other states are filled in. Finally every state that was filled in and has a neighbour of
 * another label is integrated, until there is none, so that a boundary that has been met anywhere
 * is followed to its end. Pieces of a basin that fit between the points of the coarse lattice can
 * be missed. pendres_basin_plan_sample() searches for them; it is to be called again after the
 * boundary of what it has found was followed, until a sample has no wrong state.
 * pendres_basin_plan_suspected() then says how many wrong states may be left.
 */
typedef struct pendres_basin_plan pendres_basin_plan;

/** A plan for rows first .. first + rows - 1. stride is the spacing of the coarse lattice, a power
 * of 2 (0: 16). The arrays of grid must outlive the plan. */
pendres_status pendres_basin_plan_create(const pendres_basin_grid *grid, size_t first,
                                         size_t rows, int stride, pendres_basin_plan **out);
/** NULL is allowed. */
void pendres_basin_plan_free(pendres_basin_plan *plan);

/**
 * The states to be integrated next (by pendres_basin_states, in any number of pieces): their
 * numbers in the grid, *n of them, owned by the plan. *n = 0: all states are known.
 */
pendres_status pendres_basin_plan_next(pendres_basin_plan *plan, size_t *n, const size_t **index);
/** Give the plan the results for these states, in their order. */
pendres_status pendres_basin_plan_accept(pendres_basin_plan *plan,
                                         const pendres_basin_state *state);

/**
 * Draw up to n different states that were filled in, evenly over the rows; *drawn receives how
 * many. The caller integrates them and passes the results to pendres_basin_plan_verify(), which
 * counts those that had been filled in wrongly; the others stay filled in. If any were wrong,
 * pendres_basin_plan_next() asks for all filled-in states within one lattice spacing around them,
 * and for a lattice of half the spacing everywhere. With the default stride, therefore, after at
 * most five samples the last one has no wrong state, or all states have been integrated.
 */
pendres_status pendres_basin_plan_sample(pendres_basin_plan *plan, size_t n, uint64_t seed,
                                         size_t *drawn, const size_t **index);
/** Give the plan the results for the states drawn by pendres_basin_plan_sample(); *missed receives
    how many of them had been filled in wrongly. */
pendres_status pendres_basin_plan_verify(pendres_basin_plan *plan,
                                         const pendres_basin_state *state, size_t *missed);

/** All states of the plan's rows, filled in or integrated; state[rows * nv] is written. */
pendres_status pendres_basin_plan_states(const pendres_basin_plan *plan,
                                         pendres_basin_state *state);
/** The same of some rows, counted from the first of the plan; state[rows * nv] is written. Several
    threads may ask at a time. */
pendres_status pendres_basin_plan_rows(const pendres_basin_plan *plan, size_t first, size_t rows,
                                       pendres_basin_state *state);
/** How many of them were integrated. */
size_t pendres_basin_plan_integrated(const pendres_basin_plan *plan);
/** How many are filled in. */
size_t pendres_basin_plan_filled(const pendres_basin_plan *plan);
/**
 * How many of `filled` states that were filled in may be wrong at most, with a confidence of 95 %,
 * if none of a sample of `drawn` was: filled * 3 / drawn (Hanley and Lippman-Hand, JAMA 249 (1983)
 * 1743), and not more than filled.
 */
double pendres_basin_plan_suspected(size_t filled, size_t drawn);

/* ---- Statistics ------------------------------------------------------------------------------ */

enum {
  PENDRES_BASIN_BOX = 5,      /**< states a side of a box of the entropy */
  PENDRES_BASIN_SCALES = 12   /**< distances 1, 2, 4, ... grid steps at most */
};

/** Statistics of a grid. Two states are alike when they have the same attractor, or, by well, the
    same attractor and well. */
typedef struct pendres_basin_statistics {
  size_t states;                   /**< number of states of the grid */
  size_t unresolved;               /**< how many of them are unresolved */
  double entropy;                  /**< basin entropy: mean over boxes of 5 x 5 states of
                                        -sum p log p, p the shares of outcomes in the box */
  double entropy_error;            /**< its error */
  double boundary_entropy;         /**< the same over boxes with unlike states; more than log 2: a
                                        fractal boundary. NaN without any */
  double boundary_entropy_error;   /**< its error */
  double boundary_boxes;           /**< share of boxes with unlike states */
  double uncertainty_exponent;     /**< alpha in f ~ distance^alpha over the smallest usable
                                        distances; NaN without a boundary. Strands that accumulate
                                        at a curve make f ~ d log 1/d: alpha is then below its
                                        limit 1 by 1 / log(1/d) at any distance d */
  double uncertainty_exponent_error; /**< its error */
  int scales;                      /**< how many distances there are */
  double distance[PENDRES_BASIN_SCALES];  /**< [scales] distances d in v */
  double uncertain[PENDRES_BASIN_SCALES]; /**< [scales] f: share of states with an unlike one at
                                               that distance */
  double uncertain_error[PENDRES_BASIN_SCALES]; /**< [scales] errors of these */
  size_t uncertain_states;         /**< integrated ones that may belong to another basin */
  size_t escaped;                  /**< those on their way to infinity: a separate outcome */
  double escape_fraction;          /**< their share of the window's area */
  double escape_fraction_error;    /**< its error */
} pendres_basin_statistics;

/** A well that states of a basin settle in. */
typedef struct pendres_basin_well {
  int attractor; /**< its number in the set */
  long well;     /**< number of the well, at x = pi/2 + 2 pi well; 0 alone for running and chaotic
                      attractors */
  size_t states; /**< how many states of the grid settle in it */
  double fraction;       /**< their share of the area, as of an attractor */
  double fraction_error; /**< its error; only uncertain states of the well itself count in it */
} pendres_basin_well;

/**
 * Opaque: sums over the rows of a grid. Where v is not evenly spaced there is no uncertainty
 * exponent.
 *
 * Errors are those of sampling the window by this grid: the scatter of results over grids that are
 * shifted by a fraction of their step. They are standard errors from the scatter between groups of
 * rows around their trend, for fractions two standard errors; NaN where a grid has fewer than 20
 * rows. Uncertain states contribute to all of them. The error of an uncertainty exponent includes
 * the differences between slopes over the distances used. It does not include the distance from a
 * limit far below the grid's step, which pendres_basin_uncertainty() examines.
 *
 * Sources: Daza, Wagemakers, Georgeot, Guéry-Odelin, Sanjuán, Scientific Reports 6 (2016) 31416;
 * McDonald, Grebogi, Ott, Yorke, Physica D 17 (1985) 125.
 */
typedef struct pendres_basin_sums pendres_basin_sums;

/** Sums without any rows yet, for a set of `attractors` attractors. *out is to be freed by
    pendres_basin_sums_free(). PENDRES_INVALID_ARGUMENT, PENDRES_OUT_OF_MEMORY: *out is NULL. */
pendres_status pendres_basin_sums_create(const pendres_basin_grid *grid, size_t attractors,
                                         pendres_basin_sums **out);
/** NULL is allowed. */
void pendres_basin_sums_free(pendres_basin_sums *sums);
/** Add the next rows, in their order from row 0 on. */
pendres_status pendres_basin_sums_add(pendres_basin_sums *sums, size_t rows,
                                      const pendres_basin_state *state);
/**
 * Allow for `states` states of the rows added that may be labelled wrongly without being known as
 * uncertain (pendres_basin_plan_suspected()); all errors include them.
 */
pendres_status pendres_basin_sums_suspect(pendres_basin_sums *sums, double states);
/**
 * fraction[attractors] and error[attractors] (either may be NULL): shares of the area from the
 * first to the last x and v, where each state stands for the points that are nearest to it. States
 * at the ends of a range therefore have half the weight of others; pendres_basin_sums_counts() has
 * plain numbers. To be called after all rows were added, like the functions below.
 */
pendres_status pendres_basin_sums_result(const pendres_basin_sums *sums,
                                         pendres_basin_statistics *out, double *fraction,
                                         double *error);

/** states[attractors] receives how many states of the grid go to each attractor. */
pendres_status pendres_basin_sums_counts(const pendres_basin_sums *sums, size_t *states);
/**
 * The wells that states go to, by attractor, then by well: *n of them, owned by the sums, valid
 * until the next call. Fractions and counts of attractors are modulo one turn, and so are all
 * statistics unless they are by well.
 */
pendres_status pendres_basin_sums_wells(pendres_basin_sums *sums, size_t *n,
                                        const pendres_basin_well **wells);

/** A window of initial states. */
typedef struct pendres_basin_window {
  double x_low;  /**< lowest position, rad */
  double x_high; /**< highest position, rad */
  double v_low;  /**< lowest velocity */
  double v_high; /**< highest velocity */
  pendres_basin_end by; /**< when two states of it are alike */
} pendres_basin_window;

/** Random states of a window, each with neighbours at v + distance[k] and v - distance[k]. */
typedef struct pendres_basin_sample {
  size_t n;               /**< how many states */
  uint64_t seed;          /**< of the random numbers */
  int scales;             /**< how many distances, PENDRES_BASIN_SCALES at most */
  const double *distance; /**< [scales], not kept; meaningless near rounding, some 1e-12 */
} pendres_basin_sample;

/**
 * The uncertainty exponent from random states of a window, each compared with its neighbours. If
 * they take too long to settle, as in chaos that ends late, or if more than half of them are
 * uncertain at nearly all distances, only the first of them are used; the field `states` says how
 * many. The fields states, unresolved, uncertain_states, uncertainty_exponent, distance and
 * uncertain are set; others are NaN or 0. Whatever the tolerance, labels are made certain down to
 * rounding; states whose outcome depends on rounding, or that settle too late, enter the errors.
 * PENDRES_NOT_FOUND: there are too few distances at which the boundary is met often enough for a
 * count, but by fewer than half of the states (shares near one are not a power of the distance).
 */
pendres_status pendres_basin_uncertainty(pendres_context *ctx, const pendres_attractors *set,
                                         const pendres_basin_window *window,
                                         const pendres_basin_sample *sample,
                                         pendres_basin_statistics *out);

/**
 * Replace the uncertainty exponent of a grid's statistics by that from random states of its window,
 * where these give more information on that limit than the grid. A fractal boundary may fill a grid
 * at every distance that the grid has, or its share may not yet be a power of the distance, while
 * random states meet it at distances far below the grid's step; a smooth boundary they meet too
 * rarely there.
 *
 * @param ctx        belongs to one thread at a time; its tolerance changes nothing
 * @param set        the attractors that the grid was settled on; read
 * @param grid       the grid that the statistics are of: its first and last x and v, and `by`
 * @param statistics those of pendres_basin_sums_result(); replaced are uncertainty_exponent,
 *                   scales, distance and uncertain, with their errors, or nothing is
 * @param states     written: how many random states these are from; 0: they are the grid's own
 * @return PENDRES_OK also where random states give no exponent; PENDRES_INVALID_ARGUMENT (ctx, set,
 *         grid, its values, statistics or states are NULL, or the grid spans no window), and
 *         failures of the integration: the statistics are as they were. Bounded in work as
 *         pendres_basin_uncertainty() is.
 */
pendres_status pendres_basin_statistics_refine(pendres_context *ctx, const pendres_attractors *set,
                                               const pendres_basin_grid *grid,
                                               pendres_basin_statistics *statistics,
                                               size_t *states);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
