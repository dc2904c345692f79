/*
 * lanes_shape.h -- how many pendulums a block holds, and how its memory is divided.
 *
 * Owns: the shape that all vectors of a block share. A vector has `rows` rows (kernels.h) of
 * `stride` lanes; stride is the number of lanes in use, rounded up to a multiple of 8, and may
 * change between two integrations.
 *
 * Lanes do not interact, so the block is divided into strips of lanes. Operations are deferred
 * where possible (lanes_tape.h) and then done strip by strip: all vectors of a strip fit into the
 * nearest cache, however many lanes the block has.
 */
#ifndef PENDRES_LANES_SHAPE_H
#define PENDRES_LANES_SHAPE_H

#include <stddef.h>

#include "engine/kernels/kernels.h"

enum { PENDRES_LANES_MULTIPLE = 8 };

struct pendres_lanes_tape;

/* Shared by all clones; owned by the creator of the first vector. */
typedef struct pendres_lanes_shape {
  size_t rows;
  size_t capacity; /* lanes that memory was taken for, a multiple of 8 */
  size_t stride;   /* lanes in use, rounded up to a multiple of 8 */
  size_t strip;    /* lanes of a strip, a multiple of 8, ... */
  size_t wider;    /* ... and of those below this lane 8 more */
  int norm_unused; /* fixed steps: the norm is not used, so it is not computed */
  const pendres_kernels *kernels;
  pendres_model_terms model; /* of all lanes */
  int drags;                 /* some have friction other than damping x' */
  pendres_coefficients coefficients; /* of the slope, an entry a lane; not owned */
  pendres_carried off;               /* errors of the lanes, likewise; NULL: not carried */
  pendres_tangents tangent;          /* or these */
  size_t vectors;                    /* made so far, for their place in the cache */
  struct pendres_lanes_tape *tape;   /* deferred operations */
  struct _generic_N_Vector *spare;   /* given out as a clone when there is no memory for one; */
  int starved;                       /* this is set then: nothing computed since is valid */
} pendres_lanes_shape;

/* How many lanes the strip has that starts with this lane. */
static inline size_t pendres_lanes_strip(const pendres_lanes_shape *shape, size_t lane)
{
  return shape->strip + (lane < shape->wider ? PENDRES_LANES_MULTIPLE : 0);
}

/* From now on this many lanes, at most the capacity; no operation may be deferred at this time. */
void pendres_lanes_shape_cut(pendres_lanes_shape *shape, size_t lanes);

/* Do operations one after the other, on all lanes, strip by strip. */
void pendres_lanes_shape_run(const pendres_lanes_shape *shape,
                             const pendres_operation *operations, size_t n);

#endif
