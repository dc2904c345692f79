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

int pendres_recurrence_find(const pendres_recurrence *r, double turn, pendres_initial_guess *out)
{
  double distance[LONGEST_PERIOD + 1], advance[LONGEST_PERIOD + 1];
  const long points = r->filled < r->length ? r->filled : r->length;
  const int longest = points - 1 < LONGEST_PERIOD ? (int)points - 1 : LONGEST_PERIOD;
  const int few = longest < RECURRENCE_SHORT ? longest : RECURRENCE_SHORT;
  const long now = (r->filled - 1) % r->length;
  for (int q = 1; q <= longest; q++) {
    const long then = (r->filled - 1 - q) % r->length;
    advance[q] = r->y[now] - r->y[then];
    distance[q] = hypot(pendres_less_turns(advance[q], turn), r->w[now] - r->w[then]);
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
    *out = (pendres_initial_guess){.y = r->y[now], .w = r->w[now], .period = q,
                                   .winding = (int)rint(advance[q] / turn)};
    return 1;
  }
  return 0;
}
