/**
 * @file reference.h
 * @brief An independent computation of orbits and their measures, in extended precision.
 *
 * Owns: the pendulum integrated by Taylor series in long double, its stroboscopic map with all
 * first derivatives, and what follows from the map: orbits with their measures, resonances,
 * folds and cusps. It shares no code with the library (strobe.h, orbit.h, ...), is
 * slower by two orders of magnitude and more exact by several. The library is tested against it and
 * does not hold it.
 *
 * Equation (pendulum.h, without noise), angle y = x - pi/2, velocity v = dy/dt, drive phase
 * theta = omega t:
 *
 *     dy/dt = v,   dv/dt = -sin y - damping v + drive_amplitude cos theta
 *
 * or, with torque, parametric drive and other forces f(y), where y = x - origin (pendres_model),
 *
 *     dv/dt = -f(y) (1 + parametric_amplitude cos theta) + torque - damping v
 *             + drive_amplitude cos theta
 *
 * Of the forces in PENDRES_FORCE_LIST only those are served whose Taylor series is known here
 * (squid); others are PENDRES_INVALID_ARGUMENT. Where y has no period, turns and windings are 0,
 * and y is not wrapped.
 *
 * States are given and returned at drive phase 0. Angles are in rad, times dimensionless.
 *
 * Accuracy: the truncation error is below 1e-20 a step, and sums are carried in two words. Where
 * long double has 64 bits (x86) a state is therefore good to some 1e-19 times the factor by which
 * the trajectory itself amplifies errors. Where it has 113 bits (most 64 bit ARM and RISC-V) the
 * order rises, and the results are better in proportion; where long double is double they are good
 * to some 1e-16. IBM's pair of doubles is not supported.
 *
 * Source of the method: Jorba and Zou, Experimental Mathematics 14 (2005) 99.
 *
 * Thread safety: all functions are pure. Nothing is allocated, no argument is kept.
 * No output is changed unless PENDRES_OK is returned.
 */
#ifndef REFERENCE_H
#define REFERENCE_H

#include <pendres/pendulum.h>
#include <pendres/status.h>

/**
 * Advance a pendulum by `periods` >= 0 drive periods. *y and *v are replaced in place; *y is
 * wrapped to (-pi, pi] and the whole turns taken are added to *turns (which may be NULL), so
 * that the angle is *y + 2 pi *turns.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (also for |y| > 1e9), PENDRES_INTEGRATION_FAILED (steps
 * below 1e-6 rad of drive phase, as for extreme velocities or drive frequencies).
 */
pendres_status reference_advance(const pendres_pendulum *p, long double *y,
                                         long double *v, long *turns, long periods);

/** End state of some drive periods and its derivatives, all at fixed drive phase. */
typedef struct reference_image {
  long double y;                  /**< angle at the end, in (-pi, pi] */
  long double v;                  /**< velocity there */
  long turns;                     /**< so that the angle is y + 2 pi turns */
  long double monodromy[2][2];    /**< d(y, v)/d(start y, start v); rows: end, columns: start */
  long double by_frequency[2];    /**< d(y, v)/d drive_frequency */
  long double by_damping[2];      /**< d(y, v)/d damping */
  long double by_amplitude[2];    /**< d(y, v)/d drive_amplitude */
} reference_image;

/** The stroboscopic map, applied `periods` >= 0 times, with its derivatives. Errors are those of
    reference_advance(). */
pendres_status reference_map(const pendres_pendulum *p, long double y, long double v,
                                     long periods, reference_image *out);

/**
 * A closed orbit and its measures, all for one drive cycle. For a running orbit (winding not 0) the
 * mean advance is subtracted from the angle before its harmonic and amplitude are taken.
 */
