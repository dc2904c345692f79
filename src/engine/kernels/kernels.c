/*
 * kernels.c -- the inner loops over lanes; see kernels.h.
 *
 * Compiled once per instruction set with PENDRES_KERNELS set to its name. What costs most, a
 * stage of the state alone, is written out in vectors (kernels_vector.h): sum and slope of up
 * to eight of them stay in registers. The rest are plain loops that the compiler vectorises.
 * No operation depends on the width of a vector.
 */
#include "engine/kernels/kernels.h"

#include <string.h>

#include "base/instructions.h"
#include "engine/kernels/kernels_carry.h"
#include "engine/kernels/kernels_drag.h"
#include "engine/kernels/kernels_force.h"
#include "engine/kernels/kernels_vector.h"

typedef pendres_vector vec;
enum { LANES = PENDRES_VECTOR_LANES, GROUP = PENDRES_VECTOR_GROUP };
/* Vectors of 8 lanes, what every strip is a multiple of. */
enum { REST = 8 / LANES };

PENDRES_VECTOR_INLINE void copy_vectors(int count, const double *from, double *to)
{
  PENDRES_VECTOR_EACH pendres_vector_store(to + v * LANES, pendres_vector_load(from + v * LANES));
}

/*
 * Sums that are in registers at the same time: with AVX2 the rows of 8 lanes with derivatives are
 * this many vectors; with 2 lanes to a vector they are two and four times as many, with AVX-512
 * half as many. With fewer sums at a time, each operation would wait for the one before.
 */
enum { SUMMED = 12 };

/* Sums of `count` vectors from `at` on, all in registers at once. */
PENDRES_VECTOR_INLINE void sum_vectors(int count, const pendres_sum *q, size_t at)
{
  vec sum[SUMMED];
  const double *p = pendres_vector_address(q->term[0].x, at);
  vec f = pendres_vector_set(q->term[0].c);
  PENDRES_VECTOR_EACH sum[v] = f * pendres_vector_load(p + v * LANES);
  for (int j = 1; j < q->terms; j++) {
    p = pendres_vector_address(q->term[j].x, at);
    f = pendres_vector_set(q->term[j].c);
    PENDRES_VECTOR_EACH sum[v] = pendres_vector_fma(f, pendres_vector_load(p + v * LANES), sum[v]);
  }
  PENDRES_VECTOR_EACH pendres_vector_store(q->z + at + v * LANES, sum[v]);
}

static void sum(const pendres_sum *q, size_t at, size_t n)
{
  const size_t end = at + n;
  for (; at + SUMMED * LANES <= end; at += SUMMED * LANES) sum_vectors(SUMMED, q, at);
  for (; at + 4 * LANES <= end; at += 4 * LANES) sum_vectors(4, q, at);
  for (; at < end; at += 2 * LANES) sum_vectors(2, q, at); /* there are two rows or more */
}

/*
 * The slope of w of `count` vectors, y[v] being their force and w the slope of y, which stands
 * there. It is read again: in registers it would push out what the force needs.
 */
PENDRES_VECTOR_INLINE void push(pendres_model_terms model, int count, const pendres_strip *s,
                                size_t lane, const pendres_operation *o, vec *y)
{
  const pendres_coefficients *k = &s->k;
  const double *stiffness = k->stiffness + lane, *drive = k->drive + lane;
  const double *friction = k->friction + lane, *w = o->slope + s->at + lane;
  const vec f = pendres_vector_set(o->cos_theta);
  if (model != PENDRES_MODEL_PLAIN) {
    const vec one = pendres_vector_set(1.0);
    PENDRES_VECTOR_EACH
    {
      const vec b = pendres_vector_load(k->modulation + lane + v * LANES);
      y[v] = y[v] * pendres_vector_fma(b, f, one);
    }
  }
  PENDRES_VECTOR_EACH
  {
    const size_t i = v * LANES;
    const vec drag = pendres_vector_load(friction + i) * pendres_vector_load(w + i);
    vec rest = -drag;
    if (model != PENDRES_MODEL_PLAIN) rest = pendres_vector_load(k->torque + lane + i) - drag;
    const vec force = pendres_vector_fma(pendres_vector_load(drive + i), f, rest);
    y[v] = pendres_vector_fma(-pendres_vector_load(stiffness + i), y[v], force);
  }
  double *slope = o->slope + s->at + s->lanes + lane;
  PENDRES_VECTOR_EACH pendres_vector_store(slope + v * LANES, y[v]);
}

