/*
 * langevin_block.c -- a block of noisy pendulums; see langevin_block.h.
 *
 * The generator of the motion is A + B. A is free motion with friction and drive,
 * v d/dx + (F0 cos theta - gamma v) d/dv + d/dt; B kicks by force and noise,
 * f d/dv + gamma T d^2/dv^2, where f is all other force: -sin y for a plain pendulum, else a torque
 * less some g(y) (1 + b cos theta). Chin's scheme 4B for a step h is
 *
 *     exp(a h A) exp(h/2 B') exp(h/sqrt 3 A) exp(h/2 B') exp(a h A),  a = (1 - 1/sqrt 3)/2,
 *     B' = B + h^2 (2 - sqrt 3)/24 [B, [A, B]].
 *
 * [B, [A, B]] = 2 f f' d/dv + 4 gamma T f' d^2/dv^2 with f' = df/dy; friction, drive and the time
 * in f do not contribute to it. B' is therefore a kick again, whose force is f (1 + c f') and whose
 * variance has the factor 1 + 2 c f', where c = h^2 (2 - sqrt 3)/12. Since 1 + 2 c f' = (1 + c
 * f')^2 to the order of the method, force and noise both take the factor 1 + c f', which is 1 - c
 * cos y for a plain pendulum.
 *
 * A is solved exactly. With y = u + pivot, pivot'' + gamma pivot' = F0 cos theta, u is free:
 * u += (1 - exp(-gamma t))/gamma w, w *= exp(-gamma t).
 *
 * Parameters that move are held constant during each step, at their values in its middle, and the
 * frame is changed between two steps. The error of this is of order two in the step, times the
 * change of the parameters within one. Steps are fractions of a turn of the drive, whose phase is
 * not affected.
 *
 * First harmonics are sums over the ends of steps, since between its kicks a step is accurate only
 * to order two. For a closed trajectory equally spaced samples over a period are accurate to any
 * order. One that does not close has a linear ramp besides, whose sum is known exactly and
 * corrected for.
 */
#include "noise/langevin_block.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "base/instructions.h"
#include "base/sine.h"
#include "model/formula/formula.h"
#include "noise/numbers.h"

static const double root_third = 0.57735026918962576451; /* 1/sqrt 3 */

enum { ROWS = 32, COEFFICIENTS = PENDRES_FORCE_POWERS };

const pendres_kernels_langevin *pendres_kernels_langevin_select(void)
{
  return PENDRES_INSTRUCTIONS_BEST(pendres_kernels_langevin);
}

/* Memory for n entries of eight bytes on a 64-byte boundary, all zero; n is a multiple of 8. */
static void *allocate(size_t n)
{
  void *memory = aligned_alloc(PENDRES_ALIGN, n * sizeof(double));
  if (memory != NULL) memset(memory, 0, n * sizeof(double));
  return memory;
}

pendres_status pendres_langevin_block_make(pendres_langevin_block *b, size_t capacity,
                                           uint64_t seed)
{
  b->kernels = pendres_kernels_langevin_select();
  b->capacity = capacity;
  b->key[0] = (uint32_t)seed;
  b->key[1] = (uint32_t)(seed >> 32);
  b->memory = allocate(ROWS * capacity);
  b->id = allocate(capacity);
  b->words = allocate(PENDRES_LANGEVIN_WORDS * capacity);
  if (b->memory == NULL || b->id == NULL || b->words == NULL) return PENDRES_OUT_OF_MEMORY;

  double *row = b->memory;
#define TAKE(name, count) b->name = row, row += (size_t)(count) * capacity
  TAKE(x, 1), TAKE(v, 1), TAKE(base, 1), TAKE(cosine, 1), TAKE(sine, 1), TAKE(work, 1);
  TAKE(rows.u, 1), TAKE(rows.w, 1), TAKE(gauss, PENDRES_LANGEVIN_WORDS);
  /* From here on what follows from the parameters: tune() takes them together. */
  TAKE(drive, 1), TAKE(pivot_speed, 1);
  for (int d = 0; d < PENDRES_LANGEVIN_DURATIONS; d++) TAKE(reach[d], 1), TAKE(decay[d], 1);
#undef TAKE
  /* The kernels only read the following rows; loading a lane writes them by way of `memory`. */
  b->rows.pivot_cos = row, row += capacity;
  b->rows.pivot_sin = row, row += capacity;
  b->rows.push = row, row += capacity;
  b->rows.spread = row, row += capacity;
  b->rows.bend = row, row += capacity;
  b->rows.torque = row, row += capacity;
  b->rows.parametric = row, row += capacity;
  for (int k = 0; k < COEFFICIENTS; k++) b->rows.coefficient[k] = row, row += capacity;
  return PENDRES_OK;
}

