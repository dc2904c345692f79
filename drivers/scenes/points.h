/*
 * points.h -- the points of a scene: computed some at a time, marked where they fail, and kept.
 *
 * Owns: chunks of points as tasks of the farm; what is done where a chunk fails, or its budget ends
 * it; records of points, and whether those that come from a journal can be such; which points have
 * failed, and why. A scene says how many points there are and how long the record of one is, and
 * computes some of them.
 */
#ifndef POINTS_H
#define POINTS_H

#include "results/columns.h"
#include "results/failed.h"
#include "scenes/numbers.h"
#include "scenes/scene.h"

enum {
  SCENE_MESSAGE = sizeof((farm_record *)0)->message
};

typedef struct scene_points scene_points;

/* Some points next to each other, which a task computes together. */
typedef struct scene_some {
  const scene_points *of;
  pendres_context *ctx;
  size_t first, n;          /* their numbers */
  void *rows;               /* [n] their records, all zero but for columns, which are blank */
  char *message;            /* [SCENE_MESSAGE] why it fails, where that is not the points' own */
  struct scene_marks *marks;
  scene_room *room;         /* see scene_room_take(): what lasts until the points are computed */
} scene_some;

struct scene_points {
  size_t n, chunk;          /* points, and how many of them are a task */
  size_t size;              /* bytes of a point's record */
  void *arg;                /* the scene's own */

  /*
   * Compute them all, or none. What fails for reasons of a point's own (scene_failure_of), or is
   * ended by the budget, is tried again by halves, down to single points. What fails with a message
   * ends the run.
   */
  pendres_status (*compute)(const scene_some *some);
  /* Whether a point would take longer than anybody waits, see scene_settling_too_long(); it is not
     computed then. May be NULL. */
  int (*too_long)(const scene_points *p, size_t point, char *words, size_t size);
  /* The record of a point that has no result, NULL: a blank one; and what fills in what is the
     point's own, which may be NULL. */
  const void *none;
  void (*leave_out)(const scene_points *p, size_t point, void *row);
  /* Can this be a record, by the numbers in it? NULL: what the columns say. */
  int (*check)(const scene_points *p, const void *row);
  const scene_column *columns;
  size_t column_count;
  /* Take over finished points, in their order; NULL: they are kept in `rows`. */
  pendres_status (*collect)(const scene_points *p, size_t first, size_t n, const void *rows);

  /* What they are called: "WHAT at damping 0.24, drive_period 7", or WHAT without axes; what may be
     NULL. Points that are neither one nor a grid of the deck's axes have a function for their
     names, or none: they have no budget then. */
  const char *what;
  int axes;
  deck_axis_id axis[DECK_AXES + 1]; /* slowest first */
  void (*name)(const scene_points *p, size_t point, char *text, size_t size);
  /* The words for a reason in place of the library's message; NULL: those of the list of reasons.
     The function itself may be NULL. */
  const char *(*words)(scene_failure reason);

  /* Not 0: a record says itself what became of its point. Nothing is marked then, only the budget
     leaves points out, and every other failure ends the run. */
  int unmarked;

  /* The results, which belong to the run, but for rows that the scene has set before. */
  void *rows;               /* [n] */
  scene_failed *failed;     /* [n] */
};

/* The points of a grid of the deck's axes: their number, and the axes. */
void scene_points_over(scene_points *p, const deck *d, int axes, const deck_axis_id *axis);

/* For compute(): say why one of them, number 0 to n - 1 of these, has no whole result. words NULL:
   those of the list. */
void scene_mark(const scene_some *some, size_t i, scene_failure reason, const char *words);

/* The same where a status is such a reason, and else give it back. words: the library's. */
pendres_status scene_mark_status(const scene_some *some, size_t i, pendres_status status,
                                 const char *words);

/* The columns of an array, as an initializer of the above. */
#define SCENE_COLUMNS(array) .columns = array, .column_count = sizeof array / sizeof *array

/* Compute the points of several kinds in one stage, one kind after another. stage: its name, and
   whether it is cheap or the last; it may have tasks of its own, with a check and a collector,
   which come first. The rest is set here. */
void scene_points_compute(scene_run *run, const farm_stage *stage, size_t count,
                          scene_points *const *points);

/* The same for points of one kind, with fields of the stage. */
#define SCENE_COMPUTE(run, points, name, ...)                                      \
  scene_points_compute(run, &(farm_stage){.what = name, __VA_ARGS__}, 1,     \
                             (scene_points *[]){points})

/* For tasks of other stages: begin n points next to each other, as farm_point() does. */
void scene_points_begin(const scene_run *run, const scene_points *p, size_t first, size_t n,
                        farm_record *out);

/* Count the points that failed, and tell the first of them. */
void scene_points_tell(scene_run *run, const scene_points *p);

/* The same, and write the variable `name` over the axes, whose dimensions exist. */
void scene_points_write_failed(scene_run *run, const scene_points *p, const char *name,
                               const char *long_name);

/* The rows as a table over the axes, and writing that with all columns. */
scene_table scene_points_table(const scene_points *p, const deck *d);
void scene_points_write(scene_run *run, const scene_points *p);

#endif
