/*
 * check.h -- what every test program includes: cmocka and our own comparison
 * of doubles. cmocka's assert_float_equal casts to float and lets NaN pass.
 */
#ifndef CHECK_H
#define CHECK_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

/* Sanitizers make all several times as slow: they see the same code in a shorter run. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { CHECK_SHORT = 1 };
#else
enum { CHECK_SHORT = 0 };
#endif

/* |got - want| <= tolerance, both finite; prints all digits on failure. */
#define check_near(got, want, tolerance)                                       \
  check_near_at((got), (want), (tolerance), #got, __FILE__, __LINE__)

/* The same relative to |want|. */
#define check_relative(got, want, tolerance)                                   \
  check_near_at((got), (want), (tolerance) * fabs(want), #got, __FILE__, __LINE__)

static inline void check_near_at(double got, double want, double tolerance, const char *what,
                                 const char *file, int line)
{
  /* Written so that a NaN anywhere fails. */
  if (fabs(got - want) <= tolerance) return;
  print_error("%s:%d: %s = %.17g, wanted %.17g +- %.3g (off by %.3g)\n", file, line, what, got,
              want, tolerance, got - want);
  fail();
}

/* A status must be PENDRES_OK; prints the context's message otherwise. */
#define check_ok(status) check_ok_at((int)(status), #status, __FILE__, __LINE__)

static inline void check_ok_at(int status, const char *what, const char *file, int line)
{
  if (status == 0) return;
  print_error("%s:%d: %s returned status %d\n", file, line, what, status);
  fail();
}

#endif
