/*
 * lyapunov_caught.h -- the orbits that pendulums have come close to.
 *
 * Owns: whether there is a stable orbit where strobe points repeat, and the verdict on a pendulum
 * that is on it.
 */
#ifndef PENDRES_LYAPUNOV_CAUGHT_H
#define PENDRES_LYAPUNOV_CAUGHT_H

#include "settling/exponents/lyapunov_job.h"

/* The verdict on what has come to this orbit. */
void pendres_lyapunov_take_orbit(const pendres_orbit *o, pendres_settled *out);

/* Take the orbits that runners were caught near; a runner goes on where there is no stable orbit
   near it. */
pendres_status pendres_lyapunov_settle_caught(pendres_context *ctx, const pendres_lyapunov_job *j);

#endif
