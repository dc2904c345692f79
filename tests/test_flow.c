/*
 * test_flow.c -- the integrators: order of every table, the methods against each other.
 */
#include "check.h"

#include <string.h>

#include <pendres/pendres.h>
#include "oracle/reference.h"

#include "engine/context_internal.h"
#include "engine/block.h"
#include "engine/kernels/tables.h"

#define COUNT(a) (sizeof(a) / sizeof *(a))

static const double half_pi = 1.57079632679489661923;

enum { LANES = 8, MOST_ROWS = 12 };

static pendres_context *context(const pendres_options *options)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(options, &ctx));
  return ctx;
}

/* Eight different pendulums, driven and damped, moving fast and slowly. */
static void example(size_t i, pendres_pendulum *p, double *y, double *v)
{
  *p = (pendres_pendulum){ .damping = 0.1 + 0.07 * (double)i,
                           .drive_amplitude = 0.2 + 0.05 * (double)i,
                           .drive_frequency = 0.75 + 0.06 * (double)i };
  *y = -2.4 + 0.6 * (double)i;
  *v = 1.5 - 0.4 * (double)i;
}

/* A period by the reference, in the rows of kernels.h: derivatives at fixed y and w = v/omega. */
static void expected(const pendres_pendulum *p, double y, double v, double rows[MOST_ROWS])
{
  const long double omega = p->drive_frequency, w = v / omega;
  reference_image to;
  check_ok(reference_map(p, y, v, 1, &to));
  const long double angle = to.y + 6.283185307179586476925287L * (long double)to.turns;
  rows[0] = (double)angle;
  rows[1] = (double)(to.v / omega);
  rows[2] = (double)to.monodromy[0][0];
  rows[3] = (double)(to.monodromy[1][0] / omega);
  rows[4] = (double)(to.monodromy[0][1] * omega);
  rows[5] = (double)to.monodromy[1][1];
  const long double by[2] = { to.by_frequency[0] + to.monodromy[0][1] * w,
                              to.by_frequency[1] + to.monodromy[1][1] * w };
  rows[6] = (double)by[0];
  rows[7] = (double)((by[1] - to.v / omega) / omega);
  rows[8] = (double)to.by_damping[0];
  rows[9] = (double)(to.by_damping[1] / omega);
  rows[10] = (double)to.by_amplitude[0];
  rows[11] = (double)(to.by_amplitude[1] / omega);
}

/* Largest error of a period by n steps over lanes and rows `from` to `to` - 1. */
static double error_of(pendres_block *flow, int n, size_t from, size_t to)
{
  double worst = 0.0;
  check_ok(pendres_block_set_steps(flow, n));
  pendres_block_resize(flow, LANES);
  for (size_t i = 0; i < LANES; i++) {
    pendres_pendulum p;
    double y, v;
    example(i, &p, &y, &v);
    pendres_block_load(flow, i, &p, y, v / p.drive_frequency);
  }
  check_ok(pendres_block_period(flow));
  const pendres_rows found = pendres_block_rows(flow);
  for (size_t i = 0; i < LANES; i++) {
    pendres_pendulum p;
    double y, v, rows[MOST_ROWS];
    example(i, &p, &y, &v);
    expected(&p, y, v, rows);
    for (size_t r = from; r < to; r++)
      worst = fmax(worst, fabs(pendres_rows_get(&found, (int)r, i) - rows[r]));
  }
  assert_true(isfinite(worst));
  return worst;
}

/*
 * The slope of error against steps on doubly logarithmic paper, from the first n whose error is
 * below 1e-6, where higher orders are small, to the first below 1e-10, where rounding (a few 1e-15
 * a period) is not felt yet.
 */
static double measured_order(pendres_block *flow, size_t from, size_t to)
{
  double first = 0.0, error = 1.0;
  int steps = 16, first_steps = 0, last_steps = 0;
  for (; error > 1e-10 && steps < 20000; steps += (steps + 9) / 10) {
    error = error_of(flow, steps, from, to);
    last_steps = steps;
    if (first_steps != 0 || error > 1e-6) continue;
    first = error;
    first_steps = steps;
  }
  assert_true(last_steps > first_steps && first_steps > 0);
  return log(first / error) / log((double)last_steps / first_steps);
}

/*
 * An order too few is what a stage used twice costs. Tables whose leading error is tuned to be
 * small show a part of the next order until rounding hides everything: up to two more are measured
 * (vern9); never less than 0.5 below the nominal order.
 */
