/* test_nystrom.c -- periods by a Nystrom method: the same bytes everywhere, its order and errors
   beside long double with every force, whether steps chosen for a table are enough for it; in
   single precision the error that lanes carry for it, and the labels of basins. */
#include "basin_fixture.h"

#include <stdlib.h>
#include <string.h>

#include "base/instructions.h"
#include "engine/context_internal.h"
#include "engine/block.h"
#include "engine/block_internal.h"
#include "engine/steps.h"
#include "model/model.h"
#include "oracle.h"
#include "engine/kernels/coordinates.h"
#include "orbits/strobe_noise.h"

enum { MOST = 200, ROWS = 18, STEPS = 20, FEW_STEPS = 4 };

static uint64_t seed;

static double between(double from, double to)
{
  return from + (to - from) * next_random(&seed);
}

/* Numbers of a block of lanes: y, w, errors, coefficients; where they are does not matter. */
typedef struct numbers {
  double *of[ROWS];
} numbers;

static numbers some_numbers(void)
{
  static const double from[ROWS] = {-3, -2, 0, 0, 0, 1e-14, 0.9, 0.1, 0.4, 0, 0.01, -1, -1,
                                     0, -0.01, 0, -0.01, 0};
  static const double to[ROWS] = {3, 2, 1e-9, 1e-10, 1e-9, 1e-12, 1, 0.5, 1, 1, 1, 1, 1,
                                   1, 0.01, 0.1, 0.01, 0.01};
  numbers n;
  seed = 7;
  for (int k = 0; k < ROWS; k++) {
    n.of[k] = pendres_lanes_allocate(MOST);
    assert_non_null(n.of[k]);
    for (int i = 0; i < MOST; i++) n.of[k][i] = between(from[k], to[k]);
  }
  return n;
}

/* Lanes of the numbers from one on. */
static pendres_nystrom_lanes lanes_of(const numbers *n, pendres_model_terms model, int tangents,
                                      size_t from, size_t lanes)
{
  double *p[ROWS];
  for (int k = 0; k < ROWS; k++) p[k] = n->of[k] + from;
  pendres_nystrom_lanes l = {
    .lanes = lanes, .model = model, .y = p[0], .w = p[1],
    .off = {p[2], p[3], p[4], p[5], p[6], p[7]},
    .k = {.stiffness = p[8], .drive = p[9], .friction = p[10], .torque = p[11],
          .modulation = p[12]}};
  for (int c = 0; c < PENDRES_FORCE_POWERS; c++) l.k.power[c] = p[13 + c];
  if (tangents) {
    l.off = (pendres_carried){0};
    l.tangent_y = p[2];
    l.tangent_w = p[3];
  }
  return l;
}

/* Each instruction set, and blocks of 8 and 40 lanes, give the same bytes. */
static void check_bytes(const pendres_nystrom_steps *s, pendres_model_terms model, int single,
                        int tangents)
{
  const pendres_kernels_nystrom *list[3] = {&pendres_kernels_nystrom_base};
  size_t count = 1;
#if defined(__x86_64__)
  const pendres_instructions here = pendres_instructions_here();
  if (here >= PENDRES_INSTRUCTIONS_AVX2) list[count++] = &pendres_kernels_nystrom_avx2;
  if (here >= PENDRES_INSTRUCTIONS_AVX512) list[count++] = &pendres_kernels_nystrom_avx512;
#endif
  static const size_t each[3] = {MOST, 8, 40};
  for (size_t k = 0; k < 3 * count; k++) {
    numbers first = some_numbers(), other = some_numbers();
    const pendres_nystrom_lanes whole = lanes_of(&first, model, tangents, 0, MOST);
    (single ? list[0]->run_single : list[0]->run)(s, &whole);
    for (size_t i = 0; i < MOST; i += each[k / count]) {
      const pendres_nystrom_lanes part = lanes_of(&other, model, tangents, i, each[k / count]);
      const pendres_kernels_nystrom *other_set = list[k % count];
      (single ? other_set->run_single : other_set->run)(s, &part);
    }
    for (int i = 0; i < ROWS; i++)
      assert_memory_equal(first.of[i], other.of[i], MOST * sizeof(double));
    for (int i = 0; i < 2 * ROWS; i++) free(i < ROWS ? first.of[i] : other.of[i - ROWS]);
  }
}

