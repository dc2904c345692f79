/*
 * uncertainty.h -- an uncertainty exponent from random states, as far as work allows.
 */
#ifndef PENDRES_BASIN_UNCERTAINTY_H
#define PENDRES_BASIN_UNCERTAINTY_H

#include <pendres/basin.h>

#include "engine/door.h"

/*
 * pendres_basin_uncertainty() with a bound on its work: of n states the first are settled, as many
 * as take at most `most` evaluations of the equation (pendres_context_slopes), but a first part of
 * them in any case.
 */
pendres_status pendres_basin_uncertainty_within(pendres_context *ctx, double most,
                                                const pendres_attractors *set,
                                                const pendres_basin_window *window,
                                                const pendres_basin_sample *sample,
                                                pendres_basin_statistics *out);

/*
 * The error a drive period that labels of a grid are computed with at first: ten times the
 * tolerance, if that is tighter than the default of 1e-8. Else what a picture needs, a thousandth
 * of the smallest spacing, at most 1e-5 and at least ten times the tolerance. States about this
 * close to a basin's boundary may be on its other side: those that are not known to be certain are
 * PENDRES_BASIN_UNCERTAIN.
 */
double pendres_basin_accuracy(const pendres_context *ctx, const pendres_basin_grid *grid);

/* A grid behind the door, as long as that is open. */
const pendres_basin_grid *pendres_basin_grid_inside(pendres_door *d,
                                                    const pendres_basin_grid *grid);

#endif
