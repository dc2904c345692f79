/*
 * test_free_force.c -- free oscillations under any force, by elliptic functions and by symmetry.
 */
#include "continuation_fixture.h"

#include <pendres/free.h>

#include <gsl/gsl_sf_ellint.h>

/* Elliptic integrals of GSL in double precision: a few units in the last place. */
static const double exact = 2e-15;

static double quarter(double square)
{
  return gsl_sf_ellint_Kcomp(sqrt(square), GSL_PREC_DOUBLE);
}

/* Find one, which is to be known as well as is asked for. */
static pendres_free_oscillation swing_of(pendres_pendulum p, double amplitude)
{
  pendres_context *ctx = context_of(1e-12, PENDRES_TABLE_DEFAULT);
  pendres_status outcome;
  pendres_free_oscillation s;
  check_ok(pendres_free_oscillation_find(ctx, 1, &p, &amplitude, &s, &outcome));
  check_ok(outcome);
  assert_true(s.frequency_error < 1e-12 * fmax(1.0, s.frequency));
  check_near(s.high - s.low, 2.0 * amplitude, 1e-15 * (fabs(s.high) + fabs(s.low) + amplitude));
  pendres_context_free(ctx);
  return s;
}

static void check_frequency(pendres_pendulum p, double amplitude, double want)
{
  const pendres_free_oscillation s = swing_of(p, amplitude);
  check_near(s.frequency, want, s.frequency_error + exact * want);
}

/* x + b x^3: cn or, where it softens, sn, up to close to the separatrix. */
static void duffing_by_elliptic_functions(void **state)
{
  (void)state;
  for (double a = 1e-6; a < 50.0; a *= 3.0) {
    const double square = a * a, rate = 1.0 + 0.7 * square;
    const pendres_pendulum hard = {.force = PENDRES_FORCE_POLYNOMIAL,
                                   .force_coefficients = {1.0, 0.0, 0.7}};
    check_frequency(hard, a, half_pi * sqrt(rate) / quarter(0.35 * square / rate));
  }
  static const double soft[] = {1e-5, 0.1, 0.5, 0.9, 0.99, 0.999};
  for (size_t i = 0; i < sizeof soft / sizeof *soft; i++) {
    const double square = soft[i] * soft[i], rate = 1.0 - 0.5 * square;
    const pendres_pendulum p = {.force = PENDRES_FORCE_POLYNOMIAL,
                                .force_coefficients = {1.0, 0.0, -1.0}};
    check_frequency(p, soft[i], half_pi * sqrt(rate) / quarter(0.5 * square / rate));
  }
}

/* -x + x^3 about its upper well: dn, from sqrt(2 - h^2) to h. */
static void a_well_beside_another(void **state)
{
  (void)state;
  static const double highs[] = {1.001, 1.1, 1.3, 1.41};
  for (size_t i = 0; i < sizeof highs / sizeof *highs; i++) {
    const double h = highs[i], low = sqrt(2.0 - h * h);
    const pendres_pendulum p = {.force = PENDRES_FORCE_POLYNOMIAL,
                                .force_coefficients = {-1.0, 0.0, 1.0}};
    const pendres_free_oscillation s = swing_of(p, 0.5 * (h - low));
    check_near(s.frequency, pi * h / (sqrt(2.0) * quarter(2.0 - 2.0 / (h * h))),
               s.frequency_error + exact);
    check_near(s.low, low, s.turn_error);
    check_near(s.high, h, s.turn_error);
    assert_true(s.turn_error < 1e-12);
    check_near(s.well, 1.0, 1e-11);
  }
}

/* The same up to close below its separatrix, where rounding of the turning points is what counts:
   h - l = 2 a and h^2 + l^2 = 2, and K by arithmetic-geometric means, in extended precision. */
