/* scene_noise.c -- what scenes with noise share; see scene_noise.h. */
#include "scenes/scene_noise.h"

#include <math.h>
#include <string.h>

static const double two_pi = 6.28318530717958647693;

enum { STATISTICS = PENDRES_LANGEVIN_STATISTICS };

/* Relative to a cloud's width the bias is the same at all small temperatures; where it is hot, a
   coarse and a fine trajectory part soon, and their difference tells little on steps. */
static const double coldest = 1e-4;

pendres_status scene_noise_open(farm *f, int64_t seed, pendres_langevin **out)
{
  const pendres_langevin_options options = { .seed = (uint64_t)seed };
  const pendres_status status = pendres_langevin_create(&options, out);
  if (status == PENDRES_OK) pendres_langevin_set_interrupt(*out, farm_stopped, f);
  return status;
}

void scene_noise_close(farm *f, pendres_langevin *lv)
{
  pendres_cost cost;
  if (lv == NULL) return;
  pendres_langevin_cost(lv, &cost);
  farm_add_cost(f, &cost);
  pendres_langevin_free(lv);
}

/* Steele, Lea and Flood, OOPSLA 2014: the output function of SplitMix64. */
static uint64_t mix(uint64_t z)
{
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

uint64_t scene_noise_first_id(const pendres_pendulum *p, size_t attractor)
{
  const double numbers[4] = { p->damping, p->drive_amplitude, p->drive_frequency, p->temperature };
  uint64_t hash = mix(attractor);
  for (int i = 0; i < 4; i++) {
    uint64_t bits;
    memcpy(&bits, &numbers[i], sizeof bits);
    hash = mix(hash ^ bits);
  }
  /* Room for trajectories; and the top bit is where bias is measured. */
  return (hash >> 1) & ~(uint64_t)(SCENE_NOISE_IDS - 1);
}

long scene_noise_settle(const pendres_orbit *orbit)
{
  const double contraction = hypot(orbit->multiplier_re[0], orbit->multiplier_im[0]);
  const double periods = orbit->period * log(1e-5) / log(contraction);
  if (!(contraction < 1.0)) return 10000; /* not known: chaotic, or about to vanish */
  return (long)fmin(1e5, fmax(4.0, ceil(periods)));
}

pendres_status scene_noise_choose_steps(pendres_langevin *lv,
                                        const pendres_langevin_request *request,
                                        unsigned statistics, double tolerance,
                                        pendres_langevin_bias *bias)
{
  pendres_langevin_request cold = *request;
  memset(bias, 0, sizeof *bias);
  cold.pendulum.temperature = fmin(cold.pendulum.temperature, coldest);
  pendres_status status = pendres_langevin_choose_steps(lv, &cold, statistics, tolerance, bias);
  if (status == PENDRES_NOT_CONVERGED) /* near enough: the bias says how near */
    status = pendres_langevin_set_steps(lv, bias->steps_per_period);
  if (status != PENDRES_OK && status != PENDRES_NOT_FOUND) return status;
  if (status == PENDRES_OK && cold.pendulum.temperature < request->pendulum.temperature)
    status = pendres_langevin_measure_bias(lv, request, bias);
  if (status != PENDRES_NOT_FOUND) return status;
  for (int s = 0; s < STATISTICS; s++)
    bias->statistics[s].value = bias->statistics[s].error = bias->scale[s] = NAN;
  bias->steps_per_period = pendres_langevin_steps(lv);
  return PENDRES_OK;
}

size_t scene_noise_chunks(size_t trajectories)
{
  return (trajectories + SCENE_NOISE_CHUNK - 1) / SCENE_NOISE_CHUNK;
}

void scene_noise_chunk(size_t trajectories, size_t chunk, size_t *first, size_t *count)
{
  const size_t chunks = scene_noise_chunks(trajectories);
  *first = chunk * trajectories / chunks;
  *count = (chunk + 1) * trajectories / chunks - *first;
}

/* ---- clouds -------------------------------------------------------------------------------- */

/* A mean of parts and its error; those of weight 0 may be NaN. */
static pendres_langevin_estimate mean_of(size_t n, const pendres_langevin_cloud *parts,
                                         double total, int statistic)
{
  pendres_langevin_estimate out = { 0.0, 0.0 };
  double square = 0.0;
  for (size_t i = 0; i < n; i++) {
    const double w = parts[i].strobes / total;
    const pendres_langevin_estimate *e = &parts[i].statistics[statistic];
    if (!isfinite(e->value)) continue;
    out.value += w * e->value;
    square += w * e->error * w * e->error;
  }
  out.error = sqrt(square);
  return out;
}

/* What the parts' distances from the common mean add to a covariance. */
static double between(size_t n, const pendres_langevin_cloud *parts, double total, int a, int b,
                      const pendres_langevin_cloud *all)
{
  double sum = 0.0;
  for (size_t i = 0; i < n; i++) {
    const pendres_langevin_estimate *s = parts[i].statistics;
    if (!isfinite(s[a].value)) continue;
    sum += parts[i].strobes / total * (s[a].value - all->statistics[a].value) *
           (s[b].value - all->statistics[b].value);
  }
  return sum;
}

void scene_noise_merge(size_t n, const pendres_langevin_cloud *parts, pendres_langevin_cloud *out)
{
  enum { X = PENDRES_LANGEVIN_MEAN_X, V = PENDRES_LANGEVIN_MEAN_V };
  double total = 0.0, lag = 0.0;
  *out = (pendres_langevin_cloud){ .phase_lag = { NAN, NAN } };
  for (size_t i = 0; i < n; i++) {
    out->left += parts[i].left;
    out->exposure += parts[i].exposure;
    out->strobes += parts[i].strobes;
    if (isfinite(parts[i].statistics[X].value)) total += parts[i].strobes;
  }
  for (int s = 0; s < STATISTICS; s++)
    out->statistics[s] =
      total > 0.0 ? mean_of(n, parts, total, s) : (pendres_langevin_estimate){ NAN, NAN };
  if (!(total > 0.0)) return;
  out->statistics[PENDRES_LANGEVIN_COV_XX].value += between(n, parts, total, X, X, out);
  out->statistics[PENDRES_LANGEVIN_COV_XV].value += between(n, parts, total, X, V, out);
  out->statistics[PENDRES_LANGEVIN_COV_VV].value += between(n, parts, total, V, V, out);
  const double c = out->statistics[PENDRES_LANGEVIN_COSINE].value;
  const double s = out->statistics[PENDRES_LANGEVIN_SINE].value;
  for (size_t i = 0; i < n; i++) {
    const pendres_langevin_estimate *e = parts[i].statistics;
    const double w = parts[i].strobes / total *
                     hypot(e[PENDRES_LANGEVIN_COSINE].value, e[PENDRES_LANGEVIN_SINE].value);
    if (isfinite(w)) lag += w * parts[i].phase_lag.error * w * parts[i].phase_lag.error;
  }
  out->phase_lag.value = atan2(s, c) < 0.0 ? atan2(s, c) + two_pi : atan2(s, c);
  out->phase_lag.error = sqrt(lag) / hypot(c, s);
}

double scene_noise_harmonic_covariance(const pendres_langevin_cloud *cloud)
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

scene_noise_rate scene_noise_rate_of(double events, double pendulum_periods, double period)
{
  scene_noise_rate r = { NAN, NAN, NAN, NAN };
  double value, lower;
  const double time = pendulum_periods * period;
  if (pendres_langevin_rate(events, time, 0.95, &r.value, &r.lower, &r.upper) != PENDRES_OK)
    return (scene_noise_rate){ NAN, NAN, NAN, NAN };
  r.error = sqrt(events) / time;
  if (events > 0.0) return r;
  if (pendres_langevin_rate(0.0, time, 0.68268949213708585, &value, &lower, &r.error) != PENDRES_OK)
    r.error = NAN;
  return r;
}
