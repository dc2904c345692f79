/*
 * test_langevin_run.c -- noisy runs: the same bytes however they are cut; observers; refusals.
 */
#include "langevin_fixture.h"

#include <string.h>

#include "noise/noise_common.h"

/* ---- The same bytes ---------------------------------------------------------------------- */

enum { MANY = 100 };

static void start(pendres_pendulum *p, double *x, double *v)
{
  for (int i = 0; i < MANY; i++) {
    p[i] = (pendres_pendulum){0.05 + 0.01 * i, 0.2, 0.6 + 0.005 * i, i % 7 == 0 ? 0.0 : 0.3};
    x[i] = 0.1 * i;
    v[i] = 0.02 * i;
  }
}

static void same_bytes_whatever_the_run(void **state)
{
  (void)state;
  pendres_pendulum p[MANY], one[MANY];
  double x[MANY], v[MANY], a[MANY], b[MANY];
  uint64_t ids[MANY];
  pendres_context *ctx = make(0x123456789abcdef0u, 20, 192);
  start(p, x, v);
  check_ok(pendres_langevin_advance(ctx, RUN(MANY, p, NULL, 0, 30, NULL), x, v));

  /* Smaller blocks, and cut in three, by another handle each time. */
  for (int lanes = 8; lanes <= 64; lanes *= 8) {
    pendres_context *other = make(0x123456789abcdef0u, 20, lanes);
    start(one, a, b);
    check_ok(pendres_langevin_advance(other, RUN(MANY, one, NULL, 0, 11, NULL), a, b));
    check_ok(pendres_langevin_advance(other, RUN(MANY, one, NULL, 11, 1, NULL), a, b));
    pendres_context_free(other);
    other = make(0x123456789abcdef0u, 20, lanes);
    check_ok(pendres_langevin_advance(other, RUN(MANY, one, NULL, 12, 18, NULL), a, b));
    assert_memory_equal(a, x, sizeof x);
    assert_memory_equal(b, v, sizeof v);
    pendres_context_free(other);
  }

  /* Some of them, backwards: ids say who is who. */
  start(one, a, b);
  double few_x[MANY], few_v[MANY];
  for (int i = 0; i < MANY / 2; i++) {
    const int j = MANY - 1 - 2 * i;
    ids[i] = (uint64_t)j;
    p[i] = one[j];
    few_x[i] = a[j];
    few_v[i] = b[j];
  }
  check_ok(pendres_langevin_advance(ctx, RUN(MANY / 2, p, ids, 0, 30, NULL), few_x, few_v));
  for (int i = 0; i < MANY / 2; i++) {
    assert_memory_equal(&few_x[i], &x[ids[i]], sizeof *x);
    assert_memory_equal(&few_v[i], &v[ids[i]], sizeof *v);
  }
  /* Another seed is another noise, but not for those without temperature. */
  pendres_context *other = make(1, 20, 192);
  start(one, a, b);
  check_ok(pendres_langevin_advance(other, RUN(MANY, one, NULL, 0, 30, NULL), a, b));
  for (int i = 0; i < MANY; i++) assert_int_equal(a[i] == x[i], i % 7 == 0);
  pendres_context_free(other);
  pendres_context_free(ctx);
}

static void clouds_do_not_depend_on_blocks(void **state)
{
  (void)state;
  const pendres_langevin_request q = {.pendulum = figure7(1e-3), .x = 2.1, .v = 0.1,
                                      .trajectories = 333, .settle = 3, .record = 5};
  pendres_langevin_cloud c[2];
  pendres_langevin_bias b[2];
  memset(c, 0, sizeof c);
  memset(b, 0, sizeof b);
  for (int i = 0; i < 2; i++) {
    pendres_context *ctx = make(21, 16, i == 0 ? 192 : 24);
    check_ok(pendres_langevin_measure_bias(ctx, &q, &b[i]));
    check_ok(pendres_langevin_cloud_find(ctx, &q, &c[i], NULL, NULL));
    assert_int_equal(b[i].steps_per_period, 16);
    pendres_context_free(ctx);
  }
  assert_memory_equal(&c[0].statistics, &c[1].statistics, sizeof c[0].statistics);
  assert_memory_equal(&b[0].statistics, &b[1].statistics, sizeof b[0].statistics);
}

