/*
 * test_context.c -- options and their defaults, which options are refused and why, counts of work,
 * and interruption on request.
 */
#include "check.h"

#include <math.h>
#include <string.h>

#include <pendres/context.h>
#include <pendres/free.h>
#include <pendres/strobe.h>

#include "engine/kernels/tables.h"

static const pendres_pendulum fig7 = {
  .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.78539816339744830962};

static void defaults(void **state)
{
  pendres_context *ctx = NULL;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  const pendres_options *o = pendres_context_options(ctx);
  assert_true(o->tolerance == 1e-8);
  assert_int_equal(o->method, PENDRES_BLOCK_FIXED);
  assert_int_equal(o->table, PENDRES_TABLE_TP8);
  assert_int_equal(o->block_lanes, 512);
  assert_string_equal(pendres_context_message(ctx), "");
  pendres_context_free(ctx);
  pendres_context_free(NULL);
}

/* Options are copied: the caller's may go. */
static void options_are_copied(void **state)
{
  pendres_context *ctx = NULL;
  (void)state;
  {
    pendres_options o = {.tolerance = 1e-5, .table = PENDRES_TABLE_TSIT5, .block_lanes = 64};
    check_ok(pendres_context_create(&o, &ctx));
    memset(&o, 0xff, sizeof o);
  }
  assert_true(pendres_context_options(ctx)->tolerance == 1e-5);
  assert_int_equal(pendres_context_options(ctx)->table, PENDRES_TABLE_TSIT5);
  assert_int_equal(pendres_context_options(ctx)->block_lanes, 64);
  pendres_context_free(ctx);
}

static void bad_options(void **state)
{
  static const struct {
    pendres_options options;
    const char *word; /* in what is said of it */
  } bad[] = {
    {{.tolerance = -1e-8}, "tolerance"},
    {{.tolerance = NAN}, "tolerance"},
    {{.tolerance = INFINITY}, "tolerance"},  {{.method = PENDRES_METHOD_COUNT}, "method"},
    {{.table = PENDRES_TABLE_COUNT}, "table"}, {{.steps_per_period = -1}, "steps"},
    {{.steps_per_period = 1000001}, "steps"}, {{.block_lanes = 12}, "lanes"},
    {{.block_lanes = -8}, "lanes"},          {{.block_lanes = 4104}, "lanes"},
    {{.period_budget = -1}, "budget"},
    {{.exponent_error = 1.1}, "exponents"},
    {{.exponent_error = NAN}, "exponents"},  {{.threads = -1}, "threads"},
    {{.threads = 4097}, "threads"},
  };
  (void)state;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    pendres_context *ctx = (pendres_context *)&bad;
    const char *why = pendres_options_check(&bad[i].options);
    assert_non_null(why);
    assert_non_null(strstr(why, bad[i].word));
    assert_int_equal(pendres_context_create(&bad[i].options, &ctx), PENDRES_INVALID_ARGUMENT);
    assert_null(ctx);
  }
  /* Whether a tolerance can be met depends on the pendulum's unit of length; one that is looser
     than a hundredth of it is met by a hundredth. */
  for (int i = 0; i < 2; i++) {
    pendres_context *ctx = NULL;
    const double amplitude = 1.0;
    double frequency, error;
    const pendres_options asked = {.tolerance = i == 0 ? 1e-14 : 0.1};
    assert_int_equal(pendres_context_create(&asked, &ctx), 0);
    assert_int_equal(pendres_free_find(ctx, 1, &amplitude, &frequency, &error),
                     i == 0 ? PENDRES_INVALID_ARGUMENT : PENDRES_OK);
    if (i == 0)
      assert_non_null(strstr(pendres_context_message(ctx), "at least 1e-13"));
    else
      assert_true(fabs(frequency - pendres_free_frequency(amplitude)) <= error);
    pendres_context_free(ctx);
  }
  assert_null(pendres_options_check(NULL));
  assert_non_null(strstr(pendres_context_message(NULL), "pendres_options_check"));
}

/* Options say how large they are, or nothing; those of another version are refused. */
static void sizes(void **state)
{
  (void)state;
  assert_null(pendres_options_check(&(pendres_options){.size = 0}));
  assert_null(pendres_options_check(&(pendres_options){.size = sizeof(pendres_options)}));
  assert_non_null(pendres_options_check(&(pendres_options){.size = sizeof(pendres_options) + 8}));
  assert_non_null(pendres_options_check(&(pendres_options){.size = 8}));
}

