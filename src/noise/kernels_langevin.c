/*
 * kernels_langevin.c -- the inner loops of thermal noise; see kernels_langevin.h.
 *
 * This file is compiled once for each instruction set, with PENDRES_KERNELS set to its name. The
 * compiler vectorises the plain loops; only the 32 by 32 bit product of the generator is written in
 * the instruction sets' own terms, since compilers take the slow 64-bit product for it.
 */
#include "noise/kernels_langevin.h"

#include <string.h>

#include <Random123/philox.h>

#include "base/instructions.h"
#include "engine/kernels/kernels_force.h"

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#define FMA(a, b, c) __builtin_fma((a), (b), (c))

/* A vector holds one word for each lane in its low 32 bits; the upper ones are not read. */
#if defined(__AVX512F__)
typedef uint64_t word __attribute__((vector_size(64), may_alias));
#define PRODUCT(a, m) ((word)_mm512_mul_epu32((__m512i)(a), _mm512_set1_epi64((long long)(m))))
#elif defined(__AVX2__)
typedef uint64_t word __attribute__((vector_size(32), may_alias));
#define PRODUCT(a, m) ((word)_mm256_mul_epu32((__m256i)(a), _mm256_set1_epi64x((long long)(m))))
#else
typedef uint64_t word;
#define PRODUCT(a, m) (((a) & 0xffffffffu) * (uint64_t)(m))
#endif
enum { WORD_LANES = sizeof(word) / sizeof(uint64_t), ROUNDS = philox4x32_rounds };

/*
 * Philox4x32-10: Salmon, Moraes, Dror, Shaw, Parallel random numbers: as easy as 1, 2, 3
 * (SC11). Random123's own function works on one counter at a time and is not vectorised by the
 * compiler. This one does the same in lanes, with its constants, and tests compare the two.
 */
static void words(size_t stride, const uint64_t *id, uint32_t period, uint32_t call,
                  const uint32_t key[2], uint64_t *out)
{
  uint64_t key0[ROUNDS], key1[ROUNDS];
  for (uint32_t r = 0; r < ROUNDS; r++) {
    key0[r] = (uint32_t)(key[0] + r * PHILOX_W32_0);
    key1[r] = (uint32_t)(key[1] + r * PHILOX_W32_1);
  }
  for (size_t i = 0; i < stride; i += WORD_LANES) {
    const word lane = *(const word *)(id + i);
    word x0 = lane, x1 = lane >> 32, x2 = lane - lane + period, x3 = lane - lane + call;
#pragma GCC unroll 10
    for (int r = 0; r < ROUNDS; r++) {
      const word a = PRODUCT(x0, PHILOX_M4x32_0), b = PRODUCT(x2, PHILOX_M4x32_1);
      x0 = (b >> 32) ^ x1 ^ key0[r];
      x2 = (a >> 32) ^ x3 ^ key1[r];
      x1 = b;
      x3 = a;
    }
    *(word *)(out + i) = x0 & 0xffffffffu;
    *(word *)(out + stride + i) = x1 & 0xffffffffu;
    *(word *)(out + 2 * stride + i) = x2 & 0xffffffffu;
    *(word *)(out + 3 * stride + i) = x3 & 0xffffffffu;
  }
}

static inline double from_bits(uint64_t bits)
{
  double d;
  memcpy(&d, &bits, sizeof d);
  return d;
}

static inline uint64_t to_bits(double d)
{
  uint64_t bits;
  memcpy(&bits, &d, sizeof bits);
  return bits;
}

/* -2 ln u for 2^-33 <= u < 1, with an error below 4e-10: a minimax polynomial on
 * [sqrt(1/2), sqrt 2]. */
static inline double minus_two_log(double u)
{
  const uint64_t one = 0x3ff0000000000000u, root = 0x3fe6a09e667f3bcdu;
  const uint64_t shifted = to_bits(u) + (one - root);
  const double exponent = from_bits((shifted >> 52) | 0x4330000000000000u) - (0x1p52 + 1023.0);
  const double f = from_bits(to_bits(u) + one - (shifted & 0xfff0000000000000u)) - 1.0;
  double p = 0x1.12ed2b36677e7p-4;
  p = FMA(p, f, -0x1.e2b917d7b4d72p-4);
  p = FMA(p, f, 0x1.ea627deec569ap-4);
  p = FMA(p, f, -0x1.fba1a6701f2f7p-4);
  p = FMA(p, f, 0x1.22e901776b88ap-3);
  p = FMA(p, f, -0x1.555c28ceb8d4ap-3);
  p = FMA(p, f, 0x1.99a94be10fdacp-3);
  p = FMA(p, f, -0x1.00001a5383d80p-2);
  p = FMA(p, f, 0x1.55553cb6ba1f1p-2);
  p = FMA(p, f, -0x1.ffffffa89548ap-2);
  const double log = FMA(exponent, 0x1.62e42fefa39efp-1, FMA(f * f, p, f));
  return -2.0 * log;
}