static void test_same_bytes_on_every_instruction_set(void **state)
{
  pendres_nystrom_steps s = {0};
  (void)state;
  assert_int_equal(pendres_block_nystrom_prepare(&s, FEW_STEPS), 0);
  for (int model = 0; model < PENDRES_MODEL_COUNT; model++)
    for (int k = 0; k < 4; k++)
      if (k / 2 == 0 || pendres_nystrom_may_single((pendres_model_terms)model))
        check_bytes(&s, (pendres_model_terms)model, k / 2, k % 2);
  free(s.cosine);
}

/* ---- beside long double ---- */

/* A pendulum of each kind, moderately driven. */
static pendres_pendulum drawn(int i)
{
  pendres_pendulum p = {.damping = between(0.02, 1.0), .drive_amplitude = between(0.0, 1.5),
                        .drive_frequency = between(0.5, 1.5)};
  if (i % 4 != 0) p.torque = between(-0.5, 0.5);
  if (i % 4 != 0) p.parametric_amplitude = between(-1.0, 1.0);
  if (i % 4 == 2) p.force = PENDRES_FORCE_POLYNOMIAL;
  if (i % 4 == 3) p.force = PENDRES_FORCE_SQUID;
  if (i % 4 >= 2) p.force_coefficients[0] = between(0.2, 1.0);
  for (int c = 1; c < PENDRES_FORCE_POWERS && i % 4 == 2; c++)
    p.force_coefficients[c] = c % 2 == 0 ? between(0.0, 0.5) : between(-0.1, 0.1);
  return p;
}

/* How far (y, v) are from those of long double after a period of n steps, as a multiple of how a
   start's error grows. */
static double error_of(pendres_context *ctx, const pendres_pendulum *p, double y, double v, int n,
                       pendres_flow_way way)
{
  const oracle o = oracle_of(p);
  const double omega = p->drive_frequency;
  long double s[ORACLE_SIZE] = {y, v, 1.0L, 0.0L, 0.0L, 1.0L}, grown = 1.0L;
  pendres_block *b;
  oracle_advance(&o, 1, s);
  for (int k = 2; k < 6; k++) grown = fmaxl(grown, fabsl(s[k]));
  check_ok(pendres_block_open(ctx, PENDRES_FLOW_STATE, n, &b));
  pendres_block_resize(b, 1);
  pendres_block_load(b, 0, p, y, v / omega);
  check_ok(pendres_block_period_by(b, way));
  const pendres_rows rows = pendres_block_rows(b);
  return (double)(hypotl(pendres_rows_get(&rows, PENDRES_ROW_Y, 0) - s[0],
                         omega * pendres_rows_get(&rows, PENDRES_ROW_W, 0) - s[1]) / grown);
}

/*
 * Errors of each force fall as steps to the eighth power: between 32 and 64 steps a period by 256,
 * in the geometric mean of a dozen draws within a factor of 2; and by doubling the error of
 * the coarser run is told: the finer one's is less than a thirtieth of it in each draw.
 */
static void test_order_is_eight(void **state)
{
  enum { DRAWS = 48, KINDS = 4 };
  double fallen[KINDS] = {0.0};
  pendres_context *ctx = NULL;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  seed = 3;
  for (int i = 0; i < DRAWS; i++) {
    const pendres_pendulum p = drawn(i);
    const double y = between(-2.0, 2.0), v = between(-1.0, 1.0);
    const double coarse = error_of(ctx, &p, y, v, 32, PENDRES_FLOW_NYSTROM);
    const double fine = error_of(ctx, &p, y, v, 64, PENDRES_FLOW_NYSTROM);
    assert_true(fine < coarse / 30.0 + 1e-14);
    fallen[i % KINDS] += log2(coarse / fmax(fine, 1e-16)) / (DRAWS / KINDS);
  }
  for (int k = 0; k < KINDS; k++) {
    print_message("force %d: order %.2f\n", k, fallen[k]);
    assert_true(fallen[k] > 7.0 && fallen[k] < 9.0);
  }
  pendres_context_free(ctx);
}

