/*
 * recurrence.h -- strobe points that return close to earlier ones.
 *
 * Owns: guessing the period and winding of an orbit that a motion is near.
 */
#ifndef PENDRES_RECURRENCE_H
#define PENDRES_RECURRENCE_H

enum { PENDRES_RECURRENCE_POINTS = 129 /* at most: one more than the longest period */ };

typedef struct pendres_recurrence {
  double y, w;         /* the latest point */
  int period, winding; /* of the orbit that it may be near */
} pendres_recurrence;

/*
 * The shortest period after which the distance of the latest strobe point from an earlier one is
 * about as small as it ever is. y[] and w[] are the points, the latest last, and angles have their
 * whole turns. A period above 32 counts only if the points are very close, since among many points
 * some are close by chance. Returns 0 if none is close.
 */
int pendres_recurrence_find(int points, double turn, const double *y, const double *w,
                            pendres_recurrence *out);

#endif
