/*
 * test_hysteresis_left.c -- values that a sweep leaves out, and what it does at the others.
 *
 * These are compared with those of paths that never had the values, with the linear oscillator, and
 * with what following takes.
 */
#include <math.h>
#include <stdlib.h>

#include <pendres/hysteresis.h>

#include "context_fixture.h"
#include "analysis/sweeps/hysteresis_path.h"
#include "engine/context_internal.h"

static int setup_exact(void **state)
{
  *state = context_with(&(pendres_options){.tolerance = 1e-9});
  return 0;
}

static void check_same_point(const pendres_hysteresis_point *a, const pendres_hysteresis_point *b)
{
  assert_int_equal(a->outcome, PENDRES_OK);
  assert_int_equal(a->attractor.label, b->attractor.label);
  assert_true(a->value == b->value && a->x == b->x && a->v == b->v);
  assert_true(a->attractor.orbit.loop_area == b->attractor.orbit.loop_area);
}

/* A frequency that asks for more steps a period than there are is left out, first or later, and
   twice where the path turns round: all others are as they are without it. */
static void left_out(void **state)
{
  enum { ALL = 7, WITHOUT = 4 };
  static const double value[ALL] = {1e-5, 0.8, 0.9, 1e-5, 1e-5, 0.9, 0.8};
  static const double without[WITHOUT] = {0.8, 0.9, 0.9, 0.8};
  static const int number[ALL] = {-1, 0, 1, -1, -1, 2, 3};
  const pendres_pendulum p = {.damping = 0.15, .drive_amplitude = 0.2};
  pendres_hysteresis *h = NULL, *kept = NULL;
  check_ok(pendres_hysteresis_find(
    *state, &p, &(pendres_state){1.6, 0.0},
    &(pendres_hysteresis_path){PENDRES_DRIVE_FREQUENCY, ALL, value}, &h));
  check_ok(pendres_hysteresis_find(
    *state, &p, &(pendres_state){1.6, 0.0},
    &(pendres_hysteresis_path){PENDRES_DRIVE_FREQUENCY, WITHOUT, without}, &kept));
  for (size_t i = 0; i < ALL; i++) {
    const pendres_hysteresis_point *point = pendres_hysteresis_get(h, i);
    if (number[i] >= 0) {
      check_same_point(point, pendres_hysteresis_get(kept, (size_t)number[i]));
      continue;
    }
    assert_true(point->value == value[i] && isnan(point->x));
    assert_int_equal(point->outcome, PENDRES_TOLERANCE_UNREACHABLE);
    assert_int_equal(point->attractor.label, PENDRES_LABEL_UNRESOLVED);
  }
  assert_int_equal(pendres_hysteresis_jump_count(h), pendres_hysteresis_jump_count(kept));
  assert_true(pendres_hysteresis_jump_count(h) >= 1);
  assert_int_equal(pendres_hysteresis_jump_get(h, 0)->step, 2);
  pendres_hysteresis_free(h);
  pendres_hysteresis_free(kept);
}

static void check_escape(const pendres_hysteresis_point *point)
{
  assert_int_equal(point->outcome, PENDRES_OK);
  assert_int_equal(point->attractor.label, PENDRES_LABEL_ESCAPE);
}

/* Slopes of a squid's sweep to n values, without those of its steps. */
static double slopes_beyond(size_t n, const double *value)
{
  const pendres_pendulum p = {
    .damping = 0.077, .drive_amplitude = 0.113, .drive_frequency = 0.628, .torque = -0.308,
    .force = PENDRES_FORCE_SQUID, .force_coefficients = {0.643}};
  pendres_context *ctx = context_with(NULL);
  pendres_hysteresis *h = NULL;
  pendres_cost cost;
  check_ok(pendres_hysteresis_find(
    ctx, &p, &(pendres_state){0.51, -0.34},
    &(pendres_hysteresis_path){PENDRES_PARAMETRIC_AMPLITUDE, n, value}, &h));
  check_ok(pendres_hysteresis_get(h, 1)->outcome);
  for (size_t i = 2; i < n; i++) check_escape(pendres_hysteresis_get(h, i));
  pendres_context_cost(ctx, &cost);
  pendres_hysteresis_free(h);
  pendres_context_free(ctx);
  return cost.rhs_evaluations;
}

