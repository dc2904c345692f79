/* test_kernels.c -- the inner loops: the same bytes on every instruction set and for every split of
   the lanes, and right. */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "engine/kernels.h"
#include "engine/lanes.h"

enum { MOST_LANES = 96, VECTORS = 6, TANGENTS = 5, SIZE = PENDRES_ROWS_ALL * MOST_LANES };

/* Those that this processor runs; the first is the plainest. */
static size_t available(const pendres_kernels *list[3])
{
  size_t n = 0;
  list[n++] = &pendres_kernels_base;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    list[n++] = &pendres_kernels_avx2;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    list[n++] = &pendres_kernels_avx512;
#endif
  return n;
}

static uint64_t random_state;

static double uniform(double from, double to)
{
  random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return from + (to - from) * ((double)(random_state >> 11) * 0x1p-53);
}

/* Some vectors of all rows, one lane after the other within a row, and the equation's numbers. */
typedef struct bench {
  double *vector[VECTORS], *stiffness, *drive, *friction, *inverse, *torque, *modulation;
  double *power[PENDRES_FORCE_COEFFICIENTS];
  double *tangent[TANGENTS]; /* their y, y, w, w, and what is kept of them */
  pendres_sum sum[3];
} bench;

static void close_bench(bench *b)
{
  double *const one[] = {b->stiffness, b->drive, b->friction, b->inverse, b->torque, b->modulation};
  for (size_t i = 0; i < sizeof one / sizeof *one; i++) free(one[i]);
  for (int i = 0; i < VECTORS; i++) free(b->vector[i]);
  for (int i = 0; i < TANGENTS; i++) free(b->tangent[i]);
  for (int i = 0; i < PENDRES_FORCE_COEFFICIENTS; i++) free(b->power[i]);
}

static double *random_lanes(size_t n, double from, double to)
{
  double *x = pendres_lanes_allocate(n);
  assert_non_null(x);
  for (size_t i = 0; i < n; i++) x[i] = uniform(from, to);
  return x;
}

/* What other models have; powers weigh so little that none overflows in program(). */
static void open_terms(bench *b)
{
  for (int k = 0; k < PENDRES_FORCE_COEFFICIENTS; k++)
    b->power[k] = random_lanes(MOST_LANES, -pow(0.01, k), pow(0.01, k));
  b->torque = random_lanes(MOST_LANES, -1.0, 1.0);
  b->modulation = random_lanes(MOST_LANES, -2.0, 2.0);
}

static void open_bench(bench *b, uint64_t seed)
{
  random_state = seed;
  for (int i = 0; i < VECTORS; i++) b->vector[i] = random_lanes(SIZE, -4.0, 4.0);
  b->inverse = random_lanes(MOST_LANES, 1.0 / 3.0, 5.0);
  b->stiffness = random_lanes(MOST_LANES, 1.0, 1.0);
  b->drive = random_lanes(MOST_LANES, 0.0, 1.0);
  b->friction = random_lanes(MOST_LANES, 0.0, 2.0);
  for (int i = 0; i < MOST_LANES; i++) {
    b->stiffness[i] = b->inverse[i] * b->inverse[i];
    b->drive[i] *= b->stiffness[i];
    b->friction[i] *= b->inverse[i];
  }
  for (int i = 0; i < TANGENTS; i++) b->tangent[i] = random_lanes(MOST_LANES, 0.1, 1.0);
  for (int s = 0; s < 3; s++) {
    pendres_sum *q = &b->sum[s];
    q->terms = 1 + (int)uniform(0.0, PENDRES_KERNELS_TERMS);
    q->z = b->vector[s];
    for (int j = 0; j < q->terms; j++) {
      q->term[j].c = uniform(-1.0, 1.0);
      q->term[j].x = b->vector[(s + j) % VECTORS]; /* its own z among them */
    }
  }
  open_terms(b);
}

