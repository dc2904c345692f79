/*
 * trapping_level.h -- regions around weakly damped orbits, bounded by level lines of a polynomial.
 *
 * Where damping is weak, an ellipse of the linear metric comes home only if it is so small that the
 * nonlinearity moves its points by less than a period's damping does. A polynomial V can be found
 * that follows the nonlinearity: with z the distance from the Poincaré point in the metric that the
 * linear map M shrinks evenly, V = |z|^2 + terms of the third to the sixth degree, such that
 * V(image of z) = |det M| V(z) up to terms of the seventh degree. It is the square of the distance
 * from the orbit in coordinates in which the map is M itself (a Birkhoff normal form). Where V
 * falls from each strobe to the next in all of a region V <= level, states in it come to the orbit.
 *
 * Owns: finding V by least squares on a disk of states that are followed over the orbit's period,
 * and the region in which it is seen to fall. On every second ray of the disk V is fitted, on the
 * others it is only looked at. It has to fall by at least half of what damping gives on all rays:
 * checked, not proved, as with ellipses.
 */
#ifndef PENDRES_TRAPPING_LEVEL_H
#define PENDRES_TRAPPING_LEVEL_H

#include <pendres/context.h>
#include <pendres/orbit.h>

#include "orbits/trapping_ellipse.h"

/* Give regions to those of n orbits that are weakly damped and whose ellipse has been found, where
   the region is larger than that. Metric, radius and room are then those of the largest ellipse
   inside the region. */
pendres_status pendres_trapping_levels_find(pendres_context *ctx, size_t n,
                                            const pendres_orbit *orbits,
                                            pendres_trapping_ellipse *ellipses);

#endif
