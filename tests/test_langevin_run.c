/*
 * test_langevin_run.c -- noisy runs: the same bytes however they are cut; observers; refusals.
 */
#include "langevin_fixture.h"

#include <string.h>

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
  pendres_langevin *lv = make(0x123456789abcdef0u, 20, 192);
  start(p, x, v);
  check_ok(pendres_langevin_advance(lv, MANY, p, NULL, 0, 30, x, v, NULL));

  /* Smaller blocks, and cut in three, by another handle each time. */
  for (int lanes = 8; lanes <= 64; lanes *= 8) {
    pendres_langevin *other = make(0x123456789abcdef0u, 20, lanes);
    start(one, a, b);
    check_ok(pendres_langevin_advance(other, MANY, one, NULL, 0, 11, a, b, NULL));
    check_ok(pendres_langevin_advance(other, MANY, one, NULL, 11, 1, a, b, NULL));
    pendres_langevin_free(other);
    other = make(0x123456789abcdef0u, 20, lanes);
    check_ok(pendres_langevin_advance(other, MANY, one, NULL, 12, 18, a, b, NULL));
    assert_memory_equal(a, x, sizeof x);
    assert_memory_equal(b, v, sizeof v);
    pendres_langevin_free(other);
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
  check_ok(pendres_langevin_advance(lv, MANY / 2, p, ids, 0, 30, few_x, few_v, NULL));
  for (int i = 0; i < MANY / 2; i++) {
    assert_memory_equal(&few_x[i], &x[ids[i]], sizeof *x);
    assert_memory_equal(&few_v[i], &v[ids[i]], sizeof *v);
  }
  /* Another seed is another noise, but not for those without temperature. */
  pendres_langevin *other = make(1, 20, 192);
  start(one, a, b);
  check_ok(pendres_langevin_advance(other, MANY, one, NULL, 0, 30, a, b, NULL));
  for (int i = 0; i < MANY; i++) assert_int_equal(a[i] == x[i], i % 7 == 0);
  pendres_langevin_free(other);
  pendres_langevin_free(lv);
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
    pendres_langevin *lv = make(21, 16, i == 0 ? 192 : 24);
    check_ok(pendres_langevin_measure_bias(lv, &q, &b[i]));
    check_ok(pendres_langevin_measure(lv, &q, &c[i], NULL, NULL));
    assert_int_equal(pendres_langevin_steps(lv), 16);
    pendres_langevin_free(lv);
  }
  assert_memory_equal(&c[0].statistics, &c[1].statistics, sizeof c[0].statistics);
  assert_memory_equal(&b[0].statistics, &b[1].statistics, sizeof b[0].statistics);
}

/* ---- Refusals ---------------------------------------------------------------------------- */