/* All kinds of operations; vectors are read after they were written, and sums into themselves. */
static size_t program(const bench *b, pendres_operation o[12])
{
  double *const *v = b->vector;
  size_t n = 0;
  o[n++] = (pendres_operation){.sum = &b->sum[0], .to = v[0]};
  o[n++] = (pendres_operation){.from = v[0], .slope = v[3], .cos_theta = 0.3};
  o[n++] = (pendres_operation){.sum = &b->sum[1], .to = v[1], .slope = v[4], .cos_theta = -0.7,
                               .keep = 1};
  o[n++] = (pendres_operation){.from = v[4], .to = v[5]};
  o[n++] = (pendres_operation){0};
  o[n++] = (pendres_operation){.sum = &b->sum[2], .to = v[2], .slope = v[3], .cos_theta = 0.9};
  o[n++] = (pendres_operation){.sum = &b->sum[2], .to = v[2], .slope = v[4], .cos_theta = 0.1,
                               .keep = 1};
  o[n++] = (pendres_operation){.to = v[0]};
  o[n++] = (pendres_operation){.from = v[2], .carry = 0.2, .cos_theta = 0.4};
  o[n++] = (pendres_operation){.from = v[5], .carry = 0.2, .cos_theta = 0.5, .second = 1};
  return n;
}

/* Equations: rows of each model. */
typedef struct equation {
  size_t rows;
  pendres_model_terms model;
} equation;

/* All that there are, model after model. */
#define OF_ALL(CODE, name) {PENDRES_ROWS_STATE, PENDRES_MODEL_##CODE}, \
  {PENDRES_ROWS_VARIATIONAL, PENDRES_MODEL_##CODE}, \
  {PENDRES_ROWS_SENSITIVITY, PENDRES_MODEL_##CODE},
#define OF_OWN(CODE, name) OF_ALL(CODE, name) {PENDRES_ROWS_DRIVES, PENDRES_MODEL_##CODE}, \
  {PENDRES_ROWS_ALL, PENDRES_MODEL_##CODE},
static const equation equations[] = {OF_ALL(PLAIN, ) OF_ALL(PENDULUM, ) OF_OWN(POLYNOMIAL, )
                                     PENDRES_FORCE_LIST(OF_OWN)
                                     {PENDRES_ROWS_DRIVES, PENDRES_MODEL_PENDULUM}};
enum { EQUATIONS = sizeof equations / sizeof *equations };
static const equation plain = {PENDRES_ROWS_STATE, PENDRES_MODEL_PLAIN};

static pendres_strip strip_of(const bench *b, equation e, size_t lane, size_t lanes)
{
  pendres_strip s = {
    .lanes = lanes,
    .model = e.model,
    .at = e.rows * lane,
    .k = {b->stiffness + lane, b->drive + lane, b->friction + lane, b->inverse + lane,
          b->torque + lane, b->modulation + lane, {NULL}},
    .tangent = {.keep = b->tangent[4] + lane}};
  for (int i = 0; i < 2; i++) s.tangent.y[i] = b->tangent[i] + lane;
  for (int i = 0; i < 2; i++) s.tangent.w[i] = b->tangent[2 + i] + lane;
  for (int k = 0; k < PENDRES_FORCE_COEFFICIENTS; k++) s.k.power[k] = b->power[k] + lane;
  return s;
}

static void test_same_bytes_on_every_instruction_set(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list);
  (void)state;
  for (size_t e = 0; e < EQUATIONS; e++)
    for (size_t lanes = 8; lanes <= MOST_LANES; lanes += 8) {
      bench first;
      for (size_t k = 0; k < count; k++) {
        bench b;
        pendres_operation o[12];
        open_bench(&b, 1000 * e + lanes);
        const size_t n = program(&b, o);
        const pendres_strip s = strip_of(&b, equations[e], 0, lanes);
        list[k]->run(equations[e].rows, &s, o, n);
        for (int i = 0; i < VECTORS && k > 0; i++)
          assert_memory_equal(b.vector[i], first.vector[i],
                              equations[e].rows * lanes * sizeof(double));
        for (int i = 0; i < TANGENTS && k > 0; i++)
          assert_memory_equal(b.tangent[i], first.tangent[i], lanes * sizeof(double));
        if (k == 0)
          first = b;
        else
          close_bench(&b);
      }
      close_bench(&first);
    }
}

/* One strip of 88 lanes, or eleven of 8, or 80 and 8: each lane gets the same bytes. */
static void test_same_bytes_however_lanes_are_split(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list), lanes = 88;
  (void)state;
  for (size_t k = 0; k < count; k++)
    for (size_t e = 0; e < EQUATIONS; e++) {
      const size_t rows = equations[e].rows;
      bench whole, parts;
      pendres_operation o[12];
      open_bench(&whole, e);
      open_bench(&parts, e);
      /* The same numbers, row by row of each part. */
      for (int i = 0; i < VECTORS; i++)
        for (size_t lane = 0; lane < lanes; lane++)
          for (size_t r = 0; r < rows; r++)
            parts.vector[i][rows * (lane - lane % 8) + 8 * r + lane % 8] =
              whole.vector[i][r * lanes + lane];
      size_t n = program(&whole, o);
      pendres_strip s = strip_of(&whole, equations[e], 0, lanes);
      list[k]->run(rows, &s, o, n);
      n = program(&parts, o);
      for (size_t lane = 0; lane < lanes; lane += 8) {
        s = strip_of(&parts, equations[e], lane, 8);
        list[k]->run(rows, &s, o, n);
      }
      for (int i = 0; i < VECTORS; i++)
        for (size_t lane = 0; lane < lanes; lane++)
          for (size_t r = 0; r < rows; r++)
            assert_memory_equal(
              &parts.vector[i][rows * (lane - lane % 8) + 8 * r + lane % 8],
              &whole.vector[i][r * lanes + lane], sizeof(double));
      for (int i = 0; i < TANGENTS; i++)
        assert_memory_equal(parts.tangent[i], whole.tangent[i], lanes * sizeof(double));
      close_bench(&whole);
      close_bench(&parts);
    }
}

/* Sum and slope in one go are what they are one after the other. */
static void test_stage_is_sum_then_slope(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list), lanes = 72;
  (void)state;
  for (size_t k = 0; k < count; k++)
    for (size_t e = 0; e < EQUATIONS; e++)
      for (int keep = 0; keep < 2; keep++) {
        const size_t bytes = equations[e].rows * lanes * sizeof(double);
        bench a, b;
        open_bench(&a, 7 * e);
        open_bench(&b, 7 * e);
        const pendres_operation two[] = {
          {.sum = &a.sum[0], .to = a.vector[0]},
          {.from = a.vector[0], .slope = a.vector[5], .cos_theta = 0.4}};
        const pendres_operation one = {
          .sum = &b.sum[0], .to = b.vector[0], .slope = b.vector[5], .cos_theta = 0.4,
          .keep = keep};
        pendres_strip s = strip_of(&a, equations[e], 0, lanes);
        list[k]->run(equations[e].rows, &s, two, 2);
        s = strip_of(&b, equations[e], 0, lanes);
        list[k]->run(equations[e].rows, &s, &one, 1);
        assert_memory_equal(a.vector[5], b.vector[5], bytes);
        if (keep) assert_memory_equal(a.vector[0], b.vector[0], bytes);
        close_bench(&a);
        close_bench(&b);
      }
}

