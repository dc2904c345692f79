/*
 * hysteresis_steps.h -- the steps that a path has met: where rotations are locked to the drive.
 */
#ifndef PENDRES_HYSTERESIS_STEPS_H
#define PENDRES_HYSTERESIS_STEPS_H

#include "analysis/sweeps/hysteresis_names.h"

/* Find the steps of a path from its points and jumps, once it has all of them. */
pendres_status pendres_hysteresis_find_steps(pendres_context *ctx, pendres_hysteresis *h);

#endif
