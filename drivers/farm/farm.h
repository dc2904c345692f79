/*
 * farm.h -- tasks on threads, each thread with its own context of the library.
 *
 * Owns: threads, contexts, progress and stopping. A task's result may depend on its number
 * alone, never on its thread or on other tasks: then results are the same bytes for any
 * number of threads.
 */
#ifndef FARM_H
#define FARM_H

#include <stddef.h>

#include <pendres/pendres.h>

#include "terminal/progress.h"

enum {
  FARM_MOST_THREADS = 4096,
  FARM_STACK = 8 << 20 /* bytes of each thread's stack, of which tasks need some hundred thousand */
};

typedef struct farm farm;

typedef struct farm_options {
  pendres_options library; /* of every context */
  int threads;             /* 0: as many as there are processors for this process */
  int (*stop)(void *arg);  /* asked now and then; nonzero: stop. May be NULL */
  void *stop_arg;
  progress *progress;      /* told of finished tasks; may be NULL. Not owned */
} farm_options;

/* On failure *out is NULL. */
pendres_status farm_create(const farm_options *options, farm **out);
/* NULL is allowed. */
void farm_free(farm *f);

/* Compute task number `task` with this thread's context; results go to places of its own. */
typedef pendres_status farm_task(void *arg, size_t task, pendres_context *ctx);

/* Take over a finished task's results: called for tasks 0, 1, 2, ... in this order, by one thread
   at a time (so it may write to a store). */
typedef pendres_status farm_collect(void *arg, size_t task);

/*
 * Run all tasks; idle threads take the next one. The first failure (in the order of tasks) stops
 * the farm and is returned, its message kept; PENDRES_INTERRUPTED after a signal. collect may be
 * NULL.
 * `what` names the tasks in the progress line, e.g. "dampings".
 */
pendres_status farm_run(farm *f, const char *what, size_t tasks, farm_task *task,
                        farm_collect *collect, void *arg);

/* Call run(arg) on a thread with a stack of FARM_STACK bytes and wait for it; its result. The
   caller's own stack may be too small (ulimit -s) for what scenes do outside of tasks. Where there
   can be no thread it is called as it is. */
int farm_errand(int (*run)(void *arg), void *arg);

/* The message of the failure that farm_run returned. */
const char *farm_message(const farm *f);

/* A context for work outside of tasks, on the calling thread. NULL: out of memory. */
pendres_context *farm_context(farm *f);

int farm_threads(const farm *f);

/* Is the run to stop? For what a task does without its context: `farm` is a farm. */
int farm_stopped(void *farm);

/* What all contexts have spent so far. */
void farm_cost(const farm *f, pendres_cost *cost);

#endif