/* Sums against long double: each of t operations is off by half a unit of what has piled up. */
static void test_sums(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list), lanes = 40;
  (void)state;
  for (size_t k = 0; k < count; k++)
    for (uint64_t seed = 0; seed < 20; seed++) {
      bench b;
      open_bench(&b, seed);
      pendres_sum *q = &b.sum[1];
      long double want[2 * 40], size[2 * 40];
      for (size_t i = 0; i < 2 * lanes; i++) {
        want[i] = size[i] = 0.0L;
        for (int j = 0; j < q->terms; j++) {
          want[i] += (long double)q->term[j].c * q->term[j].x[i];
          size[i] += fabsl((long double)q->term[j].c * q->term[j].x[i]);
        }
      }
      const pendres_operation o = {.sum = q, .to = q->z};
      const pendres_strip s = strip_of(&b, plain, 0, lanes);
      list[k]->run(PENDRES_ROWS_STATE, &s, &o, 1);
      for (size_t i = 0; i < 2 * lanes; i++)
        check_near((double)(q->z[i] - want[i]), 0.0, (double)(q->terms * 0x1p-53L * size[i]));
      close_bench(&b);
    }
}

/* ---- The sine -------------------------------------------------------------------------------- */

/* sin of n angles by the slope of a pendulum with stiffness -1, no drive and no friction. */
static void sines(const pendres_kernels *k, const double *y, double *sine, size_t n)
{
  enum { LANES = 64 };
  double *x = pendres_lanes_allocate(2 * LANES), *slope = pendres_lanes_allocate(2 * LANES);
  double *minus = pendres_lanes_allocate(LANES), *zero = pendres_lanes_allocate(LANES);
  assert_true(x && slope && minus && zero);
  for (int i = 0; i < LANES; i++) minus[i] = -1.0;
  const pendres_strip s = {.lanes = LANES, .k = {minus, zero, zero, zero}};
  const pendres_operation o = {.from = x, .slope = slope, .cos_theta = 0.0};
  for (size_t done = 0; done < n; done += LANES) {
    const size_t now = n - done < LANES ? n - done : LANES;
    memcpy(x, y + done, now * sizeof *x);
    k->run(PENDRES_ROWS_STATE, &s, &o, 1);
    memcpy(sine + done, slope + LANES, now * sizeof *sine);
  }
  free(x);
  free(slope);
  free(minus);
  free(zero);
}

