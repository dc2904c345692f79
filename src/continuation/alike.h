/*
 * alike.h -- when an orbit lies on what is known already.
 */
#ifndef PENDRES_CONTINUATION_ALIKE_H
#define PENDRES_CONTINUATION_ALIKE_H

#include <pendres/orbit.h>

/*
 * An orbit that lies on a branch has measures that differ by less than this from those interpolated
 * along the branch's chord. Orbits of different branches at one parameter differ by more, unless
 * the branches meet right there.
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
