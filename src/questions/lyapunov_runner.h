/*
 * lyapunov_runner.h -- pendulums that run until they come back, or until averages are known.
 *
 * Owns: when strobe points have come back; what tangent vectors and neighbours grow by, and what is
 * averaged of it, batch by batch, and with the smooth weights that rotations are told by.
 */
#ifndef PENDRES_LYAPUNOV_RUNNER_H
#define PENDRES_LYAPUNOV_RUNNER_H

#include <pendres/context.h>

#include "engine/strobe_run.h"
#include "questions/smooth.h"

enum { PENDRES_RUNNER_BATCHES = 16 };

typedef enum pendres_runner_state {
  PENDRES_RUNNER_MOVING,
  PENDRES_RUNNER_CAUGHT, /* has come back next to where it was */
  PENDRES_RUNNER_DONE
} pendres_runner_state;

typedef struct pendres_runner {
  pendres_strobe_lane lane;
  pendres_runner_state state;
  /* Cycle detection: the strobe point that is compared with, and when the next takes its place. */
  double ref_y, ref_w, near;
  long ref_turns, ref_period, next;
  int period, winding; /* of the orbit that it seems to be near */
  int rotates;         /* it may be on a rotation that is not locked to the drive */
  int neighbour;       /* runs beside one, in place of tangent vectors: exact, at twice the cost */
  double u[2][2];      /* tangent vectors, by steps and by steps twice as long: both those of a
                          neighbour */
  /* Sums over the periods of each batch. */
  double growth[2][PENDRES_RUNNER_BATCHES], turned[PENDRES_RUNNER_BATCHES];
  pendres_smooth smooth; /* of rotations */
} pendres_runner;

/* A runner at its start, lane and steps, of which there must be an even number a period; points
   that come back closer than `near` are next to an orbit. */
pendres_runner pendres_runner_at(const pendres_strobe_lane *lane, double near);

/* Whether the latest strobe point is next to the one that it is compared with. */
int pendres_runner_comes_back(pendres_runner *r, const pendres_strobe_lane *l);

/* Averages of all of n runners that are moving, over so many periods a batch. Those that come back
   meanwhile are caught, and run to the end all the same. */
pendres_status pendres_runners_average(pendres_context *ctx, size_t n, pendres_runner *runners,
                                       long batch);

/*
 * Growth by steps twice as long is off by 16 times as much as that by steps: what follows from that
 * is taken off r->growth[0]. Returns how much it is a period, more than what is left; 0 of
 * neighbours.
 */
double pendres_runner_extrapolate(pendres_runner *r, long batch);

#endif
