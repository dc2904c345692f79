/*
 * scene_basins_clouds.h -- clouds under noise, between computing and writing them.
 *
 * Owns: the clouds of scene_basins_noise.c, and which of them there are. The files
 * scene_basins_noise*.c alone include this.
 */
#ifndef SCENE_BASINS_CLOUDS_H
#define SCENE_BASINS_CLOUDS_H

#include <math.h>

#include "scenes/scene_failed.h"
#include "scenes/scene_noise.h"

/* Of a cloud's widths and their products. */
#define CLOUD_BIAS_WANTED 0.01

/* A temperature and attractor. */
typedef struct cloud {
  pendres_langevin_cloud measured;
  pendres_langevin_bias bias;
  pendres_langevin_linear linear;
  int compared; /* there is linear theory to compare with */
  int narrow;   /* so narrow that linear theory is exact: nothing is followed */
} cloud;

typedef struct cloud_work {
  const deck *d;
  const pendres_attractors *set;
  size_t temperatures, attractors;
  size_t strobes;      /* written of each cloud */
  size_t trajectories, chunks;
  long record;         /* strobes of each trajectory */
  cloud *clouds;                  /* [temperature][attractor] */
  pendres_langevin_cloud *parts;  /* [temperature][attractor][chunk] */
  double *x, *v;                  /* [temperature][attractor][strobe] */
  scene_failures failed;          /* [temperature][attractor] */
  scene_failures parts_failed;    /* the same: the first failure of its parts */
} cloud_work;

static inline double temperature_of(const cloud_work *w, size_t cloud_number)
{
  return w->d->axis[DECK_AXIS_TEMPERATURE].value[cloud_number / w->attractors];
}

static inline const pendres_attractor *attractor_of(const cloud_work *w, size_t cloud_number)
{
  return pendres_attractors_get(w->set, cloud_number % w->attractors);
}

/* Clouds are made around closed orbits that stay in their well; others run away, or have no point
   to begin with. */
static inline int has_cloud(const pendres_attractor *a)
{
  return isfinite(a->orbit.x) && isfinite(a->orbit.v) && a->orbit.winding == 0;
}

static inline int is_broken(const cloud_work *w, size_t number)
{
  return w->failed.reason[number] != SCENE_FAILURE_NONE;
}

/* Is there a cloud whose trajectories are followed? */
static inline int is_followed(const cloud_work *w, size_t number)
{
  return has_cloud(attractor_of(w, number)) && temperature_of(w, number) > 0.0 &&
         !w->clouds[number].narrow && !is_broken(w, number);
}

/* Write all of the clouds but the dimension `attractor`; the run holds the message of a failure. */
pendres_status scene_basins_clouds_write(scene_run *run, const cloud_work *w);

/* A table of them. */
void scene_basins_clouds_print(FILE *out, const cloud_work *w);

#endif
