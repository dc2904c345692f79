/*
 * orbit_sample.h -- all harmonics of an orbit that its samples determine.
 */
#ifndef PENDRES_ORBIT_SAMPLE_H
#define PENDRES_ORBIT_SAMPLE_H

#include <pendres/orbit.h>

#include "orbits/orbit_series.h"

/*
 * Add the harmonics of the angle, averaged over the orbit's drive cycles and times share, to those
 * of a series. The orbit is integrated with the number of steps with which it was found. The mean
 * of the series stays as it is.
 */
pendres_status pendres_orbit_add_harmonics(pendres_context *ctx, const pendres_orbit *orbit,
                                           double share, pendres_orbit_series *sum);

#endif
