/*
 * scene_response_noise.h -- the noisy part of scene `response`: loop area, phase lag and amplitude
 * against temperature.
 */
#ifndef SCENE_RESPONSE_NOISE_H
#define SCENE_RESPONSE_NOISE_H

#include "scenes/scene.h"

/* The response without noise at all points of the scene. */
typedef struct scene_response_grid {
  size_t dampings, drives;
  const char *damping, *drive;   /* names of the dimensions */
  const pendres_response *points; /* [damping][drive] */
} scene_response_grid;

/*
 * Compute and write the response at the deck's temperatures, with the dimensions [temperature,
 * damping, drive], the last two of which exist in the root group; that at temperature 0 is what
 * the grid holds. Points without a result are counted in the run.
 */
pendres_status scene_response_write_noise(scene_run *run, const scene_response_grid *grid);

#endif
