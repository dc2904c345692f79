/*
 * free_force.h -- the well that free oscillations and backbones are about.
 */
#ifndef PENDRES_ORBITS_FREE_FORCE_H
#define PENDRES_ORBITS_FREE_FORCE_H

#include <pendres/pendulum.h>

/* Find where a pendulum without drives comes to rest that is let go at y = 0, or, if that is the
   top of a barrier, right above it; 0: nowhere. */
int pendres_free_well(const pendres_pendulum *p, double *y);

/* The stiffness about a well by the force's first harmonic at an amplitude: the square of the
   frequency of free oscillations, nearly. */
double pendres_free_stiffness(const pendres_pendulum *p, double well, double amplitude);

#endif