/*
 * In as many steps as were chosen for a table the method is as exact: the errors of
 * random pendulums, from the least damping to what overdamps, are in the mean no larger than the
 * table's, and the largest of a force no more than twice that of the table.
 */
static void test_steps_of_a_table_are_enough(void **state)
{
  enum { DRAWS = 120, KINDS = 4 };
  static const double wanted[] = {1e-5, 1e-7};
  double largest[KINDS][2] = {{0.0}}, mean = 0.0;
  int count = 0;
  pendres_context *ctx = NULL;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  seed = 17;
  for (int i = 0; i < DRAWS; i++) {
    pendres_pendulum p = drawn(i);
    p.damping = exp(between(log(0.01), log(3.0)));
    const double y = between(-3.0, 3.0), v = between(-2.0, 2.0);
    for (int k = 0; k < 2; k++) {
      int n = 0;
      const double speed = pendres_steps_speed(&p, y + pendres_model_origin(&p), v);
      check_ok(pendres_steps_choose(ctx, &p, speed, wanted[k], &n));
      const double by_table = error_of(ctx, &p, y, v, n, PENDRES_FLOW_TABLE) / wanted[k];
      const double own = error_of(ctx, &p, y, v, n, PENDRES_FLOW_NYSTROM) / wanted[k];
      largest[i % KINDS][0] = fmax(largest[i % KINDS][0], by_table);
      largest[i % KINDS][1] = fmax(largest[i % KINDS][1], own);
      mean += log(own / by_table);
      count++;
    }
  }
  print_message("beside the table %.2f\n", exp(mean / count));
  for (int k = 0; k < KINDS; k++) {
    print_message("force %d: at most %.3f of what is asked, the table %.3f\n", k, largest[k][1],
                  largest[k][0]);
    assert_true(largest[k][1] < fmax(2.0 * largest[k][0], 0.5));
  }
  assert_true(mean <= 0.0);
  pendres_context_free(ctx);
}

/* ---- tangents ---- */

/* The trace of the derivative of a period's map, in n steps, on the orbit of one
   period that the pendulum settles on within 120 from (*x, *v): they become its point. */
static double trace_of(pendres_context *ctx, const pendres_pendulum *p, pendres_flow_way way, int n,
                       double *x, double *v)
{
  pendres_block *b;
  double column[2], trace = 0.0;
  long turns = 0;
  pendres_coordinates at = pendres_coordinates_in(p, *x, *v);
  check_ok(pendres_block_open(ctx, PENDRES_FLOW_STATE, n, &b));
  check_ok(pendres_block_carry(b, PENDRES_FLOW_TANGENTS));
  for (int period = 0; period <= 120; period++) {
    pendres_block_resize(b, 2);
    for (size_t lane = 0; lane < 2; lane++) {
      pendres_block_load(b, lane, p, at.y, at.w);
      pendres_block_put_tangent(b, lane, 0, (double[2]){lane == 0, lane == 1});
    }
    check_ok(pendres_block_period_by(b, way));
    const pendres_rows rows = pendres_block_rows(b);
    at.y = pendres_rows_get(&rows, PENDRES_ROW_Y, 0);
    at.w = pendres_rows_get(&rows, PENDRES_ROW_W, 0);
    pendres_coordinates_wrap(p, &at.y, &turns);
  }
  for (size_t lane = 0; lane < 2; lane++) {
    pendres_block_get_tangent(b, lane, 0, column);
    trace += column[lane];
    double second[2]; /* the same */
    pendres_block_get_tangent(b, lane, 1, second);
    assert_memory_equal(column, second, sizeof column);
  }
  (void)pendres_block_carry(b, PENDRES_FLOW_NOTHING);
  pendres_coordinates_out(p, &at, x, v);
  return trace;
}

/* How far the trace is off, with n steps; NaN: the pendulum does not settle on an orbit of one
   period. */
