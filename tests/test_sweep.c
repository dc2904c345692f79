/*
 * test_sweep.c -- values of an axis, pendulums by number, ensembles of starts: all exact.
 */
#include "check.h"

#include <math.h>
#include <string.h>

#include <pendres/sweep.h>

#include "analysis/sweeps/sweep.h"
#include "states_fixture.h"

static void range_has_exact_ends(void **state)
{
  (void)state;
  const pendres_range r = {0.1, 0.7, 7}, one = {0.3, 0.3, 1}, zero = {-0.0, 1.0, 2};
  assert_true(pendres_range_value(&r, 0) == 0.1);
  assert_true(pendres_range_value(&r, 6) == 0.7);
  for (size_t i = 0; i < 7; i++) /* one rounding each of three products and sums */
    check_near(pendres_range_value(&r, i), 0.1 + 0.1 * (double)i, 3e-16);
  assert_true(pendres_range_value(&one, 0) == 0.3);
  assert_false(signbit(pendres_range_value(&zero, 0)));
}

/* What a reader of a deck expects: every value is the decimal that it would have listed. */
static void ranges_hold_the_decimals(void **state)
{
  (void)state;
  static const struct {
    pendres_range range;
    double scale; /* value i is (first + i) / scale, both whole */
    double first;
  } cases[] = {
    {{0.06, 1.0, 95}, 100.0, 6.0},       {{0.06, 1.25, 120}, 100.0, 6.0},
    {{-0.3, 0.7, 1001}, 1000.0, -300.0}, {{6.0, 7.9, 20}, 10.0, 60.0},
    {{1e-9, 9e-9, 9}, 1e9, 1.0},         {{5e8, 1.5e9, 11}, 1e-8, 5.0},
  };
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++)
    for (size_t i = 0; i < cases[c].range.count; i++)
      assert_true(pendres_range_value(&cases[c].range, i) ==
                  (cases[c].first + (double)i) / cases[c].scale);
  /* Thirds are no decimals and stay as exact as they were. */
  const pendres_range thirds = {0.0, 1.0, 4};
  assert_true(pendres_range_value(&thirds, 1) == 1.0 / 3.0);
  /* Ends next to each other have no room for decimals between them. */
  const pendres_range narrow = {0.1, 0.1 + 8e-16, 5};
  for (size_t i = 1; i < 5; i++)
    assert_true(pendres_range_value(&narrow, i) > pendres_range_value(&narrow, i - 1));
}

/* Between ends times a power of two values are those times it but for rounding, which what is said
   of units of the same digits leaves to ranges. */
static void scaled_ranges_differ_by_rounding(void **state)
{
  (void)state;
  for (int k = -40; k <= 40; k++) {
    const pendres_range one = {0.1, 0.8, 5}, scaled = {ldexp(0.1, k), ldexp(0.8, k), 5};
    for (size_t i = 0; i < 5; i++)
      check_near(ldexp(pendres_range_value(&scaled, i), -k), pendres_range_value(&one, i), 3e-16);
  }
}

static void check_values(size_t listed, const double *list, const pendres_range *range, size_t n,
                         const double *expected)
{
  double value[32];
  size_t count = 99;
  assert_true(listed + (range != NULL ? range->count : 0) <= 32);
  check_ok(pendres_sweep_values(listed, list, range, value, &count));
  assert_int_equal(count, n);
  for (size_t i = 0; i < n; i++) assert_true(value[i] == expected[i]);
}

static void union_is_sorted_and_has_no_twins(void **state)
{
  (void)state;
  const double list[] = {3.0, -1.0, 3.0, 0.5, -1.0};
  const pendres_range range = {0.0, 4.0, 5};
  check_values(5, list, NULL, 3, (const double[]){-1.0, 0.5, 3.0});
  check_values(0, NULL, &range, 5, (const double[]){0.0, 1.0, 2.0, 3.0, 4.0});
  check_values(5, list, &range, 7, (const double[]){-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 4.0});
  check_values(0, NULL, NULL, 0, NULL);
  double own[] = {2.0, 1.0, 2.0};
  size_t count = 0;
  check_ok(pendres_sweep_values(3, own, NULL, own, &count));
  assert_int_equal(count, 2);
  assert_true(own[0] == 1.0 && own[1] == 2.0);
}

