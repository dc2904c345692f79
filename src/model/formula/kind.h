/*
 * kind.h -- the operations that formulas have.
 */
#ifndef PENDRES_FORMULA_KIND_H
#define PENDRES_FORMULA_KIND_H

/* Operations on values. What has no operands comes first, then what has one, two, three. */
typedef enum formula_kind {
  FORMULA_CONSTANT,
  FORMULA_X,
  FORMULA_V,
  FORMULA_COEFFICIENT,  /* a_k: `which` is k - 1 */
  FORMULA_PHASE,        /* only as n phase within sine and cosine, where it becomes these two: */
  FORMULA_PHASE_COSINE, /* of `which` times the phase */
  FORMULA_PHASE_SINE,
  FORMULA_NEGATIVE,
  FORMULA_SIN,
  FORMULA_COS,
  FORMULA_EXP,
  FORMULA_LOG,
  FORMULA_TANH,
  FORMULA_ATAN,
  FORMULA_SQRT,
  FORMULA_ABS,
  FORMULA_SIGN,
  FORMULA_ADD,
  FORMULA_SUBTRACT,
  FORMULA_MULTIPLY,
  FORMULA_DIVIDE,
  FORMULA_WITHIN,       /* the first, where the second is positive; elsewhere NaN */
  FORMULA_FUSED,        /* a b + c */
  FORMULA_FUSED_LESS,   /* a b - c */
  FORMULA_FUSED_FROM,   /* c - a b */
  FORMULA_KINDS
} formula_kind;

/* How many operands an operation has. */
static inline int formula_operands(formula_kind kind)
{
  return kind >= FORMULA_FUSED ? 3 : kind >= FORMULA_ADD ? 2 : kind >= FORMULA_NEGATIVE ? 1 : 0;
}

#endif
