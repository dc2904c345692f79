/*
 * layout.h -- what branches and curves are made of.
 */
#ifndef PENDRES_CONTINUATION_LAYOUT_H
#define PENDRES_CONTINUATION_LAYOUT_H

#include <pendres/continuation.h>

#include "continuation/map.h"

struct pendres_branch {
  pendres_parameter parameter;
  pendres_continuation_map map;
  size_t count, bifurcations;
  pendres_branch_point *point;
  pendres_bifurcation *bifurcation;
  pendres_branch_end end[2];
};

struct pendres_branches {
  size_t count, capacity, skipped;
  pendres_branch **branch;
};

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
