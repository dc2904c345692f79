/* undriven.c -- rotations under a torque alone; see undriven.h. */
#include "settling/exponents/undriven.h"

#include <math.h>

#include "base/angles.h"
#include "model/equation.h"
#include "model/model.h"

int pendres_undriven(const pendres_pendulum *p)
{
  return pendres_pendulum_rotates(p) && !pendres_model_driven(p) && !pendres_equation_drags(p);
}

/* How many upper equilibria lie behind a position, as the torque pushes. */
static double passed(const pendres_pendulum *p, double x)
{
  const double y = p->torque > 0.0 ? x - half_pi : half_pi - x;
  return floor((y - pi + asin(fabs(p->torque))) / two_pi);
}

int pendres_undriven_rotates(const pendres_pendulum *p, double from_x, double to_x, double v)
{
  const double torque = fabs(p->torque), along = copysign(1.0, p->torque) * v;
  const double loss = pendres_equation_friction(p, 0.0, along) * along;
  return torque > 1.0 || passed(p, to_x) > passed(p, from_x) ||
         (along > 0.0 && along * along > 2.0 * two_pi * (1.0 - torque + loss));
}
