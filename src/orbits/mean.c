/* mean.c -- means over time with smooth weights; see mean.h. */
#include "orbits/mean.h"

#include <math.h>

#include "orbits/numbers.h"

/* Where the parts begin and end. */
static const double part[PENDRES_MEAN_PARTS][2] = {
  {0.0, 1.0}, {0.0, 0.9375}, {0.0625, 1.0}, {0.0, 0.875}, {0.125, 1.0}, {0.0, 0.5}, {0.5, 1.0}};
enum { LONGER = PENDRES_MEAN_PARTS - 2 };

pendres_mean_weights pendres_mean_weights_at(long k, long n)
{
  const double t = ((double)k + 0.5) / (double)n;
  pendres_mean_weights w;
  for (int i = 0; i < PENDRES_MEAN_PARTS; i++) {
    const double at = (t - part[i][0]) / (part[i][1] - part[i][0]), product = at * (1.0 - at);
    w.in[i] = product > 0.0 ? exp(-1.0 / product) : 0.0;
  }
  return w;
}

void pendres_mean_add(pendres_mean *m, const pendres_mean_weights *w, double value)
{
  for (int i = 0; i < PENDRES_MEAN_PARTS; i++) {
    m->weight[i] += w->in[i];
    m->sum[i] += w->in[i] * value;
  }
}

double pendres_mean_take(const pendres_mean *m, double *error)
{
  const double all = m->sum[0] / m->weight[0];
  double low = all, high = all;
  for (int i = 1; i < LONGER; i++) {
    low = fmin(low, m->sum[i] / m->weight[i]);
    high = fmax(high, m->sum[i] / m->weight[i]);
  }
  *error = surely * (high - low);
  return all;
}

double pendres_mean_halves(const pendres_mean *m)
{
  return fabs(m->sum[LONGER + 1] / m->weight[LONGER + 1] - m->sum[LONGER] / m->weight[LONGER]);
}
