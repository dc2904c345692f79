/*
 * dry_run.h -- what a deck would compute, and what that would take.
 *
 * Owns: --dry-run. A little of the run is computed, into a file in TMPDIR that is dropped.
 */
#ifndef DRY_RUN_H
#define DRY_RUN_H

#include "scenes/scene.h"

/* Print it on standard output; run->deck and run->farm are set. A scratch file in run->store is the
   caller's to free. Where nothing can be tried the time is left out. */
void dry_run(scene_run *run, const scene_kind *scene);

#endif
