/*
 * bare_loop.h -- a reference for the speed of blocks: the same Runge-Kutta method in a plain SIMD
 * loop.
 *
 * Owns: one function, BARE_RUN, for vectors of BARE_LANES doubles; included once for each
 * instruction set, which BARE_TARGET names to the compiler. No ARKODE, no vectors in memory but the
 * slopes of one group: a group of lanes goes through all steps of all periods with its state in
 * registers and its slopes in the nearest cache, several vectors together so that no operation
 * waits for the one before. Coefficients that are zero are left out, h is multiplied in, and the
 * cosines are known.
 */
#include <stddef.h>
#include <stdint.h>

#include "base/sine.h"

#define BARE_JOIN_(a, b) a##_##b
#define BARE_JOIN(a, b) BARE_JOIN_(a, b)
#define BARE(name) BARE_JOIN(name, BARE_RUN)
#define BARE_INLINE BARE_TARGET static inline __attribute__((always_inline))
#define BARE_EACH _Pragma("GCC unroll 8") for (int v = 0; v < count; v++)

typedef double BARE(vec) __attribute__((vector_size(BARE_LANES * 8), may_alias));
typedef uint64_t BARE(bits) __attribute__((vector_size(BARE_LANES * 8), may_alias));

#define vec BARE(vec)
#define set(a) ((a) - (vec){0.0})
#define constant(i) set(pendres_kernels_sine[i])
#define load(p) (*(const vec *)(p))
#define store(p, a) (*(vec *)(p) = (a))

BARE_INLINE vec BARE(fma)(vec a, vec b, vec c)
{
#if BARE_LANES == 8
  return _mm512_fmadd_pd(a, b, c);
#elif BARE_LANES == 4
  return _mm256_fmadd_pd(a, b, c);
#else
  vec r;
  for (int i = 0; i < BARE_LANES; i++) r[i] = __builtin_fma(a[i], b[i], c[i]);
  return r;
#endif
}
#define fma_(a, b, c) BARE(fma)((a), (b), (c))

BARE_INLINE void BARE(sines)(int count, vec *y)
{
  vec t[8], s[8], k[8];
  BARE_EACH t[v] = fma_(y[v], constant(PENDRES_SINE_INVERSE_PI), constant(PENDRES_SINE_SHIFT));
  BARE_EACH k[v] = t[v] - constant(PENDRES_SINE_SHIFT);
  BARE_EACH y[v] = fma_(-k[v], constant(PENDRES_SINE_PI_HIGH), y[v]);
  BARE_EACH y[v] = fma_(-k[v], constant(PENDRES_SINE_PI_LOW), y[v]);
  BARE_EACH y[v] = (vec)((BARE(bits))y[v] ^ ((BARE(bits))t[v] << 63));
  BARE_EACH s[v] = y[v] * y[v];
  BARE_EACH t[v] = constant(PENDRES_SINE_FIRST);
  _Pragma("GCC unroll 8") for (int i = PENDRES_SINE_FIRST + 1;
                                i < PENDRES_SINE_COUNT; i++)
    BARE_EACH t[v] = fma_(t[v], s[v], constant(i));
  BARE_EACH s[v] = y[v] * s[v];
  BARE_EACH y[v] = fma_(s[v], t[v], y[v]);
}

BARE_INLINE void BARE(group)(const bare_method *m, const bare_block *b, long periods, size_t lane,
                             int count)
{
  vec y[8], w[8], sum_y[8], sum_w[8], slope_y[BARE_STAGES][8], slope_w[BARE_STAGES][8];
  BARE_EACH y[v] = load(b->y + lane + v * BARE_LANES);
  BARE_EACH w[v] = load(b->w + lane + v * BARE_LANES);
  for (long step = 0; step < periods * m->steps; step++) {
    const double *cosine = m->cosine + (step % m->steps) * m->stages;
    for (int s = 0; s <= m->stages; s++) {
      const bare_sum *q = &m->sum[s];
      BARE_EACH sum_y[v] = (vec){0.0};
      BARE_EACH sum_w[v] = (vec){0.0};
      for (int j = 0; j < q->terms; j++) {
        const vec f = set(q->c[j]), *const py = slope_y[q->j[j]], *const pw = slope_w[q->j[j]];
        BARE_EACH sum_y[v] = fma_(f, py[v], sum_y[v]);
        BARE_EACH sum_w[v] = fma_(f, pw[v], sum_w[v]);
      }
      BARE_EACH sum_y[v] += y[v];
      BARE_EACH sum_w[v] += w[v];
      if (s == m->stages) {
        BARE_EACH y[v] = sum_y[v];
        BARE_EACH w[v] = sum_w[v];
        break;
      }
      BARE_EACH slope_y[s][v] = sum_w[v];
      BARE_EACH
      {
        const size_t i = lane + v * BARE_LANES;
        const vec drag = load(b->friction + i) * sum_w[v];
        sum_w[v] = fma_(load(b->drive + i), set(cosine[s]), -drag);
      }
      BARE(sines)(count, sum_y);
      BARE_EACH slope_w[s][v] =
        fma_(-load(b->stiffness + lane + v * BARE_LANES), sum_y[v], sum_w[v]);
    }
  }
  BARE_EACH store(b->y + lane + v * BARE_LANES, y[v]);
  BARE_EACH store(b->w + lane + v * BARE_LANES, w[v]);
}

#define BARE_GROUP(count)                                                                \
  BARE_TARGET static void BARE(BARE_JOIN(group, count))(                                 \
    const bare_method *m, const bare_block *b, long periods, size_t lane)                \
  {                                                                                      \
    BARE(group)(m, b, periods, lane, count);                                             \
  }
BARE_GROUP(1)
BARE_GROUP(2)
BARE_GROUP(3)
BARE_GROUP(4)
BARE_GROUP(5)
BARE_GROUP(6)
BARE_GROUP(7)
BARE_GROUP(8)

/* b->lanes a multiple of 8. */
BARE_TARGET static void BARE_RUN(const bare_method *m, const bare_block *b, long periods)
{
  static void (*const groups[])(const bare_method *, const bare_block *, long, size_t) = {
    NULL,
    BARE(BARE_JOIN(group, 1)),
    BARE(BARE_JOIN(group, 2)),
    BARE(BARE_JOIN(group, 3)),
    BARE(BARE_JOIN(group, 4)),
    BARE(BARE_JOIN(group, 5)),
    BARE(BARE_JOIN(group, 6)),
    BARE(BARE_JOIN(group, 7)),
    BARE(BARE_JOIN(group, 8))};
  const size_t most = BARE_LANES == 8 ? 8 : 4, vectors = b->lanes / BARE_LANES;
  size_t left = (vectors + most - 1) / most;
  for (size_t done = 0; done < vectors; left--) {
    const size_t count = (vectors - done + left - 1) / left; /* groups of about the same size */
    groups[count](m, b, periods, done * BARE_LANES);
    done += count;
  }
}

#undef vec
#undef set
#undef constant
#undef load
#undef store
#undef fma_
#undef BARE_GROUP
#undef BARE_EACH
#undef BARE_INLINE
#undef BARE
#undef BARE_JOIN
#undef BARE_JOIN_
