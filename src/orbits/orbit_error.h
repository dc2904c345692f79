/*
 * orbit_error.h -- the errors of an orbit and its measures from two computations of it.
 *
 * Owns: the error estimates. Two computations may agree in one number by chance while their orbits
 * do not agree. The error of each number therefore has two parts: a fraction of its own difference,
 * and the effect that a fraction of the difference of the whole orbits could have on it.
 */
#ifndef PENDRES_ORBIT_ERROR_H
#define PENDRES_ORBIT_ERROR_H

#include "orbits/orbit_reading.h"

/* How well an orbit is known, from two computations. */
typedef struct pendres_orbit_uncertainty {
  double apart;    /* difference of the two, in y and w, anywhere on the orbit */
  double rounding; /* rounding error of y and w */
} pendres_orbit_uncertainty;

/* Error of the finer of two values; sensitivity: its derivative by y and w. */
double pendres_orbit_error(double coarse, double fine, double sensitivity,
                           const pendres_orbit_uncertainty *uncertainty);

/*
 * The distance of two computations at a short distance from the orbit, from the difference of the
 * derivatives of their maps. The maps may agree all along the orbit by chance, but not next to it
 * as well. The short distance is a fraction of the orbit's size or, if that is less, of the
 * distance over which the derivative changes by its own size. from: the vector from the point where
 * the coarse derivative was taken to that of the fine one.
 */
double pendres_orbit_apart_beside(const pendres_orbit_computed *coarse,
                                  const pendres_orbit_computed *fine, const double from[2]);

/* Two computations of an orbit. */
typedef struct pendres_orbit_twice {
  pendres_pendulum pendulum;
  int period, winding, steps; /* steps of the finer one */
  const pendres_orbit_computed *coarse, *fine;
  pendres_orbit_uncertainty at_start, along; /* at phase 0, and anywhere */
  double rounding; /* what all steps leave of an angle of order one */
  int rests;       /* it moves by rounding alone */
} pendres_orbit_twice;

/* Set all fields of the orbit and their errors; the slopes become NaN. */
void pendres_orbit_set(const pendres_orbit_twice *two, pendres_orbit *o);

#endif
