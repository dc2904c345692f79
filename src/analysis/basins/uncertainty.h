/*
 * uncertainty.h -- an uncertainty exponent from random states, as far as work allows.
 */
#ifndef PENDRES_BASIN_UNCERTAINTY_H
#define PENDRES_BASIN_UNCERTAINTY_H

#include <pendres/basin.h>

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

#endif