static void close_to_the_separatrix(void **state)
{
  (void)state;
  const pendres_pendulum p = {.force = PENDRES_FORCE_POLYNOMIAL,
                              .force_coefficients = {-1.0, 0.0, 1.0}};
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  for (int i = 1; i <= 60; i++) {
    const double amplitude = 0.70710678 - 1.5e-5 * i * i;
    const long double middle = sqrtl(1.0L - (long double)amplitude * amplitude);
    const long double high = middle + amplitude, low = middle - amplitude;
    long double x = 1.0L, y = low / high;
    for (int k = 0; k < 12; k++) {
      const long double mean = 0.5L * (x + y);
      y = sqrtl(x * y);
      x = mean;
    }
    pendres_free_oscillation s;
    pendres_status outcome;
    check_ok(pendres_free_oscillation_find(ctx, 1, &p, &amplitude, &s, &outcome));
    check_ok(outcome);
    check_near(s.frequency, (double)(sqrtl(2.0L) * x * high), s.frequency_error);
    assert_true(s.frequency_error < 1e-11);
  }
  pendres_context_free(ctx);
}

static void plain_pendulum(void **state)
{
  (void)state;
  static const double amplitudes[] = {1e-4, 0.5, 2.0, 3.0, 3.1};
  for (size_t i = 0; i < sizeof amplitudes / sizeof *amplitudes; i++)
    check_frequency((pendres_pendulum){0}, amplitudes[i], pendres_free_frequency(amplitudes[i]));
}

/* Any force: let go at a turning point, the reference is back there after a period. */
static void any_force_comes_back(void **state)
{
  (void)state;
  static const pendres_pendulum forces[] = {
    {.torque = 0.5},
    {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 1.0}, .torque = 0.05},
    {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {0.0, 0.0, 1.0}},
    {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.2, 0.1, 0.0, 0.3}},
    {.force = PENDRES_FORCE_SQUID, .force_coefficients = {2.0}, .torque = 0.1}};
  static const double amplitudes[] = {0.01, 0.3, 0.6};
  for (size_t i = 0; i < sizeof forces / sizeof *forces * 3; i++) {
    pendres_pendulum p = forces[i / 3];
    const double origin = p.force == PENDRES_FORCE_PENDULUM ? half_pi : 0.0;
    const pendres_free_oscillation s = swing_of(p, amplitudes[i % 3]);
    long double y = (long double)s.high - origin, v = 0.0L;
    const long double start = y;
    p.drive_frequency = s.frequency;
    check_ok(pendres_reference_advance(&p, &y, &v, NULL, 1));
    /* A velocity by the time that is missed, below 5 being the largest rate of its growth here; and
       the rounding of the turning point, by which the period of another swing is meant. */
    const double period = (4.0 * half_pi) / s.frequency;
    const double missed = period * s.frequency_error / s.frequency;
    check_near((double)v, 0.0, 5.0 * missed + 1e-15 * period);
    check_near((double)(y - start), 0.0, 1e-14);
  }
}

/* No well, and amplitudes from the separatrix on. */
static void none(void **state)
{
  (void)state;
  const pendres_pendulum p[] = {
    {.torque = 1.5}, {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0}},
    {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, -1.0}},
    {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0, 0.0, 1.0}},
    {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0, 0.0, 1.0}}, {0}};
  const double amplitude[] = {0.1, 0.1, 1.001, 0.7072, 1e4, 3.15};
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  pendres_free_oscillation s[6];
  pendres_status outcome[6];
  check_ok(pendres_free_oscillation_find(ctx, 6, p, amplitude, s, outcome));
  for (int i = 0; i < 6; i++) assert_true(outcome[i] == PENDRES_NOT_FOUND && isnan(s[i].frequency));
  const double bad = 0.0;
  assert_int_equal(pendres_free_oscillation_find(ctx, 1, p, &bad, s, outcome),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_free_oscillation_find(ctx, 1, p, NULL, s, outcome),
                   PENDRES_INVALID_ARGUMENT);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(duffing_by_elliptic_functions), cmocka_unit_test(a_well_beside_another),
    cmocka_unit_test(close_to_the_separatrix),
    cmocka_unit_test(plain_pendulum), cmocka_unit_test(any_force_comes_back),
    cmocka_unit_test(none)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
