/*
 * flow_single.c -- one ARKODE or CVODE problem a pendulum; see flow_single.h.
 *
 * Independent of the blocks on purpose: the plain serial vector, libm's sine,
 * adaptive steps, a clock that runs on. Slow, and a second opinion.
 *
 * CVODE is not stopped at the strobes: shortening a step there costs a multistep method its
 * history, and its own interpolant is as accurate as its steps. ARKODE's is not, so ARKODE stops.
 */
#include "engine/flow_single.h"

#include <math.h>
#include <string.h>

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "engine/compat.h"
#include "engine/context_internal.h"
#include "engine/flow_table.h"
#include "engine/passage.h"

static const double two_pi = 6.28318530717958647693;

/* One pendulum's problem with all that it needs. */
typedef struct problem {
  pendres_context *ctx;
  const pendres_pendulum *p;
  N_Vector state;
  void *arkode, *cvode;
  SUNNonlinearSolver fixed_point;
  SUNMatrix matrix;
  SUNLinearSolver linear;
  int failure, stopped;
  long evaluations;
} problem;

/* Between two questions whether to go on: some hundredths of a second. */
enum { EVALUATIONS_BETWEEN = 300000 };

static int slope(sunrealtype theta, N_Vector state, N_Vector out, void *arg)
{
  problem *b = arg;
  const double *s = N_VGetArrayPointer(state), omega = b->p->drive_frequency;
  double *d = N_VGetArrayPointer(out);
  b->ctx->cost.rhs_evaluations += 1.0;
  if (++b->evaluations % EVALUATIONS_BETWEEN == 0 && !b->stopped)
    b->stopped = pendres_context_stops(b->ctx);
  if (b->stopped) return -1;
  d[0] = s[1];
  d[1] = (b->p->drive_amplitude * cos(theta) - sin(s[0])) / (omega * omega) -
         b->p->damping / omega * s[1];
  return 0;
}

static int jacobian(sunrealtype theta, N_Vector state, N_Vector f, SUNMatrix j, void *arg,
                    N_Vector t1, N_Vector t2, N_Vector t3)
{
  const problem *b = arg;
  const double omega = b->p->drive_frequency;
  (void)theta, (void)f, (void)t1, (void)t2, (void)t3;
  SM_ELEMENT_D(j, 0, 0) = 0.0;
  SM_ELEMENT_D(j, 0, 1) = 1.0;
  SM_ELEMENT_D(j, 1, 0) = -cos(N_VGetArrayPointer(state)[0]) / (omega * omega);
  SM_ELEMENT_D(j, 1, 1) = -b->p->damping / omega;
  return 0;
}

/*
 * Relative and absolute tolerance alike, but whole turns of the angle do not loosen it, except to
 * what their digits allow.
 */
static int weights(N_Vector state, N_Vector out, void *arg)
{
  const problem *b = arg;
  const double *s = N_VGetArrayPointer(state), tolerance = b->ctx->options.tolerance;
  double *w = N_VGetArrayPointer(out);
  const double asked = tolerance * (1.0 + fmin(fabs(s[0]), 3.14159265358979323846));
  w[0] = 1.0 / fmax(asked, 2e-15 * fabs(s[0]));
  w[1] = 1.0 / (tolerance * (1.0 + fabs(s[1])));
  return 0;
}

/* See the trap described in flow.c. */
static int after_step(sunrealtype theta, N_Vector state, void *arg)
{
  (void)theta, (void)state, (void)arg;
  return 0;
}

static int open_arkode(problem *b)
{
  int stages = 0, bad = -1;
  ARKodeButcherTable table = pendres_flow_table(b->ctx->options.table, 0, &stages);
  b->arkode = ERKStepCreate(slope, 0.0, b->state, b->ctx->sun);
  if (b->arkode != NULL && table != NULL) {
    bad = pendres_compat_silence(b->ctx->sun, b->arkode, NULL) != 0 ||
          ERKStepSetTable(b->arkode, table) != 0 || ERKStepSetUserData(b->arkode, b) != 0 ||
          ERKStepSetPostprocessStepFn(b->arkode, after_step) != 0 ||
          ERKStepWFtolerances(b->arkode, weights) != 0 ||
          ERKStepSetMaxNumSteps(b->arkode, 100000000L) != 0 ||
          pendres_flow_set_controller(b->arkode) != 0;
  }
  ARKodeButcherTable_Free(table);
  return bad;
}

