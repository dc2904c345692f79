/*
 * boundary_grow.h -- growing the stable manifold of a saddle by mapping backwards.
 *
 * Owns: the nodes of the curve, their refinement, and when to stop.
 */
#ifndef PENDRES_BOUNDARY_GROW_H
#define PENDRES_BOUNDARY_GROW_H

#include <pendres/boundary.h>

#include "continuation/curve/equations.h"

/*
 * The local manifold at a saddle, going back in time: z(a) = z* + a e + c a^2 f, with a = side *
 * start * ratio^s for 0 <= s <= 1 a fundamental segment: one map further back, s = 0 is where s = 1
 * was. In (y, w) of the backward pendulum, whose w has the opposite sign.
 */
typedef struct pendres_boundary_seed {
  pendres_pendulum backward; /* in time */
  int iterates;              /* drive periods of the map that keeps the side */
  int steps;
  double y, w;               /* the saddle, w reversed */
  double e[2], f[2], bend;   /* unit vectors along and across; c */
  double start, ratio;
} pendres_boundary_seed;

/* A point of the curve: its seed parameter, and where it is, with w forward in time. */
typedef struct pendres_boundary_node {
  double s;
  int generation, side;
  int piece;   /* nodes of one piece are consecutive and neighbours on the curve */
  double y, w; /* y unwrapped */
  double sagitta; /* of the chords beside it */
  double error;   /* in x and v, once it has been estimated */
} pendres_boundary_node;

typedef struct pendres_boundary_curve {
  size_t count, capacity;
  pendres_boundary_node *node;
  int pieces, complete;
} pendres_boundary_curve;

/* Find the local manifold of the map with this number of steps a period. */
pendres_status pendres_boundary_grow_seed(pendres_context *ctx, const pendres_orbit *saddle,
                                          int steps, pendres_boundary_seed *seed);

/* Grow both sides; options are resolved. The curve is appended to. */
pendres_status pendres_boundary_grow(pendres_context *ctx, const pendres_boundary_seed *seed,
                                     const pendres_boundary_options *options,
                                     pendres_boundary_curve *curve);

void pendres_boundary_grow_free(pendres_boundary_curve *curve);

#endif
