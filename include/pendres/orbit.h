/**
 * @file orbit.h
 * @brief Periodic orbits of the driven pendulum and their measures.
 *
 * Owns: Newton's method on the stroboscopic map with the variational equations,
 * Floquet multipliers, and everything measured on a closed orbit: amplitude,
 * phase lag, loop area, dissipation, harmonics.
 *
 * An orbit of period q and winding p closes after q drive periods, in which the
 * angle grows by 2 pi p. Definitions, all a drive cycle (theta = omega t):
 *
 *   loop area     A = (1/q) closed integral of F dx, F = F0 cos theta
 *   dissipation   D = (gamma/q) closed integral of v^2 dt; equal to A on a closed orbit, with a
 *                 torque or a parametric drive to A plus the work of these: the difference is a
 *                 check at no cost (energy balance)
 *   mean power    P = A omega / (2 pi)
 *   amplitude     half the peak-to-peak of the angle (of its periodic part if p != 0)
 *   first harmonic of the angle, a cos theta + b sin theta = R cos(theta - phi):
 *                 R its amplitude, phi in [0, pi] the phase lag behind the force (with F0 < 0
 *                 it is that of minus the angle; torque or parametric drive may make A negative,
 *                 and phi then is in (-pi, 0)); A = pi F0 b
 *
 * Samples are equally spaced over the closed orbit, so that all of these are
 * spectrally accurate. Floquet multipliers are the eigenvalues of the derivative of
 * the q-th iterate of the map; their product is exp(-gamma q tau) (Liouville).
 *
 * Errors: a result x has its error estimate in x_error, from repeating the computation with 1.4
 * times the steps a period, plus an estimate of rounding. See docs/accuracy.md.
 */
#ifndef PENDRES_ORBIT_H
#define PENDRES_ORBIT_H

#include <pendres/context.h>
#include <pendres/pendulum.h>
#include <pendres/strobe.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

enum { PENDRES_ORBIT_HARMONICS = 24 /**< harmonics of an orbit that are kept */ };

/** A periodic orbit with its measures. Plain data, nothing to free. */
typedef struct pendres_orbit {
  pendres_pendulum pendulum; /**< the parameters at which the orbit exists */
  double x;                  /**< position of the Poincaré point at drive phase 0, in rad; the
                                  orbit's mean angle lies in the well number 0 */
  double v;                  /**< velocity there, in rad per unit time */
  double x_error;            /**< error of x */
  double v_error;            /**< error of v */
  int period;                /**< q: drive periods until it closes */
  int winding;               /**< p: whole turns in q drive periods */
  int symmetric;             /**< 1: its own mirror image, period half drive periods later */
  int stable;                /**< 1: both Floquet multipliers inside the unit circle */
  double multiplier_re[2];   /**< real parts of the Floquet multipliers, largest modulus first */
  double multiplier_im[2];   /**< their imaginary parts */
  double multiplier_error;   /**< the larger error of the two */
  double monodromy[2][2];    /**< derivative of (x, v) after q periods by (x, v) */
  double loop_area;          /**< A = (1/q) closed integral of F dx a drive cycle, in m g l */
  double loop_area_error;    /**< its error */
  double dissipation;        /**< D = (gamma/q) closed integral of v^2 dt, in m g l */
  double dissipation_error;  /**< its error */
  double mean_power;         /**< P = A omega / (2 pi), in m g l omega_0 */
  double mean_power_error;   /**< its error */
  double amplitude;          /**< half the peak-to-peak of the angle, in rad */
  double amplitude_error;    /**< its error */
  double first_harmonic_amplitude;       /**< R of the angle's first harmonic, in rad */
  double first_harmonic_amplitude_error; /**< its error */
  double phase_lag;          /**< phi behind the force, in rad; NaN without drive or harmonic */
  double phase_lag_error;    /**< its error */
  double mean_angle;         /**< mean of x - pi/2 (of its periodic part), within (-pi, pi]; of x
                                  where the coordinate has no period */
  double cosine[PENDRES_ORBIT_HARMONICS]; /**< [m - 1]: the factor of cos(m theta) in the angle
                                  averaged over the orbit's q drive cycles, in rad */
  double sine[PENDRES_ORBIT_HARMONICS];   /**< [m - 1]: that of sin(m theta) */
  double frequency_derivative[2];  /**< d(x, v)/d omega of the strobe point; NaN unless asked for */
  double loop_area_slope;          /**< dA/d omega along the branch, NaN if not asked for */
  double loop_area_slope_error;    /**< its error */
  int steps;                 /**< steps a period of the finer computation */
  double harmonics_rest;     /**< bounds what the harmonics that are not kept add to the angle,
                                  averaged over the drive cycles */
  double torque_work;        /**< work of the torque per drive cycle, exactly 2 pi I p / q */
  double parametric_work;    /**< work of the parametric drive per drive cycle, in m g l */
  double parametric_work_error; /**< its error */
  double spare[16];          /**< 0: measures of later versions take the first places, so that size
                                  and fields of this and of all that holds an orbit stay */
} pendres_orbit;

