/*
 * test_stable_part.c -- a computation that ends is no state that ends: sweeps over wide ranges,
 * along curves of thousands of points, have the jumps of their states alone.
 *
 * What is true is exact (the linear oscillator; a pendulum at rest), or the reference's orbit at
 * the place of a bifurcation, integrated in extended precision by another code.
 */
#include <stdlib.h>

#include <pendres/hysteresis.h>
#include "oracle/reference.h"

#include "context_fixture.h"

#include "analysis/sweeps/stable_part.h"
#include "continuation/sets.h"

/* Up and down over n values between two; the caller frees. No point is left out. */
static pendres_hysteresis *sweep(pendres_context *ctx, const pendres_pendulum *p,
                                 const pendres_branch_options *range, size_t n, double x)
{
  pendres_hysteresis *h = NULL;
  double *value = malloc(2 * n * sizeof *value);
  assert_non_null(value);
  for (size_t i = 0; i < n; i++)
    value[i] = value[2 * n - 1 - i] =
      range->low + (range->high - range->low) * (double)i / (double)(n - 1);
  check_ok(pendres_hysteresis_find(ctx, p, &(pendres_state){x, 0.0},
                                   &(pendres_hysteresis_path){range->parameter, 2 * n, value},
                                   &h));
  for (size_t i = 0; i < 2 * n; i++)
    assert_int_equal(pendres_hysteresis_get(h, i)->outcome, PENDRES_OK);
  free(value);
  return h;
}

/* The same orbit on both ways, without a jump. The pendulum's amplitude is that of the linear
   oscillator but for a relative error of some amplitude^2 / 8. */
static void no_end_of_the_drive_frequency(void **state)
{
  enum { N = 7 };
  const pendres_pendulum p = {.damping = 0.2, .drive_amplitude = 0.5};
  /* The second range is one of several thousand points between two values: it is resumed. */
  static const double highest[] = {60.0, 2e4};
  for (int k = 0; k < 2; k++) {
    const pendres_branch_options range = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 2.0, .high = highest[k]};
    pendres_hysteresis *h = sweep(*state, &p, &range, N, 1.6);
    assert_int_equal(pendres_hysteresis_jump_count(h), 0);
    for (size_t i = 0; i < N; i++) {
      const pendres_orbit *up = &pendres_hysteresis_get(h, i)->attractor.orbit;
      const pendres_orbit *down = &pendres_hysteresis_get(h, 2 * N - 1 - i)->attractor.orbit;
      const double w = up->pendulum.drive_frequency;
      const double linear = 0.5 / hypot(1.0 - w * w, 0.2 * w);
      check_near(up->amplitude, down->amplitude, up->amplitude_error + down->amplitude_error);
      check_near(up->amplitude, linear, linear * linear * linear / 8.0 + 1e-8);
    }
    pendres_hysteresis_free(h);
  }
}

/* The linear oscillator swings by F0 / damping at resonance, about the torque. */
static void no_end_of_the_torque(void **state)
{
  enum { N = 4 };
  const pendres_pendulum p = {.damping = 0.5, .drive_amplitude = 0.1, .drive_frequency = 1.0,
                              .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0}};
  const pendres_branch_options range = {
    .parameter = PENDRES_TORQUE, .low = 0.0, .high = 12.0};
  pendres_hysteresis *h = sweep(*state, &p, &range, N, 0.1);
  assert_int_equal(pendres_hysteresis_jump_count(h), 0);
  for (size_t i = 0; i < 2 * N; i++) {
    const pendres_orbit *o = &pendres_hysteresis_get(h, i)->attractor.orbit;
    check_near(o->amplitude, 0.2, o->amplitude_error);
    /* x = torque + 0.2 cos(t - pi/2) */
    check_near(o->x, o->pendulum.torque, o->x_error);
  }
  pendres_hysteresis_free(h);
}

