/*
 * langevin_internal.h -- what the files of noisy trajectories share.
 */
#ifndef PENDRES_LANGEVIN_INTERNAL_H
#define PENDRES_LANGEVIN_INTERNAL_H

#include <pendres/langevin.h>

#include "engine/context_internal.h"
#include "engine/door.h"
#include "noise/langevin_block.h"

/* The steps a drive period that a caller asks for, or the context's, or the default. */
int pendres_langevin_resolve_steps(const pendres_context *ctx, int steps);

/* A block, with the context's seed, for that many trajectories or, if these are too many for one
 * block, for a part of them. Clear it in any case. */
pendres_status pendres_langevin_open(pendres_context *ctx, size_t trajectories, int steps,
                                     pendres_langevin_block *b);

/* Count a period of a block's trajectories. */
void pendres_langevin_count(pendres_context *ctx, const pendres_langevin_block *b);

/* Check one pendulum and its state, for `steps` steps a period; the message names `index`. */
pendres_status pendres_langevin_accept(pendres_context *ctx, const pendres_pendulum *p, double x,
                                       double v, int steps, size_t index);

/* Check the numbers of periods. */
pendres_status pendres_langevin_accept_periods(pendres_context *ctx, long first, long periods);

/* Show a strobe to the observer; `first` is the number of the block's first trajectory. */
pendres_langevin_answer pendres_langevin_show(pendres_context *ctx,
                                              const pendres_langevin_block *b, size_t first,
                                              long period,
                                              const pendres_langevin_observer *observer);

/* Fail if an angle in the block is too large to be known, or not a number. */
pendres_status pendres_langevin_check_ends(pendres_context *ctx, const pendres_langevin_block *b,
                                           size_t first);

/* ---- trajectories of a pendulum whose parameters move, with noise or without. The integrator's
   order is four without noise as well; the drive's phase goes on steadily whichever parameter
   moves. ---- */

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

/* How the caller's functions see trajectories that are behind the door. */

/* Between a function of the caller's and the trajectories of a run of pendulums. */
typedef struct pendres_noise_window {
  pendres_door *door;
  const pendres_langevin_observer *observer;
  const pendres_langevin_request *request;
  pendres_langevin_observer through;
  double *memory; /* the door's */
  size_t room;
} pendres_noise_window;

/* The observer of a run of pendulums, for one of all trajectories in the caller's units; NULL for
   NULL. */
const pendres_langevin_observer *pendres_noise_observer(pendres_door *d,
                                                        const pendres_langevin_observer *observer,
                                                        pendres_noise_window *window);

/* A request behind the door, in *inside, whose function `leave` is called in the caller's units. */
const pendres_langevin_request *pendres_noise_request(pendres_door *d,
                                                      const pendres_langevin_request *request,
                                                      pendres_noise_window *window,
                                                      pendres_langevin_request *inside);

#endif
