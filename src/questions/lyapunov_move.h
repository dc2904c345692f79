/*
 * lyapunov_move.h -- verdicts on many pendulums, and their states in the end.
 *
 * Owns: the parts of lyapunov.h that a slow sweep needs.
 */
#ifndef PENDRES_LYAPUNOV_MOVE_H
#define PENDRES_LYAPUNOV_MOVE_H

#include <pendres/lyapunov.h>

/* Whether a pendulum may have a rotation that is not locked to the drive: lyapunov.h says which do
   not. */
int pendres_lyapunov_may_rotate(const pendres_pendulum *p);

/* How much work is done for a verdict. */
typedef enum pendres_lyapunov_care {
  PENDRES_CARE_FULL, /* as pendres_lyapunov_find, with two further averages, the longest ones */
  PENDRES_CARE_ONCE, /* one average; a pendulum that it does not decide about is unresolved */
  PENDRES_CARE_CLOSE /* pendulums next to rotations that are not locked, which are told sooner */
} pendres_lyapunov_care;

/* As pendres_lyapunov_find with its defaults but for `care`, for pendulums that have been checked.
   x[n] and v[n] become states at drive phase 0 that the pendulums are in at the end, less whole
   turns, and orbit[n] the orbits that they have come to: of period 0 where there is none. */
pendres_status pendres_lyapunov_move(pendres_context *ctx, size_t n, const pendres_pendulum *p,
                                     double *x, double *v, pendres_lyapunov_care care,
                                     pendres_lyapunov *out, pendres_orbit *orbit);

#endif
