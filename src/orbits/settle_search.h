/*
 * settle_search.h -- what attracts pendulums that are in no known trapping ellipse.
 *
 * Owns: looking for orbits that a pendulum is near, and for chaos, in rounds that get longer and
 * longer.
 */
#ifndef PENDRES_SETTLE_SEARCH_H
#define PENDRES_SETTLE_SEARCH_H

#include "orbits/settle_lanes.h"

/* A batch with pendulums that are unresolved. */
typedef struct pendres_settle_remaining {
  size_t sets;
  pendres_attractor_set *attractor_sets; /* may grow */
  long *budget;                  /* periods of each set, which have been spent; is raised */
  size_t n;
  const size_t *set;             /* of each pendulum, those of a set side by side */
  const double *x, *v;              /* where they began, */
  const pendres_strobe_lane *lanes; /* and where they are */
  pendres_outcome *outcome;
} pendres_settle_remaining;

/*
 * Each round is twice as long as the one before: pendulums go on, orbits that they have come near
 * are refined, every other time chaos is looked for, and pendulums are labelled again. Those that
 * have settled on nothing when the last budget is spent stay unresolved.
 */
pendres_status pendres_settle_search(pendres_context *ctx, const pendres_settle_remaining *q);

#endif
