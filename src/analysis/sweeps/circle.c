/* circle.c -- the invariant circle of a rotation; see circle.h. */
#include "analysis/sweeps/circle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_fft_halfcomplex.h>
#include <gsl/gsl_fft_real.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/coordinates.h"
#include "model/model.h"

enum {
  MOST = PENDRES_CIRCLE_MOST,
  ROUNDS = 8,     /* of Newton's method */
  SWEEPS = 400,   /* of the contraction that solves for a correction, at most */
  LOOKS = 12,     /* iterations for the angle that a period brings to a given one */
  FINER = 4,      /* cells for each point of a circle, between which ... */
  TAPS = 8,       /* ... corrections are interpolated from so many */
  ABREAST = 8,    /* angles at which a polynomial is summed side by side */
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

/* Fit a polynomial through the values at n angles 2 pi i/n. */
static void fit(size_t n, const double *value, pendres_trigonometric *out)
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

/* Its values at n angles, as pendres_trigonometric_at() has them, side by side: each waits for its
   own sums alone. */
static void values_at(const pendres_trigonometric *t, size_t n, const double *y, double *out)
{
  for (size_t first = 0; first < n; first += ABREAST) {
    double c1[ABREAST], s1[ABREAST], c[ABREAST], s[ABREAST], value[ABREAST];
    for (size_t i = 0; i < ABREAST; i++) {
      const multiple m = first_multiple(first + i < n ? y[first + i] : 0.0);
      c[i] = c1[i] = m.c1;
      s[i] = s1[i] = m.s1;
      value[i] = t->c[0];
    }
    for (size_t k = 1; k < t->n / 2; k++)
      for (size_t i = 0; i < ABREAST; i++) {
        const double next = c[i] * c1[i] - s[i] * s1[i];
        value[i] += t->c[2 * k - 1] * c[i] + t->c[2 * k] * s[i];
        s[i] = s[i] * c1[i] + c[i] * s1[i];
        c[i] = next;
      }
    for (size_t i = 0; i < ABREAST && first + i < n; i++) out[first + i] = value[i];
  }
}

void pendres_trigonometric_spread(const pendres_trigonometric *t, int order, size_t cells,
                                  double *out)
{
  memset(out, 0, cells * sizeof *out);
  out[0] = order == 0 ? t->c[0] : 0.0;
  for (size_t k = 1; k < t->n / 2; k++) {
    const double a = t->c[2 * k - 1], b = t->c[2 * k], f = (double)k;
    const double c = order == 0 ? a : order == 1 ? f * b : -f * f * a;
    const double s = order == 0 ? b : order == 1 ? -f * a : -f * f * b;
    out[k] = 0.5 * c;
    out[cells - k] = -0.5 * s;
  }
  (void)gsl_fft_halfcomplex_radix2_backward(out, 1, cells); /* cells is a power of two */
}

double pendres_trigonometric_size(const pendres_trigonometric *t)
{
  double sum = fabs(t->c[0]);
  for (size_t k = 1; k < t->n / 2; k++) sum += hypot(t->c[2 * k - 1], t->c[2 * k]);
  return sum;
}

/* The largest of the last eighth of the coefficients: the truncation error is about as large. */
static double tail_of(const pendres_trigonometric *t)
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

/* Where a value between the cells of a finer grid is interpolated from. */
typedef struct stencil {
  size_t first;
  double weight[TAPS];
} stencil;

/* The points of a circle and their images. */
typedef struct shape {
  pendres_context *ctx;
  const pendres_circle_way *way;
  size_t n;
  double w[MOST];      /* C at the grid */
  double move[MOST];   /* D there */
  double off[MOST];    /* E there */
  stencil source[MOST]; /* of the angles that a period maps to those of the grid, */
  double slope[MOST];  /* and dY/dy there */
  double fine[FINER * MOST + TAPS], rise[FINER * MOST + 1]; /* values and slopes in cells */
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

/* Fit the curves through the points after a period, and find how far they are from invariant. */
static void look(shape *r)
{
  double image[MOST], there[MOST];
  fit(r->n, r->w, &r->curve);
  fit(r->n, r->move, &r->moved);
  for (size_t i = 0; i < r->n; i++) image[i] = grid(r->n, i) + r->move[i];
  values_at(&r->curve, r->n, image, there);
  r->worst = 0.0;
  for (size_t i = 0; i < r->n; i++) {
    r->off[i] -= there[i];
    r->worst = fmax(r->worst, isfinite(r->off[i]) ? fabs(r->off[i]) : INFINITY);
  }
}

/* Lagrange's polynomial through TAPS neighbouring cells, the point being s beyond the first of the
   two in their middle. */
static stencil stencil_at(size_t cells, long cell, double s)
{
  const long last = TAPS / 2 - 1;
  stencil out = {.first = (size_t)(cell - last) & (cells - 1)};
  for (int m = 0; m < TAPS; m++) {
    out.weight[m] = 1.0;
    for (int l = 0; l < TAPS; l++)
      if (l != m) out.weight[m] *= (s + (double)(last - l)) / (double)(m - l);
  }
  return out;
}

/* The image of the beginning of a cell, in cells. */
static double image_of(const shape *r, size_t cells, long cell)
{
  return (double)cell + r->fine[(size_t)cell & (cells - 1)];
}

/* Where in a cell, between 0 and 1, the cubic through both ends takes a value; *slope: its slope
   there. */
static double place_in(const shape *r, size_t cells, long cell, double wanted, double *slope)
{
  const double a = image_of(r, cells, cell), d = image_of(r, cells, cell + 1) - a;
  const double left = 1.0 + r->rise[(size_t)cell & (cells - 1)];
  const double right = 1.0 + r->rise[(size_t)(cell + 1) & (cells - 1)];
  const double bend = 3.0 * d - 2.0 * left - right, twist = left + right - 2.0 * d;
  double s = (wanted - a) / d, step = INFINITY;
  for (int k = 0; k < LOOKS && fabs(step) > 1e-9; k++) {
    *slope = left + s * (2.0 * bend + s * (3.0 * twist));
    if (!(*slope > least_slope)) return NAN;
    step = (wanted - a - s * (left + s * (bend + s * twist))) / *slope;
    s = fmax(0.0, fmin(1.0, s + step));
  }
  return s;
}

/* The angles that a period maps to those of the grid; returns 0 if the map is not one to one. It is
   taken from cubics in cells, exact enough for corrections. */
static int invert(shape *r)
{
  const size_t cells = FINER * r->n;
  pendres_trigonometric moved = r->moved;
  moved.c[0] -= two_pi * floor(moved.c[0] / two_pi);
  pendres_trigonometric_spread(&moved, 0, cells, r->fine);
  pendres_trigonometric_spread(&moved, 1, cells, r->rise);
  for (size_t i = 0; i < cells; i++) r->fine[i] *= (double)cells / two_pi;
  for (long k = 0; k < (long)cells; k++)
    if (!(image_of(r, cells, k + 1) > image_of(r, cells, k))) return 0;
  long cell = (long)floor(-r->fine[0]);
  while (image_of(r, cells, cell) > 0.0) cell--;
  for (size_t i = 0; i < r->n; i++) {
    const double wanted = (double)(FINER * i);
    while (image_of(r, cells, cell + 1) <= wanted) cell++;
    const double s = place_in(r, cells, cell, wanted, &r->slope[i]);
    if (isnan(s)) return 0;
    r->source[i] = stencil_at(cells, cell, s);
  }
  return 1;
}

/* The polynomial through n values, at the angles that are mapped to the grid. */
static void at_sources(shape *r, const double *value, double *out)
{
  const size_t cells = FINER * r->n;
  pendres_trigonometric t;
  fit(r->n, value, &t);
  pendres_trigonometric_spread(&t, 0, cells, r->fine);
  memcpy(r->fine + cells, r->fine, TAPS * sizeof *r->fine);
  for (size_t i = 0; i < r->n; i++) {
    const double *f = r->fine + r->source[i].first, *w = r->source[i].weight;
    out[i] = ((w[0] * f[0] + w[1] * f[1]) + (w[2] * f[2] + w[3] * f[3])) +
             ((w[4] * f[4] + w[5] * f[5]) + (w[6] * f[6] + w[7] * f[7]));
  }
}

/* The correction: c(grid i) = l c(source i) + E(source i), by iteration. */
static int correct(shape *r)
{
  const pendres_pendulum *p = &r->way->pendulum;
  const double shrinks = exp(-two_pi * p->damping / p->drive_frequency);
  double given[MOST], c[MOST], there[MOST], change = INFINITY;
  if (!invert(r)) return 0;
  at_sources(r, r->off, given);
  memcpy(c, given, r->n * sizeof *c);
  for (int sweep = 0; sweep < SWEEPS && change > solved * r->worst; sweep++) {
    at_sources(r, c, there);
    change = 0.0;
    for (size_t i = 0; i < r->n; i++) {
      const double next = shrinks / r->slope[i] * there[i] + given[i];
      change = fmax(change, isfinite(next) ? fabs(next - c[i]) : INFINITY);
      c[i] = next;
    }
    if (!(change < 1e3 * (hopeless + r->worst))) return 0;
  }
  for (size_t i = 0; i < r->n; i++) r->w[i] += c[i];
  return change <= solved * r->worst;
}

/* Newton's method with as many points as r has. */
static pendres_status converge(shape *r, int *found)
{
  *found = 0;
  for (int k = 0; k < ROUNDS; k++) {
    const pendres_status status = run(r);
    if (status != PENDRES_OK) return status;
    look(r);
    *found = r->worst < r->way->residual;
    if (*found || !(r->worst < hopeless) || !correct(r)) return PENDRES_OK;
  }
  return PENDRES_OK;
}

static double tail(const shape *r)
{
  return fmax(tail_of(&r->curve), tail_of(&r->moved));
}

pendres_status pendres_circle_refine(pendres_context *ctx, const pendres_circle_way *way,
                                     const pendres_trigonometric *guess, pendres_circle *out,
                                     int *found)
{
  shape *r = malloc(sizeof *r);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  *found = 0;
  if (r == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for an invariant circle");
    goto done;
  }
  *r = (shape){.ctx = ctx, .way = way, .curve = *guess};
  for (r->n = guess->n; r->n <= MOST; r->n *= 2) {
    pendres_trigonometric_spread(&r->curve, 0, r->n, r->w);
    status = converge(r, found);
    if (status != PENDRES_OK || (*found && tail(r) < way->tolerance)) break;
    /* Too few points to resolve the circle, but close enough to it to start with more of them. */
    if (!*found && !(r->worst < hopeless)) break;
    *found = 0;
  }
  if (*found)
    *out = (pendres_circle){.w = r->curve, .move = r->moved, .error = r->worst + tail(r)};
done:
  free(r);
  return status;
}

/* ---- a guess ------------------------------------------------------------------------------- */

static int by_angle(const void *a, const void *b)
{
  const pendres_coordinates *p = a, *q = b;
  return (p->y > q->y) - (p->y < q->y);
}

/* Interpolate linearly between the points, around the cylinder. */
static int connect(pendres_coordinates at[POINTS], pendres_trigonometric *out)
{
  enum { N = PENDRES_CIRCLE_LEAST };
  double w[N];
  size_t next = 0;
  qsort(at, POINTS, sizeof *at, by_angle);
  for (size_t i = 0; i < N; i++) {
    while (next < POINTS && at[next].y <= grid(N, i)) next++;
    const pendres_coordinates *right =
      &at[next % POINTS], *left = &at[(next + POINTS - 1) % POINTS];
    const double from = left->y - (next == 0 ? two_pi : 0.0);
    const double to = right->y + (next == POINTS ? two_pi : 0.0);
    if (!(to - from < widest_gap)) return 0;
    const double part = to > from ? (grid(N, i) - from) / (to - from) : 0.0;
    w[i] = left->w + part * (right->w - left->w);
  }
  fit(N, w, out);
  return 1;
}

pendres_status pendres_circle_guess(pendres_context *ctx, const pendres_circle_way *way, double x,
                                    double v, pendres_trigonometric *out, int *found)
{
  const pendres_pendulum *p = &way->pendulum;
  pendres_block block;
  pendres_coordinates at[POINTS], now = {0};
  const pendres_coordinates start = pendres_coordinates_in(p, x, v);
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
