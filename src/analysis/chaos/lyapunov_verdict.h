/*
 * lyapunov_verdict.h -- what each of many pendulums does in the long run: an orbit, a rotation,
 * chaos.
 *
 * Owns: the verdict on what was seen of each, and whether it is followed further (how long is in
 * lyapunov.c).
 */
#ifndef PENDRES_LYAPUNOV_VERDICT_H
#define PENDRES_LYAPUNOV_VERDICT_H

#include "analysis/chaos/lyapunov_move.h"
#include "analysis/chaos/lyapunov_runner.h"

/* Pendulums to be judged; arrays are side by side. */
typedef struct pendres_lyapunov_job {
  size_t n;
  const pendres_pendulum *pendulum; /* checked */
  const double *x, *v;              /* starts */
  double accuracy;                  /* error a period on the way from the start */
  long transient, periods;          /* 0: as is best; of the first average */
  long longer;                      /* periods by which what may be chaos is followed further, by
                                       its states alone, before it is averaged */
  int asked;                        /* number of periods, by the caller */
  int rounds;
  pendres_lyapunov_care care;
  pendres_runner *runner;           /* room; they stay where they are in the end */
  pendres_orbit *orbit;             /* that runners are on; NULL: not wanted */
  pendres_lyapunov *out;            /* certain where the error of the integration stayed small */
} pendres_lyapunov_job;

pendres_status pendres_lyapunov_judge(pendres_context *ctx, const pendres_lyapunov_job *j);

#endif
