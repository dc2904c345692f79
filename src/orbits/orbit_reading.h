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

/* One computation of an orbit: what the run of a candidate found. */
typedef struct pendres_orbit_computed {
  double y, w;          /* at phase 0 */
  double off[2];        /* from the point at which m was taken to that */
  double m[2][2];       /* derivative of the map over the period by y and w */
  double m_by[2][2][2]; /* how that changes with y and w: of the coarser of two */
  pendres_newton_noise noise; /* of the finer of two */
  pendres_orbit_measures measures;
} pendres_orbit_computed;

/*
 * The caller's function for the run of one candidate: it writes one y and one w for each sample,
 * and may change where the orbit is, which is the candidate's own point before. 0 if this is not an
 * orbit; the candidate's state then becomes PENDRES_NEWTON_FAILED.
 */
typedef int pendres_orbit_taker(void *arg, const pendres_newton_candidate *c,
                                const pendres_newton_samples *taken, double *y, double *w,
                                pendres_orbit_computed *out);

typedef struct pendres_orbit_reader {
  pendres_orbit_want want;
  int bends; /* whether candidates get m_by as well, for which they have no noise */
  int points; /* without samples and measures */
  pendres_orbit_taker *take;
  void *arg;
  pendres_orbit_computed *out; /* by the candidates' indices */
} pendres_orbit_reader;

/* Run and measure the converged ones of n candidates, which are reordered. */
pendres_status pendres_orbit_read(pendres_context *ctx, const pendres_orbit_reader *reader,
                                  size_t n, pendres_newton_candidate *c);

#endif