static int open_cvode(problem *b, int adams)
{
  SUNContext sun = b->ctx->sun;
  b->cvode = CVodeCreate(adams ? CV_ADAMS : CV_BDF, sun);
  if (b->cvode == NULL) return -1;
  if (pendres_compat_silence(sun, NULL, b->cvode) != 0 ||
      CVodeInit(b->cvode, slope, 0.0, b->state) != 0 || CVodeSetUserData(b->cvode, b) != 0 ||
      CVodeWFtolerances(b->cvode, weights) != 0 ||
      CVodeSetMaxNumSteps(b->cvode, 100000000L) != 0)
    return -1;
  if (adams) {
    b->fixed_point = SUNNonlinSol_FixedPoint(b->state, 0, sun);
    return b->fixed_point == NULL || CVodeSetNonlinearSolver(b->cvode, b->fixed_point) != 0;
  }
  b->matrix = SUNDenseMatrix(2, 2, sun);
  b->linear = b->matrix != NULL ? SUNLinSol_Dense(b->state, b->matrix, sun) : NULL;
  return b->linear == NULL || CVodeSetLinearSolver(b->cvode, b->linear, b->matrix) != 0 ||
         CVodeSetJacFn(b->cvode, jacobian) != 0;
}

static void close_problem(problem *b)
{
  if (b->arkode != NULL) ERKStepFree(&b->arkode);
  if (b->cvode != NULL) CVodeFree(&b->cvode);
  if (b->fixed_point != NULL) (void)SUNNonlinSolFree(b->fixed_point);
  if (b->linear != NULL) (void)SUNLinSolFree(b->linear);
  if (b->matrix != NULL) SUNMatDestroy(b->matrix);
  if (b->state != NULL) N_VDestroy(b->state);
  memset(b, 0, sizeof *b);
}

static pendres_status open_problem(problem *b, const pendres_strobe_lane *lane)
{
  const pendres_method method = b->ctx->options.method;
  b->p = lane->pendulum;
  b->state = N_VNew_Serial(2, b->ctx->sun);
  if (b->state == NULL)
    return pendres_context_fail(b->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a pendulum");
  N_VGetArrayPointer(b->state)[0] = lane->y;
  N_VGetArrayPointer(b->state)[1] = lane->w;
  const int bad =
    method == PENDRES_SINGLE ? open_arkode(b) : open_cvode(b, method == PENDRES_CVODE_ADAMS);
  if (bad)
    return pendres_context_fail(b->ctx, PENDRES_INTEGRATION_FAILED,
                                "method %s could not be set up", pendres_method_name(method));
  return PENDRES_OK;
}

/* On to the end of drive period number `period`, counted from 1. */
static pendres_status advance(problem *b, long period)
{
  const double end = two_pi * (double)period;
  sunrealtype reached = 0.0;
  if (b->arkode != NULL) {
    b->failure = ERKStepSetStopTime(b->arkode, end);
    if (b->failure == 0)
      b->failure = ERKStepEvolve(b->arkode, end, b->state, &reached, ARK_NORMAL);
  } else {
    b->failure = CVode(b->cvode, end, b->state, &reached, CV_NORMAL);
  }
  b->ctx->cost.pendulum_periods += 1.0;
  if (b->stopped)
    return pendres_context_fail(b->ctx, PENDRES_INTERRUPTED, "interrupted on request");
  if (b->failure < 0)
    return pendres_context_fail(b->ctx, PENDRES_INTEGRATION_FAILED,
                                "method %s gave up in drive period %ld (code %d)",
                                pendres_method_name(b->ctx->options.method), period, b->failure);
  return PENDRES_OK;
}

static void count_steps(problem *b)
{
  long steps = 0;
  const int bad = b->arkode != NULL  ? ERKStepGetNumSteps(b->arkode, &steps)
                  : b->cvode != NULL ? CVodeGetNumSteps(b->cvode, &steps)
                                     : -1;
  if (bad == 0) b->ctx->cost.steps += (double)steps;
}

static pendres_status run_one(problem *b, size_t index, pendres_strobe_lane *lane,
                              pendres_strobe_visit *visit, void *arg)
{
  const long turns = lane->turns;
  pendres_status status = open_problem(b, lane);
  for (int done = 0; status == PENDRES_OK && !done;) {
    status = pendres_context_poll(b->ctx);
    if (status == PENDRES_OK) status = advance(b, lane->period + 1);
    if (status != PENDRES_OK) break;
    lane->period++;
    lane->y = N_VGetArrayPointer(b->state)[0];
    lane->w = N_VGetArrayPointer(b->state)[1];
    lane->turns = turns;
    pendres_passage_wrap(&lane->y, &lane->turns);
    done = visit(arg, index, lane);
  }
  return status;
}

pendres_status pendres_flow_single_run(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                       pendres_strobe_visit *visit, void *arg)
{
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    problem b = {.ctx = ctx};
    status = run_one(&b, i, &lanes[i], visit, arg);
    count_steps(&b);
    close_problem(&b);
  }
  return status;
}
