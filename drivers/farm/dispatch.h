/*
 * dispatch.h -- the distribution of tasks among the ranks of a run.
 *
 * Owns: the messages between ranks. All ranks run the same stages. Rank 0 knows which tasks are
 * done and has the journal; its own threads and those of the other ranks request tasks from it and
 * return their records to it. Records that later stages read are then sent to all ranks, which
 * collect them as rank 0 does. With one rank all of this is pool_take() and pool_finish().
 */
#ifndef DISPATCH_H
#define DISPATCH_H

#include "farm/pool_internal.h"

/* Before and after the work on a stage. */
pendres_status dispatch_begin(pool *c);
void dispatch_end(pool *c);

/* As pool_take and pool_finish. */
int dispatch_take(pool *c, int thread, size_t *task);
void dispatch_finish(pool *c, size_t task, pendres_status status, farm_record *record);

/* A line for the user, from any rank. */
void dispatch_tell(pool *c, const char *words);

/* What farm_run returns on ranks other than 0. */
pendres_status dispatch_outcome(pool *c);

#endif
