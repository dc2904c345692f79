/* angles.h -- a turn, half of it and a quarter, in radians. */
#ifndef PENDRES_ANGLES_H
#define PENDRES_ANGLES_H

#include <pendres/pendulum.h>

static const double two_pi = 2.0 * PENDRES_PI, pi = PENDRES_PI, half_pi = 0.5 * PENDRES_PI;

#endif
