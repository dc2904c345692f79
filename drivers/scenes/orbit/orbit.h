/*
 * orbit.h -- what the files of the scene `orbit` share.
 *
 * Owns: what is found of the pendulum, and the record while it is made.
 */
#ifndef SCENE_ORBIT_H
#define SCENE_ORBIT_H

#include "results/columns.h"
#include "scenes/points.h"

/* What is found of the pendulum. */
typedef struct orbit_found {
  pendres_attractor of;          /* its label is that of an escape, too */
  long well, settling_periods;   /* -1: no start to settle from */
  int closed;                    /* nonzero: there is a closed orbit */
  int uncertain;                 /* nonzero: errors that the start amplifies may have chosen it */
} orbit_found;

/* Whether it goes on for ever without closing: chaos, or a rotation without a lock. */
static inline int scene_orbit_open(const orbit_found *f)
{
  return !f->closed && f->of.drift == f->of.drift;
}

/* How far the record is, if a trajectory is recorded. */
typedef struct orbit_way {
  pendres_recording recording;
  int gone; /* nonzero: double precision can no longer say where the trajectory is on its way to
               infinity */
} orbit_way;

/* Variables of each sample. */
enum {
  ORBIT_VARIABLES = 4,
  ORBIT_SETTLING = 100 /* drive periods until a trajectory counts as one of the chaotic attractor */
};

/* What a whole record is measured for, while it goes by. */
typedef struct orbit_measures {
  pendres_spectrum *spectrum; /* NULL: not asked for */
  double *x, *v;              /* strobe points, at most `room` of them; NULL: not asked for */
  size_t points, room;
  long stride;                /* drive periods from one to the next */
  pendres_correlation correlation;
} orbit_measures;

typedef struct orbit_work {
  const deck *d;
  scene_run *run;
  pendres_pendulum pendulum;
  int transient;
  long chunk;                  /* drive periods of a part, the last one's may be fewer, ... */
  size_t room;                 /* ... and its points: x of all, then v, then the errors of both */
  scene_points search;         /* one, of orbit_found */
  orbit_found found;           /* what it has found */
  scene_points parts;          /* of the record, each from where the one before has ended */
  orbit_way way;
  scene_variable variable[ORBIT_VARIABLES]; /* in the store */
  orbit_measures measures;
} orbit_work;

/* write.c: what was found, and variables for samples; samples of periods `first`, ...,
   of which those of the last period's end are the next chunk's; the table. */
void scene_orbit_put_found(orbit_work *w);
void scene_orbit_put_samples(orbit_work *w, long first, long periods, const double *samples);
void scene_orbit_tabulate(FILE *out, const orbit_work *w);

/* measure.c: dimensions and spectrum. Begin before the first chunk, free always. */
void scene_orbit_measure_begin(orbit_work *w);
void scene_orbit_measure_add(orbit_work *w, long first, long periods, const double *samples);
void scene_orbit_measure_put(orbit_work *w);
void scene_orbit_measure_free(orbit_work *w);

#endif
