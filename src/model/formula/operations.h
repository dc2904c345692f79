/*
 * operations.h -- what the operations of formulas do to numbers.
 *
 * Owns: the one definition of each, inlined into the loops over lanes of every instruction set,
 * into the evaluation at one point, and where constants are folded: all give the same bytes.
 */
#ifndef PENDRES_FORMULA_OPERATIONS_H
#define PENDRES_FORMULA_OPERATIONS_H

#include "base/sine.h"
#include "model/formula/functions.h"
#include "model/formula/kind.h"

enum {
  FORMULA_MOST_HARMONIC = 64, /* of the phase */
  FORMULA_MOST_POWER = 64     /* by multiplications */
};

PENDRES_FORMULA_INLINE double pendres_formula_of_one(formula_kind kind, double a)
{
  double sine, cosine;
  switch (kind) {
  case FORMULA_NEGATIVE: return -a;
  case FORMULA_SIN: return pendres_kernels_sin(a);
  case FORMULA_COS: pendres_kernels_sincos(a, &sine, &cosine); return cosine;
  case FORMULA_EXP: return pendres_formula_exp(a);
  case FORMULA_LOG: return pendres_formula_log(a);
  case FORMULA_TANH: return pendres_formula_tanh(a);
  case FORMULA_ATAN: return pendres_formula_atan(a);
  case FORMULA_SQRT: return sqrt(a);
  case FORMULA_ABS: return fabs(a);
  case FORMULA_SIGN: return a > 0.0 ? 1.0 : a < 0.0 ? -1.0 : a;
  default: return NAN;
  }
}

PENDRES_FORMULA_INLINE double pendres_formula_of_two(formula_kind kind, double a, double b)
{
  switch (kind) {
  case FORMULA_ADD: return a + b;
  case FORMULA_SUBTRACT: return a - b;
  case FORMULA_MULTIPLY: return a * b;
  case FORMULA_DIVIDE: return a / b;
  case FORMULA_WITHIN: return b > 0.0 ? a : NAN;
  default: return NAN;
  }
}

PENDRES_FORMULA_INLINE double pendres_formula_of_three(formula_kind kind, double a, double b,
                                                       double c)
{
  switch (kind) {
  case FORMULA_FUSED: return __builtin_fma(a, b, c);
  case FORMULA_FUSED_LESS: return __builtin_fma(a, b, -c);
  case FORMULA_FUSED_FROM: return __builtin_fma(-a, b, c);
  default: return NAN;
  }
}

#endif
