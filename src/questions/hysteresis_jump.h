/*
 * hysteresis_jump.h -- where a pendulum goes when the state that it is in ends.
 *
 * Owns: the trials that tell.
 */
#ifndef PENDRES_HYSTERESIS_JUMP_H
#define PENDRES_HYSTERESIS_JUMP_H

#include <pendres/hysteresis.h>
#include <pendres/rotation.h>

/* What a pendulum settled on, and a state that it was in then. */
typedef struct pendres_settled {
  pendres_pendulum pendulum;
  pendres_attractor attractor; /* label UNRESOLVED: nothing that is known */
  double x, v;                 /* on it, or on the way to it */
} pendres_settled;

/* Whether an attractor is an orbit that closes in drive periods. */
int pendres_settled_closed(const pendres_attractor *a);

/* Whether two are the same state at parameters next to each other, or mirror images of it. */
int pendres_settled_alike(const pendres_attractor *a, const pendres_attractor *b);

/* An attractor of which nothing is known. */
pendres_attractor pendres_settled_nothing(const pendres_pendulum *p);

/* A pendulum in a state, of whose attractor nothing is known. */
pendres_settled pendres_settled_nothing_at(const pendres_pendulum *p, double x, double v);

/* The attractor that a stable orbit is; its trap is not determined. */
pendres_attractor pendres_settled_orbit(const pendres_orbit *o);

/* A pendulum on its rotation without a drive. */
void pendres_settled_rotate(const pendres_pendulum *p, const pendres_rotation *r,
                            pendres_settled *out);

/* What n pendulums that may rotate, PENDRES_HYSTERESIS_TRIALS at most, come to from where they are,
   next to rotations that are not locked to the drive. */
pendres_status pendres_settled_rotations(pendres_context *ctx, size_t n, pendres_settled *s);

/* Settle one pendulum: one that may rotate without a lock to the drive, which no hunt for orbits
   finds, is judged as in lyapunov.h. What does not close is taken some way along, so that it is on
   its attractor. */
pendres_status pendres_settled_find(pendres_context *ctx, const pendres_pendulum *p, double x,
                                    double v, pendres_settled *out);

/* Where most trials go from an orbit that ends at a bifurcation, or with `at` as it is where
   nothing is known but the place: to, share and certain of the jump are set. */
pendres_status pendres_jump_try(pendres_context *ctx, const pendres_bifurcation *at, int direction,
                                pendres_settled *to, pendres_jump *jump);

#endif
