/* strobe_record.c -- a trajectory at equally spaced drive phases; see strobe.h. */
#include <pendres/strobe.h>

#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "context_internal.h"
#include "steps.h"
#include "strobe_run.h"

static const double half_pi = 1.57079632679489661923;
static const double two_pi = 6.28318530717958647693;

enum { MOST_SAMPLES = 1000000 };

/* Where the points of a period go. */
typedef struct recorder {
  double *x, *v; /* the period's first point */
  int stretch;   /* steps between two points */
  double omega, turned;
} recorder;

static void keep(void *arg, int step, double theta, size_t stride, const double *state)
{
  const recorder *r = arg;
  (void)theta;
  if (step % r->stretch != 0) return;
  r->x[step / r->stretch] = state[0] + half_pi + r->turned;
  r->v[step / r->stretch] = r->omega * state[stride];
}

/* The whole trajectory with `stretch` steps from one point to the next. */
static pendres_status run(pendres_context *ctx, const pendres_pendulum *p, double x0, double v0,
                          long periods, int samples, int stretch, double *x, double *v)
{
  pendres_flow *flow = NULL;
  double y = x0 - half_pi;
  long turns = 0;
  pendres_status status = pendres_context_flow(ctx, PENDRES_FLOW_STATE, &flow);
  if (status != PENDRES_OK) return status;
  status = pendres_flow_set_steps(flow, samples * stretch);
  pendres_strobe_wrap(&y, &turns);
  pendres_flow_resize(flow, 1);
  pendres_flow_set_lane(flow, 0, p, y, v0 / p->drive_frequency);
  x[0] = x0;
  v[0] = v0;
  for (long k = 0; k < periods && status == PENDRES_OK; k++) {
    recorder r = { .x = x + (size_t)k * (size_t)samples, .v = v + (size_t)k * (size_t)samples,
                   .stretch = stretch, .omega = p->drive_frequency,
                   .turned = two_pi * (double)turns };
    status = pendres_context_poll(ctx);
    if (status != PENDRES_OK) return status;
    status = pendres_flow_period_sampled(flow, keep, &r);
    ctx->cost.pendulum_periods += 1.0;
    pendres_strobe_wrap(&pendres_flow_state(flow)[0], &turns);
  }
  return status == PENDRES_OK ? status : pendres_context_flow_failed(ctx, flow, status);
}

static pendres_status check(pendres_context *ctx, const pendres_pendulum *p, double x0, double v0,
                            long periods, int samples)
{
  const char *why = NULL;
  if (pendres_pendulum_check(p, &why) == PENDRES_OK) {
    if (!(isfinite(x0) && isfinite(v0))) why = "position and velocity must be finite";
    else if (periods < 0) why = "the number of periods must not be negative";
    else if (samples < 1 || samples > MOST_SAMPLES) why = "1 to 1000000 samples a period, please";
    else if (periods >= LONG_MAX / (long)sizeof(double) / samples)
      why = "there are too many samples in all";
  }
  if (why == NULL) return PENDRES_OK;
  return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
}

pendres_status pendres_strobe_record(pendres_context *ctx, const pendres_pendulum *pendulum,
                                     double x0, double v0, long periods, int samples, double *x,
                                     double *v, double *x_error, double *v_error)
{
  int steps = 0;
  double *finer = NULL;
  if (ctx == NULL || pendulum == NULL || x == NULL || v == NULL ||
      (x_error == NULL) != (v_error == NULL))
    return PENDRES_INVALID_ARGUMENT;
  pendres_status status = check(ctx, pendulum, x0, v0, periods, samples);
  if (status == PENDRES_OK)
    /* Errors of all periods may add up. */
    status = pendres_steps_choose(ctx, pendulum, fabs(v0),
                                  ctx->options.tolerance / fmax(1.0, (double)periods), &steps);
  if (status != PENDRES_OK) return status;

  const int stretch = (steps + samples - 1) / samples;
  status = run(ctx, pendulum, x0, v0, periods, samples, stretch, x, v);
  if (status != PENDRES_OK || x_error == NULL) return status;

  const size_t n = (size_t)periods * (size_t)samples + 1;
  finer = malloc(2 * n * sizeof *finer);
  if (finer == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu samples", n);
  const int more = (14 * stretch + 9) / 10;
  status = run(ctx, pendulum, x0, v0, periods, samples, more, finer, finer + n);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) {
    /* The rounding of each step's sum, at random, beside the difference of the two runs. */
    const double walk = 8.8e-16 * sqrt((double)k * (double)stretch);
    x_error[k] = fabs(x[k] - finer[k]) + walk + 2.2e-16 * fabs(x[k]);
    v_error[k] = fabs(v[k] - finer[n + k]) + walk + 2.2e-16 * fabs(v[k]);
  }
  free(finer);
  return status;
}