/* The same, y given and used up. */
PENDRES_VECTOR_INLINE void accelerate(pendres_model_terms model, int count, const pendres_strip *s,
                                      size_t lane, const pendres_operation *o, vec *y)
{
  pendres_kernels_forces(model, count, s->k.power, lane, y);
  push(model, count, s, lane, o, y);
}

/* The sums of a stage of `count` vectors of a strip from `lane` on: y, and w as the slope of y. */
PENDRES_VECTOR_INLINE void stage_sums(int count, const pendres_strip *s, size_t lane,
                                      const pendres_operation *o, int keep, vec *y)
{
  vec w[GROUP];
  const pendres_sum *q = o->sum;
  const size_t at_y = s->at + lane, at_w = at_y + s->lanes;
  const double *py = pendres_vector_address(q->term[0].x, at_y);
  const double *pw = pendres_vector_address(q->term[0].x, at_w);
  vec f = pendres_vector_set(q->term[0].c);

  PENDRES_VECTOR_EACH y[v] = f * pendres_vector_load(py + v * LANES);
  PENDRES_VECTOR_EACH w[v] = f * pendres_vector_load(pw + v * LANES);
  for (int j = 1; j < q->terms; j++) {
    py = pendres_vector_address(q->term[j].x, at_y);
    pw = pendres_vector_address(q->term[j].x, at_w);
    f = pendres_vector_set(q->term[j].c);
    PENDRES_VECTOR_EACH y[v] = pendres_vector_fma(f, pendres_vector_load(py + v * LANES), y[v]);
    PENDRES_VECTOR_EACH w[v] = pendres_vector_fma(f, pendres_vector_load(pw + v * LANES), w[v]);
  }
  if (keep) {
    PENDRES_VECTOR_EACH pendres_vector_store(q->z + at_y + v * LANES, y[v]);
    PENDRES_VECTOR_EACH pendres_vector_store(q->z + at_w + v * LANES, w[v]);
  }
  PENDRES_VECTOR_EACH pendres_vector_store(o->slope + at_y + v * LANES, w[v]);
}

/* A stage of `count` vectors of a strip from `lane` on: the sum, and the slope at it. */
PENDRES_VECTOR_INLINE void stage_vectors(pendres_model_terms model, int count,
                                         const pendres_strip *s, size_t lane,
                                         const pendres_operation *o, int keep)
{
  vec y[GROUP];
  stage_sums(count, s, lane, o, keep, y);
  accelerate(model, count, s, lane, o, y);
}

PENDRES_VECTOR_INLINE void slope_vectors(pendres_model_terms model, int count,
                                         const pendres_strip *s, size_t lane,
                                         const pendres_operation *o)
{
  vec y[GROUP];
  const size_t at_y = s->at + lane, at_w = at_y + s->lanes;

  PENDRES_VECTOR_EACH y[v] = pendres_vector_load(o->from + at_y + v * LANES);
  copy_vectors(count, o->from + at_w, o->slope + at_y);
  accelerate(model, count, s, lane, o, y);
}

/* The forces on a lane, and the factors by which an error of y and one of w enter them. */
typedef struct felt {
  double slope, spring, drag;
  double force; /* f (1 + b cos theta) */
  double bare;  /* f */
  double modulation; /* 1 + b cos theta */
} felt;

PENDRES_VECTOR_INLINE felt feel(pendres_model_terms model, const pendres_coefficients *k, size_t i,
                                double cos_theta, double y, double w)
{
  const double drag = k->friction[i] * w;
  felt a = {.drag = -k->friction[i], .modulation = 1.0};
  double by_y;
  pendres_kernels_force(model, pendres_kernels_source(model, k), i, y, &a.bare, &by_y);
  a.force = a.bare;
  double rest = -drag;
  if (model != PENDRES_MODEL_PLAIN) {
    a.modulation = FMA(k->modulation[i], cos_theta, 1.0);
    a.force = a.bare * a.modulation;
    by_y *= a.modulation;
    rest = k->torque[i] - drag;
  }
  a.slope = FMA(-k->stiffness[i], a.force, FMA(k->drive[i], cos_theta, rest));
  a.spring = -k->stiffness[i] * by_y;
  return a;
}

/* Slopes of lane i's state and of its derivatives by the initial state. stride: lanes, the distance
   between two rows. */
PENDRES_VECTOR_INLINE void vary(const felt *a, size_t stride, size_t i, const double *s, double *d)
{
  d[i] = s[stride + i];
  d[stride + i] = a->slope;
  d[2 * stride + i] = s[3 * stride + i];
  d[3 * stride + i] = FMA(a->spring, s[2 * stride + i], a->drag * s[3 * stride + i]);
  d[4 * stride + i] = s[5 * stride + i];
  d[5 * stride + i] = FMA(a->spring, s[4 * stride + i], a->drag * s[5 * stride + i]);
}