/* Parts of a cloud make the statistics of the whole. */
static void merging_parts_is_exact(void **state)
{
  enum { N = 37, CUT = 15, RECORD = 4 };
  const pendres_pendulum p = { 0.3, 0.2, 0.9, 0.05 };
  pendres_langevin_request q = { .pendulum = p, .x = 1.7, .v = 0.1, .trajectories = N, .settle = 3,
                                 .record = RECORD, .first_id = 77 };
  pendres_langevin_cloud whole, merged, parts[3];
  pendres_context *ctx = make(0, 24, 192);
  (void)state;
  check_ok(pendres_langevin_cloud_find(ctx, &q, &whole, NULL, NULL));
  q.trajectories = CUT;
  check_ok(pendres_langevin_cloud_find(ctx, &q, &parts[0], NULL, NULL));
  q.first_id += CUT;
  q.trajectories = N - CUT;
  check_ok(pendres_langevin_cloud_find(ctx, &q, &parts[1], NULL, NULL));
  /* One of which nothing is left. */
  parts[2] = (pendres_langevin_cloud){ .left = 2, .exposure = 5.0, .phase_lag = { NAN, NAN } };
  for (int s = 0; s < PENDRES_LANGEVIN_STATISTICS; s++)
    parts[2].statistics[s] = (pendres_langevin_estimate){ NAN, NAN };
  check_ok(pendres_langevin_merge(3, parts, &merged));
  for (int s = 0; s < PENDRES_LANGEVIN_STATISTICS; s++) {
    check_near(merged.statistics[s].value, whole.statistics[s].value, 1e-14);
    /* Errors come from fewer trajectories each: their own scatter is 1/sqrt(2 N). */
    check_relative(merged.statistics[s].error, whole.statistics[s].error, 0.25);
  }
  check_near(merged.phase_lag.value, whole.phase_lag.value, 1e-14);
  check_relative(merged.phase_lag.error, whole.phase_lag.error, 0.25);
  check_near(merged.exposure, whole.exposure + 5.0, 0.0);
  assert_int_equal(merged.left, 2);
  pendres_context_free(ctx);
}

/* ---- Refusals ---------------------------------------------------------------------------- */

static void wrong_arguments_are_refused(void **state)
{
  (void)state;
  static const double wrong[3] = {-1e-4, NAN, INFINITY};
  pendres_context *ctx = make(0, 16, 8);
  pendres_langevin_cloud c;
  pendres_langevin_bias b;
  for (int i = 0; i < 3; i++) {
    pendres_pendulum p[2] = {figure7(0.0), figure7(wrong[i])};
    double x[2] = {1.0, 1.0}, v[2] = {0.0, 0.0};
    const pendres_langevin_request q = {.pendulum = p[1], .trajectories = 8, .record = 1};
    assert_int_equal(pendres_langevin_advance(ctx, RUN(2, p, NULL, 0, 5, NULL), x, v),
                     PENDRES_INVALID_ARGUMENT);
    assert_non_null(strstr(pendres_context_message(ctx), "trajectory 1"));
    assert_non_null(strstr(pendres_context_message(ctx), "temperature"));
    assert_true(x[0] == 1.0 && x[1] == 1.0 && v[0] == 0.0);
    assert_int_equal(pendres_langevin_cloud_find(ctx, &q, &c, NULL, NULL),
                     PENDRES_INVALID_ARGUMENT);
    assert_int_equal(pendres_langevin_measure_bias(ctx, &q, &b), PENDRES_INVALID_ARGUMENT);
    assert_int_equal(pendres_langevin_choose_steps(ctx, &q, PENDRES_LANGEVIN_CLOUD, 0.01, &b),
                     PENDRES_INVALID_ARGUMENT);
    x[0] = wrong[i];
    if (!isfinite(wrong[i]))
      assert_int_equal(pendres_langevin_advance(ctx, RUN(1, p, NULL, 0, 5, NULL), x, v),
                       PENDRES_INVALID_ARGUMENT);
  }
  pendres_pendulum p = figure7(0.0), slow = {0.1, 0.2, 1e-9, 0.1};
  double x = 1.0, v = 0.0;
  assert_int_equal(pendres_langevin_advance(ctx, RUN(1, &p, NULL, -1, 5, NULL), &x, &v),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_langevin_advance(ctx, RUN(1, &p, NULL, 4294967295, 1, NULL), &x, &v),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_langevin_advance(ctx, RUN(1, &slow, NULL, 0, 1, NULL), &x, &v),
                   PENDRES_INVALID_ARGUMENT);
  const int bad_steps[3] = {1, -1, 1000001};
  for (int i = 0; i < 3; i++) {
    const pendres_langevin_run run = {.n = 1, .pendulums = &p, .periods = 1,
                                      .steps_per_period = bad_steps[i]};
    const pendres_langevin_request q = {.pendulum = p, .trajectories = 8, .record = 1,
                                        .steps_per_period = bad_steps[i]};
    assert_int_equal(pendres_langevin_advance(ctx, &run, &x, &v), PENDRES_INVALID_ARGUMENT);
    assert_int_equal(pendres_langevin_cloud_find(ctx, &q, &c, NULL, NULL),
                     PENDRES_INVALID_ARGUMENT);
    assert_int_equal(pendres_langevin_measure_bias(ctx, &q, &b), PENDRES_INVALID_ARGUMENT);
    assert_non_null(strstr(pendres_context_message(ctx), "steps"));
  }
  pendres_context_free(ctx);
}

