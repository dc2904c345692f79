/*
 * forces.h -- further forces, beside the pendulum's and the polynomial.
 *
 * To add one named NAME:
 *
 *   1. its header, force_NAME.h in this folder, like force_squid.h;
 *   2. a line in PENDRES_FORCE_LIST of <pendres/pendulum.h>, and the header's include below.
 *
 * The header has, with a[k - 1] its coefficients a_k, of which there are at most
 * PENDRES_FORCE_POWERS, and y = x - origin:
 *
 *   pendres_force_NAME_model      its name in decks, the period of y (2 pi or, where y and y + 2 pi
 *                                 are not the same, 0), origin, whether y is an angle (in rad),
 *                                 how many coefficients, and, if pendulums may escape to
 *                                 infinity, `outward`, which gives the position beyond which they
 *                                 certainly do (pendulum.h); without it they are unresolved;
 *                                 `centre` gives the point about which f less a torque is odd, if
 *                                 it can be; `beside`, how far it is from a spring a1 y at most
 *   pendres_force_NAME            f and df/dy; f(0) need not be 0
 *   pendres_force_NAME_by         df/da_k, k from 0 on
 *   pendres_force_NAME_potential  V, dV/dy = f, up to a constant
 *
 * The first two functions are used in the innermost loops: they must not branch on y, and every
 * operation must be one IEEE operation (+ - * /, __builtin_fma, the sine of base/sine.h); otherwise
 * results would depend on the instruction set. Kernels, blocks, sensitivities to the coefficients,
 * steps and everything else that depends on the model follow from these functions.
 */
#ifndef PENDRES_FORCES_H
#define PENDRES_FORCES_H

#include <pendres/pendulum.h>

/* Part of the kernels' loops, at every width of a vector. */
#define PENDRES_FORCE_INLINE static inline __attribute__((always_inline))

#include "model/force_squid.h"

/* The functions of a force of the list, which is known where they are compiled into a loop. */
PENDRES_FORCE_INLINE void pendres_forces_at(pendres_force force, const double *a, double y,
                                            double *f, double *slope)
{
  *f = *slope = 0.0;
#define PENDRES_FORCES_AT(CODE, name) \
  if (force == PENDRES_FORCE_##CODE) pendres_force_##name(a, y, f, slope);
  PENDRES_FORCE_LIST(PENDRES_FORCES_AT)
#undef PENDRES_FORCES_AT
}

PENDRES_FORCE_INLINE double pendres_forces_by(pendres_force force, const double *a, double y, int k)
{
#define PENDRES_FORCES_BY(CODE, name) \
  if (force == PENDRES_FORCE_##CODE) return pendres_force_##name##_by(a, y, k);
  PENDRES_FORCE_LIST(PENDRES_FORCES_BY)
#undef PENDRES_FORCES_BY
  return 0.0;
}

#endif