static void test_order_of_every_table(void **state)
{
  (void)state;
  for (int t = PENDRES_TABLE_DEFAULT + 1; t < PENDRES_TABLE_COUNT; t++) {
    const pendres_options options = { .table = (pendres_table)t, .block_lanes = LANES };
    pendres_context *ctx = context(&options);
    const double order = pendres_tables_order((pendres_table)t);
    pendres_block *flow = NULL;
    check_ok(pendres_block_of(ctx, PENDRES_FLOW_STATE, &flow));
    const double plain = measured_order(flow, 0, 2);
    check_ok(pendres_block_of(ctx, PENDRES_FLOW_SENSITIVITY, &flow));
    const double derivatives = measured_order(flow, 2, 12);
    print_message("%-7s order %g: measured %.2f for the state, %.2f for its derivatives\n",
                  pendres_name_get(PENDRES_NAMES_TABLE, t), order, plain, derivatives);
    assert_true(plain > order - 0.5 && plain < order + 2.3);
    assert_true(derivatives > order - 0.5 && derivatives < order + 2.3);
    pendres_context_free(ctx);
  }
}

/*
 * Nominal orders by the coefficients themselves: c_i is the sum of its row, and weights integrate
 * powers up to the order, sum b c^(k-1) = 1/k. (Hairer, Norsett, Wanner, Solving ODEs I, II.1.)
 * Coefficients are rounded doubles of size up to 30, 16 of them a sum: 16 * 30 * 2^-53 = 5e-14.
 */
static void test_order_conditions(void **state)
{
  (void)state;
  for (int t = PENDRES_TABLE_DEFAULT + 1; t < PENDRES_TABLE_COUNT; t++) {
    const pendres_tables_method *m = pendres_tables_get((pendres_table)t);
    if (m == NULL) continue; /* ARKODE's own */
    double row[PENDRES_TABLES_MOST_STAGES] = { 0.0 };
    assert_int_equal(m->order, pendres_tables_order((pendres_table)t));
    for (int k = 0; k < m->entries; k++) {
      assert_true(m->a[k].column < m->a[k].row && m->a[k].row < m->stages);
      row[m->a[k].row] += m->a[k].value;
    }
    for (int i = 0; i < m->stages; i++) check_near(row[i], m->c[i], 5e-14);
    for (int k = 1; k <= m->order; k++) {
      double weights = 0.0, embedded = 0.0;
      for (int i = 0; i < m->stages; i++) {
        weights += m->b[i] * pow(m->c[i], k - 1);
        embedded += m->d[i] * pow(m->c[i], k - 1);
      }
      check_near(weights, 1.0 / k, 5e-14);
      if (k <= m->embedded_order) check_near(embedded, 1.0 / k, 5e-14);
    }
  }
}

/* The state does not depend on the rows that are carried along with it. */
static void test_rows_agree(void **state)
{
  pendres_context *ctx = context(NULL);
  pendres_block *flow[3];
  double end[3][2 * LANES];
  (void)state;
  for (int k = 0; k < 3; k++) {
    const pendres_flow_kind kind[] = { PENDRES_FLOW_STATE, PENDRES_FLOW_VARIATIONAL,
                                       PENDRES_FLOW_SENSITIVITY };
    check_ok(pendres_block_of(ctx, kind[k], &flow[k]));
    (void)error_of(flow[k], 40, 0, 2);
    const pendres_rows rows = pendres_block_rows(flow[k]);
    for (size_t i = 0; i < LANES; i++)
      for (int r = 0; r < 2; r++) end[k][2 * i + (size_t)r] = pendres_rows_get(&rows, r, i);
    /* Different numbers of rows, the same operations on each: the same bits. */
    assert_memory_equal(end[k], end[0], sizeof end[0]);
  }
  pendres_context_free(ctx);
}

typedef struct samples {
  int steps, calls;
  double y;
} samples;

static void keep(void *arg, int step, const pendres_rows *rows)
{
  samples *s = arg;
  assert_int_equal(step, ++s->calls);
  s->y = pendres_rows_get(rows, PENDRES_ROW_Y, 0);
}

/* Of the first lane, after a period. */
static double row_of(const pendres_block *flow, int row)
{
  const pendres_rows rows = pendres_block_rows(flow);
  return pendres_rows_get(&rows, row, 0);
}

