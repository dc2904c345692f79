/* angles.h -- a turn, half of it and a quarter, in radians; differences of angles. */
#ifndef PENDRES_ANGLES_H
#define PENDRES_ANGLES_H

#include <math.h>

#include <pendres/pendulum.h>

static const double two_pi = 2.0 * PENDRES_PI, pi = PENDRES_PI, half_pi = 0.5 * PENDRES_PI;

/* An irrational share of a turn: of starts at its multiples about a point no two are at the same
   place. */
static const double golden_angle = 2.39996322972865332;

/* A difference of angles, reduced by whole turns to at most half a turn either way. */
static inline double pendres_less_turns(double difference, double turn)
{
  /* Most need neither the division nor the rounding. */
  return fabs(difference) <= 0.5 * turn ? difference : difference - turn * rint(difference / turn);
}

#endif
