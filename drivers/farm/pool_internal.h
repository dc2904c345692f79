/*
 * pool_internal.h -- the tasks of a stage while they are computed, on threads and on other ranks.
 * From below: pool.c knows which are done, dispatch.c hands them to other ranks, point.c has the
 * point that a task works on, what it is called and its budget of time, worker.c computes one task
 * after another, trial.c some of them, and stage.c runs all.
 */
#ifndef POOL_INTERNAL_H
#define POOL_INTERNAL_H

#include <stdatomic.h>
#include <stdint.h>

#include "farm/internal.h"

/* A record that waits for its turn to be collected. */
typedef struct kept {
  void *data;
  size_t size;
} kept;

enum { POINT_NAME = 120 };

/* What a thread is working on, and since when; 0: nothing. */
typedef struct at_work {
  char name[POINT_NAME];
  long long since; /* milliseconds */
  atomic_llong periods; /* drive periods of pendulums that its task has taken so far */
} at_work;

/* The point that a thread works on, point.c's: only that thread touches it. */
typedef struct farm_watch {
  struct pool *pool;
  int thread;      /* of the pool's bench */
  double start;    /* of this thread's processor time, seconds */
  size_t points;   /* that were begun together; 0: none */
  int over;        /* the budget has ended them ... */
  double spent;    /* ... after this number of seconds */
  int told;        /* the user has been told that they are costly */
  long long look;  /* when to look at the clock again, milliseconds; 0: at once */
  char name[POINT_NAME];
} farm_watch;

/* The tasks of one farm_run; fields are changed under the lock only, except for `limit`. */
typedef struct pool {
  farm *farm;
  const farm_stage *stage;
  uint64_t number;      /* of the stage: journal_stage() */
  journal *journal;     /* of the stage's records; NULL: none */
  int hired;            /* threads that work; those with higher numbers end */
  pthread_mutex_t lock;
  size_t next;          /* not yet taken */
  size_t finished;
  size_t waiting;       /* bytes of records in memory */
  size_t others;        /* tasks that are left to other shards */
  size_t collected;     /* tasks 0 .. collected-1 */
  int collecting;       /* a thread is doing so */
  char *done;           /* NOT_DONE, ... */
  /* Hands a record to other ranks before it is collected; NULL: none needs it. */
  void (*share)(struct pool *c, size_t task, const farm_record *record);
  kept *record;         /* of tasks that are done and not yet collected */
  atomic_size_t limit;  /* the first task that failed; tasks, while there is none */
  pendres_status status;
  at_work *bench;       /* what each thread is working on */
  size_t points;        /* that were finished here, and the seconds that they took */
  double point_seconds;
  int threads;          /* of them */
  atomic_llong look;    /* when a thread is to look at the clock again, milliseconds */
  /* dispatch.c's: */
  pthread_t server;
  atomic_int idle;      /* the rank's own threads have no more to do */
  atomic_int halted;    /* on ranks other than 0: rank 0 needs no more from this rank */
  atomic_int ended;     /* on ranks other than 0: rank 0 has sent how the stage ended */
} pool;

/* Room for the records of a stage, which is to be freed unless that fails: no memory. */
pendres_status pool_create(pool *c, farm *f, const farm_stage *stage, int threads);
void pool_free(pool *c);

long long pool_milliseconds(void);

/* Show a line to the user, while other threads work. */
void pool_tell(pool *c, const char *words);

/* Take the next task that no thread has taken; 0: there is none. */
int pool_take(pool *c, size_t *task);

/* Collect what has become ready unless another thread does. */
void pool_collect(pool *c);

/* Note a task's end; the pool becomes the owner of the record's data. */
void pool_finish(pool *c, size_t task, pendres_status status, farm_record *record);

/*
 * point.c: the clock of a point, and when it is costly: beside the mean of the points that the
 * stage has finished. A point is what a user knows: the parameters of one result. Time is that of
 * the processor, of the thread that computes, so that a machine which others use too does not end
 * points. All the same the same budget may end a point on one machine and not on another: what is
 * computed with a budget is reproduced only where none was ended.
 */

/* Whether the current point is to be given up. Called now and then by the thread that computes it,
   `now` being its milliseconds; tells the user of a costly point, once. */
int point_over(farm_watch *w, long long now);

/* The current point has ended and is part of the mean from now on. */
void point_end(farm_watch *w);

#endif
