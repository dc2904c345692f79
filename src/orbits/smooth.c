/* smooth.c -- means with smooth weights; see smooth.h. */
#include "orbits/smooth.h"

#include <math.h>

void pendres_smooth_add(pendres_smooth *s, long k, long n, double growth, double turned)
{
  const double t = ((double)k + 0.5) / (double)n;
  const double at[PENDRES_SMOOTH_SPANS] = {t, 2.0 * t, 2.0 * t - 1.0, 2.0 * t - 0.5};
  for (int i = 0; i < PENDRES_SMOOTH_SPANS; i++) {
    const double product = at[i] * (1.0 - at[i]);
    if (!(product > 0.0)) continue;
    const double weight = exp(-1.0 / product);
    s->weight[i] += weight;
    s->growth[i] += weight * growth;
    s->turned[i] += weight * turned;
  }
  s->length += growth;
  s->lengths += exp(s->length);
  s->reciprocals += exp(-s->length);
  s->count++;
}

/* The mean over all periods; *apart receives the largest difference of the means. */
static double mean_of(const pendres_smooth *s, const double sum[PENDRES_SMOOTH_SPANS],
                      double *apart)
{
  const double all = sum[0] / s->weight[0];
  double low = all, high = all;
  for (int i = 1; i < PENDRES_SMOOTH_SPANS; i++) {
    low = fmin(low, sum[i] / s->weight[i]);
    high = fmax(high, sum[i] / s->weight[i]);
  }
  *apart = high - low;
  return all;
}

pendres_smooth_means pendres_smooth_take(const pendres_smooth *s)
{
  const double n = (double)s->count;
  pendres_smooth_means m = {.uneven = s->lengths / n * (s->reciprocals / n)};
  m.growth = mean_of(s, s->growth, &m.growth_apart);
  m.turned = mean_of(s, s->turned, &m.turned_apart);
  return m;
}