PENDRES_VECTOR_INLINE void rhs_variational(pendres_model_terms model, size_t stride,
                                           const pendres_coefficients *coefficients,
                                           double cos_theta, const double *restrict s,
                                           double *restrict d)
{
  const pendres_coefficients k = *coefficients;
#pragma omp simd
  for (size_t i = 0; i < stride; i++) {
    const felt a = feel(model, &k, i, cos_theta, s[i], s[stride + i]);
    vary(&a, stride, i, s, d);
  }
}

/* The pair of rows from `row` on: derivatives by a parameter by which w's slope changes by `by`. */
PENDRES_VECTOR_INLINE void derive(const felt *a, double by, int row, size_t stride, size_t i,
                                  const double *s, double *d)
{
  const size_t of_y = (size_t)row * stride + i, of_w = of_y + stride;
  d[of_y] = s[of_w];
  d[of_w] = FMA(a->spring, s[of_y], FMA(a->drag, s[of_w], by));
}

PENDRES_VECTOR_INLINE void rhs_sensitivity(pendres_model_terms model, size_t stride,
                                           const pendres_coefficients *coefficients,
                                           double cos_theta, const double *restrict s,
                                           double *restrict d)
{
  const pendres_coefficients k = *coefficients;
#pragma omp simd
  for (size_t i = 0; i < stride; i++) {
    const double w = s[stride + i];
    const felt a = feel(model, &k, i, cos_theta, s[i], w);
    vary(&a, stride, i, s, d);
    /* d/domega of the slope at fixed state:
       (2 (stiffness f - drive cos - torque) + friction w)/omega */
    const double push = k.drive[i] * cos_theta;
    const double held = model == PENDRES_MODEL_PLAIN ? push : push + k.torque[i];
    const double by_frequency =
      k.inverse[i] * FMA(2.0, FMA(k.stiffness[i], a.force, -held), k.friction[i] * w);
    const double by_damping = -k.inverse[i] * w;
    const double by_amplitude = k.stiffness[i] * cos_theta;
    derive(&a, by_frequency, PENDRES_ROW_BY_OMEGA, stride, i, s, d);
    derive(&a, by_damping, PENDRES_ROW_BY_GAMMA, stride, i, s, d);
    derive(&a, by_amplitude, PENDRES_ROW_BY_DRIVE, stride, i, s, d);
  }
}

/* The rows beyond rhs_sensitivity(): by torque, parametric drive and coefficients of the force. */
PENDRES_VECTOR_INLINE void rhs_terms(pendres_model_terms model, size_t rows, size_t stride,
                                     const pendres_coefficients *coefficients, double cos_theta,
                                     const double *restrict s, double *restrict d)
{
  const pendres_coefficients k = *coefficients;
#pragma omp simd
  for (size_t i = 0; i < stride; i++) {
    const double y = s[i];
    const felt a = feel(model, &k, i, cos_theta, y, s[stride + i]);
    const double strength = -k.stiffness[i] * a.modulation;
    derive(&a, k.stiffness[i], PENDRES_ROW_BY_TORQUE, stride, i, s, d);
    derive(&a, -k.stiffness[i] * a.bare * cos_theta, PENDRES_ROW_BY_MODULATION, stride, i,
           s, d);
    if (rows < PENDRES_ROWS_FORCE) continue;
    double by = model >= PENDRES_MODEL_POLYNOMIAL ? strength * y : 0.0, own[PENDRES_FORCE_POWERS];
    for (int p = 0; p < PENDRES_FORCE_POWERS; p++) own[p] = k.power[p][i];
#pragma GCC unroll 8
    for (int p = 0; p < PENDRES_FORCE_POWERS; p++) {
      if (model == PENDRES_MODEL_FORMULA)
        by = strength * k.value[FORMULA_OUT_BY + p][i];
      else if (model > PENDRES_MODEL_POLYNOMIAL)
        by = strength * pendres_forces_by(PENDRES_MODEL_FORCE(model), own, y, p);
      derive(&a, by, PENDRES_ROW_BY_POWERS + 2 * p, stride, i, s, d);
      by *= y;
    }
    if (rows < PENDRES_ROWS_ALL) continue;
    for (int row = PENDRES_ROWS_FORCE; row < PENDRES_ROWS_ALL; row += 2)
      derive(&a, 0.0, row, stride, i, s, d);
  }
}

