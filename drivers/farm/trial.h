/*
 * trial.h -- the cost of a run, estimated from a few of its tasks.
 *
 * Owns: the choice of tasks that are tried, and the estimate from them. A stage of which all tasks
 * could be tried is done, and the scene continues with the next; any other stage ends the trial.
 * The estimate therefore covers the first part of a run, which for most scenes is nearly all of it.
 */
#ifndef TRIAL_H
#define TRIAL_H

#include <stddef.h>

#include <pendres/pendres.h>

#include "farm/farm.h"

/* Bytes that the states of a path take in the journal that takes so long, beside its record of
   `bytes`. */
double farm_states(double seconds, double bytes);

typedef struct farm_trial {
  double few, most;    /* processor seconds: after `few` no further task of a stage is begun, after
                          `most` everything ends, running tasks included */
  size_t least;        /* tasks of a stage that are tried even if they take longer than `few` */
  double start;        /* processor time at its beginning; farm_trial_start() sets it */
  /* For all tasks of the stages up to the one that ended the trial: */
  double seconds;      /* of processor time */
  double journal;      /* bytes */
  double changes;      /* elements of records that differ from the one before */
  pendres_cost cost;
  double spent;        /* seconds in the tasks that were tried; the rest of the trial was outside of
                          tasks */
  double periods;      /* of the drive, of all pendulums, in these seconds */
  const char *what;    /* tasks of the stage that ended it; NULL: the scene came to its end */
  size_t tasks, tried;
  double share;        /* of the task that was begun last: how much of it was done */
  double path;         /* share of the paths that was done, by which their time is told; 0: none was
                          begun, or it is not known */
  double until;        /* as `most`, of the present task */
  int cut;             /* the trial ended in the middle of something: the times are lower bounds */
  /* Of several trials: */
  double outside;      /* seconds outside of tasks */
  int members;         /* no lower bounds all the same: some members came to their end at a point */
} farm_trial;

/* From now on the stages of this farm are tried (NULL: no more); in *t, which is not owned, the
   first three fields are set and the others are zero. farm_run returns PENDRES_INTERRUPTED when the
   trial has ended. */
void farm_set_trial(farm *f, farm_trial *t);

/* Seconds outside of tasks since the start of the trial. */
double farm_trial_outside(const farm_trial *t);

#endif
