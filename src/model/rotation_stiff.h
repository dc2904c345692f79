/*
 * rotation_stiff.h -- rotations just beyond a torque of 1 where friction is strong.
 *
 * Owns: their velocity as a function of the angle by implicit collocation. Other motions approach
 * the rotation within a small angle, v / gamma, so that series in the angle cannot take longer
 * steps; close to a torque of 1 the rotation is arbitrarily slow, and a turn would take millions of
 * steps.
 */
#ifndef PENDRES_ROTATION_STIFF_H
#define PENDRES_ROTATION_STIFF_H

/*
 * The velocity at y = 0 and the period of the rotation at a damping of 1 or more and a torque above
 * 1; NaN if it is not found. widest: the width of the largest panel into which the turn is divided,
 * in radians; results with two such widths give an error estimate.
 */
double pendres_rotation_stiff(double damping, double torque, double widest, double *period);

/* The time of a turn that begins with the velocity v at y = 0. */
double pendres_rotation_stiff_period(double damping, double torque, double widest, double v);

/* What a turn does to the velocity and takes of time, derived by the velocity at its start, the
   torque and the damping. */
enum { ROTATION_BY_START, ROTATION_BY_TORQUE, ROTATION_BY_DAMPING, ROTATION_SLOPES };
typedef struct rotation_slopes {
  double velocity[ROTATION_SLOPES], time[ROTATION_SLOPES];
} rotation_slopes;

/* Those of the turn of a rotation that begins with the velocity v; returns its time. */
double pendres_rotation_stiff_slopes(double damping, double torque, double widest, double v,
                                     rotation_slopes *out);

#endif
