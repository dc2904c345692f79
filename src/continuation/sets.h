/*
 * sets.h -- sets of branches and of curves, and the curves that many bifurcations lie on, found in
 * parts that know nothing of each other.
 *
 * Owns: which bifurcations can lie on one curve, so that all others can be left to other threads;
 * how what these find is put together. The curves are those that pendres_curves_extend() finds, in
 * its order.
 */
#ifndef PENDRES_SETS_H
#define PENDRES_SETS_H

#include "continuation/curve.h"

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

/* As for branches, see continuation.h. */
size_t pendres_curves_packed_size(const pendres_curves *curves);
void pendres_curves_pack(const pendres_curves *curves, void *bytes);
pendres_status pendres_curves_unpack(size_t size, const void *bytes, pendres_curves **out);

#endif
