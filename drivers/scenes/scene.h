/*
 * scene.h -- a scene: a list of pendulums and a question about them.
 *
 * Owns: the face that every scene shows to the driver. One file a kind: NAME.c, here or in a folder
 * of its own, which defines `const scene_kind scene_NAME` and is listed in scene.c. A scene takes a
 * checked deck, computes points (points.h), and writes its results (results/); it never reads text,
 * prints progress or handles signals.
 */
#ifndef SCENE_H
#define SCENE_H

#include "farm/trial.h"
#include "results/results.h"

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
  double searched;             /* seconds of a point whose search a budget of work ends, whatever
                                  its members; at weaker damping than makes that many it takes
                                  longer; 0: nothing is searched for */
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
 * Which run this is: attributes `scene` and `deck` of the file, and the pendulum's parameters that
 * the deck holds fixed as scalar coordinates, so that files of several runs can be put together.
 */
void scene_write_identity(scene_run *run);

/* The value of a parameter that the scene holds fixed; NaN if it is an axis, or unknown. */
double scene_fixed(const deck *d, deck_axis_id axis);

/* The deck's ensemble. */
pendres_ensemble scene_ensemble(const deck *d);

/* The deck's pendulums over its axes, slowest first. */
pendres_sweep scene_sweep(const deck *d);

#endif