/*
 * Two Gaussian numbers from two words, by the method of Box and Muller (Ann. Math. Stat. 29 (1958)
 * 610). The radius takes 32 bits. The angle takes 31 bits, spread over half a circle, and its last
 * bit turns it by half a circle. The results are within 1e-9 of what is exact for the words given;
 * the largest radius is 6.76.
 */
static inline void box_muller(uint64_t radius_word, uint64_t angle_word, double *a, double *b)
{
  const double u = from_bits(0x3ff0000000080000u | (radius_word << 20)) - 1.0;
  const double t = from_bits(0x3ff0000000100000u | (angle_word << 20)) - 1.5;
  const double s = t * t;
  /* This changes the sign alone, and so cannot round. */
  const double radius = from_bits(to_bits(__builtin_sqrt(minus_two_log(u))) ^ (angle_word << 63));
  double p = -0x1.cacb5e8365512p-8, q = -0x1.8fb73efcc3b96p-6;
  p = FMA(p, s, 0x1.5000176682e82p-4);
  q = FMA(q, s, 0x1.e126f16565f9bp-3);
  p = FMA(p, s, -0x1.32d08f4518cccp-1);
  q = FMA(q, s, -0x1.55d07514cc3b7p+0);
  p = FMA(p, s, 0x1.466bbc0cfc02fp+1);
  q = FMA(q, s, 0x1.03c1e41536d58p+2);
  p = FMA(p, s, -0x1.4abbce38de050p+2);
  q = FMA(q, s, -0x1.3bd3cc57e8347p+2);
  p = FMA(p, s, 0x1.921fb543864cbp+1);
  q = FMA(q, s, 0x1.fffffffe1da75p-1);
  *a = radius * (t * p);
  *b = radius * q;
}

static void gauss(size_t stride, const uint64_t *restrict w, double *restrict g)
{
#pragma omp simd
  for (size_t i = 0; i < 2 * stride; i++) {
    /* Rows 0 and 1 make rows 0 and 1, rows 2 and 3 make rows 2 and 3. */
    double a, b;
    box_muller(w[i], w[2 * stride + i], &a, &b);
    g[i] = a;
    g[2 * stride + i] = b;
  }
}

static void drift(size_t stride, const double *restrict reach, const double *restrict decay,
                  double *restrict u, double *restrict w)
{
#pragma omp simd
  for (size_t i = 0; i < stride; i++) {
    u[i] = FMA(reach[i], w[i], u[i]);
    w[i] *= decay[i];
  }
}

/* f(y) (1 + b cos theta) - I, and its derivative, for lane i. A plain pendulum has f = sin y
   alone. */
static inline __attribute__((always_inline)) void
force(pendres_model_terms terms, const pendres_langevin_rows *rows, size_t i, double y,
      double cosine, double *pull, double *stiffness)
{
  pendres_kernels_force(terms, rows->coefficient, i, y, pull, stiffness);
  if (terms != PENDRES_MODEL_PLAIN) {
    const double drive = FMA(rows->parametric[i], cosine, 1.0);
    *stiffness *= drive;
    *pull = FMA(*pull, drive, -rows->torque[i]);
  }
}

/* Force and noise take the same correction: langevin_block.c says why. */
static inline __attribute__((always_inline)) void
kick_by(pendres_model_terms terms, size_t stride, const pendres_langevin_rows *rows,
        const double *restrict reach, const double *restrict decay, double cosine, double sine,
        const double *restrict noise)
{
  double *restrict u = rows->u, *restrict w = rows->w;
  const double *restrict pivot_cos = rows->pivot_cos, *restrict pivot_sin = rows->pivot_sin;
  const double *restrict push = rows->push, *restrict spread = rows->spread,
               *restrict bend = rows->bend;
  const pendres_langevin_rows own = *rows;

#pragma omp simd
  for (size_t i = 0; i < stride; i++) {
    double pull, stiffness;
    const double v = w[i] * decay[i], x = FMA(reach[i], w[i], u[i]);
    const double y = x + FMA(pivot_cos[i], cosine, pivot_sin[i] * sine);
    force(terms, &own, i, y, cosine, &pull, &stiffness);
    const double bare = FMA(spread[i], noise[i], -(push[i] * pull));
    u[i] = x;
    w[i] = FMA(FMA(-bend[i], stiffness, 1.0), bare, v);
  }
}

