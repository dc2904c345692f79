/*
 * hysteresis_jump.h -- where a pendulum goes when the state that it is in ends.
 *
 * Owns: the trials that decide it.
 */
#ifndef PENDRES_HYSTERESIS_JUMP_H
#define PENDRES_HYSTERESIS_JUMP_H

#include <pendres/hysteresis.h>
#include <pendres/rotation.h>

#include "settling/exponents/lyapunov_move.h"

/* What a pendulum settled on, and its state then. */
typedef struct pendres_settled {
  pendres_pendulum pendulum;
  pendres_attractor attractor; /* its label is UNRESOLVED if nothing is known of it */
  double x, v;                 /* a state on it, or on the way to it */
  int certain;                 /* no error of the integration can have chosen it */
  int slips;                   /* unresolved next to a rotation: too seldom does it turn past the
                                  end of a lock for its mean to be known */
} pendres_settled;

/* Whether an attractor is an orbit that closes in drive periods. */
int pendres_settled_closed(const pendres_attractor *a);

/* Whether two attractors at adjacent parameters are the same one, or mirror images of each
   other. */
int pendres_settled_alike(const pendres_attractor *a, const pendres_attractor *b);

/* An attractor of which nothing is known. */
pendres_attractor pendres_settled_nothing(const pendres_pendulum *p);

/* A pendulum at (x, v), of whose attractor nothing is known. */
pendres_settled pendres_settled_nothing_at(const pendres_pendulum *p, double x, double v);

/* A stable orbit as an attractor, without a trapping ellipse. */
pendres_attractor pendres_settled_orbit(const pendres_orbit *o);

/* A pendulum on its rotation without a drive. */
void pendres_settled_rotate(const pendres_pendulum *p, const pendres_rotation *r,
                            pendres_settled *out);

/* Find what n pendulums settle on, which may rotate without a lock to the drive and start close to
   such rotations. Of the orbits that others than the first come to points alone are known. */
pendres_status pendres_settled_rotations(pendres_context *ctx, size_t n, pendres_settled *s);

/* Settle one pendulum. One that may rotate without a lock to the drive, which no search for closed
   orbits finds, is judged as in lyapunov.h, with this care. If it is on no closed orbit it is
   advanced further, so that its state is on its attractor. */
pendres_status pendres_settled_find(pendres_context *ctx, const pendres_pendulum *p, double x,
                                    double v, pendres_lyapunov_care care, pendres_settled *out);

/* The same where it is asked what it settles on, not how strong a chaos is. */
pendres_status pendres_settled_name(pendres_context *ctx, const pendres_pendulum *p, double x,
                                    double v, pendres_settled *out);

/* Find where most trials go from an orbit that ends at a bifurcation; where only the place of the
   end is known, at->orbit is the last orbit known before it. Sets to, share and certain of the
   jump. */
pendres_status pendres_jump_try(pendres_context *ctx, const pendres_bifurcation *at, int direction,
                                pendres_settled *to, pendres_jump *jump);

/* The same of one pendulum, which was in the state jump->from, from as many states as a jump has
   trials. */
pendres_status pendres_jump_try_from(pendres_context *ctx, const pendres_pendulum *p,
                                     const double *x, const double *v, pendres_settled *to,
                                     pendres_jump *jump);

#endif
