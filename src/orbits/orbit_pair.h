/*
 * orbit_pair.h -- the coarser of the two computations that an orbit's errors come from.
 *
 * Two numbers of an orbit are off together: where steps shift a resonance, they shift its peak and
 * the phase lag alike. What both computations make of such a pair tells how well it is known;
 * the errors of its two numbers do not.
 */
#ifndef PENDRES_ORBIT_PAIR_H
#define PENDRES_ORBIT_PAIR_H

#include <pendres/orbit.h>

typedef struct pendres_orbit_coarser {
  double cosine, sine; /* the first harmonic, as in orbit.h */
  double loop_area_slope;
  double rounding;       /* of the finer one: what it makes of angles along the orbit */
  double slope_rounding; /* and of the slope */
} pendres_orbit_coarser;

/* pendres_orbit_refine with slopes; coarser[n] is NaN where there is no orbit. */
pendres_status pendres_orbit_refine_pair(pendres_context *ctx, size_t n,
                                         const pendres_orbit_guess *guess, pendres_orbit *out,
                                         pendres_orbit_coarser *coarser, pendres_status *outcome);

#endif