#define KICK_ARGUMENTS                                                                     \
  size_t stride, const pendres_langevin_rows *rows, const double *reach, const double *decay, \
    double cosine, double sine, const double *noise
#define KICK(name, terms)                                               \
  static void name(KICK_ARGUMENTS)                                      \
  {                                                                     \
    kick_by(terms, stride, rows, reach, decay, cosine, sine, noise);    \
  }
KICK(kick_plain, PENDRES_MODEL_PLAIN)
KICK(kick_pendulum, PENDRES_MODEL_PENDULUM)
KICK(kick_polynomial, PENDRES_MODEL_POLYNOMIAL)
#define KICK_OWN(code, name) KICK(kick_##name, PENDRES_MODEL_##code)
PENDRES_FORCE_LIST(KICK_OWN)
#undef KICK_OWN
#undef KICK

/* The rows from a lane on. */
static pendres_langevin_rows rows_from(const pendres_langevin_rows *rows, size_t lane)
{
  pendres_langevin_rows r = *rows;
  r.u += lane;
  r.w += lane;
  r.pivot_cos += lane;
  r.pivot_sin += lane;
  r.push += lane;
  r.spread += lane;
  r.bend += lane;
  r.torque += lane;
  r.parametric += lane;
  return r;
}

/* A formula has all lanes of a strip go through its operations: their places come first. */
static void kick_formula(KICK_ARGUMENTS)
{
  pendres_kernels_formula f;
  for (size_t lane = 0, lanes; lane < stride; lane += lanes) {
    lanes = stride - lane < FORMULA_LANES ? stride - lane : FORMULA_LANES;
    pendres_langevin_rows own = rows_from(rows, lane);
    pendres_kernels_formula_open(&f, rows->formula, FORMULA_SLOPES, rows->coefficient, lane);
#pragma omp simd
    for (size_t i = 0; i < lanes; i++)
      f.y[i] = FMA(reach[lane + i], own.w[i], own.u[i]) +
               FMA(own.pivot_cos[i], cosine, own.pivot_sin[i] * sine);
    pendres_kernels_formula_at(&f, lanes, f.y);
    own.coefficient[FORMULA_OUT_FORCE] = f.value[FORMULA_OUT_FORCE];
    own.coefficient[FORMULA_OUT_SLOPE] = f.value[FORMULA_OUT_SLOPE];
    kick_by(PENDRES_MODEL_FORMULA, lanes, &own, reach + lane, decay + lane, cosine, sine,
            noise + lane);
  }
}
#define KICK_OF(code, name) [PENDRES_MODEL_##code] = kick_##name,

static void sample(size_t stride, const pendres_langevin_rows *rows,
                   const double *restrict reach, double cosine, double sine,
                   double *restrict sum_cos, double *restrict sum_sin)
{
  const double *restrict u = rows->u, *restrict w = rows->w;
  const double *restrict pivot_cos = rows->pivot_cos, *restrict pivot_sin = rows->pivot_sin;

#pragma omp simd
  for (size_t i = 0; i < stride; i++) {
    const double pivot = FMA(pivot_cos[i], cosine, pivot_sin[i] * sine);
    const double y = FMA(reach[i], w[i], u[i]) + pivot;
    sum_cos[i] = FMA(y, cosine, sum_cos[i]);
    sum_sin[i] = FMA(y, sine, sum_sin[i]);
  }
}

const pendres_kernels_langevin PENDRES_INSTRUCTIONS_OWN(pendres_kernels_langevin) = {
  .name = PENDRES_INSTRUCTIONS_NAME,
  .words = words,
  .gauss = gauss,
  .drift = drift,
  .kick = {[PENDRES_MODEL_PLAIN] = kick_plain, [PENDRES_MODEL_PENDULUM] = kick_pendulum,
           [PENDRES_MODEL_POLYNOMIAL] = kick_polynomial,
           PENDRES_FORCE_LIST(KICK_OF)[PENDRES_MODEL_COUNT] = kick_formula},
  .sample = sample};
