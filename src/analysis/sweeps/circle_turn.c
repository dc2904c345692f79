/* circle_turn.c -- what a rotation does in the long run; see circle_turn.h. */
#include "analysis/sweeps/circle_turn.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"

enum {
  FINER = 4, /* cells of the table for each point of a circle */
  MOST_CELLS = FINER * PENDRES_CIRCLE_MOST,
  CHAINS = 4,
  FIRST_LENGTH = 1024, /* steps of the first averages, ... */
  LENGTHS = 4,         /* ... each four times as long as the one before */
  TOGETHER = 4,        /* steps whose growth is averaged as that of one */
  SLIPS = 3,           /* past the place of a near lock, that a mean needs */
  SAMPLES = 24,        /* of shifts between neighbouring points of an orbit */
  CLOSER = 6,          /* rounds of a parabola through the three least ones */
  HALVINGS = 60
};

/* Averages, in turns, need not be better than this. */
static const double close_enough = 1e-11;
/* Averages that differ by more are not used. */
static const double same_mean = 1e-5;
/* If the motion is nowhere slower than elsewhere by more than this factor, it does not linger. */
static const double uneven = 4.0;
/* Orbits start this fraction of the circle apart, the golden angle. */
static const double golden = 0.38196601125010515;

/* A quintic in each cell, lengths in cells. */
typedef struct cell {
  double c[6];
} cell;

struct pendres_circle_table {
  size_t cells;
  double base;  /* whole turns that are subtracted, such that the rest moves forwards */
  double error; /* in radians */
  cell map[MOST_CELLS];
  double wrong[MOST_CELLS];
  double *weight[LENGTHS]; /* made when they are needed for the first time */
};

pendres_circle_table *pendres_circle_table_create(void)
{
  pendres_circle_table *t = calloc(1, sizeof *t);
  size_t n = FIRST_LENGTH;
  for (int i = 0; t != NULL && i < LENGTHS; i++, n *= 4) {
    t->weight[i] = malloc(n * sizeof **t->weight);
    if (t->weight[i] == NULL) {
      pendres_circle_table_free(t);
      return NULL;
    }
    t->weight[i][0] = -1.0;
  }
  return t;
}

void pendres_circle_table_free(pendres_circle_table *t)
{
  if (t == NULL) return;
  for (int i = 0; i < LENGTHS; i++) free(t->weight[i]);
  free(t);
}

void pendres_circle_table_set(pendres_circle_table *t, const pendres_trigonometric *move,
                              double error, const pendres_trigonometric *wrong)
{
  double f[3][MOST_CELLS + 1];
  const size_t cells = FINER * move->n;
  const double h = two_pi / (double)cells;
  double least = INFINITY, scale = 1.0 / h;
  t->cells = cells;
  t->error = error;
  for (int order = 0; order < 3; order++, scale *= h) {
    pendres_trigonometric_spread(move, order, cells, f[order]);
    for (size_t i = 0; i < cells; i++) f[order][i] *= scale;
    f[order][cells] = f[order][0];
  }
  for (size_t i = 0; i < cells; i++) least = fmin(least, f[0][i]);
  t->base = floor(least / (double)cells);
  for (size_t i = 0; i < cells; i++) {
    const double d0 = f[0][i + 1] - f[0][i] - f[1][i] - 0.5 * f[2][i];
    const double d1 = f[1][i + 1] - f[1][i] - f[2][i], d2 = f[2][i + 1] - f[2][i];
    t->map[i] = (cell){{f[0][i] - t->base * (double)cells, f[1][i], 0.5 * f[2][i],
                        10.0 * d0 - 4.0 * d1 + 0.5 * d2, -15.0 * d0 + 7.0 * d1 - d2,
                        6.0 * d0 - 3.0 * d1 + 0.5 * d2}};
  }
  pendres_trigonometric_spread(wrong, 0, cells, t->wrong);
}

/* ---- orbits of the map --------------------------------------------------------------------- */

/* How far the map moves a point u, in cells and not negative; *u becomes its image, less whole
   turns. */
static inline double advance(const pendres_circle_table *t, double *u)
{
  const long whole = (long)*u;
  const size_t i = (size_t)whole & (t->cells - 1);
  const double *c = t->map[i].c, s = *u - (double)whole, s2 = s * s;
  /* In pairs, so that additions wait less for one another. */
  const double moved =
    (c[0] + s * c[1]) + s2 * ((c[2] + s * c[3]) + s2 * (c[4] + s * c[5]));
  *u = (double)i + s + moved;
  return moved;
}

/* The factor by which a step stretches a tangent vector at a point. */
static inline double stretches(const pendres_circle_table *t, double u)
{
  const long whole = (long)u;
  const double *c = t->map[(size_t)whole & (t->cells - 1)].c, s = u - (double)whole;
  return (1.0 + c[1] + s * (2.0 * c[2])) +
         s * s * ((3.0 * c[3] + s * (4.0 * c[4])) + s * s * (5.0 * c[5]));
}

