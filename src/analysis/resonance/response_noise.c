/* response_noise.c -- the response of an ensemble under thermal noise; see response.h. */
#include <pendres/response.h>

#include <math.h>

#include "analysis/resonance/numbers.h"
#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/door.h"
#include "noise/noise_common.h"

static const pendres_response_mean none = {NAN, NAN, NAN, NAN};

/* The first harmonic, cosine and sine, with covariance of errors, and biases. */
typedef struct harmonic {
  double c, s, cc, cs, ss;
  double bias_c, bias_s, bias_cc, bias_ss;
} harmonic;

/* Count the members in a mean, which are on closed orbits, and those among them that stay in a well
   and so have a loop. */
static void count_members(const pendres_response *r, double *all, double *loops)
{
  *all = *loops = 0.0;
  for (size_t i = 0; i < r->states; i++) {
    const pendres_orbit *o = &r->state[i].orbit;
    if (o->period == 0) continue;
    *all += (double)r->state_members[i];
    if (o->winding == 0) *loops += (double)r->state_members[i];
  }
}

/* Choose steps and make the cloud of the trajectories of q, which start on one state. */
static pendres_status measure_state(pendres_context *ctx, const pendres_langevin_request *q,
                                    pendres_langevin_cloud *cloud, pendres_langevin_bias *bias)
{
  pendres_langevin_request r = *q;
  r.trajectories = PENDRES_NOISE_LANES; /* to choose steps by */
  r.record = PENDRES_NOISE_RECORD;
  const pendres_status status =
    pendres_noise_choose_steps(ctx, &r, PENDRES_LANGEVIN_RESPONSE, response_bias, bias);
  if (status != PENDRES_OK) return status;
  r = *q;
  r.steps_per_period = bias->steps_per_period;
  return pendres_langevin_cloud_find(ctx, &r, cloud, NULL, NULL);
}

static void add_area(pendres_response_mean *q, double share, const pendres_langevin_cloud *cloud,
                     const pendres_langevin_bias *bias)
{
  const pendres_langevin_estimate a = cloud->statistics[PENDRES_LANGEVIN_LOOP_AREA];
  const pendres_langevin_estimate b = bias->statistics[PENDRES_LANGEVIN_LOOP_AREA];
  q->value += share * a.value;
  q->error = hypot(q->error, share * a.error);
  q->bias += share * b.value;
  q->bias_error = hypot(q->bias_error, share * b.error);
}

/* Covariance of the errors of a cloud's cosine and sine, from that of its phase lag. */
static double harmonic_covariance(const pendres_langevin_cloud *cloud)
{
  const pendres_langevin_estimate c = cloud->statistics[PENDRES_LANGEVIN_COSINE];
  const pendres_langevin_estimate s = cloud->statistics[PENDRES_LANGEVIN_SINE];
  const double amplitude = hypot(c.value, s.value), u = -s.value / amplitude,
               w = c.value / amplitude, across = cloud->phase_lag.error * amplitude;
  /* across^2 = u^2 cc + 2 u w cs + w^2 ss. */
  const double cs = (across * across - u * u * c.error * c.error - w * w * s.error * s.error) /
                    (2.0 * u * w);
  const double most = c.error * s.error;
  if (!isfinite(cs) || fabs(u * w) < 1e-3) return 0.0;
  return fmin(most, fmax(-most, cs));
}

static void add_harmonic(harmonic *h, double share, const pendres_langevin_cloud *cloud,
                         const pendres_langevin_bias *bias)
{
  const pendres_langevin_estimate c = cloud->statistics[PENDRES_LANGEVIN_COSINE];
  const pendres_langevin_estimate s = cloud->statistics[PENDRES_LANGEVIN_SINE];
  const pendres_langevin_estimate bc = bias->statistics[PENDRES_LANGEVIN_COSINE];
  const pendres_langevin_estimate bs = bias->statistics[PENDRES_LANGEVIN_SINE];
  h->c += share * c.value;
  h->s += share * s.value;
  h->cc += share * share * c.error * c.error;
  h->ss += share * share * s.error * s.error;
  h->cs += share * share * harmonic_covariance(cloud);
  h->bias_c += share * bc.value;
  h->bias_s += share * bs.value;
  h->bias_cc += share * share * bc.error * bc.error;
  h->bias_ss += share * share * bs.error * bs.error;
}

/* Length and direction of the harmonic, errors along and across. */
static void polar(const harmonic *h, pendres_response_noise *out)
{
  const double length = hypot(h->c, h->s), u = h->c / length, w = h->s / length;
  const double along = u * u * h->cc + 2.0 * u * w * h->cs + w * w * h->ss;
  const double across = w * w * h->cc - 2.0 * u * w * h->cs + u * u * h->ss;
  const double lag = atan2(h->s, h->c);
  out->amplitude =
    (pendres_response_mean){length, sqrt(fmax(0.0, along)), u * h->bias_c + w * h->bias_s,
                            sqrt(u * u * h->bias_cc + w * w * h->bias_ss)};
  out->phase_lag = (pendres_response_mean){
    lag < 0.0 ? lag + two_pi : lag, sqrt(fmax(0.0, across)) / length,
    (u * h->bias_s - w * h->bias_c) / length,
    sqrt(w * w * h->bias_cc + u * u * h->bias_ss) / length};
}

