/* recurrence.c -- strobe points that come back to where they were; see recurrence.h. */
#include "recurrence.h"

#include <math.h>

static const double two_pi = 6.28318530717958647693;

enum { LONGEST_PERIOD = (PENDRES_RECURRENCE_POINTS - 1) / 2 };

/* Points that come back closer than this may be near an orbit. */
static const double near_orbit = 0.3;
/* Rounding alone must not prefer a multiple of the period. */
static const double as_close = 3.0, rounding = 1e-6;

int pendres_recurrence_find(int points, const double *y, const double *w, pendres_recurrence *out)
{
  double distance[LONGEST_PERIOD + 1], closest = near_orbit;
  const int last = points - 1;
  for (int q = 1; q <= LONGEST_PERIOD && q <= last; q++) {
    const double dy = y[last] - y[last - q];
    distance[q] = hypot(dy - two_pi * rint(dy / two_pi), w[last] - w[last - q]);
    closest = fmin(closest, distance[q]);
  }
  if (!(closest < near_orbit)) return 0;
  for (int q = 1; q <= LONGEST_PERIOD && q <= last; q++) {
    if (!(distance[q] <= fmax(as_close * closest, rounding))) continue;
    *out = (pendres_recurrence){.y = y[last], .w = w[last], .period = q,
                                .winding = (int)rint((y[last] - y[last - q]) / two_pi)};
    return 1;
  }
  return 0;
}
