/*
 * test_lanes.c -- the vector of a block: its operations, and that deferring them changes nothing.
 */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "engine/sundials/compat.h"
#include "base/sine.h"
#include "engine/sundials/lanes.h"
#include "engine/sundials/lanes_tape.h"

enum { MOST = 208, ROWS = PENDRES_ROWS_STATE };

/* A shape with its context and coefficients. */
typedef struct block {
  SUNContext sun;
  pendres_lanes_shape shape;
  double *k[4];
} block;

static void open_block(block *b, size_t rows, size_t lanes)
{
  assert_int_equal(pendres_compat_context_create(&b->sun), 0);
  assert_int_equal(pendres_lanes_open(&b->shape, rows, lanes, pendres_kernels_select()), 0);
  for (int i = 0; i < 4; i++) {
    b->k[i] = pendres_lanes_allocate(b->shape.capacity);
    assert_non_null(b->k[i]);
    for (size_t j = 0; j < b->shape.capacity; j++)
      b->k[i][j] = 0.2 + 0.3 * i + 0.001 * (double)j;
  }
  b->shape.coefficients = (pendres_coefficients){b->k[0], b->k[1], b->k[2], b->k[3]};
}

static void close_block(block *b)
{
  pendres_lanes_close(&b->shape);
  for (int i = 0; i < 4; i++) free(b->k[i]);
  SUNContext_Free(&b->sun);
}

static N_Vector make(block *b)
{
  N_Vector v = pendres_lanes_create(&b->shape, b->sun);
  assert_non_null(v);
  return v;
}

/* Row r, lane i of a vector becomes f(r, i). */
static void fill(block *b, N_Vector v, double (*f)(size_t, size_t))
{
  double rows[PENDRES_ROWS_SENSITIVITY * MOST];
  for (size_t r = 0; r < b->shape.rows; r++)
    for (size_t i = 0; i < b->shape.stride; i++) rows[r * b->shape.stride + i] = f(r, i);
  pendres_lanes_write(v, rows);
}

static double at(N_Vector v, const block *b, size_t row, size_t lane)
{
  double rows[PENDRES_ROWS_SENSITIVITY * MOST];
  pendres_lanes_read(v, rows);
  return rows[row * b->shape.stride + lane];
}

/* All numbers of v are f(r, i), exactly. */
static void check_all(const block *b, N_Vector v, double (*f)(size_t, size_t))
{
  double rows[PENDRES_ROWS_SENSITIVITY * MOST];
  pendres_lanes_read(v, rows);
  for (size_t r = 0; r < b->shape.rows; r++)
    for (size_t i = 0; i < b->shape.stride; i++)
      check_near(rows[r * b->shape.stride + i], f(r, i), 0.0);
}

static double ramp(size_t r, size_t i)
{
  return 1.0 + (double)i + 1000.0 * (double)r;
}

static double falling(size_t r, size_t i)
{
  return -0.5 - 0.25 * (double)i - (double)r;
}

static double nothing(size_t r, size_t i)
{
  (void)r, (void)i;
  return 0.0;
}

static double not_a_number(size_t r, size_t i)
{
  (void)r, (void)i;
  return NAN;
}

/* Rows go in and out as they are, for every number of lanes, rows and strips. */
static void test_rows_in_and_out(void **state)
{
  static const size_t rows[] = {PENDRES_ROWS_STATE, PENDRES_ROWS_VARIATIONAL,
                                PENDRES_ROWS_SENSITIVITY};
  (void)state;
  for (size_t e = 0; e < 3; e++) {
    block b;
    open_block(&b, rows[e], MOST);
    N_Vector v = make(&b);
    check_all(&b, v, nothing);
    for (size_t lanes = MOST; lanes > 0; lanes -= 1 + lanes / 7) {
      pendres_lanes_resize(&b.shape, lanes);
      assert_int_equal(b.shape.stride, (lanes + 7) / 8 * 8);
      assert_int_equal(N_VGetLength(v), rows[e] * b.shape.stride);
      fill(&b, v, ramp);
      check_all(&b, v, ramp);
    }
    N_VDestroy(v);
    close_block(&b);
  }
}

