/* kernels_nystrom.c -- a period by a Runge-Kutta-Nystrom method; see kernels_nystrom.h. */
#include "engine/kernels/kernels_nystrom.h"

#include <float.h>
#include <math.h>
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

/* What a group's forces come from: coefficients of its lanes, or a formula that was given them. */
typedef struct source {
  const double *power[PENDRES_FORCE_POWERS];
  pendres_kernels_formula *force, *slope;
} source;

/* The same of a formula as forces_double() below. */
INLINE void formula_double(int count, pendres_kernels_formula *f, pendres_vector *y,
                           pendres_vector *slope)
{
  PENDRES_VECTOR_EACH pendres_vector_store(f->y + v * WIDE_DOUBLE, y[v]);
  pendres_kernels_formula_at(f, (size_t)count * WIDE_DOUBLE, f->y);
  PENDRES_VECTOR_EACH y[v] =
    pendres_vector_load(f->value[FORMULA_OUT_FORCE] + v * WIDE_DOUBLE);
  if (slope == NULL) return;
  PENDRES_VECTOR_EACH slope[v] =
    pendres_vector_load(f->value[FORMULA_OUT_SLOPE] + v * WIDE_DOUBLE);
}

/* Forces at vectors of places, and their derivatives unless slope is NULL. */
INLINE void forces_double(pendres_model_terms model, int count, const source *from,
                          pendres_vector *y, pendres_vector *slope)
{
  double f[MOST_DOUBLE * WIDE_DOUBLE] __attribute__((aligned(64)));
  double by[MOST_DOUBLE * WIDE_DOUBLE] __attribute__((aligned(64)));
  if (model == PENDRES_MODEL_FORMULA) {
    formula_double(count, slope != NULL ? from->slope : from->force, y, slope);
    return;
  }
  if (slope == NULL) {
    pendres_kernels_forces(model, count, from->power, 0, y);
    return;
  }
  PENDRES_VECTOR_EACH pendres_vector_store(f + v * WIDE_DOUBLE, y[v]);
#pragma omp simd
  for (int i = 0; i < count * WIDE_DOUBLE; i++)
    pendres_kernels_force(model, from->power, (size_t)i, f[i], &f[i], &by[i]);
  PENDRES_VECTOR_EACH y[v] = pendres_vector_load(f + v * WIDE_DOUBLE);
  PENDRES_VECTOR_EACH slope[v] = pendres_vector_load(by + v * WIDE_DOUBLE);
}

#define REAL double
#define VECTOR pendres_vector
#define WIDE WIDE_DOUBLE
#define MOST MOST_DOUBLE
#define FUSED pendres_vector_fma
#define FORCES forces_double
#define TO_WHOLE 0x1.8p52
#define NAME(x) x##_double
#include "engine/kernels/kernels_nystrom_run.h"
#undef REAL
#undef VECTOR
#undef WIDE
#undef MOST
#undef FUSED
#undef FORCES
#undef TO_WHOLE
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

/* sin y[v], and cos y[v] unless slope is NULL: as in base/sine.h, with polynomials that are off by
   6e-9. */
