/* test_split.c -- periods by a splitting: the same bytes everywhere; order four for strobe points
   and six for multipliers, with every force; and whether the steps that are chosen are enough. */
#include "check.h"

#include <stdlib.h>

#include <pendres/pendres.h>

#include "base/instructions.h"
#include "engine/block.h"
#include "engine/block_internal.h"
#include "engine/context_internal.h"
#include "engine/kernels/coordinates.h"
#include "engine/steps.h"
#include "engine/sundials/lanes.h"
#include "model/model.h"
#include "oracle.h"
#include "basin_fixture.h"

enum { MOST = 72, ROWS = 13, STEPS = 20, DRAWS = 24 };

static uint64_t seed;

static double between(double from, double to)
{
  return from + (to - from) * next_random(&seed);
}

/* ---- the same bytes ---- */

static pendres_split_lanes lanes_of(double *const *row, pendres_model_terms model, size_t from,
                                    size_t lanes)
{
  pendres_split_lanes b = {.lanes = lanes, .model = model, .y = row[0] + from, .w = row[1] + from,
                           .tangent_y = row[2] + from, .tangent_w = row[3] + from,
                           .k = {.stiffness = row[4] + from, .drive = row[5] + from,
                                 .friction = row[6] + from, .torque = row[7] + from,
                                 .modulation = row[8] + from}};
  for (int c = 0; c < PENDRES_FORCE_COEFFICIENTS; c++) b.k.power[c] = row[8 + c % 5] + from;
  return b;
}

static void draw_rows(double *const *row)
{
  static const double from[ROWS] = {-3, -4, -1, -1, 0.4, 0, 0.01, -1, -1, -1, -1, -1, -1};
  static const double to[ROWS] = {3, 4, 1, 1, 4, 1, 1, 1, 1, 1, 1, 1, 1};
  seed = 7;
  for (int k = 0; k < ROWS; k++)
    for (int i = 0; i < MOST; i++) row[k][i] = between(from[k], to[k]);
}

/* Each instruction set, and blocks of 8 lanes instead of 72, give the same bytes. */
static void test_same_bytes_on_every_instruction_set(void **state)
{
  const pendres_kernels_split *list[3] = {&pendres_kernels_split_base};
  const pendres_instructions here = pendres_instructions_here();
  size_t count = 1;
#if defined(__x86_64__)
  if (here >= PENDRES_INSTRUCTIONS_AVX2) list[count++] = &pendres_kernels_split_avx2;
  if (here >= PENDRES_INSTRUCTIONS_AVX512) list[count++] = &pendres_kernels_split_avx512;
#endif
  pendres_split_steps s = {0};
  double *first[ROWS], *other[ROWS];
  (void)state;
  (void)here;
  assert_int_equal(pendres_block_split_prepare(&s, STEPS), 0);
  for (int k = 0; k < ROWS; k++) {
    first[k] = pendres_lanes_allocate(MOST);
    other[k] = pendres_lanes_allocate(MOST);
    assert_true(first[k] != NULL && other[k] != NULL);
  }
  for (size_t k = 0; k < 2 * count * PENDRES_MODEL_COUNT; k++) {
    const pendres_model_terms model = (pendres_model_terms)(k / (2 * count));
    const size_t each = k / count % 2 == 0 ? MOST : 8;
    draw_rows(first);
    draw_rows(other);
    const pendres_split_lanes whole = lanes_of(first, model, 0, MOST);
    list[0]->run(&s, &whole);
    for (size_t i = 0; i < MOST; i += each) {
      const pendres_split_lanes part = lanes_of(other, model, i, each);
      list[k % count]->run(&s, &part);
    }
    for (int r = 0; r < ROWS; r++)
      assert_memory_equal(first[r], other[r], MOST * sizeof(double));
  }
  for (int k = 0; k < ROWS; k++) {
    free(first[k]);
    free(other[k]);
  }
  free(s.cosine);
  free(s.sine);
}

/* ---- beside long double ---- */

/* A pendulum of each kind, moderately driven. */
static pendres_pendulum drawn(int i)
{
  pendres_pendulum p = {.damping = between(0.05, 1.0), .drive_amplitude = between(0.0, 1.5),
                        .drive_frequency = between(0.5, 1.5)};
  if (i % 4 != 0) p.torque = between(-0.5, 0.5);
  if (i % 4 != 0) p.parametric_amplitude = between(-1.0, 1.0);
  if (i % 4 == 2) p.force = PENDRES_FORCE_POLYNOMIAL;
  if (i % 4 == 3) p.force = PENDRES_FORCE_SQUID;
  if (i % 4 >= 2) p.force_coefficients[0] = between(0.2, 1.0);
  for (int c = 1; c < PENDRES_FORCE_COEFFICIENTS && i % 4 == 2; c++)
    p.force_coefficients[c] = c % 2 == 0 ? between(0.0, 0.5) : between(-0.1, 0.1);
  return p;
}

