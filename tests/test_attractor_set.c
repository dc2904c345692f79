/*
 * test_attractor_set.c -- the order of attractors does not depend on the order of their discovery.
 */
#include "check.h"

#include <string.h>

#include <pendres/pendres.h>

#include "engine/kernels/coordinates.h"
#include "settling/attractor_set.h"
#include "orbits/orbit_same.h"

enum { ALL = 6 };

/* Names of attractors in their order, for one order of discovery. */
static void order_of(const pendres_attractor *a, const int *discovered, size_t n, double *names)
{
  pendres_attractor found[ALL];
  int order[ALL];
  const pendres_attractor_set c = {.count = n, .attractors = found};
  for (size_t i = 0; i < n; i++) found[i] = a[discovered[i]];
  assert_int_equal(pendres_attractor_set_sort(&c, order), 0);
  for (size_t i = 0; i < n; i++) names[i] = found[order[i]].orbit.phase_lag;
}

/* All orders of discovery give one order; Heap's algorithm. */
static void all_orders(const pendres_attractor *a, size_t n)
{
  int discovered[ALL], count[ALL] = {0};
  double wanted[ALL], names[ALL];
  for (size_t i = 0; i < n; i++) discovered[i] = (int)i;
  order_of(a, discovered, n, wanted);
  for (size_t i = 0; i < n;) {
    if ((size_t)count[i] >= i) {
      count[i++] = 0;
      continue;
    }
    const size_t k = i % 2 == 0 ? 0 : (size_t)count[i];
    const int other = discovered[k];
    discovered[k] = discovered[i];
    discovered[i] = other;
    count[i]++;
    i = 0;
    order_of(a, discovered, n, names);
    assert_memory_equal(names, wanted, n * sizeof *names);
  }
}

/*
 * Amplitudes less than rounding apart from one to the next, but not from first to last; points
 * likewise: comparing two at a time, a < b < c < a. phase_lag is but a name here.
 */
static void one_order(void **state)
{
  pendres_attractor a[ALL] = {
    {.orbit = {.period = 1, .amplitude = 1.0, .x = 3.0, .v = 0.0, .phase_lag = 0}},
    {.orbit = {.period = 1, .amplitude = 1.0 + 0.8e-7, .x = 2.0, .v = 0.0, .phase_lag = 1}},
    {.orbit = {.period = 1, .amplitude = 1.0 + 1.6e-7, .x = 1.0, .v = 0.0, .phase_lag = 2}},
    {.orbit = {.period = 1, .amplitude = 2.0, .x = 1.0, .v = 3.0, .phase_lag = 3}},
    {.orbit = {.period = 1, .amplitude = 2.0, .x = 1.0 + 0.8e-6, .v = 2.0, .phase_lag = 4}},
    {.orbit = {.period = 1, .amplitude = 2.0, .x = 1.0 + 1.6e-6, .v = 1.0, .phase_lag = 5}}};
  (void)state;
  all_orders(a, ALL);
  double names[ALL];
  order_of(a, (int[ALL]){0, 1, 2, 3, 4, 5}, ALL, names);
  check_near(names[0], 2.0, 0.0);
  check_near(names[5], 3.0, 0.0);
}

/* Chaos comes last, by its means, and what is no number last of its kind. */
static void chaos_last(void **state)
{
  pendres_cover one = {.attractor = 0, .mean_w = 0.5}, two = {.attractor = 2, .mean_w = -0.5};
  pendres_attractor a[4] = {{.lyapunov = 0.1},
                            {.orbit = {.period = 1, .amplitude = NAN}},
                            {.lyapunov = 0.1},
                            {.orbit = {.period = 1, .amplitude = 2.0}}};
  const pendres_attractor_set c = {
    .count = 4, .attractors = a, .covers = 2, .cover = {&one, &two}};
  int order[4];
  (void)state;
  assert_int_equal(pendres_attractor_set_sort(&c, order), 0);
  assert_memory_equal(order, ((int[4]){3, 1, 2, 0}), sizeof order);
}

/*
 * Two mirror images whose multipliers and loop areas differ by more than their errors: both errors
 * are at least the difference. What agrees, and an orbit which is nobody's image, stay as they are.
 */
