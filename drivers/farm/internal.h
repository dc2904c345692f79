/* internal.h -- what a farm holds: contexts.c makes it, all others work with it. */
#ifndef FARM_INTERNAL_H
#define FARM_INTERNAL_H

#include <pthread.h>

#include "farm/farm.h"
#include "farm/journal.h"

/*
 * state.c: a task that is computed keeps states in the journal, and goes on from the last one of an
 * earlier run; a trial hears how much of it is done. So does work outside of tasks.
 */
typedef struct task_state {
  farm *farm;
  pthread_mutex_t *lock; /* of the progress meanwhile */
  journal *journal;      /* NULL: none is kept */
  uint64_t stage;
  size_t task;
  double begun, next; /* seconds: when the task began, and when a state is wanted next */
  farm_record last;   /* of an earlier run */
} task_state;

/* Begin with farm, lock, journal, stage and task set. */
void state_begin(task_state *s, pendres_context *ctx);
void state_end(task_state *s, pendres_context *ctx);

/* Say why the journal cannot be written. */
void farm_tell_unkept(farm *f, pthread_mutex_t *lock, const char *words);

struct farm {
  farm_options options;
  int threads;
  int short_of;              /* how many threads could be started, if fewer than requested;
                                otherwise 0 */
  pthread_mutex_t lock;      /* of `spent`, and of the progress between stages */
  pendres_cost spent;        /* without what the contexts still count themselves */
  pendres_context **context; /* one for each thread, made at its first task */
  journal *journal;          /* NULL: none */
  farm_share share;
  struct farm_trial *trial;  /* NULL: not a trial */
  size_t lost;               /* points that were given up */
  size_t slice;              /* see farm_begin_slice() */
  int more, complete;        /* slices come after it; what the share was told of journals */
  int left;                  /* a stage was left to other shards */
  int dismissed;             /* on ranks other than 0: rank 0 has announced that the scene has
                                ended */
  task_state outside;        /* of the work outside of tasks */
  size_t run, stages;        /* which farm of its rank this is; stages that were run */
  char message[512];
};

/* Nonzero: the run is to stop. */
int farm_stop(const farm *f);

/* The context of a thread, made when first asked for; only that thread asks. The number after the
   last thread's is that of what is computed while the others are idle, no task or the only one: the
   library may use them. */
pendres_status farm_context_of(farm *f, int thread, pendres_context **out);

/* Add to what the farm has spent; any thread may. */
void farm_spend(farm *f, const pendres_cost *cost);

/* trial.c: try a stage that has tasks, instead of running it. */
pendres_status trial_run(farm *f, const farm_stage *stage);

/* A thread with a stack of FARM_STACK bytes, whatever the limits of the process; 0 or an errno. */
int farm_start_thread(pthread_t *thread, void *(*run)(void *), void *arg);

#endif
