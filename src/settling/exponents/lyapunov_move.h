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
  PENDRES_CARE_FULL,  /* as pendres_lyapunov_find */
  PENDRES_CARE_LABEL, /* the same, but for how well the mean of a rotation is known: well enough to
                         tell that it is one */
  PENDRES_CARE_ONCE, /* one average; a pendulum that it does not decide about is unresolved */
  PENDRES_CARE_CLOSE /* pendulums next to rotations that are not locked, which are recognised
                        sooner */
} pendres_lyapunov_care;

/* Pendulums that are moved: arrays side by side, all the caller's. */
typedef struct pendres_lyapunov_motion {
  size_t n;
  const pendres_pendulum *pendulum;
  double *x, *v;         /* starts; they become states at drive phase 0 that the pendulums are
                            in at the end, with the turns that they have made */
  pendres_settled *out; /* what they do, and ... */
  pendres_orbit *orbit;  /* ... the orbits that they have come to; of period 0 if to none */
  int points;            /* nothing else of orbits is wanted (orbits/orbit_pair.h) */
} pendres_lyapunov_motion;

/* As pendres_lyapunov_find with its defaults but for `care`, for pendulums that have been
   checked. */
pendres_status pendres_lyapunov_move(pendres_context *ctx, const pendres_lyapunov_motion *m,
                                     pendres_lyapunov_care care);

#endif
