/*
 * recurrence.h -- strobe points that return close to earlier ones.
 *
 * Owns: guessing the period and winding of an orbit that a motion is near, from all of its latest
 * points. Where there are millions of motions one point of each is compared with instead
 * (exponents/lyapunov_runner.h).
 */
#ifndef PENDRES_RECURRENCE_H
#define PENDRES_RECURRENCE_H

#include "settling/attractor_set.h"

enum { PENDRES_RECURRENCE_POINTS = 129 /* at most: one more than the longest period */ };

/* The latest strobe points of a motion, angles with their whole turns: a ring buffer. */
typedef struct pendres_recurrence {
  long filled; /* points ever recorded */
  long length; /* of the buffer */
  const double *y, *w;
} pendres_recurrence;

/*
 * The shortest period after which the distance of the latest strobe point from an earlier one is
 * about as small as it ever is. A period above 32 counts only if the points are very close, since
 * among many points some are close by chance. *out is a guess of the orbit, but for its set.
 * Returns 0 if none is close.
 */
int pendres_recurrence_find(const pendres_recurrence *r, double turn, pendres_initial_guess *out);

#endif
