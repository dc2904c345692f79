/*
 * strobe_noise.h -- rounding along trajectories.
 *
 * Owns: the covariance C of the rounding errors of a state, carried along by the variational
 * equation, C(t) = M C M' + (what is added on the way). A trajectory near a separatrix
 * amplifies rounding by orders of magnitude, and two runs may then agree by chance.
 */
#ifndef PENDRES_STROBE_NOISE_H
#define PENDRES_STROBE_NOISE_H

#include "engine/strobe_run.h"

/* The standard error that rounding in one step with a Butcher table leaves in the angle: roundings
   are random and independent of each other. */
double pendres_strobe_noise_of_step(pendres_table table);

/*
 * C_yy, C_yw, C_ww after `step` steps from a state where they were noise[]; rounding is that of a
 * step. The lane's rows of derivatives began as the identity.
 */
void pendres_strobe_noise_carry(const double noise[3], double rounding, int step,
                                const pendres_rows *rows, size_t lane, double out[3]);

/*
 * Run n lanes on by `periods` drive periods with the fixed steps of each. noise[n] receives the
 * standard error by rounding, of the larger of y and v; infinite where it exceeds all bounds.
 */
pendres_status pendres_strobe_noise_run(pendres_context *ctx, size_t n,
                                        pendres_strobe_lane *lanes, long periods, double *noise);

#endif
