/*
 * locate.h -- folds, flips and cusps to the tolerance, with their errors.
 *
 * Owns: solving their equations at two numbers of steps, and what follows from the difference.
 */
#ifndef PENDRES_CONTINUATION_LOCATE_H
#define PENDRES_CONTINUATION_LOCATE_H

#include <pendres/continuation.h>

#include "continuation/curve/equations.h"
#include "continuation/curve/orbit.h"

/* A solution with the errors of its unknowns, in their order. */
typedef struct pendres_located {
  pendres_solution pair;
  double error[PENDRES_EQUATIONS_MOST];
  int parted;          /* where two branches were to cross: they come close, and do not */
} pendres_located;

/*
 * Solve a system of as many equations as unknowns near u, with steps of its own choice, until the
 * parameters' errors are below the tolerance of the context. PENDRES_NOT_CONVERGED (without a
 * message) if there is nothing within `reach` of u (in the scale of arclength);
 * PENDRES_TOLERANCE_UNREACHABLE with *out complete.
 */
pendres_status pendres_locate(pendres_context *ctx, const pendres_system *system,
                              const pendres_u u, double reach, pendres_located *out);

/* Whether a status of pendres_locate() says that *out is complete. */
int pendres_located_found(pendres_status status);

/* The bifurcation that a condition is of, of this map. */
pendres_special pendres_special_of(pendres_condition condition, const pendres_map *map);

/* Make a public bifurcation of a located fold or flip in one parameter. */
pendres_status pendres_locate_bifurcation(pendres_context *ctx, pendres_condition condition,
                                          pendres_parameter parameter,
                                          const pendres_located *located, pendres_bifurcation *out);

/* Make a public cusp of a located one, whose last two unknowns are the parameters. */
pendres_status pendres_locate_cusp(pendres_context *ctx, const int *unknown,
                                   const pendres_located *located, pendres_cusp *out);

#endif
