/*
 * method.h -- how lanes are advanced: each method is a constant struct of functions in a file
 * method_NAME.c, and a line of the list below.
 *
 * Owns: lanes that are being integrated, and the list.
 */
#ifndef PENDRES_METHOD_H
#define PENDRES_METHOD_H

#include <pendres/context.h>
#include <pendres/pendulum.h>

#include "engine/kernels/kernels.h"

/* One pendulum that is being integrated. y is kept within half a turn of zero; whole turns are
   counted. */
typedef struct pendres_strobe_lane {
  const pendres_pendulum *pendulum; /* not owned */
  double y, w;                      /* angle, dy/dtheta at the latest strobe */
  long turns;                       /* whole turns taken out of y */
  long period;                      /* strobes so far */
  long charted;                     /* those that charts led over: all but one of each (charts.h) */
  int steps;                        /* a period; unused by adaptive methods */
  pendres_flow_way way;             /* of block_fixed; in single precision `added` allows for its
                                       rounding */
  double added;                     /* variance that a step adds to y's error (block.h); 0: errors
                                       are not propagated. With fixed steps only */
  pendres_flow_error off;           /* covariance of the errors of y and w */
  double worst;                     /* largest variance at a strobe so far, of y and w together */
  double longest;                   /* step of drive phase that block_adaptive and single may take;
                                       0: any */
  double taken;                     /* steps that they took, in a block on average */
} pendres_strobe_lane;

/* Called for lane number `index` after each period; nonzero: the lane is done. */
typedef int pendres_strobe_visit(void *arg, size_t index, const pendres_strobe_lane *lane);

/* A run: the lanes, the function that is called for them, and the tolerance of methods that choose
   their own steps. */
typedef struct pendres_strobe_job {
  size_t n;            /* > 0 */
  const size_t *which; /* numbers of the lanes that run, [n]; NULL: lanes 0 to n - 1 */
  pendres_strobe_lane *lanes;
  pendres_strobe_visit *visit;
  void *arg;        /* of visit */
  double tolerance; /* relative and absolute, of a step; unused where steps are fixed */
} pendres_strobe_job;

/* The number of the lane that runs as number i. */
static inline size_t pendres_strobe_which(const pendres_strobe_job *job, size_t i)
{
  return job->which != NULL ? job->which[i] : i;
}

typedef struct pendres_method_functions {
  int fixed_steps;     /* the number of steps is that of the lane; other methods choose their own by
                          the tolerance */
  int running_clock;   /* the clock is not reset at a period's end, so that its rounding errors add
                          up */
  /* Run lanes until visit() has declared each of them done; they keep their final state. */
  pendres_status (*run)(pendres_context *ctx, const pendres_strobe_job *job);
} pendres_method_functions;

/* The list: a method's value in the enum of context.h, and its struct, pendres_method_NAME. */
#define PENDRES_METHODS(EACH)                  \
  EACH(PENDRES_BLOCK_FIXED, block_fixed)       \
  EACH(PENDRES_BLOCK_ADAPTIVE, block_adaptive) \
  EACH(PENDRES_SINGLE, single)                 \
  EACH(PENDRES_CVODE_ADAMS, cvode_adams)       \
  EACH(PENDRES_CVODE_BDF, cvode_bdf)           \
  EACH(PENDRES_NAIVE, naive)

#define PENDRES_METHOD_DECLARE(value, name) \
  extern const pendres_method_functions pendres_method_##name;
PENDRES_METHODS(PENDRES_METHOD_DECLARE)
#undef PENDRES_METHOD_DECLARE

/* A context's method (strobe_run.c). */
const pendres_method_functions *pendres_method_of(const pendres_context *ctx);

#endif
