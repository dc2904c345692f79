/*
 * stencil.h -- a curve between two of its points, by a cubic through four.
 *
 * Owns: where a coordinate takes a value between two neighbouring points of a curve, be it twice:
 * a coordinate may turn back between them.
 */
#ifndef PENDRES_CONTINUATION_STENCIL_H
#define PENDRES_CONTINUATION_STENCIL_H

#include <stddef.h>

#include "continuation/map.h"

enum { PENDRES_STENCIL_NODES = 4, PENDRES_STENCIL_ROOTS = 3 };

/* Points around a chord; the chord goes from t = 0 to its length. */
typedef struct pendres_continuation_stencil {
  int nodes;
  double t[PENDRES_STENCIL_NODES]; /* distance along the points, scaled as arclength */
  double u[PENDRES_STENCIL_NODES][PENDRES_U_COUNT];
  double length;
} pendres_continuation_stencil;

/* The points of a curve in their order. */
typedef struct pendres_continuation_points {
  size_t count;
  const double (*u)[PENDRES_U_COUNT];
  int closed;  /* the last is followed by the first, */
  double turn; /* whole turns of y away perhaps; 0: the coordinate has none */
} pendres_continuation_points;

/* The chord from point i to the next (after the last one the first, if closed). */
void pendres_continuation_stencil_init(pendres_continuation_stencil *s,
                                       const pendres_continuation_points *points, size_t i);

void pendres_continuation_stencil_at(const pendres_continuation_stencil *s, double t,
                                     double u[PENDRES_U_COUNT]);

/* Where 0 <= t < length (<= if `last`) and coordinate `place` has a value; returns their number. */
size_t pendres_continuation_stencil_roots(const pendres_continuation_stencil *s, int place,
                                          double value, int last,
                                          double t[PENDRES_STENCIL_ROOTS]);

#endif
