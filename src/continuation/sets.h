/*
 * sets.h -- sets of branches and of curves, and the curves that many bifurcations lie on, found in
 * parts that know nothing of each other.
 *
 * Owns: which bifurcations can lie on one curve, so that those of different curves can be given to
 * different threads; and how the curves that these find are put together. The curves are those that
 * pendres_curves_find() finds, in its order.
 */
#ifndef PENDRES_SETS_H
#define PENDRES_SETS_H

#include "base/bytes.h"
#include "continuation/curve/curve.h"

/* 0 where two bifurcations are of one family: none lies on a curve of another family. Otherwise
   below 0 where the curves of the first one's family cost more, as those of long orbits do; an
   order. */
int pendres_family_order(const pendres_bifurcation *a, const pendres_bifurcation *b);

/* Some of many bifurcations, and in what order. */
typedef struct pendres_curve_starts {
  const pendres_bifurcation *all;
  size_t n;
  const size_t *which; /* [n] their numbers, ascending; NULL: 0 ... n - 1 */
} pendres_curve_starts;

/* Add the curves of these bifurcations that are on none of `known`, which may be NULL, and on none
   of `curves`. On failure *at is the number of the bifurcation that failed, and what was added
   before it stays. Errors as for pendres_curve_follow(). */
pendres_status pendres_curves_add(pendres_context *ctx, const pendres_curve_starts *starts,
                                  const pendres_curve_options *options,
                                  const pendres_curves *known, pendres_curves *curves, size_t *at);

/* An empty set; NULL: out of memory. */
pendres_curves *pendres_curves_create(void);

/* Move the curves of n sets that start at bifurcations before number `end` to another set, in the
   order of these bifurcations. PENDRES_OUT_OF_MEMORY: some may have been moved. */
pendres_status pendres_curves_join(size_t n, pendres_curves *const *parts, size_t end,
                                   pendres_curves *to);

/* Pass a set of branches, or of curves, NULL for one without any, as plain bytes; reading makes a
   new one, to be freed whether it succeeds or not. Threads may write the same set at a time. */
void pendres_curves_pass(pendres_bytes *bytes, int branches, pendres_curves **set);

/*
 * Add the branches that n bifurcations lie on, each once: one that a branch of the set has met
 * already is passed over. Bifurcations at which curves in two parameters cross a value of the
 * second one thus lead to branches on which none of the known orbits lies. options: those that the
 * set was found with. A bifurcation from which no branch can be followed counts as skipped. On
 * failure the set holds what was added so far. Errors are those of pendres_branch_follow().
 */
pendres_status pendres_branches_extend(pendres_context *ctx, size_t n,
                                       const pendres_bifurcation *bifurcations,
                                       const pendres_branch_options *options,
                                       pendres_branches *branches);

/* Call take(arg, k, orbit) for each orbit of a branch at each of n finite values of its parameter,
   value[k], in their order; within a door, whose units all are in. */
typedef void pendres_branch_crossed(void *arg, size_t k, const pendres_orbit *orbit);
pendres_status pendres_branch_cross_each(pendres_context *ctx, const pendres_branch *branch,
                                         size_t n, const double *value,
                                         pendres_branch_crossed *take, void *arg);

#endif
