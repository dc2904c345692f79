/*
 * orbit.h -- measures of orbits that Newton's method at fixed parameters cannot reach.
 *
 * Owns: turning fixed points found by continuation, at and near folds included, into pendres_orbit.
 */
#ifndef PENDRES_CONTINUATION_ORBIT_H
#define PENDRES_CONTINUATION_ORBIT_H

#include <pendres/continuation.h>

#include "continuation/curve/map.h"

/* A fixed point as two computations of different steps a period found it. */
typedef struct pendres_solution {
  pendres_map map;
  pendres_u coarse, fine;
  int coarse_steps, fine_steps;
  int critical;    /* at a bifurcation, not at given parameters */
  double apart;    /* of the two at a bifurcation, in y and w, chance left out */
  double rounding; /* of y and w */
} pendres_solution;

/* Measure n orbits; nothing is moved. */
pendres_status pendres_solution_measure(pendres_context *ctx, size_t n,
                                        const pendres_solution *pairs, pendres_orbit *out);

/*
 * The multipliers of an orbit at a bifurcation, whose parameters are known to these errors: one is
 * +1 or -1, and the product of both follows from Liouville's formula. Those of the map that was
 * computed there differ from them, since it is a little off the bifurcation.
 */
void pendres_orbit_set_critical(pendres_special kind, int parameters,
                                const pendres_parameter *parameter, const double *error,
                                pendres_orbit *o);

/* The error of the finer of two computations, rounding included. */
double pendres_solution_error(double coarse, double fine, double rounding);

#endif
