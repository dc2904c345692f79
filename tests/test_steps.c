/*
 * test_steps.c -- how many steps a period are chosen: enough by the reference, not many more than
 * needed, whatever was chosen before, and a remedy named where no number will do.
 */
#include "check.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include <pendres/context.h>
#include "oracle/reference.h"
#include <pendres/strobe.h>

#include "engine/context_internal.h"
#include "engine/block.h"
#include "engine/steps.h"

static const double pi = 3.14159265358979323846;

static double next_random(uint64_t *z)
{
  *z = *z * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(*z >> 11) * 0x1p-53;
}

static pendres_context *context_of(int steps)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.steps_per_period = steps}, &ctx));
  return ctx;
}

static int choose(pendres_context *ctx, const pendres_pendulum *p, double speed, double tolerance)
{
  int steps = 0;
  check_ok(pendres_steps_choose(ctx, p, speed, tolerance, &steps));
  return steps;
}

/* A pendulum of the kind that scenes compute, its speed, and a tolerance of one period. */
static void draw(uint64_t *z, pendres_pendulum *p, double *speed, double *tolerance)
{
  *p = (pendres_pendulum){.damping = 0.02 * pow(100.0, next_random(z)),
                          .drive_amplitude = next_random(z),
                          .drive_frequency = 0.3 * pow(8.0, next_random(z))};
  *speed = 3.0 * next_random(z);
  *tolerance = pow(10.0, -4.0 - 8.0 * next_random(z));
}

enum { STARTS = 12 };

/*
 * Largest error of one period with this many steps, by the reference, over starts with speeds up
 * to `speed`. Those whose errors grow more than tenfold are passed over: no steps help them.
 */
static double error_with(int steps, const pendres_pendulum *p, double speed, uint64_t z)
{
  pendres_context *ctx = context_of(steps);
  double largest = 0.0;
  for (int i = 0; i < STARTS; i++) {
    double x = 2.0 * pi * next_random(&z) - 0.5 * pi, v = speed * (2.0 * next_random(&z) - 1.0);
    reference_image image;
    const long double y = (long double)x - 1.57079632679489661923132169163975L;
    check_ok(reference_map(p, y, v, 1, &image));
    double growth = 0.0;
    for (int k = 0; k < 4; k++)
      growth = fmax(growth, (double)fabsl(image.monodromy[k / 2][k % 2]));
    if (growth > 10.0) continue;
    check_ok(pendres_strobe_advance(ctx, 1, p, &x, &v, 1, NULL));
    const long double there =
      image.y + 1.57079632679489661923132169163975L + 6.28318530717958647692528676655901L
        * image.turns;
    largest = fmax(largest, (double)fmaxl(fabsl(x - there), fabsl(v - image.v)));
  }
  pendres_context_free(ctx);
  return largest;
}

/*
 * The tolerance is kept: sixteen probes stand for all starts, so that one between them may exceed
 * it a little; 1e-14 is rounding. And it is not kept by waste: with half as many steps an error
 * of order eight is 256 times as large, and most of the time too large.
 */
static void enough_and_no_more(void **state)
{
  enum { DRAWS = 150 };
  pendres_context *ctx = context_of(0);
  uint64_t z = 7;
  int wasteful = 0, judged = 0;
  (void)state;
  for (int k = 0; k < DRAWS; k++) {
    pendres_pendulum p;
    double speed, tolerance;
    draw(&z, &p, &speed, &tolerance);
    const int steps = choose(ctx, &p, speed, tolerance);
    const double error = error_with(steps, &p, speed, z);
    if (!(error <= 1.5 * tolerance + 1e-14))
      print_error("damping %g, drive %g at %g, speed %g: %d steps, error %g, tolerance %g\n",
                  p.damping, p.drive_amplitude, p.drive_frequency, speed, steps, error, tolerance);
    assert_true(error <= 1.5 * tolerance + 1e-14);
    if (steps < 16) continue; /* half of it would be fewer than the ladder has */
    judged++;
    wasteful += error_with(steps / 2, &p, speed, z) < tolerance;
  }
  print_message("half the steps would have done %d times of %d\n", wasteful, judged);
  assert_true(judged > DRAWS / 2);
  assert_true(wasteful < judged / 5);
  pendres_context_free(ctx);
}

