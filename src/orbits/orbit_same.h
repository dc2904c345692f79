/*
 * orbit_same.h -- whether two orbits are one.
 *
 * Owns: how far apart the values may be that two computations find of one orbit, by the errors of
 * both: they follow from the tolerance. All that compares orbits asks here.
 */
#ifndef PENDRES_ORBIT_SAME_H
#define PENDRES_ORBIT_SAME_H

#include <pendres/orbit.h>

/* How far apart two values of one orbit may be; errors: those of both together. However large these
   are, what is further apart than one state moves to adjacent parameters is two. */
double pendres_orbit_slack(double errors);

/* The distance from an orbit's Poincaré point to another point, modulo whole turns. */
double pendres_orbit_apart(const pendres_orbit *o, double x, double v);

/* Whether a point that is known within `error` is the orbit's Poincaré point. */
int pendres_orbit_is_at(const pendres_orbit *o, double x, double v, double error);

/* Whether two orbits of one pendulum are one orbit from one of its points on. */
int pendres_orbit_same(const pendres_orbit *a, const pendres_orbit *b);

/* Whether two orbits are as wide: one orbit, and a pair of mirror images, always are. */
int pendres_orbit_as_wide(const pendres_orbit *a, const pendres_orbit *b);

/* Whether two orbits of a pendulum with the mirror symmetry are each other's images. */
int pendres_orbit_are_images(const pendres_orbit *a, const pendres_orbit *b);

#endif