/* Each trajectory of a block is seen where it belongs; odd blocks of eight stop early. */
static pendres_langevin_answer look(void *arg, const pendres_langevin_strobe *strobe)
{
  double *seen = arg;
  assert_true(strobe->cosine == NULL && strobe->work == NULL);
  for (size_t i = 0; i < strobe->count; i++) seen[strobe->first + i] = strobe->x[i];
  return strobe->first / 8 % 2 == 1 && strobe->period == 7 ? PENDRES_LANGEVIN_ENOUGH
                                                          : PENDRES_LANGEVIN_GO_ON;
}

static void observers_see_what_happens(void **state)
{
  (void)state;
  pendres_pendulum p[MANY];
  double x[MANY], v[MANY], seen[MANY], a[MANY], b[MANY], c[MANY], d[MANY];
  const pendres_langevin_observer observer = {look, seen, 0};
  pendres_context *ctx = make(2, 16, 8);
  start(p, x, v);
  start(p, a, b);
  check_ok(pendres_langevin_advance(ctx, RUN(MANY, p, NULL, 4, 6, &observer), x, v));
  assert_memory_equal(seen, x, sizeof x);
  check_ok(pendres_langevin_advance(ctx, RUN(MANY, p, NULL, 4, 3, NULL), a, b));
  memcpy(c, a, sizeof c);
  memcpy(d, b, sizeof d);
  check_ok(pendres_langevin_advance(ctx, RUN(MANY, p, NULL, 7, 3, NULL), c, d));
  for (int i = 0; i < MANY; i++) check_near(x[i], i / 8 % 2 == 1 ? a[i] : c[i], 0.0);
  pendres_context_free(ctx);
}

static int third_time(void *arg)
{
  return ++*(int *)arg == 3;
}

static pendres_langevin_answer stop_at_two(void *arg, const pendres_langevin_strobe *strobe)
{
  *(long *)arg = strobe->period;
  return strobe->period == 2 ? PENDRES_LANGEVIN_STOP : PENDRES_LANGEVIN_GO_ON;
}

static void interruptions(void **state)
{
  (void)state;
  const pendres_pendulum p = figure7(1e-3);
  pendres_context *ctx = make(0, 16, 8);
  double x = 1.0, v = 0.0;
  int asked = 0;
  long seen = 0;
  pendres_context_set_interrupt(ctx, third_time, &asked);
  assert_int_equal(pendres_langevin_advance(ctx, RUN(1, &p, NULL, 0, 5, NULL), &x, &v),
                   PENDRES_INTERRUPTED);
  check_near(x, 1.0, 0.0);
  pendres_cost cost;
  pendres_context_cost(ctx, &cost);
  check_near(cost.pendulum_periods, 2.0, 0.0); /* 16 steps a period, of two forces each */
  check_near(cost.steps, 32.0, 0.0);
  check_near(cost.rhs_evaluations, 64.0, 0.0);
  pendres_context_set_interrupt(ctx, NULL, NULL);
  const pendres_langevin_observer observer = {stop_at_two, &seen, 0};
  assert_int_equal(pendres_langevin_advance(ctx, RUN(1, &p, NULL, 0, 5, &observer), &x, &v),
                   PENDRES_INTERRUPTED);
  assert_int_equal(seen, 2);
  check_near(x, 1.0, 0.0);
  pendres_context_free(ctx);
}

/*
 * A period of 500000 steps, alone and as the finer of a pair: it ends at the third question, the
 * second within it. 192 lanes are asked about every 300000/192 steps.
 */