/* In any order, with any others before: the same. */
static void whatever_came_before(void **state)
{
  enum { DRAWS = 40 };
  pendres_pendulum p[DRAWS];
  double speed[DRAWS], tolerance[DRAWS];
  int steps[DRAWS];
  uint64_t z = 3;
  pendres_context *one = context_of(0);
  (void)state;
  for (int k = 0; k < DRAWS; k++) {
    draw(&z, &p[k], &speed[k], &tolerance[k]);
    steps[k] = choose(one, &p[k], speed[k], tolerance[k]);
  }
  pendres_context *other = context_of(0);
  for (int k = DRAWS; k-- > 0;) {
    assert_int_equal(choose(other, &p[k], speed[k], tolerance[k]), steps[k]);
    assert_int_equal(choose(one, &p[k], speed[k], tolerance[k]), steps[k]);
  }
  pendres_context_free(one);
  pendres_context_free(other);
}

/*
 * Explicit steps h are stable up to h damping = 4 or so (the tables' real stability interval), and
 * are not asked for fewer; beyond a million a period the message names what to do.
 */
static void stiff_pendulums(void **state)
{
  pendres_context *ctx = context_of(0);
  (void)state;
  for (double damping = 1.0; damping < 2000.0; damping *= 4.0) {
    const pendres_pendulum p = {
      .damping = damping, .drive_amplitude = 0.2, .drive_frequency = 0.5};
    const int steps = choose(ctx, &p, 1.0, 1e-6);
    assert_true(2.0 * pi / 0.5 / steps * damping <= 4.0);
  }
  const pendres_pendulum stiff = {
    .damping = 1000.0, .drive_amplitude = 0.2, .drive_frequency = 0.001};
  int steps = -1;
  assert_int_equal(pendres_steps_choose(ctx, &stiff, 1.0, 1e-6, &steps),
                   PENDRES_TOLERANCE_UNREACHABLE);
  assert_int_equal(steps, -1);
  assert_non_null(strstr(pendres_context_message(ctx), "cvode_bdf"));
  assert_non_null(strstr(pendres_context_message(ctx), "the damping needs"));
  pendres_context_free(ctx);
}

/* What is so fast that a million steps a period are less than one a radian, of a force that goes up
   and down with it, is refused at once: nothing is integrated to find that out. */
static void too_fast_to_be_tried(void **state)
{
  const pendres_pendulum squid = {.damping = 0.1, .drive_amplitude = 0.1, .drive_frequency = 0.6,
                                  .force = PENDRES_FORCE_SQUID, .force_coefficients = {0.6}};
  pendres_context *ctx = context_of(0);
  pendres_block *flow = NULL;
  int steps = -1;
  (void)state;
  check_ok(pendres_block_of(ctx, PENDRES_FLOW_STATE, &flow));
  assert_int_equal(pendres_steps_choose(ctx, &squid, 1e6, 1e-6, &steps),
                   PENDRES_TOLERANCE_UNREACHABLE);
  assert_int_equal(steps, -1);
  check_near(pendres_block_evaluations(flow), 0.0, 0.0);
  assert_true(choose(ctx, &squid, 100.0, 1e-6) > 0);
  assert_true(pendres_block_evaluations(flow) > 0.0);
  pendres_context_free(ctx);
}

/* Even numbers, for halves of a period; an eighth apart, for there to be few of them. */
static void ladder(void **state)
{
  (void)state;
  for (int rung = pendres_steps_rung(1), next; rung < 1000000; rung = next) {
    next = pendres_steps_rung(rung + 1);
    assert_int_equal(rung % 2, 0);
    assert_int_equal(pendres_steps_rung(rung), rung);
    assert_true(next > rung && (next - rung <= 2 || next <= 1.126 * rung));
  }
}

static void asked_for(void **state)
{
  pendres_context *ctx = context_of(37);
  const pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 0.2, .drive_frequency = 1.0};
  (void)state;
  assert_int_equal(choose(ctx, &p, 1.0, 1e-12), 37);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(enough_and_no_more), cmocka_unit_test(whatever_came_before),
    cmocka_unit_test(stiff_pendulums),    cmocka_unit_test(ladder),
    cmocka_unit_test(asked_for),          cmocka_unit_test(too_fast_to_be_tried),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