/** A measure of orbits: its position in a pendres_orbit. */
typedef struct pendres_orbit_quantity {
  const char *name;       /**< of the field, of variables in files, and for pendres_quantity_of():
                               words, definition and dimension */
  size_t value;           /**< offset in bytes of the value, a double */
  size_t error;           /**< offset of its error; PENDRES_ORBIT_EXACT: it is
                               exact except for rounding */
  int principal;          /**< 1: one of the few by which orbits are most easily distinguished */
  int of_forces;          /**< 1: zero without a torque, a parametric drive or another force */
} pendres_orbit_quantity;

/** Stands in place of the offset of an error. */
#define PENDRES_ORBIT_EXACT ((size_t)-1)

/**
 * The measures of orbits by number, from 0 on; NULL beyond the last. Nothing is to be freed; any
 * thread may call it. A program that lists or stores measures in this way includes those of later
 * versions, too.
 */
const pendres_orbit_quantity *pendres_orbit_quantity_get(size_t number);

/** Where to look for an orbit. */
typedef struct pendres_orbit_guess {
  pendres_pendulum pendulum; /**< the parameters */
  double x;    /**< position near the orbit's Poincaré point at drive phase 0, in rad */
  double v;    /**< velocity there, in rad per unit time */
  int period;  /**< q >= 1: drive periods until the orbit closes */
  int winding; /**< p: whole turns in them */
} pendres_orbit_guess;

/** What to compute beside the orbit itself. */
typedef enum pendres_orbit_want {
  PENDRES_ORBIT_PLAIN = 0,          /**< nothing: slopes are NaN */
  PENDRES_ORBIT_FREQUENCY_SLOPE = 1 /**< derivatives along the branch by omega */
} pendres_orbit_want;

/**
 * Refine n guesses to periodic orbits, side by side; stable and unstable ones alike.
 *
 * guess[n] is read; out[n] and outcome[n] are written. outcome[i] is PENDRES_OK, or
 * PENDRES_NOT_CONVERGED where Newton's method found no orbit near the guess, or one so close to
 * a fold that it cannot be distinguished from its ghost beyond it (out[i] is then undefined), or
 * PENDRES_TOLERANCE_UNREACHABLE where an orbit was found but its estimated error exceeds the
 * tolerance (out[i] is complete, errors say how far).
 * Returns PENDRES_OK unless nothing could be computed at all.
 */
pendres_status pendres_orbit_find(pendres_context *ctx, size_t n,
                                  const pendres_orbit_guess *guess, pendres_orbit_want want,
                                  pendres_orbit *out, pendres_status *outcome);

/**
 * Samples of an orbit over its period: count equally spaced points a drive period, count * q in
 * all, at theta = 2 pi k / count. x[], v[] of that length are written; either may be NULL. They
 * come from the Fourier series of the orbit, which is integrated again with orbit->steps steps per
 * period. At drive phase 0 they are as exact as orbit->x, elsewhere to about the tolerance at which
 * the orbit was found. If error is not NULL they are computed to the context's tolerance, at twice
 * the cost or more, and error[0] and error[1] receive estimates of the largest error of any x[] and
 * of any v[].
 */
pendres_status pendres_orbit_sample(pendres_context *ctx, const pendres_orbit *orbit, int count,
                                    double *x, double *v, double error[2]);

/** Drive periods of a closed orbit that are recorded. */
typedef struct pendres_orbit_stretch {
  long well;    /**< the well that the orbit is in: that many whole turns are added to x */
  long first;   /**< the first of the drive periods, from 0 on, ... */
  long periods; /**< ... and how many they are */
  int samples;  /**< points a drive period */
} pendres_orbit_stretch;

/**
 * Record a closed orbit over some drive periods, with an error for each point: point k, at drive
 * phase 2 pi k / samples after that of the first period, goes to out->x[k] and out->v[k],
 * k < periods * samples. Arrays are the caller's. Positions continue from period to period as the
 * orbit winds; they are not wrapped.
 *
 * The points are those of pendres_orbit_sample() with 1.4 times the orbit's steps. Their errors are
 * the difference from those with the orbit's own steps, twice the error of its point, and rounding;
 * if out->x_error is NULL they are not computed. The pieces of a record have the same bytes as the
 * whole.
 *
 * Errors: PENDRES_INVALID_ARGUMENT, with a message; otherwise those of pendres_orbit_sample(). What
 * was written is then to be ignored. Thread safety: as for the context.
 */
pendres_status pendres_orbit_record(pendres_context *ctx, const pendres_orbit *orbit,
                                    const pendres_orbit_stretch *stretch,
                                    const pendres_record *out);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
