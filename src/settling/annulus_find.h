/* annulus_find.h -- looking for rotations among pendulums that settle nowhere; see annulus.h. */
#ifndef PENDRES_ANNULUS_FIND_H
#define PENDRES_ANNULUS_FIND_H

#include "settling/attractor_set.h"

/* Lanes that have not settled so far, and where they started from. */
typedef struct pendres_annulus_suspects {
  size_t n;
  const pendres_strobe_lane **lane;
  double *x;
} pendres_annulus_suspects;

/*
 * Whether some of them, of attractor set c, are on a rotation that no closed orbit describes; if so
 * it is added, with its annulus where there is a drive. One that may be locked to the drive with a
 * period that recurrences find is not. With a drive nothing is done before the pendulums' own
 * budget is as long as what is beside a rotation takes to come to it: no search lasts longer than
 * they do.
 */
pendres_status pendres_annulus_find(pendres_context *ctx, pendres_attractor_set *c, long budget,
                                    const pendres_annulus_suspects *of, int *found);

#endif
