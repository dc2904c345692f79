/*
 * continuation_curve.h -- what the parts of continuation share of curves.
 *
 * Owns: the layout of pendres_curve and of pendres_curves.
 */
#ifndef PENDRES_CONTINUATION_CURVE_H
#define PENDRES_CONTINUATION_CURVE_H

#include <pendres/continuation.h>

#include "continuation/continuation_arc.h"

struct pendres_curve {
  pendres_special kind;
  pendres_continuation_map map;
  pendres_continuation_condition condition;
  pendres_parameter parameter[2];
  size_t count, cusps;
  pendres_curve_point *point;
  double (*u)[PENDRES_U_COUNT]; /* of each point */
  pendres_cusp *cusp;
  pendres_branch_end end[2];
  size_t start; /* in a set: the number of the bifurcation that it was followed from */
};

struct pendres_curves {
  size_t count, capacity;
  pendres_curve **curve;
};

#endif
