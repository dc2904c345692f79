/*
 * flow_naive.c -- plain adaptive ARKODE, one problem a pendulum; see flow_naive.h.
 *
 * Position and velocity over time as the equation is printed, the default explicit method and
 * step controller, the tolerance both relative and absolute, a clock and an angle that grow
 * without bound, interpolated output. Nothing here is meant to be improved: the other methods are
 * measured against it.
 */
#include "engine/flow_naive.h"

#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>

#include "engine/compat.h"
#include "engine/context_internal.h"
#include "engine/passage.h"

static const double two_pi = 6.28318530717958647693;
static const double half_pi = 1.57079632679489661923;

typedef struct problem {
  pendres_context *ctx;
  const pendres_pendulum *p;
} problem;

static int slope(sunrealtype t, N_Vector state, N_Vector out, void *arg)
{
  const problem *b = arg;
  const double *s = N_VGetArrayPointer(state);
  double *d = N_VGetArrayPointer(out);
  b->ctx->cost.rhs_evaluations += 1.0;
  d[0] = s[1];
  d[1] = pendres_pendulum_acceleration(b->p, s[0], s[1], t);
  return 0;
}

static int open_arkode(problem *b, N_Vector state, void **arkode)
{
  const double tolerance = b->ctx->options.tolerance;
  *arkode = ERKStepCreate(slope, 0.0, state, b->ctx->sun);
  if (*arkode == NULL) return -1;
  return pendres_compat_silence(b->ctx->sun, *arkode, NULL) != 0 ||
         ERKStepSetUserData(*arkode, b) != 0 ||
         ERKStepSStolerances(*arkode, tolerance, tolerance) != 0;
}

/* ARKODE comes back after every 500 steps: as anyone would, ask for more. */
static int evolve(pendres_context *ctx, void *arkode, double end, N_Vector state)
{
  sunrealtype reached = 0.0;
  int code = ARK_TOO_MUCH_WORK;
  while (code == ARK_TOO_MUCH_WORK && pendres_context_poll(ctx) == PENDRES_OK)
    code = ERKStepEvolve(arkode, end, state, &reached, ARK_NORMAL);
  return code;
}

static pendres_status run_one(pendres_context *ctx, size_t index, pendres_strobe_lane *lane,
                              pendres_strobe_visit *visit, void *arg)
{
  const double omega = lane->pendulum->drive_frequency;
  const long first = lane->period, turns = lane->turns;
  problem b = {.ctx = ctx, .p = lane->pendulum};
  void *arkode = NULL;
  pendres_status status = PENDRES_OK;
  N_Vector state = N_VNew_Serial(2, ctx->sun);

  if (state == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a pendulum");
    goto done;
  }
  double *s = N_VGetArrayPointer(state);
  s[0] = lane->y + half_pi;
  s[1] = lane->w * omega;
  if (open_arkode(&b, state, &arkode) != 0) {
    status = pendres_context_fail(ctx, PENDRES_INTEGRATION_FAILED, "ARKODE could not be set up");
    goto done;
  }
  for (int finished = 0; !finished;) {
    const double end = two_pi * (double)(lane->period + 1 - first) / omega;
    const int code = evolve(ctx, arkode, end, state);
    status = pendres_context_poll(ctx);
    if (status != PENDRES_OK) goto done;
    ctx->cost.pendulum_periods += 1.0;
    if (code < 0) {
      status = pendres_context_fail(ctx, PENDRES_INTEGRATION_FAILED,
                                    "method %s gave up in drive period %ld (code %d)",
                                    pendres_method_name(PENDRES_NAIVE), lane->period + 1, code);
      goto done;
    }
    lane->period++;
    lane->turns = turns;
    lane->y = s[0] - half_pi;
    lane->w = s[1] / omega;
    pendres_passage_wrap(&lane->y, &lane->turns);
    finished = visit(arg, index, lane);
  }
done:
  if (arkode != NULL) {
    long steps = 0;
    if (ERKStepGetNumSteps(arkode, &steps) == 0) ctx->cost.steps += (double)steps;
    ERKStepFree(&arkode);
  }
  if (state != NULL) N_VDestroy(state);
  return status;
}

pendres_status pendres_flow_naive_run(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                      pendres_strobe_visit *visit, void *arg)
{
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    status = run_one(ctx, i, &lanes[i], visit, arg);
  return status;
}
