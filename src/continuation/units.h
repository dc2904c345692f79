/*
 * units.h -- branches, curves and bifurcations behind the door (engine/door.h).
 */
#ifndef PENDRES_CONTINUATION_UNITS_H
#define PENDRES_CONTINUATION_UNITS_H

#include "continuation/curve/curve.h"
#include "engine/door.h"

/* Bifurcations in canonical units, each of its own parameter, until the door is closed. */
const pendres_bifurcation *pendres_bifurcations_inside(pendres_door *d, size_t n,
                                                       const pendres_bifurcation *b);

/* The options of curves through n of them. */
const pendres_curve_options *pendres_curve_options_inside(pendres_door *d, size_t n,
                                                          const pendres_bifurcation *b,
                                                          const pendres_curve_options *o);

/* Open the door for branches of a pendulum; either may be NULL. */
pendres_door pendres_branch_open(pendres_context *ctx, const pendres_pendulum *p,
                                 const pendres_branch_options *options);

/* Open the door for a curve, whose parameters are moved; returns the curve in canonical units,
   until the door is closed. NULL: none. */
const pendres_curve *pendres_curve_open(pendres_door *d, pendres_context *ctx,
                                        const pendres_curve *c);

/* Likewise curves, for a door that is open. */
const pendres_curves *pendres_curves_inside(pendres_door *d, const pendres_curves *set);

/* Curves and sets themselves: in, and out again. NULL has none. */
void pendres_curve_leave(const pendres_door *d, pendres_curve *c);
void pendres_curves_enter(const pendres_door *d, pendres_curves *set);
void pendres_curves_leave(const pendres_door *d, pendres_curves *set);

#endif