/* Sampling changes no bit, ends on the period's end, and two half periods are a period. */
static void test_samples_and_halves(void **state)
{
  pendres_context *ctx = context(NULL);
  pendres_block *flow = NULL;
  samples s = { .steps = 34 };
  pendres_pendulum p;
  double y, v;
  (void)state;
  check_ok(pendres_block_of(ctx, PENDRES_FLOW_STATE, &flow));
  (void)error_of(flow, s.steps, 0, 2);
  const double whole = row_of(flow, PENDRES_ROW_Y);
  example(0, &p, &y, &v);
  pendres_block_load(flow, 0, &p, y, v / p.drive_frequency);
  check_ok(pendres_block_period_sampled(flow, keep, &s));
  assert_int_equal(s.calls, s.steps);
  assert_true(s.y == whole && row_of(flow, PENDRES_ROW_Y) == whole);

  /* From phase pi on the drive has the other sign: the second half by the mirrored pendulum. */
  pendres_block_load(flow, 0, &p, y, v / p.drive_frequency);
  check_ok(pendres_block_half_period(flow));
  pendres_block_load(flow, 0, &p, -row_of(flow, PENDRES_ROW_Y),
                     -row_of(flow, PENDRES_ROW_W));
  check_ok(pendres_block_half_period(flow));
  /* Rounding of 34 steps, and of cos(theta) on the other half of the circle. */
  check_near(-row_of(flow, PENDRES_ROW_Y), whole, 34 * 2.2e-16 * 3.0);
  pendres_context_free(ctx);
}

