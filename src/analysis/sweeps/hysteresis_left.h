/*
 * hysteresis_left.h -- values of a path that are left out, since they cannot be computed.
 *
 * Owns: which failures concern one value only, how much work a value may cost, and the path without
 * such values. At the other values results are those of a path that never had them.
 */
#ifndef PENDRES_HYSTERESIS_LEFT_H
#define PENDRES_HYSTERESIS_LEFT_H

#include "analysis/sweeps/hysteresis_path.h"

/* The values of a path of which some may be left out. */
typedef struct pendres_path_left {
  double *value;           /* those that are not left out, as many as the path has */
  size_t *index;           /* their numbers among all values */
  pendres_status *outcome; /* [all] why a value was left out, or PENDRES_OK */
  size_t all;
} pendres_path_left;

/* Where a path was, in order to come back to it. */
typedef struct pendres_path_mark {
  pendres_path path;
  size_t jumps, parts;
} pendres_path_mark;

/* Whether a failure concerns one value only: the path may go on at others. */
int pendres_path_own(pendres_status status);

/* Give a path values of its own; close in any case. */
pendres_status pendres_path_left_open(pendres_path *w, pendres_path_left *left);
void pendres_path_left_close(pendres_path_left *left);

/* Limit the work from here on to that of one value; _all: lift the limit. */
void pendres_path_allow(pendres_path *w);
void pendres_path_allow_all(pendres_path *w);

/* Whether what ended with this status has taken more than the limit. */
int pendres_path_spent(const pendres_path *w, pendres_status status);

/* Note that the search for what there is beyond a state's end has begun; a direction of 0: it is
   over. */
void pendres_path_search_beyond(pendres_path *w, int direction, double end);

pendres_path_mark pendres_path_mark_here(const pendres_path *w);

/*
 * Whether the step that ended with this status has reached its value. It is 0 if the failure
 * concerns that value only, or if it cost too much. Then value number i is left out, the path is
 * put back to the mark, and *status is PENDRES_OK. What failed or cost too much may be to find what
 * there is beyond the end of a state, which would do the same on the way to the values that follow:
 * they are left out as well, until the path comes back.
 */
int pendres_path_came(pendres_path *w, pendres_path_left *left, const pendres_path_mark *mark,
                      size_t i, pendres_status *status);

/* Give points and jumps their numbers among all values; values that were left out or not reached
   get points without results. */
void pendres_path_number(pendres_path *w, const pendres_path_left *left);

#endif
