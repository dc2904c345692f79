/*
 * equations.h -- equations of fixed points, folds, flips and cusps.
 *
 * Owns: their values and derivatives at many points side by side, and Newton's method on them.
 */
#ifndef PENDRES_CONTINUATION_EQUATIONS_H
#define PENDRES_CONTINUATION_EQUATIONS_H

#include "continuation/curve/map.h"

enum { PENDRES_EQUATIONS_MOST = 4 };

/* The equations at a point: r[i] = 0, i < equations. */
typedef struct pendres_equations {
  int equations;
  double r[PENDRES_EQUATIONS_MOST];
  double j[PENDRES_EQUATIONS_MOST][PENDRES_U_COUNT];
  double nudge; /* step of the differences that a determinant's derivatives are, */
  int central;  /* to both sides */
  pendres_image image;
} pendres_equations;

/* What a condition adds to G(z) = z. */
typedef struct pendres_condition_rules {
  int unknowns; /* of a system of as many equations */
  int critical; /* its orbits are bifurcations: at given parameters they would be singular */
  /* The determinant that vanishes; NULL: no determinant does. */
  double (*determinant)(const pendres_image *image);
  int stencils; /* whether images along null vectors are needed, too */
  /* The equations of a point, from the images at it and at each nudged unknown, and along their
     null vectors. NULL: there are none. */
  void (*rows)(const pendres_system *system, const pendres_image *image, const pendres_image *along,
               pendres_equations *e);
} pendres_condition_rules;

const pendres_condition_rules *
pendres_condition_rules_of(pendres_condition condition);

/* A system of as many equations as unknowns, which are the first of `unknown`. Its steps are not
   chosen yet. */
pendres_system pendres_system_of(const pendres_map *map, pendres_condition condition,
                                 const int *unknown);

/* The equations of a system at n points, with their derivatives by its unknowns. */
pendres_status pendres_equations_at(pendres_context *ctx, const pendres_system *system, size_t n,
                                    const pendres_u *u, pendres_equations *out);

/*
 * Solve a system of as many equations as unknowns from u on, by Newton's method; u is replaced, and
 * *at is what the equations were before the last step. Steps are cut at `longest`.
 * PENDRES_NOT_CONVERGED without a message if there is no solution near.
 */
pendres_status pendres_equations_solve(pendres_context *ctx, const pendres_system *system,
                                       double longest, pendres_u u, pendres_equations *at);

/* a x = b for n <= 5, by GSL's LU decomposition; a and b are overwritten, b by x. 0 if singular. */
int pendres_equations_linear(int n, double a[][PENDRES_U_COUNT], double *b);

#endif
