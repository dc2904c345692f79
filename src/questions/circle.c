/* circle.c -- the invariant circle of a rotation; see circle.h. */
#include "questions/circle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_fft_real.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/passage.h"
#include "model/model.h"

enum {
  MOST = PENDRES_CIRCLE_MOST,
  ROUNDS = 8,     /* of Newton's method */
  SWEEPS = 400,   /* of the contraction that solves for a correction, at most */
  LOOKS = 12,     /* iterations for the angle that a period brings to a given one */
  POINTS = 192,   /* of a pendulum's motion, for a guess */
  ON_THE_WAY = 32 /* periods before them */
};

/* A guess with a larger E than this is not used. */
static const double hopeless = 0.5;
/* Least dY/dy: below it the map of a period is not, or hardly, one to one, and the circle is given
   up. */
static const double least_slope = 0.02;
/* The accuracy of corrections relative to the residual: what they leave of it is as small as what
   Newton's method itself leaves. */
static const double solved = 1e-4;
/* The points of a pendulum's motion must not leave wider gaps. */
static const double widest_gap = 0.4;

/* ---- trigonometric polynomials ------------------------------------------------------------- */

void pendres_trigonometric_fit(size_t n, const double *value, pendres_trigonometric *out)
{
  double z[MOST];
  memcpy(z, value, n * sizeof *z);
  (void)gsl_fft_real_radix2_transform(z, 1, n); /* fails only where n is no power of two */
  out->n = n;
  out->c[0] = z[0] / (double)n;
  for (size_t k = 1; k < n / 2; k++) {
    out->c[2 * k - 1] = 2.0 * z[k] / (double)n;
    out->c[2 * k] = -2.0 * z[n - k] / (double)n;
  }
  out->c[n - 1] = 0.0;
}

/* cos ky and sin ky, for one k after another. */
typedef struct multiple {
  double c1, s1, c, s;
} multiple;

static inline multiple first_multiple(double y)
{
  const double c = cos(y), s = sin(y);
  return (multiple){.c1 = c, .s1 = s, .c = c, .s = s};
}

static inline void turn_on(multiple *m)
{
  const double next = m->c * m->c1 - m->s * m->s1;
  m->s = m->s * m->c1 + m->c * m->s1;
  m->c = next;
}

double pendres_trigonometric_at(const pendres_trigonometric *t, double y, double *slope)
{
  double value = t->c[0], derivative = 0.0;
  multiple m = first_multiple(y);
  for (size_t k = 1; k < t->n / 2; k++, turn_on(&m)) {
    const double a = t->c[2 * k - 1], b = t->c[2 * k];
    value += a * m.c + b * m.s;
    derivative += (double)k * (b * m.c - a * m.s);
  }
  if (slope != NULL) *slope = derivative;
  return value;
}

double pendres_trigonometric_size(const pendres_trigonometric *t)
{
  double sum = fabs(t->c[0]);
  for (size_t k = 1; k < t->n / 2; k++) sum += hypot(t->c[2 * k - 1], t->c[2 * k]);
  return sum;
}

double pendres_trigonometric_tail(const pendres_trigonometric *t)
{
  double largest = 0.0;
  for (size_t i = 7 * t->n / 8; i < t->n; i++) largest = fmax(largest, fabs(t->c[i]));
  return largest;
}

void pendres_trigonometric_trim(pendres_trigonometric *t, double tolerance)
{
  while (t->n > PENDRES_CIRCLE_LEAST) {
    for (size_t i = 7 * t->n / 16; i < t->n; i++)
      if (!(fabs(t->c[i]) < tolerance)) return;
    t->n /= 2;
    t->c[t->n - 1] = 0.0;
  }
}

/* ---- Newton's method ----------------------------------------------------------------------- */

/* The points of a circle and their images. */
typedef struct shape {
  pendres_context *ctx;
  const pendres_circle_way *way;
  size_t n;
  double w[MOST];      /* C at the grid */
  double move[MOST];   /* D there */
  double off[MOST];    /* E there */
  double source[MOST]; /* angles that a period maps to those of the grid */
  pendres_trigonometric curve, moved;
  double worst; /* largest E */
} shape;

static double grid(size_t n, size_t i)
{
  return two_pi * (double)i / (double)n;
}

