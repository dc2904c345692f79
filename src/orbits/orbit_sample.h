/*
 * orbit_sample.h -- all harmonics of an orbit that can be told.
 */
#ifndef PENDRES_ORBIT_SAMPLE_H
#define PENDRES_ORBIT_SAMPLE_H

#include <pendres/orbit.h>

#include "orbits/orbit_series.h"

/*
 * Add share times the harmonics of the angle, averaged over the orbit's drive cycles, to those of
 * a series; by as many steps a period as the orbit was found with. The mean is left alone.
 */
pendres_status pendres_orbit_add_harmonics(pendres_context *ctx, const pendres_orbit *orbit,
                                           double share, pendres_orbit_series *sum);

#endif
