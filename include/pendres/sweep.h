/**
 * @file sweep.h
 * @brief Many pendulums by number: axes of values, ensembles of starts, index arithmetic.
 *
 * Owns: which parameters and which initial state pendulum number i of a sweep has. Nothing is
 * integrated here and nothing is stored: a sweep of 2^60 pendulums costs as much as one of two.
 *
 * Thread safety: all functions are pure.
 */
#ifndef PENDRES_SWEEP_H
#define PENDRES_SWEEP_H

#include <stddef.h>
#include <stdint.h>

#include <pendres/parameter.h>
#include <pendres/status.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/**
 * Equally spaced values with exact ends; count 0: none, 1: only if both ends agree. Values that
 * are decimals are the doubles next to them, as if they had been listed: 0.06 to 1 in 95 values
 * holds 0.13.
 */
typedef struct pendres_range {
  double first; /**< the first value */
  double last;  /**< the last value, not below the first */
  size_t count; /**< how many values there are, both ends included */
} pendres_range;

/**
 * The values of an axis: the union of a list and a range, ascending, repeated values dropped:
 * those of the range within their rounding error of a listed one. A value of the range is the
 * shortest decimal within its rounding error: those of a range whose ends are multiplied by a power
 * of two may differ from its values times that in the last place.
 *
 * @param listed how many values list has
 * @param list   in any order; may be NULL if there are none
 * @param range  may be NULL
 * @param value  room for listed + range->count values; may be list itself if there is no range
 * @param count  receives how many there are
 * @return PENDRES_INVALID_ARGUMENT if anything is not finite or the range runs backwards
 */
pendres_status pendres_sweep_values(size_t listed, const double *list, const pendres_range *range,
                                    double *value, size_t *count);

/** One axis of a sweep: the values of one parameter. */
typedef struct pendres_axis {
  pendres_parameter parameter; /**< what it varies */
  size_t count;                /**< how many values it has */
  const double *value;         /**< [count], not owned */
} pendres_axis;

/** The product of some axes. Where parameters have no axis, `pendulum`, x and v hold. */
typedef struct pendres_sweep {
  pendres_pendulum pendulum; /**< parameters that no axis varies */
  double x;                  /**< initial position where no axis varies it, in rad */
  double v;                  /**< initial velocity, likewise, in rad per unit time */
  size_t axes;               /**< how many axes there are */
  pendres_axis axis[PENDRES_PARAMETER_COUNT]; /**< the last one runs fastest */
} pendres_sweep;

/**
 * How many pendulums a sweep has. PENDRES_INVALID_ARGUMENT if a parameter has two axes (the drive's
 * period and frequency are one here), an axis is empty, or the number does not fit.
 */
pendres_status pendres_sweep_count(const pendres_sweep *sweep, size_t *count);

/** Pendulum number `index` below that count, and its start; x and v may be NULL. All are NaN where
    there is no such pendulum, or that function refuses the sweep. */
pendres_pendulum pendres_sweep_pendulum(const pendres_sweep *sweep, size_t index, double *x,
                                        double *v);

/** How the starts of an ensemble lie. */
typedef enum pendres_ensemble_shape {
  PENDRES_ENSEMBLE_LINE = 0,  /**< member k at x_first + (x_last - x_first) k / members and v */
  PENDRES_ENSEMBLE_RECTANGLE, /**< the middles of `rows` rows of equal cells, of x_first to x_last
                                   and v to v_last, row by row from the lowest v on */
  PENDRES_ENSEMBLE_RANDOM,    /**< independent and evenly spread over the same rectangle */
  PENDRES_ENSEMBLE_SHAPE_COUNT /**< how many there are; not a shape */
} pendres_ensemble_shape;

/**
 * The starts of an ensemble, members k = 1..members. Those of a line are the ensemble itself. Those
 * of a rectangle, regular or random, are a sample of all states in it, and the errors of results
 * include the sampling error (pendres_response.sampling). If all fields after v are zero it is a
 * line.
 */
typedef struct pendres_ensemble {
  size_t members;               /**< how many starts there are */
  double x_first;               /**< lower end of the positions, in rad */
  double x_last;                /**< their upper end, in rad */
  double v;                     /**< velocity of a line; else the lowest, in rad per unit time */
  pendres_ensemble_shape shape; /**< how the starts lie */
  double v_last;                /**< the highest velocity; not of a line */
  size_t rows;                  /**< rows of a rectangle; a divisor of members */
  uint64_t seed;                /**< seed of random starts */
} pendres_ensemble;

/** The paper's: 200 members at rest over -pi/2 < x <= 3 pi/2. */
pendres_ensemble pendres_ensemble_default(void);

/**
 * The starts of 200 members at rest that the response of p spans: of an angle the paper's. Of
 * another force they are about x = 0, up to twice as far as drive and torque can carry it, or than
 * the length at which its terms are equal if that is less or a parametric drive acts. The paper's
 * if p is NULL or has no valid force. For several pendulums take the least damped and most driven.
 */
pendres_ensemble pendres_ensemble_of(const pendres_pendulum *p);

/**
 * Check an ensemble: members, finite starts, rows that fit, ascending bounds of a rectangle.
 * Otherwise PENDRES_INVALID_ARGUMENT, and *why (may be NULL) is a static sentence.
 */
pendres_status pendres_ensemble_check(const pendres_ensemble *e, const char **why);

/** Start of member k = 1..members; x and v may be NULL. NaN if there is no such member. */
void pendres_ensemble_start(const pendres_ensemble *e, size_t k, double *x, double *v);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
