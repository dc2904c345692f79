/* langevin_bias.c -- the bias of finite steps, and the choice of steps; see langevin.h. */
#include "noise/langevin_cloud.h"

#include <math.h>
#include <string.h>

#include "base/angles.h"
#include "noise/langevin_internal.h"
#include "noise/noise_common.h"

enum { STATISTICS = PENDRES_LANGEVIN_STATISTICS, GROWTH = 64, TRIALS = 12, ORDER = 4 };

static void scales_of(const pendres_sums *total, double scale[STATISTICS])
{
  double d[STATISTICS];
  pendres_sums_statistics(total, d);
  const double xx = d[PENDRES_LANGEVIN_COV_XX], vv = d[PENDRES_LANGEVIN_COV_VV];
  scale[PENDRES_LANGEVIN_MEAN_X] = sqrt(xx);
  scale[PENDRES_LANGEVIN_MEAN_V] = sqrt(vv);
  scale[PENDRES_LANGEVIN_COV_XX] = xx;
  scale[PENDRES_LANGEVIN_COV_XV] = sqrt(xx * vv);
  scale[PENDRES_LANGEVIN_COV_VV] = vv;
  /* A harmonic that vanishes, as under a torque alone, is compared with the width of the cloud. */
  scale[PENDRES_LANGEVIN_COSINE] = scale[PENDRES_LANGEVIN_SINE] =
    fmax(hypot(d[PENDRES_LANGEVIN_COSINE], d[PENDRES_LANGEVIN_SINE]), sqrt(xx));
  scale[PENDRES_LANGEVIN_LOOP_AREA] = fabs(d[PENDRES_LANGEVIN_LOOP_AREA]);
}

/* The bias of `steps` steps per period, from pairs of trajectories of the request. */
static pendres_status measure_bias(pendres_context *ctx, const pendres_langevin_request *request,
                                   int steps, size_t trajectories, pendres_langevin_bias *bias)
{
  /* With another top bit of their ids these are not the trajectories of the cloud itself. */
  pendres_sums_run r = {.ctx = ctx, .request = request, .trajectories = trajectories,
                         .first_id = request->first_id ^ (uint64_t)1 << 63};
  pendres_langevin_block fine = {0}, coarse = {0};
  pendres_langevin_estimate fine_minus_coarse[STATISTICS];
  const double richardson = 1.0 / (1.0 - pow(2.0, -ORDER));
  pendres_status status = pendres_sums_run_make(&r, 1);
  if (status == PENDRES_OK) status = pendres_langevin_open(ctx, trajectories, 2 * steps, &fine);
  if (status == PENDRES_OK) status = pendres_langevin_open(ctx, trajectories, steps, &coarse);
  if (status == PENDRES_OK) status = pendres_sums_follow(&r, &fine, &coarse);
  if (status == PENDRES_OK) status = pendres_sums_estimate(&r, fine_minus_coarse);
  if (status == PENDRES_OK) {
    const pendres_sums total = pendres_sums_total(r.all, trajectories);
    bias->steps_per_period = steps;
    for (int s = 0; s < STATISTICS; s++)
      bias->statistics[s] = (pendres_langevin_estimate){
        -richardson * fine_minus_coarse[s].value, richardson * fine_minus_coarse[s].error};
    scales_of(&total, bias->scale);
  }
  pendres_langevin_block_clear(&fine);
  pendres_langevin_block_clear(&coarse);
  pendres_sums_run_clear(&r);
  return status;
}

static pendres_status bias_of(pendres_context *ctx, const pendres_langevin_request *request,
                              pendres_langevin_bias *bias)
{
  if (request == NULL || bias == NULL) return PENDRES_CONTEXT_NULL(ctx, "request and bias");
  const int steps = pendres_langevin_resolve_steps(ctx, request->steps_per_period);
  const pendres_status status = pendres_sums_accept(ctx, request, steps);
  if (status != PENDRES_OK) return status;
  return measure_bias(ctx, request, steps, request->trajectories, bias);
}

