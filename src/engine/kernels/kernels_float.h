/*
 * kernels_float.h -- a drive period of many plain pendulums in single precision.
 *
 * Owns: the inner loop for pendulums whose wanted error is larger than single precision rounds by:
 * twice as many lanes to a vector, and a shorter sine. Like kernels.c it is compiled once for each
 * instruction set, and gives the same bytes with each.
 */
#ifndef PENDRES_KERNELS_FLOAT_H
#define PENDRES_KERNELS_FLOAT_H

#include <stddef.h>

#include "engine/kernels/kernels.h"
#include "engine/kernels/tables.h"

/* A sum over the slopes of earlier stages. */
typedef struct pendres_float_sum {
  int terms;
  struct {
    int stage;
    float c; /* the table's coefficient times the step */
  } term[PENDRES_TABLES_MOST_STAGES];
} pendres_float_sum;

/* The steps of a period. */
typedef struct pendres_float_steps {
  int steps, stages;
  float step;
  pendres_float_sum sum[PENDRES_TABLES_MOST_STAGES + 1]; /* of each stage, and of the step */
  float *cosine; /* of the drive phase, by step and stage */
} pendres_float_steps;

/* The lanes of a block; arrays are on 64-byte boundaries. */
typedef struct pendres_float_lanes {
  size_t lanes; /* a multiple of 8 */
  double *y, *w;
  pendres_coefficients k;
  pendres_carried off;
} pendres_float_lanes;

typedef struct pendres_kernels_float {
  /* Advance states, and the errors that they carry, by a period. */
  void (*run)(const pendres_float_steps *s, const pendres_float_lanes *block);
} pendres_kernels_float;

extern const pendres_kernels_float pendres_kernels_float_base;
#if defined(__x86_64__)
extern const pendres_kernels_float pendres_kernels_float_avx2;
extern const pendres_kernels_float pendres_kernels_float_avx512;
#endif

#endif
