/*
 * kernels_float.c -- a period in single precision; see kernels_float.h.
 *
 * Groups of vectors stay where they are for a whole period: states and slopes of all stages of a
 * group are in the nearest cache, and no operation depends on the width of a vector.
 */
#include "engine/kernels/kernels_float.h"

#include <stdint.h>
#include <string.h>

#if defined(__AVX__)
#include <immintrin.h>
#endif

#include "base/instructions.h"

/* Lanes of a vector, and vectors whose y and w fit the registers together with a sine's. */
#if defined(__AVX512F__)
enum { LANES = 16, GROUP = 6 };
#elif defined(__AVX__)
enum { LANES = 8, GROUP = 4 };
#else
enum { LANES = 4, GROUP = 4 };
#endif
enum { STAGES = PENDRES_TABLES_MOST_STAGES, UNIT = 8 /* lanes are a multiple of this */ };

typedef float vec __attribute__((vector_size(LANES * sizeof(float)), may_alias));
typedef int32_t bits __attribute__((vector_size(LANES * sizeof(int32_t)), may_alias));
typedef double wide __attribute__((vector_size(LANES * sizeof(double)), aligned(8), may_alias));

#define INLINE static inline __attribute__((always_inline))
#define EACH _Pragma("GCC unroll 16") for (int v = 0; v < count; v++)

INLINE vec set(float a)
{
  return a - (vec){0.0f};
}

/* a b + c, rounded once. */
INLINE vec fma_of(vec a, vec b, vec c)
{
#if defined(__AVX512F__)
  return _mm512_fmadd_ps(a, b, c);
#elif defined(__AVX__) && defined(__FMA__)
  return _mm256_fmadd_ps(a, b, c);
#else
  vec r;
  for (int i = 0; i < LANES; i++) r[i] = __builtin_fmaf(a[i], b[i], c[i]);
  return r;
#endif
}

INLINE vec narrow(const double *p)
{
  return __builtin_convertvector(*(const wide *)p, vec);
}

INLINE void widen(double *p, vec a)
{
  *(wide *)p = __builtin_convertvector(a, wide);
}

/* Adding and subtracting this rounds to a whole number, whose parity is the sum's lowest bit. */
static const float to_whole = 0x1.8p23f;

/* y[v] = sin y[v]: as in base/sine.h, with a polynomial that is off by 6e-9 of the sine. */
INLINE void sines(int count, vec *y)
{
  vec t[GROUP], s[GROUP];
  EACH t[v] = fma_of(y[v], set(0x1.45f306p-2f), set(to_whole));
  EACH s[v] = t[v] - set(to_whole);
  EACH y[v] = fma_of(-s[v], set(0x1.921fb6p+1f), y[v]);
  EACH y[v] = fma_of(-s[v], set(-0x1.777a5cp-24f), y[v]);
  EACH y[v] = (vec)((bits)y[v] ^ ((bits)t[v] << 31));
  EACH s[v] = y[v] * y[v];
  EACH t[v] = fma_of(s[v], set(0x1.5dbdf0p-19f), set(-0x1.9f6ffep-13f));
  EACH t[v] = fma_of(t[v], s[v], set(0x1.110ed4p-7f));
  EACH t[v] = fma_of(t[v], s[v], set(-0x1.55554cp-3f));
  EACH s[v] = y[v] * s[v];
  EACH y[v] = fma_of(s[v], t[v], y[v]);
}

/* cos y within 1e-4, as pendres_kernels_cos_roughly(). */
INLINE vec cosine_roughly(vec y)
{
  const vec turns = fma_of(y, set(0x1.45f306p-3f), set(to_whole)) - set(to_whole);
  const vec r = fma_of(-turns, set(0x1.921fb6p+2f), y), s = r * r;
  vec p = fma_of(s, set(1.87708309275e-05f), set(-0.00133885087532f));
  p = fma_of(p, s, set(0.0414934583954f));
  p = fma_of(p, s, set(-0.499788065521f));
  return fma_of(p, s, set(0.99995823162f));
}

/* What a group of vectors is. Sums of steps keep what their rounding takes away (Kahan). */
typedef struct group {
  vec y[GROUP], w[GROUP], lost_y[GROUP], lost_w[GROUP];
  vec stiffness[GROUP], drive[GROUP], friction[GROUP];
  vec yy[GROUP], yw[GROUP], ww[GROUP], added[GROUP], keep[GROUP], kick[GROUP];
  vec slope_y[STAGES][GROUP], slope_w[STAGES][GROUP];
} group;

/* y and w plus a sum over slopes. */
INLINE void add(int count, const pendres_float_sum *q, const group *g, vec *y, vec *w)
{
  for (int k = 0; k < q->terms; k++) {
    const vec c = set(q->term[k].c);
    const int j = q->term[k].stage;
    EACH y[v] = fma_of(c, g->slope_y[j][v], y[v]);
    EACH w[v] = fma_of(c, g->slope_w[j][v], w[v]);
  }
}

INLINE void stage(int count, const pendres_float_steps *s, int i, float cosine, group *g)
{
  vec y[GROUP], w[GROUP];
  EACH y[v] = g->y[v];
  EACH w[v] = g->w[v];
  add(count, &s->sum[i], g, y, w);
  EACH g->slope_y[i][v] = w[v];
  sines(count, y);
  EACH
  {
    const vec force = fma_of(g->drive[v], set(cosine), -(g->friction[v] * w[v]));
    g->slope_w[i][v] = fma_of(-g->stiffness[v], y[v], force);
  }
}

