/**
 * @file reference.h
 * @brief A second, independent way to every number of the library.
 *
 * Owns: the pendulum integrated by Taylor series in long double, its strobe map with all
 * first derivatives, and what follows from the map: orbits with their measures, resonances,
 * folds and cusps. It shares no code with the ARKODE path (strobe.h, orbit.h, ...), is
 * slower by two orders of magnitude and several orders more exact: it is what the rest is
 * tested against, and what to use when the 16 digits of a double are not enough.
 *
 * Equation (pendulum.h, without noise), angle y = x - pi/2, velocity v = dy/dt, drive phase
 * theta = omega t:
 *
 *     dy/dt = v,   dv/dt = -sin y - damping v + drive_amplitude cos theta
 *
 * or, with torque, parametric drive and other forces f, y = x - origin,
 *
 *     dv/dt = -f(y) (1 + parametric_amplitude cos theta) + torque - damping v
 *             + drive_amplitude cos theta
 *
 * A force of one's own (PENDRES_FORCE_LIST) is PENDRES_INVALID_ARGUMENT unless its series is known
 * here, as that of the squid is. Where y has no period, turns and windings are 0, and y is not
 * wrapped.
 *
 * States are given and returned at drive phase 0. Angles are in rad, times dimensionless.
 *
 * Accuracy: truncation below 1e-20 a step and sums carried in two words, so that a state
 * is good to some 1e-19 times the factor by which the trajectory itself amplifies errors
 * where long double has 64 bits (x86). Where it has 113 bits (most 64 bit ARM and RISC-V) the
 * order rises with it and everything is that much better; where long double is double
 * the results are good to some 1e-16. IBM's pair of doubles is not supported.
 *
 * Source of the method: Jorba and Zou, Experimental Mathematics 14 (2005) 99.
 *
 * Thread safety: all functions are pure. Nothing is allocated, no argument is kept.
 * No output is changed unless PENDRES_OK is returned.
 */
#ifndef PENDRES_REFERENCE_H
#define PENDRES_REFERENCE_H

#include <pendres/pendulum.h>
#include <pendres/status.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/**
 * Advance a pendulum by `periods` >= 0 drive periods. *y and *v are replaced in place; *y is
 * wrapped to (-pi, pi] and the whole turns taken are added to *turns (which may be NULL), so
 * that the angle is *y + 2 pi *turns.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (also for |y| > 1e9), PENDRES_INTEGRATION_FAILED (steps
 * below 1e-6 rad of drive phase, as for absurd velocities or drive frequencies).
 */
pendres_status pendres_reference_advance(const pendres_pendulum *p, long double *y,
                                         long double *v, long *turns, long periods);

/** End state of some drive periods and its derivatives, all at fixed drive phase. */
typedef struct pendres_reference_image {
  long double y;                  /**< angle at the end, in (-pi, pi] */
  long double v;                  /**< velocity there */
  long turns;                     /**< so that the angle is y + 2 pi turns */
  long double monodromy[2][2];    /**< d(y, v)/d(start y, start v); rows: end, columns: start */
  long double by_frequency[2];    /**< d(y, v)/d drive_frequency */
  long double by_damping[2];      /**< d(y, v)/d damping */
  long double by_amplitude[2];    /**< d(y, v)/d drive_amplitude */
} pendres_reference_image;

/** The strobe map, `periods` >= 0 times, with its derivatives. Errors as above. */
pendres_status pendres_reference_map(const pendres_pendulum *p, long double y, long double v,
                                     long periods, pendres_reference_image *out);

/**
 * A closed orbit and its measures, which are all a drive cycle. Where it is a running orbit
 * (winding not 0) the mean advance is taken off the angle before harmonics and amplitude.
 */
