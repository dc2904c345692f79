/*
 * scale.h -- what counts as one in arclength.
 *
 * Owns: the scale of each unknown, and distances in it.
 */
#ifndef PENDRES_CONTINUATION_SCALE_H
#define PENDRES_CONTINUATION_SCALE_H

#include "continuation/map.h"

/* The length that counts as one in arclength, of entry `i` of u where it has this value. Of
   parameters it is a constant at first, but never less than a twentieth of the value: beyond twenty
   of the constant they count by their logarithms, and a curve over decades is not a long one. */
double pendres_arc_scale(int i, double value);

/* The constant. */
double pendres_arc_least_scale(int i);

/* Distance in the scale of arclength. What is the same in both points does not count. */
double pendres_arc_distance(const double a[PENDRES_U_COUNT], const double b[PENDRES_U_COUNT]);

#endif
