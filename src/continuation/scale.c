/* scale.c -- what counts as one in arclength; see scale.h. */
#include "continuation/scale.h"

#include <math.h>

double pendres_arc_least_scale(int i)
{
  if (i < PENDRES_U_OMEGA) return 1.0;
  return i == PENDRES_U_OMEGA ? 0.3 : 0.1;
}

double pendres_arc_scale(int i, double value)
{
  static const double logarithmic = 20.0;
  const double least = pendres_arc_least_scale(i);
  return i < PENDRES_U_OMEGA ? least : fmax(least, fabs(value) / logarithmic);
}

double pendres_arc_distance(const double a[PENDRES_U_COUNT], const double b[PENDRES_U_COUNT])
{
  double sum = 0.0;
  for (int i = 0; i < PENDRES_U_COUNT; i++)
    sum = hypot(sum, (a[i] - b[i]) / pendres_arc_scale(i, 0.5 * (a[i] + b[i])));
  return sum;
}
