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

void scene_peak_set(scene_peak *p, double at, pendres_status outcome, const pendres_resonance *r)
{
  p->at = at;
  p->outcome = outcome;
  p->kind = PENDRES_PEAK_COUNT;
  if (outcome != PENDRES_OK) return;
  const pendres_response *a = &r->response;
  const double period = 2.0 * PENDRES_PI / r->frequency;
#define PAIR(field, from) .field = from, .field##_error = from##_error
  *p = (scene_peak){
    .at = at, .outcome = outcome, .uncertain = a->uncertain, .kind = (int)r->peak,
    PAIR(resonance_frequency, r->frequency), PAIR(mean_loop_area, r->loop_area),
    PAIR(mean_loop_amplitude, a->mean_loop_amplitude), PAIR(mean_amplitude, a->mean_amplitude),
    PAIR(phase_lag, a->phase_lag), PAIR(mean_power, a->mean_power),
    PAIR(sa_fraction, a->sa_fraction), PAIR(fold_frequency, r->fold_frequency),
    .resonance_period = period,
    .resonance_period_error = period * r->frequency_error / r->frequency,
    .free_frequency = pendres_free_frequency(a->mean_loop_amplitude),
    .free_frequency_error = free_error(a->mean_loop_amplitude, a->mean_loop_amplitude_error)};
#undef PAIR
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
