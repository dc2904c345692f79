/*
 * method_one.h -- the methods to compare with: one ARKODE or CVODE problem a pendulum.
 *
 * Deliberately independent of the blocks: the plain serial vector, libm's sine, adaptive steps, a
 * clock that is not reset. Slow, but an independent check.
 */
#ifndef PENDRES_METHOD_ONE_H
#define PENDRES_METHOD_ONE_H

#include <sundials/sundials_context.h>
#include <sundials/sundials_nvector.h>
#include <sundials/sundials_types.h>

#include "engine/context_internal.h"
#include "engine/method.h"

/* One pendulum's problem. */
typedef struct pendres_one {
  pendres_context *ctx;
  const pendres_pendulum *p;
  double tolerance;
  double longest; /* step over drive phase; 0: any. Only `single` obeys it */
  N_Vector state; /* y and w over drive phase, unless the solver says otherwise */
  void *memory;   /* the solver's */
  int stopped;
  long evaluations;
} pendres_one;

/* What solves it; everything returns nonzero on failure, SUNDIALS' code where there is one. */
typedef struct pendres_one_solver {
  int (*open)(pendres_one *b); /* from the state at phase 0 on, y and w */
  int (*advance)(pendres_one *b, double theta);
  void (*read)(const pendres_one *b, double *y, double *w);
  int (*steps)(const pendres_one *b, long *steps); /* so far */
  void (*close)(pendres_one *b); /* after open has failed, too */
} pendres_one_solver;

/* As the `run` of a method's functions, by a solver. */
pendres_status pendres_one_run(pendres_context *ctx, const pendres_strobe_job *job,
                               const pendres_one_solver *solver);

/* For solvers over drive phase: the right-hand side, which checks now and then whether to go on
   ... */
int pendres_one_slope(sunrealtype theta, N_Vector state, N_Vector out, void *one);
/* ... error weights by the tolerance ... */
int pendres_one_weights(N_Vector state, N_Vector out, void *one);
/* ... and the state as it is. */
void pendres_one_read(const pendres_one *b, double *y, double *w);

/* For solvers on ERKStep: `steps` and `close`. */
int pendres_one_erk_steps(const pendres_one *b, long *steps);
void pendres_one_erk_close(pendres_one *b);

#endif
