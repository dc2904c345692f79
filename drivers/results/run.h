/*
 * run.h -- one run of a scene, from its deck to its results.
 *
 * Owns: how a run goes on until something fails, its arrays and files without a name.
 */
#ifndef RESULTS_RUN_H
#define RESULTS_RUN_H

#include <stdio.h>

#include <pendres/pendres.h>
#include <pendres/store.h>

#include "deck/deck.h"
#include "farm/farm.h"

enum { SCENE_MOST_TOLD = 10, SCENE_TOLD = 400 };

/* Arrays that are let go of together: those of a run, or of a task. All zero at first. */
typedef struct scene_room {
  struct scene_held *held;
} scene_room;

typedef struct scene_run {
  const deck *deck;
  farm *farm;
  pendres_store *store;
  FILE *table;          /* where the short table of results goes; NULL: nowhere */
  size_t points;        /* of the results, as far as they may fail one by one */
  size_t failed_points; /* points without a result (marked in the file): exit code 3 */
  size_t unresolved;    /* those among them that are so: a deck may tolerate some */
  char told[SCENE_MOST_TOLD][SCENE_TOLD]; /* lines about the first of them, see failed.h */
  char told_open[SCENE_MOST_TOLD];        /* it is unresolved */
  size_t told_count;
  pendres_status status; /* the first failure; nothing is computed or written any more after it */
  char message[512];     /* what it was */
  scene_room room;         /* see scene_array() */
  struct results_stack *stack; /* where results go while it is a slice of an outer axis, or NULL */
  char where[80];              /* which slice that is; "": none */
} scene_run;

/*
 * A scene goes on until something fails. What fails is on record in the run, and the functions of
 * this folder that take one do nothing from then on: so their callers need not ask after each.
 */
int scene_going(const scene_run *run);

/* Whether the short table is to be printed: it is wanted, and nothing has failed. */
int scene_prints(const scene_run *run);

/* Record a failure, unless an earlier one is on record; the status of the run, here and below. Not
   for tasks on threads: what they report comes from their context. */
pendres_status scene_fail(scene_run *run, pendres_status status, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* Of what the store was asked for: its own words, if it has failed. */
pendres_status scene_stored(scene_run *run, pendres_status status);

/* The context for work outside of tasks, and the status of such work: its words, if it has failed.
   NULL if something has. */
pendres_context *scene_context(scene_run *run);
pendres_status scene_asked(scene_run *run, pendres_status status);

/* n elements, all zero, that last until scene_room_end(); NULL: no memory. */
void *scene_room_take(scene_room *room, size_t n, size_t size);
void scene_room_end(scene_room *room);

/* The same in a run's room, until its end: not for tasks on threads. NULL if there is no memory,
   which is then on record as the failure, or if something has failed before. */
void *scene_array(scene_run *run, size_t n, size_t size);

/* A file without a name, in TMPDIR or else in the folder of the output, which vanishes with the run
   however that ends; this many bytes of the disk are taken at once. -1: why is on record. */
int scene_unnamed(scene_run *run, size_t bytes);

/* The same for what may be larger than memory: from SCENE_MEMORY bytes on an array is in a file
   without a name; and in another room, from `most` bytes on. */
enum { SCENE_MEMORY = 64 << 20 };
void *scene_large(scene_run *run, size_t n, size_t size);
void *scene_room_large(scene_run *run, scene_room *room, size_t n, size_t size, size_t most);

/* Run a stage on the run's farm; on failure the run has the farm's words. */
void scene_compute(scene_run *run, const farm_stage *stage);

#endif
