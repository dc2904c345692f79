/*
 * kernels_split.h -- a drive period of many pendulums in short steps that are solved exactly but
 * for kicks.
 *
 * Owns: the inner loop for chaos, where a trajectory counts only as one of many: a method of fourth
 * order with one force a step, at a third of the cost of tables of order eight, and exact tangents.
 * Like kernels.c it is compiled once for each instruction set, and gives the same bytes with each.
 *
 * With A the free motion under friction and the drive, and B the kick by the force -stiffness f, a
 * step h is
 *
 *     exp(h/2 A) exp(h B') exp(h/2 A),   B' = B + h^2/24 [B, [A, B]],
 *
 * where [B, [A, B]] is twice the force times its derivative, so that B' is a kick as well (Takahashi
 * and Imada, Journal of the Physical Society of Japan 53 (1984) 3765). Its error of second order is
 * a change of coordinates, h^2/24 [A, B], which is made at both ends of a period. Thus strobe
 * points are correct to fourth order, and what does not depend on coordinates, such as multipliers
 * and exponents, would be without it. A is solved exactly: in the frame of a free particle that the
 * drive shakes, y = u + pivot, u only slows down.
 */
#ifndef PENDRES_KERNELS_SPLIT_H
#define PENDRES_KERNELS_SPLIT_H

#include <stddef.h>

#include "engine/kernels.h"

/* The steps of a period: the drive's phase in the middle of each. */
typedef struct pendres_split_steps {
  int steps;
  double *cosine, *sine; /* [steps] */
} pendres_split_steps;

/* The lanes of a block; arrays are on 64-byte boundaries. Tangents, as in kernels.h, are those of the
   steps' own coordinates: their growth is right over long times. */
typedef struct pendres_split_lanes {
  size_t lanes; /* a multiple of 8 */
  pendres_model_terms model;
  double *y, *w;
  double *tangent_y, *tangent_w; /* NULL: there are none */
  pendres_coefficients k;
} pendres_split_lanes;

typedef struct pendres_kernels_split {
  /* Advance states, and tangents, by a period. */
  void (*run)(const pendres_split_steps *s, const pendres_split_lanes *block);
} pendres_kernels_split;

extern const pendres_kernels_split pendres_kernels_split_base;
#if defined(__x86_64__)
extern const pendres_kernels_split pendres_kernels_split_avx2;
extern const pendres_kernels_split pendres_kernels_split_avx512;
#endif

#endif
