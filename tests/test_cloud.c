/*
 * test_cloud.c -- clouds around attractors, made at once or in parts; clouds that are not followed;
 * and the response of an ensemble under noise.
 */
#include "langevin_fixture.h"

#include <float.h>
#include <string.h>

#include <pendres/cloud.h>
#include <pendres/response.h>
#include <pendres/switching.h>

static pendres_attractors *attractors_of(pendres_context *ctx, pendres_pendulum p)
{
  pendres_attractors *set = NULL;
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
  return set;
}

/* Parts cover all trajectories once, none of them alone. */
static void parts_cover_everything(void **state)
{
  (void)state;
  for (size_t n = 2; n < 2000; n += 7) {
    const pendres_cloud_request q = {.trajectories = n};
    size_t next = 0, first;
    for (size_t part = 0; part < pendres_cloud_parts(&q); part++) {
      const size_t count = pendres_cloud_part(&q, part, &first);
      assert_int_equal(first, next);
      assert_true(count >= 2 && count <= 192);
      next += count;
    }
    assert_int_equal(next, n);
  }
}

/* Bit for bit, whatever the blocks; steps that are given are used, and their bias is told. */
static void parts_make_the_whole(void **state)
{
  enum { N = 500, RECORD = 6, PARTS = 3 };
  static double x[2][N * RECORD], v[2][N * RECORD];
  pendres_context *ctx = make(4, 0, 192), *other = make(4, 0, 24);
  pendres_attractors *set = attractors_of(ctx, figure7(0.0));
  pendres_cloud_request q = {.set = set, .temperature = 0.01, .attractor = 1, .trajectories = N,
                             .record = RECORD};
  pendres_langevin_cloud part[PARTS];
  pendres_cloud whole, sum;
  (void)state;
  check_ok(pendres_cloud_find(ctx, &q, &whole, x[0], v[0]));
  check_ok(pendres_cloud_prepare(other, &q, &sum, NULL, NULL));
  assert_int_equal(sum.way, PENDRES_CLOUD_FOLLOWED);
  q.steps_per_period = sum.bias.steps_per_period;
  assert_int_equal(pendres_cloud_parts(&q), PARTS);
  for (size_t k = PARTS; k-- > 0;) {
    size_t first;
    (void)pendres_cloud_part(&q, k, &first);
    check_ok(pendres_cloud_follow(other, &q, k, &part[k], x[1] + first * RECORD,
                                  v[1] + first * RECORD));
  }
  check_ok(pendres_cloud_conclude(&q, PARTS, part, &sum));
  assert_memory_equal(x[0], x[1], sizeof x[0]);
  assert_memory_equal(v[0], v[1], sizeof v[0]);
  assert_memory_equal(&sum.measured, &whole.measured, sizeof sum.measured);
  assert_memory_equal(&sum.escape_rate, &whole.escape_rate, sizeof sum.escape_rate);
  assert_int_equal(sum.verdict, whole.verdict);
  assert_true(whole.measured.left > 0);
  q.steps_per_period = 4;
  check_ok(pendres_cloud_prepare(ctx, &q, &sum, NULL, NULL));
  assert_int_equal(sum.bias.steps_per_period, 4);
  assert_true(fabs(sum.bias.statistics[PENDRES_LANGEVIN_COV_XX].value) >
              fabs(whole.bias.statistics[PENDRES_LANGEVIN_COV_XX].value));
  pendres_attractors_free(set);
  pendres_context_free(ctx);
  pendres_context_free(other);
}

/* At temperature 0 a cloud is its orbit; an orbit of two periods has two points, which no linear
 * theory knows; what runs has no cloud. */
