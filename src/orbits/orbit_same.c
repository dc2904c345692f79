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
