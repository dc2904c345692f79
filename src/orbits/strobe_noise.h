/*
 * strobe_noise.h -- rounding along trajectories.
 *
 * Owns: how large it is. What becomes of it the lanes carry along with their steps (flow.h): a
 * trajectory near a separatrix amplifies rounding by orders of magnitude, and two runs may then
 * agree by chance. With strong friction it does so and forgets it again within a period, so that
 * the derivative of the map over a whole one tells nothing.
 */
#ifndef PENDRES_STROBE_NOISE_H
#define PENDRES_STROBE_NOISE_H

#include <pendres/context.h>

#include "engine/passage.h"

/* The standard error that rounding in one step with a Butcher table leaves in the angle: roundings
   are random and independent of each other. Its square is what a lane's steps add. */
double pendres_strobe_noise_of_step(pendres_table table);

/* The standard error of the larger of y and v, from what a lane has carried; infinite where it
   exceeds all bounds. */
double pendres_strobe_noise_of(double drive_frequency, const pendres_flow_error *carried);

#endif
