/*
 * circle_turn.h -- the motion of a rotation in the long run, from the map of a period on its
 * circle.
 *
 * Owns: a map of the circle as a table, its rotation number with its error, and whether the motion
 * on it is locked to the drive. Nothing is integrated: a step of the map takes nanoseconds.
 *
 * Rotation numbers are weighted Birkhoff averages over four orbits with different starts; their
 * scatter is the error (Das, Saiki, Sander and Yorke, Nonlinearity 30 (2017) 4111). In a lock to q
 * periods the map brings some point back after q steps and p turns. There is one exactly if the
 * q-th iterate less p turns moves some points forwards and others backwards. This is in doubt only
 * where it moves points by less than the error of the map.
 */
#ifndef PENDRES_CIRCLE_TURN_H
#define PENDRES_CIRCLE_TURN_H

#include "analysis/sweeps/circle.h"

enum { PENDRES_CIRCLE_LONGEST = 128 }; /* the most periods of a lock that is searched for */

/* The map of a circle and the weights of averages. */
typedef struct pendres_circle_table pendres_circle_table;

/* NULL if there is no memory. */
pendres_circle_table *pendres_circle_table_create(void);
void pendres_circle_table_free(pendres_circle_table *t);

/* Set the map y -> y + move(y). `error` bounds its error at any angle; `wrong`, which has no more
   coefficients, is a guess of the rest of its error as a function of the angle. */
void pendres_circle_table_set(pendres_circle_table *t, const pendres_trigonometric *move,
                              double error, const pendres_trigonometric *wrong);

typedef enum pendres_circle_motion {
  PENDRES_CIRCLE_UNKNOWN, /* too close to the end of a lock to decide */
  PENDRES_CIRCLE_UNLOCKED,
  PENDRES_CIRCLE_LOCKED
} pendres_circle_motion;

typedef struct pendres_circle_turn {
  pendres_circle_motion motion;
  double turns, turns_error;   /* a period */
  double growth;               /* growth a period of the logarithm of a tangent vector, if unlocked;
                                  it is exactly 0 in theory */
  int period, winding;         /* of a lock */
  double y;                    /* an angle on the stable orbit of a lock */
} pendres_circle_turn;

/* The motion in the long run. */
pendres_circle_turn pendres_circle_table_turn(pendres_circle_table *t);

/*
 * The smallest (sign 1) or the largest (sign -1) displacement of any point by q steps less p turns:
 * zero where a lock begins or ends. *worth receives the factor by which an error of the map enters
 * into it.
 */
double pendres_circle_table_edge(const pendres_circle_table *t, int q, int p, int sign,
                                 double *worth);

#endif