/* What is neither sum nor slope, of n elements from `at` on. */
static void set(const pendres_operation *o, size_t at, size_t n)
{
  if (o->to == NULL) return;
  if (o->from == NULL) {
    memset(o->to + at, 0, n * sizeof(double));
    return;
  }
  const size_t end = at + n;
  for (; at + 8 * LANES <= end; at += 8 * LANES) copy_vectors(8, o->from + at, o->to + at);
  for (; at < end; at += LANES) copy_vectors(1, o->from + at, o->to + at);
}

/*
 * All operations on a strip of a state, `count` vectors at once; a strip of exactly that many is
 * one group. Comparisons and not a switch: its indirect jump costs a tenth of the time where
 * processors may not speculate over one.
 */
PENDRES_VECTOR_INLINE void run_state(pendres_model_terms model, int count, const pendres_strip *s,
                                     const pendres_operation *o, size_t n)
{
  const size_t step = (size_t)count * LANES, size = PENDRES_ROWS_STATE * s->lanes;
  for (const pendres_operation *end = o + n; o < end; o++) {
    size_t lane = 0;
    if (o->sum != NULL && o->slope != NULL) {
      if (o->keep || s->drags) {
        for (; lane + step <= s->lanes; lane += step) stage_vectors(model, count, s, lane, o, 1);
        for (; lane < s->lanes; lane += REST * LANES) stage_vectors(model, REST, s, lane, o, 1);
      } else {
        for (; lane + step <= s->lanes; lane += step) stage_vectors(model, count, s, lane, o, 0);
        for (; lane < s->lanes; lane += REST * LANES) stage_vectors(model, REST, s, lane, o, 0);
      }
      if (model != PENDRES_MODEL_PLAIN && s->drags) resist(s, o->sum->z, o->slope);
    } else if (o->sum != NULL) {
      sum(o->sum, s->at, size);
    } else if (o->slope != NULL) {
      for (; lane + step <= s->lanes; lane += step) slope_vectors(model, count, s, lane, o);
      for (; lane < s->lanes; lane += REST * LANES) slope_vectors(model, REST, s, lane, o);
      if (model != PENDRES_MODEL_PLAIN && s->drags) resist(s, o->from, o->slope);
    } else if (o->carry != 0.0) {
      if (model != PENDRES_MODEL_PLAIN && s->drags)
        carry_dragged(model, s, o);
      else if (s->off.yy != NULL)
        carry(model, 0, s, o);
      else if (o->second)
        turn(model, 1, 0, s, o);
      else
        turn(model, 0, 0, s, o);
    } else {
      set(o, s->at, size);
    }
  }
}