/* A pendulum hangs at rest under a parametric drive too weak to shake it. */
static void no_end_of_rest(void **state)
{
  enum { N = 6 };
  const pendres_pendulum p = {.damping = 0.2, .drive_frequency = 10.0};
  const pendres_branch_options range = {
    .parameter = PENDRES_PARAMETRIC_AMPLITUDE, .low = -30.0, .high = -5.0};
  pendres_hysteresis *h = sweep(*state, &p, &range, N, 1.6);
  assert_int_equal(pendres_hysteresis_jump_count(h), 0);
  for (size_t i = 0; i < 2 * N; i++)
    check_near(pendres_hysteresis_get(h, i)->attractor.orbit.amplitude, 0.0, 1e-12);
  pendres_hysteresis_free(h);
}

/*
 * From one value of a path to the next may be so far that what was followed to the one ends long
 * before the other. Up, the orbit goes on, and bends sharply where it comes close to a pair that
 * meets in a fold; down, on the stable one of these, the fold ends it. Orbit and fold are
 * those that scipy's Newton method (fsolve) finds on maps integrated by DOP853 at 1e-13.
 */
static void a_short_step_and_a_long_one(void **state)
{
  enum { UP = 4, DOWN = 3 };
  static const double up[UP] = {4.0, 4.5, 21.0, 31.0}, down[DOWN] = {27.0, 26.0, 21.0};
  static const double x = 2.6379319047, v = -12.6731961307, fold = 22.9246487058, scipy = 1e-10;
  const pendres_pendulum p = {
    .damping = 0.05, .drive_frequency = 1.93, .force = PENDRES_FORCE_POLYNOMIAL,
    .force_coefficients = {0.96, 0.21, 0.53}};
  const pendres_hysteresis_path path[2] = {{PENDRES_DRIVE_AMPLITUDE, UP, up},
                                           {PENDRES_DRIVE_AMPLITUDE, DOWN, down}};
  pendres_hysteresis *h[2];
  check_ok(pendres_hysteresis_find(*state, &p, &(pendres_state){3.16, 0.70}, &path[0], &h[0]));
  assert_int_equal(pendres_hysteresis_jump_count(h[0]), 0);
  const pendres_orbit *o = &pendres_hysteresis_get(h[0], UP - 1)->attractor.orbit;
  check_near(o->x, x, o->x_error + scipy);
  check_near(o->v, v, o->v_error + scipy);
  check_ok(pendres_hysteresis_find(*state, &p, &(pendres_state){3.41, 10.99}, &path[1], &h[1]));
  assert_int_equal(pendres_hysteresis_jump_count(h[1]), 1);
  const pendres_jump *j = pendres_hysteresis_jump_get(h[1], 0);
  assert_int_equal(j->kind, PENDRES_JUMP_FOLD);
  assert_int_equal((int)j->step, DOWN - 1);
  check_near(j->value, fold, j->value_error + scipy);
  /* Beyond the fold there is the orbit of the way up. */
  const pendres_orbit *q = &pendres_hysteresis_get(h[1], DOWN - 1)->attractor.orbit;
  o = &pendres_hysteresis_get(h[0], 2)->attractor.orbit;
  check_near(q->x, o->x, q->x_error + o->x_error);
  check_near(q->v, o->v, q->v_error + o->v_error);
  for (int k = 0; k < 2; k++) pendres_hysteresis_free(h[k]);
}

/* The larger of the reference's multipliers. */
static double multiplier_at(const pendres_jump *j, const pendres_orbit *near)
{
  reference_cycle c;
  pendres_pendulum p = near->pendulum;
  p.drive_amplitude = j->value;
  check_ok(reference_orbit(&p, (long double)near->x, (long double)near->v, 1, 0, &c));
  return (double)c.multiplier_re[0];
}

/*
 * Ueda's oscillator, F0 from 0.5 to 30, where points of the orbit move by several units: folds and
 * losses of symmetry, and nothing else. Where two orbits that are mirror images grow together, the
 * pendulum goes over to the orbit that is its own image, at the value at which that loses its
 * symmetry on the way back.
 */
