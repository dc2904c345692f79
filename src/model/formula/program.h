/*
 * program.h -- a formula as a list of operations on strips of numbers.
 *
 * Owns: which values of a formula are computed together, in which order, and where they stand. Each
 * operation does a whole strip of lanes, so that choosing it costs little beside doing it.
 */
#ifndef PENDRES_FORMULA_PROGRAM_H
#define PENDRES_FORMULA_PROGRAM_H

#include <pendres/pendulum.h>

#include "model/formula/operations.h"
#include "model/formula/tree.h"

enum {
  FORMULA_LANES = 80,       /* of a strip at most: ten vectors of the widest set */
  FORMULA_MOST_SLOTS = 64,  /* values that are needed at the same time */
  FORMULA_MOST_PLACES = 256,
  FORMULA_BOTH = FORMULA_KINDS, /* sine and cosine of one argument */
  /* Places that a program reads; constants and slots follow. */
  FORMULA_AT_X = 0,
  FORMULA_AT_V,
  FORMULA_AT_COEFFICIENTS,
  FORMULA_AT_PHASES = FORMULA_AT_COEFFICIENTS + PENDRES_FORCE_POWERS,
  FORMULA_MOST_PHASES = 16
};

typedef struct formula_step {
  unsigned char kind, to, other; /* slots; `other` is the cosine's of FORMULA_BOTH */
  unsigned char a, b, c;         /* places */
} formula_step;

/* What a program computes, one after another. */
typedef enum formula_output {
  FORMULA_OUT_FORCE,
  FORMULA_OUT_SLOPE, /* derivatives by x, ... */
  FORMULA_OUT_CURVE, /* ... twice ... */
  FORMULA_OUT_BY,    /* ... and, in place of that, by a1, a2, ... */
  FORMULA_OUTPUTS = FORMULA_OUT_BY + PENDRES_FORCE_POWERS
} formula_output;

typedef struct formula_program {
  formula_step *step;
  double *constant; /* each FORMULA_LANES times, on 64-byte boundaries */
  int steps, constants, slots, phases;
  signed char phase[FORMULA_MOST_PHASES]; /* n of cos(n phase); -n of the sine */
  int output[FORMULA_OUTPUTS];            /* places; FORMULA_NONE: not computed */
} formula_program;

/* The program of these nodes, of which some may be FORMULA_NONE; -1 without memory or room. */
int pendres_formula_program_make(const formula_tree *t, const int *node, formula_program *out);
void pendres_formula_program_free(formula_program *p);

/* The place of the first constant, and of the first slot. */
static inline int formula_at_constants(const formula_program *p)
{
  return FORMULA_AT_PHASES + p->phases;
}

static inline int formula_at_slots(const formula_program *p)
{
  return formula_at_constants(p) + p->constants;
}

/* Tell where constants and slots are: of FORMULA_LANES numbers each. */
PENDRES_FORMULA_INLINE void pendres_formula_bind(const formula_program *p, const double **at,
                                                 double *slots)
{
  const int constants = formula_at_constants(p), first = formula_at_slots(p);
  for (int i = 0; i < p->constants; i++) at[constants + i] = p->constant + i * FORMULA_LANES;
  for (int i = 0; i < p->slots; i++) at[first + i] = slots + i * FORMULA_LANES;
}

/* The cosine or sine of a multiple of a phase, from its cosine and sine. */
PENDRES_FORMULA_INLINE double pendres_formula_harmonic(int n, double cosine, double sine)
{
  double c = 1.0, s = 0.0;
  for (int k = n < 0 ? -n : n; k > 0; k--) {
    const double next = __builtin_fma(c, cosine, -(s * sine));
    s = __builtin_fma(s, cosine, c * sine);
    c = next;
  }
  return n < 0 ? s : c;
}

/* One step of a program on lanes, as many as one vector or more have. */
#define FORMULA_EACH _Pragma("omp simd") for (size_t i = 0; i < lanes; i++)
#define FORMULA_CASE_ONE(KIND) \
  case KIND: FORMULA_EACH to[i] = pendres_formula_of_one(KIND, a[i]); break;
#define FORMULA_CASE_TWO(KIND) \
  case KIND: FORMULA_EACH to[i] = pendres_formula_of_two(KIND, a[i], b[i]); break;
#define FORMULA_CASE_THREE(KIND) \
  case KIND: FORMULA_EACH to[i] = pendres_formula_of_three(KIND, a[i], b[i], c[i]); break;

PENDRES_FORMULA_INLINE void pendres_formula_step(const formula_step *s, size_t lanes,
                                                 const double *const *at, double *slots)
{
  double *to = slots + s->to * FORMULA_LANES, *other = slots + s->other * FORMULA_LANES;
  const double *a = at[s->a], *b = at[s->b], *c = at[s->c];
  switch (s->kind) {
    FORMULA_CASE_TWO(FORMULA_ADD)
    FORMULA_CASE_TWO(FORMULA_SUBTRACT)
    FORMULA_CASE_TWO(FORMULA_MULTIPLY)
    FORMULA_CASE_THREE(FORMULA_FUSED)
    FORMULA_CASE_THREE(FORMULA_FUSED_LESS)
    FORMULA_CASE_THREE(FORMULA_FUSED_FROM)
    FORMULA_CASE_TWO(FORMULA_DIVIDE)
    FORMULA_CASE_TWO(FORMULA_WITHIN)
    FORMULA_CASE_ONE(FORMULA_NEGATIVE)
    FORMULA_CASE_ONE(FORMULA_SIN)
    FORMULA_CASE_ONE(FORMULA_COS)
    FORMULA_CASE_ONE(FORMULA_EXP)
    FORMULA_CASE_ONE(FORMULA_LOG)
    FORMULA_CASE_ONE(FORMULA_TANH)
    FORMULA_CASE_ONE(FORMULA_ATAN)
    FORMULA_CASE_ONE(FORMULA_SQRT)
    FORMULA_CASE_ONE(FORMULA_ABS)
    FORMULA_CASE_ONE(FORMULA_SIGN)
  case FORMULA_BOTH: FORMULA_EACH pendres_kernels_sincos(a[i], &to[i], &other[i]); break;
  default: break;
  }
}

PENDRES_FORMULA_INLINE void pendres_formula_run(const formula_program *p, size_t lanes,
                                                const double *const *at, double *slots)
{
  for (const formula_step *s = p->step, *end = s + p->steps; s < end; s++)
    pendres_formula_step(s, lanes, at, slots);
}

#endif
