/*
 * arc.h -- following a curve of solutions by pseudo-arclength.
 *
 * Owns: predictor, corrector and step length. An arc is a part of such a curve on the way: it
 * predicts several points ahead of its place at once, in lanes side by side, corrects all of them
 * by Newton's method, and keeps those that converged and lie in order; several arcs share the same
 * blocks. What an arc finds depends on itself alone.
 *
 * Source: Keller, in Applications of Bifurcation Theory (1977); Kuznetsov, section 10.2.
 */
#ifndef PENDRES_CONTINUATION_ARC_H
#define PENDRES_CONTINUATION_ARC_H

#include <pendres/continuation.h>

#include "continuation/equations.h"
#include "continuation/scale.h"

enum { PENDRES_ARC_AHEAD = 8, PENDRES_ARC_UNKNOWNS = 4 };

/* A place on the curve. */
typedef struct pendres_arc_point {
  double u[PENDRES_U_COUNT];
  double tangent[PENDRES_ARC_UNKNOWNS]; /* unit vector of the scaled unknowns */
  int held; /* 1 + the number of an unknown that corrections leave as it is; 0: none */
  double arclength;                      /* from the arc's start, of the scaled unknowns */
  pendres_continuation_image image;
  double growth;  /* how sensitive the equations are here; arcs give up where it is too large */
  double null[2]; /* on a curve of folds: the null vector of N - I, its sign kept along the arc, */
  double bending; /* and the derivative of det(N - I) along it, whose zero is a cusp */
} pendres_arc_point;

typedef struct pendres_arc {
  pendres_continuation_map map;
  pendres_continuation_condition condition;
  int unknowns, unknown[PENDRES_ARC_UNKNOWNS]; /* one more than equations */
  double tolerance;                             /* the error of a period that steps are chosen for
                                                   */
  double longest;                               /* the largest spacing of points, in scaled
                                                   arclength */
  /* The arc's own: */
  int apart; /* bit k: the arc began off the orbits that already close by half map number k, and
                stays off them: where its branch meets the one that it was born from, it stays on
                its own */
  int stuck;
  double step; /* spacing of the points ahead */
  pendres_arc_point here;
  double bend[PENDRES_ARC_UNKNOWNS]; /* derivative of the tangent by arclength */
  pendres_arc_point ahead[PENDRES_ARC_AHEAD]; /* what the latest advance found, in order */
  int found;
} pendres_arc;

/* The equations of an arc at so many steps a period. */
pendres_continuation_system pendres_arc_system(const pendres_arc *arc, int steps);

/*
 * The curve of orbits (PENDRES_CONDITION_NONE: of one parameter) or of bifurcations (of two) that
 * an orbit lies on, and its place there.
 */
pendres_arc pendres_arc_of(const pendres_orbit *orbit, pendres_continuation_condition condition,
                           const pendres_parameter *parameter, double spacing,
                           double u[PENDRES_U_COUNT]);

/*
 * Start an arc at u, corrected to the curve across its tangent, towards growing (direction > 0) or
 * falling values of the last unknown; where that stands still, the two directions are opposite.
 * The fields above `apart` are set by the caller. PENDRES_NOT_CONVERGED if there is no curve at u.
 */
pendres_status pendres_arc_begin(pendres_context *ctx, pendres_arc *arc,
                                 const double u[PENDRES_U_COUNT], double direction);

/* A point that is to be corrected, and what becomes of it. */
typedef struct pendres_arc_correction {
  double tangent[PENDRES_ARC_UNKNOWNS]; /* the point stays in the plane across it */
  int steps;                            /* a period */
  double u[PENDRES_U_COUNT];            /* where it is; replaced */
  double rounding;           /* becomes the error of the scaled unknowns by rounding; NaN where the
                                correction failed, or converged to orbits that the arc keeps
                                apart from */
} pendres_arc_correction;

/* Correct n points of one kind of curve: the arc's map, condition, unknowns and what it keeps apart
   from; its place is not read. */
pendres_status pendres_arc_correct(pendres_context *ctx, const pendres_arc *kind, size_t n,
                                   pendres_arc_correction *points);

/* What a point of the curve is beside its place: image, growth, and null vector and bending with
   the sign of the null vector that the point has already. */
pendres_status pendres_arc_describe(pendres_context *ctx, const pendres_arc *kind, int steps,
                                    pendres_arc_point *point);

/* Advance n arcs; each ends with its `ahead` filled, or stuck. Stuck ones are left alone. */
pendres_status pendres_arc_advance(pendres_context *ctx, size_t n, pendres_arc *arcs);

#endif
