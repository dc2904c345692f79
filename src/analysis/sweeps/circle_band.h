/*
 * circle_band.h -- the invariant circles of rotations over a range of a parameter.
 *
 * Owns: circles at a few values, and those at all values between them by interpolation.
 *
 * If states contract towards an invariant circle faster than neighbours on it approach each other,
 * the circle changes smoothly with a parameter, also where the motion on it locks to the drive and
 * unlocks (Hirsch, Pugh and Shub, Invariant Manifolds, 1977). The coefficients of the circle and of
 * the map on it are therefore interpolated by polynomials through values at Chebyshev's points,
 * whose last coefficients give the error. The error of the integration is found by computing the
 * circle at one of these points again, with 1.4 times as many steps.
 */
#ifndef PENDRES_CIRCLE_BAND_H
#define PENDRES_CIRCLE_BAND_H

#include <pendres/continuation.h>

#include "analysis/sweeps/circle_turn.h"

enum { PENDRES_CIRCLE_NODES = 10 };

typedef struct pendres_circle_band {
  double low, high;   /* of the parameter */
  size_t n;           /* coefficients of each trigonometric polynomial */
  double value[PENDRES_CIRCLE_NODES];      /* Chebyshev's points */
  pendres_circle at[PENDRES_CIRCLE_NODES]; /* the circles there, with n points each */
  pendres_trigonometric wrong; /* difference of the map from that of more steps */
  double error;                /* all other errors of the map */
  double reached;              /* the last value at which there was a circle */
  double missing;              /* what polynomials of higher degree would add there */
} pendres_circle_band;

/* The circles that a band holds. */
typedef struct pendres_circle_family {
  pendres_pendulum pendulum;   /* all parameters but the free one */
  pendres_parameter parameter;
  double tolerance;            /* of the map */
} pendres_circle_family;

/* Where a band begins: a value, with a guess of the circle there or the band that ends there. */
typedef struct pendres_circle_start {
  double value;
  pendres_trigonometric guess;
  const pendres_circle_band *before; /* NULL: none */
} pendres_circle_start;

/*
 * The band from its start to another value. *found is 0 if a circle is missing, or if the circles
 * do not follow a polynomial; out->reached and out->missing say by how much.
 */
pendres_status pendres_circle_band_find(pendres_context *ctx, const pendres_circle_family *family,
                                        const pendres_circle_start *start, double to,
                                        pendres_circle_band *out, int *found);

/* The circle at a value in the band or, as a guess, not far beyond its ends. */
void pendres_circle_band_at(const pendres_circle_band *b, double value, pendres_circle *out);

/* How circles at a value are to be computed. */
pendres_status pendres_circle_way_at(pendres_context *ctx, const pendres_circle_family *family,
                                     double value, pendres_circle_way *out);

#endif
