/*
 * rotations.h -- rotations of a pendulum that a torque alone turns over.
 *
 * Without a drive of either kind the equation is autonomous. What stands still are equilibria,
 * which are orbits of every strobe map and are followed as branches; what rotates has a period of
 * its own and is no such orbit. Where a rotation exists there is one, so that its branch over the
 * torque is found point by point; it ends at the least torque, in a homoclinic connection or a
 * saddle-node (pendres/rotation.h).
 */
#ifndef SCENE_ROTATIONS_H
#define SCENE_ROTATIONS_H

#include "scenes/lines.h"

/* Whether the lines are those of a pendulum under a torque, without a drive of either kind. */
int scene_rotations_are(const scene_lines *l);

/* Write period, mean velocity and multiplier of the rotation at every point, NaN where there is
   none, and the least torque that keeps one up. */
void scene_rotations_write(const scene_lines *l);

#endif
