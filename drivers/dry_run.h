/*
 * dry_run.h -- what a deck would compute, and at what cost.
 *
 * Owns: --dry-run. A small part of the run is computed, into a file in TMPDIR that is removed.
 */
#ifndef DRY_RUN_H
#define DRY_RUN_H

#include "scenes/scene.h"

/* Print it on standard output; run->deck and run->farm are set. The caller must free a scratch
   file in run->store. If no task can be tried, the time is left out. */
void dry_run(scene_run *run, const scene_kind *scene);

#endif