/*
 * Two units in the last place or 2e-29, as sine.h promises below 1e4. The reference is the
 * C library's long double sine, right to a unit of its own 64 bits: 1/2048 of a unit here; near
 * the zeros of the sine it is right to relative precision, too.
 */
static void check_sines(const double *y, size_t n)
{
  const pendres_kernels *list[3];
  const size_t count = available(list);
  double *sine = malloc(n * sizeof *sine);
  assert_non_null(sine);
  for (size_t k = 0; k < count; k++) {
    sines(list[k], y, sine, n);
    for (size_t i = 0; i < n; i++) {
      const long double want = sinl((long double)y[i]);
      int exponent = 0;
      (void)frexp((double)want, &exponent);
      const double ulp = ldexp(1.0, exponent - 53 < -1074 ? -1074 : exponent - 53);
      check_near((double)(sine[i] - want), 0.0, fmax(2.0 * ulp, 2e-29));
    }
  }
  free(sine);
}

static void test_sine(void **state)
{
  enum { N = 100000 };
  double *y = malloc(N * sizeof *y);
  (void)state;
  assert_non_null(y);
  random_state = 1;
  for (int i = 0; i < N; i++) y[i] = uniform(-10.0, 10.0);
  check_sines(y, N);
  for (int i = 0; i < N; i++) y[i] = uniform(-1e4, 1e4);
  check_sines(y, N);
  /* Small ones down to denormals, where the sine is the angle. */
  for (int i = 0; i < N; i++) y[i] = ldexp(uniform(-1.0, 1.0), -(i % 1080));
  check_sines(y, N);
  free(y);
}

/* The doubles next to multiples of pi/2: all digits of the argument's reduction show here. */
static void test_sine_next_to_its_zeros(void **state)
{
  enum { N = 6366 }; /* times pi/2: up to 1e4 */
  double *y = malloc(6 * (size_t)N * sizeof *y);
  size_t n = 0;
  (void)state;
  assert_non_null(y);
  for (int k = 0; k < N; k++) {
    const double at = (double)(1.57079632679489661923132169163975L * k);
    const double four[] = {at, -at, nextafter(at, 1e9), nextafter(at, 0.0), at * (1.0 + 1e-9),
                           at * (1.0 - 1e-6)};
    memcpy(y + n, four, sizeof four);
    n += 6;
  }
  check_sines(y, n);
  free(y);
}

static void test_sine_of_nothing(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list);
  const double y[4] = {NAN, INFINITY, -INFINITY, 0.0};
  (void)state;
  for (size_t k = 0; k < count; k++) {
    double sine[4];
    sines(list[k], y, sine, 4);
    assert_true(isnan(sine[0]) && isnan(sine[1]) && isnan(sine[2]));
    assert_true(sine[3] == 0.0);
  }
}

/* ---- The right-hand sides -------------------------------------------------------------------- */

/* A lane's equation in long double, from the physical parameters. */
typedef struct physics {
  long double omega, damping, amplitude, torque, modulation, power[PENDRES_FORCE_COEFFICIENTS];
  long double cosine;
  pendres_model_terms model;
} physics;

/* f (derivative = 0) or f' (1), times what the parametric drive makes of it. */
static long double force_of(const physics *p, long double y, int derivative)
{
  long double f = derivative ? cosl(y) : sinl(y);
  if (p->model == PENDRES_MODEL_SQUID) f += p->power[0] * (derivative ? 1.0L : y);
  if (p->model == PENDRES_MODEL_POLYNOMIAL) f = 0.0L;
  for (int k = 0; p->model == PENDRES_MODEL_POLYNOMIAL && k < PENDRES_FORCE_COEFFICIENTS; k++)
    f += p->power[k] * (derivative ? (k + 1) * powl(y, k) : powl(y, k + 1));
  return f * (1.0L + p->modulation * p->cosine);
}

static long double slope_of_w(const physics *p, long double y, long double w)
{
  const long double push = p->amplitude * p->cosine + p->torque - force_of(p, y, 0);
  return push / (p->omega * p->omega) - p->damping / p->omega * w;
}

/* d(slope of w)/d(parameter number k) at fixed y and w, by central differences: off by h^2 times a
   third derivative, below 1e-11 here, and by rounding, 1e-19/h. */
