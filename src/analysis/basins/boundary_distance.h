/*
 * boundary_distance.h -- how far the nodes of a grown boundary are from the curve.
 */
#ifndef PENDRES_BOUNDARY_DISTANCE_H
#define PENDRES_BOUNDARY_DISTANCE_H

#include "analysis/basins/boundary_grow.h"

/*
 * The distance of nodes in the (x, v) plane from the stable manifold that belongs to the seed's own
 * number of steps. Mapped forward, a node comes close to the local manifold; its distance from
 * that, divided by what the map makes of a unit vector across the curve, is its distance here. The
 * curve contracts, so that errors along it do not matter. Nodes of a piece are consecutive.
 */
pendres_status pendres_boundary_distance(pendres_context *ctx, const pendres_boundary_seed *seed,
                                         size_t n, const pendres_boundary_node *nodes,
                                         double *distance);

#endif
