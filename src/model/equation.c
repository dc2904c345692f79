/* equation.c -- what follows from a pendulum's friction; see equation.h. */
#include "model/equation.h"

#include <stddef.h>

#include "base/angles.h"

double pendres_equation_contraction(const pendres_pendulum *p)
{
  return p->damping;
}

const char *pendres_equation_undamped(const pendres_pendulum *p)
{
  return pendres_pendulum_decay_rate(p) > 0.0 ? NULL : "without damping nothing settles";
}

double pendres_equation_speed(const pendres_pendulum *p, double push)
{
  return fabs(push) / fabs(p->damping);
}

double pendres_pendulum_decay_rate(const pendres_pendulum *p)
{
  return p != NULL ? p->damping : NAN;
}

double pendres_equation_shrinking(const pendres_pendulum *p)
{
  return pendres_pendulum_decay_rate(p) * two_pi / p->drive_frequency;
}

double pendres_equation_fading(const pendres_pendulum *p)
{
  return 0.5 * pendres_equation_shrinking(p);
}

pendres_pendulum pendres_equation_reversed(const pendres_pendulum *p)
{
  pendres_pendulum back = *p;
  back.damping = -p->damping;
  return back;
}