static double trace_error(pendres_context *ctx, const pendres_pendulum *p, pendres_flow_way way,
                          int n)
{
  double x = pendres_model_origin(p) + 0.3, v = 0.0;
  pendres_orbit orbit;
  pendres_status outcome;
  const double trace = trace_of(ctx, p, way, n, &x, &v);
  const pendres_orbit_guess guess = {.pendulum = *p, .x = x, .v = v, .period = 1};
  if (!isfinite(trace + x + v)) return NAN;
  check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome));
  if (outcome != PENDRES_OK || !orbit.stable || fabs(orbit.x - x) > 0.02) return NAN;
  const double exact = orbit.multiplier_re[0] + orbit.multiplier_re[1];
  return fabs(trace - exact) / (1.0 + fabs(exact));
}

/* With the steps that are chosen for averages multipliers of drawn pendulums are right to 1e-4, and
   of nineteen in twenty to 1e-5, in either precision: numbers.h says so. */
static void test_steps_of_averages_are_enough(void **state)
{
  enum { PENDULUMS = 60 };
  pendres_context *ctx = NULL;
  int orbits = 0, beyond = 0, single = 0;
  double largest = 0.0;
  (void)state;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-10}, &ctx));
  seed = 5;
  for (int i = 0; i < 4 * PENDULUMS && orbits < PENDULUMS; i++) {
    const pendres_pendulum p = drawn(i);
    const double speed = fmax(pendres_steps_speed(&p, pendres_model_origin(&p) + 0.3, 0.0),
                              pendres_steps_turning_speed(&p));
    pendres_strobe_lane lane = {.pendulum = &p};
    check_ok(pendres_strobe_choose_average(ctx, speed, 1e-4, &lane));
    /* It does not settle. */
    if (isnan(trace_error(ctx, &p, PENDRES_FLOW_NYSTROM, 8 * lane.steps))) continue;
    const double error = trace_error(ctx, &p, lane.way, lane.steps);
    beyond += !(error <= 1e-5);
    single += lane.way == PENDRES_FLOW_SINGLE;
    if (!(error <= largest)) largest = error;
    orbits++;
  }
  print_message("%d of %d above 1e-5, largest %.2g; %d in single precision\n", beyond, orbits,
                largest, single);
  assert_int_equal(orbits, PENDULUMS);
  assert_true(beyond <= PENDULUMS / 20 && largest < 1e-4);
  assert_true(single > orbits / 2 && single < orbits);
  pendres_context_free(ctx);
}

/* What it cannot do is refused: derivatives, and in single precision forces of their own. */
static void test_refuses(void **state)
{
  pendres_context *ctx = NULL;
  pendres_block *b;
  const pendres_pendulum p = {.damping = 0.1, .drive_frequency = 1.0, .force = PENDRES_FORCE_SQUID};
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  for (int k = 0; k < 2; k++) {
    const pendres_flow_way way = k == 0 ? PENDRES_FLOW_SINGLE : PENDRES_FLOW_NYSTROM;
    check_ok(pendres_block_open(ctx, k == 0 ? PENDRES_FLOW_STATE : PENDRES_FLOW_VARIATIONAL, STEPS,
                                &b));
    pendres_block_resize(b, 1);
    pendres_block_load(b, 0, &p, 0.0, 0.0);
    assert_int_equal(pendres_block_period_by(b, way), PENDRES_INVALID_ARGUMENT);
  }
  pendres_context_free(ctx);
}

/* ---- single precision ---- */

