/*
 * settle_certain.h -- labels that the error of the integration leaves no choice.
 *
 * Owns: what is done about pendulums whose error, as it was carried along, is not small against
 * what tells their fates apart (settle_lanes.c): they are integrated again from their start, more
 * and more exactly, down to rounding. The label of the most exact run counts.
 */
#ifndef PENDRES_SETTLE_CERTAIN_H
#define PENDRES_SETTLE_CERTAIN_H

#include "orbits/settle_lanes.h"

/* A batch that has been labelled, pendulums by their own numbers. */
typedef struct pendres_settle_labelled {
  const pendres_settle_labelling *job; /* doubt must be kept; outcome and doubt may change */
  size_t n;
  const double *x, *v; /* the starts */
  double accuracy;     /* error a period that they were run with */
} pendres_settle_labelled;

/*
 * Make labels certain that are not. Those that stay in doubt at the last, and those that get into
 * no trap when they are run again, keep their latest label, and are not certain.
 *
 * Where errors are not carried, as with adaptive steps, labels are compared with those of fixed
 * steps, and stay what they are; those that agree with a certain one are certain.
 */
pendres_status pendres_settle_certain(pendres_context *ctx, const pendres_settle_labelled *l);

#endif
