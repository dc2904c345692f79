/*
 * rotation_slope.h -- how the mean velocity of a rotation without a drive, and the least torque
 * that has one, move with torque and damping.
 *
 * Owns: these derivatives, from the equations of sensitivity over a turn; see
 * <pendres/rotation.h>. Thread safe.
 */
#ifndef PENDRES_MODEL_ROTATION_SLOPE_H
#define PENDRES_MODEL_ROTATION_SLOPE_H

#include <pendres/rotation.h>

typedef struct pendres_rotation_slope {
  double mean_velocity, by_torque, by_damping;
} pendres_rotation_slope;

/* At a torque above 0; 0: there is no rotation. */
int pendres_rotation_slope_at(double damping, double torque, pendres_rotation_slope *out);

/* The least torque with a rotation, and its derivative by the damping; 0: no such damping. */
int pendres_rotation_onset_slope(double damping, double *torque, double *by_damping);

#endif
