/*
 * continuation_alike.h -- when an orbit lies on what is known already.
 */
#ifndef PENDRES_CONTINUATION_ALIKE_H
#define PENDRES_CONTINUATION_ALIKE_H

#include <pendres/orbit.h>

/*
 * Measures of orbits that lie on one branch differ from those interpolated along a chord by less
 * than this; those of different branches at one parameter by more, unless they meet right there.
 */
static const double alike = 5e-3;

static inline double mixed(double a, double b, double part)
{
  return a + part * (b - a);
}

/* Whether orbits have one winding, or windings of each other's mirror images. */
static inline int same_winding(const pendres_orbit *a, const pendres_orbit *b)
{
  return a->winding == b->winding || (a->winding == -b->winding &&
                                      pendres_pendulum_symmetric(&a->pendulum) &&
                                      pendres_pendulum_symmetric(&b->pendulum));
}

#endif
