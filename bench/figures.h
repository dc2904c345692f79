/*
 * figures.h -- figures of a benchmark that any machine can compare with the last release's: counts,
 * and ratios of times within one run.
 *
 * `make bench` names a file in BENCH_FIGURES, to which a line each is added:
 * name, value, which way is better ('<' or '>'), and the fraction by which it may get worse.
 * compare.sh reads it. Without BENCH_FIGURES nothing is written.
 */
#ifndef FIGURES_H
#define FIGURES_H

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

/* Counts are the same on every machine, but for what libm's last digits change. */
static const double bench_count = 0.02;
/* Ratios of times of programs that take turns: what other work on a machine does to them. */
static const double bench_ratio = 0.15;

/* The name as in printf. */
__attribute__((format(printf, 4, 5))) static inline void bench_figure(double value, char better,
                                                                      double tolerance,
                                                                      const char *name, ...)
{
  const char *path = getenv("BENCH_FIGURES");
  FILE *f = path != NULL && *path != '\0' ? fopen(path, "a") : NULL;
  va_list args;
  if (f == NULL) return;
  va_start(args, name);
  (void)vfprintf(f, name, args);
  va_end(args);
  fprintf(f, " %.6g %c %g\n", value, better, tolerance);
  if (fclose(f) != 0) perror(path);
}

#endif
