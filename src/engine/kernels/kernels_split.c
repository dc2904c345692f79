/* kernels_split.c -- a period by exact free motion and kicks; see kernels_split.h. */
#include "engine/kernels/kernels_split.h"

#include "base/angles.h"
#include "base/instructions.h"
#include "engine/kernels/kernels_force.h"

#define FMA(a, b, c) __builtin_fma((a), (b), (c))

/* Lanes that go through a period together: enough vectors for one kick's operations not to wait
   for each other, and few enough for the nearest cache. */
enum { STRIP = 32, UNIT = 8 };

/* Free motion: to a step's first kick, between its kicks, and on to the next step's first; and its
   kicks. */
enum { EDGE, INNER, BETWEEN, DURATIONS };
enum { OUTER, MIDDLE };

/* Some lanes, in the shaken frame, and what a step does to them. */
typedef struct strip {
  double u[STRIP], w[STRIP], a[STRIP], b[STRIP]; /* states, and tangents (a, b) */
  double reach[DURATIONS][STRIP], decay[DURATIONS][STRIP]; /* of free motion */
  double pivot_cos[STRIP], pivot_sin[STRIP];     /* y = u + pivot */
  double push[2][STRIP], bend[2][STRIP];         /* a kick is -push f (1 - bend f') */
  double torque[STRIP];                          /* over the stiffness */
} strip;

#define LANES _Pragma("omp simd") for (size_t i = 0; i < count; i++)
#define INLINE static inline __attribute__((always_inline))

/* (1 - exp(-x)) / x to rounding, for |x| < 2. */
INLINE double mean_decay(double x)
{
  enum { TERMS = 24 };
  double sum = 1.0;
#pragma GCC unroll 24
  for (int k = TERMS; k > 1; k--) sum = FMA(-x * (1.0 / k), sum, 1.0);
  return sum;
}

/* A force, and its first two derivatives by y. */
typedef struct spring {
  double f, by_y, twice;
} spring;

/* The force f (1 + b cos theta) - I, without the stiffness. */
INLINE spring spring_at(pendres_model_terms model, const pendres_coefficients *k, double torque,
                        size_t i, double y, double cosine)
{
  double f, by_y;
  pendres_kernels_force(model, k->power, i, y, &f, &by_y);
  const double twice = pendres_kernels_curvature(model, k->power, i, y, f);
  if (model == PENDRES_MODEL_PLAIN) return (spring){f, by_y, twice};
  const double drive = FMA(k->modulation[i], cosine, 1.0);
  return (spring){FMA(f, drive, -torque), by_y * drive, twice * drive};
}

INLINE void drift(size_t count, int length, int tangents, strip *s)
{
  LANES
  {
    s->u[i] = FMA(s->reach[length][i], s->w[i], s->u[i]);
    s->w[i] *= s->decay[length][i];
    if (!tangents) continue;
    s->a[i] = FMA(s->reach[length][i], s->b[i], s->a[i]);
    s->b[i] *= s->decay[length][i];
  }
}

/* A kick: which of them, the cosine and sine of the drive's phase, and the free motion after it. */
typedef struct moment {
  int which, length;
  double cosine, sine;
} moment;

INLINE void kick(pendres_model_terms model, size_t count, int tangents,
                 const pendres_coefficients *k, moment m, strip *s)
{
  LANES
  {
    const double y = s->u[i] + FMA(s->pivot_cos[i], m.cosine, s->pivot_sin[i] * m.sine);
    const spring at = spring_at(model, k, s->torque[i], i, y, m.cosine);
    const double push = s->push[m.which][i], bend = s->bend[m.which][i];
    const double less = FMA(-bend, at.by_y, 1.0), w = FMA(-push * at.f, less, s->w[i]);
    s->u[i] = FMA(s->reach[m.length][i], w, s->u[i]);
    s->w[i] = w * s->decay[m.length][i];
    if (!tangents) continue;
    const double spring_here = FMA(at.by_y, less, -(bend * at.f * at.twice));
    const double b = FMA(-push * spring_here, s->a[i], s->b[i]);
    s->a[i] = FMA(s->reach[m.length][i], b, s->a[i]);
    s->b[i] = b * s->decay[m.length][i];
  }
}

/* What a step does to the lanes, from their coefficients. */
INLINE void prepare(pendres_model_terms model, size_t count, double step,
                    const pendres_coefficients *k, strip *s)
{
  const double edge = pendres_split_a * step, inner = 0.5 * step - edge;
  const double time[DURATIONS] = {[EDGE] = edge, [INNER] = inner, [BETWEEN] = 2.0 * edge};
  const double share[2] = {[OUTER] = pendres_split_b, [MIDDLE] = 1.0 - 2.0 * pendres_split_b};
  for (int d = 0; d < DURATIONS; d++)
    LANES
    {
      s->reach[d][i] = time[d] * mean_decay(time[d] * k->friction[i]);
      s->decay[d][i] = FMA(-k->friction[i], s->reach[d][i], 1.0);
    }
  for (int d = OUTER; d <= MIDDLE; d++)
    LANES
    {
      s->push[d][i] = share[d] * step * k->stiffness[i];
      s->bend[d][i] = pendres_split_bend[d] * step * step * k->stiffness[i];
    }
  LANES
  {
    const double g = k->friction[i], reduced = k->drive[i] / FMA(g, g, 1.0);
    s->pivot_cos[i] = -reduced;
    s->pivot_sin[i] = reduced * g;
    s->torque[i] = 0.0;
    if (model != PENDRES_MODEL_PLAIN) s->torque[i] = k->torque[i] / k->stiffness[i];
  }
}

