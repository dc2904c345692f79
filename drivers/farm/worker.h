/*
 * worker.h -- a thread that computes tasks of a pool, one after another, with its context.
 */
#ifndef FARM_WORKER_H
#define FARM_WORKER_H

#include "farm/pool_internal.h"

/* Work as thread number `thread` until no task is left. */
void worker_run(pool *c, int thread);

/* Compute a task on the calling thread, the first of the pool's; its record is the caller's. */
pendres_status worker_try(pool *c, size_t task, farm_record *record);

#endif
