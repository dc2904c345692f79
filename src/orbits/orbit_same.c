/* orbit_same.c -- whether two orbits are one; see orbit_same.h. */
#include "orbits/orbit_same.h"

#include <math.h>

#include "base/angles.h"
#include "model/model.h"
#include "orbits/numbers.h"

double pendres_orbit_slack(double errors)
{
  return orbit_same_point + fmin(orbit_another, pendres_several_errors * errors);
}

double pendres_orbit_apart(const pendres_orbit *o, double x, double v)
{
  return hypot(pendres_less_turns(x - o->x, pendres_model_turn(&o->pendulum)), v - o->v);
}

int pendres_orbit_is_at(const pendres_orbit *o, double x, double v, double error)
{
  return pendres_orbit_apart(o, x, v) < pendres_orbit_slack(o->x_error + o->v_error + error);
}

int pendres_orbit_same(const pendres_orbit *a, const pendres_orbit *b)
{
  return a->period == b->period && a->winding == b->winding &&
         pendres_orbit_is_at(a, b->x, b->v, b->x_error + b->v_error);
}

int pendres_orbit_as_wide(const pendres_orbit *a, const pendres_orbit *b)
{
  return fabs(a->amplitude - b->amplitude) <
         pendres_orbit_slack(a->amplitude_error + b->amplitude_error);
}

enum { HARMONICS = 5 /* that are compared */ };

/* y(t) -> 2 c - y(t + half a drive period) changes the sign of even harmonics, and moves the mean
   to the other side of the centre; of an angle there are centres everywhere. */
int pendres_orbit_are_images(const pendres_orbit *a, const pendres_orbit *b)
{
  if (a->period != b->period || a->winding != -b->winding) return 0;
  const double bound =
    pendres_orbit_slack(a->x_error + a->v_error + a->amplitude_error + b->x_error + b->v_error +
                        b->amplitude_error);
  if (!pendres_orbit_as_wide(a, b)) return 0;
  const double middle = 0.5 * (a->mean_angle + b->mean_angle);
  if (pendres_model_of(a->pendulum.force)->period == 0.0 &&
      !(fabs(middle - pendres_model_centre(&a->pendulum, middle)) <= bound))
    return 0;
  for (int m = 1; m <= HARMONICS; m++) {
    const double sign = m % 2 == 0 ? -1.0 : 1.0;
    if (!(hypot(a->cosine[m - 1] - sign * b->cosine[m - 1],
                a->sine[m - 1] - sign * b->sine[m - 1]) <= bound))
      return 0;
  }
  return 1;
}
