/*
 * orbit_error.h -- the errors of an orbit and its measures from two computations of it.
 *
 * Owns: the errors that are claimed. Two computations may agree in one number by chance while their
 * orbits do not agree. The error of each number therefore has two parts: a share of its own
 * difference, and what a share of the difference of the whole orbits could make of it.
 */
#ifndef PENDRES_ORBIT_ERROR_H
#define PENDRES_ORBIT_ERROR_H

#include "orbits/orbit_measure.h"

/* How well the finer of two computations knows an orbit. */
typedef struct pendres_orbit_doubt {
  double apart;    /* what the two differ by, in y and w, anywhere on the orbit */
  double rounding; /* of y and w */
} pendres_orbit_doubt;

/* Error of the finer of two values; sensitivity: how much it feels y and w. */
double pendres_orbit_error(double coarse, double fine, double sensitivity,
                           const pendres_orbit_doubt *doubt);

/*
 * How far apart two computations would be a little beside the orbit, from the difference of the
 * derivatives of their maps. The maps may agree all along the orbit by chance, but not beside it as
 * well. "A little beside" is a share of the orbit's size or, where that is less, of the distance
 * over which the derivative changes by its own size; by_point tells how it changes with y and w.
 * from: the vector from the point where the coarse derivative was taken to that of the fine one.
 */
double pendres_orbit_apart_beside(const double coarse[2][2], const double fine[2][2],
                                  const double by_point[2][2][2], const double from[2],
                                  double amplitude);

/* A derivative of the map over the orbit's period, by (y, w), of two computations. */
typedef struct pendres_orbit_spectrum {
  double coarse[2][2], fine[2][2];
  double by_point[2][2][2]; /* how its entries change with y and w */
  double left;              /* relative error of its entries by rounding, and by the correction to
                               the orbit's point */
} pendres_orbit_spectrum;

/* Two computations of an orbit. */
typedef struct pendres_orbit_twice {
  pendres_pendulum pendulum;
  int period, winding, steps; /* steps of the finer one */
  double coarse[2], fine[2];  /* y and w at phase 0 */
  double left[2];             /* further errors of the finer one, in y and w */
  const pendres_orbit_measures *coarse_measures, *fine_measures;
  pendres_orbit_doubt at_start, along; /* at phase 0, and anywhere */
  pendres_orbit_spectrum spectrum;
} pendres_orbit_twice;

/* Set all of the orbit, with its errors, but for the slopes, which become NaN. */
void pendres_orbit_set(const pendres_orbit_twice *two, pendres_orbit *o);

#endif
