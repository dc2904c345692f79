/* peak.c -- a resonance as a row of results; see peak.h. */
#include "scenes/peak.h"

#include <math.h>

#include <pendres/free.h>

/* The error of the free frequency of an amplitude. It falls ever faster to zero, where the pendulum
   stands on its head: an amplitude that may be as large may have any frequency below. */
static double free_error(double amplitude, double error)
{
  const double free = pendres_free_frequency(amplitude);
  if (amplitude + error < PENDRES_PI)
    return fabs(pendres_free_frequency(amplitude + error) - free) + 4e-16;
  return fmax(free, pendres_free_frequency(fmax(0.0, amplitude - error)) - free);
}

/* Without a resonance. */
static scene_peak no_peak(double at, pendres_status outcome)
{
  scene_peak p = {.at = at, .outcome = outcome, .kind = PENDRES_PEAK_COUNT};
  p.resonance_frequency = p.resonance_frequency_error = NAN;
  p.resonance_period = p.resonance_period_error = NAN;
  p.mean_loop_area = p.mean_loop_area_error = NAN;
  p.mean_loop_amplitude = p.mean_loop_amplitude_error = NAN;
  p.mean_amplitude = p.mean_amplitude_error = p.phase_lag = p.phase_lag_error = NAN;
  p.mean_power = p.mean_power_error = p.sa_fraction = p.sa_fraction_error = NAN;
  p.free_frequency = p.free_frequency_error = p.fold_frequency = p.fold_frequency_error = NAN;
  return p;
}

scene_peak scene_peak_of(double at, pendres_status outcome, const pendres_resonance *r)
{
  if (outcome != PENDRES_OK) return no_peak(at, outcome);
  const pendres_response *a = &r->response;
  scene_peak p = {.at = at, .outcome = outcome, .uncertain = a->uncertain, .kind = (int)r->peak};
  const double loop = a->mean_loop_amplitude, loop_error = a->mean_loop_amplitude_error;
  const double period = 2.0 * PENDRES_PI / r->frequency;
  p.resonance_frequency = r->frequency;
  p.resonance_frequency_error = r->frequency_error;
  p.resonance_period = period;
  p.resonance_period_error = period * r->frequency_error / r->frequency;
  p.mean_loop_area = r->loop_area;
  p.mean_loop_area_error = r->loop_area_error;
  p.mean_loop_amplitude = loop;
  p.mean_loop_amplitude_error = loop_error;
  p.mean_amplitude = a->mean_amplitude;
  p.mean_amplitude_error = a->mean_amplitude_error;
  p.phase_lag = a->phase_lag;
  p.phase_lag_error = a->phase_lag_error;
  p.mean_power = a->mean_power;
  p.mean_power_error = a->mean_power_error;
  p.sa_fraction = a->sa_fraction;
  p.sa_fraction_error = a->sa_fraction_error;
  p.free_frequency = pendres_free_frequency(loop);
  p.free_frequency_error = free_error(loop, loop_error);
  p.fold_frequency = r->fold_frequency;
  p.fold_frequency_error = r->fold_frequency_error;
  return p;
}

size_t scene_peak_printed(const deck *d, size_t n, const scene_peak *rows,
                          scene_printed values[SCENE_PRINTED_PERIODS])
{
  static const struct {
    double damping, period;
    const char *name;
  } printed[SCENE_PRINTED_PERIODS] = {
    {0.24, 6.66, "resonance_period_damping_0_24"},
    {0.32, 6.542, "resonance_period_damping_0_32"},
    {0.80, 6.865, "resonance_period_damping_0_80"},
    {0.90, 7.02, "resonance_period_damping_0_90"},
  };
  size_t count = 0;
  const deck_axis *damping = &d->axis[DECK_AXIS_DAMPING];
  if (!(fabs(d->pendulum.drive_amplitude - 0.2) <= 1e-12) || n != damping->count ||
      !deck_is_plain(d))
    return 0;
  for (size_t k = 0; k < SCENE_PRINTED_PERIODS; k++)
    for (size_t i = 0; i < n && count <= k; i++)
      if (rows[i].at == damping->value[i] && fabs(rows[i].at - printed[k].damping) < 1e-12 &&
          rows[i].outcome == PENDRES_OK)
        values[count++] = (scene_printed){.name = printed[k].name, .printed = printed[k].period,
                                          .computed = rows[i].resonance_period,
                                          .error = rows[i].resonance_period_error};
  return count;
}

const char *scene_peak_names(int kind)
{
  return kind == PENDRES_PEAK_COUNT ? "none" : pendres_name_get(PENDRES_NAMES_PEAK, kind);
}

const char *scene_peak_instead(const void *row)
{
  const pendres_status outcome = ((const scene_peak *)row)->outcome;
  if (outcome == PENDRES_OK) return NULL;
  return outcome == PENDRES_NOT_FOUND ? "no peak in the range" : "failed";
}
