/*
 * lanes_replay.h -- the operations of a drive period, recorded to be repeated.
 *
 * Owns: the operations that ARKODE has requested of a block from the start of a period to its end.
 * With fixed steps they are the same in every period, whatever the numbers are, and where few
 * pendulums are left in a block ARKODE takes longer than the operations. The first two periods of a
 * kind are therefore recorded; if they are the same, operation by operation, the following periods
 * are computed from the recording, without ARKODE.
 */
#ifndef PENDRES_LANES_REPLAY_H
#define PENDRES_LANES_REPLAY_H

#include "engine/sundials/lanes_shape.h"

/* Operations in their order, in parts: each part ends where numbers are read. */
typedef struct pendres_lanes_replay {
  size_t operations, sums, parts;
  size_t slopes; /* right-hand sides among the operations */
  pendres_operation *operation;
  pendres_sum *sum; /* those of the operations */
  size_t *end;      /* how many operations come before the end of each part */
} pendres_lanes_replay;

/* Periods of one kind have the same operations. */
typedef struct pendres_lanes_replay_kind {
  int steps;
  int span;    /* the caller's: what is a period, and where it is looked at */
  int carried; /* the caller's: errors or tangents are carried along ... */
  int driven;  /* ... by a spring that depends on the phase */
} pendres_lanes_replay_kind;

/* The recordings of one block, and the one that is being made. */
typedef struct pendres_lanes_replays pendres_lanes_replays;

/* NULL if out of memory. */
pendres_lanes_replays *pendres_lanes_replays_create(void);
void pendres_lanes_replays_free(pendres_lanes_replays *r);

/* The operations of periods of a kind; NULL: not known yet. Valid until the next recording ends. */
const pendres_lanes_replay *pendres_lanes_replays_find(pendres_lanes_replays *r,
                                                       const pendres_lanes_replay_kind *kind);

/* Record from now on, and add what is done: n operations; a part of the period ends here. */
void pendres_lanes_replays_begin(pendres_lanes_replays *r);
void pendres_lanes_replays_add(pendres_lanes_replays *r, const pendres_operation *operations,
                               size_t n);
void pendres_lanes_replays_part(pendres_lanes_replays *r);
/* The period is over. `whole`: it has not been cut short. */
void pendres_lanes_replays_end(pendres_lanes_replays *r, const pendres_lanes_replay_kind *kind,
                               int whole);

#endif
