/*
 * lyapunov_job.h -- pendulums to be judged.
 *
 * Owns: what is asked about them, and where they and their verdicts are.
 */
#ifndef PENDRES_LYAPUNOV_JOB_H
#define PENDRES_LYAPUNOV_JOB_H

#include "settling/exponents/lyapunov_move.h"
#include "settling/exponents/lyapunov_runner.h"

/* Pendulums to be judged; arrays are side by side. */
typedef struct pendres_lyapunov_job {
  size_t n;
  const pendres_pendulum *pendulum; /* checked */
  const double *x, *v;              /* starts */
  double accuracy;                  /* error a period on the way from the start */
  const double *each;               /* the same of each pendulum; NULL: of all */
  long transient, periods;          /* 0: as is best; of the first average */
  long longer;                      /* periods by which what may be chaos is followed further, by
                                       its states alone, before it is averaged */
  int asked;                        /* number of periods, by the caller */
  int rounds;
  int coarse;                       /* the first average: as exact as what is followed. Sweeps come
                                       next to folds, beyond which such steps may be */
  int few;                          /* they are so few that they should have equal steps */
  size_t copies;                    /* of one pendulum each, side by side; 0: they are no copies */
  const pendres_orbit *known;       /* of copies: orbits that those are on which they are copies
                                       of; of period 0 if on none */
  pendres_lyapunov_care care;
  pendres_runner *runner;           /* room; they stay where they are in the end */
  pendres_orbit *orbit;             /* that runners are on; NULL: not wanted */
  int points;                       /* nothing else of orbits is wanted (orbits/orbit_pair.h) */
  pendres_settled *out;            /* certain where the error of the integration stayed small */
} pendres_lyapunov_job;

#endif
