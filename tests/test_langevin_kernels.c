/*
 * test_langevin_kernels.c -- sine, random numbers and the lanes of thermal noise.
 */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include <Random123/philox.h>
#include <gsl/gsl_cdf.h>

#include <pendres/formula.h>

#include "model/formula/formula.h"
#include "noise/kernels_langevin.h"
#include "base/sine.h"

#define PI 3.14159265358979323846

/* In standard errors: one honest result in 150 000 is farther off. The seeds are fixed. */
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
  enum { LANES = 24, ROWS = 18 };
  const uint32_t key[2] = {5, 6};
  uint64_t *id = aligned(LANES), *words = aligned(4 * LANES);
  double *rows = aligned(ROWS * LANES);
  for (size_t i = 0; i < LANES; i++) id[i] = i;
  k->words(LANES, id, 1, 2, key, words);
  k->gauss(LANES, words, out);
  for (size_t i = 0; i < ROWS * LANES; i++)
    rows[i] = (double)(words[i % (4 * LANES)] % 1000003) * 1e-5 * (i % 3 == 0 ? -1.0 : 1.0);
  pendres_langevin_rows r = {.u = rows, .w = rows + LANES, .pivot_cos = rows + 2 * LANES,
                                   .pivot_sin = rows + 3 * LANES, .push = rows + 4 * LANES,
                                   .spread = rows + 5 * LANES, .bend = rows + 6 * LANES};
  const double *reach = rows + 7 * LANES, *decay = rows + 8 * LANES;
  r.torque = rows + 11 * LANES;
  r.parametric = rows + 12 * LANES;
  for (size_t j = 0; j < PENDRES_FORCE_POWERS; j++) r.coefficient[j] = rows + (13 + j)
    * LANES;
  pendres_force formula;
  pendres_formula_error error;
  check_ok(pendres_force_define("a1*tanh(x)", &formula, &error));
  r.formula = pendres_formula_of(formula);
  for (int f = 0; f < PENDRES_LANGEVIN_FORCES; f++) {
    k->kick[f](LANES, &r, reach, decay, 0.3, -0.9, out);
    memcpy(out + (size_t)(16 + 2 * f) * LANES, rows, 2 * LANES * sizeof *out);
  }
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
  enum { SIZE = (16 + 2 * PENDRES_LANGEVIN_FORCES) * 24 };
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

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(sine_is_accurate),
    cmocka_unit_test(generator_known_answers),
    cmocka_unit_test(generator_is_random123),
    cmocka_unit_test(variants_give_the_same_bytes),
    cmocka_unit_test(gaussian_numbers_are_gaussian),
    cmocka_unit_test(gaussian_extremes_are_exact),
  };
  return cmocka_run_group_tests_name("langevin_kernels", tests, NULL, NULL);
}
