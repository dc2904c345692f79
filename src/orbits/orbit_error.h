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
 * Everything of o but the point, the multipliers and the slopes, with errors; o->pendulum, period
 * and winding are read. Returns the whole turns by which the orbit's mean lies outside of well 0.
 */
long pendres_orbit_set_measures(const pendres_orbit_measures *coarse,
                                const pendres_orbit_measures *fine,
                                const pendres_orbit_doubt *doubt, pendres_orbit *o);

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

/* Monodromy matrix, multipliers and their error; o->pendulum and period are read. */
void pendres_orbit_set_spectrum(const pendres_orbit_spectrum *s, const pendres_orbit_doubt *doubt,
                                pendres_orbit *o);

#endif