/* Strips cover all lanes once, in multiples of 8. */
static void test_strips(void **state)
{
  (void)state;
  block b;
  open_block(&b, PENDRES_ROWS_VARIATIONAL, 4096);
  for (size_t lanes = 0; lanes <= 4096; lanes += 8) {
    size_t lane = 0;
    pendres_lanes_resize(&b.shape, lanes);
    while (lane < lanes) {
      const size_t strip = pendres_lanes_strip(&b.shape, lane);
      assert_true(strip > 0 && strip % 8 == 0);
      lane += strip;
    }
    assert_int_equal(lane, lanes);
  }
  close_block(&b);
}

static double linear(size_t r, size_t i)
{
  return 2.0 * ramp(r, i) - 4.0 * falling(r, i);
}

static double threefold(size_t r, size_t i)
{
  return 3.0 * ramp(r, i);
}

static double quotient(size_t r, size_t i)
{
  return ramp(r, i) / falling(r, i);
}

static double product(size_t r, size_t i)
{
  return ramp(r, i) * falling(r, i);
}

static double positive(size_t r, size_t i)
{
  return -falling(r, i);
}

static double inverse(size_t r, size_t i)
{
  return 1.0 / ramp(r, i);
}

static double shifted(size_t r, size_t i)
{
  return ramp(r, i) + 0.5;
}

static double constant(size_t r, size_t i)
{
  (void)r, (void)i;
  return 2.5;
}

/* What ARKODE may call, by its names. Numbers are small multiples of 1/4: all exact. */
static void test_operations(void **state)
{
  (void)state;
  block b;
  open_block(&b, ROWS, 88);
  N_Vector x = make(&b), y = make(&b), z = N_VClone(x);
  assert_non_null(z);
  fill(&b, x, ramp);
  fill(&b, y, falling);
  N_VLinearSum(2.0, x, -4.0, y, z);
  check_all(&b, z, linear);
  N_VScale(3.0, x, z);
  check_all(&b, z, threefold);
  N_VScale(1.0, x, z);
  check_all(&b, z, ramp);
  N_VScale(3.0, z, z); /* in place */
  check_all(&b, z, threefold);
  N_VDiv(x, y, z);
  check_all(&b, z, quotient);
  N_VProd(x, y, z);
  check_all(&b, z, product);
  N_VAbs(y, z);
  check_all(&b, z, positive);
  N_VInv(x, z);
  check_all(&b, z, inverse);
  N_VAddConst(x, 0.5, z);
  check_all(&b, z, shifted);
  N_VConst(2.5, z);
  check_all(&b, z, constant);
  check_near(N_VMaxNorm(y), positive(1, 87), 0.0);
  check_near(N_VMin(y), falling(1, 87), 0.0);
  N_VDestroy(x);
  N_VDestroy(y);
  N_VDestroy(z);
  close_block(&b);
}

/* A term with a zero coefficient is not looked at: ARKODE hands over vectors never filled. */
static void test_zero_coefficients_are_skipped(void **state)
{
  (void)state;
  block b;
  open_block(&b, ROWS, 200);
  N_Vector x = make(&b), bad = make(&b), y = make(&b), z = make(&b);
  double c[4] = {0.0, 2.0, 0.0, -4.0};
  N_Vector terms[4] = {bad, x, bad, y};
  fill(&b, bad, not_a_number);
  fill(&b, x, ramp);
  fill(&b, y, falling);
  assert_int_equal(N_VLinearCombination(4, c, terms, z), 0);
  check_all(&b, z, linear);
  /* None left: zero. */
  memset(c, 0, sizeof c);
  assert_int_equal(N_VLinearCombination(4, c, terms, z), 0);
  check_all(&b, z, nothing);
  /* More terms than any table has are refused, not cut. */
  double many[PENDRES_KERNELS_TERMS + 1];
  N_Vector vectors[PENDRES_KERNELS_TERMS + 1];
  for (int i = 0; i <= PENDRES_KERNELS_TERMS; i++) {
    many[i] = 1.0;
    vectors[i] = x;
  }
  assert_int_not_equal(N_VLinearCombination(PENDRES_KERNELS_TERMS + 1, many, vectors, z), 0);
  N_VDestroy(x);
  N_VDestroy(y);
  N_VDestroy(z);
  N_VDestroy(bad);
  close_block(&b);
}