/* Advance all points by a period. */
static pendres_status run(shape *r)
{
  pendres_block block;
  pendres_status status = pendres_block_open(r->ctx, PENDRES_FLOW_STATE, r->way->steps, &block);
  if (status != PENDRES_OK) return status;
  const size_t most = pendres_block_capacity(&block);
  for (size_t first = 0, some; first < r->n && status == PENDRES_OK; first += some) {
    some = r->n - first < most ? r->n - first : most;
    pendres_block_resize(&block, some);
    for (size_t i = 0; i < some; i++)
      pendres_block_load(&block, i, &r->way->pendulum, grid(r->n, first + i), r->w[first + i]);
    status = pendres_block_period(&block);
    const pendres_rows rows = pendres_block_rows(&block);
    for (size_t i = 0; i < some && status == PENDRES_OK; i++) {
      r->move[first + i] = pendres_rows_get(&rows, PENDRES_ROW_Y, i) - grid(r->n, first + i);
      r->off[first + i] = pendres_rows_get(&rows, PENDRES_ROW_W, i);
    }
  }
  return status;
}

/* After a period: the curves through the points, and how far they are from invariant. */
static void look(shape *r)
{
  pendres_trigonometric_fit(r->n, r->w, &r->curve);
  pendres_trigonometric_fit(r->n, r->move, &r->moved);
  r->worst = 0.0;
  for (size_t i = 0; i < r->n; i++) {
    r->off[i] -= pendres_trigonometric_at(&r->curve, grid(r->n, i) + r->move[i], NULL);
    r->worst = fmax(r->worst, isfinite(r->off[i]) ? fabs(r->off[i]) : INFINITY);
  }
}

/* The angles that a period maps to those of the grid; returns 0 if the map is not one to one. */
static int invert(shape *r)
{
  double y = -r->moved.c[0], slope = 0.0;
  for (size_t i = 0; i < r->n; i++) {
    const double wanted = grid(r->n, i);
    double step = INFINITY;
    for (int k = 0; k < LOOKS && fabs(step) > 1e-12; k++) {
      step = wanted - y - pendres_trigonometric_at(&r->moved, y, &slope);
      if (!(1.0 + slope > least_slope)) return 0;
      step = fmax(-0.5, fmin(0.5, step / (1.0 + slope)));
      y += step;
    }
    if (!(fabs(step) < 1e-9)) return 0;
    r->source[i] = y;
    y += two_pi / (double)r->n / (1.0 + slope);
  }
  return 1;
}

/* basis[i][k]: the function of coefficient k at the angle that is mapped to grid point i. */
static void tabulate(const shape *r, double *basis)
{
  for (size_t i = 0; i < r->n; i++) {
    double *b = basis + i * r->n;
    multiple m = first_multiple(r->source[i]);
    b[0] = 1.0;
    for (size_t k = 1; k < r->n / 2; k++, turn_on(&m)) {
      b[2 * k - 1] = m.c;
      b[2 * k] = m.s;
    }
    b[r->n - 1] = 0.0;
  }
}

