/* parameter.c -- parameters and bifurcations by name; see continuation.h. */
#include "continuation/parameter.h"

#include <math.h>
#include <stddef.h>

#include "continuation/curve/map.h"
#include "model/model.h"
#include "orbits/orbit_newton.h"

double pendres_parameter_scale(pendres_parameter parameter)
{
  return pendres_arc_least_scale(PENDRES_U_OMEGA + (int)parameter);
}

double pendres_parameter_scale_at(pendres_parameter parameter, double value)
{
  pendres_u u = {0.0};
  u[PENDRES_U_OMEGA + (int)parameter] = value;
  return pendres_arc_scale(NULL, PENDRES_U_OMEGA + (int)parameter, u);
}

double pendres_parameter_beyond(pendres_parameter parameter, double value, double distance)
{
  const int above = pendres_parameter_of(parameter)->positive;
  return above ? fmax(value + distance, 0.5 * value) : value + distance;
}

const char *pendres_follow_refuses(const pendres_orbit *o, pendres_parameter parameter)
{
  const char *why = pendres_orbit_refuses(o);
  if (why == NULL) why = pendres_parameter_refuses(parameter, o->pendulum.force);
  if (why != NULL) return why;
  if (o->winding != 0 && !pendres_model_driven(&o->pendulum))
    return "without a drive a rotation has a period of its own, and is no orbit of the strobe map";
  return NULL;
}