pendres_status pendres_langevin_measure_bias(pendres_context *ctx,
                                             const pendres_langevin_request *request,
                                             pendres_langevin_bias *bias)
{
  pendres_noise_window window;
  pendres_langevin_request inside;
  pendres_door d = pendres_door_open(ctx, request != NULL ? &request->pendulum : NULL);
  request = pendres_noise_request(&d, request, &window, &inside);
  PENDRES_DOOR_OUT(&d, bias, 1, bias);
  return PENDRES_DOOR_END(&d, bias_of(ctx, request, bias));
}

/* Raise *most to a number in units of its scale. NaN is kept: an unknown bias may be large. */
static void raise_to(double number, double scale, double *most)
{
  /* A number that is exactly zero, such as the work of no drive, needs no scale. */
  const double size = number == 0.0 ? 0.0 : fabs(number) / scale;
  if (!(size <= *most) && !isnan(*most)) *most = size;
}

/* The largest bias and its largest error among the statistics, in units of their scales. */
static void worst_of(const pendres_langevin_bias *bias, unsigned statistics, double *value,
                     double *error)
{
  *value = *error = 0.0;
  for (int s = 0; s < STATISTICS; s++) {
    if ((statistics >> s & 1u) == 0) continue;
    raise_to(bias->statistics[s].value, bias->scale[s], value);
    raise_to(bias->statistics[s].error, bias->scale[s], error);
  }
}

/* The search begins with the fewest steps that may resolve the well and the friction. */
static int first_steps(const pendres_pendulum *p)
{
  const double period = two_pi / p->drive_frequency;
  return (int)ceil(fmin(5e5, fmax(4.0, period * fmax(1.0, p->damping))));
}

static pendres_status choose_steps(pendres_context *ctx, const pendres_langevin_request *request,
                                   unsigned statistics, double tolerance,
                                   pendres_langevin_bias *bias)
{
  if (request == NULL || bias == NULL) return PENDRES_CONTEXT_NULL(ctx, "request and bias");
  size_t trajectories = request->trajectories;
  double value, error;
  if (!(tolerance > 0.0) || statistics == 0 || statistics >> STATISTICS != 0 ||
      !(request->pendulum.temperature > 0.0) || !(request->pendulum.damping > 0.0))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "choosing steps needs a positive tolerance, temperature and "
                                "damping, and a statistic");
  int steps = first_steps(&request->pendulum);
  for (int trial = 0; trial < TRIALS; trial++) {
    pendres_status status = pendres_sums_accept(ctx, request, steps);
    if (status == PENDRES_OK) status = measure_bias(ctx, request, steps, trajectories, bias);
    if (status != PENDRES_OK) return status;
    worst_of(bias, statistics, &value, &error);
    if (value + 2.0 * error <= tolerance) return PENDRES_OK;
    /* More steps or more trajectories do not help where the bias is NaN. */
    if (isnan(value + error)) break;
    /* The bias goes down with more steps, and its error with these and with more trajectories. */
    if (error > 0.25 * tolerance && trajectories < GROWTH * request->trajectories)
      trajectories *= 4;
    const double ratio = value / (0.7 * tolerance);
    const double factor = fmin(4.0, fmax(1.1, pow(ratio, 1.0 / ORDER)));
    if (value > 0.5 * tolerance) steps = (int)fmin(5e5, ceil(steps * factor));
  }
  return pendres_context_fail(ctx, PENDRES_NOT_CONVERGED,
                              "with %d steps a period the bias is %.2g of its scale, known to "
                              "%.2g; wanted %.2g", bias->steps_per_period, value, error,
                              tolerance);
}

pendres_status pendres_langevin_choose_steps(pendres_context *ctx,
                                             const pendres_langevin_request *request,
                                             unsigned statistics, double tolerance,
                                             pendres_langevin_bias *bias)
{
  pendres_noise_window window;
  pendres_langevin_request inside;
  pendres_door d = pendres_door_open(ctx, request != NULL ? &request->pendulum : NULL);
  request = pendres_noise_request(&d, request, &window, &inside);
  PENDRES_DOOR_OUT(&d, bias, 1, bias);
  return PENDRES_DOOR_END(&d, choose_steps(ctx, request, statistics, tolerance, bias));
}
