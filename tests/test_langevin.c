/*
 * test_langevin.c -- thermal noise: generator, integrator, clouds, linear noise theory.
 *
 * Statistical bounds: the seeds are fixed, so each test always gives the same numbers; the
 * bounds are 4.5 standard errors, which one in 150 000 honest results would break, over some
 * two hundred comparisons here.
 */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include <Random123/philox.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_integration.h>

#include <pendres/langevin.h>

#include "kernels_langevin.h"
#include "kernels_sine.h"
#include "langevin_block.h"

#define PI 3.14159265358979323846

static const double sigmas = 4.5;

/* Every variant that this processor runs. */
static size_t variants(const pendres_kernels_langevin *out[3])
{
  size_t n = 0;
  out[n++] = &pendres_kernels_langevin_base;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    out[n++] = &pendres_kernels_langevin_avx2;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    out[n++] = &pendres_kernels_langevin_avx512;
#endif
  return n;
}

/* Zeroed, on the boundary that the kernels want; n a multiple of 8. */
static void *aligned(size_t n)
{
  void *memory = aligned_alloc(64, 8 * n);
  assert_non_null(memory);
  memset(memory, 0, 8 * n);
  return memory;
}

static pendres_langevin *make(uint64_t seed, int steps, int lanes)
{
  const pendres_langevin_options options = {
    .seed = seed, .steps_per_period = steps, .block_lanes = lanes};
  pendres_langevin *lv = NULL;
  check_ok(pendres_langevin_create(&options, &lv));
  return lv;
}

/* The parameters of the paper's Fig. 7. */
static pendres_pendulum figure7(double temperature)
{
  return (pendres_pendulum){.damping = 0.12, .drive_amplitude = 0.2,
                            .drive_frequency = 2.0 * PI / 8.0, .temperature = temperature};
}

/* Strobe point of Fig. 7's SA (large = 0) or LA, by waiting: a period leaves exp(-0.48) of a
 * distance, so the 60 precise ones leave 3e-13 of what the coarse ones are wrong by. */
static void orbit(int large, double *x, double *v)
{
  const pendres_pendulum p = figure7(0.0);
  pendres_langevin *lv = make(0, 40, 8);
  *x = large ? -0.1 * PI : 0.5 * PI;
  *v = 0.0;
  check_ok(pendres_langevin_advance(lv, 1, &p, NULL, 0, 100, x, v, NULL));
  check_ok(pendres_langevin_set_steps(lv, 2000));
  check_ok(pendres_langevin_advance(lv, 1, &p, NULL, 100, 60, x, v, NULL));
  pendres_langevin_free(lv);
}

/* ---- Kernels ----------------------------------------------------------------------------- */

static void sine_is_accurate(void **state)
{
  (void)state;
  double largest = 0.0, largest_cos = 0.0;
  for (int i = 0; i < 400000; i++) {
    /* A golden-ratio sequence over |y| < 1e4, and finer near zero. */
    const double u = fmod(i * 0.61803398874989484820, 1.0) * 2.0 - 1.0;
    const double y = u * (i % 2 == 0 ? 1e4 : 4.0);
    double s, c;
    int exponent;
    pendres_kernels_sincos(y, &s, &c);
    assert_true(s == pendres_kernels_sin(y));
    const long double exact = sinl((long double)y);
    (void)frexp((double)exact, &exponent);
    largest = fmax(largest, (double)fabsl(s - exact) / ldexp(1.0, exponent - 53));
    largest_cos = fmax(largest_cos, (double)fabsl(c - cosl((long double)y)));
  }
  /* What the header promises, measured 1.7 and 2.2e-16. */
  check_near(largest, 0.0, 2.0);
  check_near(largest_cos, 0.0, 3e-16);
}