static void asked_within_a_period(void **state)
{
  enum { N = 192, STEPS = 500000 };
  (void)state;
  pendres_pendulum p[N];
  double x[N] = {0}, v[N] = {0};
  pendres_context *ctx = make(0, STEPS, N);
  pendres_langevin_bias bias;
  pendres_langevin_cloud cloud;
  int asked = 0;
  for (int i = 0; i < N; i++) p[i] = figure7(1e-3);
  const pendres_langevin_request q = {.pendulum = p[0], .trajectories = N, .record = 1};
  pendres_context_set_interrupt(ctx, third_time, &asked);
  assert_int_equal(pendres_langevin_advance(ctx, RUN(N, p, NULL, 0, 1, NULL), x, v),
                   PENDRES_INTERRUPTED);
  assert_int_equal(asked, 3);
  assert_non_null(strstr(pendres_context_message(ctx), "interrupted"));
  check_near(x[0], 0.0, 0.0);
  pendres_cost cost;
  pendres_context_cost(ctx, &cost);
  check_near(cost.pendulum_periods, 0.0, 0.0);
  asked = 0;
  assert_int_equal(pendres_langevin_cloud_find(ctx, &q, &cloud, NULL, NULL), PENDRES_INTERRUPTED);
  assert_int_equal(asked, 3);
  asked = 0;
  assert_int_equal(pendres_langevin_measure_bias(ctx, &q, &bias), PENDRES_INTERRUPTED);
  assert_int_equal(asked, 3);
  pendres_context_free(ctx);
}

/*
 * Errors from the scatter of two trajectories: the truth lies within one of them as often as within
 * one standard deviation, 68.3 %, where the naive error of two would have it in 50 %. Over 1000
 * pairs the share's own standard deviation is 1.5 %.
 */
static void errors_from_two_trajectories_cover(void **state)
{
  enum { PAIRS = 1000 };
  double x, v, mean[PAIRS], error[PAIRS], truth = 0.0;
  int within = 0;
  (void)state;
  orbit(0, &x, &v);
  pendres_context *ctx = make(17, 16, 8);
  for (int i = 0; i < PAIRS; i++) {
    const pendres_langevin_request q = {.pendulum = figure7(1e-4), .x = x, .v = v,
                                        .trajectories = 2, .settle = 10, .record = 4,
                                        .first_id = 2 * (uint64_t)i};
    pendres_langevin_cloud c;
    check_ok(pendres_langevin_cloud_find(ctx, &q, &c, NULL, NULL));
    mean[i] = c.statistics[PENDRES_LANGEVIN_MEAN_V].value;
    error[i] = c.statistics[PENDRES_LANGEVIN_MEAN_V].error;
    truth += mean[i] / PAIRS;
  }
  for (int i = 0; i < PAIRS; i++) within += fabs(mean[i] - truth) <= error[i];
  check_near((double)within / PAIRS, 0.6827, sigmas * 0.0147);
  pendres_context_free(ctx);
}

/* Numbers beyond the largest double are no cloud, and no bias that would be small enough. */
static void steps_are_not_chosen_by_what_is_no_number(void **state)
{
  (void)state;
  pendres_context *ctx = make(0, 16, 8);
  const pendres_langevin_request q = {
    .pendulum = {.damping = 0.12, .drive_amplitude = 1e200, .drive_frequency = 0.8,
                 .temperature = 1e-4},
    .trajectories = 16, .settle = 2, .record = 4};
  pendres_langevin_bias bias;
  assert_int_not_equal(
    pendres_langevin_choose_steps(ctx, &q, PENDRES_LANGEVIN_CLOUD, 0.01, &bias), PENDRES_OK);
  assert_true(strlen(pendres_context_message(ctx)) > 0);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(same_bytes_whatever_the_run),
    cmocka_unit_test(clouds_do_not_depend_on_blocks),
    cmocka_unit_test(merging_parts_is_exact),
    cmocka_unit_test(wrong_arguments_are_refused),
    cmocka_unit_test(observers_see_what_happens),
    cmocka_unit_test(interruptions),
    cmocka_unit_test(asked_within_a_period),
    cmocka_unit_test(errors_from_two_trajectories_cover),
    cmocka_unit_test(steps_are_not_chosen_by_what_is_no_number),
  };
  return cmocka_run_group_tests_name("langevin_run", tests, NULL, NULL);
}