/* One period by a splitting of n steps from (y, v): how far y and v are from those of long double,
   as a multiple of how a start's error grows. */
static double error_of(pendres_context *ctx, const pendres_pendulum *p, double y, double v, int n)
{
  const oracle o = oracle_of(p);
  long double s[ORACLE_SIZE] = {y, v, 1.0L, 0.0L, 0.0L, 1.0L};
  pendres_block *b;
  oracle_advance(&o, 1, s);
  check_ok(pendres_block_open(ctx, PENDRES_FLOW_STATE, n, &b));
  pendres_block_resize(b, 1);
  double w = v / p->drive_frequency, growth = 1.0;
  pendres_block_split_state(p, n, 0, &y, &w);
  pendres_block_load(b, 0, p, y, w);
  check_ok(pendres_block_period_by(b, PENDRES_FLOW_SPLIT));
  const pendres_rows rows = pendres_block_rows(b);
  y = pendres_rows_get(&rows, PENDRES_ROW_Y, 0);
  w = pendres_rows_get(&rows, PENDRES_ROW_W, 0);
  pendres_block_split_state(p, n, 1, &y, &w);
  for (int k = 2; k < ORACLE_SIZE; k++) growth = fmax(growth, fabs((double)s[k]));
  return fmax(fabs(y - (double)s[0]), fabs(p->drive_frequency * w - (double)s[1])) / growth;
}

/* With twice the steps the error is a sixteenth: of six pendulums of each force together, from 200
   to 400 steps, where the order holds to a few per cent and rounding, 1e-13, is far away. */
static void test_order_is_four_for_every_force(void **state)
{
  (void)state;
  for (int kind = 0; kind < 4; kind++) {
    pendres_context *ctx = NULL;
    double coarse = 0.0, fine = 0.0;
    check_ok(pendres_context_create(NULL, &ctx));
    seed = 31 + (uint64_t)kind;
    for (int i = 0; i < 6; i++) {
      const pendres_pendulum p = drawn(4 * i + kind);
      const double y = between(-1.5, 1.5), v = between(-1.0, 1.0);
      coarse += error_of(ctx, &p, y, v, 200);
      fine += error_of(ctx, &p, y, v, 400);
    }
    print_message("force %d: errors %.2g, %.2g, ratio %.2f\n", kind, coarse, fine, coarse / fine);
    assert_true(fine > 1e-11);
    check_near(coarse / fine, 16.0, 1.6);
    pendres_context_free(ctx);
  }
}

/* The trace of the derivative of a period's map, by a splitting of n steps, on the orbit of one
   period that the pendulum settles on within 200 from (*x, *v): they become its point. */
static double trace_of(pendres_context *ctx, const pendres_pendulum *p, int n, double *x, double *v)
{
  pendres_block *b;
  double column[2], trace = 0.0;
  long turns = 0;
  pendres_coordinates at = pendres_coordinates_in(p, *x, *v);
  check_ok(pendres_block_open(ctx, PENDRES_FLOW_STATE, n, &b));
  check_ok(pendres_block_carry(b, PENDRES_FLOW_TANGENTS));
  pendres_block_split_state(p, n, 0, &at.y, &at.w);
  for (int period = 0; period <= 200; period++) {
    pendres_block_resize(b, 2);
    for (size_t lane = 0; lane < 2; lane++) {
      pendres_block_load(b, lane, p, at.y, at.w);
      pendres_block_put_tangent(b, lane, 0, (double[2]){lane == 0, lane == 1});
    }
    check_ok(pendres_block_period_by(b, PENDRES_FLOW_SPLIT));
    const pendres_rows rows = pendres_block_rows(b);
    at.y = pendres_rows_get(&rows, PENDRES_ROW_Y, 0);
    at.w = pendres_rows_get(&rows, PENDRES_ROW_W, 0);
    pendres_coordinates_wrap(p, &at.y, &turns);
  }
  for (size_t lane = 0; lane < 2; lane++) {
    pendres_block_get_tangent(b, lane, 0, column);
    trace += column[lane];
    /* Both tangents are the one with the block's steps. */
    double second[2];
    pendres_block_get_tangent(b, lane, 1, second);
    assert_memory_equal(column, second, sizeof column);
  }
  (void)pendres_block_carry(b, PENDRES_FLOW_NOTHING);
  pendres_block_split_state(p, n, 1, &at.y, &at.w);
  pendres_coordinates_out(p, &at, x, v);
  return trace;
}

