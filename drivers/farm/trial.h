/*
 * trial.h -- what a run would cost, from a few of its tasks.
 *
 * Owns: the choice of tasks that are tried, and what is concluded from them. A stage of which all
 * tasks could be tried is done, and the scene goes on to the next; any other ends the trial. So
 * what is known is the part of a run that begins it, for most scenes nearly all of it.
 */
#ifndef TRIAL_H
#define TRIAL_H

#include <stddef.h>

#include <pendres/pendres.h>

#include "farm/farm.h"

typedef struct farm_trial {
  double few, most;    /* processor seconds: after `few` no task of a stage is begun, after `most`
                          all ends, a task under way too */
  size_t least;        /* tasks of a stage, though they take longer than `few` */
  double start;        /* processor time at its beginning; farm_trial_start() sets it */
  /* Of the stages up to the one that ended the trial, all of their tasks: */
  double seconds;      /* of processor time */
  double journal;      /* bytes */
  double changes;      /* elements of records that differ from the one before */
  pendres_cost cost;
  double spent;        /* seconds in the tasks that were tried, so that the rest of the trial is
                          known to be outside of tasks */
  const char *what;    /* tasks of the stage that ended it; NULL: the scene came to its end */
  size_t tasks, tried;
  int cut;             /* the end of the trial came in the middle of something: what is told of time
                          is the least that there is */
} farm_trial;

/* From now on the stages of this farm are tried; *t, not owned, has the first three and is zero
   otherwise. farm_run then returns PENDRES_INTERRUPTED where the trial has ended. */
void farm_set_trial(farm *f, farm_trial *t);

/* Seconds outside of tasks since the start of the trial. */
double farm_trial_outside(const farm_trial *t);

#endif