static void names(void **state)
{
  static const char *const methods[] = {"block_fixed", "block_adaptive", "single",
                                        "cvode_adams", "cvode_bdf",      "naive"};
  static const struct {
    const char *name;
    int order;
  } tables[] = {{"default", 8}, {"tp8", 8}, {"tsit5", 5}, {"vern9", 9}, {"dp5", 5}};
  (void)state;
  for (int i = 0; i < PENDRES_METHOD_COUNT; i++) {
    assert_string_equal(pendres_name_get(PENDRES_NAMES_METHOD, i), methods[i]);
    assert_int_equal(pendres_name_find(PENDRES_NAMES_METHOD, methods[i]), i);
  }
  assert_null(pendres_name_get(PENDRES_NAMES_METHOD, PENDRES_METHOD_COUNT));
  for (int i = 0; i < PENDRES_TABLE_COUNT; i++) {
    assert_string_equal(pendres_name_get(PENDRES_NAMES_TABLE, i), tables[i].name);
    assert_int_equal(pendres_name_find(PENDRES_NAMES_TABLE, tables[i].name), i);
    assert_int_equal(pendres_tables_order((pendres_table)i), tables[i].order);
  }
  assert_int_equal(pendres_name_find(PENDRES_NAMES_METHOD, "euler"), -1);
  assert_int_equal(pendres_name_find(PENDRES_NAMES_TABLE, "tp"), -1);
  assert_null(pendres_name_get(PENDRES_NAMES_TABLE, PENDRES_TABLE_COUNT));
  assert_int_equal(pendres_tables_order(PENDRES_TABLE_COUNT), 0);
}

/* Three pendulums, four periods, ten steps each of thirteen stages (tp8's last serves no other). */
static void costs_are_counted(void **state)
{
  pendres_context *ctx = NULL;
  pendres_cost cost;
  const pendres_pendulum p[3] = {fig7, fig7, fig7};
  double x[3] = {0.1, 0.2, 0.3}, v[3] = {0.0, 0.0, 0.0};
  (void)state;
  check_ok(pendres_context_create(&(pendres_options){.steps_per_period = 10}, &ctx));
  check_ok(pendres_strobe_advance(ctx, 3, p, x, v, 4, NULL));
  pendres_context_cost(ctx, &cost);
  assert_true(cost.pendulum_periods == 12.0);
  assert_true(cost.steps == 120.0);
  assert_true(cost.rhs_evaluations >= 12.0 * 120.0 && cost.rhs_evaluations <= 13.0 * 120.0 + 12.0);
  pendres_context_cost_reset(ctx);
  pendres_context_cost(ctx, &cost);
  assert_true(cost.pendulum_periods == 0.0 && cost.steps == 0.0 && cost.rhs_evaluations == 0.0);
  check_ok(pendres_strobe_advance(ctx, 1, p, x, v, 1, NULL));
  pendres_context_cost(ctx, &cost);
  assert_true(cost.pendulum_periods == 1.0 && cost.steps == 10.0);
  pendres_context_free(ctx);
}

/* What a computation costs does not depend on what the context has done before, though the steps of
   a pendulum are chosen once. */
static void costs_do_not_depend_on_the_past(void **state)
{
  pendres_context *ctx = NULL;
  pendres_cost first, again;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  for (int k = 0; k < 2; k++) {
    double x = 0.1, v = 0.0;
    pendres_context_cost_reset(ctx);
    check_ok(pendres_strobe_advance(ctx, 1, &fig7, &x, &v, 4, NULL));
    pendres_context_cost(ctx, k == 0 ? &first : &again);
  }
  assert_true(first.pendulum_periods == 4.0);
  assert_memory_equal(&first, &again, sizeof first);
  pendres_context_free(ctx);
}

static int after_some(void *arg)
{
  int *left = arg;
  return --*left < 0;
}

/* A run that is stopped says so and leaves its arrays alone; the context goes on. */
static void interrupted(void **state)
{
  for (int m = 0; m < PENDRES_METHOD_COUNT; m++) {
    pendres_context *ctx = NULL;
    int left = 3;
    double x = 1.0, v = 0.0;
    (void)state;
    check_ok(pendres_context_create(&(pendres_options){.method = (pendres_method)m}, &ctx));
    pendres_context_set_interrupt(ctx, after_some, &left);
    assert_int_equal(pendres_strobe_advance(ctx, 1, &fig7, &x, &v, 1000000, NULL),
                     PENDRES_INTERRUPTED);
    assert_true(x == 1.0 && v == 0.0);
    assert_non_null(strstr(pendres_context_message(ctx), "interrupted"));
    pendres_context_set_interrupt(ctx, NULL, NULL);
    check_ok(pendres_strobe_advance(ctx, 1, &fig7, &x, &v, 2, NULL));
    assert_true(x != 1.0);
    pendres_context_free(ctx);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(defaults),    cmocka_unit_test(options_are_copied),
    cmocka_unit_test(bad_options), cmocka_unit_test(sizes), cmocka_unit_test(names),
    cmocka_unit_test(costs_are_counted),
    cmocka_unit_test(costs_do_not_depend_on_the_past), cmocka_unit_test(interrupted),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
