/*
 * equation.h -- what follows from the equation of motion, whatever its friction h is:
 *
 *     x'' + h(x, x') + f(x) (1 + b cos omega t) = I + F0 cos omega t.
 *
 * Owns: the friction, h = damping x' + nonlinear_damping x^2 x' + quadratic_damping x' |x'| +
 * cubic_damping x'^3, and what is concluded from it. It stands here, in kernels' loops, and where
 * docs/architecture.md says so. What asks for a bound gets one; what asks for a time or a width
 * gets a guess, by which work is planned and nothing is told.
 */
#ifndef PENDRES_EQUATION_H
#define PENDRES_EQUATION_H

#include <math.h>

#include <pendres/pendulum.h>

/* Whether there is friction other than damping x'. */
static inline int pendres_equation_drags(const pendres_pendulum *p)
{
  return p->nonlinear_damping != 0.0 || p->quadratic_damping != 0.0 || p->cubic_damping != 0.0;
}

/* h/v and dh/dv at y = x - origin and v; the latter is the rate at which the flow contracts areas
   there, minus its divergence. */
static inline double pendres_equation_friction(const pendres_pendulum *p, double y, double v)
{
  const double speed = fabs(v);
  if (!pendres_equation_drags(p)) return p->damping;
  return p->damping + p->nonlinear_damping * y * y +
         speed * (p->quadratic_damping + speed * p->cubic_damping);
}

static inline double pendres_equation_drag(const pendres_pendulum *p, double y, double v)
{
  const double speed = fabs(v);
  if (!pendres_equation_drags(p)) return p->damping;
  return p->damping + p->nonlinear_damping * y * y +
         speed * (2.0 * p->quadratic_damping + 3.0 * speed * p->cubic_damping);
}

/* dh/dx there. */
double pendres_equation_drag_by_place(const pendres_pendulum *p, double y, double v);

/* The least that both are anywhere, and the most dh/dv is up to a distance and a speed. */
double pendres_equation_least_drag(const pendres_pendulum *p);
double pendres_equation_most_drag(const pendres_pendulum *p, double reach, double speed);

/* The rate at which the flow contracts areas, where it is the same at all states; NaN if it is
   not: pendres_orbit_contraction() (orbits/orbit_measure.h) has what it is along an orbit. */
double pendres_equation_contraction(const pendres_pendulum *p);

/* What is left of an area, or of its root, by Liouville's formula: after a contraction, that rate
   times a time or half of it. Where there is no such rate, what was computed from derivatives. */
static inline double pendres_equation_left(double contraction, double computed)
{
  return isnan(contraction) ? computed : exp(-contraction);
}

/* NULL, or why nothing settles: a static sentence. */
const char *pendres_equation_undamped(const pendres_pendulum *p);

/* NULL, or why a computation that knows damping x' alone refuses the friction. */
const char *pendres_equation_refuses_drag(const pendres_pendulum *p);

/* A speed beyond which friction is more than a push; infinite if none is, NaN if there is neither.
   */
double pendres_equation_speed(const pendres_pendulum *p, double push);

/* By what power of e motions lose their energy, and areas shrink, in a drive period, at least: as
   pendres_pendulum_decay_rate() says. */
double pendres_equation_shrinking(const pendres_pendulum *p);

/* By what power of e motions come together in a drive period: half of that. */
double pendres_equation_fading(const pendres_pendulum *p);

/* The equation backwards in time: of (y, -w). */
pendres_pendulum pendres_equation_reversed(const pendres_pendulum *p);

#endif