static long double by_parameter(physics p, int k, long double y, long double w)
{
  const long double h = 1e-6L;
  long double *const parameter[] = {&p.omega, &p.damping, &p.amplitude, &p.torque,
                                    &p.modulation, &p.power[0], &p.power[1], &p.power[2],
                                    &p.power[3], &p.power[4]};
  const long double middle = *parameter[k];
  *parameter[k] = middle + h;
  const long double above = slope_of_w(&p, y, w);
  *parameter[k] = middle - h;
  const long double below = slope_of_w(&p, y, w);
  return (above - below) / (2.0L * h);
}

static physics physics_of(const bench *b, pendres_model_terms model, size_t i, double cos_theta)
{
  const long double omega = 1.0L / b->inverse[i], square = omega * omega;
  physics p = {.omega = omega, .damping = b->friction[i] * omega,
               .amplitude = b->drive[i] * square, .cosine = cos_theta, .model = model};
  if (model == PENDRES_MODEL_PLAIN) return p;
  p.torque = b->torque[i] * square;
  p.modulation = b->modulation[i];
  for (int k = 0; k < PENDRES_FORCE_COEFFICIENTS; k++) p.power[k] = b->power[k][i];
  return p;
}

static void check_lane(const bench *b, equation e, size_t lanes, size_t i, double cos_theta)
{
  const double *x = b->vector[0] + i, *got = b->vector[1] + i;
  const physics p = physics_of(b, e.model, i, cos_theta);
  const long double y = x[0], w = x[lanes], square = p.omega * p.omega;
  const long double to_y = -force_of(&p, y, 1) / square, to_w = -p.damping / p.omega;
  /* At |y| <= 4 the force of the others is below 5, and its slope below 2. */
  const long double force = e.model >= PENDRES_MODEL_POLYNOMIAL ? 6.0L : 2.0L;
  const long double push = force * (1.0L + fabsl(p.modulation)) + p.amplitude + fabsl(p.torque);
  const double size = (double)(push / square + 4.0L * p.damping);

  assert_true(got[0] == x[lanes]);
  /* Coefficients rounded to doubles, and a handful of operations on them: 8 half units. */
  check_near(got[lanes], (double)slope_of_w(&p, y, w), 8.0 * 0x1p-53 * size);
  for (size_t r = 2; r < e.rows; r += 2) {
    const long double u = x[r * lanes], v = x[(r + 1) * lanes];
    long double want = to_y * u + to_w * v;
    double tolerance = 16.0 * 0x1p-53 * 4.0 * size;
    if (r >= PENDRES_ROWS_VARIATIONAL) {
      want += by_parameter(p, (int)(r - PENDRES_ROWS_VARIATIONAL) / 2, y, w);
      tolerance = 1e-9 * size; /* the differences; 24 amplitude h^2/omega^5 at the least omega */
    }
    assert_true(got[r * lanes] == x[(r + 1) * lanes]);
    check_near(got[(r + 1) * lanes], (double)want, tolerance);
  }
}

static void test_right_hand_sides(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list), lanes = MOST_LANES;
  (void)state;
  for (size_t k = 0; k < count; k++)
    for (size_t e = 0; e < EQUATIONS; e++)
      for (uint64_t seed = 0; seed < 10; seed++) {
        bench b;
        open_bench(&b, seed);
        const double cos_theta = uniform(-1.0, 1.0);
        const pendres_operation o = {
          .from = b.vector[0], .slope = b.vector[1], .cos_theta = cos_theta};
        const pendres_strip s = strip_of(&b, equations[e], 0, lanes);
        list[k]->run(equations[e].rows, &s, &o, 1);
        for (size_t i = 0; i < lanes; i++) check_lane(&b, equations[e], lanes, i, cos_theta);
        close_bench(&b);
      }
}

static void test_the_fastest_is_chosen(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list);
  (void)state;
  assert_ptr_equal(pendres_kernels_select(), list[count - 1]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_same_bytes_on_every_instruction_set),
    cmocka_unit_test(test_same_bytes_however_lanes_are_split),
    cmocka_unit_test(test_stage_is_sum_then_slope),
    cmocka_unit_test(test_sums),
    cmocka_unit_test(test_sine),
    cmocka_unit_test(test_sine_next_to_its_zeros),
    cmocka_unit_test(test_sine_of_nothing),
    cmocka_unit_test(test_right_hand_sides),
    cmocka_unit_test(test_the_fastest_is_chosen),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
