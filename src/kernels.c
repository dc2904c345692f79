/*
 * kernels.c -- the inner loops over lanes; see kernels.h.
 *
 * Compiled once per instruction set with PENDRES_KERNELS set to its name.
 * Plain loops that the compiler vectorises; no operation depends on the
 * width of a vector.
 */
#include "kernels.h"

#include "kernels_sine.h"

#ifndef PENDRES_KERNELS
#define PENDRES_KERNELS base
#endif
#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)

#define FMA(a, b, c) __builtin_fma((a), (b), (c))

/* The most terms one pass takes; longer sums go on from the first pass. */
enum { MOST_TERMS = 14 };

/*
 * Sums of a fixed number of terms: the inner loop unrolls, the outer one
 * vectorises, and each vector is read once. The order of additions is the
 * order of the terms, for every lane.
 */
#define COMBINE(TERMS)                                                                       \
  static void combine_##TERMS(size_t n, const double *restrict c, const double *const *x,    \
                              double *z)                                                     \
  {                                                                                          \
    double f[TERMS];                                                                         \
    const double *p[TERMS];                                                                  \
    for (int j = 0; j < TERMS; j++) {                                                        \
      f[j] = c[j];                                                                           \
      p[j] = x[j];                                                                           \
    }                                                                                        \
    _Pragma("omp simd") for (size_t i = 0; i < n; i++)                                       \
    {                                                                                        \
      double sum = f[0] * p[0][i];                                                           \
      _Pragma("GCC unroll 16") for (int j = 1; j < TERMS; j++) sum = FMA(f[j], p[j][i], sum); \
      z[i] = sum;                                                                            \
    }                                                                                        \
  }

COMBINE(1)
COMBINE(2)
COMBINE(3)
COMBINE(4)
COMBINE(5)
COMBINE(6)
COMBINE(7)
COMBINE(8)
COMBINE(9)
COMBINE(10)
COMBINE(11)
COMBINE(12)
COMBINE(13)
COMBINE(14)

static void combine(size_t n, int terms, const double *c, const double *const *x, double *z)
{
  typedef void pass(size_t, const double *restrict, const double *const *, double *);
  static pass *const passes[MOST_TERMS + 1] = {
    NULL,      combine_1, combine_2, combine_3,  combine_4,  combine_5,  combine_6, combine_7,
    combine_8, combine_9, combine_10, combine_11, combine_12, combine_13, combine_14};

  if (terms <= MOST_TERMS) {
    passes[terms](n, c, x, z);
    return;
  }
  passes[MOST_TERMS](n, c, x, z);
  for (int done = MOST_TERMS; done < terms; done++) {
    const double f[2] = {1.0, c[done]};
    const double *const two[2] = {z, x[done]};
    combine_2(n, f, two, z);
  }
}

static void rhs_state(size_t stride, const pendres_coefficients *k, double cos_theta,
                      const double *restrict s, double *restrict d)
{
  const double *restrict stiffness = k->stiffness, *restrict drive = k->drive,
               *restrict friction = k->friction;
#pragma omp simd
  for (size_t i = 0; i < stride; i++) {
    const double y = s[i], w = s[stride + i];
    const double force = FMA(drive[i], cos_theta, -(friction[i] * w));
    d[i] = w;
    d[stride + i] = FMA(-stiffness[i], pendres_kernels_sin(y), force);
  }
}

static void rhs_variational(size_t stride, const pendres_coefficients *k, double cos_theta,
                            const double *restrict s, double *restrict d)
{
  const double *restrict stiffness = k->stiffness, *restrict drive = k->drive,
               *restrict friction = k->friction;
#pragma omp simd
  for (size_t i = 0; i < stride; i++) {
    const double y = s[i], w = s[stride + i];
    double sine, cosine;
    pendres_kernels_sincos(y, &sine, &cosine);
    const double force = FMA(drive[i], cos_theta, -(friction[i] * w));
    const double spring = -stiffness[i] * cosine, drag = -friction[i];
    d[i] = w;
    d[stride + i] = FMA(-stiffness[i], sine, force);
    d[2 * stride + i] = s[3 * stride + i];
    d[3 * stride + i] = FMA(spring, s[2 * stride + i], drag * s[3 * stride + i]);
    d[4 * stride + i] = s[5 * stride + i];
    d[5 * stride + i] = FMA(spring, s[4 * stride + i], drag * s[5 * stride + i]);
  }
}

static void rhs_sensitivity(size_t stride, const pendres_coefficients *k, double cos_theta,
                            const double *restrict s, double *restrict d)
{
  const double *restrict stiffness = k->stiffness, *restrict drive = k->drive,
               *restrict friction = k->friction, *restrict inverse = k->inverse;

  rhs_variational(stride, k, cos_theta, s, d);
#pragma omp simd
  for (size_t i = 0; i < stride; i++) {
    const double w = s[stride + i];
    double sine, cosine;
    pendres_kernels_sincos(s[i], &sine, &cosine);
    const double spring = -stiffness[i] * cosine, drag = -friction[i];
    /* d/domega of the slope at fixed state: 2/omega (stiffness sin y - drive cos) + friction/omega w */
    const double by_frequency =
      inverse[i] * FMA(2.0, FMA(stiffness[i], sine, -(drive[i] * cos_theta)), friction[i] * w);
    const double by_damping = -inverse[i] * w;
    const double by_amplitude = stiffness[i] * cos_theta;
    d[6 * stride + i] = s[7 * stride + i];
    d[7 * stride + i] =
      FMA(spring, s[6 * stride + i], FMA(drag, s[7 * stride + i], by_frequency));
    d[8 * stride + i] = s[9 * stride + i];
    d[9 * stride + i] = FMA(spring, s[8 * stride + i], FMA(drag, s[9 * stride + i], by_damping));
    d[10 * stride + i] = s[11 * stride + i];
    d[11 * stride + i] =
      FMA(spring, s[10 * stride + i], FMA(drag, s[11 * stride + i], by_amplitude));
  }
}

#define TEXT_(a) #a
#define TEXT(a) TEXT_(a)

const pendres_kernels JOIN(pendres_kernels, PENDRES_KERNELS) = {
  TEXT(PENDRES_KERNELS), combine, rhs_state, rhs_variational, rhs_sensitivity};
