/*
 * undriven.h -- rotations under a torque alone.
 *
 * Owns: whether a pendulum has come to one. Under a torque above 1 there is nothing else. Below, it
 * has once it has passed an upper equilibrium in the direction of the torque: it is then faster
 * than the unstable manifold of that equilibrium, which passes the next one wherever there is a
 * rotation, and trajectories do not cross. It is about to where it is so fast, v, that it passes
 * one within a turn for certain: there v dv/dy > I - 1 - gamma v, so that v^2 falls by less than
 * 4 pi (1 - I + gamma v).
 */
#ifndef PENDRES_UNDRIVEN_H
#define PENDRES_UNDRIVEN_H

#include <pendres/rotation.h>

/* Whether a pendulum has a torque and no drive, so that rotation.h tells its rotations. */
int pendres_undriven(const pendres_pendulum *p);

/* Whether such a pendulum, which has a rotation, comes to it for certain as it has gone from one
   position to another, turns included, and has this velocity now. */
int pendres_undriven_rotates(const pendres_pendulum *p, double from_x, double to_x, double v);

#endif
