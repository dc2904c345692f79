/*
 * hysteresis_path.h -- a pendulum on its way along a path of a parameter.
 *
 * Owns: where it is, and what is noted of that: points and jumps.
 */
#ifndef PENDRES_HYSTERESIS_PATH_H
#define PENDRES_HYSTERESIS_PATH_H

#include "questions/circles.h"
#include "questions/hysteresis_jump.h"
#include "questions/hysteresis_names.h"
#include "questions/rotation_table.h"
#include "questions/stretch.h"

typedef struct pendres_path {
  pendres_context *ctx;
  pendres_pendulum pendulum; /* but for the parameter */
  pendres_parameter parameter;
  const double *all;   /* the values that were asked for, ... */
  size_t n;
  const double *value; /* ... and those that are not left out */
  int settled;         /* it has come to the first of these */
  double most_slopes;  /* that coming to a value may take; 0: the usual */
  pendres_hysteresis *h;
  double at;               /* where the parameter is now */
  pendres_settled state;   /* what the pendulum is on there */
  pendres_stretch stretch; /* that it is followed along; none: not yet, or not closed */
  size_t tried;            /* the value to which it was last tried to come from chaos, ... */
  int tries;               /* ... so often */
  pendres_rotation_table *rotations; /* without a drive; NULL: not met yet */
  pendres_circles *circles; /* NULL: not met yet */
  int on_circle;            /* it is on one of them, locked or not, ... */
  pendres_circles_verdict last; /* ... as was told here for the last time */
} pendres_path;

pendres_pendulum pendres_path_pendulum(const pendres_path *w, double value);

/* The attractor at value number i; of what is not closed, the state that the pendulum is in. */
void pendres_path_put(pendres_path *w, size_t i, const pendres_attractor *a);

/* A point of which nothing is known but the parameter. */
pendres_hysteresis_point pendres_path_nothing(const pendres_path *w, double value);

/* The stretch, or whatever the pendulum was on, is over. */
void pendres_path_leave(pendres_path *w);

pendres_status pendres_path_note(pendres_path *w, const pendres_jump *j);

/* pendres_hysteresis_follow of a path from position x and velocity v. */
pendres_status pendres_path_run(pendres_path *w, double x, double v, pendres_hysteresis **out);

#endif
