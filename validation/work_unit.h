/*
 * work_unit.h -- pendulums to measure methods with, and where they really go.
 *
 * Owns: the two work units and their states after 10 and 100 drive periods in extended precision.
 *
 *   ensemble  200 starts at rest over one period of the potential; damping 0.12, drive period 8,
 *             drive amplitude 0.2, where a small and a large oscillation coexist
 *   sweep     1000 pendulums, each its own drive frequency in (0.6, 1.2), damping in (0.06, 1) and
 *             start at rest; drive amplitude 0.2. Evenly spread by the additive recurrence of the
 *             plastic number (M. Roberts, The unreasonable effectiveness of quasirandom sequences)
 */
#ifndef WORK_UNIT_H
#define WORK_UNIT_H

#include "farm/farm.h"

enum { WORK_UNIT_MARKS = 2 };

/* Drive periods after which errors are measured: 10 and 100. */
extern const long work_unit_periods[WORK_UNIT_MARKS];

typedef struct work_unit {
  size_t n;
  pendres_pendulum *pendulum;
  double *x;              /* starts; velocities are 0 */
  /* Of each mark, after work_unit_periods[mark] drive periods: */
  long double *angle[WORK_UNIT_MARKS];    /* y = x - pi/2, whole turns and all */
  long double *velocity[WORK_UNIT_MARKS];
  double *growth[WORK_UNIT_MARKS];        /* largest entry of the derivative by the start */
} work_unit;

/* By name, "ensemble" or "sweep"; w must be all zero. Without references. */
pendres_status work_unit_make(const char *name, work_unit *w);
void work_unit_free(work_unit *w);

/* The references, by the farm's threads; failures are in its message. */
pendres_status work_unit_refer(work_unit *w, farm *f);

/* Pendulum number k of `some` that stand for all, evenly chosen. */
size_t work_unit_pick(const work_unit *w, size_t some, size_t k);

/* Error of a state (x, v) of pendulum i at a mark: the larger of both; infinite for NaN, which no
   maximum over pendulums would notice. */
double work_unit_error(const work_unit *w, size_t i, int mark, double x, double v);

#endif
