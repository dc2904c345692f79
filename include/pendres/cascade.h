/**
 * @file cascade.h
 * @brief An orbit that doubles its period repeatedly as a parameter varies.
 *
 * Owns: the doublings one after another, each located to the tolerance, the value at which they
 * accumulate, and the ratio of their distances.
 *
 * Each orbit is followed by continuation to its doubling, and the orbit born there likewise. The
 * distances of successive doublings finally shrink by Feigenbaum's ratio, 4.669..., with which the
 * last two are extrapolated to the accumulation point, beyond which there is chaos.
 *
 * A cascade keeps states (pendres_context_set_keep()), at each of its forks.
 *
 * Source: Feigenbaum, Journal of Statistical Physics 19 (1978) 25; Kuznetsov, Elements of Applied
 * Bifurcation Theory, chapter 4.
 */
#ifndef PENDRES_CASCADE_H
#define PENDRES_CASCADE_H

#include <pendres/continuation.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

enum { PENDRES_CASCADE_DOUBLINGS = 8 /**< followed at most */ };

/** Doublings in their order. Plain data. */
typedef struct pendres_cascade {
  int doublings;                         /**< how many were found */
  int period[PENDRES_CASCADE_DOUBLINGS]; /**< of the orbit that loses its stability there */
  double value[PENDRES_CASCADE_DOUBLINGS];       /**< of the parameter there */
  double value_error[PENDRES_CASCADE_DOUBLINGS]; /**< its error */
  double x[PENDRES_CASCADE_DOUBLINGS];   /**< a Poincaré point of it, ... */
  double v[PENDRES_CASCADE_DOUBLINGS];   /**< ... and the velocity there */
  double limit;       /**< where they accumulate; NaN with less than three doublings */
  double limit_error; /**< its error */
  double ratio;       /**< of the last two distances, which tends to Feigenbaum's; NaN with less
                           than four doublings, as three give no error estimate */
  double ratio_error; /**< its error */
} pendres_cascade;

/**
 * The cascade that a stable orbit goes through while a parameter moves from its own value towards
 * `limit`. A loss of mirror symmetry on the way is followed. It ends where an orbit leaves the
 * range, or ends otherwise, or no stable orbit of twice the period is born, or after
 * PENDRES_CASCADE_DOUBLINGS: the cost doubles each time, and rounding hides further doublings.
 *
 * orbit is read; *out is complete on PENDRES_OK. Errors: PENDRES_INVALID_ARGUMENT,
 * PENDRES_NOT_FOUND (the orbit does not double its period in the range; *out then has no
 * doublings), those of the integration. Thread safety: as for the context.
 */
pendres_status pendres_cascade_find(pendres_context *ctx, const pendres_orbit *orbit,
                                    pendres_parameter parameter, double limit,
                                    pendres_cascade *out);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
