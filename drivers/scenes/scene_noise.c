/* scene_noise.c -- what scenes with noise share; see scene_noise.h. */
#include "scenes/scene_noise.h"

#include <math.h>
#include <string.h>

enum { STATISTICS = PENDRES_LANGEVIN_STATISTICS };

/* Relative to a cloud's width the bias is the same at all small temperatures; where it is hot, a
   coarse and a fine trajectory part soon, and their difference tells little on steps. */
static const double coldest = 1e-4;

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

pendres_status scene_noise_choose_steps(pendres_context *ctx,
                                        const pendres_langevin_request *request,
                                        unsigned statistics, double tolerance,
                                        pendres_langevin_bias *bias)
{
  pendres_langevin_request cold = *request;
  *bias = (pendres_langevin_bias){ .steps_per_period = PENDRES_LANGEVIN_STEPS };
  cold.pendulum.temperature = fmin(cold.pendulum.temperature, coldest);
  pendres_status status = pendres_langevin_choose_steps(ctx, &cold, statistics, tolerance, bias);
  if (status == PENDRES_NOT_CONVERGED) status = PENDRES_OK; /* the bias says how near it is */
  cold = *request;
  cold.steps_per_period = bias->steps_per_period;
  if (status == PENDRES_OK && request->pendulum.temperature > coldest)
    status = pendres_langevin_measure_bias(ctx, &cold, bias);
  if (status != PENDRES_NOT_FOUND) return status;
  for (int s = 0; s < STATISTICS; s++)
    bias->statistics[s].value = bias->statistics[s].error = bias->scale[s] = NAN;
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
