/*
 * scene_basins_noise.h -- the noisy part of scene `basins`: clouds around the attractors.
 */
#ifndef SCENE_BASINS_NOISE_H
#define SCENE_BASINS_NOISE_H

#include "scenes/scene.h"

/*
 * Compute and write the clouds around all attractors of the set at the deck's temperatures, and
 * print a table of them. Nothing is done if the deck has no temperature axis. The root group has
 * the dimension `attractor` already, in the order of the set; the dimensions `temperature` and
 * `strobe` are made here. The run holds the message of a failure.
 */
pendres_status scene_basins_write_clouds(scene_run *run, const pendres_attractors *set);

#endif
