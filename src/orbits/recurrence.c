/* recurrence.c -- strobe points that come back to where they were; see recurrence.h. */
#include "base/angles.h"
#include "orbits/recurrence.h"

#include <math.h>

enum { SHORT_PERIOD = 32, LONGEST_PERIOD = PENDRES_RECURRENCE_POINTS - 1 };

/* Points that come back closer than these may be near an orbit of a short or a long period ... */
static const double near_orbit = 0.3, near_long_orbit = 0.02;
/* ... if their distance is less than this share of that after any short period. */
static const double closer = 0.1;
/* A period is preferred to its multiples if points are this many times as far apart after it, or no
   further than rounding makes them. */
static const double as_close = 3.0, rounding = 1e-6;

/* The smallest distance of the last point from those first .. last periods ago. */
static double least(const double *distance, int first, int last)
{
  double closest = INFINITY;
  for (int q = first; q <= last; q++) closest = fmin(closest, distance[q]);
  return closest;
}

int pendres_recurrence_find(int points, double turn, const double *y, const double *w,
                            pendres_recurrence *out)
{
  double distance[LONGEST_PERIOD + 1];
  const int now = points - 1, longest = now < LONGEST_PERIOD ? now : LONGEST_PERIOD;
  const int few = longest < SHORT_PERIOD ? longest : SHORT_PERIOD;
  for (int q = 1; q <= longest; q++) {
    const double dy = pendres_less_turns(y[now] - y[now - q], turn);
    distance[q] = hypot(dy, w[now] - w[now - q]);
  }
  double closest = least(distance, 1, few);
  const double far = least(distance, few + 1, longest);
  int first = 1;
  if (far < near_long_orbit && far < closer * closest && closest > rounding) {
    closest = far;
    first = few + 1;
  }
  if (!(closest < near_orbit)) return 0;
  for (int q = first; q <= longest; q++) {
    if (!(distance[q] <= fmax(as_close * closest, rounding))) continue;
    *out = (pendres_recurrence){.y = y[now], .w = w[now], .period = q,
                                .winding = (int)rint((y[now] - y[now - q]) / turn)};
    return 1;
  }
  return 0;
}
