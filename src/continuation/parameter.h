/* parameter.h -- how long steps are in a parameter, and which orbits are followed in it. */
#ifndef PENDRES_CONTINUATION_PARAMETER_H
#define PENDRES_CONTINUATION_PARAMETER_H

#include <pendres/continuation.h>

#include "model/parameter.h"

/* Lengths that count as one in arclength: the least of them, and that at a value, which may be
   longer at a large one. */
double pendres_parameter_scale(pendres_parameter parameter);
double pendres_parameter_scale_at(pendres_parameter parameter, double value);

/* The value at a signed distance from another one; but what stays above 0 is at least half of the
   other. */
double pendres_parameter_beyond(pendres_parameter parameter, double value, double distance);

/* Why an orbit cannot be followed in a parameter, a static sentence; NULL if it can. */
const char *pendres_follow_refuses(const pendres_orbit *orbit, pendres_parameter parameter);

#endif