static void wrong_arguments_are_refused(void **state)
{
  (void)state;
  static const double wrong[3] = {-1e-4, NAN, INFINITY};
  pendres_langevin *lv = make(0, 16, 8);
  pendres_langevin *none = lv;
  pendres_langevin_cloud c;
  pendres_langevin_bias b;
  for (int i = 0; i < 3; i++) {
    pendres_pendulum p[2] = {figure7(0.0), figure7(wrong[i])};
    double x[2] = {1.0, 1.0}, v[2] = {0.0, 0.0};
    const pendres_langevin_request q = {.pendulum = p[1], .trajectories = 8, .record = 1};
    assert_int_equal(pendres_langevin_advance(lv, 2, p, NULL, 0, 5, x, v, NULL),
                     PENDRES_INVALID_ARGUMENT);
    assert_non_null(strstr(pendres_langevin_message(lv), "trajectory 1"));
    assert_non_null(strstr(pendres_langevin_message(lv), "temperature"));
    assert_true(x[0] == 1.0 && x[1] == 1.0 && v[0] == 0.0);
    assert_int_equal(pendres_langevin_measure(lv, &q, &c, NULL, NULL), PENDRES_INVALID_ARGUMENT);
    assert_int_equal(pendres_langevin_measure_bias(lv, &q, &b), PENDRES_INVALID_ARGUMENT);
    assert_int_equal(pendres_langevin_choose_steps(lv, &q, PENDRES_LANGEVIN_CLOUD, 0.01, &b),
                     PENDRES_INVALID_ARGUMENT);
    x[0] = wrong[i];
    if (!isfinite(wrong[i]))
      assert_int_equal(pendres_langevin_advance(lv, 1, p, NULL, 0, 5, x, v, NULL),
                       PENDRES_INVALID_ARGUMENT);
  }
  pendres_pendulum p = figure7(0.0), slow = {0.1, 0.2, 1e-9, 0.1};
  double x = 1.0, v = 0.0;
  assert_int_equal(pendres_langevin_advance(lv, 1, &p, NULL, -1, 5, &x, &v, NULL),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_langevin_advance(lv, 1, &p, NULL, 4294967295, 1, &x, &v, NULL),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_langevin_advance(lv, 1, &slow, NULL, 0, 1, &x, &v, NULL),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_langevin_set_steps(lv, 1), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_langevin_steps(lv), 16);
  pendres_langevin_options options = {.block_lanes = 12};
  assert_non_null(pendres_langevin_options_check(&options));
  assert_int_equal(pendres_langevin_create(&options, &none), PENDRES_INVALID_ARGUMENT);
  assert_null(none);
  assert_null(pendres_langevin_options_check(NULL));
  pendres_langevin_free(lv);
  pendres_langevin_free(NULL);
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
  pendres_langevin *lv = make(2, 16, 8);
  start(p, x, v);
  start(p, a, b);
  check_ok(pendres_langevin_advance(lv, MANY, p, NULL, 4, 6, x, v, &observer));
  assert_memory_equal(seen, x, sizeof x);
  check_ok(pendres_langevin_advance(lv, MANY, p, NULL, 4, 3, a, b, NULL));
  memcpy(c, a, sizeof c);
  memcpy(d, b, sizeof d);
  check_ok(pendres_langevin_advance(lv, MANY, p, NULL, 7, 3, c, d, NULL));
  for (int i = 0; i < MANY; i++) check_near(x[i], i / 8 % 2 == 1 ? a[i] : c[i], 0.0);
  pendres_langevin_free(lv);
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
  pendres_langevin *lv = make(0, 16, 8);
  double x = 1.0, v = 0.0;
  int asked = 0;
  long seen = 0;
  pendres_langevin_set_interrupt(lv, third_time, &asked);
  assert_int_equal(pendres_langevin_advance(lv, 1, &p, NULL, 0, 5, &x, &v, NULL),
                   PENDRES_INTERRUPTED);
  check_near(x, 1.0, 0.0);
  check_near(pendres_langevin_spent(lv), 2.0, 0.0);
  pendres_cost cost;
  pendres_langevin_cost(lv, &cost);
  check_near(cost.pendulum_periods, 2.0, 0.0); /* 16 steps a period, of two forces each */
  check_near(cost.steps, 32.0, 0.0);
  check_near(cost.rhs_evaluations, 64.0, 0.0);
  pendres_langevin_cost(NULL, &cost);
  assert_true(isnan(cost.pendulum_periods));
  pendres_langevin_set_interrupt(lv, NULL, NULL);
  const pendres_langevin_observer observer = {stop_at_two, &seen, 0};
  assert_int_equal(pendres_langevin_advance(lv, 1, &p, NULL, 0, 5, &x, &v, &observer),
                   PENDRES_INTERRUPTED);
  assert_int_equal(seen, 2);
  check_near(x, 1.0, 0.0);
  pendres_langevin_free(lv);
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
  pendres_langevin *lv = make(0, STEPS, N);
  pendres_langevin_bias bias;
  pendres_langevin_cloud cloud;
  int asked = 0;
  for (int i = 0; i < N; i++) p[i] = figure7(1e-3);
  const pendres_langevin_request q = {.pendulum = p[0], .trajectories = N, .record = 1};
  pendres_langevin_set_interrupt(lv, third_time, &asked);
  assert_int_equal(pendres_langevin_advance(lv, N, p, NULL, 0, 1, x, v, NULL), PENDRES_INTERRUPTED);
  assert_int_equal(asked, 3);
  assert_non_null(strstr(pendres_langevin_message(lv), "interrupted"));
  check_near(x[0], 0.0, 0.0);
  check_near(pendres_langevin_spent(lv), 0.0, 0.0);
  asked = 0;
  assert_int_equal(pendres_langevin_measure(lv, &q, &cloud, NULL, NULL), PENDRES_INTERRUPTED);
  assert_int_equal(asked, 3);
  asked = 0;
  assert_int_equal(pendres_langevin_measure_bias(lv, &q, &bias), PENDRES_INTERRUPTED);
  assert_int_equal(asked, 3);
  pendres_langevin_free(lv);
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
  pendres_langevin *lv = make(17, 16, 8);
  for (int i = 0; i < PAIRS; i++) {
    const pendres_langevin_request q = {.pendulum = figure7(1e-4), .x = x, .v = v,
                                        .trajectories = 2, .settle = 10, .record = 4,
                                        .first_id = 2 * (uint64_t)i};
    pendres_langevin_cloud c;
    check_ok(pendres_langevin_measure(lv, &q, &c, NULL, NULL));
    mean[i] = c.statistics[PENDRES_LANGEVIN_MEAN_V].value;
    error[i] = c.statistics[PENDRES_LANGEVIN_MEAN_V].error;
    truth += mean[i] / PAIRS;
  }
  for (int i = 0; i < PAIRS; i++) within += fabs(mean[i] - truth) <= error[i];
  check_near((double)within / PAIRS, 0.6827, sigmas * 0.0147);
  pendres_langevin_free(lv);
}

/* Numbers beyond the largest double are no cloud, and no bias that would be small enough. */
static void steps_are_not_chosen_by_what_is_no_number(void **state)
{
  (void)state;
  pendres_langevin *lv = make(0, 16, 8);
  const pendres_langevin_request q = {
    .pendulum = {.damping = 0.12, .drive_amplitude = 1e200, .drive_frequency = 0.8,
                 .temperature = 1e-4},
    .trajectories = 16, .settle = 2, .record = 4};
  pendres_langevin_bias bias;
  assert_int_not_equal(
    pendres_langevin_choose_steps(lv, &q, PENDRES_LANGEVIN_CLOUD, 0.01, &bias), PENDRES_OK);
  assert_true(strlen(pendres_langevin_message(lv)) > 0);
  pendres_langevin_free(lv);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(same_bytes_whatever_the_run),
    cmocka_unit_test(clouds_do_not_depend_on_blocks),
    cmocka_unit_test(wrong_arguments_are_refused),
    cmocka_unit_test(observers_see_what_happens),
    cmocka_unit_test(interruptions),
    cmocka_unit_test(asked_within_a_period),
    cmocka_unit_test(errors_from_two_trajectories_cover),
    cmocka_unit_test(steps_are_not_chosen_by_what_is_no_number),
  };
  return cmocka_run_group_tests_name("langevin_run", tests, NULL, NULL);
}
