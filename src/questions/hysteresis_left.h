/*
 * hysteresis_left.h -- values that a path leaves out, since it cannot come to them.
 *
 * Owns: which failures are a value's own, what a value may cost, and the path without such values.
 * What a pendulum does at the others is what it does on a path that never had them.
 */
#ifndef PENDRES_HYSTERESIS_LEFT_H
#define PENDRES_HYSTERESIS_LEFT_H

#include "questions/hysteresis_path.h"

/* The values of a path of which some may be left out. */
typedef struct pendres_path_left {
  double *value;           /* those that are still there, as many as the path has */
  size_t *index;           /* their numbers among all of them */
  pendres_status *outcome; /* of all: why one was left out, or PENDRES_OK */
  size_t all;
} pendres_path_left;

/* Where a path was, in order to come back to it. */
typedef struct pendres_path_mark {
  pendres_path path;
  size_t jumps, stretches;
} pendres_path_mark;

/* Whether a failure is a value's own: at others the path may go on. */
int pendres_path_own(pendres_status status);

/* Give a path values of its own; close in any case. */
pendres_status pendres_path_left_open(pendres_path *w, pendres_path_left *left);
void pendres_path_left_close(pendres_path_left *left);

/* From here on to the next call or the end the path may cost what a value may. */
void pendres_path_allow(pendres_path *w);
void pendres_path_allow_all(pendres_path *w);

pendres_path_mark pendres_path_mark_here(const pendres_path *w);

/*
 * Whether the step that ended with this status has come to its value: 0 if it failed for the
 * value's own sake, or cost too much. Then value number i is left out, the path is where it was at
 * the mark, and *status is PENDRES_OK.
 */
int pendres_path_came(pendres_path *w, pendres_path_left *left, const pendres_path_mark *mark,
                      size_t i, pendres_status *status);

/* Give points and jumps the numbers that they have among all values; those left out and those that
   were not reached get points of which nothing is known. */
void pendres_path_number(pendres_path *w, const pendres_path_left *left);

#endif