static void images_compared(void **state)
{
  pendres_orbit o = {.period = 9, .winding = 0, .amplitude = 1.5, .multiplier_re = {0.76, 0.1},
                     .multiplier_error = 1e-11, .loop_area = 0.5, .loop_area_error = 1e-12,
                     .phase_lag = 0.7, .phase_lag_error = 1e-10,
                     .cosine = {1.0, 0.2, 0.1, 0.05, 0.02}, .sine = {0.5, 0.1, 0.05, 0.02, 0.01}};
  pendres_attractor found[3] = {{.orbit = o, .label = PENDRES_LABEL_PERIODIC}};
  (void)state;
  found[1] = found[2] = found[0];
  for (int k = 0; k < 2; k++) {
    const int even = 2 * k + 1; /* of harmonics 2 and 4 */
    found[1].orbit.cosine[even] = -o.cosine[even];
    found[1].orbit.sine[even] = -o.sine[even];
  }
  found[1].orbit.multiplier_re[0] += 1e-9;
  found[1].orbit.loop_area += 1e-10;
  found[1].orbit.phase_lag += 1e-10;
  found[2].orbit.multiplier_re[0] += 1e-9; /* its even harmonics are not turned */
  /* A torque breaks the symmetry: no two orbits need to agree then. */
  pendres_attractor_set c = {.count = 3, .attractors = found, .pendulum = {.torque = 1e-9}};
  pendres_attractor_set_compare_images(&c);
  check_near(found[0].orbit.multiplier_error, 1e-11, 0.0);
  check_near(found[1].orbit.multiplier_error, 1e-11, 0.0);
  c.pendulum.torque = 0.0;
  pendres_attractor_set_compare_images(&c);
  for (int i = 0; i < 2; i++) {
    /* Rounding of numbers of order one. */
    check_near(found[i].orbit.multiplier_error, 1e-9, 1e-15);
    check_near(found[i].orbit.loop_area_error, 1e-10, 1e-15);
    check_near(found[i].orbit.phase_lag_error, 1e-10, 0.0);
  }
  check_near(found[2].orbit.multiplier_error, 1e-11, 0.0);
  check_near(found[2].orbit.loop_area_error, 1e-12, 0.0);
}

/*
 * Long orbits of several parameter sets find their points side by side; what a set gets is what it
 * gets alone, byte by byte. Doubled orbits and their mirror images, of two and of four periods
 * (these run), and an orbit of one period between them.
 */
static void test_long_orbits(void **state)
{
  enum { SETS = 3, MEMBERS = 24, N = SETS * MEMBERS };
  static const pendres_pendulum set[SETS] = {
    {.damping = 0.5, .drive_amplitude = 1.07, .drive_frequency = 2.0 / 3.0},
    {.damping = 0.3, .drive_amplitude = 0.2, .drive_frequency = 0.9},
    {.damping = 0.5, .drive_amplitude = 1.47, .drive_frequency = 2.0 / 3.0}};
  pendres_pendulum p[N];
  double x[N], v[N];
  pendres_settled outcome[N];
  pendres_attractors *all = NULL, *alone = NULL;
  pendres_context *ctx = NULL;
  size_t seen = 0, longs = 0;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  for (size_t i = 0; i < N; i++) {
    p[i] = set[i / MEMBERS];
    x[i] = -1.5 + 6.0 * (double)(i % MEMBERS) / MEMBERS;
    v[i] = 0.0;
  }
  check_ok(pendres_settle(ctx, N, p, x, v, outcome, &all));
  for (size_t s = 0; s < SETS; s++) {
    const size_t at = s * MEMBERS;
    check_ok(pendres_settle(ctx, MEMBERS, p + at, x + at, v + at, outcome + at, &alone));
    for (size_t k = 0; k < pendres_attractors_count(alone); k++, seen++) {
      const pendres_attractor *a = pendres_attractors_get(alone, k);
      const pendres_attractor *b = pendres_attractors_get(all, seen);
      assert_non_null(b);
      assert_int_equal(a->orbit.period, b->orbit.period);
      longs += a->orbit.period > 1;
      check_near(b->orbit.x, a->orbit.x, 0.0);
      check_near(b->orbit.v, a->orbit.v, 0.0);
      check_near(b->orbit.loop_area, a->orbit.loop_area, 0.0);
      check_near(b->orbit.multiplier_error, a->orbit.multiplier_error, 0.0);
      check_near(b->trap_radius, a->trap_radius, 0.0);
      assert_memory_equal(b->trap_metric, a->trap_metric, sizeof a->trap_metric);
    }
    pendres_attractors_free(alone);
  }
  assert_int_equal(seen, pendres_attractors_count(all));
  assert_int_equal(longs, 4);
  pendres_attractors_free(all);
  pendres_context_free(ctx);
}

/*
 * A guess of fifty periods at an orbit of one is no orbit of its own. It takes Newton's steps and
 * two runs of fifty periods, each with its derivatives; the fifty points are not refined one by
 * one, which takes fifty times as much.
 */
