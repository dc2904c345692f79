/*
 * kernels_nystrom.h -- a drive period of many pendulums by a Runge-Kutta-Nystrom method.
 *
 * Owns: the inner loop of bulk work: settling, basins, ensembles, trials of sweeps; and of chaos,
 * where a trajectory counts only as one of many, with exact tangents. Like kernels.c it is compiled
 * once for each instruction set, and gives the same bytes with each.
 *
 * Friction is taken out exactly. Within a step h, with E(t) = exp(-friction t / 2) and y = E u,
 *
 *     u'' = (forces at E u) / E + (friction / 2)^2 u,
 *
 * which has no u': the eight stages of a Nystrom method of order eight need no more than the places
 * u, half the sums of a Butcher table, of which the same order takes twelve.
 *
 * Method: J. R. Dormand, M. E. A. El-Mikkawy and P. J. Prince, High-order embedded
 * Runge-Kutta-Nystrom formulae, IMA J. Numer. Anal. 7 (1987) 423: RKN8(6)9FM, without its last
 * stage, which serves an estimate of the error alone.
 */
#ifndef PENDRES_KERNELS_NYSTROM_H
#define PENDRES_KERNELS_NYSTROM_H

#include <stddef.h>

#include "engine/kernels/kernels.h"

enum { PENDRES_NYSTROM_STAGES = 8, PENDRES_NYSTROM_ORDER = 8 };

/* The stages' places in a step, in twentieths of it. */
static const int pendres_nystrom_node[PENDRES_NYSTROM_STAGES] = {0, 1, 2, 6, 10, 14, 18, 20};

/* Which models are computed in single precision: those without a header of their own. */
static inline int pendres_nystrom_may_single(pendres_model_terms model)
{
  return model <= PENDRES_MODEL_POLYNOMIAL;
}

/* The steps of a period: cosines of the drive's phase, by step and stage. */
typedef struct pendres_nystrom_steps {
  int steps;
  double *cosine;
} pendres_nystrom_steps;

/* The lanes of a block; arrays are on 64-byte boundaries. */
typedef struct pendres_nystrom_lanes {
  size_t lanes; /* a multiple of 8 */
  pendres_model_terms model;
  double *y, *w;
  pendres_coefficients k;
  pendres_carried off; /* yy NULL: errors are not carried */
  double *tangent_y, *tangent_w; /* as in kernels.h; NULL: there are none */
} pendres_nystrom_lanes;

typedef struct pendres_kernels_nystrom {
  /* Advance states, and the errors or tangents that they carry, by a period; the second one in
     single precision, for the forces that pendres_nystrom_may_single() tells. */
  void (*run)(const pendres_nystrom_steps *s, const pendres_nystrom_lanes *block);
  void (*run_single)(const pendres_nystrom_steps *s, const pendres_nystrom_lanes *block);
} pendres_kernels_nystrom;

extern const pendres_kernels_nystrom pendres_kernels_nystrom_base;
#if defined(__x86_64__)
extern const pendres_kernels_nystrom pendres_kernels_nystrom_avx2;
extern const pendres_kernels_nystrom pendres_kernels_nystrom_avx512;
#endif

#endif
