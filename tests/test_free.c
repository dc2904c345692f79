/*
 * test_free.c -- the free pendulum by integration against the elliptic integral, and the energy
 * of undamped motion over ten thousand periods.
 *
 * The reference is pendres_free_frequency(), which test_pendulum.c checks on its own, together with
 * its error.
 */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include <pendres/pendres.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static const double pi = 3.14159265358979323846;

static pendres_context *context(const pendres_options *options)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(options, &ctx));
  return ctx;
}

/* Integrated against exact: within `bound` relative, and within ten times the error claimed. */
static void check_amplitudes(const pendres_options *options, size_t n, const double *amplitude,
                             double bound)
{
  pendres_context *ctx = context(options);
  double *frequency = malloc(2 * n * sizeof *frequency), *error = frequency + n;
  assert_non_null(frequency);
  check_ok(pendres_free_find(ctx, n, amplitude, frequency, error));
  for (size_t i = 0; i < n; i++) {
    pendres_free f;
    pendres_free_get(amplitude[i], &f);
    const double exact = f.frequency, own = f.frequency_error;
    check_near(frequency[i], exact, bound * exact + own);
    check_near(frequency[i], exact, 10.0 * error[i] + own);
  }
  free(frequency);
  pendres_context_free(ctx);
}

/* The promise: the period within 1e-11 of the elliptic integral up to amplitude 3.1. */
static void test_elliptic(void **state)
{
  enum { N = 311 };
  const pendres_options options = { .tolerance = 1e-12 };
  double amplitude[N];
  (void)state;
  for (int i = 0; i < N; i++) amplitude[i] = 3.1 * (i + 1) / N;
  check_amplitudes(&options, N, amplitude, 1e-11);
}

/* At each tolerance the error is within it (rounding: see the amplitudes). */
static void test_tolerances(void **state)
{
  static const double tolerance[] = { 1e-3, 1e-5, 1e-8, 1e-10, 1e-12, 1e-13 };
  static const double amplitude[] = { 0.01, 0.5, 1.0, 2.0, 2.5, 3.0 };
  (void)state;
  for (size_t i = 0; i < COUNT(tolerance); i++) {
    const pendres_options options = { .tolerance = tolerance[i] };
    check_amplitudes(&options, COUNT(amplitude), amplitude, tolerance[i]);
  }
}

/* Near the separatrix rounding takes over: a change of the start by one unit in the last place
   changes the quarter period by about 4e-16 / (pi - a), and each step adds another. */
static void test_separatrix(void **state)
{
  const pendres_options options = { .tolerance = 1e-12 };
  (void)state;
  for (int k = 3; k <= 12; k++) {
    const double distance = pow(10.0, -k), amplitude = pi - distance;
    check_amplitudes(&options, 1, &amplitude, 1e-12 + 1e-15 / distance);
  }
}

/* Small oscillations: 1 - a^2/16, down to amplitudes whose squares vanish. */
static void test_small(void **state)
{
  static const double amplitude[] = { 1e-300, 1e-100, 1e-30, 1e-8, 1e-4 };
  const pendres_options options = { .tolerance = 1e-12 };
  (void)state;
  check_amplitudes(&options, COUNT(amplitude), amplitude, 1e-12);
}

static void test_methods(void **state)
{
  static const double amplitude[] = { 0.01, 1.0, 2.5, 3.1 };
  (void)state;
  for (int m = 0; m < PENDRES_METHOD_COUNT; m++) {
    const pendres_options options = { .method = (pendres_method)m, .tolerance = 1e-9 };
    /* Multistep methods add up hundreds of steps' errors of 1e-9, relative to one radian. */
    check_amplitudes(&options, COUNT(amplitude), amplitude, m == PENDRES_BLOCK_FIXED ? 1e-9 : 1e-6);
  }
  for (int t = 0; t < PENDRES_TABLE_COUNT; t++) {
    const pendres_options options = { .table = (pendres_table)t, .tolerance = 1e-10 };
    check_amplitudes(&options, COUNT(amplitude), amplitude, 1e-10);
  }
}

