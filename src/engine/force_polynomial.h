/*
 * force_polynomial.h -- the force f = a1 y + a2 y^2 + ... + a5 y^5 of lanes, and its derivatives.
 *
 * By Horner's rule; every operation is one IEEE operation, so that any width of a vector gives the
 * same bytes. (The pendulum's force is the sine of sine.h.)
 */
#ifndef PENDRES_FORCE_POLYNOMIAL_H
#define PENDRES_FORCE_POLYNOMIAL_H

#include "engine/kernels_vector.h"

#include <pendres/pendulum.h>

/* y[v] = f(y[v]) of `count` vectors; a[i]: coefficients a_(i+1) of all lanes, from `lane` on. */
PENDRES_VECTOR_INLINE void pendres_polynomial_forces(int count, const double *const *a,
                                                     size_t lane, pendres_vector *y)
{
  enum { LAST = PENDRES_FORCE_COEFFICIENTS - 1 };
  pendres_vector t[PENDRES_VECTOR_GROUP];
  PENDRES_VECTOR_EACH t[v] = pendres_vector_load(a[LAST] + lane + v * PENDRES_VECTOR_LANES);
#pragma GCC unroll 8
  for (int i = LAST - 1; i >= 0; i--)
    PENDRES_VECTOR_EACH t[v] = pendres_vector_fma(
      t[v], y[v], pendres_vector_load(a[i] + lane + v * PENDRES_VECTOR_LANES));
  PENDRES_VECTOR_EACH y[v] = t[v] * y[v];
}

/* f of one lane, the same, and its derivative by y. */
PENDRES_VECTOR_INLINE void pendres_polynomial_force(const double *const *a, size_t lane, double y,
                                                    double *force, double *slope)
{
  enum { LAST = PENDRES_FORCE_COEFFICIENTS - 1 };
  double t = a[LAST][lane], by = 0.0;
#pragma GCC unroll 8
  for (int i = LAST - 1; i >= 0; i--) {
    by = __builtin_fma(by, y, t);
    t = __builtin_fma(t, y, a[i][lane]);
  }
  *force = t * y;
  *slope = __builtin_fma(by, y, t);
}

#endif
