/*
 * method_naive.c -- a straightforward integration of a pendulum, as a baseline.
 *
 * Plain adaptive ARKODE, one problem a pendulum: position and velocity over time as the equation is
 * printed, the default explicit method and step controller, the tolerance both relative and
 * absolute, a clock and an angle that grow without bound, interpolated output. This is
 * deliberately not improved: the other methods are compared with it.
 */
#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>

#include "engine/sundials/compat.h"
#include "engine/method_one.h"
#include "engine/kernels/coordinates.h"

static int slope(sunrealtype t, N_Vector state, N_Vector out, void *arg)
{
  const pendres_one *b = arg;
  const double *s = N_VGetArrayPointer(state);
  double *d = N_VGetArrayPointer(out);
  b->ctx->cost.rhs_evaluations += 1.0;
  d[0] = s[1];
  d[1] = pendres_pendulum_acceleration(b->p, s[0], s[1], t);
  return 0;
}

/* The state becomes x and v. */
static int open(pendres_one *b)
{
  const double tolerance = b->tolerance;
  double *s = N_VGetArrayPointer(b->state);
  const pendres_coordinates at = {.y = s[0], .w = s[1]};
  pendres_coordinates_out(b->p, &at, &s[0], &s[1]);
  b->memory = ERKStepCreate(slope, 0.0, b->state, b->ctx->sun);
  return b->memory == NULL || pendres_compat_silence(b->ctx->sun, b->memory, NULL) != 0 ||
         ERKStepSetUserData(b->memory, b) != 0 ||
         ERKStepSStolerances(b->memory, tolerance, tolerance) != 0;
}

/* ARKODE returns after every 500 steps, and is called again. */
static int advance(pendres_one *b, double theta)
{
  const double end = theta / b->p->drive_frequency;
  sunrealtype reached = 0.0;
  int code = ARK_TOO_MUCH_WORK;
  while (code == ARK_TOO_MUCH_WORK && !b->stopped) {
    code = ERKStepEvolve(b->memory, end, b->state, &reached, ARK_NORMAL);
    b->stopped = pendres_context_stops(b->ctx);
  }
  return code;
}

static void read(const pendres_one *b, double *y, double *w)
{
  const double *s = N_VGetArrayPointer(b->state);
  const pendres_coordinates at = pendres_coordinates_in_whole(b->p, s[0], s[1]);
  *y = at.y;
  *w = at.w;
}

static pendres_status run(pendres_context *ctx, const pendres_strobe_job *job)
{
  static const pendres_one_solver solver = {open, advance, read, pendres_one_erk_steps,
                                            pendres_one_erk_close};
  return pendres_one_run(ctx, job, &solver);
}

const pendres_method_functions pendres_method_naive = {
  .running_clock = 1, .run = run};
