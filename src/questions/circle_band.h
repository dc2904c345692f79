/*
 * circle_band.h -- the invariant circles of rotations over a range of a parameter.
 *
 * Owns: circles at a few values, and those at all values between them by interpolation.
 *
 * An invariant circle to which states are drawn in faster than neighbours on it draw together
 * changes smoothly with a parameter, also where the motion on it locks to the drive and unlocks
 * (Hirsch, Pugh and Shub, Invariant Manifolds, 1977). So the coefficients of the circle and of the
 * map on it are interpolated by polynomials through values at Chebyshev's points, whose last
 * coefficients tell the error. The error of the integration is told by the circle at one of the
 * points with 1.4 times as many steps.
 */
#ifndef PENDRES_CIRCLE_BAND_H
#define PENDRES_CIRCLE_BAND_H

#include <pendres/continuation.h>

#include "questions/circle_turn.h"

enum { PENDRES_CIRCLE_NODES = 10 };

typedef struct pendres_circle_band {
  double low, high;   /* of the parameter */
  size_t n;           /* coefficients of each polynomial */
  double value[PENDRES_CIRCLE_NODES];
  pendres_circle at[PENDRES_CIRCLE_NODES]; /* at the values, with n points each */
  pendres_trigonometric wrong; /* what the map is off by more steps' */
  double error;                /* of the map besides */
  double reached;              /* the last value at which there was a circle */
  double missing;              /* of that, what polynomials of higher degrees would add */
} pendres_circle_band;

/* What a band is made of. */
typedef struct pendres_circle_family {
  pendres_pendulum pendulum;   /* but for the parameter */
  pendres_parameter parameter;
  double tolerance;            /* of the map */
} pendres_circle_family;

/* Where a band begins: a value, and a guess of the circle there, or the band that ends there. */
typedef struct pendres_circle_start {
  double value;
  pendres_trigonometric guess;
  const pendres_circle_band *before; /* NULL: none */
} pendres_circle_start;

/*
 * The band from its start to another value. Found is 0 where some circle is not, or where they do
 * not follow a polynomial: out->reached and out->missing tell how far that is.
 */
pendres_status pendres_circle_band_find(pendres_context *ctx, const pendres_circle_family *family,
                                        const pendres_circle_start *start, double to,
                                        pendres_circle_band *out, int *found);

/* The circle at a value of it, or not far beyond its ends, where it is a guess. */
void pendres_circle_band_at(const pendres_circle_band *b, double value, pendres_circle *out);

/* How the circle at a value is computed. */
pendres_status pendres_circle_way_at(pendres_context *ctx, const pendres_circle_family *family,
                                     double value, pendres_circle_way *out);

#endif
