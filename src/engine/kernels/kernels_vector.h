/*
 * kernels_vector.h -- a vector of doubles as wide as the instruction set that is compiled for.
 *
 * Owns: the types and the few operations that the kernels write out by hand, so that a group
 * of vectors stays in registers. Each is one IEEE operation an element, whatever the width.
 */
#ifndef PENDRES_KERNELS_VECTOR_H
#define PENDRES_KERNELS_VECTOR_H

#include <stddef.h>

#if defined(__AVX__)
#include <immintrin.h>
#endif

#include "base/sine.h"

/* Elements of a vector, and how many vectors of y and of w fit the registers at once. */
#if defined(__AVX512F__)
enum { PENDRES_VECTOR_LANES = 8, PENDRES_VECTOR_GROUP = 10 };
#elif defined(__AVX__)
enum { PENDRES_VECTOR_LANES = 4, PENDRES_VECTOR_GROUP = 4 };
#else
enum { PENDRES_VECTOR_LANES = 2, PENDRES_VECTOR_GROUP = 4 };
#endif

#define PENDRES_VECTOR_INLINE static inline __attribute__((always_inline))

typedef double pendres_vector
  __attribute__((vector_size(PENDRES_VECTOR_LANES * sizeof(double)), may_alias));

PENDRES_VECTOR_INLINE pendres_vector pendres_vector_load(const double *p)
{
  return *(const pendres_vector *)p;
}

PENDRES_VECTOR_INLINE void pendres_vector_store(double *p, pendres_vector a)
{
  *(pendres_vector *)p = a;
}

/* The address of p[at], computed here and now: left alone, GCC keeps one index a load instead. */
PENDRES_VECTOR_INLINE const double *pendres_vector_address(const double *p, size_t at)
{
  p += at;
  __asm__("" : "+r"(p));
  return p;
}

/* All elements a; a - 0 is a for every a, -0 included. */
PENDRES_VECTOR_INLINE pendres_vector pendres_vector_set(double a)
{
  return a - (pendres_vector){0.0};
}

/* a b + c, rounded once. */
PENDRES_VECTOR_INLINE pendres_vector pendres_vector_fma(pendres_vector a, pendres_vector b,
                                                        pendres_vector c)
{
#if defined(__AVX512F__)
  return _mm512_fmadd_pd(a, b, c);
#elif defined(__AVX__) && defined(__FMA__)
  return _mm256_fmadd_pd(a, b, c);
#else
  pendres_vector r;
  for (int i = 0; i < PENDRES_VECTOR_LANES; i++) r[i] = __builtin_fma(a[i], b[i], c[i]);
  return r;
#endif
}

#define PENDRES_VECTOR_EACH _Pragma("GCC unroll 16") for (int v = 0; v < count; v++)

/*
 * y[v] = sin y[v], as pendres_kernels_sin does it: the same operations, step by step for all
 * vectors, as each must wait for the one before.
 */
PENDRES_VECTOR_INLINE void pendres_vector_sines(int count, pendres_vector *y)
{
  typedef uint64_t bits
    __attribute__((vector_size(PENDRES_VECTOR_LANES * sizeof(uint64_t)), may_alias));
  pendres_vector t[PENDRES_VECTOR_GROUP], s[PENDRES_VECTOR_GROUP];
  /* Constants from memory when they are needed: as registers are, they would push out vectors. */
  const double *const c = pendres_vector_address(pendres_kernels_sine, 0);
  pendres_vector f = pendres_vector_set(c[PENDRES_SINE_INVERSE_PI]);
  const pendres_vector shift = pendres_vector_set(c[PENDRES_SINE_SHIFT]);

  PENDRES_VECTOR_EACH t[v] = pendres_vector_fma(y[v], f, shift);
  PENDRES_VECTOR_EACH s[v] = t[v] - shift;
  f = pendres_vector_set(c[PENDRES_SINE_PI_HIGH]);
  PENDRES_VECTOR_EACH y[v] = pendres_vector_fma(-s[v], f, y[v]);
  f = pendres_vector_set(c[PENDRES_SINE_PI_LOW]);
  PENDRES_VECTOR_EACH y[v] = pendres_vector_fma(-s[v], f, y[v]);
  PENDRES_VECTOR_EACH y[v] = (pendres_vector)((bits)y[v] ^ ((bits)t[v] << 63));
  PENDRES_VECTOR_EACH s[v] = y[v] * y[v];
  PENDRES_VECTOR_EACH t[v] = pendres_vector_set(c[PENDRES_SINE_FIRST]);
#pragma GCC unroll 8
  for (int i = PENDRES_SINE_FIRST + 1; i < PENDRES_SINE_COUNT; i++) {
    f = pendres_vector_set(c[i]);
    PENDRES_VECTOR_EACH t[v] = pendres_vector_fma(t[v], s[v], f);
  }
  PENDRES_VECTOR_EACH s[v] = y[v] * s[v];
  PENDRES_VECTOR_EACH y[v] = pendres_vector_fma(s[v], t[v], y[v]);
}

#endif