static const double *weights(pendres_circle_table *t, int length, size_t n)
{
  double *w = t->weight[length];
  if (w[0] >= 0.0) return w;
  for (size_t k = 0; k < n; k++) {
    const double at = ((double)k + 0.5) / (double)n;
    w[k] = exp(-1.0 / (at * (1.0 - at)));
  }
  return w;
}

/* The mean turns a period, and the scatter of those of the orbits. */
static double mean_turns(pendres_circle_table *t, int length, size_t n, double *apart)
{
  const double *w = weights(t, length, n), cells = (double)t->cells;
  double u[CHAINS], sum[CHAINS] = {0.0}, all = 0.0;
  for (int i = 0; i < CHAINS; i++) u[i] = cells * (i * golden - floor(i * golden));
  for (size_t k = 0; k < n; k++) {
    all += w[k];
    for (int i = 0; i < CHAINS; i++) sum[i] += w[k] * advance(t, &u[i]);
  }
  double low = INFINITY, high = -INFINITY, mean = 0.0;
  for (int i = 0; i < CHAINS; i++) {
    sum[i] /= all * cells;
    low = fmin(low, sum[i]);
    high = fmax(high, sum[i]);
    mean += sum[i] / CHAINS;
  }
  *apart = high - low;
  return t->base + mean;
}

/*
 * The effect of errors of the map on the mean. In the coordinate in which the motion is uniform, a
 * shift counts in proportion to the reciprocal of the tangent vector's length, whose mean over the
 * circle is one. The vector's growth, which is zero on average, is followed for that.
 */
static void doubt(pendres_circle_table *t, int length, size_t n, pendres_circle_turn *out)
{
  const double *w = weights(t, length, n);
  double u = 0.0, vector = 1.0, lengths = 0.0, counts = 0.0, off = 0.0, growth = 0.0, all = 0.0;
  for (size_t k = 0; k < n; k += TOGETHER) {
    double by = 1.0;
    for (size_t i = 0; i < TOGETHER; i++) {
      const double wrong = t->wrong[(size_t)u & (t->cells - 1)];
      by *= stretches(t, u);
      (void)advance(t, &u);
      lengths += vector * by;
      counts += 1.0 / (vector * by);
      off += fabs(wrong) / (vector * by);
    }
    vector *= by;
    growth += w[k + TOGETHER / 2] * log(by);
    all += TOGETHER * w[k + TOGETHER / 2];
  }
  const double mean = lengths / ((double)n * (double)n);
  out->growth = growth / all;
  out->turns_error += mean * (off + counts * t->error) / two_pi;
}

/* ---- locks --------------------------------------------------------------------------------- */

/* How far q steps move a point, less p turns, in cells. */
static double shift(const pendres_circle_table *t, int q, int p, double u)
{
  double moved = -((double)p - t->base * q) * (double)t->cells;
  u -= (double)t->cells * floor(u / (double)t->cells);
  for (int k = 0; k < q; k++) moved += advance(t, &u);
  return moved;
}

/* The interval from point 0 to the next one of its first q images: its images cover the circle. */
static double arc(const pendres_circle_table *t, int q)
{
  double u = 0.0, next = (double)t->cells;
  for (int k = 1; k < q; k++) {
    (void)advance(t, &u);
    u -= (double)t->cells * floor(u / (double)t->cells);
    if (u > 0.0) next = fmin(next, u);
  }
  return next;
}

/* The point of the least sign * shift, from the least of samples; *most: the largest of them. */
static double least_place(const pendres_circle_table *t, int q, int p, int sign, double *most)
{
  const double h = arc(t, q) / SAMPLES;
  double best = 0.0, least = INFINITY, step = h;
  *most = -INFINITY;
  for (int i = 0; i < SAMPLES; i++) {
    const double g = sign * shift(t, q, p, i * h);
    *most = fmax(*most, g);
    if (!(g < least)) continue;
    least = g;
    best = i * h;
  }
  for (int k = 0; k < CLOSER; k++, step *= 0.25) {
    const double behind = sign * shift(t, q, p, best - step);
    const double ahead = sign * shift(t, q, p, best + step);
    const double bend = behind - 2.0 * least + ahead;
    double to = behind < ahead ? -step : step;
    if (bend > 0.0) to = fmax(-step, fmin(step, 0.5 * step * (behind - ahead) / bend));
    const double g = sign * shift(t, q, p, best + to);
    if (!(g < least)) continue;
    least = g;
    best += to;
  }
  return best;
}

/* An extreme shift: its point, in cells; the factor by which an error of the map enters into it;
   the shift itself, in rad; and the other extreme of the samples, likewise. */
typedef struct extreme {
  double at, worth, shift, other;
} extreme;

