/*
 * test_parts.c -- work in parts on threads: the same bytes as in one call, whatever the number of
 * threads and parts; every item is done once; of several failures the first in order is reported.
 * So it is in calls that divide their own work, by the option `threads`.
 */
#include "check.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include <pendres/basin.h>
#include <pendres/dimension.h>
#include <pendres/hysteresis.h>
#include <pendres/parts.h>
#include <pendres/strobe.h>

enum { N = 1500 };

typedef struct ensemble {
  pendres_pendulum pendulums[N];
  double x[N], v[N];
  int done[N];
  size_t fails_from; /* parts that begin there or behind fail */
  atomic_int later;  /* one of those behind is about to */
} ensemble;

static ensemble *filled(void)
{
  ensemble *e = calloc(1, sizeof *e);
  assert_non_null(e);
  e->fails_from = N;
  for (size_t i = 0; i < N; i++) {
    const double share = (double)i / N;
    e->pendulums[i] = (pendres_pendulum){.damping = 0.1 + 0.3 * share, .drive_amplitude = 0.2,
                                         .drive_frequency = 0.7 + 0.3 * share};
    e->x[i] = -1.5 + 6.0 * share;
  }
  return e;
}

static pendres_status advance(pendres_context *ctx, size_t first, size_t count, void *arg)
{
  ensemble *e = arg;
  for (size_t i = first; i < first + count; i++) e->done[i]++;
  if (first >= e->fails_from) e->pendulums[first].damping = -1.0;
  if (first > e->fails_from) atomic_store(&e->later, 1);
  /* The first of them comes last, if another thread is there to be quicker. */
  for (long i = 0; first == e->fails_from && !atomic_load(&e->later) && i < 20000000; i++) continue;
  for (size_t i = 0; first == e->fails_from && i < 50; i++) {
    double x = 1.0, v = 0.0;
    check_ok(pendres_strobe_advance(ctx, 1, e->pendulums, &x, &v, 100, NULL));
  }
  return pendres_strobe_advance(ctx, count, e->pendulums + first, e->x + first, e->v + first, 2,
                                NULL);
}

static void bytes_do_not_depend_on_threads(void **state)
{
  static const pendres_parts ways[] = {
    {.n = N, .threads = 1}, {.n = N, .each = 100, .threads = 2}, {.n = N, .each = 1, .threads = 3},
    {.n = N, .each = N - 1, .threads = 8}, {.n = N, .each = 64}};
  ensemble *one = filled();
  pendres_context *ctx = NULL;
  char why[200] = "unchanged";
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_strobe_advance(ctx, N, one->pendulums, one->x, one->v, 2, NULL));
  pendres_context_free(ctx);
  for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
    ensemble *e = filled();
    check_ok(pendres_parts_run(&ways[k], advance, e, why, sizeof why));
    assert_string_equal(why, "");
    assert_memory_equal(e->x, one->x, sizeof e->x);
    assert_memory_equal(e->v, one->v, sizeof e->v);
    for (size_t i = 0; i < N; i++) assert_int_equal(e->done[i], 1);
    free(e);
  }
  free(one);
}

static void first_failure_is_told(void **state)
{
  (void)state;
  for (int threads = 1; threads < 6; threads++) {
    const pendres_parts how = {.n = N, .each = 50, .threads = threads};
    char why[200] = "", few[4] = "";
    ensemble *e = filled();
    e->fails_from = 700;
    assert_int_equal(pendres_parts_run(&how, advance, e, why, sizeof why),
                     PENDRES_INVALID_ARGUMENT);
    assert_ptr_equal(strstr(why, "part from 700 on: pendulum 0: the damping"), why);
    for (size_t i = 0; i < 700; i++) assert_int_equal(e->done[i], 1); /* all before are done */
    assert_int_equal(pendres_parts_run(&how, advance, e, few, sizeof few),
                     PENDRES_INVALID_ARGUMENT);
    assert_int_equal(strlen(few), 3);
    free(e);
  }
}

static void nothing_to_do(void **state)
{
  const pendres_parts none = {.threads = 4};
  (void)state;
  check_ok(pendres_parts_run(&none, advance, NULL, NULL, 0));
}

/* ---- calls that divide their own work ---- */

/* Asked on any thread, one at a time, so that a plain count is safe. */
static int stop_at_third(void *arg)
{
  return ++*(int *)arg >= 3;
}

