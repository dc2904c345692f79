/* noise_common.c -- ids, settling, steps and parts of noisy trajectories; see noise_common.h. */
#include "noise/noise_common.h"

#include <math.h>
#include <string.h>

#include "base/mix.h"
#include "model/equation.h"
#include "model/model.h"

enum {
  IDS = 1 << 20 /* ids between those of one pendulum and attractor and others */
};

static uint64_t mix_in(uint64_t hash, double number)
{
  uint64_t bits;
  memcpy(&bits, &number, sizeof bits);
  return pendres_mix(hash ^ bits);
}

uint64_t pendres_noise_first_id(const pendres_pendulum *p, size_t attractor)
{
  const double numbers[4] = {p->damping, p->drive_amplitude, p->drive_frequency, p->temperature};
  uint64_t hash = pendres_mix(attractor);
  for (int i = 0; i < 4; i++) hash = mix_in(hash, numbers[i]);
  if (pendres_model_kind(p) != PENDRES_MODEL_PLAIN) {
    hash = mix_in(mix_in(hash, p->torque), p->parametric_amplitude);
    for (int i = 0; i < PENDRES_FORCE_POWERS; i++)
      hash = mix_in(hash, p->force_coefficients[i]);
    if (p->force >= PENDRES_FORCE_FORMULA) hash = pendres_mix(hash ^ (uint64_t)p->force);
  }
  /* The low bits number trajectories, and the top bit marks those that measure the bias. */
  return (hash >> 1) & ~(uint64_t)(IDS - 1);
}

/* The spring that a force comes down to far out, where a sine does not count; NaN: none. */
static double spring_of(const pendres_pendulum *p)
{
  double half, all, slope;
  if (pendres_model_of(p->force)->period > 0.0) return NAN;
  pendres_model_force(p, 0.5 * noise_far_out, &half, &slope);
  pendres_model_force(p, noise_far_out, &all, &slope);
  return fabs(all - 2.0 * half) <= noise_spring * fabs(all) ? all / noise_far_out : NAN;
}

/* Whether a parametric drive makes the oscillations of a spring grow. */
static int grows(const pendres_pendulum *p, double spring)
{
  const pendres_pendulum far = {.damping = p->damping, .drive_frequency = p->drive_frequency,
                                .parametric_amplitude = p->parametric_amplitude,
                                .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {spring}};
  pendres_langevin_linear theory;
  return pendres_langevin_linear_find(&far, 0.0, 0.0, 1, &theory) == PENDRES_NOT_FOUND;
}

const char *pendres_noise_refuses(const pendres_pendulum *p)
{
  static const char *const carried =
    "noise carries a pendulum of this force to infinity: its highest power must be odd, with a "
    "positive coefficient that the parametric drive does not turn over";
  if (pendres_equation_drags(p)) return pendres_equation_refuses_drag(p);
  if (pendres_pendulum_leaves(p)) return carried;
  if (p->parametric_amplitude == 0.0) return NULL;
  const double spring = spring_of(p);
  if (isnan(spring))
    return p->force == PENDRES_FORCE_POLYNOMIAL && fabs(p->parametric_amplitude) >= 1.0 ? carried
                                                                                       : NULL;
  return grows(p, spring) ? "noise carries a pendulum of this force to infinity: far out it is a "
                            "spring, whose oscillations this parametric drive makes grow"
                          : NULL;
}

long pendres_noise_settle(const pendres_orbit *orbit)
{
  const double contraction = hypot(orbit->multiplier_re[0], orbit->multiplier_im[0]);
  const double periods = orbit->period * log(noise_settled) / log(contraction);
  if (!(contraction < 1.0)) return (long)noise_unknown_settling;
  return (long)fmin(noise_longest_settling, fmax(4.0, ceil(periods)));
}

pendres_status pendres_noise_choose_steps(pendres_context *ctx,
                                          const pendres_langevin_request *request,
                                          unsigned statistics, double tolerance,
                                          pendres_langevin_bias *bias)
{
  pendres_langevin_request q = *request;
  const int given = request->steps_per_period;
  pendres_status status = PENDRES_OK;
  *bias = (pendres_langevin_bias){.steps_per_period = given != 0 ? given : PENDRES_LANGEVIN_STEPS};
  q.pendulum.temperature = fmin(q.pendulum.temperature, pendres_noise_coldest);
  if (given == 0) status = pendres_langevin_choose_steps(ctx, &q, statistics, tolerance, bias);
  if (status == PENDRES_NOT_CONVERGED) status = PENDRES_OK;
  q = *request;
  q.steps_per_period = bias->steps_per_period;
  if (status == PENDRES_OK && (given != 0 || q.pendulum.temperature > pendres_noise_coldest))
    status = pendres_langevin_measure_bias(ctx, &q, bias);
  if (status != PENDRES_NOT_FOUND) return status;
  for (int s = 0; s < PENDRES_LANGEVIN_STATISTICS; s++)
    bias->statistics[s].value = bias->statistics[s].error = bias->scale[s] = NAN;
  return PENDRES_OK;
}

size_t pendres_noise_parts(size_t trajectories, size_t most)
{
  return trajectories / most + (trajectories % most > 0);
}

size_t pendres_noise_part(size_t trajectories, size_t most, size_t part, size_t *first)
{
  const size_t parts = pendres_noise_parts(trajectories, most);
  *first = part * trajectories / parts;
  return (part + 1) * trajectories / parts - *first;
}
