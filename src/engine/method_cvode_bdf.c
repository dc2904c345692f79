/* method_cvode_bdf.c -- one CVODE problem a pendulum, BDF by Newton with the exact Jacobian. */
#include <math.h>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "engine/method_cvode.h"
#include "model/model.h"

static int jacobian(sunrealtype theta, N_Vector state, N_Vector f, SUNMatrix j, void *arg,
                    N_Vector t1, N_Vector t2, N_Vector t3)
{
  const pendres_one *b = arg;
  const double omega = b->p->drive_frequency;
  double force, by_y;
  pendres_model_force(b->p, N_VGetArrayPointer(state)[0], &force, &by_y);
  by_y *= 1.0 + b->p->parametric_amplitude * cos(theta);
  (void)f, (void)t1, (void)t2, (void)t3;
  SM_ELEMENT_D(j, 0, 0) = 0.0;
  SM_ELEMENT_D(j, 0, 1) = 1.0;
  SM_ELEMENT_D(j, 1, 0) = -by_y / (omega * omega);
  SM_ELEMENT_D(j, 1, 1) = -b->p->damping / omega;
  return 0;
}

static int open(pendres_one *b)
{
  pendres_cvode *c = pendres_cvode_open(b, CV_BDF);
  if (c == NULL) return -1;
  c->matrix = SUNDenseMatrix(2, 2, b->ctx->sun);
  c->linear = c->matrix != NULL ? SUNLinSol_Dense(b->state, c->matrix, b->ctx->sun) : NULL;
  return c->linear == NULL || CVodeSetLinearSolver(c->cvode, c->linear, c->matrix) != 0 ||
         CVodeSetJacFn(c->cvode, jacobian) != 0;
}

static pendres_status run(pendres_context *ctx, const pendres_strobe_job *job)
{
  static const pendres_one_solver solver = {open, pendres_cvode_advance, pendres_one_read,
                                            pendres_cvode_steps, pendres_cvode_close};
  return pendres_one_run(ctx, job, &solver);
}

const pendres_method_functions pendres_method_cvode_bdf = {
  .running_clock = 1, .run = run};