/* All lanes of a strip over a period. */
INLINE void run_strip(pendres_model_terms model, size_t count, int tangents,
                      const pendres_split_steps *t, const pendres_split_lanes *block, size_t lane)
{
  strip s;
  const double step = two_pi / t->steps;
  double *y = block->y + lane, *w = block->w + lane;
  pendres_coefficients k = {.stiffness = block->k.stiffness + lane, .drive = block->k.drive + lane,
                            .friction = block->k.friction + lane};
  if (model != PENDRES_MODEL_PLAIN) {
    k.torque = block->k.torque + lane;
    k.modulation = block->k.modulation + lane;
    for (int c = 0; c < PENDRES_FORCE_COEFFICIENTS; c++) k.power[c] = block->k.power[c] + lane;
  }
  prepare(model, count, step, &k, &s);
  LANES
  {
    s.u[i] = y[i] - s.pivot_cos[i];
    s.w[i] = w[i] - s.pivot_sin[i];
    if (!tangents) continue;
    s.a[i] = block->tangent_y[lane + i];
    s.b[i] = FMA(-0.5 * k.friction[i], s.a[i], block->tangent_w[lane + i]);
  }
  drift(count, EDGE, tangents, &s);
  const double *cosine = t->cosine, *sine = t->sine;
  for (int n = 1; n <= t->steps; n++, cosine += PENDRES_SPLIT_KICKS, sine += PENDRES_SPLIT_KICKS) {
    const int last = n < t->steps ? BETWEEN : EDGE;
    kick(model, count, tangents, &k, (moment){OUTER, INNER, cosine[0], sine[0]}, &s);
    kick(model, count, tangents, &k, (moment){MIDDLE, INNER, cosine[1], sine[1]}, &s);
    kick(model, count, tangents, &k, (moment){OUTER, last, cosine[2], sine[2]}, &s);
  }
  LANES
  {
    y[i] = s.u[i] + s.pivot_cos[i];
    w[i] = s.w[i] + s.pivot_sin[i];
    if (!tangents) continue;
    block->tangent_y[lane + i] = s.a[i];
    block->tangent_w[lane + i] = FMA(0.5 * k.friction[i], s.a[i], s.b[i]);
  }
}

#define RUN_STRIP(MODEL, COUNT, TANGENTS)                                                  \
  static void strip_##MODEL##_##COUNT##_##TANGENTS(const pendres_split_steps *t,           \
                                                   const pendres_split_lanes *b, size_t lane) \
  {                                                                                        \
    run_strip(PENDRES_MODEL_##MODEL, COUNT, TANGENTS, t, b, lane);                         \
  }
#define RUN_MODEL(MODEL, name)  \
  RUN_STRIP(MODEL, 8, 0)        \
  RUN_STRIP(MODEL, 8, 1)        \
  RUN_STRIP(MODEL, 32, 0)       \
  RUN_STRIP(MODEL, 32, 1)
RUN_MODEL(PLAIN, plain)
RUN_MODEL(PENDULUM, pendulum)
RUN_MODEL(POLYNOMIAL, polynomial)
PENDRES_FORCE_LIST(RUN_MODEL)

typedef void run_some(const pendres_split_steps *, const pendres_split_lanes *, size_t);
#define OF_MODEL(MODEL, name)                                       \
  [PENDRES_MODEL_##MODEL] = {{strip_##MODEL##_8_0, strip_##MODEL##_32_0}, \
                             {strip_##MODEL##_8_1, strip_##MODEL##_32_1}},
static run_some *const strips[PENDRES_MODEL_COUNT][2][2] = {
  OF_MODEL(PLAIN, plain) OF_MODEL(PENDULUM, pendulum) OF_MODEL(POLYNOMIAL, polynomial)
  PENDRES_FORCE_LIST(OF_MODEL)};

static void run(const pendres_split_steps *s, const pendres_split_lanes *b)
{
  run_some *const *of = strips[b->model][b->tangent_y != NULL];
  size_t lane = 0;
  for (; lane + STRIP <= b->lanes; lane += STRIP) of[1](s, b, lane);
  for (; lane < b->lanes; lane += UNIT) of[0](s, b, lane);
}

const pendres_kernels_split PENDRES_INSTRUCTIONS_OWN(pendres_kernels_split) = {run};
