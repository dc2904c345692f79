/*
 * parameter.h -- how long steps are in a parameter, and who has it; for its value and
 * name see continuation.h.
 */
#ifndef PENDRES_CONTINUATION_PARAMETER_H
#define PENDRES_CONTINUATION_PARAMETER_H

#include <pendres/continuation.h>

/* The pendulum with another value of a parameter. */
pendres_pendulum pendres_parameter_with(const pendres_pendulum *p, pendres_parameter parameter,
                                        double value);

/* Lengths that count as one in arclength. */
double pendres_parameter_scale(pendres_parameter parameter);

/* The value at a signed distance from another one; but the damping and the drive frequency, which
   stay above 0, are at least half of the other. */
double pendres_parameter_beyond(pendres_parameter parameter, double value, double distance);

/* Why an orbit cannot be followed in a parameter, a static sentence; NULL if it can. */
const char *pendres_continuation_refuses(const pendres_orbit *orbit, pendres_parameter parameter);

#endif
