/* kernels_nystrom.c -- a period by a Runge-Kutta-Nystrom method; see kernels_nystrom.h. */
#include "engine/kernels/kernels_nystrom.h"

#include <stdint.h>
#include <string.h>

#include "base/angles.h"
#include "base/instructions.h"
#include "engine/kernels/kernels_force.h"

#define INLINE PENDRES_VECTOR_INLINE

enum { STAGES = PENDRES_NYSTROM_STAGES, UNIT = 8 /* lanes are a multiple of this */ };

/* Sums over the slopes of earlier stages, and those of a step of the place and of the speed. */
#define INNER                                                                                  \
  {{0},                                                                                        \
   {1.0 / 800.0},                                                                              \
   {1.0 / 600.0, 1.0 / 300.0},                                                                 \
   {9.0 / 200.0, -9.0 / 100.0, 9.0 / 100.0},                                                   \
   {-66701.0 / 197352.0, 28325.0 / 32892.0, -2665.0 / 5482.0, 2170.0 / 24669.0},               \
   {227015747.0 / 304251000.0, -54897451.0 / 30425100.0, 12942349.0 / 10141700.0,              \
    -9499.0 / 304251.0, 539.0 / 9250.0},                                                       \
   {-1131891597.0 / 901789000.0, 41964921.0 / 12882700.0, -6663147.0 / 3220675.0,              \
    270954.0 / 644135.0, -108.0 / 5875.0, 114.0 / 1645.0},                                     \
   {13836959.0 / 3667458.0, -17731450.0 / 1833729.0, 1063919505.0 / 156478208.0,               \
    -33213845.0 / 39119552.0, 13335.0 / 28544.0, -705.0 / 14272.0, 1645.0 / 57088.0}}
#define PLACE                                                                             \
  {223.0 / 7938.0,  0.0, 1175.0 / 8064.0, 925.0 / 6048.0, 41.0 / 448.0, 925.0 / 14112.0, \
   1175.0 / 72576.0, 0.0}
#define SPEED                                                                                \
  {223.0 / 7938.0,    0.0, 5875.0 / 36288.0, 4625.0 / 21168.0, 41.0 / 224.0, 4625.0 / 21168.0, \
   5875.0 / 36288.0, 223.0 / 7938.0}

INLINE double fma_one(double a, double b, double c)
{
  return __builtin_fma(a, b, c);
}

/* (1 - exp(-x)) / x to rounding, for |x| < 2 and for |x| < 0.1. */
INLINE double mean_decay_far(double x)
{
  double sum = 1.0;
#pragma GCC unroll 24
  for (int k = 24; k > 1; k--) sum = fma_one(-x * (1.0 / k), sum, 1.0);
  return sum;
}

INLINE double mean_decay_near(double x)
{
  double sum = 1.0;
#pragma GCC unroll 12
  for (int k = 10; k > 1; k--) sum = fma_one(-x * (1.0 / k), sum, 1.0);
  return sum;
}

/* ---- double precision ---- */

/* Vectors of a group: what fits the registers together with a sine's. */
enum { WIDE_DOUBLE = PENDRES_VECTOR_LANES, MOST_DOUBLE = WIDE_DOUBLE == 8 ? 8 : 4 };

/* y[v] = df/dy there, as carried errors need it: of a sine within 1e-4. */
INLINE void slopes_double(pendres_model_terms model, int count, const double *const *power,
                          pendres_vector *y)
{
  double by[MOST_DOUBLE * WIDE_DOUBLE] __attribute__((aligned(64)));
  PENDRES_VECTOR_EACH pendres_vector_store(by + v * WIDE_DOUBLE, y[v]);
#pragma omp simd
  for (int i = 0; i < count * WIDE_DOUBLE; i++) {
    double unused;
    if (model >= PENDRES_MODEL_POLYNOMIAL)
      pendres_kernels_force(model, power, (size_t)i, by[i], &unused, &by[i]);
    else
      by[i] = pendres_kernels_cos_roughly(by[i]);
  }
  PENDRES_VECTOR_EACH y[v] = pendres_vector_load(by + v * WIDE_DOUBLE);
}

INLINE void forces_double(pendres_model_terms model, int count, const double *const *power,
                          pendres_vector *y)
{
  pendres_kernels_forces(model, count, power, 0, y);
}