typedef struct reference_cycle {
  long double damping;            /**< gamma at which it exists */
  long double drive_amplitude;    /**< F0 at which it exists */
  long double drive_frequency;    /**< omega at which it exists */
  long double y;                  /**< angle at drive phase 0, in (-pi, pi]: with v a fixed point of
                                       the map over `period` drive periods */
  long double v;                  /**< velocity of the fixed point */
  long period;                    /**< q: drive cycles after which it closes */
  long winding;                   /**< p: whole turns in them */
  long double multiplier_re[2];   /**< real parts of the Floquet multipliers, larger one first */
  long double multiplier_im[2];   /**< their imaginary parts */
  long double monodromy[2][2];    /**< over the whole period */
  long double loop_area;          /**< closed integral of F dx, in m g l */
  long double dissipation;        /**< damping times the integral of v^2 dt, in m g l; equals
                                       loop_area plus the work of a torque and of a parametric
                                       drive, where there are such */
  long double amplitude;          /**< half peak to peak of the angle, in rad */
  long double first_harmonic_amplitude; /**< R of the first harmonic R cos(theta - phase_lag) */
  long double phase_lag;          /**< of the first harmonic behind the force, 0 to pi, in rad; NaN
                                       without a first harmonic */
  long double mean_power;         /**< loop_area drive_frequency / (2 pi), in m g l omega_0 */
  long double loop_area_slope;    /**< d loop_area / d drive_frequency along the branch */
  long double state_slope[2];     /**< d(y, v) / d drive_frequency along the branch */
  long double closure;            /**< residual: largest of |end - start| in y and v */
  long double energy_residual;    /**< residual: |loop_area - dissipation| */
  long double liouville_residual; /**< residual: |det monodromy / exp(-damping time) - 1| */
} reference_cycle;

/**
 * The orbit with the given period >= 1 and winding near the guess (y, v), by Newton's
 * method on the stroboscopic map; it may be stable or unstable.
 * Errors: PENDRES_INVALID_ARGUMENT, PENDRES_INTEGRATION_FAILED, PENDRES_NOT_CONVERGED.
 */
pendres_status reference_orbit(const pendres_pendulum *p, long double y, long double v,
                                       long period, long winding, reference_cycle *out);

/** What reference_find() looks for. */
typedef enum reference_kind {
  REFERENCE_RESONANCE = 0,     /**< the maximum of the loop area along the branch: only
                                            smooth ones, zeros of loop_area_slope */
  REFERENCE_FOLD,              /**< the drive frequency at which a stable and an unstable
                                            orbit meet, with the multiplier +1. Where a symmetric
                                            orbit loses its mirror symmetry it has a multiplier +1
                                            as well, but these equations are singular there and the
                                            iteration does not converge */
  REFERENCE_SYMMETRY_BREAKING, /**< the drive frequency at which an orbit that is its own
                                            mirror image (y(t + half a period) = 2 c - y(t), with
                                            the centre c as a double has it) has a multiplier +1
                                            without a fold: two orbits branch off that are mirror
                                            images of each other. Swift and Wiesenfeld, Physical
                                            Review Letters 52 (1984) 705 */
  REFERENCE_CUSP,              /**< the drive frequency and damping at which two folds meet
                                            and vanish. Kuznetsov, Elements of Applied Bifurcation
                                            Theory, section 9.2 */
  REFERENCE_KINDS              /**< how many there are */
} reference_kind;

/** Where to look for it. */
typedef struct reference_guess {
  long double frequency; /**< drive frequency */
  long double y;         /**< angle at drive phase 0 */
  long double v;         /**< velocity there */
  long double damping;   /**< read for a cusp alone */
} reference_guess;

/**
 * The orbit of period one near a guess at which that happens. p's own drive frequency, and for a
 * cusp its damping, are not read. The slopes in *out are those of a resonance, otherwise NaN: they
 * are infinite at a fold. Errors are those of reference_orbit(); PENDRES_NOT_CONVERGED also
 * if the branch ends before a maximum.
 */
pendres_status reference_find(reference_kind kind, const pendres_pendulum *p,
                                      const reference_guess *guess,
                                      reference_cycle *out);

#endif
