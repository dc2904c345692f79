/*
 * langevin_moving.h -- trajectories of a pendulum whose parameters move, with noise or without.
 *
 * Owns: nothing; the integrator is that of langevin.h, whose fourth order holds without noise as
 * well, and the drive's phase goes on steadily whatever moves.
 */
#ifndef PENDRES_LANGEVIN_MOVING_H
#define PENDRES_LANGEVIN_MOVING_H

#include <pendres/langevin.h>

#include "noise/langevin_block.h"

/* Trajectories that start alike, in periods 0 to periods - 1. */
typedef struct pendres_langevin_moving {
  pendres_langevin_motion *motion;
  void *arg;         /* of motion() */
  size_t n;          /* trajectories */
  uint64_t first_id; /* trajectory i has id first_id + i */
  long periods;
  int steps;         /* a period */
  double x, v;       /* where they start */
  int may_leave;     /* for infinity: that some end there is no failure; the observer sees it */
  const pendres_langevin_observer *observer; /* never answers ENOUGH */
} pendres_langevin_moving;

/* All trajectories, seen by the observer. The pendulums were accepted (langevin_internal.h). */
pendres_status pendres_langevin_move(pendres_context *ctx, const pendres_langevin_moving *run);

/* Check the pendulum at one time. */
pendres_status pendres_langevin_moving_accept(pendres_context *ctx,
                                              const pendres_langevin_moving *run, double time);

#endif
