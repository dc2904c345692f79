/*
 * provenance.h -- where a file of results comes from and what it cost.
 *
 * Owns: the group `provenance`: the deck verbatim and as resolved, versions, host, threads, seed,
 * times and counts. Everything that changes from run to run is here; nothing else in the file does,
 * except for the date in the root's `history`.
 */
#ifndef PROVENANCE_H
#define PROVENANCE_H

#include <pendres/store.h>

#include "deck/deck.h"
#include "farm/farm.h"

/* When a run began. */
typedef struct provenance {
  double wall, processor; /* seconds */
  char date[32];          /* UTC */
} provenance;

void provenance_start(provenance *p);

/* Seconds since the start. */
double provenance_wall(const provenance *p);

/* Write the group. failed_points as in scene_run. */
pendres_status provenance_write(const provenance *p, const deck *d, const farm *f,
                                size_t failed_points, pendres_store *store);

#endif
