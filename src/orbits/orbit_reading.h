/*
 * orbit_reading.h -- integrating many orbits over one period each, side by side, and measuring
 * them.
 *
 * Owns: the order of the runs, and the memory for samples.
 */
#ifndef PENDRES_ORBIT_READING_H
#define PENDRES_ORBIT_READING_H

#include "orbits/orbit_measure.h"
#include "orbits/orbit_newton.h"

/*
 * The caller's function for the run of one candidate: it writes one y and one w for each sample,
 * and keeps whatever else it needs. It returns the address for the measures of the samples, or
 * NULL if this is not an orbit; the candidate's state then becomes PENDRES_NEWTON_FAILED.
 */
typedef pendres_orbit_measures *pendres_orbit_taker(void *arg, const pendres_newton_candidate *c,
                                                    const pendres_newton_samples *taken, double *y,
                                                    double *w);

typedef struct pendres_orbit_reader {
  pendres_orbit_want want;
  int bends; /* whether candidates get m_by as well */
  int points; /* without samples and measures */
  pendres_orbit_taker *take;
  void *arg;
} pendres_orbit_reader;

/* Run and measure the converged ones of n candidates, which are reordered. */
pendres_status pendres_orbit_read(pendres_context *ctx, const pendres_orbit_reader *reader,
                                  size_t n, pendres_newton_candidate *c);

#endif