/* At temperature 0, take what was found without noise, to the last digit. */
static void take_still(const pendres_response *r, double loops, pendres_response_noise *out)
{
  double c = 0.0, s = 0.0;
  for (size_t i = 0; i < r->states; i++) {
    const pendres_orbit *o = &r->state[i].orbit;
    if (o->period == 0 || o->winding != 0) continue;
    c += (double)r->state_members[i] / loops * o->cosine[0];
    s += (double)r->state_members[i] / loops * o->sine[0];
  }
  out->loop_area = (pendres_response_mean){r->mean_loop_area, r->mean_loop_area_error, 0.0, 0.0};
  out->mean_power = (pendres_response_mean){r->mean_power, r->mean_power_error, 0.0, 0.0};
  out->phase_lag = (pendres_response_mean){r->phase_lag, r->phase_lag_error, 0.0, 0.0};
  out->amplitude = (pendres_response_mean){loops > 0.0 ? hypot(c, s) : NAN,
                                           r->mean_loop_amplitude_error, 0.0, 0.0};
}

/* Add up all states; in the harmonics, only those that stay in a well. */
static pendres_status add_states(pendres_context *ctx, const pendres_response *r,
                                 const pendres_langevin_request *q, harmonic *h,
                                 pendres_response_noise *out)
{
  double all, loops;
  count_members(r, &all, &loops);
  for (size_t i = 0; i < r->states; i++) {
    const pendres_orbit *o = &r->state[i].orbit;
    const double members = (double)r->state_members[i];
    pendres_langevin_cloud cloud;
    pendres_langevin_bias bias;
    if (o->period == 0) continue;
    const double n = ceil(members / all * (double)q->trajectories);
    pendres_langevin_request own = *q;
    own.x = o->x;
    own.v = o->v;
    own.settle = pendres_noise_settle(o);
    own.first_id = pendres_noise_first_id(&q->pendulum, i);
    own.trajectories = n > 2.0 ? (size_t)n : 2;
    const pendres_status status = measure_state(ctx, &own, &cloud, &bias);
    if (status != PENDRES_OK) return status;
    add_area(&out->loop_area, members / all, &cloud, &bias);
    if (o->winding == 0) add_harmonic(h, members / loops, &cloud, &bias);
    if (bias.steps_per_period > out->steps_per_period)
      out->steps_per_period = bias.steps_per_period;
  }
  return PENDRES_OK;
}

static pendres_status add_noise(pendres_context *ctx, const pendres_response *still,
                                double temperature, size_t trajectories, long periods,
                                pendres_response_noise *out)
{
  if (still == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "still and out");
  if (still->states > PENDRES_RESPONSE_STATES || trajectories < 1 || periods < 1 ||
      !(temperature >= 0.0 && isfinite(temperature)))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "a response with noise needs a temperature from 0 on, a "
                                "trajectory and a period");
  const char *wrong = pendres_noise_refuses(&still->pendulum);
  *out = (pendres_response_noise){.temperature = temperature, .loop_area = none, .amplitude = none,
                                  .phase_lag = none, .mean_power = none};
  if (wrong != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", wrong);
  pendres_langevin_request q = {.pendulum = still->pendulum, .trajectories = trajectories,
                                .record = periods};
  harmonic h = {0};
  double all, loops;
  count_members(still, &all, &loops);
  *out = (pendres_response_noise){.temperature = temperature};
  if (!(temperature > 0.0)) {
    take_still(still, loops, out);
    return PENDRES_OK;
  }
  q.pendulum.temperature = temperature;
  const pendres_status status = add_states(ctx, still, &q, &h, out);
  if (status != PENDRES_OK || all == 0.0) out->loop_area = none;
  const pendres_response_mean a = out->loop_area;
  const double f = still->pendulum.drive_frequency / two_pi;
  out->mean_power =
    (pendres_response_mean){f * a.value, f * a.error, f * a.bias, f * a.bias_error};
  if (status == PENDRES_OK && loops > 0.0) polar(&h, out);
  else out->phase_lag = out->amplitude = none;
  if (status != PENDRES_OK) out->steps_per_period = 0;
  return status;
}

pendres_status pendres_response_noise_find(pendres_context *ctx, const pendres_response *still,
                                           double temperature, size_t trajectories, long periods,
                                           pendres_response_noise *out)
{
  pendres_door d = pendres_door_open(ctx, still != NULL ? &still->pendulum : NULL);
  PENDRES_DOOR_IN(&d, response, 1, still);
  const double warm = temperature / pendres_units_factor(&d.scales, 2, -2);
  PENDRES_DOOR_OUT(&d, response_noise, 1, out);
  return PENDRES_DOOR_END(&d, add_noise(ctx, still, warm, trajectories, periods, out));
}
