/* continuation_parameter.c -- a parameter of a pendulum by its number. */
#include "continuation/continuation_parameter.h"

#include <math.h>
#include <stddef.h>

#include "continuation/continuation_walk.h"

double *pendres_parameter_of(pendres_pendulum *p, pendres_parameter parameter)
{
  switch (parameter) {
  case PENDRES_DRIVE_FREQUENCY: return &p->drive_frequency;
  case PENDRES_DAMPING: return &p->damping;
  case PENDRES_DRIVE_AMPLITUDE: return &p->drive_amplitude;
  case PENDRES_PARAMETER_COUNT: break;
  }
  return NULL;
}

double pendres_parameter_value(const pendres_pendulum *p, pendres_parameter parameter)
{
  pendres_pendulum copy = *p;
  const double *value = pendres_parameter_of(&copy, parameter);
  return value != NULL ? *value : NAN;
}

double pendres_parameter_scale(pendres_parameter parameter)
{
  return pendres_walk_scale[PENDRES_U_OMEGA + (int)parameter];
}
