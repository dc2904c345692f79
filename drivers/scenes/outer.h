/*
 * outer.h -- a scene once for each value of an outer axis (deck_slices), as one run: whatever its
 * kind, results have that axis as one more dimension. No scene knows of it.
 */
#ifndef SCENE_OUTER_H
#define SCENE_OUTER_H

#include "scenes/scene.h"

/* Describe, and compute and write, all of a run: what the kind does or, with an outer axis, what it
   does for each of the values. */
void scene_describe_all(const deck *d, const scene_kind *scene, FILE *out);
pendres_status scene_run_all(scene_run *run, const scene_kind *scene);

/* The slices that a trial tries for --dry-run, number i of n: the only scene of a deck without an
   outer axis, or the first, the middle and the last. */
size_t scene_trials(const deck *d);
pendres_status scene_try(scene_run *run, const scene_kind *scene, size_t i);

#endif
