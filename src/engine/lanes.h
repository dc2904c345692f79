/*
 * lanes.h -- the N_Vector that holds a block of pendulums side by side.
 *
 * Owns: memory layout and vector operations of a block. A vector has `rows`
 * rows (see kernels.h) of `stride` lanes; stride is the number of lanes in
 * use, rounded up to a multiple of 8, and may change between two integrations:
 * all clones of a vector share one shape.
 *
 * Lanes never mix, so the block is cut into strips of lanes, and what can be is
 * put off (lanes_tape.h) and then done strip by strip: all vectors of a strip
 * fit the nearest cache, however many lanes the block has.
 *
 * The norm is the largest over the lanes of each lane's own root mean square,
 * so that every lane meets the tolerance of an adaptive step on its own.
 */
#ifndef PENDRES_LANES_H
#define PENDRES_LANES_H

#include <stddef.h>

#include <sundials/sundials_nvector.h>

#include "engine/kernels.h"

enum { PENDRES_LANES_ALIGN = 64, PENDRES_LANES_MULTIPLE = 8 };

struct pendres_lanes_tape;

/* Shared by all clones; owned by whoever made the first vector. */
typedef struct pendres_lanes_shape {
  size_t rows;
  size_t capacity; /* lanes that memory was taken for, a multiple of 8 */
  size_t stride;   /* lanes in use, rounded up to a multiple of 8 */
  size_t strip;    /* lanes of a strip, a multiple of 8, ... */
  size_t wider;    /* ... and of those below this lane 8 more */
  int norm_unused; /* fixed steps: nobody reads the norm, so do not compute it */
  const pendres_kernels *kernels;
  pendres_coefficients coefficients; /* of the slope, an entry a lane; not owned */
  pendres_carried off;               /* errors of the lanes, likewise; NULL: not carried */
  size_t vectors;                    /* made so far, for their place in the cache */
  struct pendres_lanes_tape *tape;   /* what was put off */
} pendres_lanes_shape;

/* Memory for n doubles on a 64-byte boundary, all zero; NULL if there is none. Free with free(). */
double *pendres_lanes_allocate(size_t n);

/* A shape of that many rows and lanes, all in use; nonzero if out of memory. */
int pendres_lanes_open(pendres_lanes_shape *shape, size_t rows, size_t lanes,
                       const pendres_kernels *kernels);
/* After its last vector is gone. */
void pendres_lanes_close(pendres_lanes_shape *shape);

/* From now on this many lanes, at most the capacity. Vectors keep no values. */
void pendres_lanes_resize(pendres_lanes_shape *shape, size_t lanes);

/* How many lanes the strip has that starts with this lane. */
static inline size_t pendres_lanes_strip(const pendres_lanes_shape *shape, size_t lane)
{
  return shape->strip + (lane < shape->wider ? PENDRES_LANES_MULTIPLE : 0);
}

/* A vector of the shape, all zero; NULL if out of memory. N_VDestroy frees it. */
N_Vector pendres_lanes_create(pendres_lanes_shape *shape, SUNContext sun);

/* All rows in and out, row after row, each `stride` doubles long. */
void pendres_lanes_write(N_Vector v, const double *rows);
void pendres_lanes_read(N_Vector v, double *rows);

/* slope = the right-hand side at y, of the equation that belongs to the number of rows. */
void pendres_lanes_slope(N_Vector y, N_Vector slope, double cos_theta);

/* The errors of the lanes over a step of this length that has ended at y. */
void pendres_lanes_carry(N_Vector y, double step);

#endif
