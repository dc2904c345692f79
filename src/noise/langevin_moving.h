/*
 * langevin_moving.h -- trajectories of a pendulum whose parameters move, with noise or without.
 *
 * Owns: the loop over periods and parts. The integrator is that of langevin.h, whose order is four
 * without noise as well; the drive's phase goes on steadily whichever parameter moves.
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
  int may_leave;     /* nonzero: it is no failure if some go to infinity; the observer sees it */
  const pendres_langevin_observer *observer; /* never answers ENOUGH */
} pendres_langevin_moving;

/* Advance all trajectories, and show them to the observer. The pendulums must have been accepted
   (pendres_langevin_moving_accept). */
pendres_status pendres_langevin_move(pendres_context *ctx, const pendres_langevin_moving *run);

/* Check the pendulum at one time. */
pendres_status pendres_langevin_moving_accept(pendres_context *ctx,
                                              const pendres_langevin_moving *run, double time);

#endif
