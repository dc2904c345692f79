/*
 * kernels_drag.h -- friction other than that in proportion to w, which few pendulums have.
 *
 * Owns: what it adds to slopes. A part of kernels.c, which includes it behind
 * kernels.h.
 */
#ifndef PENDRES_KERNELS_DRAG_H
#define PENDRES_KERNELS_DRAG_H

#include "engine/kernels/kernels_vector.h"

#define FMA(a, b, c) __builtin_fma((a), (b), (c))

/* What friction other than `friction` adds to the slope of lane i: its sum over w, and derivatives
   of -sum w by y and w. */
typedef struct resistance {
  double sum, by_y, by_w;
} resistance;

PENDRES_VECTOR_INLINE resistance resistance_of(const pendres_coefficients *k, size_t i, double y,
                                               double w)
{
  const double speed = __builtin_fabs(w), bent = k->nonlinear[i] * y;
  const double linear = k->quadratic[i] * speed, square = k->cubic[i] * speed * speed;
  return (resistance){.sum = bent * y + (linear + square), .by_y = -2.0 * bent * w,
                      .by_w = -(bent * y + (2.0 * linear + 3.0 * square))};
}

/* How the slope of lane i changes with the parameter of a pair of rows, by such friction. */
PENDRES_VECTOR_INLINE double resistance_by(const pendres_coefficients *k, int row, size_t i,
                                           double y, double w)
{
  switch (row) {
  case PENDRES_ROW_BY_OMEGA:
    return k->inverse[i] * w * FMA(k->nonlinear[i] * y, y, -(k->cubic[i] * w * w));
  case PENDRES_ROW_BY_NONLINEAR: return -k->inverse[i] * y * y * w;
  case PENDRES_ROW_BY_QUADRATIC: return -w * __builtin_fabs(w);
  case PENDRES_ROW_BY_CUBIC: return -(w * w * w) / k->inverse[i];
  default: return 0.0;
  }
}

/* Other friction added to the slopes of a strip's states. */
static inline void resist(const pendres_strip *strip, const double *state, double *slope)
{
  const pendres_coefficients k = strip->k;
  const size_t stride = strip->lanes;
  const double *restrict s = state + strip->at;
  double *restrict d = slope + strip->at;
#pragma omp simd
  for (size_t i = 0; i < stride; i++) {
    const double w = s[stride + i];
    d[stride + i] = FMA(-resistance_of(&k, i, s[i], w).sum, w, d[stride + i]);
  }
}

/* And to those of its derivatives. Those by such friction are there also where it is 0. */
static inline void resist_rows(size_t rows, const pendres_strip *strip, const double *state,
                               double *slope)
{
  const pendres_coefficients k = strip->k;
  const size_t stride = strip->lanes;
  const double *restrict s = state + strip->at;
  double *restrict d = slope + strip->at;
  const int first = strip->drags ? PENDRES_ROW_BY_Y : PENDRES_ROW_BY_NONLINEAR;
  for (int row = first; row < (int)rows; row += 2) {
    const double *restrict by_y = s + (size_t)row * stride, *restrict by_w = by_y + stride;
    double *restrict of_w = d + (size_t)(row + 1) * stride;
#pragma omp simd
    for (size_t i = 0; i < stride; i++) {
      const double y = s[i], w = s[stride + i], by = resistance_by(&k, row, i, y, w);
      const resistance r = resistance_of(&k, i, y, w);
      of_w[i] += strip->drags ? FMA(r.by_y, by_y[i], FMA(r.by_w, by_w[i], by)) : by;
    }
  }
}

#endif
