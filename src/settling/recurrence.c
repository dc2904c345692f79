/* recurrence.c -- strobe points that come back to where they were; see recurrence.h. */
#include "base/angles.h"
#include "settling/numbers.h"
#include "settling/recurrence.h"

#include <math.h>

enum { LONGEST_PERIOD = PENDRES_RECURRENCE_POINTS - 1 };

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
  const int few = longest < RECURRENCE_SHORT ? longest : RECURRENCE_SHORT;
  for (int q = 1; q <= longest; q++) {
    const double dy = pendres_less_turns(y[now] - y[now - q], turn);
    distance[q] = hypot(dy, w[now] - w[now - q]);
  }
  double closest = least(distance, 1, few);
  const double far = least(distance, few + 1, longest);
  int first = 1;
  if (far < recurrence_near_long && far < recurrence_closer * closest &&
      closest > orbit_same_point) {
    closest = far;
    first = few + 1;
  }
  if (!(closest < recurrence_near)) return 0;
  for (int q = first; q <= longest; q++) {
    if (!(distance[q] <= fmax(recurrence_as_close * closest, orbit_same_point))) continue;
    *out = (pendres_recurrence){.y = y[now], .w = w[now], .period = q,
                                .winding = (int)rint((y[now] - y[now - q]) / turn)};
    return 1;
  }
  return 0;
}
