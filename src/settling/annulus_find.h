/* annulus_find.h -- looking for rotations among pendulums that settle nowhere; see annulus.h. */
#ifndef PENDRES_ANNULUS_FIND_H
#define PENDRES_ANNULUS_FIND_H

#include "settling/attractor_set.h"

/*
 * Whether some of n lanes of attractor set c, which have not settled so far, are on a rotation that
 * no closed orbit describes; if so it is added with its annulus. One that may be locked to the
 * drive with a period that recurrences find is not.
 */
pendres_status pendres_annulus_find(pendres_context *ctx, pendres_attractor_set *c, size_t n,
                                    const pendres_strobe_lane *const *lanes, int *found);

#endif
