/*
 * test_mean.c -- means over time with smooth weights: of a rotation by an irrational angle, whose
 * mean is 0, and of the logistic map in chaos, whose mean is 1/2.
 */
#include <math.h>

#include "check.h"
#include "orbits/mean.h"

static const double two_pi = 6.28318530717958647693;

/* A function of an angle with all harmonics, whose mean is 0, along a rotation. */
static pendres_mean rotation(double turns, double from, long n)
{
  pendres_mean m = {.sum = {0.0}};
  for (long k = 0; k < n; k++) {
    const pendres_mean_weights w = pendres_mean_weights_at(k, n);
    const double y = two_pi * fmod(from + turns * (double)k, 1.0);
    pendres_mean_add(&m, &w, 3.0 / (5.0 - 4.0 * cos(y)) - 1.0);
  }
  return m;
}

static pendres_mean logistic(double x, long n)
{
  pendres_mean m = {.sum = {0.0}};
  for (long k = 0; k < n; k++, x = 4.0 * x * (1.0 - x)) {
    const pendres_mean_weights w = pendres_mean_weights_at(k, n);
    pendres_mean_add(&m, &w, x);
  }
  return m;
}

/* By how many turns a rotation passes the nearest fraction of small numbers in so many steps. */
static double passes(double turns, long n)
{
  double least = INFINITY;
  for (int q = 1; q <= 32; q++) least = fmin(least, fabs(turns * q - rint(turns * q)));
  return least * (double)n;
}

/* Errors are below what is claimed, and not far below. */
static void claims(void **state)
{
  enum { N = 200, LENGTH = 512 };
  int all = 0, below = 0, idle = 0;
  (void)state;
  for (int i = 0; i < N; i++) {
    double error = 0.0;
    const double turns = sqrt(2.0 + i) + 0.001 * i;
    if (passes(turns, LENGTH) < 3.0) continue;
    const pendres_mean m = rotation(turns, 0.618034 * i, LENGTH);
    all++;
    const double mean = fabs(pendres_mean_take(&m, &error));
    below += mean <= error + 1e-14;
    idle += mean < error / 100.0 && error > 1e-12;
  }
  assert_true(all > N / 4 && below >= all - all / 20);
  assert_true(idle < all / 2);
}

/* Twice the time gives more than twice the digits on a rotation; in chaos four times the time gives
   half the error. */
static void digits(void **state)
{
  double error = 0.0, most = 0.0, least = 1.0;
  (void)state;
  const double golden = 0.5 * (sqrt(5.0) - 1.0);
  pendres_mean m = rotation(golden, 0.1, 1024);
  check_near(pendres_mean_take(&m, &error), 0.0, 1e-12);
  assert_true(error < 1e-11);
  for (int i = 0; i < 20; i++) {
    m = logistic(0.1 + 0.0371 * i, 1024);
    check_near(pendres_mean_take(&m, &error), 0.5, 0.1);
    most = fmax(most, error);
    least = fmin(least, error);
  }
  assert_true(most < 0.1 && least > 1e-3);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(claims),
    cmocka_unit_test(digits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
