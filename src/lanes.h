/*
 * lanes.h -- the N_Vector that holds a block of pendulums side by side.
 *
 * Owns: memory layout and vector operations of a block. A vector has `rows`
 * rows (see kernels.h) of `stride` doubles; stride is the number of lanes in
 * use, rounded up to a multiple of 8, and may change between two integrations:
 * all clones of a vector share one shape.
 *
 * The norm is the largest over the lanes of each lane's own root mean square,
 * so that every lane meets the tolerance of an adaptive step on its own.
 */
#ifndef PENDRES_LANES_H
#define PENDRES_LANES_H

#include <stddef.h>

#include <sundials/sundials_nvector.h>

#include "kernels.h"

enum { PENDRES_LANES_ALIGN = 64, PENDRES_LANES_MULTIPLE = 8 };

/* Shared by all clones; owned by whoever made the first vector. */
typedef struct pendres_lanes_shape {
  size_t rows;
  size_t capacity; /* lanes that memory was taken for, a multiple of 8 */
  size_t stride;   /* lanes in use, rounded up to a multiple of 8 */
  int norm_unused; /* fixed steps: nobody reads the norm, so do not compute it */
  const pendres_kernels *kernels;
} pendres_lanes_shape;

/* Memory for n doubles on a 64-byte boundary, all zero; NULL if there is none. Free with free(). */
double *pendres_lanes_allocate(size_t n);

/* A vector of the shape, all zero; NULL if out of memory. N_VDestroy frees it. */
N_Vector pendres_lanes_create(pendres_lanes_shape *shape, SUNContext sun);

/* Its rows. */
double *pendres_lanes_data(N_Vector v);

#endif