static void only_bifurcations(void **state)
{
  static const pendres_jump_kind kinds[] = {
    PENDRES_JUMP_FOLD, PENDRES_JUMP_SYMMETRY, PENDRES_JUMP_SYMMETRY, PENDRES_JUMP_FOLD,
    PENDRES_JUMP_SYMMETRY, PENDRES_JUMP_SYMMETRY, PENDRES_JUMP_FOLD, PENDRES_JUMP_SYMMETRY,
    PENDRES_JUMP_SYMMETRY, PENDRES_JUMP_FOLD};
  enum { N = 60, JUMPS = sizeof kinds / sizeof *kinds };
  const pendres_pendulum p = {.damping = 0.5, .drive_frequency = 1.0,
                              .force = PENDRES_FORCE_POLYNOMIAL,
                              .force_coefficients = {0.0, 0.0, 1.0}};
  const pendres_branch_options range = {
    .parameter = PENDRES_DRIVE_AMPLITUDE, .low = 0.5, .high = 30.0};
  pendres_hysteresis *h = sweep(*state, &p, &range, N, 0.1);
  assert_int_equal(pendres_hysteresis_jump_count(h), JUMPS);
  for (size_t k = 0; k < JUMPS; k++) {
    const pendres_jump *j = pendres_hysteresis_jump_get(h, k);
    assert_int_equal(j->kind, kinds[k]);
    assert_int_equal(j->gradual, kinds[k] == PENDRES_JUMP_SYMMETRY);
    assert_true(j->value_error < 1e-8);
  }
  const pendres_jump *lost = pendres_hysteresis_jump_get(h, 2),
  *back = pendres_hysteresis_jump_get(h, 7);
  check_near(lost->value, back->value, lost->value_error + back->value_error);
  /* The orbit of its own image at the next value leads there. The multiplier passes 1 at a rate of
     order one, so that it is off by some errors of the value (2e-10); 1e-7 is a wide margin. */
  const pendres_orbit *o = &pendres_hysteresis_get(h, lost->step)->attractor.orbit;
  assert_true(o->symmetric);
  check_near(multiplier_at(lost, o), 1.0, 1e-7);
  pendres_hysteresis_free(h);
}

/*
 * An orbit of eight periods is born from one of four, and grows into that again a little further: a
 * closed branch, so short that its points pass the second doubling more than once. Both ways meet
 * the same doublings, and at the second the reference's orbit of four periods has a multiplier -1.
 */
static void doublings_of_a_short_branch(void **state)
{
  enum { N = 2, JUMPS = 6 };
  static const int to[JUMPS] = {4, 8, 4, 8, 4, 2};
  const pendres_pendulum p = {.damping = 0.57395788975562456, .torque = 0.46123985610058271,
                              .drive_frequency = 0.47158924700965588};
  const pendres_branch_options range = {
    .parameter = PENDRES_DRIVE_AMPLITUDE, .low = 2.58, .high = 2.6793};
  pendres_hysteresis *h = sweep(*state, &p, &range, N, 0.65);
  assert_int_equal(pendres_hysteresis_jump_count(h), JUMPS);
  for (size_t k = 0; k < JUMPS; k++) {
    const pendres_jump *j = pendres_hysteresis_jump_get(h, k);
    const pendres_jump *back = pendres_hysteresis_jump_get(h, JUMPS - 1 - k);
    assert_true(j->kind == PENDRES_JUMP_FLIP && j->gradual);
    assert_int_equal(j->to_period, to[k]);
    check_near(j->value, back->value, j->value_error + back->value_error);
  }
  const pendres_orbit *o = &pendres_hysteresis_get(h, N - 1)->attractor.orbit;
  pendres_pendulum q = o->pendulum;
  reference_cycle c;
  q.drive_amplitude = pendres_hysteresis_jump_get(h, 2)->value;
  check_ok(reference_orbit(&q, (long double)o->x - 1.57079632679489662L,
                                   (long double)o->v, o->period, o->winding, &c));
  /* It changes by some thousands a unit of F0, and the value is known to some 1e-11. */
  check_near((double)fminl(c.multiplier_re[0], c.multiplier_re[1]), -1.0, 1e-6);
  pendres_hysteresis_free(h);
}

