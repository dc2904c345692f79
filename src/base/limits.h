/*
 * limits.h -- bounds that several parts of the library share.
 */
#ifndef PENDRES_LIMITS_H
#define PENDRES_LIMITS_H

#include <limits.h>

enum {
  /* Steps per drive period, chosen or asked for: what needs more is refused, with a remedy. */
  PENDRES_MOST_STEPS = 1000000,
  /* Steps, of all lanes together, between two checks whether to go on: they take some hundredths of
     a second. */
  PENDRES_STEPS_BETWEEN_CHECKS = 300000,
  /* Steps that ARKODE or CVODE may take in one call: a bound that is never the reason to stop. */
  PENDRES_MOST_SOLVER_STEPS = 100000000,
  /* Lanes of doubles begin on the boundaries of cache lines, which the widest vectors need. */
  PENDRES_ALIGN = 64
};

/* A double beyond this does not hold a position to a tenth of a radian, and whole turns have to fit
   into a long, which has 32 bits on some machines. */
static const double pendres_farthest = LONG_MAX > 2147483647L ? 1e15 : 2147483647.0;

#endif
