/*
 * circles.h -- the invariant circles that a sweep has met: bands of them, one beside the other.
 *
 * Owns: finding the band of a value, making bands from one that is next to it or from a pendulum's
 * motion, and what a pendulum on the circle does at a value. There is one circle at most at each
 * value (lyapunov.h), so that bands serve a sweep both ways.
 */
#ifndef PENDRES_CIRCLES_H
#define PENDRES_CIRCLES_H

#include "questions/circle_band.h"

/* The circle and what a pendulum does on it: `found` is 0 where there is no band. */
typedef struct pendres_circles_verdict {
  int found;
  double value;
  pendres_circle_turn turn;
  double x, v; /* on the circle, on the stable orbit if it is locked */
} pendres_circles_verdict;

typedef struct pendres_circles {
  pendres_context *ctx;
  pendres_circle_family family;
  size_t count, room;
  pendres_circle_band *band;   /* in the order in which they were found */
  unsigned char *closed;       /* of each, bit 1 and 2: nothing was found below it, above it */
  pendres_circle_table *table;
  double width;                /* of the next band */
  double low, high;            /* no band goes beyond */
  size_t told, places;         /* verdicts so far, at places that their values tell */
  pendres_circles_verdict *verdict; /* `found` is 0 where there is none */
  double failed;               /* value of the last motion from which there was none; or NaN */
} pendres_circles;

/* For a pendulum, but for a parameter, within a range of that. */
pendres_status pendres_circles_create(pendres_context *ctx, const pendres_circle_family *family,
                                      double low, double high, pendres_circles **out);
void pendres_circles_free(pendres_circles *c);

/* A band for the circle of a pendulum that is on it at a state and a value. */
pendres_status pendres_circles_begin(pendres_circles *c, double value, double x, double v);

/* The band that holds a value, made from those next to it where it is not there: NULL if the
   circle could not be followed so far. The pointer is good until the next call. */
pendres_status pendres_circles_seek(pendres_circles *c, double value,
                                    const pendres_circle_band **out);

/* What a pendulum on the circle at a value does: told once for each value. */
pendres_status pendres_circles_tell(pendres_circles *c, double value,
                                    pendres_circles_verdict *out);

/* Where a lock ends: `found` is 0 if that is in doubt. */
typedef struct pendres_circles_end {
  double value, error;
  int found;
} pendres_circles_end;

/* The end of a lock between a value at which it is there and one at which it is not. */
pendres_status pendres_circles_edge(pendres_circles *c, const pendres_circle_turn *lock,
                                    double inside, double outside, pendres_circles_end *out);

/* How far a state is from the circle at a value; infinite where there is none. */
pendres_status pendres_circles_distance(pendres_circles *c, double value, double x, double v,
                                        double *distance);

#endif
