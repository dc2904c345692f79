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
 */
#ifndef BENCHMARK_H
#define BENCHMARK_H

#include "validation/work_unit.h"

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
