/*
 * lyapunov_certain.h -- verdicts that rounding cannot change.
 *
 * Owns: what is done about a pendulum whose error was not small on the way to where it has gone. It
 * starts again, as exactly as can be. Where that leaves a doubt, copies of it start as far from it
 * as errors are large; where all of them do the same, the error decides nothing. Otherwise copies
 * start as near as rounding, and as exactly as can be. Where these differ from each other, how far
 * is in the errors.
 */
#ifndef PENDRES_LYAPUNOV_CERTAIN_H
#define PENDRES_LYAPUNOV_CERTAIN_H

#include "analysis/chaos/lyapunov_verdict.h"

/* Go through verdicts that are not certain. The job's runners are where its judgement has left
   them; its orbits are not looked at. */
pendres_status pendres_lyapunov_make_certain(pendres_context *ctx, const pendres_lyapunov_job *job);

#endif