#define REAL double
#define VECTOR pendres_vector
#define WIDE WIDE_DOUBLE
#define MOST MOST_DOUBLE
#define FUSED pendres_vector_fma
#define FORCES forces_double
#define SLOPES slopes_double
#define NAME(x) x##_double
#include "engine/kernels/kernels_nystrom_run.h"
#undef REAL
#undef VECTOR
#undef WIDE
#undef MOST
#undef FUSED
#undef FORCES
#undef SLOPES
#undef NAME

/* ---- single precision ---- */

enum { WIDE_SINGLE = 2 * PENDRES_VECTOR_LANES, MOST_SINGLE = MOST_DOUBLE };

typedef float single
  __attribute__((vector_size(WIDE_SINGLE * sizeof(float)), may_alias));
typedef int32_t single_bits
  __attribute__((vector_size(WIDE_SINGLE * sizeof(int32_t)), may_alias));

INLINE single fused_single(single a, single b, single c)
{
#if defined(__AVX512F__)
  return _mm512_fmadd_ps(a, b, c);
#elif defined(__AVX__) && defined(__FMA__)
  return _mm256_fmadd_ps(a, b, c);
#else
  single r;
  for (int i = 0; i < WIDE_SINGLE; i++) r[i] = __builtin_fmaf(a[i], b[i], c[i]);
  return r;
#endif
}

INLINE single all_single(float a)
{
  return a - (single){0.0f};
}

/* Adding and subtracting this rounds to a whole number, whose parity is the sum's lowest bit. */
static const float to_whole = 0x1.8p23f;

/* y[v] = sin y[v]: as in base/sine.h, with a polynomial that is off by 6e-9 of the sine. */
INLINE void sines_single(pendres_model_terms model, int count, const double *const *power,
                         single *y)
{
  single t[MOST_SINGLE], s[MOST_SINGLE];
  (void)model, (void)power;
  PENDRES_VECTOR_EACH t[v] = fused_single(y[v], all_single(0x1.45f306p-2f), all_single(to_whole));
  PENDRES_VECTOR_EACH s[v] = t[v] - all_single(to_whole);
  PENDRES_VECTOR_EACH y[v] = fused_single(-s[v], all_single(0x1.921fb6p+1f), y[v]);
  PENDRES_VECTOR_EACH y[v] = fused_single(-s[v], all_single(-0x1.777a5cp-24f), y[v]);
  PENDRES_VECTOR_EACH y[v] = (single)((single_bits)y[v] ^ ((single_bits)t[v] << 31));
  PENDRES_VECTOR_EACH s[v] = y[v] * y[v];
  PENDRES_VECTOR_EACH t[v] =
    fused_single(s[v], all_single(0x1.5dbdf0p-19f), all_single(-0x1.9f6ffep-13f));
  PENDRES_VECTOR_EACH t[v] = fused_single(t[v], s[v], all_single(0x1.110ed4p-7f));
  PENDRES_VECTOR_EACH t[v] = fused_single(t[v], s[v], all_single(-0x1.55554cp-3f));
  PENDRES_VECTOR_EACH s[v] = y[v] * s[v];
  PENDRES_VECTOR_EACH y[v] = fused_single(s[v], t[v], y[v]);
}

/* y[v] = cos y[v] within 1e-4, as pendres_kernels_cos_roughly(). */
INLINE void cosines_single(pendres_model_terms model, int count, const double *const *power,
                           single *y)
{
  (void)model, (void)power;
  PENDRES_VECTOR_EACH
  {
    const single whole = all_single(to_whole);
    const single turns = fused_single(y[v], all_single(0x1.45f306p-3f), whole) - whole;
    const single r = fused_single(-turns, all_single(0x1.921fb6p+2f), y[v]), s = r * r;
    single p = fused_single(s, all_single(1.87708309275e-05f), all_single(-0.00133885087532f));
    p = fused_single(p, s, all_single(0.0414934583954f));
    p = fused_single(p, s, all_single(-0.499788065521f));
    y[v] = fused_single(p, s, all_single(0.99995823162f));
  }
}

#define REAL float
#define VECTOR single
#define WIDE WIDE_SINGLE
#define MOST MOST_SINGLE
#define FUSED fused_single
#define FORCES sines_single
#define SLOPES cosines_single
#define NAME(x) x##_single
#include "engine/kernels/kernels_nystrom_run.h"

