/**
 * @file free.h
 * @brief Free oscillations: their frequency by elliptic integrals, integration, and quadrature.
 *
 * Owns: the frequency without damping and drive as a function of the amplitude: of the pendulum in
 * closed form, and from the equation of motion alone, which is a check of the whole computation; of
 * any force by quadrature of the period.
 *
 * Equation of the pendulum: y'' = -sin y, y(0) = a, y'(0) = 0; the frequency is 2 pi / period.
 */
#ifndef PENDRES_FREE_H
#define PENDRES_FREE_H

#include <stddef.h>

#include <pendres/context.h>
#include <pendres/pendulum.h>

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

/** A free oscillation under any force. Plain data. */
typedef struct pendres_free_oscillation {
  double well;            /**< where the pendulum rests: x; low and high may embrace others, too */
  double low;             /**< turning point: the lowest x, ... */
  double high;            /**< ... and the highest; twice the amplitude apart */
  double frequency;       /**< angular: 2 pi / period */
  double frequency_error; /**< by what twice as many points change, rounding, and what that of the
                               turning points does, which grows towards the separatrix */
  double turn_error;      /**< of both turning points: rounding, that of the amplitude included */
} pendres_free_oscillation;

/**
 * The backbone without damping and drive, of any force: the frequency of free oscillations of an
 * amplitude (half the peak-to-peak), about the well in which a pendulum comes to rest that is let
 * go at the model's origin, as pendres_backbone_find() takes it, or across this well and others. By
 * quadrature of the period (Landau and Lifshitz, Mechanics, section 11), which has nothing in
 * common with an integration of the equation of motion.
 *
 * The largest swings about a well and the smallest across a barrier are the separatrix' two sides,
 * on which the frequency falls to 0; no swing has an amplitude between theirs. Within some 1e-8 of
 * a separatrix, as a share of the amplitude, the frequency is not known. A pendulum that passes its
 * barrier rotates: that is no oscillation.
 *
 * @param ctx       belongs to one thread at a time
 * @param n         how many
 * @param pendulums [n], read for their force and torque; not kept
 * @param amplitude [n], above 0, as x is (rad); not kept
 * @param out       [n], written; NaN where there is none
 * @param outcome   [n], written: PENDRES_OK, PENDRES_TOLERANCE_UNREACHABLE (the error tells), or
 *                  PENDRES_NOT_FOUND: there is no well, no swing of this amplitude, or it is that
 *                  of a separatrix
 * @return PENDRES_INVALID_ARGUMENT or PENDRES_OUT_OF_MEMORY; then out is not meaningful
 */
pendres_status pendres_free_oscillation_find(pendres_context *ctx, size_t n,
                                             const pendres_pendulum *pendulums,
                                             const double *amplitude,
                                             pendres_free_oscillation *out,
                                             pendres_status *outcome);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
