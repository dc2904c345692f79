/* kernels_fixture.h -- what the tests of the inner loops share: random numbers in all vectors. */
#ifndef KERNELS_FIXTURE_H
#define KERNELS_FIXTURE_H

#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "engine/kernels/kernels.h"
#include "engine/sundials/lanes.h"

enum { MOST_LANES = 96, VECTORS = 6, TANGENTS = 5, SIZE = PENDRES_ROWS_ALL * MOST_LANES };

/* Those that this processor runs; the first is the plainest. */
static inline size_t available(const pendres_kernels *list[3])
{
  size_t n = 0;
  list[n++] = &pendres_kernels_base;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    list[n++] = &pendres_kernels_avx2;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    list[n++] = &pendres_kernels_avx512;
#endif
  return n;
}

static uint64_t random_state;

static inline double uniform(double from, double to)
{
  random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return from + (to - from) * ((double)(random_state >> 11) * 0x1p-53);
}

/* Some vectors of all rows, one lane after the other within a row, and the equation's numbers. */
typedef struct bench {
  double *vector[VECTORS], *stiffness, *drive, *friction, *inverse, *torque, *modulation;
  double *nonlinear, *quadratic, *cubic;
  double *power[PENDRES_FORCE_POWERS];
  double *tangent[TANGENTS]; /* their y, y, w, w, and what is kept of them */
  pendres_sum sum[3];
} bench;

static inline void close_bench(bench *b)
{
  double *const one[] = {b->stiffness, b->drive, b->friction, b->inverse, b->torque, b->modulation,
                         b->nonlinear, b->quadratic, b->cubic};
  for (size_t i = 0; i < sizeof one / sizeof *one; i++) free(one[i]);
  for (int i = 0; i < VECTORS; i++) free(b->vector[i]);
  for (int i = 0; i < TANGENTS; i++) free(b->tangent[i]);
  for (int i = 0; i < PENDRES_FORCE_POWERS; i++) free(b->power[i]);
}

static inline double *random_lanes(size_t n, double from, double to)
{
  double *x = pendres_lanes_allocate(n);
  assert_non_null(x);
  for (size_t i = 0; i < n; i++) x[i] = uniform(from, to);
  return x;
}

/* What other models have; powers weigh so little that none overflows in program(). */
static inline void open_terms(bench *b)
{
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++)
    b->power[k] = random_lanes(MOST_LANES, -pow(0.01, k), pow(0.01, k));
  b->torque = random_lanes(MOST_LANES, -1.0, 1.0);
  b->modulation = random_lanes(MOST_LANES, -2.0, 2.0);
  b->nonlinear = random_lanes(MOST_LANES, 0.0, 0.02);
  b->quadratic = random_lanes(MOST_LANES, 0.0, 0.1);
  b->cubic = random_lanes(MOST_LANES, 0.0, 0.01);
}

static inline void open_bench(bench *b, uint64_t seed)
{
  random_state = seed;
  for (int i = 0; i < VECTORS; i++) b->vector[i] = random_lanes(SIZE, -4.0, 4.0);
  b->inverse = random_lanes(MOST_LANES, 1.0 / 3.0, 5.0);
  b->stiffness = random_lanes(MOST_LANES, 1.0, 1.0);
  b->drive = random_lanes(MOST_LANES, 0.0, 1.0);
  b->friction = random_lanes(MOST_LANES, 0.0, 2.0);
  for (int i = 0; i < MOST_LANES; i++) {
    b->stiffness[i] = b->inverse[i] * b->inverse[i];
    b->drive[i] *= b->stiffness[i];
    b->friction[i] *= b->inverse[i];
  }
  for (int i = 0; i < TANGENTS; i++) b->tangent[i] = random_lanes(MOST_LANES, 0.1, 1.0);
  for (int s = 0; s < 3; s++) {
    pendres_sum *q = &b->sum[s];
    q->terms = 1 + (int)uniform(0.0, PENDRES_KERNELS_TERMS);
    q->z = b->vector[s];
    for (int j = 0; j < q->terms; j++) {
      q->term[j].c = uniform(-1.0, 1.0);
      q->term[j].x = b->vector[(s + j) % VECTORS]; /* its own z among them */
    }
  }
  open_terms(b);
}