typedef struct pendres_reference_cycle {
  long double damping;            /**< gamma at which it exists */
  long double drive_amplitude;    /**< F0 at which it exists */
  long double drive_frequency;    /**< omega at which it exists */
  long double y;                  /**< angle of the strobe map's fixed point, in (-pi, pi] */
  long double v;                  /**< velocity of the fixed point */
  long period;                    /**< q: drive cycles after which it closes */
  long winding;                   /**< p: whole turns in them */
  long double multiplier_re[2];   /**< real parts of the Floquet multipliers, larger one first */
  long double multiplier_im[2];   /**< their imaginary parts */
  long double monodromy[2][2];    /**< over the whole period */
  long double loop_area;          /**< closed integral of F dx */
  long double dissipation;        /**< damping times the integral of v^2 dt; equals loop_area, with
                                       a torque or a parametric drive and what these give */
  long double amplitude;          /**< half peak to peak of the angle */
  long double first_harmonic_amplitude; /**< of cos(theta - phase_lag) in the angle */
  long double phase_lag;          /**< behind the force, 0 to pi; NaN without a first harmonic */
  long double mean_power;         /**< loop_area drive_frequency / (2 pi) */
  long double loop_area_slope;    /**< d loop_area / d drive_frequency along the branch */
  long double state_slope[2];     /**< d(y, v) / d drive_frequency along the branch */
  long double closure;            /**< residual: largest of |end - start| in y and v */
  long double energy_residual;    /**< residual: |loop_area - dissipation| */
  long double liouville_residual; /**< residual: |det monodromy / exp(-damping time) - 1| */
} pendres_reference_cycle;

/**
 * The orbit with the given period >= 1 and winding next to the guess (y, v), by Newton's
 * method on the strobe map; stable or not.
 * Errors: PENDRES_INVALID_ARGUMENT, PENDRES_INTEGRATION_FAILED, PENDRES_NOT_CONVERGED.
 */
pendres_status pendres_reference_orbit(const pendres_pendulum *p, long double y, long double v,
                                       long period, long winding, pendres_reference_cycle *out);

/**
 * The largest loop area over the drive frequency on the branch of period-1 orbits that goes
 * through the guess (a drive frequency and a state there); p's own drive_frequency is not
 * read. A smooth maximum only: the frequency is the zero of loop_area_slope.
 * Errors as for the orbit; PENDRES_NOT_CONVERGED also if the branch ends before a maximum.
 */
pendres_status pendres_reference_resonance(const pendres_pendulum *p, long double frequency,
                                           long double y, long double v,
                                           pendres_reference_cycle *out);

/**
 * The fold next to the guess: the drive frequency at which a period-1 orbit has the Floquet
 * multiplier +1 and meets its unstable twin. p's drive_frequency is not read. The slopes in
 * *out are infinite there and set to NaN.
 *
 * The orbit's symmetry is not looked at. Where a symmetric orbit loses its mirror symmetry a
 * multiplier is +1 as well, but the equations are singular and do not converge: see below.
 * Errors as for the orbit.
 */
pendres_status pendres_reference_fold(const pendres_pendulum *p, long double frequency,
                                      long double y, long double v,
                                      pendres_reference_cycle *out);

/**
 * The point next to the guess at which a period-1 orbit that is its own mirror image
 * (y(t + half a period) = -y(t)) has a multiplier +1 without a fold: it goes on, unstable, and
 * a pair of orbits branches off that are each other's mirror image. Large-amplitude orbits
 * of small damping end in this way. p's drive_frequency is not read. Errors and slopes as for
 * the fold, though the branch itself is smooth here.
 * Source: Swift and Wiesenfeld, Physical Review Letters 52 (1984) 705.
 */
pendres_status pendres_reference_symmetry_breaking(const pendres_pendulum *p,
                                                   long double frequency, long double y,
                                                   long double v, pendres_reference_cycle *out);

/**
 * The cusp next to the guess: the drive frequency and damping at which the two folds meet
 * and vanish. Only p's drive_amplitude is read. Slopes are NaN. Errors as for the orbit.
 * Source: Kuznetsov, Elements of Applied Bifurcation Theory, section 9.2.
 */
pendres_status pendres_reference_cusp(const pendres_pendulum *p, long double frequency,
                                      long double damping, long double y, long double v,
                                      pendres_reference_cycle *out);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
