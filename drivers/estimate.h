/*
 * estimate.h -- time, memory and size of the output of a run, before it is begun.
 *
 * Owns: the rules for memory and for the size of the output, to which each scene contributes its
 * own (scene_size), and the time that --dry-run reports. The rules were measured on the decks of
 * input/, where they should be correct within a factor of two. What depends on the results, such as
 * the number of periods until pendulums settle and the number of neighbours in a grid that differ,
 * is found by computing a small part of the run (farm/trial.h). If that ends in the middle of a
 * task the reported time is a lower bound: the larger of two values, one as if no task took longer
 * than the part of that one, the other from a rule that depends on the damping.
 */
#ifndef ESTIMATE_H
#define ESTIMATE_H

#include "scenes/scene.h"

/* Print on standard output what a deck would compute, and what that would take: a little of it is
   computed, into a file in TMPDIR. run->deck and run->farm are set; the file, in run->store, is the
   caller's to free. Where nothing can be tried the time is left out. */
void estimate_dry_run(scene_run *run, const scene_kind *scene);

/* Warn if the output will not fit on the disk; the run continues, since this is only an estimate.
   0, after an error message, if the machine has less memory than the rules say that the run needs;
   otherwise 1. */
int estimate_fits(const deck *d, const farm *f, progress *p);

#endif
