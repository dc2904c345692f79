/* test_split.c -- periods by a splitting: the same bytes everywhere, order four for every force,
   the error that steps are chosen for, and tangents whose growth is an orbit's. */
#include "check.h"

#include <stdlib.h>

#include <pendres/pendres.h>

#include "base/instructions.h"
#include "engine/block.h"
#include "engine/block_internal.h"
#include "engine/context_internal.h"
#include "engine/coordinates.h"
#include "engine/steps.h"
#include "engine/lanes.h"
#include "model/model.h"
#include "oracle.h"
#include "basin_fixture.h"

enum { MOST = 72, ROWS = 13, STEPS = 20, DRAWS = 24 };

static const double half_pi = 1.57079632679489661923;

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
  pendres_block_load(b, 0, p, y, v / p->drive_frequency);
  check_ok(pendres_block_period_by(b, PENDRES_FLOW_SPLIT));
  const pendres_rows rows = pendres_block_rows(b);
  double growth = 1.0;
  for (int k = 2; k < ORACLE_SIZE; k++) growth = fmax(growth, fabs((double)s[k]));
  return fmax(fabs(pendres_rows_get(&rows, PENDRES_ROW_Y, 0) - (double)s[0]),
              fabs(p->drive_frequency * pendres_rows_get(&rows, PENDRES_ROW_W, 0) - (double)s[1])) /
         growth;
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

/* Steps are chosen for 1e-4 a period: numbers.h says that one in a hundred pendulums exceeds that.
   So do at most four of 400 drawn ones here, and none by a factor of four. */
static void test_steps_keep_the_error(void **state)
{
  enum { PENDULUMS = 400 };
  pendres_context *ctx = NULL;
  int beyond = 0;
  double largest = 0.0;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  seed = 5;
  for (int i = 0; i < PENDULUMS; i++) {
    const pendres_pendulum p = drawn(i);
    const double y = between(-1.5, 1.5), v = between(-1.0, 1.0);
    const double speed = fmax(pendres_steps_speed(&p, y + pendres_model_origin(&p), v),
                              pendres_steps_turning_speed(&p));
    int steps = 0;
    check_ok(pendres_steps_choose_split(ctx, &p, speed, &steps));
    const double error = error_of(ctx, &p, y, v, steps);
    beyond += error > 1e-4;
    largest = fmax(largest, error);
  }
  print_message("%d of %d above 1e-4, largest %.2g\n", beyond, PENDULUMS, largest);
  assert_true(beyond <= PENDULUMS / 100 && largest < 4e-4);
  pendres_context_free(ctx);
}

/*
 * Along an orbit a tangent vector grows by the larger multiplier, a period after another. After n
 * of them its direction is right to the n-th power of the multipliers' ratio, at most 1e-8 here. The
 * orbit of the splitting and its multipliers differ from the pendulum's by its error: a
 * thousandth with 60 steps, and a sixteenth of that with 120.
 */
static void test_tangents_grow_as_multipliers_say(void **state)
{
  enum { LONG = 60 };
  const pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 0.3, .drive_frequency = 0.5};
  const pendres_orbit_guess guess = {.pendulum = p, .x = half_pi, .period = 1};
  double off[2];
  pendres_orbit orbit;
  pendres_status outcome;
  pendres_context *ctx = NULL;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome));
  check_ok(outcome);
  /* The multipliers are complex: their modulus is the root of the determinant, which is known. */
  const double modulus = exp(-pi * p.damping / p.drive_frequency);
  check_near(hypot(orbit.multiplier_re[0], orbit.multiplier_im[0]), modulus,
             orbit.multiplier_error + 1e-15);
  for (int k = 0; k < 2; k++) {
    pendres_block *b;
    double m[2][2];
    check_ok(pendres_block_open(ctx, PENDRES_FLOW_STATE, 60 << k, &b));
    check_ok(pendres_block_carry(b, PENDRES_FLOW_TANGENTS));
    pendres_block_resize(b, 2);
    for (size_t lane = 0; lane < 2; lane++) {
      pendres_block_load(b, lane, &p, orbit.x - half_pi, orbit.v / p.drive_frequency);
      for (int which = 0; which < 2; which++)
        pendres_block_put_tangent(b, lane, which, (double[2]){lane == 0, lane == 1});
    }
    for (int period = 0; period < LONG; period++)
      check_ok(pendres_block_period_by(b, PENDRES_FLOW_SPLIT));
    /* Both tangents are one matrix, whose determinant is exact and whose trace tells the angle. */
    for (size_t lane = 0; lane < 2; lane++) {
      double column[2], second[2];
      pendres_block_get_tangent(b, lane, 0, column);
      pendres_block_get_tangent(b, lane, 1, second);
      assert_memory_equal(column, second, sizeof column);
      m[0][lane] = column[0];
      m[1][lane] = column[1];
    }
    const double determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    check_near(determinant / pow(modulus, 2 * LONG), 1.0, 1e-11);
    const double angle = LONG * atan2(orbit.multiplier_im[0], orbit.multiplier_re[0]);
    off[k] = fabs((m[0][0] + m[1][1]) / pow(modulus, LONG) - 2.0 * cos(angle));
    (void)pendres_block_carry(b, PENDRES_FLOW_NOTHING);
  }
  print_message("trace of %d periods is off by %.2g, %.2g\n", LONG, off[0], off[1]);
  assert_true(off[0] < 0.05 && off[1] < off[0] / 8.0);
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
    cmocka_unit_test(test_steps_keep_the_error),
    cmocka_unit_test(test_tangents_grow_as_multipliers_say),
    cmocka_unit_test(test_refusals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