static void clouds_without_noise(void **state)
{
  enum { RECORD = 3 };
  double x[2 * RECORD], v[2 * RECORD];
  pendres_context *ctx = make(0, 0, 64);
  pendres_attractors *set = attractors_of(ctx, figure7(0.0));
  pendres_cloud_request q = {.set = set, .trajectories = 2, .record = RECORD};
  pendres_cloud c;
  (void)state;
  const pendres_orbit *o = &pendres_attractors_get(set, 0)->orbit;
  check_ok(pendres_cloud_find(ctx, &q, &c, x, v));
  assert_int_equal(c.way, PENDRES_CLOUD_STILL);
  assert_int_equal(c.verdict, PENDRES_CLOUD_AGREES);
  for (int k = 0; k < 2 * RECORD; k++) assert_true(x[k] == o->x && v[k] == o->v);
  assert_true(c.measured.statistics[PENDRES_LANGEVIN_LOOP_AREA].value == o->loop_area);
  check_near(c.measured.phase_lag.value, o->phase_lag, o->phase_lag_error + DBL_EPSILON);
  assert_true(c.escape_rate.value == 0.0 && c.bias.steps_per_period == 0);
  /* So cold that theory is exact, and in proportion to the temperature. */
  q.temperature = 1e-20;
  check_ok(pendres_cloud_find(ctx, &q, &c, x, v));
  assert_int_equal(c.way, PENDRES_CLOUD_NARROW);
  assert_int_equal(c.verdict, PENDRES_CLOUD_BELOW_ROUNDING);
  assert_true(c.linear.xx > 0.0 && c.linear.xx < 10.0 * q.temperature);
  assert_true(c.measured.statistics[PENDRES_LANGEVIN_COV_XX].value == c.linear.xx);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

static void wrong_requests_are_refused(void **state)
{
  pendres_context *ctx = make(0, 0, 64);
  pendres_attractors *set = attractors_of(ctx, figure7(0.0));
  const pendres_cloud_request good = {.set = set, .temperature = 1e-3, .trajectories = 2,
                                      .record = 1};
  pendres_cloud_request bad[7];
  pendres_cloud c;
  (void)state;
  for (int i = 0; i < 7; i++) bad[i] = good;
  bad[0].attractor = 9;
  bad[1].temperature = -1.0;
  bad[2].temperature = NAN;
  bad[3].trajectories = 1;
  bad[4].record = 0;
  bad[5].steps_per_period = 1;
  bad[6].trajectories = SIZE_MAX;
  for (int i = 0; i < 7; i++) {
    assert_int_equal(pendres_cloud_find(ctx, &bad[i], &c, NULL, NULL),
                     PENDRES_INVALID_ARGUMENT);
    assert_true(strlen(pendres_context_message(ctx)) > 10);
  }
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

/* A rotation without a lock has a point, but comes back to none: no cloud around it, with noise or
   without, and no rates of leaving it or for it. */
static void rotations_have_no_cloud(void **state)
{
  const pendres_pendulum p = {
    .damping = 0.12, .drive_amplitude = 0.1, .drive_frequency = 1.2, .torque = 0.4};
  pendres_context *ctx = make(0, 0, 64);
  pendres_attractors *set = attractors_of(ctx, p);
  pendres_switching_tally tally;
  pendres_cloud cloud;
  double x[2], v[2];
  size_t met = 0;
  (void)state;
  for (size_t i = 0; i < pendres_attractors_count(set); i++) {
    pendres_pendulum hot = p;
    hot.temperature = 0.01;
    const pendres_switching_request from = {
      .pendulum = hot, .set = set, .from = i, .trajectories = 1, .periods = 1};
    assert_int_equal(pendres_switching_count(ctx, &from, &tally), PENDRES_INVALID_ARGUMENT);
    if (pendres_attractors_get(set, i)->label != PENDRES_LABEL_QUASI_PERIODIC) continue;
    for (int warm = 0; warm < 2; warm++) {
      const pendres_cloud_request q = {.set = set, .attractor = i, .temperature = 0.01 * warm,
                                       .trajectories = 2, .record = 1};
      check_ok(pendres_cloud_prepare(ctx, &q, &cloud, x, v));
      assert_int_equal(cloud.way, PENDRES_CLOUD_NONE);
      assert_true(isnan(x[0]) && isnan(cloud.measured.statistics[PENDRES_LANGEVIN_COV_XX].value));
    }
    met++;
  }
  assert_int_equal(met, 1);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

/*
 * A weakly driven pendulum in the cold is a harmonic oscillator, whose mean response noise does not
 * change but by terms of order T: y^3/6 makes the spring softer by <y^2>/2 = T/2, and the response
 * A and lag change by their slopes there, of order T/gamma. And what the mean is of is the members'
 * shares: nobody else is followed.
 */
static void responses_stay_what_they_are_in_the_cold(void **state)
{
  const pendres_pendulum p = {.damping = 0.3, .drive_amplitude = 0.01, .drive_frequency = 0.9};
  const pendres_ensemble e = {.members = 10, .x_first = -PI / 2.0, .x_last = 1.5 * PI};
  const double T = 1e-6;
  pendres_context *ctx = make(8, 0, 64);
  pendres_response still;
  pendres_response_noise noisy, again;
  (void)state;
  check_ok(pendres_response_find(ctx, 1, &p, &e, &still));
  check_ok(pendres_response_noise_find(ctx, &still, 0.0, 50, 20, &noisy));
  assert_true(noisy.loop_area.value == still.mean_loop_area);
  assert_true(noisy.phase_lag.value == still.phase_lag && noisy.steps_per_period == 0);
  check_ok(pendres_response_noise_find(ctx, &still, T, 50, 20, &noisy));
  check_ok(pendres_response_noise_find(ctx, &still, T, 50, 20, &again));
  assert_memory_equal(&noisy, &again, sizeof noisy);
  const pendres_response_mean *m[3] = {&noisy.loop_area, &noisy.phase_lag, &noisy.mean_power};
  const double want[3] = {still.mean_loop_area, still.phase_lag, still.mean_power};
  for (int i = 0; i < 3; i++) {
    check_near(m[i]->value - m[i]->bias, want[i],
               sigmas * hypot(m[i]->error, m[i]->bias_error) + 10.0 * T / p.damping);
    assert_true(m[i]->error > 0.0 && m[i]->error < 0.05 * want[i]);
  }
  check_relative(noisy.mean_power.value, noisy.loop_area.value * 0.9 / (2.0 * PI), 1e-14);
  assert_int_equal(pendres_response_noise_find(ctx, &still, -1.0, 50, 20, &noisy),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_response_noise_find(ctx, &still, T, 0, 20, &noisy),
                   PENDRES_INVALID_ARGUMENT);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(parts_cover_everything),
    cmocka_unit_test(parts_make_the_whole),
    cmocka_unit_test(clouds_without_noise),
    cmocka_unit_test(wrong_requests_are_refused),
    cmocka_unit_test(rotations_have_no_cloud),
    cmocka_unit_test(responses_stay_what_they_are_in_the_cold),
  };
  return cmocka_run_group_tests_name("cloud", tests, NULL, NULL);
}
