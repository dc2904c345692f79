/*
 * orbit_pair.h -- the coarser of the two computations that an orbit's errors come from.
 *
 * Errors of two numbers of an orbit may be correlated: where finite steps shift a resonance, they
 * shift both its peak and the phase lag. The error of such a pair follows from its values in both
 * computations, not from the errors of the two numbers.
 */
#ifndef PENDRES_ORBIT_PAIR_H
#define PENDRES_ORBIT_PAIR_H

#include <pendres/orbit.h>

typedef struct pendres_orbit_coarser {
  double cosine, sine; /* the first harmonic, as in orbit.h */
  double loop_area_slope;
  double rounding;       /* rounding error of the finer computation in angles along the orbit */
  double slope_rounding; /* and in the slope */
} pendres_orbit_coarser;

/* pendres_orbit_find with slopes; coarser[n] is NaN where there is no orbit. */
pendres_status pendres_orbit_refine_pair(pendres_context *ctx, size_t n,
                                         const pendres_orbit_guess *guess, pendres_orbit *out,
                                         pendres_orbit_coarser *coarser, pendres_status *outcome);

/* pendres_orbit_find where guesses of one pendulum lie one after another, and several of them may
   lead to one orbit: that is measured once, for the first of them, and the others have the outcome
   PENDRES_NOT_CONVERGED. */
pendres_status pendres_orbit_find_once(pendres_context *ctx, size_t n,
                                       const pendres_orbit_guess *guess, pendres_orbit *out,
                                       pendres_status *outcome);

/* pendres_orbit_find for those who ask for points at phase 0 and multipliers alone, at a third of
   the cost: no measure of the orbits is set. */
pendres_status pendres_orbit_find_points(pendres_context *ctx, size_t n,
                                         const pendres_orbit_guess *guess, pendres_orbit *out,
                                         pendres_status *outcome);

#endif
