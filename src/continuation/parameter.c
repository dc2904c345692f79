/* parameter.c -- parameters and bifurcations by name; see continuation.h. */
#include "continuation/parameter.h"

#include <math.h>
#include <stddef.h>

#include "continuation/scale.h"
#include "orbits/orbit_newton.h"

static const char *const names[PENDRES_PARAMETER_COUNT] = {
#define PARAMETER_NAME(code, name, field) name,
  PENDRES_PARAMETER_LIST(PARAMETER_NAME)
#undef PARAMETER_NAME
};

const char *pendres_parameter_name(pendres_parameter parameter)
{
  return (unsigned)parameter < PENDRES_PARAMETER_COUNT ? names[parameter] : NULL;
}

static double *place_of(pendres_pendulum *p, pendres_parameter parameter)
{
  switch (parameter) {
#define PARAMETER_PLACE(code, name, field) case PENDRES_##code: return &p->field;
    PENDRES_PARAMETER_LIST(PARAMETER_PLACE)
#undef PARAMETER_PLACE
  default: return NULL;
  }
}

double pendres_parameter_get(pendres_parameter parameter, const pendres_pendulum *p)
{
  if (p == NULL) return NAN;
  pendres_pendulum copy = *p;
  const double *value = place_of(&copy, parameter);
  return value != NULL ? *value : NAN;
}

void pendres_parameter_set(pendres_parameter parameter, double value, pendres_pendulum *p)
{
  double *place = p != NULL ? place_of(p, parameter) : NULL;
  if (place != NULL) *place = value;
}

pendres_pendulum pendres_parameter_with(const pendres_pendulum *p, pendres_parameter parameter,
                                        double value)
{
  pendres_pendulum with = *p;
  pendres_parameter_set(parameter, value, &with);
  return with;
}

double pendres_parameter_scale(pendres_parameter parameter)
{
  return pendres_arc_least_scale(PENDRES_U_OMEGA + (int)parameter);
}

double pendres_parameter_beyond(pendres_parameter parameter, double value, double distance)
{
  const int above = parameter == PENDRES_DAMPING || parameter == PENDRES_DRIVE_FREQUENCY;
  return above ? fmax(value + distance, 0.5 * value) : value + distance;
}

const char *pendres_continuation_refuses(const pendres_orbit *o, pendres_parameter parameter)
{
  if ((unsigned)parameter >= PENDRES_PARAMETER_COUNT) return "unknown parameter";
  const char *why = pendres_orbit_refuses(o);
  if (why != NULL) return why;
  const int coefficients = pendres_model_of(o->pendulum.force)->coefficients;
  if ((int)parameter - PENDRES_FORCE_COEFFICIENT_1 >= coefficients)
    return "this force has no such coefficient";
  if (o->winding != 0 && o->pendulum.drive_amplitude == 0.0 &&
      o->pendulum.parametric_amplitude == 0.0)
    return "without a drive a rotation has a period of its own, and is no orbit of the strobe map";
  return NULL;
}

const char *pendres_special_name(pendres_special special)
{
  static const char *const specials[PENDRES_SPECIAL_COUNT] = {
#define SPECIAL_NAME(code, name) name,
    PENDRES_SPECIAL_LIST(SPECIAL_NAME)
#undef SPECIAL_NAME
  };
  return (unsigned)special < PENDRES_SPECIAL_COUNT ? specials[special] : NULL;
}