void pendres_langevin_block_clear(pendres_langevin_block *b)
{
  free(b->memory);
  free(b->id);
  free(b->words);
  free(b->phases);
  *b = (pendres_langevin_block){0};
}

pendres_status pendres_langevin_block_set_steps(pendres_langevin_block *b, int steps)
{
  const double within[3] = {0.0, 0.5 - 0.5 * root_third, 0.5 + 0.5 * root_third};
  double *phases = malloc(6 * (size_t)steps * sizeof *phases);
  if (phases == NULL) return PENDRES_OUT_OF_MEMORY;
  /* By the library's own sine, which gives the same bytes on any processor. */
  for (int k = 0; k < 3 * steps; k++)
    pendres_kernels_sincos(two_pi * (k / 3 + within[k % 3]) / steps, &phases[2 * k + 1],
                           &phases[2 * k]);
  free(b->phases);
  b->phases = phases;
  b->steps = steps;
  return PENDRES_OK;
}

void pendres_langevin_block_resize(pendres_langevin_block *b, size_t count)
{
  b->count = count;
  b->stride = (count + 7) / 8 * 8;
  b->noisy = 0;
}

/* pivot = pivot_cos cos theta + pivot_sin sin theta solves y'' + gamma y' = F0 cos theta. */
static void pivot_of(const pendres_pendulum *p, double *pivot_cos, double *pivot_sin)
{
  const double g = p->damping, w = p->drive_frequency;
  const double reduced = p->drive_amplitude / (w * w + g * g);
  *pivot_cos = -reduced;
  *pivot_sin = reduced * g / w;
}

const char *pendres_langevin_block_refuses(const pendres_pendulum *p, int steps)
{
  double c, s;
  pivot_of(p, &c, &s);
  if (!(fabs(c) <= noise_farthest && fabs(s) <= noise_farthest))
    return "with noise, the drive must not shake a free particle farther than 1e7";
  /* Noise alone makes velocities of sqrt(T), which carry a pendulum by that over the larger of the
   * drive frequency and the damping. */
  if (!(sqrt(p->temperature) <= noise_farthest * fmax(p->drive_frequency, p->damping)))
    return "so hot a pendulum is beyond 1e7 within a period";
  /* The speed that a torque leads to within a period, or against friction. */
  const double period = two_pi / p->drive_frequency;
  const double speed = fabs(p->torque) * fmin(period, 1.0 / p->damping);
  if (!(speed * period <= noise_farthest))
    return "with noise, the torque must not move a free particle farther than 1e7 within a period";
  if (!(period / steps <= noise_longest_step))
    return "with noise, a step must not be longer than 3: more steps a period are needed";
  return NULL;
}

/* The constants of a period that follow from a lane's parameters and the steps. */
static void set_constants(pendres_langevin_block *b, size_t lane, const pendres_pendulum *p)
{
  const double h = two_pi / p->drive_frequency / b->steps, g = p->damping;
  const double durations[PENDRES_LANGEVIN_DURATIONS] = {
    0.5 * (1.0 - root_third) * h, root_third * h, (1.0 - root_third) * h};
  const size_t pivot_cos = (size_t)(b->rows.pivot_cos - b->memory) + lane;
  const size_t apart = b->capacity;

  b->drive[lane] = p->drive_amplitude;
  for (int d = 0; d < PENDRES_LANGEVIN_DURATIONS; d++) {
    b->decay[d][lane] = exp(-g * durations[d]);
    b->reach[d][lane] = g > 0.0 ? -expm1(-g * durations[d]) / g : durations[d];
  }
  pivot_of(p, &b->memory[pivot_cos], &b->memory[pivot_cos + apart]);
  b->pivot_speed[lane] = p->drive_frequency * b->memory[pivot_cos + apart];
  b->memory[pivot_cos + 2 * apart] = 0.5 * h;
  b->memory[pivot_cos + 3 * apart] = sqrt(g * p->temperature * h);
  b->memory[pivot_cos + 4 * apart] = h * h * (2.0 - 3.0 * root_third) / 12.0;
  b->memory[pivot_cos + 5 * apart] = p->torque;
  b->memory[pivot_cos + 6 * apart] = p->parametric_amplitude;
  for (size_t k = 0; k < COEFFICIENTS; k++)
    b->memory[pivot_cos + (7 + k) * apart] = p->force_coefficients[k];
}