static void generator_known_answers(void **state)
{
  (void)state;
  /* Philox4x32-10: the known answers that Random123 is published with (kat_vectors). */
  static const struct {
    uint32_t counter[4], key[2], answer[4];
  } known[] = {
    {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
    {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff},
     {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
    {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0},
     {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}}};
  const pendres_kernels_langevin *kernels[3];
  const size_t n = variants(kernels);
  uint64_t *id = aligned(8), *words = aligned(32);

  for (size_t k = 0; k < n; k++)
    for (size_t c = 0; c < 3; c++) {
      for (int i = 0; i < 8; i++)
        id[i] = known[c].counter[0] | (uint64_t)known[c].counter[1] << 32;
      kernels[k]->words(8, id, known[c].counter[2], known[c].counter[3], known[c].key, words);
      for (int i = 0; i < 8; i++)
        for (int w = 0; w < 4; w++)
          assert_int_equal(words[8 * w + i], known[c].answer[w]);
    }
  free(id);
  free(words);
}

static void generator_is_random123(void **state)
{
  (void)state;
  enum { LANES = 24, CALLS = 500 };
  const pendres_kernels_langevin *kernels[3];
  const size_t n = variants(kernels);
  uint64_t *id = aligned(LANES), *words = aligned(4 * LANES);

  for (uint32_t call = 0; call < CALLS; call++) {
    const uint32_t key[2] = {call * 2654435761u, ~call}, period = call * 40503u;
    for (size_t i = 0; i < LANES; i++) id[i] = (call + i) * 0x9e3779b97f4a7c15u;
    for (size_t k = 0; k < n; k++) {
      kernels[k]->words(LANES, id, period, call, key, words);
      for (size_t i = 0; i < LANES; i++) {
        const philox4x32_ctr_t counter = {
          {(uint32_t)id[i], (uint32_t)(id[i] >> 32), period, call}};
        const philox4x32_key_t both = {{key[0], key[1]}};
        const philox4x32_ctr_t answer = philox4x32(counter, both);
        for (size_t w = 0; w < 4; w++) assert_int_equal(words[w * LANES + i], answer.v[w]);
      }
    }
  }
  free(id);
  free(words);
}

/* Inputs of all kernels from the generator, and all outputs one after another. */
static void exercise(const pendres_kernels_langevin *k, double *out)
{
  enum { LANES = 24 };
  const uint32_t key[2] = {5, 6};
  uint64_t *id = aligned(LANES), *words = aligned(4 * LANES);
  double *rows = aligned(12 * LANES);
  for (size_t i = 0; i < LANES; i++) id[i] = i;
  k->words(LANES, id, 1, 2, key, words);
  k->gauss(LANES, words, out);
  for (size_t i = 0; i < 12 * LANES; i++)
    rows[i] = (double)(words[i % (4 * LANES)] % 1000003) * 1e-5 * (i % 3 == 0 ? -1.0 : 1.0);
  const pendres_langevin_rows r = {.u = rows, .w = rows + LANES, .pivot_cos = rows + 2 * LANES,
                                   .pivot_sin = rows + 3 * LANES, .push = rows + 4 * LANES,
                                   .spread = rows + 5 * LANES, .bend = rows + 6 * LANES};
  const double *reach = rows + 7 * LANES, *decay = rows + 8 * LANES;
  k->kick(LANES, &r, reach, decay, 0.3, -0.9, out);
  k->sample(LANES, &r, reach, 0.7, 0.2, rows + 9 * LANES, rows + 10 * LANES);
  k->drift(LANES, reach, decay, rows, rows + LANES);
  memcpy(out + 4 * LANES, rows, 12 * LANES * sizeof *out);
  free(id);
  free(words);
  free(rows);
}

static void variants_give_the_same_bytes(void **state)
{
  (void)state;
  enum { SIZE = 16 * 24 };
  const pendres_kernels_langevin *kernels[3];
  const size_t n = variants(kernels);
  double first[SIZE], other[SIZE];
  exercise(kernels[0], first);
  for (size_t k = 1; k < n; k++) {
    exercise(kernels[k], other);
    assert_memory_equal(first, other, sizeof first);
  }
}

static void gaussian_numbers_are_gaussian(void **state)
{
  (void)state;
  enum { LANES = 192, CALLS = 4000 };
  const pendres_kernels_langevin *k = pendres_kernels_langevin_select();
  const uint32_t key[2] = {11, 12};
  const double n = 4.0 * LANES * CALLS;
  uint64_t *id = aligned(LANES), *words = aligned(4 * LANES);
  double *g = aligned(4 * LANES), m[7] = {0}, cross[3] = {0}, beyond[2] = {0};

  for (size_t i = 0; i < LANES; i++) id[i] = i;
  for (uint32_t call = 0; call < CALLS; call++) {
    k->words(LANES, id, 0, call, key, words);
    k->gauss(LANES, words, g);
    for (size_t i = 0; i < 4 * LANES; i++) {
      double power = 1.0;
      for (int q = 1; q <= 6; q++) m[q] += power *= g[i];
      beyond[0] += fabs(g[i]) > 1.0;
      beyond[1] += fabs(g[i]) > 4.0;
    }
    for (size_t i = 0; i < LANES; i++)
      for (size_t j = 0; j < 3; j++) cross[j] += g[i] * g[(j + 1) * LANES + i];
  }
  /* Moments of order q have variance (2q-1)!! - ((q-1)!!)^2 (the second for even q). */
  check_near(m[1] / n, 0.0, sigmas * sqrt(1.0 / n));
  check_near(m[2] / n, 1.0, sigmas * sqrt(2.0 / n));
  check_near(m[3] / n, 0.0, sigmas * sqrt(15.0 / n));
  check_near(m[4] / n, 3.0, sigmas * sqrt(96.0 / n));
  check_near(m[6] / n, 15.0, sigmas * sqrt((10395.0 - 225.0) / n));
  for (int j = 0; j < 3; j++) check_near(cross[j] / (LANES * CALLS), 0.0,
                                         sigmas / sqrt(LANES * (double)CALLS));
  for (int j = 0; j < 2; j++) {
    const double p = 2.0 * gsl_cdf_ugaussian_Q(j == 0 ? 1.0 : 4.0);
    check_near(beyond[j] / n, p, sigmas * sqrt(p / n));
  }
  free(id);
  free(words);
  free(g);
}

static void gaussian_extremes_are_exact(void **state)
{
  (void)state;
  /* The largest radius, the smallest, and both ends of the angle, against libm. */
  static const uint32_t extreme[4] = {0, 1, 0x80000000u, 0xffffffffu};
  uint64_t *words = aligned(32);
  double *g = aligned(32);
  for (int i = 0; i < 16; i++) {
    const uint32_t a = extreme[i / 4], b = extreme[i % 4];
    for (int j = 0; j < 8; j++) words[j] = a, words[16 + j] = b;
    pendres_kernels_langevin_base.gauss(8, words, g);
    const double radius = sqrt(-2.0 * log((a + 0.5) * 0x1p-32));
    const double angle = ((b | 1u) * 0x1p-32 - 0.5) * PI, turn = b & 1u ? -1.0 : 1.0;
    /* The polynomials' own errors, as stated, times the radius. */
    check_near(g[0], turn * radius * sin(angle), 1e-9);
    check_near(g[16], turn * radius * cos(angle), 3e-9);
  }
  free(words);
  free(g);
}

/* ---- The integrator ---------------------------------------------------------------------- */

/* Classical Runge-Kutta, many steps: an independent answer at temperature zero. */
static void reference(const pendres_pendulum *p, int periods, double *x, double *v)
{
  enum { STEPS = 4096 };
  const double h = 2.0 * PI / p->drive_frequency / STEPS;
  for (int k = 0; k < periods * STEPS; k++) {
    const double t = k % STEPS * h;
    const double a1 = pendres_pendulum_acceleration(p, *x, *v, t);
    const double v2 = *v + 0.5 * h * a1;
    const double a2 = pendres_pendulum_acceleration(p, *x + 0.5 * h * *v, v2, t + 0.5 * h);
    const double v3 = *v + 0.5 * h * a2;
    const double a3 = pendres_pendulum_acceleration(p, *x + 0.5 * h * v2, v3, t + 0.5 * h);
    const double v4 = *v + h * a3;
    const double a4 = pendres_pendulum_acceleration(p, *x + h * v3, v4, t + h);
    *x += h / 6.0 * (*v + 2.0 * (v2 + v3) + v4);
    *v += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
  }
}

static void no_temperature_is_deterministic(void **state)
{
  (void)state;
  /* Soft and hard, friction strong, weak and none, slow and fast drive. */
  static const pendres_pendulum cases[] = {
    {0.12, 0.2, 0.785, 0.0}, {0.0, 0.3, 0.6, 0.0}, {5.0, 1.0, 1.3, 0.0}, {0.3, 0.0, 1.0, 0.0}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    double x0 = 0.4, v0 = 1.2, error[3];
    reference(&cases[c], 3, &x0, &v0);
    for (int j = 0; j < 3; j++) {
      double x = 0.4, v = 1.2;
      pendres_langevin *lv = make(1, j == 2 ? 3000 : 64 << j, 8);
      check_ok(pendres_langevin_advance(lv, 1, &cases[c], NULL, 0, 3, &x, &v, NULL));
      error[j] = hypot(x - x0, v - v0);
      pendres_langevin_free(lv);
    }
    /* Order four: 64 to 128 steps gain 16, less what the next order still adds (h < 0.1). */
    check_near(log2(error[0] / error[1]), 4.0, 0.25);
    /* Order four from 128 to 3000 steps, times 2 for the same reason; 1e-11 is what the
     * reference itself is good for (h = 0.0025, h^4 / 120 a unit of time, amplified). */
    check_near(error[2], 0.0, 2.0 * error[1] * pow(128.0 / 3000.0, 4.0) + 1e-11);
  }
}

/*
 * Expected values without sampling: each kick's Gaussian number takes the points of
 * Gauss-Hermite quadrature, one lane for each combination of all kicks of a period.
 */
static double points[16], weights[16];
static int point_count;
static uint32_t this_call;

static void count_call(size_t stride, const uint64_t *id, uint32_t period, uint32_t call,
                       const uint32_t key[2], uint64_t *words)
{
  (void)stride, (void)id, (void)period, (void)key, (void)words;
  this_call = call;
}

static void quadrature_points(size_t stride, const uint64_t *words, double *gauss)
{
  (void)words;
  for (size_t row = 0; row < 4; row++)
    for (size_t i = 0; i < stride; i++) {
      size_t digit = i;
      for (size_t k = 0; k < 4 * this_call + row; k++) digit /= (size_t)point_count;
      gauss[row * stride + i] = points[digit % (size_t)point_count];
    }
}

/* Ends of one period in n steps from one point, with `count` points a kick, and their weights. */
typedef struct ends {
  pendres_langevin_block block;
  double *weight;
} ends;

static void reach_ends(const pendres_pendulum *p, int n, int count, ends *e)
{
  pendres_kernels_langevin kernels = *pendres_kernels_langevin_select();
  gsl_integration_fixed_workspace *rule =
    gsl_integration_fixed_alloc(gsl_integration_fixed_hermite, (size_t)count, 0.0, 0.5, 0.0, 0.0);
  pendres_langevin_block *b = &e->block;
  size_t lanes = 1;

  assert_non_null(rule);
  point_count = count;
  memcpy(points, gsl_integration_fixed_nodes(rule), (size_t)count * sizeof *points);
  memcpy(weights, gsl_integration_fixed_weights(rule), (size_t)count * sizeof *weights);
  gsl_integration_fixed_free(rule);
  for (int k = 0; k < 2 * n; k++) lanes *= (size_t)count;
  *e = (ends){.weight = malloc(lanes * sizeof *e->weight)};
  assert_non_null(e->weight);
  check_ok(pendres_langevin_block_make(b, (lanes + 7) / 8 * 8, 0));
  kernels.words = count_call;
  kernels.gauss = quadrature_points;
  b->kernels = &kernels;
  check_ok(pendres_langevin_block_set_steps(b, n));
  pendres_langevin_block_resize(b, lanes);
  for (size_t i = 0; i < lanes; i++) {
    size_t digits = i;
    pendres_langevin_block_load(b, i, p, i, 0.9, 0.7);
    e->weight[i] = 1.0;
    for (int k = 0; k < 2 * n; k++) {
      e->weight[i] *= weights[digits % (size_t)count] / sqrt(2.0 * PI);
      digits /= (size_t)count;
    }
  }
  pendres_langevin_block_finish(b);
  pendres_langevin_block_period(b, 0);
  b->kernels = NULL;
}

static void clear_ends(ends *e)
{
  pendres_langevin_block_clear(&e->block);
  free(e->weight);
}

/* E of v^2, sin x and x v. */
static void expect(const pendres_pendulum *p, int n, int count, double out[3])
{
  ends e;
  reach_ends(p, n, count, &e);
  out[0] = out[1] = out[2] = 0.0;
  for (size_t i = 0; i < e.block.count; i++) {
    const double x = e.block.x[i], v = e.block.v[i];
    out[0] += e.weight[i] * v * v;
    out[1] += e.weight[i] * sin(x);
    out[2] += e.weight[i] * x * v;
  }
  clear_ends(&e);
}

static void weak_order_is_four(void **state)
{
  (void)state;
  /* Duration 0.4 in 1, 2, 4 steps, no drive, strong noise. Gauss-Hermite with 4 points a kick
   * is exact to degree 7: it is wrong by the eighth derivative times (gamma T h)^4/1680, less
   * than 1e-7 relative to what one kick adds. */
  const pendres_pendulum p = {.damping = 0.5, .drive_amplitude = 0.0,
                              .drive_frequency = 2.0 * PI / 0.4, .temperature = 1.0};
  double one[3], two[3], four[3];
  expect(&p, 1, 16, one);
  expect(&p, 2, 16, two);
  expect(&p, 4, 4, four);
  for (int i = 0; i < 3; i++) {
    /* The next orders still add some h^2 = 0.04 of the difference. */
    const double order = log2(fabs(one[i] - two[i]) / fabs(two[i] - four[i]));
    print_message("weak order: %.2f (bias of one step %.1e)\n", order, one[i] - four[i]);
    check_near(order, 4.0, 0.15);
  }
}

/* The same with drive, for which a period is a period: covariance to first order in T. */
static void weak_order_is_four_driven(void **state)
{
  (void)state;
  /* With two points a kick, +-1, only the fourth cumulant is wrong: T relative. */
  const pendres_pendulum p = {.damping = 1.0, .drive_amplitude = 1.5,
                              .drive_frequency = 2.0 * PI / 1.6, .temperature = 1e-8};
  pendres_langevin_linear lin;
  double error[2][3];
  check_ok(pendres_langevin_linear_theory(&p, 0.9, 0.7, 1, &lin));
  for (int j = 0; j < 2; j++) {
    ends e;
    double x = 0.0, v = 0.0;
    reach_ends(&p, 4 << j, 2, &e);
    for (size_t i = 0; i < e.block.count; i++) {
      x += e.weight[i] * e.block.x[i];
      v += e.weight[i] * e.block.v[i];
    }
    error[j][0] = -lin.injected.xx, error[j][1] = -lin.injected.xv, error[j][2] = -lin.injected.vv;
    for (size_t i = 0; i < e.block.count; i++) {
      const double dx = e.block.x[i] - x, dv = e.block.v[i] - v;
      error[j][0] += e.weight[i] * dx * dx;
      error[j][1] += e.weight[i] * dx * dv;
      error[j][2] += e.weight[i] * dv * dv;
    }
    clear_ends(&e);
  }
  for (int i = 0; i < 3; i++) {
    const double order = log2(fabs(error[0][i]) / fabs(error[1][i]));
    print_message("weak order, driven: %.2f (relative bias of 8 steps %.1e)\n", order,
                  error[1][i] / p.temperature);
    /* From 4 to 8 steps; the next orders add some (h = 0.4)^2 of the difference. */
    check_near(order, 4.0, 0.2);
  }
}

/* Two periods of free flight with strong noise: the well counts for nothing. */
static void free_diffusion_is_ornstein_uhlenbeck(void **state)
{
  (void)state;
  enum { N = 4096 };
  const double g = 0.7, T = 1e6, t = 2.0 * PI;
  const pendres_langevin_request q = {.pendulum = {g, 0.3, 1.0, T}, .trajectories = N,
                                      .settle = 0, .record = 1};
  pendres_langevin *lv = make(3, 24, 192);
  pendres_langevin_cloud c;
  check_ok(pendres_langevin_measure(lv, &q, &c, NULL, NULL));
  /* Uhlenbeck and Ornstein, Phys. Rev. 36 (1930) 823. The force of the well and the steps,
   * (gamma h)^4/2880, change these by less than 1e-5 relative. */
  const double e = exp(-g * t), one = -expm1(-g * t);
  const double vv = T * -expm1(-2.0 * g * t), xv = T / g * one * one;
  const double xx = T / (g * g) * (2.0 * g * t - 3.0 + 4.0 * e - e * e);
  const double want[3] = {xx, xv, vv};
  for (int i = 0; i < 3; i++) {
    const pendres_langevin_estimate s = c.statistics[PENDRES_LANGEVIN_COV_XX + i];
    check_near(s.value, want[i], sigmas * s.error);
    /* Errors of Gaussian variances: sqrt(2/N); of the covariance as its correlation r says:
     * sqrt((1 + r^2)/N) of the widths' product. A tenth for their own scatter. */
    const double r = xv / sqrt(xx * vv);
    const double error = i == 1 ? sqrt(xx * vv * (1.0 + r * r) / N) : want[i] * sqrt(2.0 / N);
    check_relative(s.error, error, 0.1);
  }
  pendres_langevin_free(lv);
}

/* Around a well's bottom all is linear: Sigma(t) = T (1 - M M^T), undriven, from a point. */
static void small_oscillations_are_linear(void **state)
{
  (void)state;
  static const double damping[3] = {0.05, 0.5, 5.0};
  for (int i = 0; i < 3; i++) {
    const double T = 1e-10;
    const pendres_langevin_request q = {.pendulum = {damping[i], 0.0, 1.3, T}, .x = PI / 2.0,
                                        .trajectories = 4096, .settle = 1, .record = 1};
    pendres_langevin_linear lin;
    pendres_langevin_cloud c;
    pendres_langevin *lv = make(4, damping[i] > 1.0 ? 64 : 24, 192);
    check_ok(pendres_langevin_linear_theory(&q.pendulum, q.x, 0.0, 1, &lin));
    /* Equilibrium: equipartition, whatever the damping. */
    check_near(lin.covariance.xx, T, 1e-9 * T);
    check_near(lin.covariance.xv, 0.0, 1e-9 * T);
    check_near(lin.covariance.vv, T, 1e-9 * T);
    assert_true(lin.error < 1e-9 * T);

    /* Two periods: M^2. */
    const double *m = lin.monodromy;
    const double s[4] = {m[0] * m[0] + m[1] * m[2], m[0] * m[1] + m[1] * m[3],
                         m[2] * m[0] + m[3] * m[2], m[2] * m[1] + m[3] * m[3]};
    const double want[3] = {T * (1.0 - s[0] * s[0] - s[1] * s[1]),
                            T * (-s[0] * s[2] - s[1] * s[3]),
                            T * (1.0 - s[2] * s[2] - s[3] * s[3])};
    check_ok(pendres_langevin_measure(lv, &q, &c, NULL, NULL));
    for (int k = 0; k < 3; k++) {
      const pendres_langevin_estimate e = c.statistics[PENDRES_LANGEVIN_COV_XX + k];
      check_near(e.value, want[k], sigmas * e.error);
    }
    pendres_langevin_free(lv);
  }
}

/* ---- Equilibrium ------------------------------------------------------------------------- */

/* Angles that cut Boltzmann's exp(cos y / T) in equal parts; returns its mean of cos y. */
static double boltzmann(double T, size_t parts, double *cuts)
{
  enum { POINTS = 20000 };
  const double width = 2.0 * PI / POINTS;
  double total = 0.0, mean = 0.0, sum = 0.0;
  size_t next = 1;
  for (int i = 0; i < POINTS; i++) {
    const double y = -PI + width * (i + 0.5), weight = exp((cos(y) - 1.0) / T);
    total += weight;
    mean += weight * cos(y);
  }
  for (int i = 0; i < POINTS && next < parts; i++) {
    const double weight = exp((cos(-PI + width * (i + 0.5)) - 1.0) / T);
    const double over = sum + weight - total * (double)next / (double)parts;
    sum += weight;
    if (over < 0.0) continue;
    cuts[next] = -PI + width * (i + 1 - over / weight);
    next++;
  }
  return mean / total;
}

static void check_equilibrium(double damping, double T)
{
  enum { N = 1536, RECORD = 30, BINS = 16 };
  /* Steps such that the bias (order four, largest for strong friction: 2e-4 of <v^2> at
   * damping 5, h = 0.1) is well below the statistical error of some 1e-3 or more. */
  const pendres_langevin_request q = {.pendulum = {damping, 0.0, 1.0, T}, .x = PI / 2.0,
                                      .trajectories = N, .record = RECORD,
                                      /* 19 or more times the slowest relaxation: energy at
                                       * weak friction, 1/gamma; position at strong, gamma. */
                                      .settle = damping < 0.1 ? 60 : 15};
  double cuts[BINS] = {0}, counts[BINS] = {0}, mean = 0.0, square = 0.0, chi2 = 0.0;
  double *x = malloc(N * RECORD * sizeof *x), *v = malloc(N * RECORD * sizeof *v);
  pendres_langevin *lv = make(5, damping > 1.0 ? 64 : 14, 192);
  pendres_langevin_cloud c;

  assert_true(x != NULL && v != NULL);
  const double want = boltzmann(T, BINS, cuts);
  check_ok(pendres_langevin_measure(lv, &q, &c, x, v));
  const pendres_langevin_estimate vv = c.statistics[PENDRES_LANGEVIN_COV_VV];
  check_near(vv.value, T, sigmas * vv.error);
  /* An error that is itself sensible: between all strobes independent and all equal. */
  assert_true(vv.error > 0.9 * T * sqrt(2.0 / (N * RECORD)) && vv.error < T * sqrt(2.0 / N));

  for (size_t i = 0; i < N; i++) {
    double own = 0.0;
    for (size_t k = 0; k < RECORD; k++) own += sin(x[i * RECORD + k]) / RECORD;
    mean += own / N;
    square += own * own / N;
    /* One strobe of each trajectory: independent, so Pearson's test holds. */
    const double y = remainder(x[i * RECORD + RECORD - 1] - PI / 2.0, 2.0 * PI);
    size_t bin = 0;
    while (bin + 1 < BINS && y > cuts[bin + 1]) bin++;
    counts[bin] += 1.0;
  }
  check_near(mean, want, sigmas * sqrt((square - mean * mean) / (N - 1)));
  for (size_t b = 0; b < BINS; b++) {
    const double expected = (double)N / BINS;
    chi2 += (counts[b] - expected) * (counts[b] - expected) / expected;
  }
  /* The same chance to fail as 4.5 standard errors. */
  check_near(chi2, 0.0, gsl_cdf_chisq_Qinv(2.0 * gsl_cdf_ugaussian_Q(sigmas), BINS - 1));
  free(x);
  free(v);
  pendres_langevin_free(lv);
}

static void equilibrium_is_boltzmann(void **state)
{
  (void)state;
  static const double damping[3] = {0.05, 0.5, 5.0}, temperature[3] = {0.05, 0.2, 1.0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) check_equilibrium(damping[i], temperature[j]);
}

/* ---- Clouds ------------------------------------------------------------------------------ */

static void clouds_of_figure7_are_linear(void **state)
{
  (void)state;
  for (int large = 0; large < 2; large++) {
    pendres_langevin_request q = {.pendulum = figure7(1e-4), .trajectories = 768, .settle = 60,
                                  .record = 300};
    pendres_langevin_linear lin;
    pendres_langevin_cloud c;
    pendres_langevin_bias bias;
    pendres_langevin *lv = make(7, 0, 0);

    orbit(large, &q.x, &q.v);
    check_ok(pendres_langevin_linear_theory(&q.pendulum, q.x, q.v, 1, &lin));
    check_near(lin.closure, 0.0, 1e-9);
    /* The determinant of the monodromy matrix is exp(-gamma tau), by Liouville. */
    check_relative(lin.monodromy[0] * lin.monodromy[3] - lin.monodromy[1] * lin.monodromy[2],
                   exp(-0.12 * 8.0), 1e-9);

    pendres_langevin_request few = q;
    few.trajectories = 192;
    few.record = 60;
    check_ok(pendres_langevin_choose_steps(lv, &few, PENDRES_LANGEVIN_CLOUD, 0.01, &bias));
    check_ok(pendres_langevin_measure(lv, &q, &c, NULL, NULL));
    assert_int_equal(c.left, 0);
    const double want[3] = {lin.covariance.xx, lin.covariance.xv, lin.covariance.vv};
    for (int k = 0; k < 3; k++) {
      const int s = PENDRES_LANGEVIN_COV_XX + k;
      const double error = hypot(c.statistics[s].error, bias.statistics[s].error);
      print_message("%s %d: %.4e, linear %.4e, %.1f standard errors, bias %.1e\n",
                    large ? "LA" : "SA", k, c.statistics[s].value, want[k],
                    (c.statistics[s].value - want[k]) / error, bias.statistics[s].value);
      check_near(c.statistics[s].value - bias.statistics[s].value, want[k], sigmas * error);
      /* And the comparison means something: errors of a per cent of the scale at most. */
      assert_true(error < 0.01 * bias.scale[s]);
    }
    pendres_langevin_free(lv);
  }
}

static void chosen_steps_keep_their_bias(void **state)
{
  (void)state;
  for (int large = 0; large < 2; large++) {
    pendres_langevin_request q = {.pendulum = figure7(1e-5), .trajectories = 192, .settle = 40,
                                  .record = 20};
    pendres_langevin_bias bias;
    pendres_langevin *lv = make(8, 0, 0);
    double x, v;

    orbit(large, &q.x, &q.v);
    check_ok(pendres_langevin_choose_steps(lv, &q, PENDRES_LANGEVIN_CLOUD, 0.02, &bias));
    assert_int_equal(pendres_langevin_steps(lv), bias.steps_per_period);
    for (int s = 0; s <= PENDRES_LANGEVIN_COV_VV; s++)
      assert_true(fabs(bias.statistics[s].value) + 2.0 * bias.statistics[s].error <=
                  0.02 * bias.scale[s]);

    /* So little noise moves the mean with its orbit: the bias is the orbit's own. The next
     * order of the steps and of the noise may change it by a quarter. */
    pendres_pendulum still = figure7(0.0);
    x = q.x;
    v = q.v;
    check_ok(pendres_langevin_advance(lv, 1, &still, NULL, 0, 200, &x, &v, NULL));
    const pendres_langevin_estimate *e = bias.statistics;
    check_near(e[PENDRES_LANGEVIN_MEAN_X].value, x - q.x,
               sigmas * e[PENDRES_LANGEVIN_MEAN_X].error + 0.25 * fabs(x - q.x));
    check_near(e[PENDRES_LANGEVIN_MEAN_V].value, v - q.v,
               sigmas * e[PENDRES_LANGEVIN_MEAN_V].error + 0.25 * fabs(v - q.v));
    pendres_langevin_free(lv);
  }
}

static pendres_langevin_answer keep_strobe(void *arg, const pendres_langevin_strobe *strobe)
{
  double *out = arg;
  out[0] = strobe->cosine[0];
  out[1] = strobe->sine[0];
  out[2] = strobe->work[0];
  return PENDRES_LANGEVIN_GO_ON;
}

static void harmonics_and_work(void **state)
{
  (void)state;
  for (int large = 0; large < 2; large++) {
    const pendres_pendulum p = figure7(0.0);
    double x, v, fine[3], coarse[3], dissipated = 0.0;
    orbit(large, &x, &v);
    for (int j = 0; j < 2; j++) {
      double y[2] = {x, v};
      const pendres_langevin_observer observer = {keep_strobe, j == 0 ? fine : coarse, 1};
      pendres_langevin *lv = make(0, j == 0 ? 2000 : 40, 8);
      check_ok(pendres_langevin_advance(lv, 1, &p, NULL, 0, j == 0 ? 1 : 200, y, y + 1,
                                        &observer));
      pendres_langevin_free(lv);
    }
    /* On a closed orbit the work is what friction takes. */
    enum { SPLIT = 4096 };
    const double h = 8.0 / SPLIT;
    double s[2] = {x, v};
    for (int k = 0; k < SPLIT; k++) {
      dissipated += 0.12 * s[1] * s[1] * h;
      const double t = k * h;
      /* The midpoint method: its error is about h^2 = 4e-6. */
      const double a = pendres_pendulum_acceleration(&p, s[0], s[1], t);
      const double mx = s[0] + 0.5 * h * s[1], mv = s[1] + 0.5 * h * a;
      s[0] += h * mv;
      s[1] += h * pendres_pendulum_acceleration(&p, mx, mv, t + 0.5 * h);
    }
    check_relative(fine[2], dissipated, 1e-5);
    check_near(fine[2], PI * 0.2 * fine[1], 1e-9);
    /* Forty steps: order four, (h = 0.2)^4/120 of the amplitude, times ten for the orbit. */
    for (int i = 0; i < 3; i++) check_near(coarse[i], fine[i], 1.5e-4 * hypot(fine[0], fine[1]));
  }
  /* A ramp y = k theta has sine -2 k, though it does not close. At this speed the well bends
   * it by ripples of 1/v^2 = 1e-4. */
  const pendres_pendulum free_flight = {0.0, 0.0, 1.0, 0.0};
  double x = PI / 2.0, v = 100.0, out[3];
  const pendres_langevin_observer observer = {keep_strobe, out, 1};
  pendres_langevin *lv = make(0, 230, 8);
  check_ok(pendres_langevin_advance(lv, 1, &free_flight, NULL, 0, 1, &x, &v, &observer));
  check_near(out[1], -(x - PI / 2.0) / PI, 1e-3);
  pendres_langevin_free(lv);
}

static void leave_at_ten(void *arg, const pendres_langevin_strobe *strobe, unsigned char *left)
{
  (void)arg;
  for (size_t i = 0; i < strobe->count; i++)
    if (strobe->period >= 10 && (strobe->first + i) % 3 == 0) left[i] = 1;
}

static void those_who_left_do_not_count(void **state)
{
  (void)state;
  enum { N = 300, RECORD = 8 };
  pendres_langevin_request q = {.pendulum = figure7(1e-4), .x = PI / 2.0, .trajectories = N,
                                .settle = 5, .record = RECORD, .leave = leave_at_ten};
  double x[N * RECORD], v[N * RECORD];
  pendres_langevin *lv = make(9, 16, 64);
  pendres_langevin_cloud c;
  check_ok(pendres_langevin_measure(lv, &q, &c, x, v));
  /* A hundred left at the end of period 10, when four of their strobes had counted. */
  assert_int_equal(c.left, 100);
  check_near(c.exposure, 100 * 10.0 + 200 * 13.0, 0.0);
  check_near(c.strobes, 100 * 4.0 + 200 * 8.0, 0.0);
  assert_true(isnan(x[4]) && isnan(v[4]) && isfinite(x[3]) && isfinite(x[RECORD + 7]));
  q.settle = 20;
  q.trajectories = 2;
  q.leave = leave_at_ten;
  assert_int_equal(pendres_langevin_measure(lv, &q, &c, NULL, NULL), PENDRES_NOT_FOUND);
  pendres_langevin_free(lv);
}

/* ---- Linear theory and rates ------------------------------------------------------------- */

static void lyapunov_equation(void **state)
{
  (void)state;
  const double m[4] = {0.3, -0.8, 0.5, 0.2};
  const pendres_langevin_covariance q = {1.0, 0.2, 3.0};
  pendres_langevin_covariance s;
  check_ok(pendres_langevin_lyapunov(m, &q, &s));
  /* It solves the equation: rounding of a handful of terms of order 10. */
  const double a = m[0] * s.xx + m[1] * s.xv, b = m[0] * s.xv + m[1] * s.vv;
  const double c = m[2] * s.xx + m[3] * s.xv, d = m[2] * s.xv + m[3] * s.vv;
  check_near(a * m[0] + b * m[1] + q.xx, s.xx, 1e-14);
  check_near(a * m[2] + b * m[3] + q.xv, s.xv, 1e-14);
  check_near(c * m[2] + d * m[3] + q.vv, s.vv, 1e-14);
  /* Eigenvalues outside the unit circle: real, minus one beyond, and a complex pair. */
  const double out[3][4] = {{1.1, 0.0, 0.3, 0.2}, {-1.01, 0.4, 0.0, 0.5}, {0.9, -0.6, 0.6, 0.9}};
  for (int i = 0; i < 3; i++)
    assert_int_equal(pendres_langevin_lyapunov(out[i], &q, &s), PENDRES_NOT_FOUND);
}

static void linear_theory_refuses(void **state)
{
  (void)state;
  pendres_langevin_linear out;
  pendres_pendulum p = {0.1, 0.0, 1.0, 1e-4};
  /* The barrier top repels. */
  assert_int_equal(pendres_langevin_linear_theory(&p, -PI / 2.0, 0.0, 1, &out),
                   PENDRES_NOT_FOUND);
  assert_int_equal(pendres_langevin_linear_theory(&p, PI / 2.0, 0.0, 0, &out),
                   PENDRES_INVALID_ARGUMENT);
  p.temperature = -1e-4;
  assert_int_equal(pendres_langevin_linear_theory(&p, PI / 2.0, 0.0, 1, &out),
                   PENDRES_INVALID_ARGUMENT);
}

static void rates_have_exact_intervals(void **state)
{
  (void)state;
  double rate, lower, upper;
  /* Garwood's intervals as tabulated (95 %), to the digits of the tables. */
  check_ok(pendres_langevin_rate(0.0, 2.0, 0.95, &rate, &lower, &upper));
  check_near(rate, 0.0, 0.0);
  check_near(lower, 0.0, 0.0);
  check_near(upper, 3.6889 / 2.0, 3e-5);
  check_ok(pendres_langevin_rate(10.0, 1.0, 0.95, &rate, &lower, &upper));
  check_near(lower, 4.7954, 5e-5);
  check_near(upper, 18.3904, 5e-5);
  assert_int_equal(pendres_langevin_rate(-1.0, 1.0, 0.95, &rate, &lower, &upper),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_langevin_rate(1.0, 0.0, 0.95, &rate, &lower, &upper),
                   PENDRES_INVALID_ARGUMENT);
}

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
  pendres_langevin_set_interrupt(lv, NULL, NULL);
  const pendres_langevin_observer observer = {stop_at_two, &seen, 0};
  assert_int_equal(pendres_langevin_advance(lv, 1, &p, NULL, 0, 5, &x, &v, &observer),
                   PENDRES_INTERRUPTED);
  assert_int_equal(seen, 2);
  check_near(x, 1.0, 0.0);
  pendres_langevin_free(lv);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(sine_is_accurate),
    cmocka_unit_test(generator_known_answers),
    cmocka_unit_test(generator_is_random123),
    cmocka_unit_test(variants_give_the_same_bytes),
    cmocka_unit_test(gaussian_numbers_are_gaussian),
    cmocka_unit_test(gaussian_extremes_are_exact),
    cmocka_unit_test(no_temperature_is_deterministic),
    cmocka_unit_test(weak_order_is_four),
    cmocka_unit_test(weak_order_is_four_driven),
    cmocka_unit_test(free_diffusion_is_ornstein_uhlenbeck),
    cmocka_unit_test(small_oscillations_are_linear),
    cmocka_unit_test(equilibrium_is_boltzmann),
    cmocka_unit_test(clouds_of_figure7_are_linear),
    cmocka_unit_test(chosen_steps_keep_their_bias),
    cmocka_unit_test(harmonics_and_work),
    cmocka_unit_test(those_who_left_do_not_count),
    cmocka_unit_test(lyapunov_equation),
    cmocka_unit_test(linear_theory_refuses),
    cmocka_unit_test(rates_have_exact_intervals),
    cmocka_unit_test(same_bytes_whatever_the_run),
    cmocka_unit_test(clouds_do_not_depend_on_blocks),
    cmocka_unit_test(wrong_arguments_are_refused),
    cmocka_unit_test(observers_see_what_happens),
    cmocka_unit_test(interruptions),
  };
  return cmocka_run_group_tests_name("langevin", tests, NULL, NULL);
}