static extreme find_extreme(const pendres_circle_table *t, int q, int p, int sign)
{
  const double h = two_pi / (double)t->cells;
  extreme e = {.worth = 0.0};
  e.at = least_place(t, q, p, sign, &e.other);
  e.other *= h * sign;
  e.shift = h * shift(t, q, p, e.at);
  double u = e.at - (double)t->cells * floor(e.at / (double)t->cells);
  for (int k = 0; k < q; k++) {
    e.worth = e.worth * stretches(t, u) + 1.0;
    (void)advance(t, &u);
  }
  return e;
}

double pendres_circle_table_edge(const pendres_circle_table *t, int q, int p, int sign,
                                 double *worth)
{
  const extreme e = find_extreme(t, q, p, sign);
  *worth = e.worth;
  return e.shift;
}

/* The stable point between a point that is moved forwards and the next one that is moved back. */
static double stable_place(const pendres_circle_table *t, int q, int p, double forwards,
                           double back)
{
  while (back < forwards) back += arc(t, q);
  while (back - forwards > arc(t, q)) back -= arc(t, q);
  for (int k = 0; k < HALVINGS; k++) {
    const double middle = 0.5 * (forwards + back);
    if (shift(t, q, p, middle) > 0.0) forwards = middle;
    else back = middle;
  }
  return 0.5 * (forwards + back);
}

/* Whether the motion is locked with q periods and p turns. If it is not, *even says whether it
   lingers nowhere, so that averages need not include passages of the lock's place. */
static pendres_circle_motion try_lock(const pendres_circle_table *t, int q, int p,
                                      pendres_circle_turn *out, int *even)
{
  const double h = two_pi / (double)t->cells;
  double most = 0.0, off = 0.0;
  for (size_t i = 0; i < t->cells; i++) off = fmax(off, fabs(t->wrong[i]));
  const int sign = out->turns * q >= p ? 1 : -1;
  const extreme e = find_extreme(t, q, p, sign);
  const double g = sign * e.shift, error = e.worth * (t->error + off);
  *even = g > error && sign * e.other < uneven * g;
  if (g > error) return PENDRES_CIRCLE_UNLOCKED;
  const double other = least_place(t, q, p, -sign, &most);
  if (g > -error || h * sign * shift(t, q, p, other) < error) return PENDRES_CIRCLE_UNKNOWN;
  out->y = h * (sign > 0 ? stable_place(t, q, p, other, e.at)
                         : stable_place(t, q, p, e.at, other));
  out->period = q;
  out->winding = p;
  out->turns = (double)p / q;
  return PENDRES_CIRCLE_LOCKED;
}

/* The lock nearest to a mean, relative to its period: one of the continued fraction's
   convergents. */
static void nearest_lock(double turns, double n, int *q, int *p, double *slips)
{
  double x = turns, q0 = 0.0, q1 = 1.0, p0 = 1.0, p1 = floor(x);
  *slips = INFINITY;
  while (q1 <= PENDRES_CIRCLE_LONGEST) {
    const double passed = fabs(turns * q1 - p1) * n;
    if (passed < *slips) {
      *slips = passed;
      *q = (int)q1;
      *p = (int)p1;
    }
    if (passed < SLIPS) return;
    const double rest = x - floor(x);
    if (!(rest > 1e-12)) return;
    x = 1.0 / rest;
    const double q2 = floor(x) * q1 + q0, p2 = floor(x) * p1 + p0;
    q0 = q1;
    p0 = p1;
    q1 = q2;
    p1 = p2;
  }
}

pendres_circle_turn pendres_circle_table_turn(pendres_circle_table *t)
{
  pendres_circle_turn out = {.motion = PENDRES_CIRCLE_UNKNOWN};
  size_t n = FIRST_LENGTH;
  int q = 0, p = 0, tried_q = 0, tried_p = 0, used = 0, even = 0;
  for (int length = 0; length < LENGTHS; length++, n *= 4) {
    double apart = 0.0, slips = 0.0;
    out.turns = mean_turns(t, length, n, &apart);
    nearest_lock(out.turns, (double)n, &q, &p, &slips);
    if (slips < SLIPS && (q != tried_q || p != tried_p)) {
      const pendres_circle_motion motion = try_lock(t, q, p, &out, &even);
      if (motion != PENDRES_CIRCLE_UNLOCKED) {
        out.motion = motion;
        return out;
      }
      tried_q = q;
      tried_p = p;
    }
    out.turns_error = apart;
    if ((slips < SLIPS && !even) || !(apart < same_mean)) continue;
    out.motion = PENDRES_CIRCLE_UNLOCKED;
    used = length;
    if (apart < fmax(close_enough, 0.1 * t->error)) break;
  }
  if (out.motion == PENDRES_CIRCLE_UNLOCKED)
    doubt(t, used, (size_t)FIRST_LENGTH << 2 * used, &out);
  return out;
}
