/* turns.h -- differences of angles. */
#ifndef PENDRES_TURNS_H
#define PENDRES_TURNS_H

#include <math.h>

/* A difference of angles without the whole turns in it: half a turn at most, either way. */
static inline double pendres_less_turns(double difference, double turn)
{
  return difference - turn * rint(difference / turn);
}

#endif