static double product(size_t n, const double *a, const double *b)
{
  double sum[4] = {0.0};
  for (size_t i = 0; i < n; i += 4)
    for (size_t k = 0; k < 4; k++) sum[k] += a[i + k] * b[i + k];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* The correction: c(grid i) = l c(source i) + E(source i), by iteration. */
static int correct(shape *r, double *basis)
{
  const pendres_pendulum *p = &r->way->pendulum;
  const double shrinks = exp(-two_pi * p->damping / p->drive_frequency);
  double factor[MOST], given[MOST], c[MOST], change = INFINITY;
  pendres_trigonometric t;
  if (!invert(r)) return 0;
  tabulate(r, basis);
  pendres_trigonometric_fit(r->n, r->off, &t);
  for (size_t i = 0; i < r->n; i++) {
    double slope = 0.0;
    (void)pendres_trigonometric_at(&r->moved, r->source[i], &slope);
    factor[i] = shrinks / (1.0 + slope);
    c[i] = given[i] = product(r->n, basis + i * r->n, t.c);
  }
  for (int sweep = 0; sweep < SWEEPS && change > solved * r->worst; sweep++) {
    pendres_trigonometric_fit(r->n, c, &t);
    change = 0.0;
    for (size_t i = 0; i < r->n; i++) {
      const double next = factor[i] * product(r->n, basis + i * r->n, t.c) + given[i];
      change = fmax(change, isfinite(next) ? fabs(next - c[i]) : INFINITY);
      c[i] = next;
    }
    if (!(change < 1e3 * (hopeless + r->worst))) return 0;
  }
  for (size_t i = 0; i < r->n; i++) r->w[i] += c[i];
  return change <= solved * r->worst;
}

/* Newton's method with as many points as r has. */
static pendres_status converge(shape *r, double *basis, int *found)
{
  *found = 0;
  for (int k = 0; k < ROUNDS; k++) {
    const pendres_status status = run(r);
    if (status != PENDRES_OK) return status;
    look(r);
    *found = r->worst < r->way->residual;
    if (*found || !(r->worst < hopeless) || !correct(r, basis)) return PENDRES_OK;
  }
  return PENDRES_OK;
}

static double tail(const shape *r)
{
  return fmax(pendres_trigonometric_tail(&r->curve), pendres_trigonometric_tail(&r->moved));
}

pendres_status pendres_circle_refine(pendres_context *ctx, const pendres_circle_way *way,
                                     const pendres_trigonometric *guess, pendres_circle *out,
                                     int *found)
{
  shape *r = malloc(sizeof *r);
  double *basis = malloc(MOST * MOST * sizeof *basis);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  *found = 0;
  if (r == NULL || basis == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for an invariant circle");
    goto done;
  }
  *r = (shape){.ctx = ctx, .way = way, .curve = *guess};
  for (r->n = guess->n; r->n <= MOST; r->n *= 2) {
    for (size_t i = 0; i < r->n; i++)
      r->w[i] = pendres_trigonometric_at(&r->curve, grid(r->n, i), NULL);
    status = converge(r, basis, found);
    if (status != PENDRES_OK || (*found && tail(r) < way->tolerance)) break;
    /* Too few points to resolve the circle, but close enough to it to start with more of them. */
    if (!*found && !(r->worst < hopeless)) break;
    *found = 0;
  }
  if (*found)
    *out = (pendres_circle){.w = r->curve, .move = r->moved, .error = r->worst + tail(r)};
done:
  free(r);
  free(basis);
  return status;
}

/* ---- a guess ------------------------------------------------------------------------------- */

static int by_angle(const void *a, const void *b)
{
  const pendres_place *p = a, *q = b;
  return (p->y > q->y) - (p->y < q->y);
}

/* Interpolate linearly between the points, around the cylinder. */
static int connect(pendres_place at[POINTS], pendres_trigonometric *out)
{
  enum { N = PENDRES_CIRCLE_LEAST };
  double w[N];
  size_t next = 0;
  qsort(at, POINTS, sizeof *at, by_angle);
  for (size_t i = 0; i < N; i++) {
    while (next < POINTS && at[next].y <= grid(N, i)) next++;
    const pendres_place *right = &at[next % POINTS], *left = &at[(next + POINTS - 1) % POINTS];
    const double from = left->y - (next == 0 ? two_pi : 0.0);
    const double to = right->y + (next == POINTS ? two_pi : 0.0);
    if (!(to - from < widest_gap)) return 0;
    const double part = to > from ? (grid(N, i) - from) / (to - from) : 0.0;
    w[i] = left->w + part * (right->w - left->w);
  }
  pendres_trigonometric_fit(N, w, out);
  return 1;
}

pendres_status pendres_circle_guess(pendres_context *ctx, const pendres_circle_way *way, double x,
                                    double v, pendres_trigonometric *out, int *found)
{
  const pendres_pendulum *p = &way->pendulum;
  pendres_block block;
  pendres_place at[POINTS], now = {0};
  const pendres_place start = pendres_passage_in(p, x, v);
  pendres_status status = pendres_block_open(ctx, PENDRES_FLOW_STATE, way->steps, &block);
  *found = 0;
  if (status != PENDRES_OK) return status;
  pendres_block_resize(&block, 1);
  pendres_block_load(&block, 0, p, start.y, start.w);
  for (int k = -ON_THE_WAY; k < POINTS && status == PENDRES_OK; k++) {
    status = pendres_block_period(&block);
    const pendres_rows rows = pendres_block_rows(&block);
    now.w = pendres_rows_get(&rows, PENDRES_ROW_W, 0);
    now.y = pendres_rows_get(&rows, PENDRES_ROW_Y, 0);
    now.y -= two_pi * floor(now.y / two_pi);
    pendres_block_put_state(&block, 0, now.y, now.w);
    if (k >= 0) at[k] = now;
  }
  if (status == PENDRES_OK) *found = connect(at, out);
  return status;
}
