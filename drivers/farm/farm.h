/*
 * farm.h -- tasks on threads, each thread with its own context of the library.
 *
 * Owns: threads, contexts, records, progress and stopping. A task fills a record: plain bytes that
 * depend only on its number, the deck and the code, never on its thread or on other tasks. Records
 * are collected in the order of tasks, and the results are a function of the records. They are
 * therefore the same bytes for any number of threads, and a record may also come from elsewhere, as
 * from a journal.
 */
#ifndef FARM_H
#define FARM_H

#include <stddef.h>

#include <pendres/pendres.h>

#include "farm/numbers.h"
#include "farm/record.h"
#include "terminal/progress.h"

typedef struct farm farm;

typedef struct farm_options {
  pendres_options library; /* of every context */
  int threads;             /* 0: as many as there are processors for this process */
  int (*stop)(void *arg);  /* called now and then; nonzero: stop. May be NULL */
  void *stop_arg;
  double budget;           /* processor seconds per point, see farm_point(); 0: no limit */
  progress *progress;      /* is informed of finished tasks; may be NULL. Not owned */
  size_t run;              /* the same number in all ranks, different for each farm of a rank */
} farm_options;

/* On failure *out is NULL. */
pendres_status farm_create(const farm_options *options, farm **out);
/* NULL is allowed. */
void farm_free(farm *f);

/* Compute task number `task` with this thread's context, and fill its record. Nothing else may be
   written to, since several threads share arg. */
typedef pendres_status farm_task(const void *arg, size_t task, pendres_context *ctx,
                                 farm_record *record);

/* Take over a finished task's record, which lasts until this returns: called for tasks 0, 1, 2, ...
   in this order, by one thread at a time (so it may write to a store). It may not change what
   other tasks read. */
typedef pendres_status farm_collect(void *arg, size_t task, const farm_record *record);

/*
 * Called by a task that begins `points` points together; what it has begun before is then finished.
 * 0: something that is not a point and has no budget. The name tells the user what is being
 * computed, and which points are costly compared with earlier ones.
 *
 * When the points have taken `points` times the budget of a point, the library is stopped, as by a
 * signal. A task for which farm_gave_up() then returns nonzero continues with farm_point() for the
 * next points, or for some of the same. It calls farm_lost() for each point that it gives up, which
 * is to be marked; words, which may be NULL, receive the reason. Such a record is not kept in the
 * journal, nor is what depends on it.
 */
void farm_point(farm_record *record, size_t points, const char *format, ...)
  __attribute__((format(printf, 3, 4)));
int farm_gave_up(const farm_record *record, pendres_status status);
void farm_lost(farm_record *record, char *words, size_t size);
/* The same where `lost` of the points begun together are given up, and the others are done. */
void farm_lost_some(farm_record *record, size_t lost, char *words, size_t size);

/* Whether this can be the record of a task, judged by its size and the ranges of all numbers in it
   that are used: records may come from a journal that others have written. 0: it is refused. */
typedef int farm_check(const void *arg, size_t task, const farm_record *record);

/* Tasks of one kind. */
typedef struct farm_stage {
  const char *what;      /* names the tasks in the progress line, e.g. "dampings" */
  size_t tasks;
  size_t record_size;    /* bytes */
  size_t element;        /* bytes of the elements that end each record, as the states of a grid's
                            rows: trials count those that differ from the one before; 0: none */
  size_t paths;          /* the first tasks that are unlike the others, as a path is: trials count
                            each for itself, by the share of it that is done */
  int last;              /* no later stage of the run reads its records */
  int cheap;             /* so little work that every shard does all of it */
  int timed;             /* tasks measure times: they are run one at a time */
  int chained;           /* each task reads what was collected from the one before: they are run one
                            at a time, and by every shard */
  farm_task *task;
  farm_check *check;     /* called before a record is collected; NULL: only its size is checked,
                            which must be record_size */
  farm_collect *collect; /* may be NULL */
  void *arg;             /* of all of these */
} farm_stage;

/*
 * Run all tasks of a stage; idle threads take the next one. The first failure (in the order of
 * tasks) stops the farm and is returned, its message kept; PENDRES_INTERRUPTED after a signal.
 */
pendres_status farm_run(farm *f, const farm_stage *stage);

/*
 * Keep the records of finished tasks in a journal, which is not owned, and take those that it
 * already holds from there instead of computing them. The stages of a run are identified by their
 * ordinals, names, numbers of tasks and sizes of records: with the same deck and code they follow
 * each other in the same order. NULL: no journal, which is the default. Stages whose tasks measure
 * times are never kept.
 */
struct journal;
void farm_set_journal(farm *f, struct journal *j);

/*
 * What follows is one slice of several of a run: its stages have numbers of their own, whatever
 * became of those of the slices before it. `more`: others come after it, so that other ranks go on
 * after its last stage.
 */
void farm_begin_slice(farm *f, size_t slice, int more);

/*
 * How many slices can be computed side by side; 1: only one after another, as without a journal or
 * with several ranks. And a farm for one of them on one thread, any thread, whose records f finds
 * in its journal as those of an interrupted run: what is computed there is computed by f no more.
 * NULL: out of memory.
 */
int farm_sides(const farm *f);
farm *farm_aside(const farm *f);

/* Whether the stage that was interrupted last was left to other shards, so that other slices can be
   begun. */
int farm_left_to_shards(const farm *f);

/* How tasks are divided among several programs, each with a journal; all zero: not at all. */
typedef struct farm_share {
  size_t shard, shards; /* number of this shard, from 0, and how many there are: each computes every
                           shards-th task */
  int complete;         /* results are put together from shards: the journals must hold all records
                           of the stage that was divided */
} farm_share;

/*
 * A shard computes its own tasks of the first stage that is neither cheap nor completely in the
 * journals; farm_run then returns PENDRES_INTERRUPTED, and farm_left() returns nonzero for this
 * reason. Later stages need all records and are computed when the shards are put together.
 */
void farm_set_share(farm *f, farm_share share);
int farm_left(const farm *f);

/*
 * All ranks call this when the scene has ended: rank 0 goes on alone, or not at all, and the others
 * leave the stage that they are in. A rank that has failed, for the reason in `words` (otherwise
 * NULL), waits for that and receives what is still sent to it meanwhile; rank 0 goes on with the
 * other ranks.
 */
void farm_dismiss(farm *f, const char *words);

/* Call run(arg) on a thread with a stack of FARM_STACK bytes, wait for it, and return its result.
   The caller's own stack may be too small (ulimit -s) for what scenes do outside of tasks. If no
   thread can be started, run() is called directly. */
int farm_run_on_thread(int (*run)(void *arg), void *arg);

/* The message of the failure that farm_run returned. */
const char *farm_message(const farm *f);

/* A context for work outside of tasks, on the calling thread. NULL: out of memory. */
pendres_context *farm_context(farm *f);

/* Between these what is computed on that context keeps states in the journal, as in tasks: `what`
   names it. */
void farm_keep_begin(farm *f, pendres_context *ctx, const char *what);
void farm_keep_end(farm *f, pendres_context *ctx);

/* What that work is, as a sentence for users who wait for it; "": it is done. */
void farm_doing(farm *f, const char *what);

int farm_threads(const farm *f);

/* Whether the run is to stop, for what a task does without its context; `farm` is a farm. */
int farm_stopped(void *farm);

/* Processor seconds per point; number of points that were given up (farm_lost()). */
double farm_budget(const farm *f);
size_t farm_points_lost(const farm *f);

/* The cost of all tasks, and of the contexts outside of tasks. */
void farm_cost(const farm *f, pendres_cost *cost);

#endif
