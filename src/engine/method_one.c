/* method_one.c -- one ARKODE or CVODE problem a pendulum; see method_one.h. */
#include "base/numbers.h"
#include "engine/method_one.h"

#include <math.h>

#include <nvector/nvector_serial.h>

#include "base/angles.h"
#include "engine/sundials/compat.h"
#include "engine/kernels/coordinates.h"
#include "model/model.h"

int pendres_one_slope(sunrealtype theta, N_Vector state, N_Vector out, void *one)
{
  pendres_one *b = one;
  const double *s = N_VGetArrayPointer(state);
  double *d = N_VGetArrayPointer(out);
  b->ctx->cost.rhs_evaluations += 1.0;
  if (++b->evaluations % PENDRES_STEPS_BETWEEN_CHECKS == 0 && !b->stopped)
    b->stopped = pendres_context_stops(b->ctx);
  if (b->stopped) return -1;
  d[0] = s[1];
  d[1] = pendres_model_slope(b->p, s[0], s[1], cos(theta));
  return 0;
}

/*
 * Relative and absolute tolerance alike, but whole turns of the angle do not loosen it, except to
 * what their digits allow.
 */
int pendres_one_weights(N_Vector state, N_Vector out, void *one)
{
  const pendres_one *b = one;
  const double *s = N_VGetArrayPointer(state), tolerance = b->tolerance;
  double *w = N_VGetArrayPointer(out);
  const double turn = pendres_model_turn(b->p);
  const double asked = tolerance * (1.0 + fmin(fabs(s[0]), 0.5 * turn));
  w[0] = 1.0 / fmax(asked, 2e-15 * fabs(s[0]));
  w[1] = 1.0 / (tolerance * (1.0 + fabs(s[1])));
  return 0;
}

void pendres_one_read(const pendres_one *b, double *y, double *w)
{
  *y = N_VGetArrayPointer(b->state)[0];
  *w = N_VGetArrayPointer(b->state)[1];
}

int pendres_one_erk_steps(const pendres_one *b, long *steps)
{
  return ERKStepGetNumSteps(b->memory, steps);
}

void pendres_one_erk_close(pendres_one *b)
{
  if (b->memory != NULL) ERKStepFree(&b->memory);
}

static const char *name_of(const pendres_one *b)
{
  return pendres_name_get(PENDRES_NAMES_METHOD, (int)b->ctx->options.method);
}

static pendres_status open_problem(pendres_one *b, const pendres_one_solver *solver,
                                   const pendres_strobe_lane *lane)
{
  b->p = lane->pendulum;
  b->state = N_VNew_Serial(2, b->ctx->sun);
  if (b->state == NULL)
    return pendres_context_fail(b->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a pendulum");
  N_VGetArrayPointer(b->state)[0] = lane->y;
  N_VGetArrayPointer(b->state)[1] = lane->w;
  if (solver->open(b) != 0)
    return pendres_context_fail(b->ctx, PENDRES_INTEGRATION_FAILED,
                                "method %s could not be set up", name_of(b));
  return PENDRES_OK;
}

/* On to the end of drive period number `period` of this run, counted from 1. */
static pendres_status advance(pendres_one *b, const pendres_one_solver *solver, long period)
{
  pendres_status status = pendres_context_poll(b->ctx);
  if (status != PENDRES_OK) return status;
  const int code = solver->advance(b, two_pi * (double)period);
  b->ctx->cost.pendulum_periods += 1.0;
  if (b->stopped)
    return pendres_context_fail(b->ctx, PENDRES_INTERRUPTED, "interrupted on request");
  if (code < 0)
    return pendres_context_fail(b->ctx, PENDRES_INTEGRATION_FAILED,
                                "method %s gave up in drive period %ld (code %d)",
                                name_of(b), period, code);
  return PENDRES_OK;
}

static pendres_status run_one(pendres_one *b, const pendres_one_solver *solver,
                              const pendres_strobe_job *job, size_t index)
{
  pendres_strobe_lane *lane = &job->lanes[index];
  /* The clock starts now, whatever the number of periods of the lane so far. */
  const long turns = lane->turns, first = lane->period;
  pendres_status status = open_problem(b, solver, lane);
  for (int done = 0; status == PENDRES_OK && !done;) {
    status = advance(b, solver, lane->period + 1 - first);
    if (status != PENDRES_OK) break;
    lane->period++;
    lane->turns = turns;
    solver->read(b, &lane->y, &lane->w);
    pendres_coordinates_wrap(b->p, &lane->y, &lane->turns);
    done = job->visit(job->arg, index, lane);
  }
  return status;
}

pendres_status pendres_one_run(pendres_context *ctx, const pendres_strobe_job *job,
                               const pendres_one_solver *solver)
{
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < job->n && status == PENDRES_OK; i++) {
    const size_t index = pendres_strobe_which(job, i);
    pendres_strobe_lane *lane = &job->lanes[index];
    pendres_one b = {.ctx = ctx, .tolerance = job->tolerance, .longest = lane->longest};
    long steps = 0;
    status = run_one(&b, solver, job, index);
    if (b.memory != NULL && solver->steps(&b, &steps) == 0) {
      ctx->cost.steps += (double)steps;
      lane->taken += (double)steps;
    }
    solver->close(&b);
    if (b.state != NULL) N_VDestroy(b.state);
  }
  return status;
}
