/*
 * lyapunov_runner.h -- pendulums that run until their strobe points repeat, or averages are known.
 *
 * Owns: whether strobe points have repeated; the growth of tangent vectors, and its averages, batch
 * by batch; the means over time that tell rotations.
 */
#ifndef PENDRES_LYAPUNOV_RUNNER_H
#define PENDRES_LYAPUNOV_RUNNER_H

#include <pendres/lyapunov.h>

#include "engine/strobe_run.h"
#include "settling/exponents/growth.h"
#include "orbits/mean.h"

enum { PENDRES_RUNNER_LONGEST_ORBIT = 128 /* drive periods of an orbit that is looked for */ };

typedef enum pendres_runner_state {
  PENDRES_RUNNER_MOVING,
  PENDRES_RUNNER_WAITING,
  PENDRES_RUNNER_CAUGHT, /* has come back next to where it was */
  PENDRES_RUNNER_AWAY,   /* escapes to infinity for certain, ... */
  PENDRES_RUNNER_LOST,   /* ... or is beyond all numbers: its last period tells then */
  PENDRES_RUNNER_DONE
} pendres_runner_state;

/* What is carried along beside a runner in averages, to see how errors grow. */
typedef enum pendres_runner_beside {
  PENDRES_BESIDE_NOTHING,
  PENDRES_BESIDE_TANGENTS
} pendres_runner_beside;

typedef struct pendres_runner {
  pendres_strobe_lane lane;
  pendres_runner_state state;
  /* Cycle detection: the strobe point that is compared with, and when the next takes its place. */
  double ref_y, ref_w, near;
  long ref_turns, ref_period, next;
  int period, winding; /* of the orbit that it seems to be near */
  int steps;           /* of averages, a period */
  double doubt;        /* the error that it has carried so far, over the largest one that cannot
                          change where it goes; NaN: not known */
  double sure_y, sure_w; /* the last state before that was above 1, ... */
  double back;           /* ... and the smallest distance to that in averages */
  long came;           /* the period at which it had come to an orbit, or escaped; -1: not known */
  long until;          /* the period at which its transient is over, or it has been followed */
  int followed;        /* after its transient */
  int open;            /* it may escape, */
  double before_y, before_w; /* and was here a period ago */
  int rotates;         /* it may be on a rotation that is not locked to the drive */
  pendres_runner_beside beside;
  int rough;           /* its mean turns are known, and are to be averaged again with more steps */
  int adrift;          /* its steps are right for averages alone, and no errors are carried */
  double u[2][2];      /* tangent vectors by steps, and by steps twice as long; adrift both are by
                          its steps */
  /* Sums over the periods of each batch. */
  double growth[2][BATCHES], turned[BATCHES];
  pendres_mean turns, squares; /* of rotations: turns a period, and w at its end, squared */
} pendres_runner;

/* A runner at its start, lane and steps, of which there must be an even number a period; points
   that come back closer than `near` are next to an orbit. */
pendres_runner pendres_runner_at(const pendres_strobe_lane *lane, double near);

/* Note the doubt of the latest strobe point. */
void pendres_runner_trust(pendres_runner *r, const pendres_strobe_lane *l, double doubt);

/* Note how near the latest strobe point is to the last sure state. */
void pendres_runner_pass(pendres_runner *r, const pendres_strobe_lane *l);

/* Whether the latest strobe point is next to the one that it is compared with. */
int pendres_runner_comes_back(pendres_runner *r, const pendres_strobe_lane *l);

/* Whether the latest strobe point shows that a runner escapes, or is lost: its state says which. */
int pendres_runner_leaves(pendres_runner *r, const pendres_strobe_lane *l);

/* Averages of all of n runners that are moving, over this many periods a batch. Those that come
   back meanwhile are caught, and run to the end all the same. */
pendres_status pendres_runners_average(pendres_context *ctx, size_t n, pendres_runner *runners,
                                       long batch);

/* Correct r->growth[0] by that with steps twice as long. Returns the correction for one period,
   which exceeds the error that is left; 0 for runners without tangent vectors. */
double pendres_runner_extrapolate(pendres_runner *r, long batch);

/* ---- lyapunov_means.c: rotations that are not locked to the drive, by how many digits of their
   means over time are known (orbits/mean.h), and what errors of the integration do to them ---- */

/* Whether a runner that has been averaged over this many periods is on such a rotation: its mean
   turns are known to `enough`. One whose mean is a fraction of small numbers is caught: it may be
   on its slow way to an orbit. */
int pendres_means_tell(pendres_runner *r, long periods, double enough, pendres_settled *out);

/* Whether one that may be next to such a rotation is certainly on none: it is on chaos. */
int pendres_means_scatter(const pendres_runner *r, long periods);

/*
 * Average all of n runners that are `rough` again, over the same time with more steps. These means
 * take the place of the former ones, and their distance tells the error. A runner whose means do
 * not agree is unresolved, and moves on.
 */
pendres_status pendres_means_refine(pendres_context *ctx, size_t n, pendres_runner *runners,
                                    long batch, pendres_settled *out);

#endif