/* A parametric drive shakes a squid off to infinity: where its state has ended it escapes at all
   values that follow, and nothing more is done for them. */
static void end_that_nothing_follows(void **state)
{
  enum { N = 8 };
  static const double value[N] = {-0.85, 1.14, 3.14, 3.15, 3.16, 3.17, 3.18, 3.19};
  (void)state;
  const double one = slopes_beyond(3, value), many = slopes_beyond(N, value);
  assert_true(many < 1.5 * one);
}

/* To find what there is beyond the end of SA at 0.8416 takes more than a value may take here. That
   is tried once, not at each of the values beyond; back before the end SA goes on. */
static void beyond_an_end(void **state)
{
  enum { VALUES = 6 };
  static const double value[VALUES] = {0.83, 0.85, 0.86, 0.87, 0.845, 0.835};
  static const double most = 2e6;
  pendres_context *ctx = context_with(&(pendres_options){.tolerance = 1e-8});
  pendres_path w = {.ctx = ctx, .parameter = PENDRES_DRIVE_FREQUENCY, .n = VALUES, .all = value,
                    .value = value, .most_slopes = most};
  pendres_hysteresis *h = NULL;
  (void)state;
  w.pendulum = (pendres_pendulum){.damping = 0.12, .drive_amplitude = 0.2};
  check_ok(pendres_path_run(&w, 1.57, 0.0, &h));
  for (size_t i = 0; i < VALUES; i++)
    assert_int_equal(pendres_hysteresis_get(h, i)->outcome,
                     i == 0 || i + 1 == VALUES ? PENDRES_OK : PENDRES_UNRESOLVED);
  assert_int_equal(pendres_hysteresis_jump_count(h), 0);
  assert_true(pendres_context_slopes(ctx) < 3.0 * most);
  pendres_hysteresis_free(h);
  pendres_context_free(ctx);
}

/* The way to a torque far away takes more than a value may take here: it is left out as well,
   whatever the size of blocks. 0.1 and 0.2 take a tenth of that. */
static void not_worth_it(void **state)
{
  enum { VALUES = 3, SIZES = 2, FAR = 1 };
  static const double value[VALUES] = {0.1, 30.0, 0.2};
  static const int lanes[SIZES] = {8, 512};
  double x[SIZES];
  (void)state;
  for (size_t k = 0; k < SIZES; k++) {
    pendres_context *ctx =
      context_with(&(pendres_options){.tolerance = 1e-6, .block_lanes = lanes[k]});
    pendres_path w = {.ctx = ctx, .parameter = PENDRES_TORQUE, .n = VALUES, .all = value,
                      .value = value, .most_slopes = 5e6};
    w.pendulum = (pendres_pendulum){
      .damping = 0.15, .drive_amplitude = 0.05, .drive_frequency = 0.9};
    pendres_hysteresis *h = NULL;
    check_ok(pendres_path_run(&w, 0.1, 0.0, &h));
    for (size_t i = 0; i < VALUES; i++) {
      const pendres_hysteresis_point *point = pendres_hysteresis_get(h, i);
      assert_int_equal(point->outcome, i == FAR ? PENDRES_UNRESOLVED : PENDRES_OK);
      assert_int_equal(point->attractor.orbit.period, i == FAR ? 0 : 1);
    }
    x[k] = pendres_hysteresis_get(h, 2)->x;
    pendres_hysteresis_free(h);
    pendres_context_free(ctx);
  }
  assert_true(x[0] == x[1]);
}

