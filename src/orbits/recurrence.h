/*
 * recurrence.h -- strobe points that come back to where they were.
 *
 * Owns: guessing the period and winding of an orbit that a motion is near.
 */
#ifndef PENDRES_RECURRENCE_H
#define PENDRES_RECURRENCE_H

enum { PENDRES_RECURRENCE_POINTS = 129 /* looked at, at most: the longest period, and one */ };

typedef struct pendres_recurrence {
  double y, w;         /* the latest point */
  int period, winding; /* of the orbit that it may be near */
} pendres_recurrence;

/*
 * The shortest period that the strobe points y[], w[], the latest one last, repeat themselves with
 * about as closely as with any; angles with whole turns. Periods above 32 are found where points
 * come back very closely: by chance some of so many are always close. Returns 0 if they do not
 * come near.
 */
int pendres_recurrence_find(int points, double turn, const double *y, const double *w,
                            pendres_recurrence *out);

#endif
