/* reference_fixture.h -- what the tests of the reference share. */
#ifndef REFERENCE_FIXTURE_H
#define REFERENCE_FIXTURE_H

#include "check.h"

#include <float.h>
#include <string.h>

#include "oracle/reference.h"

#include "golden.h"
#include "oracle/taylor.h"

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static const long double pi = 3.14159265358979323846264338327950288L;

/* |got - want| <= tolerance in long double, both finite. */
#define check_long(got, want, tolerance) \
  check_long_at((got), (want), (tolerance), #got, __FILE__, __LINE__)

static inline void check_long_at(long double got, long double want, long double tolerance,
                                 const char *what, const char *file, int line)
{
  if (fabsl(got - want) <= tolerance) return;
  print_error("%s:%d: %s = %.21Lg, wanted %.21Lg +- %.3Lg (off by %.3Lg)\n", file, line, what,
              got, want, tolerance, got - want);
  fail();
}

/* Distance from 1 to the next number, as arithmetic really does it. */
static inline long double epsilon(void)
{
  volatile long double step = 1.0L, sum;
  do {
    step = step * 0.5L;
    sum = 1.0L + step;
  } while (sum > 1.0L);
  return 2.0L * step;
}

/* The same, but not below that of golden.h, which was made with 64 bits. */
static inline long double golden_epsilon(void)
{
  return fmaxl(epsilon(), 0x1p-63L);
}

static inline pendres_pendulum make(double damping, double drive_amplitude, double drive_frequency)
{
  return (pendres_pendulum){ damping, drive_amplitude, drive_frequency, 0.0 };
}

#endif
