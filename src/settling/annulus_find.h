/* annulus_find.h -- looking for rotations among pendulums that settle nowhere; see annulus.h. */
#ifndef PENDRES_ANNULUS_FIND_H
#define PENDRES_ANNULUS_FIND_H

#include "settling/attractor_set.h"

/*
 * Whether some of n lanes of attractor set c, which have not settled so far, are on a rotation that
 * no closed orbit describes; if so it is added with its annulus. One that may be locked to the
 * drive with a period that recurrences find is not. Nothing is done before the pendulums' own
 * budget is as long as what is beside a rotation takes to come to it: no search lasts longer than
 * they do.
 */
pendres_status pendres_annulus_find(pendres_context *ctx, pendres_attractor_set *c, long budget,
                                    size_t n, const pendres_strobe_lane *const *lanes, int *found);

#endif
