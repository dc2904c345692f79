/**
 * @file free.h
 * @brief The free pendulum by integration.
 *
 * Owns: the frequency of the undamped, undriven pendulum as a function of its
 * amplitude, found from the equation of motion alone. Its purpose is a check
 * from end to end: the answer is also known in closed form
 * (pendres_free_frequency in pendulum.h).
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
 * Frequencies of n free pendulums.
 *
 * amplitude[n] (rad, 0 < a < pi) is read; frequency[n] and error[n], the estimate of its
 * error, are written. No argument is kept.
 *
 * By symmetry the pendulum passes the bottom after a quarter of its period. The clock
 * of the flow is set such that this takes one turn of its phase, by Newton's method
 * on the clock; the steps are doubled until the result, relative to itself, is within the
 * context's tolerance. Where rounding forbids that (amplitudes within some 1e-9 of pi)
 * the error says how far it is; that is not a failure.
 *
 * Results depend on each amplitude alone, not on the others.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (the message names the amplitude), PENDRES_NOT_CONVERGED,
 * PENDRES_INTEGRATION_FAILED, PENDRES_OUT_OF_MEMORY, PENDRES_INTERRUPTED. What was written
 * is then to be ignored.
 *
 * Thread safety: as the context.
 */
pendres_status pendres_free_frequency_integrate(pendres_context *ctx, size_t n,
                                                const double *amplitude, double *frequency,
                                                double *error);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
