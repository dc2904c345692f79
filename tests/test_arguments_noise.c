/*
 * test_arguments_noise.c -- invalid arguments of functions that deal with noise.
 */
#define _XOPEN_SOURCE 700 /* mkdtemp */

#include "arguments_plain_fixture.h"

static void noise(void **state)
{
  int wrong = 0;
  double x = 1.0, v = 0.0;
  pendres_langevin_linear linear;
  pendres_langevin_cloud cloud;
  pendres_langevin_bias bias;
  pendres_context *ctx = make(1, 16, 8);
  const unsigned all = PENDRES_LANGEVIN_CLOUD;
  const pendres_langevin_request request = {
    .pendulum = good, .x = 1.0, .trajectories = 2, .record = 1 };
  (void)state;
  INVALID(pendres_langevin_advance(NULL, RUN(1, &good, NULL, 0, 1, NULL), &x, &v));
  INVALID(pendres_langevin_advance(ctx, RUN(1, NULL, NULL, 0, 1, NULL), &x, &v));
  INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, 1, NULL), NULL, &v));
  INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, 1, NULL), &x, NULL));
  INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, -1, 1, NULL), &x, &v));
  INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, LONG_MAX, NULL), &x, &v));
  INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, LONG_MAX, LONG_MAX, NULL), &x, &v));
  const pendres_langevin_observer blind = { NULL, NULL, 0 };
  INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, 1, &blind), &x, &v));
  INVALID(pendres_langevin_advance(ctx, NULL, &x, &v));
  for (int i = 0; i < 3; i++) {
    const int steps[3] = { 1, INT_MIN, INT_MAX };
    const pendres_langevin_run run = { .n = 1, .pendulums = &good, .steps_per_period = steps[i] };
    INVALID(pendres_langevin_advance(ctx, &run, &x, &v));
  }
  INVALID(pendres_langevin_cloud_find(NULL, &request, &cloud, NULL, NULL));
  INVALID(pendres_langevin_cloud_find(ctx, NULL, &cloud, NULL, NULL));
  INVALID(pendres_langevin_cloud_find(ctx, &request, NULL, NULL, NULL));
  INVALID(pendres_langevin_cloud_find(ctx, &request, &cloud, &x, NULL));
  INVALID(pendres_langevin_choose_steps(ctx, NULL, all, 0.1, &bias));
  INVALID(pendres_langevin_choose_steps(ctx, &request, all, 0.1, NULL));
  INVALID(pendres_langevin_choose_steps(ctx, &request, 0, 0.1, &bias));
  INVALID(pendres_langevin_choose_steps(ctx, &request, ~0u, 0.1, &bias));
  INVALID(pendres_langevin_choose_steps(ctx, &request, all, NAN, &bias));
  INVALID(pendres_langevin_choose_steps(ctx, &request, all, -1.0, &bias));
  for (size_t i = 0; i < COUNT(bad_pendulums); i++) {
    pendres_langevin_request r = request;
    r.pendulum = bad_pendulums[i];
    INVALID(pendres_langevin_advance(ctx, RUN(1, &bad_pendulums[i], NULL, 0, 1, NULL), &x, &v));
    INVALID(pendres_langevin_cloud_find(ctx, &r, &cloud, NULL, NULL));
    INVALID(pendres_langevin_choose_steps(ctx, &r, all, 0.1, &bias));
    INVALID(pendres_langevin_linear_find(&bad_pendulums[i], x, v, 1, &linear));
  }
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    double b = bad_numbers[i];
    pendres_langevin_request r = request;
    *(i % 2 ? &r.x : &r.v) = b;
    INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, 1, NULL), &b, &v));
    INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, 1, NULL), &x, &b));
    INVALID(pendres_langevin_cloud_find(ctx, &r, &cloud, NULL, NULL));
    INVALID(pendres_langevin_linear_find(&good, b, v, 1, &linear));
    INVALID(pendres_langevin_linear_find(&good, x, b, 1, &linear));
  }
  INVALID(pendres_langevin_linear_find(NULL, x, v, 1, &linear));
  INVALID(pendres_langevin_linear_find(&good, x, v, 0, &linear));
  INVALID(pendres_langevin_linear_find(&good, x, v, 1, NULL));
  assert_int_not_equal(pendres_langevin_linear_find(&good, x, v, INT_MAX, &linear), PENDRES_OK);
  assert_true(x == 1.0 && v == 0.0);
  pendres_context_free(ctx);
  assert_int_equal(wrong, 0);
}

