/*
 * rotation_stiff.h -- rotations just beyond a torque of 1 where friction is strong.
 *
 * Owns: their velocity along the angle by implicit collocation. Off the rotation motions come to
 * it within a small angle, v / gamma, so that series in the angle take no longer steps; next to a
 * torque of 1 the rotation is as slow there as wished, and a turn would take millions of them.
 */
#ifndef PENDRES_ROTATION_STIFF_H
#define PENDRES_ROTATION_STIFF_H

/*
 * The velocity at y = 0 and the period of the rotation at a damping of 1 or more and a torque above
 * 1; NaN if it is not found. widest: of the panels that the turn is cut into, in radians; two of
 * them tell how exact a result is.
 */
double pendres_rotation_stiff(double damping, double torque, double widest, double *period);

/* The time of a turn that begins with the velocity v at y = 0. */
double pendres_rotation_stiff_period(double damping, double torque, double widest, double v);

#endif
