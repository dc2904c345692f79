/*
 * pendulum.h -- the model: a damped, driven pendulum, and its exact neighbours.
 *
 * Owns: the equation of motion, its Jacobian, energy, wells and mirror
 * symmetry, and two limits with closed forms: the driven harmonic oscillator
 * and the free pendulum (elliptic integrals).
 *
 * Equation (Kharkongor and Mahato, eq. 2.1, with thermal noise added):
 *
 *     x'' + damping x' - cos x = drive_amplitude cos(drive_frequency t)
 *                                + sqrt(2 damping temperature) xi(t)
 *
 * All quantities are dimensionless: time in units of 1/omega_0 of small
 * oscillations, energy in units of the depth m omega_0^2 of the potential
 * V(x) = -sin x. Wells lie at x = pi/2 + 2 pi n (n is the well number), the
 * barrier tops at x = -pi/2 + 2 pi n. The pendulum's angle is y = x - pi/2.
 * The mirror symmetry is y -> -y together with half a drive period's delay.
 *
 * Thread safety: all functions are pure.
 */
#ifndef PENDRES_PENDULUM_H
#define PENDRES_PENDULUM_H

#include <pendres/status.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/** The parameters of one pendulum. */
typedef struct pendres_pendulum {
  double damping;         /**< gamma >= 0, friction coefficient */
  double drive_amplitude; /**< F0, any finite value */
  double drive_frequency; /**< omega > 0, rad per unit time; also the clock of
                               the stroboscopic map when drive_amplitude is 0 */
  double temperature;     /**< T >= 0; used by langevin.h alone */
} pendres_pendulum;

/**
 * Check parameters. On failure *why (if not NULL) is a static sentence.
 * Returns PENDRES_OK or PENDRES_INVALID_ARGUMENT.
 */
pendres_status pendres_pendulum_check(const pendres_pendulum *p, const char **why);

/** Acceleration x'' at position x, velocity v, time t, without noise. */
double pendres_pendulum_acceleration(const pendres_pendulum *p, double x, double v, double t);

/** Its derivatives with respect to x and v: *dx = -sin x, *dv = -damping. */
void pendres_pendulum_jacobian(const pendres_pendulum *p, double x, double v,
                               double *dx, double *dv);

/** Energy v^2/2 - sin x; the barrier top has energy 1, a well's bottom -1. */
double pendres_pendulum_energy(double x, double v);

/** Number of the well that x lies in: n for -pi/2 + 2 pi n < x <= 3 pi/2 + 2 pi n; 0 for NaN and
    beyond 1e15. */
long pendres_pendulum_well(double x);

/**
 * Mirror image of a state under y -> -y. A trajectory and its mirror image
 * obey the same equation half a drive period apart.
 */
void pendres_pendulum_mirror(double *x, double *v);

/** Closed form of the driven harmonic oscillator y'' + gamma y' + y = F0 cos(omega t). */
typedef struct pendres_harmonic {
  double amplitude; /**< of y */
  double phase_lag; /**< behind the force, 0 <= phase_lag <= pi: y has the sign of F0 times
                         amplitude cos(omega t - phase_lag) */
  double loop_area; /**< pi F0 amplitude sin(phase_lag), a drive cycle */
} pendres_harmonic;

/** Linear response of p. Landau and Lifshitz, Mechanics, section 26. */
pendres_status pendres_harmonic_response(const pendres_pendulum *p, pendres_harmonic *out);

/**
 * Exact frequency of the free undamped pendulum of amplitude 0 <= a < pi:
 * pi / (2 K(k)), k = sin(a/2) (paper eqs. 1.3-1.5). NaN outside the range.
 */
double pendres_free_frequency(double amplitude);

/** Kittel's approximation 1 - a^2/16 (paper eq. 1.1). */
double pendres_free_frequency_kittel(double amplitude);

/** Approximation of Belendez et al., (1 + sqrt(cos(a/2)))^2 / 4 (paper eq. 1.2). */
double pendres_free_frequency_belendez(double amplitude);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
