/**
 * @file boundary.h
 * @brief Basin boundaries as curves: stable manifolds of unstable orbits.
 *
 * Owns: the unstable orbit between two attractors, and its stable manifold as a polyline. Where
 * two basins meet in a smooth curve, that curve is the stable manifold of a saddle, and
 * mapping it one drive period back gives more of it.
 *
 * The stroboscopic map backwards is the map of the same pendulum with negative damping, seen
 * in a mirror: time -> -time changes (damping, v) into (-damping, -v) and leaves the drive, which
 * is even in time, unchanged. Backwards in time, errors across the manifold shrink.
 *
 * Serves all pendulums and forces. With another force than the pendulum's a state that has left may
 * come back from any distance, so the curve is followed as far as twice the window's size around
 * it, and is never said to be complete.
 *
 * Source: You, Kostelich and Yorke, Int. J. Bifurcation Chaos 1 (1991) 605; Hobson,
 * J. Comput. Phys. 104 (1993) 14, for the refinement by distance and angle.
 */
#ifndef PENDRES_BOUNDARY_H
#define PENDRES_BOUNDARY_H

#include <stddef.h>

#include <pendres/context.h>
#include <pendres/orbit.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** Options. Zero in a field means the default. */
typedef struct pendres_boundary_options {
  size_t size; /**< sizeof this struct, or 0: that of version 1.0 (see pendres.h) */
  double x_low;         /**< window in which points are kept, rad; where x_low and x_high are 0: one
                             turn around well 0, of a polynomial pi times its unit of length
                             (pendres_units_of) to both sides of 0 */
  double x_high;        /**< its other side */
  double v_low;         /**< the same in v; where v_low and v_high are 0: -2.5 to 2.5 units */
  double v_high;        /**< its other side */
  double spacing;       /**< neighbours on a piece are no further apart in x, or in v times the unit
                             of time; default 0.05 units of length */
  double deviation;     /**< of the polyline from the curve between its points, likewise; default
                             1e-5 */
  size_t most_points;   /**< number of points after which the curve ends; default 400000 */
} pendres_boundary_options;

/** A curve in one or more pieces. Made and freed by the library, which alone may change it. */
typedef struct pendres_boundary {
  size_t count;        /**< how many points, piece after piece, in order along each */
  const double *x;     /**< [count] their positions, rad */
  const double *v;     /**< [count] velocities */
  const double *error; /**< [count] how far the true curve may be from the point and from the lines
                            to its neighbours, in the plane of x and v times the unit of time */
  const int *piece;    /**< [count] the piece (0, 1, ...) that each belongs to */
  double bound;        /**< the largest error; 0 without points */
  int complete;        /**< 1: all of the manifold that ever enters the window; 0: it goes on */
} pendres_boundary;

/**
 * The orbit that separates the basin of `attractor` (period one, stable) from its neighbour's: the
 * unstable orbit at the same parameters on the same branch, behind the fold. *out is written.
 * PENDRES_NOT_FOUND: the branch does not come back to these parameters.
 */
pendres_status pendres_saddle_find(pendres_context *ctx, const pendres_orbit *attractor,
                                   pendres_orbit *out);

/**
 * The stable manifold of `saddle` (one multiplier outside, one inside the unit circle, any
 * period) within a window of Poincaré points at drive phase 0, all its translations by whole
 * turns included. options may be NULL. *out is to be freed by pendres_boundary_free.
 *
 * A manifold that accumulates on itself or on another one (in a fractal boundary or in endless
 * strands) has no end: the part that fits into most_points, and starts at points that are distinct
 * in double precision, is given, and `complete` is 0.
 * Errors: PENDRES_INVALID_ARGUMENT (not a saddle, or an empty window), those of the integration.
 */
pendres_status pendres_boundary_find(pendres_context *ctx, const pendres_orbit *saddle,
                                     const pendres_boundary_options *options,
                                     pendres_boundary **out);
/** NULL is allowed. */
void pendres_boundary_free(pendres_boundary *boundary);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