INLINE void forces_single(pendres_model_terms model, int count, const source *from,
                          single *y, single *slope)
{
  single t[MOST_SINGLE], s[MOST_SINGLE];
  const single whole = all_single(0x1.8p23f);
  (void)model, (void)from;
  PENDRES_VECTOR_EACH t[v] = fused_single(y[v], all_single(0x1.45f306p-2f), whole);
  PENDRES_VECTOR_EACH s[v] = t[v] - whole;
  PENDRES_VECTOR_EACH y[v] = fused_single(-s[v], all_single(0x1.921fb6p+1f), y[v]);
  PENDRES_VECTOR_EACH y[v] = fused_single(-s[v], all_single(-0x1.777a5cp-24f), y[v]);
  PENDRES_VECTOR_EACH y[v] = (single)((single_bits)y[v] ^ ((single_bits)t[v] << 31));
  PENDRES_VECTOR_EACH s[v] = y[v] * y[v];
  if (slope != NULL)
    PENDRES_VECTOR_EACH
    {
      single c = fused_single(s[v], all_single(-0x1.194102p-22f), all_single(0x1.9f8f5ap-16f));
      c = fused_single(c, s[v], all_single(-0x1.6c149cp-10f));
      c = fused_single(c, s[v], all_single(0x1.55555p-5f));
      c = fused_single(c, s[v], all_single(-0.5f));
      c = fused_single(c, s[v], all_single(1.0f));
      slope[v] = (single)((single_bits)c ^ ((single_bits)t[v] << 31));
    }
  PENDRES_VECTOR_EACH t[v] =
    fused_single(s[v], all_single(0x1.5dbdf0p-19f), all_single(-0x1.9f6ffep-13f));
  PENDRES_VECTOR_EACH t[v] = fused_single(t[v], s[v], all_single(0x1.110ed4p-7f));
  PENDRES_VECTOR_EACH t[v] = fused_single(t[v], s[v], all_single(-0x1.55554cp-3f));
  PENDRES_VECTOR_EACH s[v] = y[v] * s[v];
  PENDRES_VECTOR_EACH y[v] = fused_single(s[v], t[v], y[v]);
}

#define REAL float
#define VECTOR single
#define WIDE WIDE_SINGLE
#define MOST MOST_SINGLE
#define FUSED fused_single
#define FORCES forces_single
#define TO_WHOLE 0x1.8p23f
#define NAME(x) x##_single
#include "engine/kernels/kernels_nystrom_run.h"

/* ---- groups of as many vectors as there are lanes for ---- */

typedef void run_some(const pendres_nystrom_steps *, const pendres_nystrom_lanes *, size_t);

/* As many as are worth the time of compiling them: of the plain pendulum's states most. */
#if defined(__AVX512F__)
#define FEW(EACH_COUNT, A, B) EACH_COUNT(A, B, 1) EACH_COUNT(A, B, 4)
#define SOME(EACH_COUNT, A, B) FEW(EACH_COUNT, A, B) EACH_COUNT(A, B, 8)
#define MANY(EACH_COUNT, A, B) \
  SOME(EACH_COUNT, A, B)       \
  EACH_COUNT(A, B, 2)          \
  EACH_COUNT(A, B, 3)          \
  EACH_COUNT(A, B, 6)
#elif defined(__AVX__)
#define FEW(EACH_COUNT, A, B) EACH_COUNT(A, B, 2) EACH_COUNT(A, B, 4)
#define SOME FEW
#define MANY FEW
#else
#define FEW(EACH_COUNT, A, B) EACH_COUNT(A, B, 4)
#define SOME FEW
#define MANY FEW
#endif

#define GROUP(REAL_NAME, MODEL, TANGENTS, COUNT)                                        \
  static void REAL_NAME##_##MODEL##_##TANGENTS##_##COUNT(                               \
    const pendres_nystrom_steps *s, const pendres_nystrom_lanes *b, size_t lane)        \
  {                                                                                     \
    run_group_##REAL_NAME(PENDRES_MODEL_##MODEL, COUNT, TANGENTS, s, b, lane);          \
  }
#define DOUBLE_GROUP(MODEL, TANGENTS, COUNT) GROUP(double, MODEL, TANGENTS, COUNT)
#define SINGLE_GROUP(MODEL, TANGENTS, COUNT) GROUP(single, MODEL, TANGENTS, COUNT)
#define DOUBLE_GROUPS(MODEL, name) FEW(DOUBLE_GROUP, MODEL, 1) SOME(DOUBLE_GROUP, MODEL, 0)
#define SINGLE_GROUPS(MODEL, name) FEW(SINGLE_GROUP, MODEL, 1) SOME(SINGLE_GROUP, MODEL, 0)
FEW(DOUBLE_GROUP, PLAIN, 1)
MANY(DOUBLE_GROUP, PLAIN, 0)
DOUBLE_GROUPS(PENDULUM, pendulum)
DOUBLE_GROUPS(POLYNOMIAL, polynomial)
PENDRES_FORCE_LIST(DOUBLE_GROUPS)
DOUBLE_GROUPS(FORMULA, formula)
FEW(SINGLE_GROUP, PLAIN, 1)
MANY(SINGLE_GROUP, PLAIN, 0)
SINGLE_GROUPS(PENDULUM, pendulum)
SINGLE_GROUPS(POLYNOMIAL, polynomial)

