/*
 * circle_turn.h -- what a rotation does in the long run, from what a period does on its circle.
 *
 * Owns: a map of the circle as a table, its rotation number with its error, and whether the motion
 * on it is locked to the drive. Nothing is integrated: a step of the map takes nanoseconds.
 *
 * Rotation numbers are weighted Birkhoff averages, over four orbits that start apart: how far their
 * means differ is the error (Das, Saiki, Sander and Yorke, Nonlinearity 30 (2017) 4111). A lock to
 * q periods is a place that the map brings back in q steps and p turns; there is one exactly if the
 * q-th iterate less p turns moves some places forwards and others backwards. All that is in doubt
 * are places that it moves by less than it is wrong by.
 */
#ifndef PENDRES_CIRCLE_TURN_H
#define PENDRES_CIRCLE_TURN_H

#include "questions/circle.h"

enum { PENDRES_CIRCLE_LONGEST = 128 }; /* periods of a lock that is looked for */

/* The map of a circle, and weights of averages: handed from one call to the next. */
typedef struct pendres_circle_table pendres_circle_table;

/* NULL without memory. */
pendres_circle_table *pendres_circle_table_create(void);
void pendres_circle_table_free(pendres_circle_table *t);

/* Put the map y -> y + move(y) there; `error` bounds what it is wrong by anywhere, and `wrong`, of
   no more coefficients, is a guess of what it is wrong by besides, at every angle. */
void pendres_circle_table_set(pendres_circle_table *t, const pendres_trigonometric *move,
                              double error, const pendres_trigonometric *wrong);

typedef enum pendres_circle_motion {
  PENDRES_CIRCLE_UNKNOWN, /* by the end of a lock, closer than can be told */
  PENDRES_CIRCLE_UNLOCKED,
  PENDRES_CIRCLE_LOCKED
} pendres_circle_motion;

typedef struct pendres_circle_turn {
  pendres_circle_motion motion;
  double turns, turns_error;   /* a period */
  double growth;               /* of a tangent vector's logarithm a period, unlocked only: what was
                                  found in place of zero */
  int period, winding;         /* of a lock */
  double y;                    /* an angle on the stable orbit of a lock */
} pendres_circle_turn;

pendres_circle_turn pendres_circle_table_turn(pendres_circle_table *t);

/*
 * How far the least moved place goes in q steps less p turns, as seen from ahead (sign 1: the
 * smallest shift) or behind (sign -1: the largest one): zero where a lock begins or ends.
 * *worth becomes what an error of the map counts therein.
 */
double pendres_circle_table_edge(const pendres_circle_table *t, int q, int p, int sign,
                                 double *worth);

#endif