/* Who asks for an error that it meets gets it, a slow plain pendulum alone. */
static void test_where_it_is_used(void **state)
{
  static const double accuracy[] = {1e-5, 1e-7, 1e-5, 1e-5, 1e-5};
  static const pendres_flow_way way[] = {PENDRES_FLOW_SINGLE, PENDRES_FLOW_NYSTROM,
                                         PENDRES_FLOW_NYSTROM, PENDRES_FLOW_NYSTROM,
                                         PENDRES_FLOW_TABLE};
  pendres_context *ctx = NULL;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  for (int k = 0; k < 5; k++) {
    const pendres_pendulum p = {.damping = 0.1, .drive_frequency = 0.8,
                                .drive_amplitude = k == 4 ? 0.0 : 0.2,
                                .torque = k == 2 ? 1e-300 : 0.0};
    const double speed = k == 3 ? 30.0 : 1.0;
    pendres_strobe_lane lane = {.pendulum = &p};
    check_ok(pendres_strobe_choose(ctx, speed, accuracy[k], &lane));
    pendres_strobe_noise_choose(speed, pendres_strobe_noise_fastest(ctx, &p), accuracy[k], &lane);
    assert_int_equal(lane.way, way[k]);
    assert_true((lane.added > 0.0) == (way[k] == PENDRES_FLOW_SINGLE));
  }
  pendres_context_free(ctx);
}

/* The states of all lanes of a flow, row after row. */
static void take_rows(const pendres_block *flow, double at[2][MOST])
{
  const pendres_rows rows = pendres_block_rows(flow);
  for (size_t i = 0; i < 2 * MOST; i++)
    at[i / MOST][i % MOST] = pendres_rows_get(&rows, (int)(i / MOST), i % MOST);
}

/* Pendulums of the same parameters from y and w, which carry an error that begins at zero. */
static void load_flow(pendres_block *flow, int steps, const pendres_pendulum *p, const double *y,
                      const double *w, double added)
{
  pendres_block_clear(flow);
  check_ok(pendres_block_set_steps(flow, steps));
  pendres_block_resize(flow, MOST);
  for (size_t i = 0; i < MOST; i++) {
    pendres_block_load(flow, i, p, y[i], w[i]);
    pendres_block_set_error(flow, i, &(pendres_flow_error){0}, added);
  }
}

/* The largest distance of states from what they should be, and its root mean square, in standard
   deviations that are carried. */
typedef struct distances {
  double square, largest;
  int count;
} distances;

static void compare(distances *d, const pendres_block *flow, double at[2][MOST], double to[2][MOST])
{
  for (size_t i = 0; i < MOST; i++) {
    const pendres_flow_error e = pendres_block_get_error(flow, i);
    const double off = hypot(at[0][i] - to[0][i], at[1][i] - to[1][i]) / sqrt(e.yy + e.ww);
    d->square += off * off;
    d->largest = isnan(off) ? INFINITY : fmax(d->largest, off);
    d->count++;
  }
}

/*
 * Random pendulums over a period of as many steps as an error of 1e-5 needs, in single precision.
 * Beside double precision with the same steps they differ by rounding alone; of what is carried for
 * that the largest of 8,000 is 2.5 and the root mean square 0.2; three standard deviations count
 * for a label, and wherever single precision is used at least as much is carried for the steps
 * again, a factor of root two. Beside 200 steps the error of the steps joins in: 0.9 and 0.03, as
 * steps are chosen for the worst start.
 */