static void test_refusals(void **state)
{
  const pendres_options adaptive = { .method = PENDRES_BLOCK_ADAPTIVE };
  pendres_context *ctx = context(&adaptive);
  pendres_block *flow = NULL;
  (void)state;
  check_ok(pendres_block_of(ctx, PENDRES_FLOW_STATE, &flow));
  assert_int_equal(pendres_block_set_steps(flow, 0), PENDRES_INVALID_ARGUMENT);
  check_ok(pendres_block_set_steps(flow, 9));
  assert_int_equal(pendres_block_half_period(flow), PENDRES_INVALID_ARGUMENT);
  check_ok(pendres_block_create(ctx, PENDRES_ROWS_STATE, 1e-8, &flow));
  assert_int_equal(pendres_block_set_steps(flow, 20), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_block_period_sampled(flow, keep, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_block_half_period(flow), PENDRES_INVALID_ARGUMENT);
  pendres_block_free(flow);
  pendres_context_free(ctx);
}

/* Right-hand sides and steps are counted for lanes in use, whatever the vector's width. */
static void test_counts(void **state)
{
  pendres_context *ctx = context(&(pendres_options){ .steps_per_period = 20 });
  pendres_pendulum p[3];
  double x[3], v[3];
  pendres_cost cost;
  (void)state;
  for (size_t i = 0; i < 3; i++) example(i, &p[i], &x[i], &v[i]);
  check_ok(pendres_strobe_advance(ctx, 3, p, x, v, 7, NULL));
  pendres_context_cost(ctx, &cost);
  check_near(cost.pendulum_periods, 21.0, 0.0);
  check_near(cost.steps, 21.0 * 20.0, 0.0);
  /* The default table works with 12 stages; ARKODE may evaluate one more after a reset. */
  assert_true(cost.rhs_evaluations >= cost.steps * 12.0);
  assert_true(cost.rhs_evaluations <= cost.steps * 12.0 + 21.0);
  pendres_context_cost_reset(ctx);
  pendres_context_cost(ctx, &cost);
  check_near(cost.pendulum_periods + cost.steps + cost.rhs_evaluations, 0.0, 0.0);
  pendres_context_free(ctx);
}

/*
 * Every other method against extended precision, over five periods. Their tolerance is that of a
 * step: some tens of steps a period, five periods, and errors that grow up to ten times in between
 * make 1e4 tolerances (measured: CVODE needs a quarter of that). The estimate, from
 * runs by a tenth and a hundredth of the tolerance, must not be below a tenth of the true error.
 */
static void test_methods_against_reference(void **state)
{
  static const struct {
    pendres_method method;
    pendres_table table;
  } ways[] = {
    { PENDRES_BLOCK_ADAPTIVE, PENDRES_TABLE_DEFAULT },
      { PENDRES_BLOCK_ADAPTIVE, PENDRES_TABLE_DP5 },
    { PENDRES_SINGLE, PENDRES_TABLE_TP8 },             { PENDRES_SINGLE, PENDRES_TABLE_DP5 },
    { PENDRES_CVODE_ADAMS, PENDRES_TABLE_DEFAULT },    { PENDRES_CVODE_BDF, PENDRES_TABLE_DEFAULT },
    { PENDRES_NAIVE, PENDRES_TABLE_DEFAULT },
  };
  (void)state;
  for (size_t k = 0; k < COUNT(ways); k++)
    for (double tolerance = 1e-6; tolerance > 1e-11; tolerance *= 1e-2) {
      pendres_context *ctx = context(&(pendres_options){ .method = ways[k].method,
                                                         .table = ways[k].table,
                                                         .tolerance = tolerance });
      pendres_pendulum p[LANES];
      double x[LANES], v[LANES], error[LANES], start[LANES], speed[LANES];
      for (size_t i = 0; i < LANES; i++) {
        example(i, &p[i], &start[i], &speed[i]);
        x[i] = start[i] + half_pi, v[i] = speed[i];
      }
      check_ok(pendres_strobe_advance(ctx, LANES, p, x, v, 5, error));
      for (size_t i = 0; i < LANES; i++) {
        long double y = start[i], w = speed[i];
        long turns = 0;
        check_ok(reference_advance(&p[i], &y, &w, &turns, 5));
        const double angle = (double)(y + 6.283185307179586476925287L * (long double)turns);
        const double off = fmax(fabs(x[i] - half_pi - angle), fabs(v[i] - (double)w));
        check_near(off, 0.0, 1e4 * tolerance);
        if (!(off <= 10.0 * error[i]))
          print_error("%s, tolerance %g, pendulum %zu: off by %g, estimated %g\n",
                      pendres_name_get(PENDRES_NAMES_METHOD, ways[k].method), tolerance, i, off,
                      error[i]);
        assert_true(off <= 10.0 * error[i]);
      }
      pendres_context_free(ctx);
    }
}

typedef struct swing {
  int steps;
  double worst;
} swing;

static void compare_with_sine(void *arg, int step, const pendres_rows *rows)
{
  swing *s = arg;
  const double meant = 6.283185307179586476925287 * step / s->steps;
  s->worst = fmax(s->worst, fabs(pendres_rows_get(rows, PENDRES_ROW_W, 0) - sin(meant)));
}

/*
 * w' = cos(theta), with gravity 1e-18 of the drive: w = sin(theta) at each of many steps. ARKODE's
 * own clock is off by 3e-12 after so many. Rounding is half a unit in the last place of one a step,
 * at random: 53248^(1/2) 1.1e-16 / 3^(1/2) = 1.5e-14, of which four standard errors are let pass.
 */
static void test_clock_of_many_steps(void **state)
{
  static const pendres_pendulum p = { .drive_amplitude = 1e18, .drive_frequency = 1e9 };
  const double rounding = 6e-14;
  swing s = { .steps = 53248 };
  pendres_block *flow = NULL;
  (void)state;
  pendres_context *ctx = context(&(pendres_options){ .block_lanes = LANES });
  check_ok(pendres_block_of(ctx, PENDRES_FLOW_STATE, &flow));
  check_ok(pendres_block_set_steps(flow, s.steps));
  pendres_block_resize(flow, 1);
  pendres_block_load(flow, 0, &p, -1.0, 0.0);
  check_ok(pendres_block_period_sampled(flow, compare_with_sine, &s));
  check_near(s.worst, 0.0, rounding);

  /* Neither a cut step at the end nor one too many. */
  const double before = pendres_block_steps(flow);
  pendres_block_load(flow, 0, &p, -1.0, 0.0);
  check_ok(pendres_block_period(flow));
  check_near(row_of(flow, PENDRES_ROW_W), 0.0, rounding);
  assert_true(pendres_block_steps(flow) - before == s.steps);
  pendres_block_load(flow, 0, &p, -1.0, 0.0);
  check_ok(pendres_block_half_period(flow));
  check_near(row_of(flow, PENDRES_ROW_W), 0.0, rounding);
  pendres_context_free(ctx);
}

/* What the tangents of a lane at rest grow by in the last of 30 periods, all others forgotten. */
static void growth_of(pendres_block *flow, const pendres_pendulum *p, double y, int steps,
                      double growth[2])
{
  double u[2];
  check_ok(pendres_block_set_steps(flow, steps));
  check_ok(pendres_block_carry(flow, PENDRES_FLOW_TANGENTS));
  for (int period = 0; period < 30; period++) {
    pendres_block_load(flow, 0, p, y, 0.0);
    for (int i = 0; i < 2 && period == 0; i++)
      pendres_block_put_tangent(flow, 0, i, (const double[]){0.6, 0.8});
    check_ok(pendres_block_period(flow));
    for (int i = 0; i < 2; i++) {
      pendres_block_get_tangent(flow, 0, i, u);
      growth[i] = log(hypot(u[0], u[1]));
      for (int k = 0; k < 2; k++) u[k] /= exp(growth[i]);
      pendres_block_put_tangent(flow, 0, i, u);
    }
  }
  check_ok(pendres_block_carry(flow, PENDRES_FLOW_NOTHING));
}

/*
 * A pendulum upside down falls at an exact rate; one at rest under a parametric drive, and a
 * polynomial force with the same slope, by the multiplier of Mathieu's equation, which the
 * variational rows give at 400 steps of order 8. Tangents are of fourth order, 16 times as exact
 * with half the steps; next orders let this be 13 to 19. Those by steps twice as long are what the
 * others are with half as many steps, but for rounding.
 */
static void test_tangents(void **state)
{
  const pendres_pendulum fall = {.damping = 0.5, .drive_frequency = 1.0},
                         sway = {.damping = 0.1, .drive_frequency = 2.0,
                                 .parametric_amplitude = 0.8},
                         beam = {.damping = 0.1, .drive_frequency = 2.0,
                                 .parametric_amplitude = 0.8, .force = PENDRES_FORCE_POLYNOMIAL,
                                 .force_coefficients = {1.0}};
  const double rate = sqrt(1.0 + 0.0625) - 0.25;
  pendres_block *flow = NULL, *exact = NULL;
  (void)state;
  pendres_context *ctx = context(&(pendres_options){.block_lanes = LANES});
  check_ok(pendres_block_of(ctx, PENDRES_FLOW_VARIATIONAL, &exact));
  check_ok(pendres_block_set_steps(exact, 400));
  pendres_block_resize(exact, 1);
  pendres_block_load(exact, 0, &sway, 0.0, 0.0);
  check_ok(pendres_block_period(exact));
  double m[2][2];
  const pendres_rows rows = pendres_block_rows(exact);
  pendres_rows_tangent(&rows, 0, m);
  const double half = 0.5 * (m[0][0] + m[1][1]);
  const double root = sqrt(half * half - (m[0][0] * m[1][1] - m[0][1] * m[1][0]));
  const double sways = log(fabs(half) + root);

  const struct {
    const pendres_pendulum *p;
    double y, want;
  } cases[] = {{&fall, 2.0 * half_pi, 2.0 * 2.0 * half_pi * rate}, {&sway, 0.0, sways},
               {&beam, 0.0, sways}};
  check_ok(pendres_block_of(ctx, PENDRES_FLOW_STATE, &flow));
  for (size_t c = 0; c < COUNT(cases); c++) {
    double few[2], many[2];
    pendres_block_clear(flow);
    pendres_block_resize(flow, 1);
    growth_of(flow, cases[c].p, cases[c].y, 16, few);
    growth_of(flow, cases[c].p, cases[c].y, 32, many);
    const double ratio = (few[0] - cases[c].want) / (many[0] - cases[c].want);
    assert_true(ratio > 13.0 && ratio < 19.0);
    check_near(many[1], few[0], 1e-12);
    check_near(many[0] - (many[1] - many[0]) / 15.0, cases[c].want,
               fabs(many[1] - many[0]) / 15.0);
  }
  assert_int_equal(pendres_block_carry(exact, PENDRES_FLOW_TANGENTS), PENDRES_INVALID_ARGUMENT);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_order_of_every_table), cmocka_unit_test(test_order_conditions),
    cmocka_unit_test(test_rows_agree),           cmocka_unit_test(test_clock_of_many_steps),
    cmocka_unit_test(test_samples_and_halves),   cmocka_unit_test(test_refusals),
    cmocka_unit_test(test_tangents),
    cmocka_unit_test(test_counts),               cmocka_unit_test(test_methods_against_reference),
  };
  return cmocka_run_group_tests_name("flow", tests, NULL, NULL);
}
