/*
 * hysteresis_path.h -- a pendulum on its way along a path of a parameter.
 *
 * Owns: where the pendulum is, and its results so far: points and jumps.
 */
#ifndef PENDRES_HYSTERESIS_PATH_H
#define PENDRES_HYSTERESIS_PATH_H

#include "analysis/sweeps/hysteresis_jump.h"
#include "analysis/sweeps/hysteresis_names.h"
#include "analysis/sweeps/stable_part.h"
#include "base/bytes.h"

/* A rotation without a lock to the drive that was met on the way. */
typedef struct pendres_unlocked pendres_unlocked;

typedef struct pendres_path {
  pendres_context *ctx;
  pendres_pendulum pendulum; /* all parameters but the one that changes */
  pendres_parameter parameter;
  const double *all;   /* the values that were asked for, ... */
  size_t n;
  const double *value; /* ... and those that are not left out */
  int settled;         /* whether the first of these values has been computed */
  int known, certain;  /* whether the state is known that the path begins on, and whether no error
                          of the integration can have chosen it */
  int states_only;     /* no ends of states are asked for: what takes their place is met at the
                          values themselves, wherever no choice is made on the way there */
  double most_slopes;  /* evaluations of the slope that one value may take; 0: the default */
  pendres_hysteresis *h;
  double at;               /* the present value of the parameter */
  pendres_arrival state;   /* what the pendulum is on there */
  pendres_part part; /* that it is followed along; none: not yet, or no closed orbit */
  int beyond;              /* while it is searched for what there is beyond the end of a state: the
                              direction in which that lies, else 0, ... */
  double end;              /* ... and where the state ends */
  size_t tried;            /* number of the value to which a way out of chaos was last tried, ... */
  int tries;               /* ... and how often */
  pendres_unlocked *unlocked; /* at each of this many different values; NULL: none met yet */
  size_t values;
  struct pendres_crisis_seen *seen; /* chaos compared with another last; NULL: none */
} pendres_path;

pendres_pendulum pendres_path_pendulum(const pendres_path *w, double value);

/* Whether the path goes up (1) or down (-1) to value number i. */
int pendres_path_direction(const pendres_path *w, size_t i);

/* Orbits of at most so many drive periods are followed by continuation. */
int pendres_path_longest(const pendres_path *w);

/* Put the attractor at value number i into the results; without a closed orbit, the pendulum's
   state. */
void pendres_path_put(pendres_path *w, size_t i, const pendres_attractor *a);

/* A point without results but for the parameter's value. */
pendres_hysteresis_point pendres_path_nothing(const pendres_path *w, double value);

/* End the part, or whatever the pendulum was on. */
void pendres_path_leave(pendres_path *w);

/* Add a jump to the results. */
pendres_status pendres_path_note(pendres_path *w, const pendres_jump *j);

/* pendres_hysteresis_find() for a path, from position x and velocity v. */
pendres_status pendres_path_run(pendres_path *w, double x, double v, pendres_hysteresis **out);

#endif
