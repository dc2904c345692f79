/*
 * trail.h -- whole curves: both ways from a start, within bounds, with their zeros.
 *
 * Owns: running arcs to their ends, putting the two ways of a start together, correcting all
 * points at two numbers of steps, and finding where test functions change their sign.
 */
#ifndef PENDRES_CONTINUATION_TRAIL_H
#define PENDRES_CONTINUATION_TRAIL_H

#include <pendres/continuation.h>

#include "continuation/orbit.h"
#include "continuation/arc.h"

typedef struct pendres_trail {
  pendres_arc kind; /* map, condition and unknowns; its place is not meaningful */
  size_t count, capacity;
  pendres_arc_point *point; /* in order, arclength ascending from 0 */
  pendres_branch_end end[2];
  int closed; /* the last point is followed by the first, */
  double round; /* whose y is meant to be so much larger: whole turns, where the way round leads
                   from well to well */
} pendres_trail;

/* Bounds of the parameters among the unknowns, in their order, and of the arc. */
typedef struct pendres_trail_bounds {
  double low[2], high[2];
  double wildest;
  size_t most_points; /* each way */
} pendres_trail_bounds;

/* A solution to start from, and the curve that it lies on. */
typedef struct pendres_trail_start {
  pendres_arc kind;
  double u[PENDRES_U_COUNT];
} pendres_trail_start;

/* Follow n curves. On failure all trails are empty. `which` (may be NULL) is the start at fault. */
pendres_status pendres_trail_follow(pendres_context *ctx, size_t n,
                                    const pendres_trail_start *starts,
                                    const pendres_trail_bounds *bounds, pendres_trail *trails,
                                    size_t *which);
void pendres_trail_free(pendres_trail *trail);

/*
 * All points of a trail, corrected at coarse and fine steps so that errors come down to the
 * tolerance where they can: pairs[count] are written, and the errors of the unknown parameters,
 * error[i][0..1]. Each point stays in the plane across its tangent.
 */
pendres_status pendres_trail_polish(pendres_context *ctx, const pendres_trail *trail,
                                    pendres_continuation_pair *pairs, double (*error)[2]);

/* A function of a point of a trail. */
typedef double pendres_trail_test(const pendres_arc_point *point);

/* Where a test function is thought to vanish: between points i and i + 1 (or the first, if closed),
   this share of the way. */
typedef struct pendres_trail_zero {
  size_t i;
  double part;
  int half; /* of a birth: the number of the half map whose orbits the branch was born from */
} pendres_trail_zero;

/*
 * Add points to a trail where a test function comes close to 0 without changing its sign from one
 * point to the next, until it does or is known not to: two folds may be close together.
 */
pendres_status pendres_trail_refine(pendres_context *ctx, pendres_trail *trail,
                                    pendres_trail_test *test);

/* Find up to `room` zeros, in order; returns their number. A minimum of about 0 counts as one:
   where a branch is born from another the determinant touches 0. */
size_t pendres_trail_zeros(const pendres_trail *trail, pendres_trail_test *test, size_t room,
                           pendres_trail_zero *zeros);

/* Where a trail passes branch points, or places where branches come so close that its points have
   led from one to another: up to `room`, in order. Births are among them. */
size_t pendres_trail_crossings(const pendres_trail *trail, size_t room, pendres_trail_zero *zeros);

/* Where a trail that keeps apart from orbits that close by a half map passes one: the orbit was
   born there, and beyond it is its own image. Up to `room`, in order. */
pendres_status pendres_trail_births(pendres_context *ctx, const pendres_trail *trail, size_t room,
                                    pendres_trail_zero *zeros, size_t *count);

/* The point at a zero, by linear interpolation, and the length of the chord. */
double pendres_trail_between(const pendres_trail *trail, const pendres_trail_zero *zero,
                             double u[PENDRES_U_COUNT]);

#endif
