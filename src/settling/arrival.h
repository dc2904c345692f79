/*
 * arrival.h -- what single pendulums come to, and their states then: for sweeps, which go on from
 * there.
 *
 * Owns: which way to tell it is asked: trapping, and rotations without a drive (settle.h); or
 * averages (lyapunov_move.h), of what may rotate without a lock to its drive, which no search for
 * closed orbits finds.
 */
#ifndef PENDRES_ARRIVAL_H
#define PENDRES_ARRIVAL_H

#include "settling/attractor_set.h"
#include "settling/exponents/lyapunov_move.h"

/* What a pendulum has come to, and its state then. */
typedef struct pendres_arrival {
  pendres_pendulum pendulum;
  pendres_attractor attractor; /* its label is UNRESOLVED if nothing is known of it */
  double x, v;                 /* a state on it, or on the way to it */
  int certain;                 /* no error of the integration can have chosen it */
  int slips;                   /* unresolved next to a rotation: too seldom does it turn past the
                                  end of a lock for its mean to be known */
} pendres_arrival;

enum { PENDRES_ARRIVALS = 16 /* that are looked for at once, at most */ };

/* An attractor of which nothing is known. */
pendres_attractor pendres_arrival_nothing(const pendres_pendulum *p);

/* A pendulum at (x, v), of whose attractor nothing is known. */
pendres_arrival pendres_arrival_at(const pendres_pendulum *p, double x, double v);

/* A stable orbit as an attractor, without a trapping ellipse. */
pendres_attractor pendres_arrival_orbit(const pendres_orbit *o);

/* A pendulum on its rotation without a drive. */
pendres_arrival pendres_arrival_turning(const pendres_pendulum *p, const pendres_rotation *r);

/* Whether two attractors at adjacent parameters are the same one, or mirror images of each
   other. */
int pendres_arrival_alike(const pendres_attractor *a, const pendres_attractor *b);

/* Settle one pendulum, with this care where averages tell. If it is on no closed orbit it is
   advanced further, so that its state is on its attractor. */
pendres_status pendres_arrival_find(pendres_context *ctx, const pendres_pendulum *p, double x,
                                    double v, pendres_lyapunov_care care, pendres_arrival *out);

/* The same where it is asked what it settles on, not how strong a chaos is. */
pendres_status pendres_arrival_name(pendres_context *ctx, const pendres_pendulum *p, double x,
                                    double v, pendres_arrival *out);

/* The same of n pendulums, at most PENDRES_ARRIVALS, from their states. Where averages tell, of the
   orbits that several come to points and rough amplitudes are known. They are not advanced: see
   pendres_arrival_end(). */
pendres_status pendres_arrivals_name(pendres_context *ctx, size_t n, pendres_lyapunov_care care,
                                     pendres_arrival *s);

/* Measure the orbit that one of these has come to, and advance it. */
pendres_status pendres_arrival_end(pendres_context *ctx, pendres_arrival *s);

/* Find what n pendulums settle on, which may rotate without a lock to the drive and start close to
   such rotations. Of the orbits that others than the first come to points alone are known. */
pendres_status pendres_arrivals_turning(pendres_context *ctx, size_t n, pendres_arrival *s);

#endif
