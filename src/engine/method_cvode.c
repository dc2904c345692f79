/* method_cvode.c -- one CVODE problem a pendulum; methods differ in how the corrector is solved. */
#include <math.h>
#include <stdlib.h>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "base/numbers.h"
#include "engine/sundials/compat.h"
#include "engine/method_one.h"
#include "model/equation.h"
#include "model/model.h"

/* What b->memory points to. */
typedef struct problem {
  void *cvode;
  SUNNonlinearSolver fixed_point;
  SUNMatrix matrix;
  SUNLinearSolver linear;
} problem;

/* CVODE by a linear multistep method, CV_ADAMS or CV_BDF; NULL on failure. */
static problem *open_cvode(pendres_one *b, int multistep)
{
  problem *c = calloc(1, sizeof *c);
  b->memory = c;
  if (c == NULL) return NULL;
  c->cvode = CVodeCreate(multistep, b->ctx->sun);
  if (c->cvode == NULL || pendres_compat_silence(b->ctx->sun, NULL, c->cvode) != 0 ||
      CVodeInit(c->cvode, pendres_one_slope, 0.0, b->state) != 0 ||
      CVodeSetUserData(c->cvode, b) != 0 ||
      CVodeWFtolerances(c->cvode, pendres_one_weights) != 0 ||
      CVodeSetMaxNumSteps(c->cvode, (long)PENDRES_MOST_SOLVER_STEPS) != 0)
    return NULL;
  return c;
}

/* Not stopped at the strobes: shortening a step there costs a multistep method its history, and
   CVODE's own interpolant is as accurate as its steps. */
static int advance(pendres_one *b, double theta)
{
  const problem *c = b->memory;
  sunrealtype reached = 0.0;
  return CVode(c->cvode, theta, b->state, &reached, CV_NORMAL);
}

static int steps(const pendres_one *b, long *steps)
{
  const problem *c = b->memory;
  return c->cvode != NULL ? CVodeGetNumSteps(c->cvode, steps) : -1;
}

static void close(pendres_one *b)
{
  problem *c = b->memory;
  if (c == NULL) return;
  if (c->cvode != NULL) CVodeFree(&c->cvode);
  if (c->fixed_point != NULL) (void)SUNNonlinSolFree(c->fixed_point);
  if (c->linear != NULL) (void)SUNLinSolFree(c->linear);
  if (c->matrix != NULL) SUNMatDestroy(c->matrix);
  free(c);
  b->memory = NULL;
}

/* ---- cvode_adams: Adams' method by fixed-point iteration ------------------------------------ */

static int open_adams(pendres_one *b)
{
  problem *c = open_cvode(b, CV_ADAMS);
  if (c == NULL) return -1;
  c->fixed_point = SUNNonlinSol_FixedPoint(b->state, 0, b->ctx->sun);
  return c->fixed_point == NULL || CVodeSetNonlinearSolver(c->cvode, c->fixed_point) != 0;
}

static pendres_status run_adams(pendres_context *ctx, const pendres_strobe_job *job)
{
  static const pendres_one_solver solver = {open_adams, advance, pendres_one_read,
                                            steps, close};
  return pendres_one_run(ctx, job, &solver);
}

const pendres_method_functions pendres_method_cvode_adams = {
  .running_clock = 1, .run = run_adams};

/* ---- cvode_bdf: BDF by Newton with the exact Jacobian --------------------------------------- */

static int jacobian(sunrealtype theta, N_Vector state, N_Vector f, SUNMatrix j, void *arg,
                    N_Vector t1, N_Vector t2, N_Vector t3)
{
  const pendres_one *b = arg;
  const double *s = N_VGetArrayPointer(state), omega = b->p->drive_frequency;
  double force, by_y;
  pendres_model_force(b->p, s[0], &force, &by_y);
  by_y *= 1.0 + b->p->parametric_amplitude * cos(theta);
  (void)f, (void)t1, (void)t2, (void)t3;
  SM_ELEMENT_D(j, 0, 0) = 0.0;
  SM_ELEMENT_D(j, 0, 1) = 1.0;
  const double v = s[1] * omega, by_place = pendres_equation_drag_by_place(b->p, s[0], v);
  SM_ELEMENT_D(j, 1, 0) = -(by_y + by_place) / (omega * omega);
  SM_ELEMENT_D(j, 1, 1) = -pendres_equation_drag(b->p, s[0], v) / omega;
  return 0;
}

static int open_bdf(pendres_one *b)
{
  problem *c = open_cvode(b, CV_BDF);
  if (c == NULL) return -1;
  c->matrix = SUNDenseMatrix(2, 2, b->ctx->sun);
  c->linear = c->matrix != NULL ? SUNLinSol_Dense(b->state, c->matrix, b->ctx->sun) : NULL;
  return c->linear == NULL || CVodeSetLinearSolver(c->cvode, c->linear, c->matrix) != 0 ||
         CVodeSetJacFn(c->cvode, jacobian) != 0;
}

static pendres_status run_bdf(pendres_context *ctx, const pendres_strobe_job *job)
{
  static const pendres_one_solver solver = {open_bdf, advance, pendres_one_read,
                                            steps, close};
  return pendres_one_run(ctx, job, &solver);
}

const pendres_method_functions pendres_method_cvode_bdf = {
  .running_clock = 1, .run = run_bdf};
