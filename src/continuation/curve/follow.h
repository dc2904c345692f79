/*
 * follow.h -- the one follower: along a curve of solutions by pseudo-arclength.
 *
 * Owns: predictor, corrector and step length. A follower has a place on a curve of any equations.
 * It predicts several points ahead at once, which are integrated side by side, corrects all of them
 * by Newton's method, and keeps those that converged and lie in order. Several followers share
 * blocks; what one of them finds does not depend on the others.
 *
 * Source: Keller, in Applications of Bifurcation Theory (1977); Kuznetsov, section 10.2.
 */
#ifndef PENDRES_FOLLOW_H
#define PENDRES_FOLLOW_H

#include <pendres/continuation.h>

#include "continuation/curve/equations.h"

enum { PENDRES_AHEAD = 8 };

/* What is followed, and how finely. */
typedef struct pendres_followed {
  pendres_system system; /* one unknown more than equations; steps are chosen on the
                                         way */
  double tolerance; /* the error of a period that steps are chosen for */
  double spacing;   /* the largest spacing of points, in scaled arclength */
  int apart; /* set where a follower begins. Bit k: its orbits do not close by half map number k,
                and points that do are refused, so that the follower does not change over to the
                branch from which its own was born */
} pendres_followed;

/* A place on a curve. */
typedef struct pendres_curve_node {
  pendres_u u;
  double tangent[PENDRES_UNKNOWNS]; /* unit vector of the scaled unknowns */
  int held; /* 1 + the number of an unknown that corrections do not change; 0: none */
  double arclength; /* from where the follower began, of the scaled unknowns */
  pendres_image image;
  double growth;  /* by how much the equations enlarge errors; curves end where it is too large */
  double null[2]; /* of folds: the null vector of N - I, its sign kept along the curve, */
  double bending; /* and the derivative of det(N - I) along it, whose zero is a cusp */
} pendres_curve_node;

typedef struct pendres_follower {
  pendres_followed kind;
  int stuck;
  double step; /* spacing of the points ahead */
  pendres_curve_node here;
  double bend[PENDRES_UNKNOWNS]; /* derivative of the tangent by arclength */
  pendres_curve_node ahead[PENDRES_AHEAD]; /* what the latest advance found, in order */
  int found;
} pendres_follower;

/*
 * The curve of orbits (PENDRES_CONDITION_NONE: of one parameter) or of bifurcations (of two) that
 * an orbit lies on, and its place there.
 */
pendres_followed pendres_followed_of(const pendres_orbit *orbit, pendres_condition condition,
                                     const pendres_parameter *parameter, double spacing,
                                     pendres_u u);

/*
 * Begin at u, corrected to the curve across its tangent, towards growing (direction > 0) or
 * falling values of the last unknown; where that stands still, the two directions are opposite.
 * PENDRES_NOT_CONVERGED if there is no curve at u.
 */
pendres_status pendres_follow_begin(pendres_context *ctx, const pendres_followed *kind,
                                    const pendres_u u, double direction, pendres_follower *out);

/* Advance n followers; each ends with its `ahead` filled, or stuck. Stuck ones are left alone. */
pendres_status pendres_follow_advance(pendres_context *ctx, size_t n,
                                      pendres_follower *const *followers);

/* A point that is to be corrected, and what becomes of it. */
typedef struct pendres_correction {
  const pendres_followed *kind;
  double tangent[PENDRES_UNKNOWNS]; /* the point stays in the plane across it */
  int steps;                        /* a period */
  pendres_u u;                      /* where it is; replaced */
  /* Set by the corrector: */
  enum { PENDRES_CORRECTION_ACTIVE, PENDRES_CORRECTION_CONVERGED, PENDRES_CORRECTION_FAILED } state;
  int waiting;
  pendres_equations at;
} pendres_correction;

/* Correct n points. Those that converge to orbits from which their kind keeps apart fail, too. */
pendres_status pendres_follow_correct(pendres_context *ctx, size_t n, pendres_correction *points);

/* Correct a point with steps for an error of about `tolerance` a period; *found: it has
   converged. */
pendres_status pendres_follow_place(pendres_context *ctx, double tolerance,
                                    pendres_correction *point, int *found);

/* The error of the scaled unknowns of a corrected point by rounding; NaN where that failed. */
double pendres_correction_rounding(const pendres_correction *point);

/* Set image, growth, tangent, null vector and bending of a node. The null vector keeps the sign
   that it has in the node. */
pendres_status pendres_follow_describe(pendres_context *ctx, const pendres_followed *kind,
                                       int steps, pendres_curve_node *node);

/* A function of nodes. */
typedef double pendres_curve_function(const pendres_curve_node *node);

/*
 * What a curve is searched for: that a function of its nodes changes its sign, or comes back to the
 * value that it began with; and a function that locates the place between two nodes, near u.
 */
typedef struct pendres_goal {
  const char *start; /* what the curve is of: "orbit" */
  pendres_curve_function *value;
  int comes_back;
  /* PENDRES_NOT_CONVERGED: there is nothing, and the search goes on; PENDRES_NOT_FOUND: it goes on
     in the other direction. */
  pendres_status (*locate)(pendres_context *ctx, const pendres_followed *kind,
                           const pendres_curve_node nodes[2], const pendres_u u, void *out);
} pendres_goal;

/*
 * Search along a curve from u on: first towards growing values of the last unknown (first > 0), or
 * falling ones (< 0), or in the direction in which the function comes closer to 0; then the other
 * way. PENDRES_NOT_FOUND, without a message, if it is not within a range of parameters.
 */
pendres_status pendres_follow_search(pendres_context *ctx, const pendres_followed *kind,
                                     const pendres_u u, const pendres_goal *goal,
                                     double first, void *out);

#endif
