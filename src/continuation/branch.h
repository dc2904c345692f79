/*
 * branch.h -- what the parts of continuation share of a branch.
 *
 * Owns: branches that are gone on with, without measures.
 */
#ifndef PENDRES_CONTINUATION_BRANCH_H
#define PENDRES_CONTINUATION_BRANCH_H

#include <pendres/continuation.h>

#include "continuation/curve/curve.h"

/* What is wrong with options and starts, a static sentence; NULL if nothing is. */
const char *pendres_branch_refuses(const pendres_branch_options *options, size_t n,
                                   const pendres_orbit *starts);

/*
 * A branch that is only to lead on, for as long as is needed: from an orbit at first, to be freed
 * by pendres_branch_free(), and on within bounds, where it has ended by the number of points alone.
 * Its regular points are those of pendres_curve_leave_coarse(), at a fifth of the cost of others,
 * and are not checked. Bifurcations are whole. Once it has more points, all have other numbers.
 */
pendres_status pendres_branch_begin(pendres_context *ctx, const pendres_orbit *orbit,
                                    pendres_parameter parameter, double spacing,
                                    pendres_branch **out);
pendres_status pendres_branch_extend(pendres_context *ctx, pendres_branch *branch,
                                     const pendres_curve_bounds *bounds);

/* A bifurcation with the Poincare point of its orbit from which orbits of twice the period leave
   furthest: at others they may be so close to it that their branch is hard to follow. */
pendres_status pendres_bifurcation_widest(pendres_context *ctx, const pendres_bifurcation *at,
                                          pendres_bifurcation *out);

/* The parameter of point i. */
double pendres_branch_value(const pendres_curve *branch, size_t i);

/* Where to look for the orbit at a value of the parameter between two orbits of a branch: this part
   of the way from one to the other, between which x may differ by whole turns. */
pendres_orbit_guess pendres_branch_between(const pendres_orbit *from, const pendres_orbit *to,
                                           double part, pendres_parameter parameter, double value);

/* Set the doubt of all points: whether the points and the bifurcations agree. */
void pendres_branch_check(pendres_curve *branch);

#endif
