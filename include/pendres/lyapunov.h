/**
 * @file lyapunov.h
 * @brief Largest Lyapunov exponents of many pendulums, each with its own parameters.
 *
 * Owns: the exponent of each pendulum's own motion, with its error. It is made for maps of a
 * million points: only the attractor that the start leads to is found, and that it traps the
 * pendulum is not checked; see attractor.h for that.
 *
 * A pendulum that comes close to a stable orbit has that orbit's exponent, period and winding.
 * Otherwise growth is averaged along tangent vectors, and the motion is chaotic,
 * quasi-periodic (a rotation that is not locked to the drive, with the exponent 0), or unresolved.
 * Chaos that ends, or changes, later than the pendulum is followed (by default after 2264 drive
 * periods) is not distinguished from chaos that lasts. docs/sweeps.md describes the method, its
 * criteria, and how a result is made certain.
 */
#ifndef PENDRES_LYAPUNOV_H
#define PENDRES_LYAPUNOV_H

#include <stddef.h>

#include <pendres/attractor.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** Lengths of the computation. Zero in a field: its default. */
typedef struct pendres_lyapunov_options {
  size_t size; /**< sizeof this struct, or 0: that of version 1.0 (see pendres.h) */
  long transient; /**< drive periods, at most, until an orbit is reached, and before averages are
                       taken; default 200, and more where damping is weak */
  long periods;   /**< drive periods of an average, rounded up to a multiple of 16; default 512,
                       before which chaos is followed for longer */
} pendres_lyapunov_options;

/**
 * The exponents of n pendulums that start from x[n], v[n] at drive phase 0. All arrays are the
 * caller's; out[n] is written. There is no set of attractors: SA and LA are not told apart
 * (PERIODIC). The exponent of an unresolved pendulum is the mean so far; the error of a chaotic
 * one's rotation is one standard error. Each result depends on its own pendulum and the tolerance
 * alone. The drive's amplitude may be 0, the damping must be above 0. An odd number of steps a
 * period is made even.
 *
 * options may be NULL. Errors: PENDRES_INVALID_ARGUMENT (the message names the pendulum),
 * PENDRES_OUT_OF_MEMORY, PENDRES_INTERRUPTED, those of the integration. PENDRES_OK also where some
 * are unresolved. Thread safety: as for the context.
 */
pendres_status pendres_lyapunov_find(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums, const double *x,
                                     const double *v, const pendres_lyapunov_options *options,
                                     pendres_settled *out);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
