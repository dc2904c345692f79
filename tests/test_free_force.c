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

/* pi Omega / (2 K(k)) of x = A cn(Omega t, k) in -x + x^3: Omega^2 = A^2 - 1 and
   k^2 = A^2 / (2 Omega^2), by arithmetic-geometric means in extended precision. */
static double across_two_wells(double amplitude)
{
  const long double square = (long double)amplitude * amplitude;
  long double x = sqrtl(square - 1.0L), y = sqrtl(0.5L * square - 1.0L);
  for (int k = 0; k < 12; k++) {
    const long double mean = 0.5L * (x + y);
    y = sqrtl(x * y);
    x = mean;
  }
  return (double)x;
}

/* Above the barrier of -x + x^3, from large swings to the separatrix. The claim is what a few units
   in the last place of the amplitude do, and not a hundred times as much, as long as the points of
   the quadrature are enough; closer than its grid can tell there is none, and none is claimed. */
static void across_a_barrier(void **state)
{
  (void)state;
  const pendres_pendulum p = {.force = PENDRES_FORCE_POLYNOMIAL,
                              .force_coefficients = {-1.0, 0.0, 1.0}};
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  for (double above = 100.0; above > 1e-15; above *= 0.3) {
    const double amplitude = sqrt(2.0) + above, want = across_two_wells(amplitude);
    pendres_free_oscillation s;
    pendres_status outcome;
    check_ok(pendres_free_oscillation_find(ctx, 1, &p, &amplitude, &s, &outcome));
    if (outcome == PENDRES_NOT_FOUND) {
      assert_true(above < 3e-8);
      continue;
    }
    assert_true(above > 1e-9);
    check_near(s.frequency, want, s.frequency_error);
    if (above > 4e-6) {
      const double unit = amplitude * 0x1p-52;
      const double places = across_two_wells(amplitude + unit) - across_two_wells(amplitude - unit);
      check_ok(outcome);
      assert_true(s.frequency_error < 100.0 * places);
    }
    check_near(s.low, -amplitude, s.turn_error);
    check_near(s.high, amplitude, s.turn_error);
    check_near(s.well, 1.0, 1e-11);
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

/* Let go at a turning point, the reference is back there after a period. */
static void check_comes_back(pendres_pendulum p, double amplitude, double most_force)
{
  const double origin = p.force == PENDRES_FORCE_PENDULUM ? half_pi : 0.0;
  const pendres_free_oscillation s = swing_of(p, amplitude);
  long double y = (long double)s.high - origin, v = 0.0L;
  const long double start = y;
  p.drive_frequency = s.frequency;
  check_ok(reference_advance(&p, &y, &v, NULL, 1));
  /* A velocity by the time that is missed, which grows at the rate of the force there; and
     the rounding of the turning point, by which the period of another swing is meant. */
  const double period = (4.0 * half_pi) / s.frequency;
  const double missed = period * s.frequency_error / s.frequency;
  check_near((double)v, 0.0, most_force * missed + 1e-15 * period);
  check_near((double)(y - start), 0.0, 1e-14 * fmax(1.0, fabs(s.high)));
}

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
  for (size_t i = 0; i < sizeof forces / sizeof *forces * 3; i++)
    check_comes_back(forces[i / 3], amplitudes[i % 3], 5.0);
}

/* Two wells of different depths, on either side of where the pendulum rests, the middle one of
   three and one beside it, and rings of many. */
static void across_barriers_comes_back(void **state)
{
  (void)state;
  static const struct {
    pendres_pendulum of;
    double amplitude, most_force;
  } swings[] = {
    {{.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0, 0.3, 1.0}}, 1.6, 5.0},
    {{.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0, -0.3, 1.0}, .torque = 0.1},
     1.6, 5.0},
    {{.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {4.0, 0.0, -5.0, 0.0, 1.0}},
     2.9, 100.0},
    {{.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {4.0, 0.0, -5.0, 0.0, 1.0},
      .torque = 0.3}, 1.67, 20.0},
    {{.force = PENDRES_FORCE_SQUID, .force_coefficients = {0.1}, .torque = 0.13}, 8.5, 2.0},
    {{.force = PENDRES_FORCE_SQUID, .force_coefficients = {0.03}, .torque = 0.02}, 36.0, 3.0}};
  for (size_t i = 0; i < sizeof swings / sizeof *swings; i++)
    check_comes_back(swings[i].of, swings[i].amplitude, swings[i].most_force);
}

/* No well, amplitudes between those of wells and those across barriers, and rotations. */
static void none(void **state)
{
  (void)state;
  const pendres_pendulum p[] = {
    {.torque = 1.5}, {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0}},
    {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, -1.0}},
    {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0, 0.0, 1.0}},
    {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0, 0.0, 1.0}}, {0}, {0}};
  const double amplitude[] = {0.1, 0.1, 1.001, 0.7072, 1.4142, 3.15, 3.0 * pi};
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  pendres_free_oscillation s[7];
  pendres_status outcome[7];
  check_ok(pendres_free_oscillation_find(ctx, 7, p, amplitude, s, outcome));
  for (int i = 0; i < 7; i++) assert_true(outcome[i] == PENDRES_NOT_FOUND && isnan(s[i].frequency));
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
    cmocka_unit_test(close_to_the_separatrix), cmocka_unit_test(across_a_barrier),
    cmocka_unit_test(plain_pendulum), cmocka_unit_test(any_force_comes_back),
    cmocka_unit_test(across_barriers_comes_back), cmocka_unit_test(none)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
