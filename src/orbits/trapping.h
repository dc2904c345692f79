/*
 * trapping.h -- trapping ellipses around attracting periodic orbits.
 *
 * Owns: the metric of an orbit, and the largest ellipse found to lie in the orbit's basin. That is
 * checked by rings of pendulums on its edge, and not proved (see attractor.h for the argument).
 */
#ifndef PENDRES_TRAPPING_H
#define PENDRES_TRAPPING_H

#include <pendres/context.h>
#include <pendres/orbit.h>

#include "orbits/trapping_ellipse.h"

/* How hard to look for large ellipses. */
typedef enum pendres_trapping_effort {
  PENDRES_TRAPPING_FEW = 0, /* for ensembles of hundreds: the radius within a factor of 1.4 */
  PENDRES_TRAPPING_MANY = 1 /* for grids of millions: within a tenth */
} pendres_trapping_effort;

/*
 * Find the ellipses of n orbits, one at each Poincaré point: an orbit of period q comes as q
 * entries, each refined at its own point.
 */
pendres_status pendres_trapping_find(pendres_context *ctx, size_t n, const pendres_orbit *orbits,
                                     pendres_trapping_effort effort,
                                     pendres_trapping_ellipse *ellipses);

#endif
