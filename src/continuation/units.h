/*
 * units.h -- branches, curves and bifurcations behind the door (engine/door.h).
 */
#ifndef PENDRES_CONTINUATION_UNITS_H
#define PENDRES_CONTINUATION_UNITS_H

#include <pendres/continuation.h>

#include "engine/door.h"

/* Bifurcations in canonical units, each of its own parameter, until the door is closed. */
const pendres_bifurcation *pendres_bifurcations_inside(pendres_door *d, size_t n,
                                                       const pendres_bifurcation *b);

/* The options of curves through n of them. */
const pendres_curve_options *pendres_curve_options_inside(pendres_door *d, size_t n,
                                                          const pendres_bifurcation *b,
                                                          const pendres_curve_options *o);

/* A branch in canonical units, until the door is closed. */
const pendres_branch *pendres_branch_inside(pendres_door *d, const pendres_branch *b);

/* Likewise a curve, and curves. */
const pendres_curve *pendres_curve_inside(pendres_door *d, const pendres_curve *c);
const pendres_curves *pendres_curves_inside(pendres_door *d, const pendres_curves *set);

/* Branches and curves themselves: in, and out again. NULL has none. */
void pendres_branch_enter(const pendres_door *d, pendres_branch *b);
void pendres_branch_leave(const pendres_door *d, pendres_branch *b);
void pendres_branches_enter(const pendres_door *d, pendres_branches *set);
void pendres_branches_leave(const pendres_door *d, pendres_branches *set);
void pendres_curve_leave(const pendres_door *d, pendres_curve *c);
void pendres_curves_enter(const pendres_door *d, pendres_curves *set);
void pendres_curves_leave(const pendres_door *d, pendres_curves *set);

#endif
