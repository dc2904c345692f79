/*
 * equation.h -- what follows from the equation of motion, whatever its friction h is:
 *
 *     x'' + h(x') + f(x) (1 + b cos omega t) = I + F0 cos omega t.
 *
 * Owns: the friction, and what is concluded from it. That h = damping x' stands here, in kernels'
 * loops, and where docs/architecture.md says so. What asks for a bound gets one; what asks for a
 * time or a width gets a guess, by which work is planned and nothing is told.
 */
#ifndef PENDRES_EQUATION_H
#define PENDRES_EQUATION_H

#include <math.h>

#include <pendres/pendulum.h>

/* h(v)/v, and dh/dv, the rate at which the flow contracts areas there: minus its divergence. Both
   are least at rest, and grow with |v| if at all. */
static inline double pendres_equation_friction(const pendres_pendulum *p, double v)
{
  (void)v;
  return p->damping;
}

static inline double pendres_equation_drag(const pendres_pendulum *p, double v)
{
  (void)v;
  return p->damping;
}

/* The rate at which the flow contracts areas, where it is the same at all states; NaN if it is
   not. */
double pendres_equation_contraction(const pendres_pendulum *p);

/* What is left of an area, or of its root, by Liouville's formula: after a contraction, that rate
   times a time or half of it. Where there is no such rate, what was computed from derivatives. */
static inline double pendres_equation_left(double contraction, double computed)
{
  return isnan(contraction) ? computed : exp(-contraction);
}

/* NULL, or why nothing settles: a static sentence. */
const char *pendres_equation_undamped(const pendres_pendulum *p);

/* The speed at which friction balances a push; infinite if none does, NaN if there is neither. */
double pendres_equation_speed(const pendres_pendulum *p, double push);

/* By what power of e motions lose their energy, and areas shrink, in a drive period, as
   pendres_pendulum_decay_rate() says. */
double pendres_equation_shrinking(const pendres_pendulum *p);

/* By what power of e motions come together in a drive period: half of that. */
double pendres_equation_fading(const pendres_pendulum *p);

/* The equation backwards in time: of (y, -w). */
pendres_pendulum pendres_equation_reversed(const pendres_pendulum *p);

#endif
