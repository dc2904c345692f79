/*
 * circles.h -- the invariant circles that a sweep has met, in adjacent bands of the parameter.
 *
 * Owns: finding the band that holds a value, making bands from an adjacent one or from a pendulum's
 * motion, and how a pendulum on the circle moves at a value. There is at most one circle at each
 * value (lyapunov.h), so that a sweep uses the same bands on its way up and down.
 */
#ifndef PENDRES_CIRCLES_H
#define PENDRES_CIRCLES_H

#include "analysis/sweeps/circle_band.h"

/* How a pendulum on the circle moves at one value; `found` is 0 where there is no band. */
typedef struct pendres_circles_verdict {
  int found;
  double value;
  pendres_circle_turn turn;
  double x, v; /* a state on the circle, on the stable orbit if the motion is locked */
} pendres_circles_verdict;

typedef struct pendres_circles {
  pendres_context *ctx;
  pendres_circle_family family;
  size_t count, room;
  pendres_circle_band *band;   /* in the order in which they were found */
  unsigned char *closed;       /* of each band, bits 1 and 2: none was found below it, above it */
  pendres_circle_table *table;
  double width;                /* of the next band */
  double low, high;            /* range of the parameter, which no band leaves */
  size_t told, places;         /* verdicts so far, and places of the hash table that holds them */
  pendres_circles_verdict *verdict; /* [places], by the hash of the value; found 0: a free place */
  double failed;               /* last value whose motion gave no circle; NaN: none yet */
} pendres_circles;

/* No circles yet, of a pendulum with one free parameter in a range. */
pendres_status pendres_circles_create(pendres_context *ctx, const pendres_circle_family *family,
                                      double low, double high, pendres_circles **out);
void pendres_circles_free(pendres_circles *c);

/* Make a band that begins at a value, at which a pendulum in state (x, v) is on the circle. */
pendres_status pendres_circles_begin(pendres_circles *c, double value, double x, double v);

/* How a pendulum on the circle moves at a value; computed once for each value, and kept. */
pendres_status pendres_circles_tell(pendres_circles *c, double value,
                                    pendres_circles_verdict *out);

/* Where a lock ends; `found` is 0 if that is in doubt. */
typedef struct pendres_circles_end {
  double value, error;
  int found;
} pendres_circles_end;

/* The end of a lock, between a value at which it exists and one at which it does not. */
pendres_status pendres_circles_edge(pendres_circles *c, const pendres_circle_turn *lock,
                                    double inside, double outside, pendres_circles_end *out);

/* The distance of a state from the circle at a value; infinite if there is no circle. */
pendres_status pendres_circles_distance(pendres_circles *c, double value, double x, double v,
                                        double *distance);

#endif