/* All kinds of operations; vectors are read after they were written, and sums into themselves. */
static inline size_t program(const bench *b, pendres_operation o[12])
{
  double *const *v = b->vector;
  size_t n = 0;
  o[n++] = (pendres_operation){.sum = &b->sum[0], .to = v[0]};
  o[n++] = (pendres_operation){.from = v[0], .slope = v[3], .cos_theta = 0.3};
  o[n++] = (pendres_operation){.sum = &b->sum[1], .to = v[1], .slope = v[4], .cos_theta = -0.7,
                               .keep = 1};
  o[n++] = (pendres_operation){.from = v[4], .to = v[5]};
  o[n++] = (pendres_operation){0};
  o[n++] = (pendres_operation){.sum = &b->sum[2], .to = v[2], .slope = v[3], .cos_theta = 0.9};
  o[n++] = (pendres_operation){.sum = &b->sum[2], .to = v[2], .slope = v[4], .cos_theta = 0.1,
                               .keep = 1};
  o[n++] = (pendres_operation){.to = v[0]};
  o[n++] = (pendres_operation){.from = v[2], .carry = 0.2, .cos_theta = 0.4};
  o[n++] = (pendres_operation){.from = v[5], .carry = 0.2, .cos_theta = 0.5, .second = 1};
  return n;
}

/* Equations: rows of each model. */
typedef struct equation {
  size_t rows;
  pendres_model_terms model;
  int drags;
} equation;

/* All that there are, model after model. */
#define OF_ALL(CODE, name) {PENDRES_ROWS_STATE, PENDRES_MODEL_##CODE}, \
  {PENDRES_ROWS_VARIATIONAL, PENDRES_MODEL_##CODE}, \
  {PENDRES_ROWS_SENSITIVITY, PENDRES_MODEL_##CODE},
#define OF_OWN(CODE, name) OF_ALL(CODE, name) {PENDRES_ROWS_DRIVES, PENDRES_MODEL_##CODE}, \
  {PENDRES_ROWS_FORCE, PENDRES_MODEL_##CODE}, {PENDRES_ROWS_ALL, PENDRES_MODEL_##CODE},
#define OF_DRAG(CODE) {PENDRES_ROWS_STATE, PENDRES_MODEL_##CODE, 1}, \
  {PENDRES_ROWS_VARIATIONAL, PENDRES_MODEL_##CODE, 1}, \
  {PENDRES_ROWS_SENSITIVITY, PENDRES_MODEL_##CODE, 1}, \
  {PENDRES_ROWS_DRIVES, PENDRES_MODEL_##CODE, 1}, {PENDRES_ROWS_ALL, PENDRES_MODEL_##CODE, 1},
static const equation equations[] = {OF_ALL(PLAIN, ) OF_ALL(PENDULUM, ) OF_OWN(POLYNOMIAL, )
                                     PENDRES_FORCE_LIST(OF_OWN)
                                     {PENDRES_ROWS_DRIVES, PENDRES_MODEL_PENDULUM},
                                     OF_DRAG(PENDULUM) OF_DRAG(POLYNOMIAL)};
enum { EQUATIONS = sizeof equations / sizeof *equations };

static inline pendres_strip strip_of(const bench *b, equation e, size_t lane, size_t lanes)
{
  pendres_strip s = {
    .lanes = lanes,
    .model = e.model,
    .drags = e.drags,
    .at = e.rows * lane,
    .k = {b->stiffness + lane, b->drive + lane, b->friction + lane, b->inverse + lane,
          b->torque + lane, b->modulation + lane, b->nonlinear + lane, b->quadratic + lane,
          b->cubic + lane, {NULL}},
    .tangent = {.keep = b->tangent[4] + lane}};
  for (int i = 0; i < 2; i++) s.tangent.y[i] = b->tangent[i] + lane;
  for (int i = 0; i < 2; i++) s.tangent.w[i] = b->tangent[2 + i] + lane;
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++) s.k.power[k] = b->power[k] + lane;
  return s;
}

#endif
