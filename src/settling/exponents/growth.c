/* growth.c -- how fast neighbouring motions part; see growth.h. */
#include "settling/exponents/growth.h"

#include <float.h>
#include <math.h>

#include "settling/exponents/numbers.h"

/* Vectors are put back to length one where they are longer, or shorter than its inverse. */
static const double longest = 1e100;
/* Steps twice as long differ by this times the error of the steps: methods of fourth order. */
static const double extrapolated = 15.0;

/* ---- tangent vectors ---- */

void pendres_tangents_put(pendres_block *block, size_t lane, double u[2][2])
{
  for (int i = 0; i < 2; i++) pendres_block_put_tangent(block, lane, i, u[i]);
}

static void shorten(double u[2][2], double log_length[2])
{
  for (int i = 0; i < 2; i++) {
    const double length = fmax(hypot(u[i][0], u[i][1]), DBL_MIN);
    log_length[i] = log(length);
    u[i][0] /= length;
    u[i][1] /= length;
  }
}

void pendres_tangents_take(pendres_block *block, size_t lane, int last, double u[2][2],
                           double log_length[2])
{
  double size[2];
  for (int i = 0; i < 2; i++) {
    pendres_block_get_tangent(block, lane, i, u[i]);
    size[i] = fabs(u[i][0]) + fabs(u[i][1]);
    log_length[i] = 0.0;
  }
  if (!last && fmax(size[0], size[1]) < longest && fmin(size[0], size[1]) > 1.0 / longest) return;
  shorten(u, log_length);
  pendres_tangents_put(block, lane, u);
}

double pendres_growth_correction(const double growth[2])
{
  return (growth[1] - growth[0]) / extrapolated;
}

/* ---- batches ---- */

double pendres_batches_mean(const double sum[BATCHES], long batch, double *error)
{
  double mean = 0.0, square = 0.0;
  for (int b = 0; b < BATCHES; b++) mean += sum[b] / (double)(batch * BATCHES);
  for (int b = 0; b < BATCHES; b++) {
    const double d = sum[b] / (double)batch - mean;
    square += d * d;
  }
  *error = sqrt(square / (BATCHES * (BATCHES - 1.0)));
  return mean;
}

int pendres_batches_change(const double sum[BATCHES])
{
  double all = 0.0, first = 0.0, square = 0.0, between = 0.0;
  for (int b = 0; b < BATCHES; b++) all += sum[b];
  const double mean = all / BATCHES;
  for (int b = 0; b < BATCHES; b++) square += (sum[b] - mean) * (sum[b] - mean);
  for (int k = 1; k < BATCHES - 1; k++) {
    first += sum[k - 1] - mean;
    if (k > 1) between = fmax(between, first * first * BATCHES / (k * (BATCHES - k)));
  }
  return between * (BATCHES - 2) > growth_by_chance * growth_by_chance * (square - between);
}

/* ---- the verdict ---- */

pendres_growth_verdict pendres_growth_tell(double growth, double latter, double off)
{
  const double half = 0.5 * off;
  if (growth - off > growth_passing && latter > half) return PENDRES_GROWTH_CHAOS;
  const int order = growth + off < -growth_passing && latter < -half;
  return order ? PENDRES_GROWTH_ORDER : PENDRES_GROWTH_DOUBT;
}
