/**
 * @file free.h
 * @brief The free pendulum: its frequency by elliptic integrals, and by integration.
 *
 * Owns: the frequency of the undamped, undriven pendulum as a function of its
 * amplitude: in closed form, and from the equation of motion alone, which is a check of the whole
 * computation.
 *
 * Equation: y'' = -sin y, y(0) = a, y'(0) = 0; the frequency is 2 pi / period.
 */
#ifndef PENDRES_FREE_H
#define PENDRES_FREE_H

#include <stddef.h>

#include <pendres/context.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/**
 * Exact frequency of the free undamped pendulum of amplitude 0 <= a < pi:
 * pi / (2 K(k)), k = sin(a/2) (paper eqs. 1.3-1.5). NaN outside the range.
 */
double pendres_free_frequency(double amplitude);

/** The free pendulum's frequency, and two approximations of it. NaN outside of the range. */
typedef struct pendres_free {
  double frequency;       /**< pendres_free_frequency() */
  double frequency_error; /**< its error by rounding: some units in the last place from the formula,
                               and the effect of rounding the amplitude to a double: close to pi the
                               frequency f falls by f / ((pi - a) K) per radian */
  double kittel;          /**< 1 - a^2/16 (paper eq. 1.1) */
  double belendez;        /**< (1 + sqrt(cos(a/2)))^2 / 4, Belendez et al. (paper eq. 1.2) */
} pendres_free;

/** All of these at an amplitude a. Nothing happens if out is NULL. Thread safe. */
void pendres_free_get(double amplitude, pendres_free *out);

/**
 * Frequencies of n free pendulums.
 *
 * amplitude[n] (rad, 0 < a < pi) is read; frequency[n] and error[n], the estimate of its
 * error, are written. No argument is kept.
 *
 * By symmetry the pendulum passes the bottom after a quarter of its period. The clock
 * of the flow is set such that this takes one turn of its phase, by Newton's method
 * on the clock; the steps are doubled until the result, relative to itself, is within the
 * context's tolerance. Where rounding prevents this (amplitudes within some 1e-9 of pi)
 * the error is larger than the tolerance; that is not a failure.
 *
 * Each result depends only on its own amplitude.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (the message names the amplitude), PENDRES_NOT_CONVERGED,
 * PENDRES_INTEGRATION_FAILED, PENDRES_OUT_OF_MEMORY, PENDRES_INTERRUPTED. What was written
 * is then to be ignored.
 *
 * Thread safety: as the context.
 */
pendres_status pendres_free_find(pendres_context *ctx, size_t n,
                                 const double *amplitude, double *frequency,
                                 double *error);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
