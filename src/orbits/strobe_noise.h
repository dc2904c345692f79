/*
 * strobe_noise.h -- rounding along trajectories.
 *
 * Owns: how large it is in a step. Lanes carry along what becomes of it (flow.h): a trajectory near
 * a separatrix amplifies rounding by orders of magnitude, and two runs may then agree by chance.
 * With strong friction errors grow so and fade again within a period, and the derivative of the map
 * over a whole period tells nothing of that.
 */
#ifndef PENDRES_STROBE_NOISE_H
#define PENDRES_STROBE_NOISE_H

#include <pendres/context.h>

#include "engine/passage.h"

/* The standard error of the angle by rounding in one step with a Butcher table. Roundings are taken
   to be random and independent: each step adds the square of this to the variance. */
double pendres_strobe_noise_of_step(pendres_table table);

/* The standard error of the larger of y and v, from what a lane has carried; infinite where it
   exceeds all bounds. */
double pendres_strobe_noise_of(double drive_frequency, const pendres_flow_error *carried);

#endif
