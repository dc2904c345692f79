/*
 * benchmark.h -- one method at one tolerance on a work unit: how far off it is, how fast, and how
 * far off it believes to be.
 *
 * Owns: the names of methods in decks, and how a method is timed. Errors are measured against the
 * unit's references. Members that amplify an error of their start more than BENCHMARK_WILD-fold
 * are left out of the largest error, as no method could help them; the estimate beside the error is
 * judged for all members, as it is to say so itself.
 *
 * Methods with one problem a pendulum are hundreds of times slower than blocks and get
 * BENCHMARK_FEW pendulums, spread over the unit: a pendulum's cost does not depend on the others,
 * and the largest error of fewer is smaller, if anything.
 *
 * Work units are pendulums whose states after 10 and 100 drive periods are known in extended
 * precision:
 *
 *   ensemble  200 starts at rest over one period of the potential; damping 0.12, drive period 8,
 *             drive amplitude 0.2, where a small and a large oscillation coexist
 *   sweep     1000 pendulums, each its own drive frequency in (0.6, 1.2), damping in (0.06, 1) and
 *             start at rest; drive amplitude 0.2. Evenly spread by the additive recurrence of the
 *             plastic number (M. Roberts, The unreasonable effectiveness of quasirandom sequences)
 */
#ifndef BENCHMARK_H
#define BENCHMARK_H

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

enum { BENCHMARK_FEW = 20, BENCHMARK_WILD = 1000 };

typedef struct benchmark {
  double error[WORK_UNIT_MARKS]; /* largest, of x and v */
  double estimate;               /* largest, at the last mark; NaN where a method gives none */
  double honesty, padding;       /* least and median of estimate / error over all members */
  double steps, rhs;             /* a pendulum and period */
  double seconds, spread;        /* processor time of the thread, in which others on the machine do
                                    not count: of the best run; of the next best over it */
  double throughput;             /* pendulum-periods a second */
  size_t pendulums;              /* that were run */
  char failure[256];             /* why there are no figures (all of them NaN); "" */
} benchmark;

/* How methods are run. */
typedef struct benchmark_rules {
  double tolerance;
  int block_lanes;         /* as in pendres_options */
  int (*stop)(void *arg);  /* asked now and then; may be NULL */
  void *stop_arg;
} benchmark_rules;

/*
 * Run it on the calling thread. A method that refuses or gives up is a finding, not a failure:
 * PENDRES_OUT_OF_MEMORY, PENDRES_INTERRUPTED (asked by stop(stop_arg)) and nothing else.
 */
pendres_status benchmark_run(const work_unit *unit, const char *name, const benchmark_rules *rules,
                             benchmark *c);

#endif
