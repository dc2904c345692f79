/* equation.c -- what follows from a pendulum's friction; see equation.h. */
#include "model/equation.h"

#include <stddef.h>

#include "base/angles.h"

double pendres_equation_drag_by_place(const pendres_pendulum *p, double y, double v)
{
  return 2.0 * p->nonlinear_damping * y * v;
}

/* Coefficients are not negative, unless all are. */
double pendres_equation_least_drag(const pendres_pendulum *p)
{
  return p->damping;
}

double pendres_equation_most_drag(const pendres_pendulum *p, double reach, double speed)
{
  return pendres_equation_drag(p, pendres_equation_drags(p) ? reach : 0.0, speed);
}

double pendres_equation_contraction(const pendres_pendulum *p)
{
  return pendres_equation_drags(p) ? NAN : p->damping;
}

const char *pendres_equation_undamped(const pendres_pendulum *p)
{
  if (pendres_pendulum_decay_rate(p) > 0.0) return NULL;
  return pendres_equation_drags(p) ? "near rest there is no friction without damping, so that "
                                     "nothing settles"
                                   : "without damping nothing settles";
}

const char *pendres_equation_refuses_drag(const pendres_pendulum *p)
{
  return pendres_equation_drags(p)
           ? "this is for friction proportional to the velocity alone: not with nonlinear, "
             "quadratic or cubic damping"
           : NULL;
}

double pendres_equation_speed(const pendres_pendulum *p, double push)
{
  const double linear = fabs(push) / fabs(p->damping);
  if (p->quadratic_damping == 0.0 && p->cubic_damping == 0.0) return linear;
  return fmin(fmin(linear, sqrt(fabs(push) / fabs(p->quadratic_damping))),
              cbrt(fabs(push) / fabs(p->cubic_damping)));
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
  back.nonlinear_damping = -p->nonlinear_damping;
  back.quadratic_damping = -p->quadratic_damping;
  back.cubic_damping = -p->cubic_damping;
  return back;
}
