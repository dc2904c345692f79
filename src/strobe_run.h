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

/* One pendulum under way. y is kept within half a turn of zero; whole turns are counted. */
typedef struct pendres_strobe_lane {
  const pendres_pendulum *pendulum; /* not owned */
  double y, w;                      /* angle, dy/dtheta at the latest strobe */
  long turns;                       /* whole turns taken out of y */
  long period;                      /* strobes so far */
  int steps;                        /* a period; unused by adaptive methods */
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
 * Pendulums with the same steps a period share blocks; retired lanes are replaced at once.
 */
pendres_status pendres_strobe_run(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                  pendres_strobe_visit *visit, void *arg);

/* Take whole turns out of an angle: -pi <= y <= pi afterwards. */
void pendres_strobe_wrap(double *y, long *turns);

/*
 * A state at the end of a period: whole turns are taken out. A damped pendulum without a drive dies
 * down to denormal numbers and stays there, in steps that take forty times as long: below 1e-290 it
 * is put to rest.
 */
void pendres_strobe_arrive(const pendres_pendulum *p, double *y, double *w, long *turns);

#endif
