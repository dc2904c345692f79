/*
 * scene.h -- a scene: a list of pendulums and a question about them.
 *
 * Owns: the face that every scene shows to the driver, and how a run goes on until something fails.
 * One file a kind: NAME.c, which defines `const scene_kind scene_NAME` and is listed in scene.c. A
 * scene takes a checked deck, computes points (points.h), and defines and writes its results; it
 * never reads text, prints progress or handles signals.
 */
#ifndef SCENE_H
#define SCENE_H

#include <stdio.h>

#include <pendres/pendres.h>
#include <pendres/store.h>

#include "deck/deck.h"
#include "farm/farm.h"
#include "farm/trial.h"

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
  struct results_tape *tape; /* where results go, while it is one slice of an outer axis; or NULL */
  char where[80];            /* which slice that is; "": none */
} scene_run;

typedef struct scene_more {
  double output, memory;
} scene_more;

/*
 * What runs of a kind take, for --dry-run. head: bytes that a file has beside its points (headers
 * and provenance); point and memory: bytes of the file and of memory for each point; stages: the
 * length of all journals over that of the first stage's; after: processor time of all of a run over
 * that of its first stage; seconds: for each point where not even one task can be tried, on a
 * processor of 3 GHz and at a usual damping. Most kinds leave the other fields 0.
 */
typedef struct scene_size {
  double head, point, memory, stages, after, seconds;
  double slowest;              /* how many times longer points take at most, at weak damping */
  double journal;              /* bytes a point where not even one task can be tried */
  int members;                 /* each point has the deck's ensemble, of which some can be tried */
  double (*points)(const deck *d); /* where they are not those of the deck's axes */
  /* Values that are no points, such as strobe points: how many there are, and bytes of each. */
  double (*values)(const deck *d);
  double value;
  /* Bytes that output and memory have beside those, at this many points; may be NULL. trial: what
     a trial has shown; NULL: none. */
  scene_more (*more)(const deck *d, const farm_trial *trial, double points);
} scene_size;

/* Where branches are followed, points hardly take longer at weak damping (measured down to 1e-5);
   and bytes of a path's points in journals. */
#define SCENE_SLOWEST_BRANCH 5.0
#define SCENE_PATH_JOURNAL 1.2e3

typedef struct scene_kind {
  deck_kind kind;
  const char *figures;    /* of the pendulum's paper, that the scene reproduces; NULL: none */
  const char *references; /* for methods, with what stands before them, "; " or ". "; may be NULL */
  scene_size size;
  /* Flags that few kinds have. */
  int budget;             /* its tasks say which points they begin: --budget can end them */
  int timed;              /* it measures times, so that there is no journal, and no shards */
  int any_method;         /* it takes the deck's method for all it does: it has no orbits */
  int path;               /* what takes time is one path, a single task */
  int one_temperature;    /* its noise has a single temperature, which is no dimension of results */
  /* The library's options that only this kind sets; may be NULL. */
  void (*options)(const deck *d, pendres_options *out);
  /* What would be computed, in a few lines (--dry-run). */
  void (*describe)(const deck *d, FILE *out);
  /* Compute and write everything but the provenance. */
  pendres_status (*run)(scene_run *run);
} scene_kind;

/* The root attribute of a file: whose equation the deck's is, and whose methods are used. */
enum { SCENE_REFERENCES = 1024 };
const char *scene_references(const deck *d, char text[SCENE_REFERENCES]);

/* The scene of a kind; NULL if this build has none. */
const scene_kind *scene_find(deck_kind kind);

/* The library's options that a deck's &precision asks for; *why is a static sentence if it is
   more than the library can do. */
pendres_status scene_precision(const deck *d, pendres_options *out, const char **why);

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
   without a name. */
enum { SCENE_MEMORY = 64 << 20 };
void *scene_large(scene_run *run, size_t n, size_t size);

/* Run a stage on the run's farm; on failure the run has the farm's words. */
void scene_compute(scene_run *run, const farm_stage *stage);