/* How far the trace is off, with n steps; NaN: the pendulum does not settle on an orbit of one
   period. */
static double trace_error(pendres_context *ctx, const pendres_pendulum *p, int n)
{
  double x = pendres_model_origin(p) + 0.3, v = 0.0;
  pendres_orbit orbit;
  pendres_status outcome;
  const double trace = trace_of(ctx, p, n, &x, &v);
  const pendres_orbit_guess guess = {.pendulum = *p, .x = x, .v = v, .period = 1};
  if (!isfinite(trace + x + v)) return NAN;
  check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome));
  if (outcome != PENDRES_OK || !orbit.stable || fabs(orbit.x - x) > 0.02) return NAN;
  const double exact = orbit.multiplier_re[0] + orbit.multiplier_re[1];
  return fabs(trace - exact) / (1.0 + fabs(exact));
}

static int by_size(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

/* What does not depend on coordinates has an error of sixth order: with twice the steps, 64 for 32
   or of polynomials, which are stiffer, 128 for 64, it falls to a sixty-fourth. So does the median
   of seven orbits of each force, within a quarter of that; at some the leading error is small. */
static void test_multipliers_are_of_order_six(void **state)
{
  enum { ORBITS = 7 };
  (void)state;
  for (int kind = 0; kind < 4; kind++) {
    pendres_context *ctx = NULL;
    double fall[ORBITS];
    int orbits = 0;
    const int n = kind == 2 ? 64 : 32;
    check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-12}, &ctx));
    seed = 41 + (uint64_t)kind;
    for (int i = 0; i < 40 && orbits < ORBITS; i++) {
      const pendres_pendulum p = drawn(4 * i + kind);
      const double once = trace_error(ctx, &p, n), twice = trace_error(ctx, &p, 2 * n);
      if (!isnan(once) && !isnan(twice)) fall[orbits++] = once / twice;
    }
    assert_int_equal(orbits, ORBITS);
    qsort(fall, ORBITS, sizeof *fall, by_size);
    print_message("force %d: errors fall to 1/%.1f\n", kind, fall[ORBITS / 2]);
    check_near(fall[ORBITS / 2], 64.0, 16.0);
    pendres_context_free(ctx);
  }
}

/* With the steps that are chosen multipliers of 200 drawn pendulums are right to 1e-3, and of
   nineteen in twenty to 1e-5: numbers.h says so. */
static void test_steps_are_enough(void **state)
{
  enum { PENDULUMS = 200 };
  pendres_context *ctx = NULL;
  int orbits = 0, beyond = 0;
  double largest = 0.0;
  (void)state;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-10}, &ctx));
  seed = 5;
  for (int i = 0; i < 4 * PENDULUMS && orbits < PENDULUMS; i++) {
    const pendres_pendulum p = drawn(i);
    const double speed = fmax(pendres_steps_speed(&p, pendres_model_origin(&p) + 0.3, 0.0),
                              pendres_steps_turning_speed(&p));
    int steps = 0;
    check_ok(pendres_steps_choose_split(ctx, &p, speed, 1e-4, &steps));
    if (isnan(trace_error(ctx, &p, 8 * steps))) continue; /* it does not settle */
    const double error = trace_error(ctx, &p, steps);
    beyond += !(error <= 1e-5);
    if (!(error <= largest)) largest = error;
    orbits++;
  }
  print_message("%d of %d above 1e-5, largest %.2g\n", beyond, orbits, largest);
  assert_int_equal(orbits, PENDULUMS);
  assert_true(beyond <= PENDULUMS / 20 && largest < 1e-3);
  pendres_context_free(ctx);
}

/* What it cannot do is refused. */
static void test_refusals(void **state)
{
  pendres_context *ctx = NULL;
  pendres_block *b;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_block_open(ctx, PENDRES_FLOW_VARIATIONAL, STEPS, &b));
  pendres_block_resize(b, 8);
  assert_int_equal(pendres_block_period_by(b, PENDRES_FLOW_SPLIT), PENDRES_INVALID_ARGUMENT);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_same_bytes_on_every_instruction_set),
    cmocka_unit_test(test_order_is_four_for_every_force),
    cmocka_unit_test(test_multipliers_are_of_order_six),
    cmocka_unit_test(test_steps_are_enough),
    cmocka_unit_test(test_refusals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
