/* method_cvode_adams.c -- one CVODE problem a pendulum, Adams' method by fixed-point iteration. */
#include <cvode/cvode.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "engine/method_cvode.h"

static int open(pendres_one *b)
{
  pendres_cvode *c = pendres_cvode_open(b, CV_ADAMS);
  if (c == NULL) return -1;
  c->fixed_point = SUNNonlinSol_FixedPoint(b->state, 0, b->ctx->sun);
  return c->fixed_point == NULL || CVodeSetNonlinearSolver(c->cvode, c->fixed_point) != 0;
}

static pendres_status run(pendres_context *ctx, const pendres_strobe_job *job)
{
  static const pendres_one_solver solver = {open, pendres_cvode_advance, pendres_one_read,
                                            pendres_cvode_steps, pendres_cvode_close};
  return pendres_one_run(ctx, job, &solver);
}

const pendres_method_functions pendres_method_cvode_adams = {
  .running_clock = 1, .run = run};
