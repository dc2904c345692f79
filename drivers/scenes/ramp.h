/*
 * ramp.h -- the swept parameter of scene hysteresis moved in real time, up and then down.
 *
 * Owns: the ramp that a deck asks for, its tasks, and its results beside those of the sweep without
 * end: the pendulum's way, and how late it leaves each state, with noise or without.
 */
#ifndef SCENE_RAMP_H
#define SCENE_RAMP_H

#include "scenes/along.h"

/* All of it, where the deck asks for a ramp; the dimensions `direction` and `jump` exist. The path
   was followed up and down, and the points of the way back are in the order of the axis. */
void scene_ramp_run(scene_run *run, deck_axis_id axis, const scene_along_path *path);

/* What is said of it before a run. */
void scene_ramp_describe(const deck *d, deck_axis_id axis, FILE *out);

#endif