/* Points all over a square have the dimension 2. */
static void dimension_on_threads(void **state)
{
  enum { POINTS = 6000, FEW = 1600 };
  static double x[POINTS], v[POINTS];
  const pendres_section section = {POINTS, x, v, 0.0}, few = {FEW, x, v, 0.0};
  pendres_correlation one, some;
  uint64_t random = 1;
  (void)state;
  for (size_t i = 0; i < 2 * POINTS; i++) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    (i % 2 ? x : v)[i / 2] = (double)(random >> 11) * 0x1p-53;
  }
  for (int threads = 1; threads <= 5; threads += 2) {
    int asked = 0;
    pendres_context *ctx = NULL;
    check_ok(pendres_context_create(&(pendres_options){.threads = threads}, &ctx));
    check_ok(pendres_correlation_find(ctx, &section, 0.0, threads == 1 ? &one : &some));
    check_near(one.dimension, 2.0, one.dimension_error);
    if (threads > 1) assert_memory_equal(&one, &some, sizeof one);
    pendres_context_set_interrupt(ctx, stop_at_third, &asked);
    assert_int_equal(pendres_correlation_find(ctx, &few, 0.0, &some), PENDRES_INTERRUPTED);
    assert_non_null(strstr(pendres_context_message(ctx), "interrupted on request"));
    assert_true(asked >= 3 && asked < 3 + threads);
    pendres_context_free(ctx);
  }
}

/* In any units, with the same work. */
static void random_states_on_threads(void **state)
{
  enum { STATES = 3000, MODELS = 2 };
  static const double distance[] = {1e-5, 6e-5, 3.6e-4, 2.16e-3, 1.296e-2};
  static const pendres_pendulum p[MODELS] = {
    {.damping = 0.2, .drive_amplitude = 2.0, .drive_frequency = 1.0},
    {.damping = 25.0, .drive_amplitude = 40.0, .drive_frequency = 100.0, /* units of 1 / 100 */
     .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1e4, 0.0, 1e8}}};
  static const double far[MODELS][2] = {{1.5, 4.0}, {0.02, 2.0}};
  (void)state;
  for (int k = 0; k < MODELS; k++) {
    const pendres_basin_window window = {
      .x_low = -far[k][0], .x_high = far[k][0], .v_low = -far[k][1], .v_high = far[k][1]};
    const pendres_basin_sample sample = {STATES, 7, 5, distance};
    pendres_basin_statistics one, some;
    pendres_cost cost[2];
    for (int threads = 1; threads <= 3; threads += 2) {
      pendres_context *ctx = NULL;
      pendres_attractors *set = NULL;
      check_ok(pendres_context_create(&(pendres_options){.threads = threads}, &ctx));
      check_ok(pendres_attractors_find(ctx, &p[k], 0, NULL, NULL, &set));
      (void)pendres_basin_uncertainty(ctx, set, &window, &sample, threads == 1 ? &one : &some);
      pendres_context_cost(ctx, &cost[threads > 1]);
      pendres_attractors_free(set);
      pendres_context_free(ctx);
    }
    assert_true(one.states > 256 && isfinite(one.uncertain[0]));
    assert_memory_equal(&one, &some, sizeof one);
    assert_memory_equal(&cost[0], &cost[1], sizeof cost[0]);
  }
}

/* A junction over the end of a Shapiro step and back: trials of jumps, rotations ahead. */
static void sweep_on_threads(void **state)
{
  enum { VALUES = 40 };
  static const pendres_pendulum junction = {
    .damping = 0.3, .drive_amplitude = 9.0, .drive_frequency = 3.0};
  double value[2 * VALUES];
  pendres_hysteresis *h[2] = {NULL};
  pendres_cost cost[2];
  (void)state;
  for (int i = 0; i < VALUES; i++) value[i] = value[2 * VALUES - 1 - i] = 1.88 + 0.002 * i;
  for (int k = 0; k < 2; k++) {
    pendres_context *ctx = NULL;
    check_ok(pendres_context_create(&(pendres_options){.threads = 1 + 2 * k}, &ctx));
    check_ok(pendres_hysteresis_find(
      ctx, &junction, &(pendres_state){1.6, 0.0},
      &(pendres_hysteresis_path){PENDRES_TORQUE, 2 * VALUES, value}, &h[k]));
    pendres_context_cost(ctx, &cost[k]);
    pendres_context_free(ctx);
  }
  assert_memory_equal(&cost[0], &cost[1], sizeof cost[0]);
  assert_int_equal(pendres_hysteresis_count(h[0]), 2 * VALUES);
  assert_int_equal(pendres_hysteresis_count(h[1]), 2 * VALUES);
  assert_int_equal(pendres_hysteresis_jump_count(h[0]), pendres_hysteresis_jump_count(h[1]));
  for (size_t i = 0; i < pendres_hysteresis_count(h[0]); i++)
    assert_memory_equal(pendres_hysteresis_get(h[0], i), pendres_hysteresis_get(h[1], i),
                        sizeof(pendres_hysteresis_point));
  assert_true(pendres_hysteresis_jump_count(h[0]) >= 2);
  for (size_t i = 0; i < pendres_hysteresis_jump_count(h[0]); i++)
    assert_memory_equal(pendres_hysteresis_jump_get(h[0], i),
                        pendres_hysteresis_jump_get(h[1], i), sizeof(pendres_jump));
  for (int k = 0; k < 2; k++) pendres_hysteresis_free(h[k]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(bytes_do_not_depend_on_threads),
    cmocka_unit_test(first_failure_is_told),
    cmocka_unit_test(nothing_to_do),
    cmocka_unit_test(dimension_on_threads),
    cmocka_unit_test(random_states_on_threads),
    cmocka_unit_test(sweep_on_threads),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