INLINE void end_step(int count, const pendres_float_steps *s, group *g)
{
  vec y[GROUP], w[GROUP];
  EACH y[v] = g->lost_y[v];
  EACH w[v] = g->lost_w[v];
  add(count, &s->sum[s->stages], g, y, w);
  EACH
  {
    const vec next_y = g->y[v] + y[v], next_w = g->w[v] + w[v];
    g->lost_y[v] = y[v] - (next_y - g->y[v]);
    g->lost_w[v] = w[v] - (next_w - g->w[v]);
    g->y[v] = next_y;
    g->w[v] = next_w;
  }
}

/* Errors over the step from half a step before a state to half a step after it: carry() of
   kernels.c. */
INLINE void carry(int count, const pendres_float_steps *s, group *g)
{
  const vec half = set(0.5f * s->step);
  EACH
  {
    const vec pull = g->kick[v] * cosine_roughly(g->y[v]), left = g->keep[v];
    vec b = fma_of(half, g->ww[v], g->yw[v]);
    vec a = fma_of(half, g->yw[v] + b, g->yy[v]);
    const vec mixed = fma_of(left, b, -(pull * a));
    const vec c = fma_of(left, fma_of(left, g->ww[v], -(pull * b)), -(pull * mixed));
    b = fma_of(half, c, mixed);
    a = fma_of(half, mixed + b, a);
    g->yy[v] = a + g->added[v];
    g->yw[v] = b;
    g->ww[v] = fma_of(g->stiffness[v], g->added[v], c);
  }
}

/* `count` vectors of a block from a lane on, over a period. */
INLINE void run_group(int count, const pendres_float_steps *s, const pendres_float_lanes *b,
                      size_t lane)
{
  group g;
  EACH
  {
    const size_t i = lane + (size_t)v * LANES;
    g.y[v] = narrow(b->y + i);
    g.w[v] = narrow(b->w + i);
    g.lost_y[v] = g.lost_w[v] = set(0.0f);
    g.stiffness[v] = narrow(b->k.stiffness + i);
    g.drive[v] = narrow(b->k.drive + i);
    g.friction[v] = narrow(b->k.friction + i);
    g.yy[v] = narrow(b->off.yy + i);
    g.yw[v] = narrow(b->off.yw + i);
    g.ww[v] = narrow(b->off.ww + i);
    g.added[v] = narrow(b->off.added + i);
    g.keep[v] = narrow(b->off.keep + i);
    g.kick[v] = narrow(b->off.kick + i);
  }
  const float *cosine = s->cosine;
  for (int k = 0; k < s->steps; k++, cosine += s->stages) {
    for (int i = 0; i < s->stages; i++) stage(count, s, i, cosine[i], &g);
    end_step(count, s, &g);
    carry(count, s, &g);
  }
  EACH
  {
    const size_t i = lane + (size_t)v * LANES;
    widen(b->y + i, g.y[v]);
    widen(b->w + i, g.w[v]);
    widen(b->off.yy + i, g.yy[v]);
    widen(b->off.yw + i, g.yw[v]);
    widen(b->off.ww + i, g.ww[v]);
  }
}

#if defined(__AVX512F__)
/* The last 8 lanes, where a vector has 16: with as many at rest beside them. */
static void run_half(const pendres_float_steps *s, const pendres_float_lanes *b, size_t lane)
{
  enum { NUMBERS = 11, CHANGED = 5 };
  double room[NUMBERS][LANES] __attribute__((aligned(64))) = {{0.0}};
  double *const own[CHANGED] = {b->y, b->w, b->off.yy, b->off.yw, b->off.ww};
  const double *const given[NUMBERS - CHANGED] = {b->k.stiffness, b->k.drive, b->k.friction,
                                                  b->off.added,   b->off.keep, b->off.kick};
  for (int i = 0; i < NUMBERS; i++)
    memcpy(room[i], (i < CHANGED ? own[i] : given[i - CHANGED]) + lane, UNIT * sizeof(double));
  const pendres_float_lanes alone = {
    .lanes = LANES, .y = room[0], .w = room[1],
    .k = {.stiffness = room[5], .drive = room[6], .friction = room[7]},
    .off = {room[2], room[3], room[4], room[8], room[9], room[10]}};
  run_group(1, s, &alone, 0);
  for (int i = 0; i < CHANGED; i++) memcpy(own[i] + lane, room[i], UNIT * sizeof(double));
}
#endif

static void run(const pendres_float_steps *s, const pendres_float_lanes *b)
{
  size_t lane = 0;
  for (; lane + GROUP * LANES <= b->lanes; lane += GROUP * LANES) run_group(GROUP, s, b, lane);
  for (; lane + 2 * LANES <= b->lanes; lane += 2 * LANES) run_group(2, s, b, lane);
  for (; lane + LANES <= b->lanes; lane += LANES) run_group(1, s, b, lane);
#if defined(__AVX512F__)
  if (lane < b->lanes) run_half(s, b, lane);
#endif
}

const pendres_kernels_float PENDRES_INSTRUCTIONS_OWN(pendres_kernels_float) = {run};
