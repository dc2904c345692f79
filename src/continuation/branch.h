/*
 * branch.h -- what the parts of continuation share of a branch.
 *
 * Owns: branches without measures.
 */
#ifndef PENDRES_CONTINUATION_BRANCH_H
#define PENDRES_CONTINUATION_BRANCH_H

#include <pendres/continuation.h>

#include "continuation/curve.h"

/* What is wrong with options and starts, a static sentence; NULL if nothing is. */
const char *pendres_branch_refuses(const pendres_branch_options *options, size_t n,
                                   const pendres_orbit *starts);

/* As pendres_branch_follow() from one orbit, but its regular points are those of
   pendres_curve_outline(), at a fifth of the cost, and have no doubts. Bifurcations are whole. */
pendres_status pendres_branch_outline(pendres_context *ctx, const pendres_orbit *start,
                                      const pendres_branch_options *options, pendres_branch **out);

/* The parameter of point i. */
double pendres_branch_value(const pendres_curve *branch, size_t i);

/* Set the doubt of all points: whether the points and the bifurcations agree. */
void pendres_branch_check(pendres_curve *branch);

#endif