void pendres_langevin_block_load(pendres_langevin_block *b, size_t lane, const pendres_pendulum *p,
                                 uint64_t id, double x, double v)
{
  b->id[lane] = id;
  b->x[lane] = x;
  b->v[lane] = v;
  set_constants(b, lane, p);
  b->terms = pendres_model_kind(p);
  b->rows.formula = pendres_formula_of(p->force);
  b->origin = pendres_model_origin(p);
  b->turn = pendres_model_turn(p);
  if (p->temperature > 0.0 && p->damping > 0.0) b->noisy = 1;
}

void pendres_langevin_block_finish(pendres_langevin_block *b)
{
  for (size_t i = b->count; i < b->stride; i++) {
    b->id[i] = b->id[0];
    for (size_t row = 0; row < ROWS; row++)
      b->memory[row * b->capacity + i] = b->memory[row * b->capacity];
  }
}

/* Take the states at drive phase 0 into the shaken frame, without their whole turns. */
static void enter(pendres_langevin_block *b)
{
  pendres_langevin_rows *r = &b->rows;
  for (size_t i = 0; i < b->stride; i++) {
    b->base[i] = b->origin + b->turn * rint((b->x[i] - b->origin) / b->turn);
    const double y = b->x[i] - b->base[i];
    r->u[i] = y - r->pivot_cos[i];
    r->w[i] = b->v[i] - b->pivot_speed[i];
    b->cosine[i] = 0.5 * y;
    b->sine[i] = 0.0;
  }
}

/* The first harmonic and the work of lane i over the period that ends at angle y. */
static void harmonics(pendres_langevin_block *b, size_t i, double y)
{
  const double n = b->steps;
  const double moved = y - (b->x[i] - b->base[i]);
  /* For a ramp in theta the sum is pi/n cot(pi/n) times the integral. */
  const double missing = 1.0 - pi / n / tan(pi / n);
  b->cosine[i] = 2.0 / n * (b->cosine[i] + 0.5 * y);
  b->sine[i] = 2.0 / n * b->sine[i] - moved / pi * missing;
  /* Integration by parts: that of cos theta dx is `moved` plus that of y sin theta dtheta. */
  b->work[i] = b->drive[i] * (moved + pi * b->sine[i]);
}

/* Take the states back from the shaken frame at the period's end. The next period starts from these
 * numbers, so that a run may be cut at any strobe. */
static void leave(pendres_langevin_block *b)
{
  const pendres_langevin_rows *r = &b->rows;
  b->kernels->drift(b->stride, b->reach[PENDRES_LANGEVIN_EDGE], b->decay[PENDRES_LANGEVIN_EDGE],
                    r->u, r->w);
  for (size_t i = 0; i < b->stride; i++) {
    const double y = r->u[i] + r->pivot_cos[i];
    if (b->harmonics) harmonics(b, i, y);
    b->x[i] = y + b->base[i];
    b->v[i] = r->w[i] + b->pivot_speed[i];
  }
}

/* Move freely to kick k of the period, and kick. Where a step starts on the way, sample there. */
static void kick(pendres_langevin_block *b, int k, const double *gauss)
{
  const double *start = b->phases + 6 * (k / 2), *at = start + (k % 2 == 0 ? 2 : 4);
  int d = PENDRES_LANGEVIN_INNER;
  if (k % 2 == 0) d = k == 0 ? PENDRES_LANGEVIN_EDGE : PENDRES_LANGEVIN_BETWEEN;
  if (b->harmonics && d == PENDRES_LANGEVIN_BETWEEN)
    b->kernels->sample(b->stride, &b->rows, b->reach[PENDRES_LANGEVIN_EDGE], start[0], start[1],
                       b->cosine, b->sine);
  b->kernels->kick[pendres_model_kernel(b->terms)](b->stride, &b->rows, b->reach[d],
                                                   b->decay[d], at[0], at[1], gauss);
}

/* The Gaussian numbers of kick k; one call of the generator serves four kicks. */
static const double *noise(pendres_langevin_block *b, uint32_t period, int k)
{
  /* Without noise any finite row will do, since it is multiplied by zero. */
  if (!b->noisy) return b->gauss;
  const int row = k % PENDRES_LANGEVIN_WORDS;
  if (row == 0) {
    b->kernels->words(b->stride, b->id, period, (uint32_t)(k / PENDRES_LANGEVIN_WORDS), b->key,
                      b->words);
    b->kernels->gauss(b->stride, b->words, b->gauss);
  }
  return b->gauss + (size_t)row * b->stride;
}

/* Whether the period is to end before this step. In short periods stop() is not called. */
static int stops(const pendres_langevin_block *b, int step)
{
  const int every = (int)ceil((double)PENDRES_STEPS_BETWEEN_CHECKS / (double)b->stride);
  return step > 0 && step % every == 0 && b->stop != NULL && b->stop(b->stop_arg) != 0;
}

