/* kernels_formula.c -- the loop over a formula's operations; see kernels_formula.h. */
#include "engine/kernels/kernels_formula.h"

void PENDRES_INSTRUCTIONS_OWN(pendres_kernels_formula_run)(const formula_program *p, size_t lanes,
                                                           const double *const *at, double *slots)
{
  pendres_formula_run(p, lanes & ~(size_t)7, at, slots);
}
