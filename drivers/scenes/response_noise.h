/*
 * response_noise.h -- the noisy part of scene `response`: loop area, phase lag and amplitude
 * against temperature.
 */
#ifndef SCENE_RESPONSE_NOISE_H
#define SCENE_RESPONSE_NOISE_H

#include "scenes/points.h"

/* What is written of a point: see pendres_response. */
typedef struct scene_response_row {
  double mean_loop_area, mean_loop_area_error, mean_loop_amplitude, mean_loop_amplitude_error;
  double mean_amplitude, mean_amplitude_error, phase_lag, phase_lag_error;
  double mean_power, mean_power_error, sa_fraction, sa_fraction_error;
  double la_fraction, la_fraction_error;
  size_t uncertain;
} scene_response_row;

/* The response without noise at all points of the scene. */
typedef struct scene_response_grid {
  const scene_points *points;
  const scene_temporary *kept, *rows; /* of pendres_response and scene_response_row */
} scene_response_grid;

/*
 * Compute and write the response at the deck's temperatures, with a dimension `temperature` before
 * those of the grid, which exist in the root group; that at temperature 0 is what the grid holds.
 * Points without a result are counted in the run.
 */
void scene_response_write_noise(scene_run *run, const scene_response_grid *grid);

#endif