/* Surveys of two states without any attractors, or of nothing. */
static void surveys(pendres_context *ctx, int *failed)
{
  int wrong = 0, steps, two[2] = { 7, 7 };
  const double t = 0.01;
  double depth;
  const pendres_switching_survey q = { .trajectories = 2, .periods = 1, .steps_per_period = 16 };
  pendres_switching_tally tally = { 0 };
  pendres_switching_rates rates;
  pendres_switching_activation energy[PENDRES_SWITCHING_WAYS];
  pendres_switching_states(NULL, two);
  assert_true(two[0] == -1 && two[1] == -1);
  pendres_switching_states(NULL, NULL);
  for (int i = 0; i < 2; i++) {
    const pendres_switching_survey *s = i == 0 ? NULL : &q;
    INVALID(pendres_switching_find(ctx, s, 1, &t, &rates, energy));
    INVALID(pendres_switching_choose_steps(ctx, s, 0, &steps));
    INVALID(pendres_switching_follow(ctx, s, t, 0, &tally));
    pendres_escapes *ways = NULL;
    INVALID(pendres_escapes_find(ctx, NULL, 0, i == 0 ? NULL : &ways));
    assert_int_equal(pendres_escapes_count(ways), 0);
    assert_null(pendres_escapes_get(ways, 0));
    pendres_escapes_free(ways);
    INVALID(pendres_switching_depth(ctx, NULL, 0, i == 0 ? NULL : &depth));
    INVALID(pendres_switching_conclude(s, t, &tally, &rates));
    INVALID(pendres_switching_activate(s, 1, &rates, energy));
  }
  INVALID(pendres_switching_find(NULL, &q, 1, &t, &rates, energy));
  INVALID(pendres_switching_find(ctx, &q, 1, NULL, &rates, energy));
  INVALID(pendres_switching_find(ctx, &q, 1, &t, NULL, energy));
  INVALID(pendres_switching_find(ctx, &q, 1, &t, &rates, NULL));
  INVALID(pendres_switching_choose_steps(ctx, &q, 0, NULL));
  INVALID(pendres_switching_choose_steps(ctx, &q, 2, &steps));
  INVALID(pendres_switching_follow(ctx, &q, t, SIZE_MAX, &tally));
  INVALID(pendres_switching_follow(ctx, &q, t, 0, NULL));
  INVALID(pendres_switching_conclude(&q, t, &tally, NULL));
  INVALID(pendres_switching_activate(&q, 1, NULL, energy));
  INVALID(pendres_switching_activate(&q, 1, &rates, NULL));
  assert_int_equal(pendres_switching_parts(NULL), 0);
  *failed += wrong;
}

