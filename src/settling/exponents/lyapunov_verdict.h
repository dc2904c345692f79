/*
 * lyapunov_verdict.h -- what each of many pendulums does in the long run: an orbit, a rotation,
 * chaos.
 *
 * Owns: the verdict on what was seen of each, and whether it is followed further (how long is in
 * lyapunov.c).
 */
#ifndef PENDRES_LYAPUNOV_VERDICT_H
#define PENDRES_LYAPUNOV_VERDICT_H

#include "settling/exponents/lyapunov_job.h"

pendres_status pendres_lyapunov_judge(pendres_context *ctx, const pendres_lyapunov_job *j);

#endif
