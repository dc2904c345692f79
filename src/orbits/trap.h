/*
 * trap.h -- trapping ellipses around attracting periodic orbits.
 *
 * Owns: the metric of an orbit, and the largest ellipse found to lie in the orbit's basin. That is
 * checked by rings of pendulums on its edge, and not proved (see attractor.h for the argument).
 */
#ifndef PENDRES_TRAP_H
#define PENDRES_TRAP_H

#include <pendres/context.h>
#include <pendres/orbit.h>

#include "orbits/trap_ellipse.h"

/* How hard to look for large traps. */
typedef enum pendres_trap_effort {
  PENDRES_TRAP_FEW = 0, /* for ensembles of hundreds: the largest radius within a factor of 1.4 */
  PENDRES_TRAP_MANY = 1 /* for grids of millions: within a tenth */
} pendres_trap_effort;

/*
 * Find the traps of n orbits, one at each Poincaré point: an orbit of period q comes as q entries,
 * each refined at its own point.
 */
pendres_status pendres_trap_find(pendres_context *ctx, size_t n, const pendres_orbit *orbits,
                                 pendres_trap_effort effort, pendres_trap *traps);

#endif