static void multiple_of_period(void **state)
{
  const pendres_options options = {.tolerance = 1e-8};
  pendres_attractor_set c = {.pendulum = {0.12, 0.2, 0.8}};
  pendres_orbit_guess guess = {.pendulum = c.pendulum, .period = 1};
  pendres_context *ctx = NULL;
  pendres_orbit orbit;
  pendres_status outcome;
  pendres_cost cost;
  (void)state;
  check_ok(pendres_context_create(&options, &ctx));
  check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome));
  check_ok(outcome);
  assert_true(orbit.stable);
  const pendres_coordinates at = pendres_coordinates_in(&c.pendulum, orbit.x, orbit.v);
  const pendres_initial_guess far_guess = {.y = at.y, .w = at.w, .period = 50};
  pendres_context_cost_reset(ctx);
  check_ok(pendres_attractor_set_add(ctx, &c, 1, &far_guess));
  pendres_context_cost(ctx, &cost);
  assert_int_equal(c.count, 0);
  /* 1.2e5 as it is, 4e6 with all points refined: in the middle, by ratio. */
  assert_true(cost.rhs_evaluations < 7e5);
  pendres_attractor_set_clear(&c);
  pendres_context_free(ctx);
}

/* Values of one orbit differ by several errors of both at most, a millionth aside; however large
   the errors are, what differs by hundredths is two. Whole turns are no difference, periods and
   winding are. Bounds of this test are the numbers' values, within a factor of two. */
static void same_by_both_errors(void **state)
{
  static const struct {
    double error, apart;
    int same;
  } cases[] = {{0.0, 0.5e-6, 1}, {0.0, 2e-6, 0},  {1e-4, 1e-3, 1}, {1e-4, 4e-3, 0},
               {1.0, 0.01, 1},   {1.0, 0.04, 0},  {1e-4, NAN, 0}};
  const pendres_orbit a = {.period = 2, .winding = 1, .x = 3.0, .v = 0.2};
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    pendres_orbit o = a, p = a;
    o.x_error = p.v_error = cases[i].error;
    o.amplitude_error = p.amplitude_error = cases[i].error;
    p.x += cases[i].apart + two_pi;
    p.amplitude += cases[i].apart;
    assert_int_equal(pendres_orbit_same(&o, &p), cases[i].same);
    assert_int_equal(pendres_orbit_same(&p, &o), cases[i].same);
    assert_int_equal(pendres_orbit_as_wide(&o, &p), cases[i].same);
  }
  pendres_orbit once = a, back = a;
  once.period = 1;
  back.winding = -1;
  assert_false(pendres_orbit_same(&a, &once) || pendres_orbit_same(&a, &back));
}

/*
 * At loose tolerances one orbit is found with errors that are larger than any fixed distance: it is
 * one attractor all the same. There is a single one here at 1e-8.
 */
static void once_at_any_tolerance(void **state)
{
  enum { SIDE = 28 };
  static const struct {
    double x, v, tolerance;
  } grid[] = {{3.0, 2.5, 1e-3}, {3.0, 3.0, 1e-3}, {3.0, 2.5, 1e-8}, {pi, 5.0, 1e-4}};
  const pendres_pendulum p = {.damping = 0.08065207614198543,
                              .drive_amplitude = 0.42398322758004636,
                              .drive_frequency = 0.7256297930163663};
  (void)state;
  for (size_t g = 0; g < sizeof grid / sizeof *grid; g++) {
    double x[SIDE * SIDE], v[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++) {
      x[i] = grid[g].x * (2.0 * (i / SIDE) / (SIDE - 1.0) - 1.0);
      v[i] = grid[g].v * (2.0 * (i % SIDE) / (SIDE - 1.0) - 1.0);
    }
    pendres_context *ctx = NULL;
    pendres_attractors *found = NULL;
    const pendres_options options = {.tolerance = grid[g].tolerance};
    check_ok(pendres_context_create(&options, &ctx));
    check_ok(pendres_attractors_find(ctx, &p, SIDE * SIDE, x, v, &found));
    assert_int_equal(pendres_attractors_count(found), 1);
    pendres_attractors_free(found);
    pendres_context_free(ctx);
  }
}

/* The built-in starts are as many as attractor.h says: 36, and in each well with a barrier. */
static void built_in_starts(void **state)
{
  const pendres_pendulum turning = {.damping = 0.1, .drive_frequency = 1.0};
  pendres_pendulum wells = {.damping = 0.1, .drive_frequency = 1.0,
                            .force = PENDRES_FORCE_POLYNOMIAL,
                            .force_coefficients = {-1.0, 0.0, 1.0}};
  double x[PENDRES_ATTRACTOR_SET_STARTS], v[PENDRES_ATTRACTOR_SET_STARTS];
  (void)state;
  assert_int_equal(pendres_attractor_set_starts(&turning, x, v), 36);
  assert_int_equal(pendres_attractor_set_starts(&wells, x, v), 36 + 2 * 36);
  wells.force_coefficients[0] = 1.0;
  assert_int_equal(pendres_attractor_set_starts(&wells, x, v), 36);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(one_order),
                                     cmocka_unit_test(test_long_orbits),
                                     cmocka_unit_test(multiple_of_period),
                                     cmocka_unit_test(chaos_last),
                                     cmocka_unit_test(images_compared),
                                     cmocka_unit_test(same_by_both_errors),
                                     cmocka_unit_test(once_at_any_tolerance),
                                     cmocka_unit_test(built_in_starts)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
