/*
 * hysteresis_orbit.h -- a pendulum on a closed orbit, followed along a path by continuation.
 *
 * Owns: those points of a path, and the jumps at which such orbits end.
 */
#ifndef PENDRES_HYSTERESIS_ORBIT_H
#define PENDRES_HYSTERESIS_ORBIT_H

#include "analysis/sweeps/hysteresis_path.h"

/* Whether an attractor is an orbit that can be followed. */
int pendres_path_short(const pendres_path *w, const pendres_attractor *a);

/*
 * Follow a pendulum on such an orbit to value number *i and as far beyond as possible, through
 * jumps at its ends. If the trials of a jump have gone beyond that value, the orbit is followed
 * back to it; an end that it meets on the way back is no jump of the path.
 */
pendres_status pendres_path_orbit(pendres_path *w, size_t *i);

#endif