/* A cubic oscillator has no stiffness but what its amplitude A makes, so that it comes back to its
   orbit ever more slowly at high frequencies, until it can neither be followed nor settle. This
   value is left out, and tells nothing of an end: on the way back the orbit is there as before,
   that without a force but for the stiffness, at most 0.6 A^2 with the parametric drive, in parts
   of omega^2. */
static void slower_and_slower(void **state)
{
  enum { VALUES = 5, HIGHEST = 2 };
  static const double value[VALUES] = {2.0, 20.0, 60.0, 20.0, 2.0};
  const pendres_pendulum p = {.damping = 0.3, .drive_amplitude = 0.1, .parametric_amplitude = 0.8,
                              .force = PENDRES_FORCE_POLYNOMIAL,
                              .force_coefficients = {0.0, 0.0, 0.4}};
  pendres_hysteresis *h = NULL;
  check_ok(pendres_hysteresis_find(
    *state, &p, &(pendres_state){0.0, 0.0},
    &(pendres_hysteresis_path){PENDRES_DRIVE_FREQUENCY, VALUES, value}, &h));
  for (size_t i = 0; i < VALUES; i++) {
    const pendres_hysteresis_point *at = pendres_hysteresis_get(h, i);
    const pendres_orbit *o = &at->attractor.orbit;
    const double free = p.drive_amplitude / (value[i] * hypot(value[i], p.damping));
    assert_int_equal(at->outcome, i == HIGHEST ? PENDRES_UNRESOLVED : PENDRES_OK);
    if (i == HIGHEST) continue;
    assert_int_equal(o->period, 1);
    check_near(o->amplitude, free, pow(free, 3.0) / pow(value[i], 2.0) + o->amplitude_error);
  }
  assert_int_equal(pendres_hysteresis_jump_count(h), 0);
  pendres_hysteresis_free(h);
}

/*
 * Chaos gives way to running orbits of two drive periods between 1.28 and 1.285 (Taylor, Classical
 * Mechanics, section 12.6). To find where takes more than a value may; what it gave way to is known
 * all the same, and the end is between the values.
 */
static void where_chaos_ends_takes_too_much(void **state)
{
  static const double value[] = {1.28, 1.285, 1.29};
  const pendres_pendulum p = {.damping = 0.5, .drive_frequency = 2.0 / 3.0};
  pendres_hysteresis *h = NULL;
  check_ok(pendres_hysteresis_find(*state, &p, &(pendres_state){0.1, 0.1},
                                   &(pendres_hysteresis_path){PENDRES_DRIVE_AMPLITUDE, 3, value},
                                   &h));
  for (size_t i = 0; i < 3; i++) {
    const pendres_hysteresis_point *at = pendres_hysteresis_get(h, i);
    assert_int_equal(at->outcome, PENDRES_OK);
    assert_int_equal(at->attractor.label, i > 0 ? PENDRES_LABEL_RUNNING : PENDRES_LABEL_CHAOTIC);
    if (i == 0) continue;
    assert_int_equal(at->attractor.orbit.period, 2);
    assert_int_equal(abs(at->attractor.orbit.winding), 2);
  }
  assert_int_equal(pendres_hysteresis_jump_count(h), 1);
  const pendres_jump *j = pendres_hysteresis_jump_get(h, 0);
  assert_int_equal(j->kind, PENDRES_JUMP_OTHER);
  assert_int_equal(j->step, 1);
  assert_true(j->value - j->value_error >= 1.28 && j->value + j->value_error <= 1.285);
  pendres_hysteresis_free(h);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(left_out, setup_exact, teardown),
    cmocka_unit_test(not_worth_it),
    cmocka_unit_test(end_that_nothing_follows),
    cmocka_unit_test(beyond_an_end),
    cmocka_unit_test_setup_teardown(slower_and_slower, setup, teardown),
    cmocka_unit_test_setup_teardown(where_chaos_ends_takes_too_much, setup, teardown),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