static double one(size_t r, size_t i)
{
  (void)r, (void)i;
  return 1.0;
}

static double one_lane_large(size_t r, size_t i)
{
  return i == 61 ? 3.0 + (double)r : 0.5;
}

static double one_lane_lost(size_t r, size_t i)
{
  return i == 7 && r == 1 ? NAN : 1e3;
}

/* The largest over the lanes of each lane's root mean square; NaN wins. */
static void test_norm(void **state)
{
  (void)state;
  block b;
  open_block(&b, ROWS, 104);
  N_Vector x = make(&b), w = make(&b);
  fill(&b, w, one);
  fill(&b, x, one_lane_large);
  check_near(N_VWrmsNorm(x, w), sqrt((9.0 + 16.0) / 2.0), 1e-15); /* two roundings */
  fill(&b, x, one_lane_lost);
  assert_true(isnan(N_VWrmsNorm(x, w)));
  assert_true(isnan(N_VMaxNorm(x)));
  b.shape.norm_unused = 1;
  check_near(N_VWrmsNorm(x, w), 0.0, 0.0);
  N_VDestroy(x);
  N_VDestroy(w);
  close_block(&b);
}

/* ---- Putting off ----------------------------------------------------------------------------- */

/* What is overwritten after it was read must be as it was when it was asked for. */
static void test_order_is_kept(void **state)
{
  (void)state;
  block b;
  open_block(&b, ROWS, 160);
  N_Vector x = make(&b), y = make(&b), z = make(&b), kept = make(&b);
  fill(&b, x, ramp);
  N_VScale(1.0, x, kept);
  N_VScale(3.0, x, x);
  N_VScale(1.0, x, y);
  N_VScale(0.0, x, x);
  N_VScale(1.0, kept, z); /* read */
  N_VScale(1.0, y, kept); /* and overwritten */
  check_all(&b, x, nothing);
  check_all(&b, z, ramp);
  check_all(&b, y, threefold);
  check_all(&b, kept, threefold);
  N_VDestroy(x);
  N_VDestroy(y);
  N_VDestroy(z);
  N_VDestroy(kept);
  close_block(&b);
}

/* A vector goes, with operations put off that read or write it. */
static void test_vectors_may_go(void **state)
{
  (void)state;
  block b;
  open_block(&b, ROWS, 64);
  N_Vector x = make(&b), y = make(&b), z = make(&b);
  fill(&b, x, ramp);
  N_VScale(3.0, x, y);
  N_VScale(1.0, y, z);
  N_VScale(1.0, z, x);
  N_VDestroy(y);
  check_all(&b, z, threefold);
  /* A new one, perhaps at the old one's place, is not taken for it. */
  y = make(&b);
  N_VScale(3.0, x, y);
  N_VScale(1.0, y, x);
  check_near(at(x, &b, 1, 5), 9.0 * ramp(1, 5), 0.0);
  N_VDestroy(x);
  N_VDestroy(y);
  N_VDestroy(z);
  close_block(&b);
}

static uint64_t random_state;

static unsigned draw(unsigned below)
{
  random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (unsigned)((random_state >> 33) % below);
}

/* The same operations on plain arrays, each done at once and one number at a time. */
typedef struct model {
  size_t stride;
  double *x; /* vectors one after the other, two rows each */
} model;

static double *of(const model *m, int vector)
{
  return m->x + (size_t)vector * ROWS * MOST;
}

static void model_sum(const model *m, int n, const double *c, const int *x, int z)
{
  for (size_t i = 0; i < ROWS * m->stride; i++) {
    double sum = 0.0;
    int first = 1;
    for (int j = 0; j < n; j++) {
      if (c[j] == 0.0) continue;
      sum = first ? c[j] * of(m, x[j])[i] : fma(c[j], of(m, x[j])[i], sum);
      first = 0;
    }
    of(m, z)[i] = sum;
  }
}

