/* langevin_merge.c -- one cloud from clouds of its trajectories; see langevin.h. */
#include <pendres/langevin.h>

#include <math.h>

#include "base/angles.h"
#include "noise/noise_common.h"

enum { STATISTICS = PENDRES_LANGEVIN_STATISTICS };

/* A mean of parts and its error; those of weight 0 may be NaN. */
static pendres_langevin_estimate mean_of(size_t n, const pendres_langevin_cloud *parts,
                                         double total, int statistic)
{
  pendres_langevin_estimate out = {0.0, 0.0};
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

/* The phase lag of the whole, whose first harmonic is known, with its error from those of parts. */
static pendres_langevin_estimate phase_lag(size_t n, const pendres_langevin_cloud *parts,
                                           double total, const pendres_langevin_cloud *out)
{
  const double c = out->statistics[PENDRES_LANGEVIN_COSINE].value;
  const double s = out->statistics[PENDRES_LANGEVIN_SINE].value;
  const double lag = atan2(s, c);
  double square = 0.0;
  for (size_t i = 0; i < n; i++) {
    const pendres_langevin_estimate *e = parts[i].statistics;
    const double w = parts[i].strobes / total *
                     hypot(e[PENDRES_LANGEVIN_COSINE].value, e[PENDRES_LANGEVIN_SINE].value);
    if (isfinite(w)) square += w * parts[i].phase_lag.error * w * parts[i].phase_lag.error;
  }
  return (pendres_langevin_estimate){lag < 0.0 ? lag + two_pi : lag, sqrt(square) / hypot(c, s)};
}

pendres_status pendres_langevin_merge(size_t n, const pendres_langevin_cloud *parts,
                                      pendres_langevin_cloud *out)
{
  enum { X = PENDRES_LANGEVIN_MEAN_X, V = PENDRES_LANGEVIN_MEAN_V };
  double total = 0.0;
  if (out == NULL || (n > 0 && parts == NULL)) return PENDRES_INVALID_ARGUMENT;
  *out = (pendres_langevin_cloud){.phase_lag = {NAN, NAN}};
  for (size_t i = 0; i < n; i++) {
    out->left += parts[i].left;
    out->exposure += parts[i].exposure;
    out->strobes += parts[i].strobes;
    if (isfinite(parts[i].statistics[X].value)) total += parts[i].strobes;
  }
  for (int s = 0; s < STATISTICS; s++)
    out->statistics[s] =
      total > 0.0 ? mean_of(n, parts, total, s) : (pendres_langevin_estimate){NAN, NAN};
  if (!(total > 0.0)) return PENDRES_OK;
  out->statistics[PENDRES_LANGEVIN_COV_XX].value += between(n, parts, total, X, X, out);
  out->statistics[PENDRES_LANGEVIN_COV_XV].value += between(n, parts, total, X, V, out);
  out->statistics[PENDRES_LANGEVIN_COV_VV].value += between(n, parts, total, V, V, out);
  out->phase_lag = phase_lag(n, parts, total, out);
  return PENDRES_OK;
}
