/*
 * test_continuation_far.c -- branches whose orbits are much larger, or resonances much narrower,
 * than the unit of length and time: a linear oscillator's against its closed form, a strongly
 * driven spring's against the reference; and branches at a cusp.
 */
#include <math.h>

#include "continuation/sets.h"
#include "continuation_fixture.h"

/* A branch along the drive frequency from the orbit next to a guess. */
static pendres_branch *branch_of(pendres_context *ctx, const pendres_orbit_guess *guess, double low,
                                 double high)
{
  pendres_orbit start;
  pendres_status outcome = PENDRES_NOT_CONVERGED;
  pendres_branch *b = NULL;
  check_ok(pendres_orbit_find(ctx, 1, guess, PENDRES_ORBIT_PLAIN, &start, &outcome));
  assert_true(outcome == PENDRES_OK || outcome == PENDRES_TOLERANCE_UNREACHABLE);
  check_ok(pendres_branch_follow(
    ctx, &start,
    &(pendres_branch_options){.parameter = PENDRES_DRIVE_FREQUENCY, .low = low, .high = high}, &b));
  return b;
}

static pendres_orbit_guess spring(double a1, double a3, double damping, double drive,
                                  double frequency)
{
  pendres_orbit_guess g = {.pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .damping = damping,
                                        .drive_amplitude = drive, .drive_frequency = frequency,
                                        .force_coefficients = {a1, 0.0, a3}},
                           .period = 1};
  const double stiff = a1 - frequency * frequency, friction = damping * frequency;
  g.x = drive * stiff / (stiff * stiff + friction * friction);
  g.v = drive * friction * frequency / (stiff * stiff + friction * friction);
  return g;
}

/* How much of its claim a result is off by, at most. */
static void note(double *worst, long double is, long double claimed, long double exact)
{
  *worst = fmax(*worst, (double)(fabsl(is - exact) / claimed));
}

