/*
 * lanes_replay.h -- the operations of a drive period, kept to be done again.
 *
 * Owns: what ARKODE has asked of a block from the start of a period to its end. With fixed steps it
 * asks for the same every period, whatever the numbers are, and asking costs more than doing where
 * few pendulums are left in a block. So the first two periods of a kind are recorded; where they
 * are the same, operation by operation, those that follow are done from the record.
 */
#ifndef PENDRES_LANES_REPLAY_H
#define PENDRES_LANES_REPLAY_H

#include "engine/lanes_shape.h"

/* Operations in their order, in parts: each ends where the numbers are to be seen. */
typedef struct pendres_lanes_replay {
  size_t operations, sums, parts;
  size_t slopes; /* right-hand sides among the operations */
  pendres_operation *operation;
  pendres_sum *sum; /* those of the operations */
  size_t *end;      /* how many operations come before the end of each part */
} pendres_lanes_replay;

/* Periods that ask for the same. */
typedef struct pendres_lanes_replay_kind {
  int steps;
  int span;    /* the caller's: what is a period, and where it is looked at */
  int carried; /* the caller's: errors or tangents are carried along ... */
  int driven;  /* ... by a spring that depends on the phase */
} pendres_lanes_replay_kind;

/* The replays of one block, and the record that is being made. */
typedef struct pendres_lanes_replays pendres_lanes_replays;

/* NULL if out of memory. */
pendres_lanes_replays *pendres_lanes_replays_create(void);
void pendres_lanes_replays_free(pendres_lanes_replays *r);

/* What periods of a kind do; NULL: not known yet. Valid until the next recording ends. */
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