/*
 * Where an orbit is born by a doubling its branch turns round, and points of the branch may lie
 * next to that, or between two doublings next to each other. On the way down there is one
 * bifurcation at each place within its error. All of this happened.
 */
static void one_bifurcation_at_a_place(void **state)
{
  enum { N = 12, CASES = 3, DOUBLINGS = 5 /* on the way down, in a row */ };
  static const pendres_pendulum p[CASES] = {
    {.damping = 0.16167918053663349, .drive_amplitude = 0.66061728924368002,
     .torque = -0.030555463448689868},
    {.damping = 0.088115518405680743, .drive_amplitude = 0.97236988314086892},
    {.damping = 0.29126932479635753, .drive_frequency = 1.4750256694475705,
     .torque = 0.14601913351895512, .parametric_amplitude = -0.65161023967982001}};
  static const pendres_parameter moves[CASES] = {
    PENDRES_DRIVE_FREQUENCY, PENDRES_DRIVE_FREQUENCY, PENDRES_DRIVE_AMPLITUDE};
  static const double low[CASES] = {0.50333193285723676, 0.63005155577537686, 1.6380538249179097};
  static const double high[CASES] = {3.4288453967999333, 2.3619314926512498, 6.1832569965923447};
  static const pendres_state start[CASES] = {{0.079339324159200502, -0.1838289409418945},
                                             {-0.83548583621790329, -0.18907451341191794},
                                             {0.205031595072662, 0.26637364567277588}};
  for (int c = 0; c < CASES; c++) {
    double value[2 * N], last = INFINITY, error = 0.0;
    pendres_hysteresis *h = NULL;
    int row = 0, most = 0;
    for (int i = 0; i < N; i++)
      value[i] = value[2 * N - 1 - i] = low[c] + (high[c] - low[c]) * i / (N - 1.0);
    check_ok(pendres_hysteresis_find(
      *state, &p[c], &start[c],
      &(pendres_hysteresis_path){moves[c], 2 * N, value}, &h));
    for (size_t k = 0; k < pendres_hysteresis_jump_count(h); k++) {
      const pendres_jump *j = pendres_hysteresis_jump_get(h, k);
      if (j->direction > 0) continue;
      assert_true(fabs(j->value - last) > j->value_error + error);
      last = j->value;
      error = j->value_error;
      if (j->gradual) assert_true(j->to_period > 0);
      row = j->gradual && j->kind == PENDRES_JUMP_FLIP ? row + 1 : 0;
      if (row > most) most = row;
    }
    assert_true(most >= DOUBLINGS);
    pendres_hysteresis_free(h);
  }
}

/* The orbit near a guess that is right but for some Newton steps. */
static pendres_orbit orbit_at(pendres_context *ctx, const pendres_pendulum *p, double x)
{
  const pendres_orbit_guess guess = {.pendulum = *p, .x = x, .period = 1};
  pendres_orbit o;
  pendres_status outcome;
  check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &o, &outcome));
  assert_int_equal(outcome, PENDRES_OK);
  return o;
}

/* Orbits at both ends of a wide range lie on one branch, which reaches from end to end. */
static void one_branch(void **state)
{
  const pendres_branch_options range = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 2.0, .high = 60.0};
  pendres_orbit orbit[2];
  pendres_branches *set = NULL;
  for (int i = 0; i < 2; i++) {
    const double w = i == 0 ? 2.0 : 60.0;
    const pendres_pendulum p = {.damping = 0.2, .drive_amplitude = 0.5, .drive_frequency = w};
    orbit[i] = orbit_at(*state, &p, 1.57079632679489662 + 0.5 / (1.0 - w * w));
  }
  check_ok(pendres_branches_find(*state, 2, orbit, &range, &set));
  assert_int_equal(pendres_branches_count(set), 1);
  for (int end = 0; end < 2; end++)
    assert_int_equal(pendres_branch_end_get(pendres_branches_get(set, 0), end), PENDRES_END_RANGE);
  pendres_branches_free(set);
}