/* x'' + x'/Q + x = torque + F0 cos(w t): whole, and known to less than what it claims. */
static void check_linear(double quality, double drive, double torque, double tolerance)
{
  pendres_context *ctx = context_of(tolerance, PENDRES_TABLE_DEFAULT);
  pendres_orbit_guess guess = spring(1.0, 0.0, 1.0 / quality, drive, 0.5);
  guess.pendulum.torque = torque;
  guess.x += torque;
  pendres_branch *b = branch_of(ctx, &guess, 0.5, 1.5);
  const size_t n = pendres_branch_count(b);
  double off = 0.0, largest = 0.0, loose = 0.0;
  for (size_t i = 0; i < n; i++) {
    const pendres_branch_point *p = pendres_branch_get(b, i);
    const pendres_orbit *o = &p->orbit;
    const long double w = o->pendulum.drive_frequency, stiff = (1.0L - w) * (1.0L + w);
    const long double friction = (long double)o->pendulum.damping * w;
    const long double size = drive / hypotl(stiff, friction), lag = atan2l(friction, stiff);
    note(&off, o->x, o->x_error, torque + size * cosl(lag));
    note(&off, o->v, o->v_error, w * size * sinl(lag));
    note(&off, o->amplitude, o->amplitude_error, size);
    note(&off, o->phase_lag, o->phase_lag_error, lag);
    note(&off, o->loop_area, o->loop_area_error, pi * drive * size * sinl(lag));
    /* Far from the top the multipliers are the same 1 + 2 pi i (1 - w), and nowhere closer to 1. */
    if (o->amplitude > 2.0 * (drive + torque))
      loose = fmax(loose, o->amplitude_error / fmax(tolerance, 1e-14 * size * size / drive));
    largest = fmax(largest, o->amplitude);
    assert_int_equal(p->doubt, 0);
    assert_true(o->stable);
  }
  print_message("Q %g, F0 %g, torque %g: %zu points, largest amplitude %.9g, off by %.2g of the "
                "claims\n", quality, drive, torque, n, largest, off);
  assert_int_equal(pendres_branch_end_get(b, 0), PENDRES_END_RANGE);
  assert_int_equal(pendres_branch_end_get(b, 1), PENDRES_END_RANGE);
  /* Steps of a twentieth of the amplitude lead from 1 to Q and back in 40 ln Q, and round the
     half circle of the state in 20 pi; beside that 0.5 to 1.5 has some 70 in scales of 0.3. Next
     to the top they are as far apart as a twentieth of the lag. */
  assert_true((double)n < 2.0 * (40.0 * log(quality) + 20.0 * pi + 70.0));
  assert_true(largest > quality * drive * cos(0.05));
  assert_true(off < 1.0 && off > 1.0 / 30.0);
  assert_true(loose < 10.0); /* rounding of some hundred steps, enlarged by Q */
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

static void linear_resonances_are_whole(void **state)
{
  (void)state;
  check_linear(100.0, 1.0, 0.0, 1e-9);
  check_linear(1e4, 1.0, 0.0, 1e-9);
  check_linear(1e6, 1.0, 0.0, 1e-9);
  check_linear(1e6, 1.0, 0.0, 1e-12);
  check_linear(1e6, 1.0, 0.0, 1e-5);
  /* A torque moves the place about which it swings, and makes the unit of length large. */
  check_linear(1e4, 1e-3, 1000.0, 1e-6);
}

/* x'' + 0.05 x' + x + x^3 = 100 cos(w t): from beyond its resonance down to 1, over both folds. If
   long stretches counted three times as much it would end before. */
static void strong_drives_have_their_upper_branch(void **state)
{
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  const pendres_orbit_guess guess = spring(1.0, 1.0, 0.05, 100.0, 60.0);
  pendres_branch *b = branch_of(ctx, &guess, 1.0, 60.0);
  pendres_orbit there[8];
  size_t found = 0;
  (void)state;
  assert_int_equal(pendres_branch_end_get(b, 0), PENDRES_END_RANGE);
  assert_int_equal(pendres_branch_end_get(b, 1), PENDRES_END_RANGE);
  for (size_t i = 0; i < pendres_branch_count(b); i++)
    assert_int_equal(pendres_branch_get(b, i)->doubt, 0);
  /* At 30 there are three: the reference has the same ones. The upper one attracts. */
  check_ok(pendres_branch_cross(ctx, b, 30.0, 8, there, &found));
  assert_int_equal(found, 3);
  double off = 0.0, upper = 0.0;
  for (size_t k = 0; k < found; k++) {
    const pendres_orbit *o = &there[k];
    reference_cycle e;
    check_ok(reference_orbit(&o->pendulum, o->x, o->v, 1, 0, &e));
    note(&off, o->x, o->x_error, e.y);
    note(&off, o->v, o->v_error, e.v);
    note(&off, o->amplitude, o->amplitude_error, e.amplitude);
    note(&off, o->multiplier_re[0], o->multiplier_error, e.multiplier_re[0]);
    if (o->stable) upper = fmax(upper, o->amplitude);
  }
  print_message("%zu points; at 30 off by %.2g of the claims\n", pendres_branch_count(b), off);
  assert_true(off < 1.0 && off > 1.0 / 30.0);
  assert_true(fabs(upper - 35.4419) < 5e-5); /* by a shooting of another hand */
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/* What bounds a curve is how often it turns, not how long it is: over two decades of frequency the
   two folds of a resonance are reached and left again, with thousands of points between. */
static void long_stretches_do_not_end_a_curve(void **state)
{
  pendres_context *ctx = context_of(1e-6, PENDRES_TABLE_DEFAULT);
  const pendres_orbit_guess guess = spring(1.0, 1.0, 1e-2, 1000.0, 2000.0);
  pendres_branch *b = branch_of(ctx, &guess, 6.0, 2000.0);
  size_t folds = 0;
  (void)state;
  for (size_t k = 0; k < pendres_branch_bifurcation_count(b); k++) {
    const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, k);
    folds += f->kind == PENDRES_FOLD && f->value > 12.0;
    /* At the upper one the drive balances friction: F0 = damping w A but for harmonics, of which
       the third, the largest, is a twenty-fourth of the first. */
    if (f->value > 100.0)
      assert_true(fabs(1e-2 * f->value * f->orbit.amplitude / 1000.0 - 1.0) < 1.0 / 24.0);
  }
  print_message("%zu points, %zu folds\n", pendres_branch_count(b), folds);
  assert_int_equal(pendres_branch_end_get(b, 0), PENDRES_END_RANGE);
  assert_int_equal(pendres_branch_end_get(b, 1), PENDRES_END_RANGE);
  assert_int_equal(folds, 2);
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/*
 * Next to the critical drive of a spring of quality 5000 the two folds are closer than errors. The
 * branch is one that attracts all along; the fold that is found has no curvature, and does not make
 * another branch. A little above there are two.
 */
static void a_cusp_is_no_turn(void **state)
{
  static const double critical = 4.0534710267e-6; /* of the cusp, to 3e-13 */
  pendres_context *ctx = context_of(1e-9, PENDRES_TABLE_DEFAULT);
  pendres_cusp cusp;
  (void)state;
  for (int k = -3; k <= 3; k++) {
    const double drive = critical + (k == 3 ? 1e-10 : k * 8e-15);
    const pendres_branch_options options = {
      .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.999, .high = 1.002};
    const pendres_orbit_guess guess = spring(1.0, 1.0, 2e-4, drive, 0.999);
    pendres_orbit start;
    pendres_status outcome;
    pendres_branches *all = NULL;
    pendres_branch_part part[4];
    check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &start, &outcome));
    check_ok(pendres_branches_find(ctx, 1, &start, &options, &all));
    const pendres_branch *b = pendres_branches_get(all, 0);
    const size_t folds = pendres_branch_bifurcation_count(b);
    const size_t parts = pendres_branch_parts(b, 4, part);
    print_message("drive %.13g: %zu folds, %zu parts\n", drive, folds, parts);
    for (size_t i = 0; i < pendres_branch_count(b); i++)
      assert_int_equal(pendres_branch_get(b, i)->doubt, 0);
    assert_int_equal(parts, folds == 2 ? 2 : 1);
    if (k == 3) assert_int_equal(folds, 2);
    for (size_t i = 0; i < folds; i++) {
      const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, i);
      assert_true((f->curvature != 0.0) == (folds == 2));
      if (k != 0) continue;
      check_ok(pendres_cusp_find(ctx, f, PENDRES_DRIVE_AMPLITUDE, &cusp));
      assert_true(fabs(cusp.value[1] - critical) < 1e-12);
      check_ok(pendres_branches_extend(ctx, 1, f, &options, all));
      assert_int_equal(pendres_branches_count(all), 1);
    }
    pendres_branches_free(all);
  }
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(linear_resonances_are_whole),
    cmocka_unit_test(strong_drives_have_their_upper_branch),
    cmocka_unit_test(long_stretches_do_not_end_a_curve),
    cmocka_unit_test(a_cusp_is_no_turn),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