#define RUN_STATE(MODEL, COUNT)                                                     \
  static void run_state_##MODEL##_##COUNT(const pendres_strip *s, const pendres_operation *o, \
                                          size_t n)                                 \
  {                                                                                 \
    run_state(PENDRES_MODEL_##MODEL, COUNT, s, o, n);                               \
  }
#if defined(__AVX512F__)
RUN_STATE(PLAIN, 1)
RUN_STATE(PLAIN, 2)
RUN_STATE(PLAIN, 3)
RUN_STATE(PLAIN, 5)
RUN_STATE(PLAIN, 6)
RUN_STATE(PLAIN, 7)
RUN_STATE(PLAIN, 8)
RUN_STATE(PLAIN, 9)
RUN_STATE(PLAIN, 10)
#endif
RUN_STATE(PLAIN, 4)
RUN_STATE(PENDULUM, 4)
RUN_STATE(POLYNOMIAL, 4)
#define RUN_STATE_4(CODE, name) RUN_STATE(CODE, 4)
PENDRES_FORCE_LIST(RUN_STATE_4)

/* The same for the other equations. */
PENDRES_VECTOR_INLINE void run_rows(pendres_model_terms model, size_t rows, const pendres_strip *s,
                                    const pendres_operation *o, size_t n,
                                    pendres_kernels_formula *formula)
{
  const size_t size = rows * s->lanes;
  for (const pendres_operation *end = o + n; o < end; o++) {
    const double *from = o->sum != NULL ? o->sum->z : o->from;
    if (o->sum != NULL) sum(o->sum, s->at, size);
    if (model == PENDRES_MODEL_FORMULA && o->slope != NULL)
      pendres_kernels_formula_at(formula, s->lanes, from + s->at);
    if (o->slope != NULL && rows == PENDRES_ROWS_VARIATIONAL)
      rhs_variational(model, s->lanes, &s->k, o->cos_theta, from + s->at, o->slope + s->at);
    else if (o->slope != NULL)
      rhs_sensitivity(model, s->lanes, &s->k, o->cos_theta, from + s->at, o->slope + s->at);
    else if (o->sum == NULL)
      set(o, s->at, size);
    if (model == PENDRES_MODEL_PLAIN || o->slope == NULL) continue;
    if (rows == PENDRES_ROWS_DRIVES)
      rhs_terms(model, PENDRES_ROWS_DRIVES, s->lanes, &s->k, o->cos_theta, from + s->at,
                o->slope + s->at);
    else if (model >= PENDRES_MODEL_POLYNOMIAL && rows == PENDRES_ROWS_FORCE)
      rhs_terms(model, PENDRES_ROWS_FORCE, s->lanes, &s->k, o->cos_theta, from + s->at,
                o->slope + s->at);
    else if (rows == PENDRES_ROWS_ALL)
      rhs_terms(model, PENDRES_ROWS_ALL, s->lanes, &s->k, o->cos_theta, from + s->at,
                o->slope + s->at);
    if (s->drags) resist(s, from, o->slope);
    resist_rows(rows, s, from, o->slope);
  }
}

#define RUN_ROWS(MODEL)                                                          \
  static void run_rows_##MODEL(size_t rows, const pendres_strip *s,              \
                               const pendres_operation *o, size_t n)             \
  {                                                                              \
    run_rows(PENDRES_MODEL_##MODEL, rows, s, o, n, NULL);                            \
  }
RUN_ROWS(PLAIN)
RUN_ROWS(PENDULUM)
RUN_ROWS(POLYNOMIAL)
#define RUN_ROWS_OWN(CODE, name) RUN_ROWS(CODE)
PENDRES_FORCE_LIST(RUN_ROWS_OWN)

#include "engine/kernels/kernels_strips.h"

/* Of forces beyond the pendulum's. */
#define OF_STATE(CODE, name) [PENDRES_MODEL_##CODE] = run_state_##CODE##_4,
#define OF_ROWS(CODE, name) [PENDRES_MODEL_##CODE] = run_rows_##CODE,
static void (*const states_of[PENDRES_MODEL_COUNT])(const pendres_strip *,
                                                    const pendres_operation *, size_t) = {
  OF_STATE(POLYNOMIAL, polynomial) PENDRES_FORCE_LIST(OF_STATE)};
static void (*const rows_of[PENDRES_MODEL_COUNT])(size_t, const pendres_strip *,
                                                  const pendres_operation *, size_t) = {
  OF_ROWS(POLYNOMIAL, polynomial) PENDRES_FORCE_LIST(OF_ROWS)};

static void run_states(const pendres_strip *s, const pendres_operation *o, size_t n)
{
  if (s->model >= PENDRES_MODEL_FORMULA) {
    run_state_formula(s, o, n);
    return;
  }
  if (s->model >= PENDRES_MODEL_POLYNOMIAL) {
    states_of[s->model](s, o, n);
    return;
  }
  if (s->model == PENDRES_MODEL_PENDULUM) {
    run_state_PENDULUM_4(s, o, n);
    return;
  }
#if defined(__AVX512F__)
  static void (*const states[GROUP])(const pendres_strip *, const pendres_operation *, size_t) = {
    run_state_PLAIN_1, run_state_PLAIN_2, run_state_PLAIN_3, run_state_PLAIN_4,
    run_state_PLAIN_5, run_state_PLAIN_6, run_state_PLAIN_7, run_state_PLAIN_8,
    run_state_PLAIN_9, run_state_PLAIN_10};
  const size_t vectors = s->lanes / LANES;
  states[(vectors < GROUP ? vectors : GROUP) - 1](s, o, n);
#else
  run_state_PLAIN_4(s, o, n);
#endif
}

static void run(size_t rows, const pendres_strip *s, const pendres_operation *o, size_t n)
{
  if (rows == PENDRES_ROWS_STATE)
    run_states(s, o, n);
  else if (s->model >= PENDRES_MODEL_FORMULA)
    run_rows_formula(rows, s, o, n);
  else if (s->model >= PENDRES_MODEL_POLYNOMIAL)
    rows_of[s->model](rows, s, o, n);
  else if (s->model == PENDRES_MODEL_PENDULUM || rows > PENDRES_ROWS_SENSITIVITY)
    run_rows_PENDULUM(rows, s, o, n);
  else
    run_rows_PLAIN(rows, s, o, n);
}

const pendres_kernels PENDRES_INSTRUCTIONS_OWN(pendres_kernels) = {PENDRES_INSTRUCTIONS_NAME, run};
