/*
 * settle_hunt.h -- what attracts pendulums that are in no known trap.
 *
 * Owns: looking for orbits that a pendulum comes back near to, and for chaos, in rounds that get
 * longer and longer.
 */
#ifndef PENDRES_SETTLE_HUNT_H
#define PENDRES_SETTLE_HUNT_H

#include "orbits/settle_lanes.h"

/* A batch of which some pendulums are unresolved. */
typedef struct pendres_settle_quarry {
  size_t sets;
  pendres_catalogue *catalogues; /* may grow */
  long *budget;                  /* of each set, spent so far; is raised */
  size_t n;
  const size_t *set;             /* of each pendulum, those of a set side by side */
  const pendres_strobe_lane *starts, *lanes; /* where they began and where they are */
  pendres_outcome *outcome;
} pendres_settle_quarry;

/*
 * Rounds, each twice as long as the one before: go on, refine the orbits that pendulums have come
 * near, tell chaos, label again. What has found nothing when the last budget is spent stays
 * unresolved.
 */
pendres_status pendres_settle_hunt(pendres_context *ctx, const pendres_settle_quarry *q);

#endif