/* Each amplitude gives the same bits alone as among others, whatever the block. */
static void test_neighbours(void **state)
{
  enum { N = 50 };
  const pendres_options small = { .block_lanes = 8 };
  pendres_context *ctx = context(NULL), *other = context(&small);
  double amplitude[N], frequency[N], error[N];
  (void)state;
  for (int i = 0; i < N; i++) amplitude[i] = 3.1415 * (i + 1) / N;
  check_ok(pendres_free_find(ctx, N, amplitude, frequency, error));
  for (int i = 0; i < N; i++) {
    double alone = 0.0, alone_error = 0.0;
    check_ok(pendres_free_find(other, 1, &amplitude[i], &alone, &alone_error));
    assert_memory_equal(&alone, &frequency[i], sizeof alone);
    assert_memory_equal(&alone_error, &error[i], sizeof alone_error);
  }
  pendres_context_free(ctx);
  pendres_context_free(other);
}

static int always(void *arg)
{
  ++*(int *)arg;
  return 1;
}

static void test_refusals(void **state)
{
  static const double bad[] = { 0.0, -1.0, 3.2, NAN, INFINITY };
  pendres_context *ctx = context(NULL);
  double amplitude[2] = { 1.0, 0.0 }, frequency[2], error[2];
  int asked = 0;
  (void)state;
  for (size_t i = 0; i < COUNT(bad); i++) {
    amplitude[1] = bad[i];
    assert_int_equal(pendres_free_find(ctx, 2, amplitude, frequency, error),
                     PENDRES_INVALID_ARGUMENT);
    assert_non_null(strstr(pendres_context_message(ctx), "amplitude 1"));
  }
  check_ok(pendres_free_find(ctx, 0, NULL, NULL, NULL));
  assert_int_equal(pendres_free_find(NULL, 1, amplitude, frequency, error),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_free_find(ctx, 1, amplitude, NULL, error),
                   PENDRES_INVALID_ARGUMENT);
  pendres_context_set_interrupt(ctx, always, &asked);
  assert_int_equal(pendres_free_find(ctx, 1, amplitude, frequency, error),
                   PENDRES_INTERRUPTED);
  assert_true(asked > 0);
  pendres_context_free(ctx);
}

/*
 * Energy of the undamped, undriven pendulum after thousands of its own periods. The error of the
 * state bounds it: |dE| <= |y'| d(y') + |sin y| d(y) <= 2.4 tolerance. More steps are not taken
 * than show in one period's rounding, some 2e-15, which may add up as long.
 */
static void test_energy(void **state)
{
  static const struct { double tolerance; long periods; } cases[] = { { 1e-8, 10000 },
                                                                      { 1e-12, 1000 } };
  const double amplitude = 2.0;
  (void)state;
  for (size_t i = 0; i < COUNT(cases); i++) {
    const pendres_options options = { .tolerance = cases[i].tolerance };
    pendres_context *ctx = context(&options);
    const pendres_pendulum p = { .drive_frequency = pendres_free_frequency(amplitude) };
    double x = 0.5 * pi + amplitude, v = 0.0;
    const double before = pendres_pendulum_energy(&p, x, v);
    check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, cases[i].periods, NULL));
    const double drift = pendres_pendulum_energy(&p, x, v) - before;
    print_message("tolerance %.0e: energy error after %ld periods %.1e\n", cases[i].tolerance,
                  cases[i].periods, drift);
    check_near(drift, 0.0, 2.4 * cases[i].tolerance + 2e-15 * (double)cases[i].periods);
    pendres_context_free(ctx);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_elliptic),   cmocka_unit_test(test_tolerances),
    cmocka_unit_test(test_separatrix), cmocka_unit_test(test_small),
    cmocka_unit_test(test_methods),    cmocka_unit_test(test_neighbours),
    cmocka_unit_test(test_refusals),   cmocka_unit_test(test_energy),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
