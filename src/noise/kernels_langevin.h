/*
 * kernels_langevin.h -- the inner loops of thermal noise, chosen at run time.
 *
 * Owns: random words, Gaussian numbers, and the two moves of the integrator of langevin.h
 * for a block of pendulums side by side. kernels_langevin.c is compiled once per instruction
 * set; all variants do the same IEEE operations and give the same bytes.
 *
 * Every array has `stride` entries, one a lane, a multiple of 8, on a 64-byte boundary. Rows
 * that belong together follow each other.
 */
#ifndef PENDRES_KERNELS_LANGEVIN_H
#define PENDRES_KERNELS_LANGEVIN_H

#include <stddef.h>
#include <stdint.h>

#include "model/model.h"

/* How many random words one call of the generator yields for each lane. */
enum { PENDRES_LANGEVIN_WORDS = 4 };

/* How many kinds of forces there are, and kicks by them. */
enum { PENDRES_LANGEVIN_FORCES = PENDRES_MODEL_COUNT + 1 };

/*
 * A block in the frame of a free particle that the drive shakes: y = u + pivot, where
 * pivot = pivot_cos cos theta + pivot_sin sin theta solves y'' + gamma y' = F0 cos theta,
 * and w = du/dt. In this frame the drive shows only as the place where the sine is taken.
 */
typedef struct pendres_langevin_rows {
  double *u, *w;
  const double *pivot_cos, *pivot_sin;
  const double *push;   /* the duration of a kick: half a step */
  const double *spread; /* the standard deviation of a kick's noise */
  const double *bend;   /* the coefficient c of the fourth-order correction 1 - c f'(y) */
  const double *torque; /* I; this and the next are not read where all pendulums are plain */
  const double *parametric;                              /* b */
  const double *coefficient[PENDRES_FORCE_POWERS]; /* of the force: a1, a2, ... */
  const struct pendres_formula *formula;                 /* the force, if it is one */
} pendres_langevin_rows;

typedef struct pendres_kernels_langevin {
  const char *name;
  /* Philox4x32-10 (Random123) of the counters (id low, id high, period, call). It writes four
   * rows of 32-bit words, each of which takes 64 bits. */
  void (*words)(size_t stride, const uint64_t *id, uint32_t period, uint32_t call,
                const uint32_t key[2], uint64_t *words);
  /* Turn four rows of words into four rows of independent Gaussian numbers of variance 1. */
  void (*gauss)(size_t stride, const uint64_t *words, double *gauss);
  /* Move freely: u += reach w, w *= decay. */
  void (*drift)(size_t stride, const double *reach, const double *decay, double *u, double *w);
  /* Move freely, then kick at the drive phase whose cosine and sine are given: for each of the
   * forces that pendres_model_kernel() numbers, since all pendulums of a block have the same. */
  void (*kick[PENDRES_LANGEVIN_FORCES])(size_t stride, const pendres_langevin_rows *rows,
                                        const double *reach, const double *decay, double cosine,
                                        double sine, const double *gauss);
  /* Add y cos theta and y sin theta to sums, with the y that free motion of the given reach leads
   * to at the phase whose cosine and sine are given. The state itself is not changed. */
  void (*sample)(size_t stride, const pendres_langevin_rows *rows, const double *reach,
                 double cosine, double sine, double *sum_cos, double *sum_sin);
} pendres_kernels_langevin;

extern const pendres_kernels_langevin pendres_kernels_langevin_base;
#if defined(__x86_64__)
extern const pendres_kernels_langevin pendres_kernels_langevin_avx2;
extern const pendres_kernels_langevin pendres_kernels_langevin_avx512;
#endif

/* The fastest variant that this processor runs. Never NULL, and static. It is defined in
 * langevin_block.c, since kernels_langevin.c is compiled once for each variant. */
const pendres_kernels_langevin *pendres_kernels_langevin_select(void);

#endif