static void model_slope(const model *m, const pendres_coefficients *k, int from, int to, double c)
{
  for (size_t i = 0; i < m->stride; i++) {
    const double y = of(m, from)[i], w = of(m, from)[m->stride + i];
    of(m, to)[i] = w;
    of(m, to)[m->stride + i] =
      fma(-k->stiffness[i], pendres_kernels_sin(y), fma(k->drive[i], c, -(k->friction[i] * w)));
  }
}

enum { VECTORS = 70, USED = 8 }; /* more vectors than the tape can distinguish */

static void random_operation(block *b, const model *m, N_Vector *v, const int *used)
{
  const int z = used[draw(USED)], from = used[draw(USED)];
  const unsigned what = draw(8);
  if (what < 4) {
    double c[5];
    int x[5], n = 1 + (int)draw(5);
    N_Vector terms[5];
    for (int j = 0; j < n; j++) {
      x[j] = used[draw(USED)];
      terms[j] = v[x[j]];
      /* Few different ones, so that sums come again; small, so that nothing overflows. */
      c[j] = 0.25 * ((double)draw(3) - 1.0);
    }
    assert_int_equal(N_VLinearCombination(n, c, terms, v[z]), 0);
    model_sum(m, n, c, x, z);
  } else if (what < 6 && from != z) {
    const double cosine = 0.1 * draw(10);
    pendres_lanes_tape_slope(v[from], v[z], cosine);
    model_slope(m, &b->shape.coefficients, from, z, cosine);
  } else {
    N_VScale(1.0, v[from], v[z]);
    memmove(of(m, z), of(m, from), ROWS * m->stride * sizeof(double));
  }
}

/* Long random programs: whenever somebody looks, every byte is as if all had been done at once. */
static void test_random_programs(void **state)
{
  block b;
  N_Vector v[VECTORS];
  model m = {.x = calloc((size_t)VECTORS * ROWS * MOST, sizeof(double))};
  (void)state;
  assert_non_null(m.x);
  open_block(&b, ROWS, MOST);
  for (int i = 0; i < VECTORS; i++) v[i] = make(&b);
  for (int round = 0; round < 5000; round++) {
    int used[USED];
    double rows[ROWS * MOST];
    random_state = (uint64_t)round;
    pendres_lanes_resize(&b.shape, 8 * (1 + draw(MOST / 8)));
    m.stride = b.shape.stride;
    for (int i = 0; i < USED; i++) {
      /* All, or but three, which then meet more often; the first or the last made. */
      const int n = round % 4 < 2 ? i : i % 3;
      used[i] = round % 2 == 0 ? n : VECTORS - 1 - n;
      for (size_t j = 0; j < ROWS * m.stride; j++)
        rows[j] = of(&m, used[i])[j] = 0.01 * ((double)draw(500) - 250.0);
      pendres_lanes_write(v[used[i]], rows);
    }
    /* Mostly short, before later operations wipe out a mistake; some beyond what the tape holds. */
    const unsigned length = 1 + draw(round % 100 == 0 ? 3000 : 12);
    for (unsigned k = 0; k < length; k++) random_operation(&b, &m, v, used);
    for (int i = 0; i < USED; i++) {
      pendres_lanes_read(v[used[i]], rows);
      assert_memory_equal(rows, of(&m, used[i]), ROWS * m.stride * sizeof(double));
    }
  }
  for (int i = 0; i < VECTORS; i++) N_VDestroy(v[i]);
  close_block(&b);
  free(m.x);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_rows_in_and_out),
    cmocka_unit_test(test_strips),
    cmocka_unit_test(test_operations),
    cmocka_unit_test(test_zero_coefficients_are_skipped),
    cmocka_unit_test(test_norm),
    cmocka_unit_test(test_order_is_kept),
    cmocka_unit_test(test_vectors_may_go),
    cmocka_unit_test(test_random_programs),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
