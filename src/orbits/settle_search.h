/*
 * settle_search.h -- what attracts pendulums that are in no known trapping ellipse.
 *
 * Owns: the search for orbits near a pendulum, and for chaos, in rounds of increasing length.
 */
#ifndef PENDRES_SETTLE_SEARCH_H
#define PENDRES_SETTLE_SEARCH_H

#include "orbits/settle_lanes.h"

/* A batch with pendulums that are unresolved. */
typedef struct pendres_settle_remaining {
  size_t sets;
  pendres_attractor_set *attractor_sets; /* may grow */
  long *budget;                  /* periods of each set, all of which are spent; is raised */
  size_t n;
  const size_t *set;             /* of each pendulum, those of a set side by side */
  const double *x, *v;              /* where they began, */
  const pendres_strobe_lane *lanes; /* and where they are */
  pendres_outcome *outcome;
} pendres_settle_remaining;

/*
 * Each round is twice as long as the one before: pendulums are integrated further, orbits that they
 * have come close to are refined, in every other round chaos is searched for, and pendulums are
 * labelled again. Those that have not settled when the last budget is spent stay unresolved.
 */
pendres_status pendres_settle_search(pendres_context *ctx, const pendres_settle_remaining *q);

#endif
