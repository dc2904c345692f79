/*
 * scene_basins_clouds.h -- clouds under noise, between computing and writing them.
 *
 * Owns: the clouds of scene_basins_noise.c. The files scene_basins_noise*.c alone include this.
 */
#ifndef SCENE_BASINS_CLOUDS_H
#define SCENE_BASINS_CLOUDS_H

#include "scenes/scene_failed.h"

typedef struct cloud_work {
  const deck *d;
  const pendres_attractors *set;
  size_t temperatures, attractors;
  size_t strobes;               /* written of each cloud */
  size_t parts;                 /* that each cloud is followed in */
  pendres_cloud *clouds;        /* [temperature][attractor] */
  pendres_langevin_cloud *part; /* [temperature][attractor][part] */
  double *x, *v;                /* [temperature][attractor][strobe] */
  scene_failures failed;        /* [temperature][attractor] */
  scene_failures parts_failed;  /* the same: the first failure of its parts */
} cloud_work;

/* What to make a cloud of: as many strobes of each trajectory as make those that are written. */
static inline pendres_cloud_request cloud_request(const cloud_work *w, size_t number)
{
  const size_t trajectories = (size_t)w->d->basins.trajectories;
  return (pendres_cloud_request){
    .set = w->set, .attractor = number % w->attractors, .trajectories = trajectories,
    .temperature = w->d->axis[DECK_AXIS_TEMPERATURE].value[number / w->attractors],
    .record = (long)((w->strobes + trajectories - 1) / trajectories) };
}

static inline int is_broken(const cloud_work *w, size_t number)
{
  return w->failed.reason[number] != SCENE_FAILURE_NONE;
}

/* Is there a cloud whose trajectories are followed? */
static inline int is_followed(const cloud_work *w, size_t number)
{
  return w->clouds[number].way == PENDRES_CLOUD_FOLLOWED && !is_broken(w, number);
}

/* Write all of the clouds but the dimension `attractor`; the run holds the message of a failure. */
pendres_status scene_basins_clouds_write(scene_run *run, const cloud_work *w);

/* A table of them. */
void scene_basins_clouds_print(FILE *out, const cloud_work *w);

#endif