/*
 * An upright pendulum is followed from b = 0.5, where it falls over, to where a fast parametric
 * drive holds it upright: there the reference's map has a multiplier 1. It is where the linear
 * equation y'' + gamma y' = (1 + b cos 14 t) y has one (integrated by scipy's DOP853 at 1e-13);
 * without damping this is Mathieu's equation with a = -4/196 and q = 2 b/196, and b is 98 q where
 * a is the characteristic value a0(q).
 */
static void upright(void **state)
{
  const double up = 4.71238898038468986;
  static const struct {
    double damping, b;
  } cases[] = {{0.0, 19.843114335205}, {0.1, 19.843616124743}, {0.5, 19.855655285655}};
  const pendres_branch_options range = {
    .parameter = PENDRES_PARAMETRIC_AMPLITUDE, .low = 0.4, .high = 25.0};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    pendres_pendulum p = {
      .damping = cases[i].damping, .drive_frequency = 14.0, .parametric_amplitude = 0.5};
    const pendres_orbit start = orbit_at(*state, &p, up);
    pendres_branch *b = NULL;
    reference_image image;
    check_ok(pendres_branch_follow(*state, &start, &range, &b));
    assert_int_equal(pendres_branch_bifurcation_count(b), 1);
    const pendres_bifurcation *held = pendres_branch_bifurcation_get(b, 0);
    /* What scipy leaves; the trace changes by 0.01 from b to b + 1. */
    check_near(held->value, cases[i].b, held->value_error + 2e-11);
    p.parametric_amplitude = held->value;
    check_ok(reference_map(&p, 3.14159265358979323846L, 0.0L, 1, &image));
    const long double trace = image.monodromy[0][0] + image.monodromy[1][1];
    const long double product = expl(-p.damping * 2.0L * 3.14159265358979323846L / 14.0L);
    /* 1 - trace + product = (1 - m)(1 - product/m) falls by some 0.01 from b to b + 1. */
    check_near((double)(1.0L - trace + product), 0.0, 0.1 * held->value_error + 1e-15);
    assert_true(held->value_error < 1e-8);
    pendres_branch_free(b);
  }
}

/* A part goes one way from its orbit: what the branch does the other way is not followed, though a
   point there shows that the orbit is not at the end of its branch. */
static void one_way(void **state)
{
  const pendres_pendulum p = {.damping = 0.2, .drive_amplitude = 0.5, .drive_frequency = 2.0};
  const pendres_orbit orbit = orbit_at(*state, &p, 1.6);
  for (int direction = -1; direction <= 1; direction += 2) {
    double behind = 0.0;
    pendres_part s;
    check_ok(pendres_part_from(*state, &orbit, PENDRES_DRIVE_FREQUENCY, 2.0 + 0.1 * direction, &s));
    assert_int_equal(s.end, PENDRES_PART_LIMIT);
    for (size_t i = 0; i < pendres_branch_count(s.branch); i++) {
      const double there = pendres_branch_get(s.branch, i)->orbit.pendulum.drive_frequency;
      behind = fmax(behind, direction * (2.0 - there));
    }
    assert_true(behind > 0.0 && behind < 1e-4);
    pendres_part_free(&s);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(no_end_of_the_drive_frequency),
    cmocka_unit_test(no_end_of_the_torque),
    cmocka_unit_test(no_end_of_rest),
    cmocka_unit_test(a_short_step_and_a_long_one),
    cmocka_unit_test(only_bifurcations),
    cmocka_unit_test(doublings_of_a_short_branch),
    cmocka_unit_test(one_bifurcation_at_a_place),
    cmocka_unit_test(one_branch),
    cmocka_unit_test(upright),
    cmocka_unit_test(one_way),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
