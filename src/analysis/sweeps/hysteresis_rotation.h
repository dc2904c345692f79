/*
 * hysteresis_rotation.h -- a pendulum that rotates without a drive, followed along a path.
 *
 * Owns: those points of a path, and the jump at which the rotation ends.
 */
#ifndef PENDRES_HYSTERESIS_ROTATION_H
#define PENDRES_HYSTERESIS_ROTATION_H

#include "analysis/sweeps/hysteresis_path.h"

/* Follow a pendulum on such a rotation from value number *i on as far as there are any, and beyond
   their end onto the equilibrium that is left. */
pendres_status pendres_path_rotation(pendres_path *w, size_t *i);

/* Whether the pendulum's state ends at the torque beyond which there is no equilibrium, only
   rotations. If so, jump and state are set; if not, *done is 0. */
void pendres_path_into_rotation(pendres_path *w, const pendres_bifurcation *end,
                                pendres_jump *jump, int *done);

#endif