pendres_status pendres_langevin_block_period(pendres_langevin_block *b, uint32_t period)
{
  enter(b);
  for (int step = 0; step < b->steps; step++) {
    if (stops(b, step)) return PENDRES_INTERRUPTED;
    for (int k = 2 * step; k < 2 * step + 2; k++) kick(b, k, noise(b, period, k));
  }
  leave(b);
  return PENDRES_OK;
}

/* Give all lanes the parameters of this pendulum. */
static void tune(pendres_langevin_block *b, const pendres_pendulum *p)
{
  enum { FIXED = 2 + 2 * PENDRES_LANGEVIN_DURATIONS + 7 /* rows but coefficients of a force */ };
  b->terms = pendres_model_kind(p);
  b->rows.formula = pendres_formula_of(p->force);
  const size_t rows = b->terms >= PENDRES_MODEL_POLYNOMIAL ? FIXED + COEFFICIENTS : FIXED;
  set_constants(b, 0, p);
  for (size_t k = 0; k < rows; k++)
    for (size_t i = 1; i < b->stride; i++)
      b->drive[k * b->capacity + i] = b->drive[k * b->capacity];
}

/* The same between two steps: the states are the same, expressed in another frame. */
static void retune(pendres_langevin_block *b, const pendres_pendulum *p, const double phase[2],
                   double *frequency)
{
  const pendres_langevin_rows *r = &b->rows;
  const double c = r->pivot_cos[0], s = r->pivot_sin[0], omega = *frequency;
  tune(b, p);
  *frequency = p->drive_frequency;
  const double place = (c - r->pivot_cos[0]) * phase[0] + (s - r->pivot_sin[0]) * phase[1];
  const double speed = (omega * s - *frequency * r->pivot_sin[0]) * phase[0] -
                       (omega * c - *frequency * r->pivot_cos[0]) * phase[1];
  for (size_t i = 0; i < b->stride; i++) {
    r->u[i] += place;
    r->w[i] += speed;
  }
}

pendres_status pendres_langevin_block_moving(pendres_langevin_block *b, uint32_t period,
                                             pendres_langevin_motion *motion, void *arg)
{
  const double *const edge = b->reach[PENDRES_LANGEVIN_EDGE];
  const double *const inner = b->reach[PENDRES_LANGEVIN_INNER];
  double frequency = 0.0;
  for (int step = 0; step < b->steps; step++) {
    const double *start = b->phases + 6 * step;
    if (stops(b, step)) return PENDRES_INTERRUPTED;
    const pendres_pendulum p = motion(arg, (double)period + (step + 0.5) / b->steps);
    if (step == 0) {
      tune(b, &p);
      frequency = p.drive_frequency;
      enter(b);
    } else {
      if (b->harmonics)
        b->kernels->sample(b->stride, &b->rows, edge, start[0], start[1], b->cosine, b->sine);
      b->kernels->drift(b->stride, edge, b->decay[PENDRES_LANGEVIN_EDGE], b->rows.u, b->rows.w);
      retune(b, &p, start, &frequency);
    }
    const int kernel = pendres_model_kernel(b->terms);
    b->kernels->kick[kernel](b->stride, &b->rows, edge, b->decay[PENDRES_LANGEVIN_EDGE],
                             start[2], start[3], noise(b, period, 2 * step));
    b->kernels->kick[kernel](b->stride, &b->rows, inner, b->decay[PENDRES_LANGEVIN_INNER],
                             start[4], start[5], noise(b, period, 2 * step + 1));
  }
  leave(b);
  return PENDRES_OK;
}

pendres_status pendres_langevin_block_pair(pendres_langevin_block *fine,
                                           pendres_langevin_block *coarse, uint32_t period)
{
  const double root_half = 0.70710678118654752440;

  enter(fine);
  enter(coarse);
  for (int k = 0; k < coarse->steps * 2; k++) {
    if (stops(fine, k)) return PENDRES_INTERRUPTED; /* a coarse kick is a fine step */
    const double *first = noise(fine, period, 2 * k);
    kick(fine, 2 * k, first);
    const double *second = noise(fine, period, 2 * k + 1);
    kick(fine, 2 * k + 1, second);
    for (size_t i = 0; i < coarse->stride; i++)
      coarse->gauss[i] = root_half * (first[i] + second[i]);
    kick(coarse, k, coarse->gauss);
  }
  leave(fine);
  leave(coarse);
  return PENDRES_OK;
}
