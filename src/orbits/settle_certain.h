/*
 * settle_certain.h -- labels that no error of the integration can change.
 *
 * Owns: the treatment of a pendulum whose propagated error is not small against what separates one
 * outcome from another (settle_lanes.c). It is integrated again from its start, more and more
 * exactly, down to rounding. Of the runs in which the error stayed below what separates outcomes,
 * the most exact one decides about the label.
 */
#ifndef PENDRES_SETTLE_CERTAIN_H
#define PENDRES_SETTLE_CERTAIN_H

#include "orbits/settle_lanes.h"

/* A batch that has been labelled; arrays are by the numbers of its pendulums. */
typedef struct pendres_settle_labelled {
  const pendres_settle_labelling *job; /* error_ratio must be kept; it and outcome may change */
  size_t n;
  const double *x, *v; /* the starts */
  double accuracy;     /* error a period that they were run with */
} pendres_settle_labelled;

/*
 * Make labels certain that are not. Pendulums that are still uncertain after the most exact run,
 * and those that reach no trapping ellipse in a further run, keep their latest label, which is not
 * certain. A further run of a pendulum ends where its error has grown so large that no label can
 * be certain.
 *
 * Where errors are not propagated, as with adaptive steps, labels are not changed but compared with
 * those of fixed steps: those that agree with a certain one are certain.
 */
pendres_status pendres_settle_certain(pendres_context *ctx, const pendres_settle_labelled *l);

#endif
