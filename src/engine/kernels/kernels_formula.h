/*
 * kernels_formula.h -- the values of a formula on a strip of lanes.
 *
 * Owns: a formula's program with the strip's coefficients, and where its values are. The loop over
 * operations (kernels_formula.c) is compiled once for each instruction set, and is there to be
 * called: it is too long to be part of other loops.
 */
#ifndef PENDRES_KERNELS_FORMULA_H
#define PENDRES_KERNELS_FORMULA_H

#include "base/instructions.h"
#include "model/formula/formula.h"

/* A program that was given coefficients. Large: of a strip at a time. */
typedef struct pendres_kernels_formula {
  const formula_program *program;
  const double *at[FORMULA_MOST_PLACES];
  const double *value[FORMULA_OUTPUTS]; /* what it computed last, of each lane */
  _Alignas(64) double y[FORMULA_LANES]; /* room for lanes to be computed at */
  double slots[FORMULA_MOST_SLOTS * FORMULA_LANES];
} pendres_kernels_formula;

/* Do a program's operations on lanes, a multiple of 8 and at most FORMULA_LANES. */
void pendres_kernels_formula_run_base(const formula_program *p, size_t lanes,
                                      const double *const *at, double *slots);
#if defined(__x86_64__)
void pendres_kernels_formula_run_avx2(const formula_program *p, size_t lanes,
                                      const double *const *at, double *slots);
void pendres_kernels_formula_run_avx512(const formula_program *p, size_t lanes,
                                        const double *const *at, double *slots);
#endif

/* Take the coefficients from `lane` on. */
static inline void pendres_kernels_formula_open(pendres_kernels_formula *f,
                                                const pendres_formula *formula,
                                                formula_programs which,
                                                const double *const *power, size_t lane)
{
  f->program = &formula->program[which];
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++)
    f->at[FORMULA_AT_COEFFICIENTS + k] = power[k] + lane;
  pendres_formula_bind(f->program, f->at, f->slots);
}

/* The values at y of each lane, which are read from f->value until the next call. */
static inline void pendres_kernels_formula_at(pendres_kernels_formula *f, size_t lanes,
                                              const double *y)
{
  f->at[FORMULA_AT_X] = y;
  PENDRES_INSTRUCTIONS_OWN(pendres_kernels_formula_run)(f->program, lanes, f->at, f->slots);
  for (int k = 0; k < FORMULA_OUTPUTS; k++)
    if (f->program->output[k] >= 0) f->value[k] = f->at[f->program->output[k]];
}

#endif
