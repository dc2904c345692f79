/*
 * kernels_split.h -- a drive period of many pendulums in short steps that are solved exactly but
 * for kicks.
 *
 * Owns: the inner loop for chaos, where a trajectory counts only as one of many: a method of sixth
 * order with three forces a step, at a third of the cost of tables of order eight, and exact
 * tangents. Like kernels.c it is compiled once for each instruction set, and gives the same bytes
 * with each.
 *
 * With A the free motion under friction and the drive, and B the kick by the force -stiffness f, a
 * step h is
 *
 *     exp(a h A) exp(b h B_1) exp((1/2 - a) h A) exp((1 - 2b) h B_2) exp((1/2 - a) h A)
 *       exp(b h B_1) exp(a h A),
 *
 * where B_1 and B_2 are B with a multiple of h^2 [B, [A, B]], which is twice the force times its
 * derivative, so that they are kicks as well. Up to a change of coordinates, k h^2 [A, B] + ...,
 * the step is that of the pendulum to sixth order (a processed method: S. Blanes, F. Casas and J.
 * Ros, Applied Numerical Mathematics 39 (2001) 245). A splitting therefore has coordinates of its
 * own, and what does not depend on them, such as multipliers, exponents and where chaos ends, has
 * an error of sixth order. Going over to them and back at both ends of a run leaves one of fourth
 * order, once. A is solved exactly: in the frame of a free particle that the drive shakes,
 * y = u + pivot, u only slows down.
 */
#ifndef PENDRES_KERNELS_SPLIT_H
#define PENDRES_KERNELS_SPLIT_H

#include <stddef.h>

#include "engine/kernels/kernels.h"

enum { PENDRES_SPLIT_KICKS = 3 /* a step */ };

/*
 * The three conditions of sixth order leave one of a, b and the multiples of [B, [A, B]] free. They
 * were solved with b given, in 40 digits; of b between 0.2 and 0.32 this one has the least errors
 * in multipliers of pendulums. `bend`: an outer kick and the middle one are f (1 - bend h^2 f').
 */
static const double pendres_split_a = -0.067272469177126937895, pendres_split_b = 0.27;
static const double pendres_split_bend[2] = {-2.0 * -0.00085875763051635054237 / 0.27,
                                             -2.0 * -0.01502522238812714271 / 0.46};
static const double pendres_split_k = 0.04521880799;

/* The steps of a period: the drive's phase at each kick. */
typedef struct pendres_split_steps {
  int steps;
  double *cosine, *sine; /* [PENDRES_SPLIT_KICKS * steps] */
} pendres_split_steps;

/* The lanes of a block, in the splitting's coordinates; arrays are on 64-byte boundaries. Tangents
   are as in kernels.h. */
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