/* ---- groups of as many vectors as there are lanes for ---- */

typedef void run_some(const pendres_nystrom_steps *, const pendres_nystrom_lanes *, size_t);

#define GROUP(NAME, MODEL, COUNT)                                                             \
  static void NAME##_##MODEL##_##COUNT(const pendres_nystrom_steps *s,                        \
                                       const pendres_nystrom_lanes *b, size_t lane)           \
  {                                                                                           \
    run_group_##NAME(PENDRES_MODEL_##MODEL, COUNT, s, b, lane);                               \
  }
#if defined(__AVX512F__)
#define COUNTS(EACH_COUNT, A, B) \
  EACH_COUNT(A, B, 1)            \
  EACH_COUNT(A, B, 2)            \
  EACH_COUNT(A, B, 3)            \
  EACH_COUNT(A, B, 4)            \
  EACH_COUNT(A, B, 5)            \
  EACH_COUNT(A, B, 6)            \
  EACH_COUNT(A, B, 7)            \
  EACH_COUNT(A, B, 8)
#elif defined(__AVX__)
#define COUNTS(EACH_COUNT, A, B) \
  EACH_COUNT(A, B, 1)            \
  EACH_COUNT(A, B, 2)            \
  EACH_COUNT(A, B, 4)
#else
#define COUNTS(EACH_COUNT, A, B) \
  EACH_COUNT(A, B, 2)            \
  EACH_COUNT(A, B, 4)
#endif

#define DOUBLE_GROUP(MODEL, unused, COUNT) GROUP(double, MODEL, COUNT)
#define DOUBLE_GROUPS(MODEL, name) COUNTS(DOUBLE_GROUP, MODEL, name)
#define SINGLE_GROUP(MODEL, unused, COUNT) GROUP(single, MODEL, COUNT)
DOUBLE_GROUPS(PLAIN, plain)
DOUBLE_GROUPS(PENDULUM, pendulum)
DOUBLE_GROUPS(POLYNOMIAL, polynomial)
PENDRES_FORCE_LIST(DOUBLE_GROUPS)
COUNTS(SINGLE_GROUP, PLAIN, plain)

#define OF_COUNT(MODEL, unused, COUNT) [COUNT] = double_##MODEL##_##COUNT,
#define OF_MODEL(MODEL, name) [PENDRES_MODEL_##MODEL] = {COUNTS(OF_COUNT, MODEL, name)},
static run_some *const in_double[PENDRES_MODEL_COUNT][MOST_DOUBLE + 1] = {
  OF_MODEL(PLAIN, plain) OF_MODEL(PENDULUM, pendulum) OF_MODEL(POLYNOMIAL, polynomial)
  PENDRES_FORCE_LIST(OF_MODEL)};
#define OF_SINGLE(MODEL, unused, COUNT) [COUNT] = single_##MODEL##_##COUNT,
static run_some *const in_single[MOST_SINGLE + 1] = {COUNTS(OF_SINGLE, PLAIN, plain)};

/* All lanes, in as few groups as can be, and as equal. */
INLINE void run_all(run_some *const *of, size_t wide, size_t most, const pendres_nystrom_steps *s,
                    const pendres_nystrom_lanes *b)
{
  const size_t vectors = (b->lanes + wide - 1) / wide, groups = (vectors + most - 1) / most;
  size_t lane = 0;
  for (size_t g = 0; g < groups; g++) {
    size_t count = (vectors - lane / wide + groups - g - 1) / (groups - g);
    while (of[count] == NULL) count++;
    of[count](s, b, lane);
    lane += count * wide;
    if (lane >= b->lanes) return;
  }
}

static void run(const pendres_nystrom_steps *s, const pendres_nystrom_lanes *b)
{
  run_all(in_double[b->model], WIDE_DOUBLE, MOST_DOUBLE, s, b);
}

static void run_single(const pendres_nystrom_steps *s, const pendres_nystrom_lanes *b)
{
  run_all(in_single, WIDE_SINGLE, MOST_SINGLE, s, b);
}

const pendres_kernels_nystrom PENDRES_INSTRUCTIONS_OWN(pendres_kernels_nystrom) = {run, run_single};