/*
 * Where results go: into the store or, while a scene is computed for one value of an outer axis,
 * onto a tape (tape.h). They are the functions of <pendres/store.h> of these names; what fails is
 * on record in the run.
 */
void results_dimension(scene_run *run, const pendres_store_spec *spec, uint64_t n,
                       const void *values);
void results_variable(scene_run *run, const pendres_store_spec *spec, int *id, int *error_id);
/* rows 0: all of the variable. */
void results_write(scene_run *run, int id, uint64_t first, uint64_t rows, const void *data,
                   size_t n);
void results_attribute(scene_run *run, const char *group, const char *object, const char *name,
                       const char *text);
void results_number(scene_run *run, const char *group, const char *object, const char *name,
                    double number);
int results_has(scene_run *run, const char *group, const char *name);

/* Write a variable, with its errors unless they are NULL, or a dimension of n values (NULL: numbers
   from 0 on); see pendres/store.h. Units, and words where the spec has none, are those of the
   quantity of its name, or of the one that is named. */
void scene_put(scene_run *run, const pendres_store_spec *spec, const void *values,
               const double *errors, size_t n);
void scene_put_as(scene_run *run, const char *quantity, const pendres_store_spec *spec,
                  const void *values, const double *errors, size_t n);
void scene_put_dimension(scene_run *run, const pendres_store_spec *spec, const void *values,
                         size_t n);
void scene_put_dimension_as(scene_run *run, const char *quantity, const pendres_store_spec *spec,
                            const void *values, size_t n);

/* An axis of the deck as a dimension of a group, with its usual name, words and units. */
void scene_dimension(scene_run *run, const char *group, deck_axis_id axis);

/* A dimension of the root that numbers things from 0 on. */
void scene_numbering(scene_run *run, const char *name, size_t n, const char *words);

/*
 * Which run this is: attributes `scene` and `deck` of the file, and the pendulum's parameters that
 * the deck holds fixed as scalar coordinates, so that files of several runs can be put together.
 */
void scene_write_identity(scene_run *run);

/* Where a deck has &units: mark a variable that was just defined, and its errors if it has any,
   with the attributes si_factor and si_units, by its kind; one whose unit is another; and print
   short results in SI behind the table. */
void scene_mark_si(scene_run *run, const char *group, const char *name, const deck_si *si);
void scene_mark_units(scene_run *run, const pendres_store_spec *spec, pendres_kind kind,
                      int errors);
void scene_tell_units(scene_run *run);

/* The quantity of that name, which is on record as a failure if there is none; if no name is given
   (NULL), that of the variable's own, or NULL. */
const pendres_quantity *scene_quantity(scene_run *run, const char *name, const char *own);

/* Describe a variable as files do, by its quantity (NULL: a number), whose kind is returned: its
   units, its words where it gives none, its definition as its `comment` where it has the quantity's
   own name; and nothing is called an angle where x is none. words: room for its long_name. For what
   writes variables, as the functions above and columns do. */
enum { SCENE_WORDS = 300 };
pendres_kind scene_define(const scene_run *run, const pendres_quantity *q, pendres_store_spec *spec,
                          char words[SCENE_WORDS]);

/* A parameter's name in words, "drive amplitude", in `text`, which is returned; and in columns of
   tables, where the frequency is the drive's. */
const char *scene_spaced(pendres_parameter parameter, char text[DECK_NAME]);
const char *scene_column_name(pendres_parameter parameter);

/* What stands above the values of an axis in a short table, and their format. */
typedef struct scene_heading {
  char words[DECK_NAME], format[16];
} scene_heading;
scene_heading scene_heading_of(deck_axis_id axis);

/* The dimension of a parameter in scenes that call it by its short name. */
void scene_dimension_short(scene_run *run, deck_axis_id axis);

/* The value of a parameter that the scene holds fixed; NaN if it is an axis, or unknown. */
double scene_fixed(const deck *d, deck_axis_id axis);

/* The deck's ensemble. */
pendres_ensemble scene_ensemble(const deck *d);

/* The deck's pendulums over its axes, slowest first. */
pendres_sweep scene_sweep(const deck *d);

#endif