/* By model, whether there are tangents, and how many vectors. */
#define OF_DOUBLE(MODEL, TANGENTS, COUNT) [COUNT] = double_##MODEL##_##TANGENTS##_##COUNT,
#define OF_SINGLE(MODEL, TANGENTS, COUNT) [COUNT] = single_##MODEL##_##TANGENTS##_##COUNT,
#define IN_DOUBLE(MODEL, name) \
  [PENDRES_MODEL_##MODEL] = {{SOME(OF_DOUBLE, MODEL, 0)}, {FEW(OF_DOUBLE, MODEL, 1)}},
static run_some *const in_double[PENDRES_MODEL_COUNT + 1][2][MOST_DOUBLE + 1] = {
  [PENDRES_MODEL_COUNT] = {{SOME(OF_DOUBLE, FORMULA, 0)}, {FEW(OF_DOUBLE, FORMULA, 1)}},
  [PENDRES_MODEL_PLAIN] = {{MANY(OF_DOUBLE, PLAIN, 0)}, {FEW(OF_DOUBLE, PLAIN, 1)}},
  IN_DOUBLE(PENDULUM, pendulum) IN_DOUBLE(POLYNOMIAL, polynomial) PENDRES_FORCE_LIST(IN_DOUBLE)};
static run_some *const in_single[PENDRES_MODEL_POLYNOMIAL + 1][2][MOST_SINGLE + 1] = {
  [PENDRES_MODEL_PLAIN] = {{MANY(OF_SINGLE, PLAIN, 0)}, {FEW(OF_SINGLE, PLAIN, 1)}},
  [PENDRES_MODEL_PENDULUM] = {{SOME(OF_SINGLE, PENDULUM, 0)}, {FEW(OF_SINGLE, PENDULUM, 1)}},
  [PENDRES_MODEL_POLYNOMIAL] = {{SOME(OF_SINGLE, POLYNOMIAL, 0)},
                                {FEW(OF_SINGLE, POLYNOMIAL, 1)}}};

/* All lanes, in as few groups as can be, and as equal. */
INLINE void run_all(run_some *const *of, size_t wide, size_t most, const pendres_nystrom_steps *s,
                    const pendres_nystrom_lanes *b)
{
  const size_t vectors = (b->lanes + wide - 1) / wide, groups = (vectors + most - 1) / most;
  size_t lane = 0;
  for (size_t g = 0; g < groups && lane < b->lanes; g++) {
    size_t count = (vectors - lane / wide + groups - g - 1) / (groups - g);
    while (of[count] == NULL) count++;
    of[count](s, b, lane);
    lane += count * wide;
  }
}

static void run(const pendres_nystrom_steps *s, const pendres_nystrom_lanes *b)
{
  const int tangents = b->tangent_y != NULL;
  run_all(in_double[pendres_model_kernel(b->model)][tangents], WIDE_DOUBLE,
          tangents ? 4 : MOST_DOUBLE, s, b);
}

static void run_single(const pendres_nystrom_steps *s, const pendres_nystrom_lanes *b)
{
  const int tangents = b->tangent_y != NULL;
  run_all(in_single[b->model][tangents], WIDE_SINGLE, tangents ? 4 : MOST_SINGLE, s, b);
}

const pendres_kernels_nystrom PENDRES_INSTRUCTIONS_OWN(pendres_kernels_nystrom) = {run, run_single};
