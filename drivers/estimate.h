/*
 * estimate.h -- what a run will take, told before it is begun.
 *
 * Owns: the rules for memory and for the size of the output, of which each scene tells its own
 * (scene_size), and what --dry-run says of time. Rules were measured on the decks of input/ and
 * are meant to be right within a factor of two there; what depends on the answers, as how often a
 * pendulum has to go round until it settles and how many neighbours of a grid differ, is found by
 * computing a little of the run (farm/trial.h). Where that ends in the middle of a task the time is
 * told as the least that there is: as if no task took longer than what was seen of that one, and by
 * a rule that knows the damping, whichever is more.
 */
#ifndef ESTIMATE_H
#define ESTIMATE_H

#include <stdio.h>

#include "deck/deck.h"
#include "farm/trial.h"
#include "terminal/progress.h"

/* What a trial has shown of a deck, in lines. `threads` of the run to come. */
void estimate_print(const deck *d, const farm_trial *t, double outside, int threads, FILE *out);

/* A line on free space in the folder of `path`. */
void estimate_print_space(const char *path, FILE *out);

/* Tell where the disk will not hold the output; the run goes on, since an estimate is no
   measure. 0, after an error that says so, where the machine has less memory than the rules tell
   that the run needs; else 1. */
int estimate_fits(const deck *d, const farm *f, progress *p);

#endif
