/*
 * strobe_run.h -- the engine under every analysis: lanes of a block, retired
 * and refilled at the strobe.
 *
 * Owns: which pendulum sits in which lane. A caller hands over a list of
 * lanes and a function that looks at each of them after every drive period
 * and says whether it is done.
 */
#ifndef PENDRES_STROBE_RUN_H
#define PENDRES_STROBE_RUN_H

#include <pendres/context.h>
#include <pendres/pendulum.h>

#include "engine/kernels.h"

/* One pendulum under way. y is kept within half a turn of zero; whole turns are counted. */
typedef struct pendres_strobe_lane {
  const pendres_pendulum *pendulum; /* not owned */
  double y, w;                      /* angle, dy/dtheta at the latest strobe */
  long turns;                       /* whole turns taken out of y */
  long period;                      /* strobes so far */
  int steps;                        /* a period; unused by adaptive methods */
  double added;                     /* variance that a step adds to y's error (flow.h); 0: errors
                                       are not carried. Fixed steps only */
  pendres_flow_error off;           /* what y and w are off by */
  double worst;                     /* largest variance at a strobe so far, of y and w together */
} pendres_strobe_lane;

/* A lane's place in a list, and its steps. */
typedef struct pendres_strobe_rank {
  int steps;
  size_t index;
} pendres_strobe_rank;

/* Lanes in the order of their steps, those of equal steps in their own order. */
void pendres_strobe_order(size_t n, pendres_strobe_rank *rank);

/* Look at lane number `index` after one more period; nonzero: it is done. */
typedef int pendres_strobe_visit(void *arg, size_t index, const pendres_strobe_lane *lane);

/*
 * Run n lanes until visit() has declared each of them done. Lanes keep their final state.
 * Pendulums with the same steps a period share blocks; retired lanes are replaced at once. Errors
 * are carried along if the first lane says so.
 */
pendres_status pendres_strobe_run(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                  pendres_strobe_visit *visit, void *arg);

/* A lane at a state (x, v), whole turns taken out: steps and errors are the caller's to set. */
pendres_strobe_lane pendres_strobe_lane_at(const pendres_pendulum *p, double x, double v);
/* Where it is now. */
void pendres_strobe_lane_out(const pendres_strobe_lane *l, double *x, double *v);

/*
 * How far off a run may be that is so far from a better one. The better one is off as well, by less
 * than half as much: steps 1.4 times as many leave a fifteenth at order eight, a fifth at five, and
 * a tenth of the tolerance somewhat more than a tenth. So the distance is at least half the error.
 * Runs that are a tenth of a radian apart have lost each other, and nothing is known (infinite).
 */
double pendres_strobe_doubt(double distance);

/* The failure of a pendulum whose state is no number after some periods. */
pendres_status pendres_strobe_lost(pendres_context *ctx, const pendres_pendulum *p, long period);

#endif
