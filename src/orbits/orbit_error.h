/*
 * orbit_error.h -- the errors of an orbit and its measures from two computations of it.
 *
 * Owns: what is claimed. A single number of two computations may agree by chance while the orbits
 * do not: beside its own difference each number is given the share of it that the difference of
 * the whole orbits could make.
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
 * How far two computations would be apart a little beside the orbit, by what the derivatives of
 * their maps differ by. That the maps agree on the orbit, all along it, may be chance; that they
 * agree beside it as well is none. A little: a share of the orbit's size, and of the way on which
 * the derivative changes by itself: by_point, as it changes with y and w. from: the way from the
 * point at which the coarse derivative was taken to that of the fine one.
 */
double pendres_orbit_apart_beside(const double coarse[2][2], const double fine[2][2],
                                  const double by_point[2][2][2], const double from[2],
                                  double amplitude);

/* A derivative of the map over the orbit's period, by (y, w), of two computations. */
typedef struct pendres_orbit_spectrum {
  double coarse[2][2], fine[2][2];
  double by_point[2][2][2]; /* how its entries change with y and w */
  double left;              /* relative error of its entries by rounding, and by having moved
                               them */
} pendres_orbit_spectrum;

/* Two computations of an orbit. */
typedef struct pendres_orbit_twice {
  pendres_pendulum pendulum;
  int period, winding, steps; /* steps of the finer one */
  double coarse[2], fine[2];  /* y and w at phase 0 */
  double left[2];             /* what the finer one is off by besides, in y and w */
  const pendres_orbit_measures *coarse_measures, *fine_measures;
  pendres_orbit_doubt at_start, along; /* at phase 0, and anywhere */
  pendres_orbit_spectrum spectrum;
} pendres_orbit_twice;

/* All of the orbit, with errors, but the slopes, which become NaN. */
void pendres_orbit_set(const pendres_orbit_twice *two, pendres_orbit *o);

#endif