static void test_carried_error_holds_the_rounding(void **state)
{
  enum { ROUNDS = 40, MANY_STEPS = 200 };
  static const double accuracy = 1e-5;
  const double rounding = pendres_strobe_noise_of_single_step();
  pendres_context *chooses = NULL, *ctx = NULL;
  pendres_block *flow = NULL;
  distances alone = {0}, in_all = {0};
  (void)state;
  check_ok(pendres_context_create(NULL, &chooses));
  const pendres_options options = {.block_lanes = MOST};
  check_ok(pendres_context_create(&options, &ctx));
  check_ok(pendres_block_of(ctx, PENDRES_FLOW_STATE, &flow));
  check_ok(pendres_block_carry(flow, PENDRES_FLOW_ERRORS));
  seed = 11;
  for (int round = 0; round < ROUNDS; round++) {
    const pendres_pendulum p = {.damping = between(0.02, 1.0),
                                .drive_amplitude = between(0.0, 1.0),
                                .drive_frequency = between(0.5, 1.5)};
    double y[MOST], w[MOST], exact[2][MOST], rounded[2][MOST], got[2][MOST];
    int steps = 0;
    for (int i = 0; i < MOST; i++) {
      y[i] = between(-pi, pi);
      w[i] = between(-2.0, 2.0) / p.drive_frequency;
    }
    check_ok(pendres_steps_choose(chooses, &p, 2.0, accuracy, &steps));
    load_flow(flow, MANY_STEPS, &p, y, w, 0.0);
    check_ok(pendres_block_period(flow));
    take_rows(flow, exact);
    load_flow(flow, steps, &p, y, w, 0.0);
    check_ok(pendres_block_period_by(flow, PENDRES_FLOW_NYSTROM));
    take_rows(flow, rounded);
    load_flow(flow, steps, &p, y, w, rounding * rounding);
    check_ok(pendres_block_period_by(flow, PENDRES_FLOW_SINGLE));
    take_rows(flow, got);
    compare(&alone, flow, got, rounded);
    load_flow(flow, steps, &p, y, w, rounding * rounding + accuracy * accuracy / steps);
    check_ok(pendres_block_period_by(flow, PENDRES_FLOW_SINGLE));
    compare(&in_all, flow, got, exact);
  }
  const double typical = sqrt(alone.square / alone.count);
  print_message("of what is carried: rounding rms %.2f, largest %.2f; in all %.2f, %.2f\n", typical,
                alone.largest, sqrt(in_all.square / in_all.count), in_all.largest);
  assert_true(alone.largest < 3.0 * sqrt(2.0) && typical > 0.1);
  assert_true(in_all.largest < 3.0);
  pendres_context_free(chooses);
  pendres_context_free(ctx);
}

/*
 * Labels of a picture's rows, whose first run is in single precision, beside those of the same
 * states one by one, in double precision: where both are certain they agree. Random pendulums,
 * among them some with fractal boundaries.
 */
static void test_labels_are_those_of_double_precision(void **state)
{
  enum { SIDE = 64, STATES = SIDE * SIDE, DRAWS = 8 };
  size_t index[STATES], compared = 0, left = 0;
  static pendres_basin_state rows[STATES], single[STATES];
  pendres_context *ctx = NULL;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  seed = 5;
  double *x = spaced(SIDE, -pi, pi), *v = spaced(SIDE, -2.5, 2.5);
  const pendres_basin_grid grid = {.nx = SIDE, .nv = SIDE, .x = x, .v = v};
  for (size_t i = 0; i < STATES; i++) index[i] = i;
  for (int draw = 0; draw < DRAWS; draw++) {
    const pendres_pendulum p = {.damping = between(0.05, 0.13),
                                .drive_amplitude = between(0.2, 0.4),
                                .drive_frequency = between(0.62, 0.85)};
    pendres_attractors *set = NULL;
    check_ok(pendres_basin_attractors(ctx, &p, &grid, &set));
    check_ok(pendres_basin_rows(ctx, set, &grid, 0, SIDE, rows));
    check_ok(pendres_basin_states(ctx, set, &grid, STATES, index, single));
    for (size_t i = 0; i < STATES; i++) {
      left += rows[i].how != PENDRES_BASIN_INTEGRATED;
      if (rows[i].how != PENDRES_BASIN_INTEGRATED || single[i].how != PENDRES_BASIN_INTEGRATED)
        continue;
      compared++;
      assert_int_equal(rows[i].attractor, single[i].attractor);
      assert_int_equal(rows[i].well, single[i].well);
    }
    pendres_attractors_free(set);
  }
  print_message("%zu labels agree; %zu uncertain or left for later\n", compared, left);
  assert_true(compared > DRAWS * STATES / 2);
  free(x);
  free(v);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_same_bytes_on_every_instruction_set),
    cmocka_unit_test(test_order_is_eight),
    cmocka_unit_test(test_steps_of_a_table_are_enough),
    cmocka_unit_test(test_steps_of_averages_are_enough),
    cmocka_unit_test(test_refuses),
    cmocka_unit_test(test_where_it_is_used),
    cmocka_unit_test(test_carried_error_holds_the_rounding),
    cmocka_unit_test(test_labels_are_those_of_double_precision),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
