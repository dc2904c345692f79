/*
 * strobe_noise.h -- rounding along trajectories.
 *
 * Owns: the size of rounding errors in a step. Lanes propagate their covariance (block.h), since a
 * trajectory near a separatrix amplifies rounding by orders of magnitude, and two runs may then
 * agree by chance. With strong friction errors may grow as much and decay again within a period,
 * which the derivative of the map over a whole period does not show.
 */
#ifndef PENDRES_STROBE_NOISE_H
#define PENDRES_STROBE_NOISE_H

#include <pendres/context.h>

#include "engine/block.h"
#include "engine/strobe_run.h"

/* The standard error of the angle by rounding in one step with a Butcher table. Roundings are taken
   to be random and independent: each step adds the square of this to the variance. */
double pendres_strobe_noise_of_step(pendres_table table);

/* The same of a Nystrom method in single precision (kernels_nystrom.h). */
double pendres_strobe_noise_of_single_step(void);

/*
 * Plain pendulums may be run in single precision up to this speed at the start; -1: not at all. The
 * error that they carry includes its rounding, so that a label is certain or the pendulum is run
 * again. Near a small ellipse rounding may keep a pendulum from settling: a run that waits for the
 * last of them is in double precision.
 */
double pendres_strobe_noise_fastest(const pendres_context *ctx, const pendres_pendulum *p);

/* Let a lane that starts with this speed, and whose steps are known, run in single precision if
   these are no more exact than what steps in it round by, that much each. */
void pendres_strobe_noise_choose(double speed, double fastest, double accuracy,
                                 pendres_strobe_lane *lane);

/* The larger of the standard errors of y and v, from the covariance that a lane has carried;
   infinite if it has overflowed. */
double pendres_strobe_noise_of(double drive_frequency, const pendres_flow_error *carried);

#endif
