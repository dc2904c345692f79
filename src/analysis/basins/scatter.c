/* scatter.c -- scatter of sums over rows, and the exponent of shares; see scatter.h. */
#include "analysis/basins/scatter.h"

#include <math.h>
#include <string.h>

#include "analysis/basins/numbers.h"
#include "base/student.h"

enum {
  QUANTITIES = PENDRES_SCATTER_QUANTITIES
};

void pendres_scatter_add(pendres_scatter *s, const double *group)
{
  double bend[QUANTITIES];
  for (int k = 0; k < QUANTITIES; k++) {
    s->total[k] += group[k];
    bend[k] = s->last[1][k] - 2.0 * s->last[0][k] + group[k];
  }
  if (s->groups >= 2)
    for (int k = 0; k < QUANTITIES; k++)
      for (int l = 0; l < QUANTITIES; l++) s->square[k][l] += bend[k] * bend[l];
  memcpy(s->last[1], s->last[0], sizeof s->last[1]);
  memcpy(s->last[0], group, sizeof s->last[0]);
  s->groups++;
}

double pendres_scatter_variance(const pendres_scatter *s, const double *weight)
{
  if (s->groups < SCATTER_LEAST_GROUPS) return NAN;
  const double n = (double)s->groups, differences = n - 2.0;
  double sum = 0.0;
  for (int k = 0; k < QUANTITIES; k++)
    for (int l = 0; l < QUANTITIES; l++) sum += weight[k] * weight[l] * s->square[k][l];
  /* A second difference of independent numbers has six times their variance. The differences
     overlap, so that 35 of them are worth 18 independent ones. */
  const double student = pendres_student(PENDRES_ONE_SIGMA, differences * 18.0 / 35.0);
  return fmax(sum, 0.0) / 6.0 * n / differences * student * student;
}

/* ---- the exponent ---- */

/* The scales that can be used, from the smallest distance on. */
typedef struct usable {
  int n, scale[PENDRES_SCATTER_MOST_SCALES];
  /* Logarithms of distance and share. */
  double a[PENDRES_SCATTER_MOST_SCALES], b[PENDRES_SCATTER_MOST_SCALES];
} usable;

static usable list_usable(const pendres_scatter *s, int scales, const double *distance,
                          const double *tried)
{
  usable u = {0};
  for (int k = 0; k < scales && u.n < PENDRES_SCATTER_MOST_SCALES; k++) {
    const double count = s->total[k];
    if (count < SCATTER_LEAST_COUNT || count > scatter_most_uncertain * tried[k]) continue;
    u.scale[u.n] = k;
    u.a[u.n] = log(distance[k]);
    u.b[u.n++] = log(count / tried[k]);
  }
  return u;
}

/* Variance of a combination of logarithms of the first m shares. */
static double variance_of_logs(const pendres_scatter *s, const usable *u, int m, const double *c)
{
  double weight[QUANTITIES] = {0.0};
  double uncertain = 0.0;
  for (int i = 0; i < m; i++) {
    const int k = u->scale[i];
    weight[k] = c[i] / s->total[k];
    uncertain += weight[k] * weight[k] * s->uncertain[k];
  }
  return pendres_scatter_variance(s, weight) + uncertain;
}

/* What counts that are not known may change such a combination by. */
static double unknown_of_logs(const pendres_scatter *s, const usable *u, int m, const double *c)
{
  double sum = 0.0;
  for (int i = 0; i < m; i++) sum += fabs(c[i]) * s->unknown[u->scale[i]] / s->total[u->scale[i]];
  return sum;
}

/* The slope over the first m scales by least squares, and its factors c of the logarithms of
   shares. */
static double slope(const usable *u, int m, double *c)
{
  double mean = 0.0, squares = 0.0, value = 0.0;
  for (int i = 0; i < m; i++) mean += u->a[i] / m;
  for (int i = 0; i < m; i++) squares += (u->a[i] - mean) * (u->a[i] - mean);
  for (int i = 0; i < m; i++) {
    c[i] = (u->a[i] - mean) / squares;
    value += c[i] * u->b[i];
  }
  return value;
}

/*
 * How far one more slope between neighbouring distances may be from the mean of the slopes over the
 * first m scales, beyond their own scatter.
 */
static double bend(const pendres_scatter *s, const usable *u, int m)
{
  const int slopes = m - 1;
  double mean = 0.0, squares = 0.0, expected = 0.0;
  for (int j = 0; j < slopes; j++)
    mean += (u->b[j + 1] - u->b[j]) / (u->a[j + 1] - u->a[j]) / slopes;
  for (int j = 0; j < slopes; j++) {
    double c[PENDRES_SCATTER_MOST_SCALES] = {0.0};
    const double apart = u->a[j + 1] - u->a[j];
    const double off = (u->b[j + 1] - u->b[j]) / apart - mean;
    squares += off * off / (slopes - 1);
    for (int i = 0; i < slopes; i++) {
      const double share = ((i == j) - 1.0 / slopes) / (u->a[i + 1] - u->a[i]);
      c[i] -= share;
      c[i + 1] += share;
    }
    expected += variance_of_logs(s, u, m, c) / (slopes - 1);
  }
  const double beyond = fmax(squares - expected, 0.0);
  return sqrt(beyond * (1.0 + 1.0 / slopes)) * pendres_student(PENDRES_ONE_SIGMA, slopes - 1.0);
}

void pendres_scatter_exponent(const pendres_scatter *s, int scales, const double *distance,
                              const double *tried, double *exponent, double *error)
{
  const usable u = list_usable(s, scales, distance, tried);
  double c[PENDRES_SCATTER_MOST_SCALES];
  *exponent = *error = NAN;
  if (u.n < PENDRES_SCATTER_LEAST_SCALES) return;
  const double whole = slope(&u, u.n, c);
  for (int m = u.n; m >= PENDRES_SCATTER_LEAST_SCALES; m--) {
    const double value = slope(&u, m, c), scatter = variance_of_logs(s, &u, m, c);
    /* Few slopes may agree by chance: the slope over all distances is compared, too. */
    const double one = sqrt(scatter + pow(bend(s, &u, m), 2.0) + pow(value - whole, 2.0)) +
                       unknown_of_logs(s, &u, m, c);
    if (m < u.n && !(one < *error)) continue;
    *exponent = value;
    *error = one;
  }
}
