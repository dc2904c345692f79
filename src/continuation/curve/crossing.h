/*
 * crossing.h -- branch points, where two branches cross.
 *
 * Owns: their equations, whether a branch passes one, and the way along the branch that crosses.
 *
 * Of an orbit z and a parameter p, with F = G(z, p) - z, the derivative B = (DF, dF/dp) has the
 * rank two on a branch, whose tangent is its null vector. At a fold DF alone is singular; at a
 * branch point B has the rank one. By elimination with its largest entry, of row r, this is
 *
 *   F_r = 0,   h = 0,   with l B = (0, h) and l F = beta,
 *
 * where l takes a multiple of row r from the other one and h has the two other columns: three
 * equations for y, w and p that are regular where two branches cross at an angle. beta is left.
 * Where branches cross it is 0; where they only come close, since something small keeps them apart,
 * it tells the size of that: then there are two folds next to each other, or none.
 *
 * The determinant of B bordered by the tangent does not vanish on a branch, keeps its sign at folds
 * and changes it at branch points.
 *
 * Source: Kuznetsov, Elements of Applied Bifurcation Theory, section 10.2.2; Moore, SIAM Journal on
 * Numerical Analysis 17 (1980) 567, for the equations with beta.
 */
#ifndef PENDRES_CONTINUATION_CROSSING_H
#define PENDRES_CONTINUATION_CROSSING_H

#include <pendres/continuation.h>

#include "continuation/curve/map.h"

/* The largest entry of B. */
typedef struct pendres_crossing_pivot {
  int parameter; /* the place of p in a point */
  int row, column;
} pendres_crossing_pivot;

pendres_crossing_pivot pendres_crossing_pivot_of(const pendres_image *image, int parameter);

/* F_r, the two of h, and beta. */
void pendres_crossing_rows(const pendres_crossing_pivot *pivot, const pendres_image *image,
                           double rows[4]);

/* Whether beta is 0 within the rounding of this many steps and another error. */
int pendres_crossing_closes(const pendres_image *image, int parameter, int steps, double error);

/*
 * The determinant of B bordered by a branch's tangent: along the branch in one direction it keeps
 * its sign, at folds too, and changes it where branches cross.
 */
double pendres_crossing_bordered(const pendres_image *image, int parameter,
                                 const double tangent[3]);

/*
 * The direction of the branch that crosses at a branch point u, from about that of the branch
 * itself; both are of unit length in the scale of arclength. In the plane of null vectors of B both
 * directions t solve l D2F(t, t) = 0. PENDRES_NOT_CONVERGED if they are not told apart.
 */
pendres_status pendres_crossing_direction(pendres_context *ctx, const pendres_system *system,
                                          const pendres_u u, const double own[3],
                                          double crossing[3]);

#endif