/* 0.1 + 2 * 0.1 is not 0.3 in doubles: what is listed is kept, and alone. */
static void listed_values_stand_for_the_ranges(void **state)
{
  (void)state;
  const double list[] = {0.1 + 2.0 * 0.1};
  const pendres_range range = {0.1, 0.5, 5};
  double value[6];
  size_t count = 0;
  assert_true(list[0] != pendres_range_value(&range, 2));
  check_ok(pendres_sweep_values(1, list, &range, value, &count));
  assert_int_equal(count, 5);
  assert_true(value[2] == list[0]);
  const double apart[] = {0.3 + 1e-14};
  check_ok(pendres_sweep_values(1, apart, &range, value, &count));
  assert_int_equal(count, 6);
}

static void values_that_are_wrong(void **state)
{
  (void)state;
  double value[4];
  size_t count = 7;
  const double bad[] = {1.0, NAN};
  const pendres_range backwards = {1.0, 0.0, 2}, endless = {0.0, INFINITY, 2}, flat = {1.0, 1.0, 2},
                      lone = {0.0, 1.0, 1};
  assert_int_equal(pendres_sweep_values(2, bad, NULL, value, &count), PENDRES_INVALID_ARGUMENT);
  const pendres_range *const ranges[] = {&backwards, &endless, &flat, &lone};
  for (int i = 0; i < 4; i++)
    assert_int_equal(pendres_sweep_values(0, NULL, ranges[i], value, &count),
                     PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_sweep_values(1, NULL, NULL, value, &count), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_sweep_values(0, NULL, NULL, NULL, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(count, 7);
}

static const double dampings[] = {0.1, 0.2}, periods[] = {4.0, 8.0, 16.0}, starts[] = {-1.0, 1.0};

static pendres_sweep three_axes(void)
{
  return (pendres_sweep){.pendulum = {.drive_amplitude = 0.2, .drive_frequency = 9.0},
                         .x = 5.0,
                         .v = 0.25,
                         .axes = 3,
                         .axis = {{PENDRES_DAMPING, 2, dampings},
                                  {PENDRES_DRIVE_PERIOD, 3, periods},
                                  {PENDRES_X, 2, starts}}};
}

static void last_axis_runs_fastest(void **state)
{
  (void)state;
  const pendres_sweep s = three_axes();
  size_t n = 0, i = 0;
  check_ok(pendres_sweep_count(&s, &n));
  assert_int_equal(n, 12);
  for (int a = 0; a < 2; a++)
    for (int b = 0; b < 3; b++)
      for (int c = 0; c < 2; c++, i++) {
        double x, v;
        const pendres_pendulum p = pendres_sweep_pendulum(&s, i, &x, &v);
        assert_true(p.damping == dampings[a]);
        assert_true(p.drive_frequency == 6.28318530717958647693 / periods[b]);
        assert_true(p.drive_amplitude == 0.2 && p.temperature == 0.0);
        assert_true(x == starts[c] && v == 0.25);
      }
}

static void every_quantity_has_its_place(void **state)
{
  (void)state;
  const double half = 0.5;
  for (int q = 0; q < PENDRES_PARAMETER_COUNT; q++) {
    const pendres_sweep s = {.axes = 1, .axis = {{(pendres_parameter)q, 1, &half}}};
    double x, v;
    const pendres_pendulum p = pendres_sweep_pendulum(&s, 0, &x, &v);
    const int by_period = q == PENDRES_DRIVE_PERIOD;
    assert_true(p.damping == (q == PENDRES_DAMPING ? half : 0.0));
    assert_true(p.drive_amplitude == (q == PENDRES_DRIVE_AMPLITUDE ? half : 0.0));
    assert_true(p.drive_frequency == (q == PENDRES_DRIVE_FREQUENCY ? half
                                      : by_period ? 6.28318530717958647693 / half
                                                  : 0.0));
    assert_true(p.temperature == (q == PENDRES_TEMPERATURE ? half : 0.0));
    assert_true(x == (q == PENDRES_X ? half : 0.0));
    assert_true(v == (q == PENDRES_V ? half : 0.0));
  }
}

static void sweeps_that_are_wrong(void **state)
{
  (void)state;
  size_t n = 3;
  pendres_sweep s = three_axes();
  s.axis[2] = (pendres_axis){PENDRES_DRIVE_FREQUENCY, 2, starts};
  assert_int_equal(pendres_sweep_count(&s, &n), PENDRES_INVALID_ARGUMENT);
  s = three_axes();
  s.axis[1].count = 0;
  assert_int_equal(pendres_sweep_count(&s, &n), PENDRES_INVALID_ARGUMENT);
  s = three_axes();
  s.axis[0].count = (size_t)-1 / 2;
  assert_int_equal(pendres_sweep_count(&s, &n), PENDRES_INVALID_ARGUMENT);
  s = three_axes();
  s.axes = PENDRES_PARAMETER_COUNT + 1;
  assert_int_equal(pendres_sweep_count(&s, &n), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(n, 3);
  s.axes = 0;
  check_ok(pendres_sweep_count(&s, &n));
  assert_int_equal(n, 1);
}

/* The paper's: from beyond the top of the potential on, in steps of pi / 100, to its next top. */
static void ensemble_is_half_open(void **state)
{
  (void)state;
  const pendres_ensemble e = pendres_ensemble_default();
  assert_int_equal(e.members, 200);
  assert_true(e.v == 0.0);
  check_near(member_x(&e, 1), -1.57079632679489661923 + 0.0314159265358979323846, 5e-16);
  check_near(member_x(&e, 200), 4.71238898038468985769, 1e-15);
}

/* A spring k that is driven by F0 swings by F0/(damping sqrt(k)) at most, which a search by powers
   of two and four halvings meets to 1/16; starts lie up to twice as far, in whatever units. */
static void starts_span_the_response(void **state)
{
  (void)state;
  const pendres_ensemble paper = pendres_ensemble_default();
  pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 0.02, .drive_frequency = 1.0};
  pendres_ensemble e = pendres_ensemble_of(&p);
  assert_memory_equal(&e, &paper, sizeof e);
  e = pendres_ensemble_of(NULL);
  assert_memory_equal(&e, &paper, sizeof e);
  p.force = PENDRES_FORCE_POLYNOMIAL;
  p.force_coefficients[0] = 4.0;
  e = pendres_ensemble_of(&p);
  assert_true(e.members == 200 && e.x_first == -e.x_last && e.v == 0.0);
  assert_true(e.x_last <= 0.2 * (1.0 + 1e-12) && e.x_last > 0.2 * 15.0 / 16.0);
  const double one = e.x_last;
  p.drive_amplitude *= 0x1p-20;
  assert_true(pendres_ensemble_of(&p).x_last == one * 0x1p-20);
  /* Without a drive the force's own length: where k x is k3 x^3. */
  p.drive_amplitude = 0.0;
  p.force_coefficients[2] = 16.0;
  assert_true(pendres_ensemble_of(&p).x_last == 1.0);
  /* Two wells at +-1, which starts up to sqrt(2) span. */
  p.drive_amplitude = 0.3;
  p.force_coefficients[0] = -1.0;
  p.force_coefficients[2] = 1.0;
  assert_true(pendres_ensemble_of(&p).x_last >= sqrt(2.0));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(range_has_exact_ends),
    cmocka_unit_test(ranges_hold_the_decimals),
    cmocka_unit_test(scaled_ranges_differ_by_rounding),
    cmocka_unit_test(union_is_sorted_and_has_no_twins),
    cmocka_unit_test(listed_values_stand_for_the_ranges),
    cmocka_unit_test(values_that_are_wrong),
    cmocka_unit_test(last_axis_runs_fastest),
    cmocka_unit_test(every_quantity_has_its_place),
    cmocka_unit_test(sweeps_that_are_wrong),
    cmocka_unit_test(ensemble_is_half_open),
    cmocka_unit_test(starts_span_the_response),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
