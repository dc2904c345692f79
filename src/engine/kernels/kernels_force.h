/*
 * kernels_force.h -- the forces of all models, of vectors and of single lanes.
 *
 * Owns: which force a model has. Included by what is compiled once for each instruction set alone:
 * kernels.c, and the kicks of noise (noise/kernels_langevin.c).
 */
#ifndef PENDRES_KERNELS_FORCE_H
#define PENDRES_KERNELS_FORCE_H

#include <pendres/pendulum.h>

#include "engine/kernels/kernels_formula.h"
#include "engine/kernels/kernels_vector.h"
#include "model/forces.h"
#include "model/model.h"

/* ---- Polynomials ----------------------------------------------------------------------------- */

/* y[v] = f(y[v]) of `count` vectors; a[i]: coefficients a_(i+1) of all lanes, from `lane` on. */
PENDRES_VECTOR_INLINE void pendres_polynomial_forces(int count, const double *const *a,
                                                     size_t lane, pendres_vector *y)
{
  enum { LAST = PENDRES_FORCE_POWERS - 1 };
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
  enum { LAST = PENDRES_FORCE_POWERS - 1 };
  double t = a[LAST][lane], by = 0.0;
#pragma GCC unroll 8
  for (int i = LAST - 1; i >= 0; i--) {
    by = __builtin_fma(by, y, t);
    t = __builtin_fma(t, y, a[i][lane]);
  }
  *force = t * y;
  *slope = __builtin_fma(by, y, t);
}

/* ---- All forces ------------------------------------------------------------------------------ */

/* f of a lane by a force's own header, and its derivative; power[c]: coefficient number c + 1 of
   all lanes. */
PENDRES_VECTOR_INLINE void pendres_kernels_own_force(pendres_model_terms model,
                                                     const double *const *power, size_t i,
                                                     double y, double *f, double *slope)
{
  double a[PENDRES_FORCE_POWERS];
  for (int c = 0; c < PENDRES_FORCE_POWERS; c++) a[c] = power[c][i];
  pendres_forces_at(PENDRES_MODEL_FORCE(model), a, y, f, slope);
}

PENDRES_VECTOR_INLINE void pendres_kernels_own_forces(pendres_model_terms model, int count,
                                                      const double *const *power, size_t lane,
                                                      pendres_vector *y)
{
  double f[PENDRES_VECTOR_GROUP * PENDRES_VECTOR_LANES];
  PENDRES_VECTOR_EACH pendres_vector_store(f + v * PENDRES_VECTOR_LANES, y[v]);
#pragma omp simd
  for (int i = 0; i < count * PENDRES_VECTOR_LANES; i++) {
    double slope;
    pendres_kernels_own_force(model, power, lane + (size_t)i, f[i], &f[i], &slope);
  }
  PENDRES_VECTOR_EACH y[v] = pendres_vector_load(f + v * PENDRES_VECTOR_LANES);
}

/* y[v] = f(y[v]) of a model; lane: where the vectors' coefficients begin. */
PENDRES_VECTOR_INLINE void pendres_kernels_forces(pendres_model_terms model, int count,
                                                  const double *const *power, size_t lane,
                                                  pendres_vector *y)
{
  if (model == PENDRES_MODEL_POLYNOMIAL)
    pendres_polynomial_forces(count, power, lane, y);
  else if (model > PENDRES_MODEL_POLYNOMIAL)
    pendres_kernels_own_forces(model, count, power, lane, y);
  else
    pendres_vector_sines(count, y);
}

/* f and its derivative at a lane's y: the same f, bit by bit. */
PENDRES_VECTOR_INLINE void pendres_kernels_force(pendres_model_terms model,
                                                 const double *const *power, size_t i, double y,
                                                 double *f, double *slope)
{
  if (model == PENDRES_MODEL_FORMULA) {
    *f = power[FORMULA_OUT_FORCE][i];
    *slope = power[FORMULA_OUT_SLOPE][i];
  } else if (model == PENDRES_MODEL_POLYNOMIAL)
    pendres_polynomial_force(power, i, y, f, slope);
  else if (model > PENDRES_MODEL_POLYNOMIAL)
    pendres_kernels_own_force(model, power, i, y, f, slope);
  else
    pendres_kernels_sincos(y, f, slope);
}

#endif