/* Clouds and responses of nothing. */
static void clouds(void **state)
{
  int wrong = 0;
  double x = 1.0;
  size_t first = 7;
  pendres_context *ctx = make(1, 16, 8);
  const pendres_cloud_request q = { .temperature = 1e-3, .trajectories = 2, .record = 1,
                                    .steps_per_period = 16 };
  pendres_cloud cloud;
  pendres_langevin_cloud part;
  pendres_response still = { .pendulum = good };
  pendres_response_noise noisy;
  (void)state;
  for (int i = 0; i < 2; i++) {
    const pendres_cloud_request *r = i == 0 ? NULL : &q;
    INVALID(pendres_cloud_find(ctx, r, &cloud, NULL, NULL));
    INVALID(pendres_cloud_prepare(ctx, r, &cloud, NULL, NULL));
    INVALID(pendres_cloud_prepare(ctx, r, &cloud, &x, NULL));
    INVALID(pendres_cloud_follow(ctx, r, 0, &part, NULL, NULL));
    INVALID(pendres_cloud_conclude(r, 1, &part, &cloud));
  }
  INVALID(pendres_cloud_find(NULL, &q, &cloud, NULL, NULL));
  INVALID(pendres_cloud_find(ctx, &q, NULL, NULL, NULL));
  INVALID(pendres_cloud_prepare(ctx, &q, NULL, NULL, NULL));
  INVALID(pendres_cloud_follow(ctx, &q, SIZE_MAX, &part, NULL, NULL));
  INVALID(pendres_cloud_follow(ctx, &q, 0, NULL, NULL, NULL));
  INVALID(pendres_cloud_conclude(&q, 1, &part, NULL));
  assert_int_equal(pendres_cloud_parts(NULL), 0);
  assert_int_equal(pendres_cloud_part(NULL, 0, &first), 0);
  assert_int_equal(pendres_cloud_part(&q, SIZE_MAX, NULL), 0);
  INVALID(pendres_response_noise_find(NULL, &still, 0.0, 2, 1, &noisy));
  INVALID(pendres_response_noise_find(ctx, NULL, 0.0, 2, 1, &noisy));
  INVALID(pendres_response_noise_find(ctx, &still, 0.0, 2, 1, NULL));
  INVALID(pendres_response_noise_find(ctx, &still, 0.0, 2, -1, &noisy));
  for (size_t i = 0; i < 3; i++)
    INVALID(pendres_response_noise_find(ctx, &still, bad_numbers[i], 2, 1, &noisy));
  still.states = SIZE_MAX;
  INVALID(pendres_response_noise_find(ctx, &still, 0.0, 2, 1, &noisy));
  assert_true(first == 0 && x == 1.0);
  pendres_context_free(ctx);
  assert_int_equal(wrong, 0);
}

static void switching(void **state)
{
  int wrong = 0;
  pendres_switching_tally tally = { 0 };
  pendres_switching_rate rate;
  pendres_switching_activation energy;
  pendres_context *ctx = make(1, 16, 8);
  const pendres_switching_request nowhere = { .pendulum = good, .trajectories = 2, .periods = 1 };
  const double t[3] = { 0.01, 0.02, 0.03 };
  pendres_switching_rate r[3];
  (void)state;
  INVALID(pendres_switching_count(NULL, &nowhere, &tally));
  INVALID(pendres_switching_count(ctx, NULL, &tally));
  INVALID(pendres_switching_count(ctx, &nowhere, NULL));
  INVALID(pendres_switching_count(ctx, &nowhere, &tally)); /* no attractors */
  pendres_switching_add(NULL, &tally);
  pendres_switching_add(&tally, NULL);
  INVALID(pendres_switching_rate_of(NULL, 0, 0, 0.9, &rate));
  INVALID(pendres_switching_rate_of(&tally, 0, 0, 0.9, NULL));
  INVALID(pendres_switching_rate_of(&tally, SIZE_MAX, 0, 0.9, &rate));
  INVALID(pendres_switching_rate_of(&tally, 0, SIZE_MAX, 0.9, &rate));
  INVALID(pendres_switching_rate_of(&tally, 0, 0, NAN, &rate));
  INVALID(pendres_switching_rate_of(&tally, 0, 0, 1.0, &rate));
  for (size_t i = 0; i < 3; i++)
    r[i] = (pendres_switching_rate){ .events = 100.0, .value = exp(-0.1 / t[i]),
                                     .error = 0.1 * exp(-0.1 / t[i]) };
  check_ok(pendres_switching_fit(3, t, r, 0.0, &energy));
  INVALID(pendres_switching_fit(3, NULL, r, 0.0, &energy));
  INVALID(pendres_switching_fit(3, t, NULL, 0.0, &energy));
  INVALID(pendres_switching_fit(3, t, r, 0.0, NULL));
  for (size_t i = 0; i < 6; i++) {
    const pendres_switching_rate kept = r[1];
    const double bad[] = { NAN, INFINITY, -1.0 };
    *(i % 2 ? &r[1].value : &r[1].error) = bad[i / 2];
    INVALID(pendres_switching_fit(3, t, r, 0.0, &energy));
    r[1] = kept;
  }
  surveys(ctx, &wrong);
  pendres_context_free(ctx);
  assert_int_equal(wrong, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(noise),
    cmocka_unit_test(switching),
    cmocka_unit_test(clouds),
  };
  return cmocka_run_group_tests_name("arguments_noise", tests, NULL, NULL);
}
