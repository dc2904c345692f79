/* dimension.c -- dimensions of attractors; see dimension.h. */
#include <pendres/dimension.h>

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/chaos/numbers.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/threads.h"
#include "model/equation.h"

enum {
  BINS = PENDRES_CORRELATION_SCALES,
  TILE = 256,     /* points that are compared at a time */
  TABLES = 4     /* histograms that take pairs in turn, so that no addition waits for the last */
};

static const double ln2 = 0.69314718055994530942;

typedef struct survey {
  size_t n;
  const double *x, *v; /* x in units of `extent`, from 0 to turn */
  double turn;
  double extent;       /* the longest distance that there can be */
  /* Pairs between stretches a <= b: [a][b][k] at distances from extent / 2^((k+1)/2) to
     extent / 2^(k/2). */
  uint64_t pairs[BATCHES][BATCHES][BINS];
} survey;

static size_t first_of(const survey *s, int stretch)
{
  return s->n * (size_t)stretch / BATCHES;
}

/* ---- counting ------------------------------------------------------------------------------ */

/* Count the pairs of point i with points from `first` to below `last`. */
static void count_row(const survey *s, size_t i, size_t first, size_t last,
                      uint64_t table[TABLES][BINS])
{
  double square[TILE];
  const double x = s->x[i], v = s->v[i], turn = s->turn;
  const size_t n = last - first;
  for (size_t k = 0; k < n; k++) {
    const double across = fabs(s->x[first + k] - x), around = turn - across;
    const double dx = around < across ? around : across, dv = s->v[first + k] - v;
    square[k] = dx * dx + dv * dv;
  }
  for (size_t k = 0; k < n; k++) {
    /* The binary exponent: each is a factor of two of the square. 1022 is that of 1/2 to 1. */
    uint64_t bits;
    memcpy(&bits, &square[k], sizeof bits);
    const int64_t below = 1022 - (int64_t)(bits >> 52);
    table[k % TABLES][below < 0 ? 0 : below < BINS ? below : BINS - 1]++;
  }
}

static pendres_status count_stretches(pendres_context *ctx, survey *s, int a, int b)
{
  uint64_t table[TABLES][BINS] = {{0}};
  for (size_t i = first_of(s, a); i < first_of(s, a + 1); i++) {
    const size_t last = first_of(s, b + 1);
    size_t first = first_of(s, b);
    if (first < i + DIMENSION_APART) first = i + DIMENSION_APART;
    for (; first < last; first += TILE)
      count_row(s, i, first, last - first < TILE ? last : first + TILE, table);
    if (i % 64 == 0) {
      const pendres_status status = pendres_context_poll(ctx);
      if (status != PENDRES_OK) return status;
    }
  }
  for (int k = 0; k < BINS; k++)
    for (int t = 0; t < TABLES; t++) s->pairs[a][b][k] += table[t][k];
  return PENDRES_OK;
}

/* Pairs of stretches by number, a + BATCHES b: those with a <= b are counted. */
static pendres_status count_some(pendres_context *ctx, size_t first, size_t count, void *arg)
{
  pendres_status status = PENDRES_OK;
  for (size_t i = first; i < first + count && status == PENDRES_OK; i++) {
    const int a = (int)(i % BATCHES), b = (int)(i / BATCHES);
    if (a <= b) status = count_stretches(ctx, arg, a, b);
  }
  return status;
}

/* ---- slopes -------------------------------------------------------------------------------- */

/* Pairs closer than each of the distances, without those of one stretch (-1: with all); how many
   there are in all. */
static double sums(const survey *s, int without, double closer[BINS])
{
  double all = 0.0;
  for (int k = 0; k < BINS; k++) closer[k] = 0.0;
  for (int a = 0; a < BATCHES; a++)
    for (int b = a; b < BATCHES; b++)
      for (int k = 0; k < BINS && a != without && b != without; k++)
        closer[k] += (double)s->pairs[a][b][k];
  for (int k = BINS - 2; k >= 0; k--) closer[k] += closer[k + 1];
  all = closer[0];
  return all;
}

/* The slope of log pairs against log distance, from distance number `from` to number `to`. */
static double slope(const double closer[BINS], int from, int to)
{
  const double middle = 0.5 * (from + to);
  double up = 0.0, square = 0.0;
  for (int k = from; k <= to; k++) {
    up -= (k - middle) * log(closer[k]);
    square += (k - middle) * (k - middle);
  }
  return 2.0 * up / (ln2 * square); /* a step is half a factor of two */
}

/* The standard error, from values that each leave out one stretch. */
static double jackknife(const double value[BATCHES])
{
  double mean = 0.0, square = 0.0;
  for (int a = 0; a < BATCHES; a++) mean += value[a] / BATCHES;
  for (int a = 0; a < BATCHES; a++) square += (value[a] - mean) * (value[a] - mean);
  return sqrt(square * (BATCHES - 1.0) / BATCHES);
}

static void judge(const survey *s, double resolution, pendres_correlation *out)
{
  double closer[BINS], less[BATCHES][BINS], all_less[BATCHES], value[BATCHES];
  const double all = sums(s, -1, closer);
  int from = 0, to = 0;
  for (int a = 0; a < BATCHES; a++) all_less[a] = sums(s, a, less[a]);
  while (from < BINS && exp2(-0.5 * from) > dimension_close_by) from++;
  for (to = from; to < BINS - 1; to++)
    if (closer[to + 1] < DIMENSION_FEWEST || s->extent * exp2(-0.5 * (to + 1)) < resolution) break;
  out->scales = to + 1;
  for (int k = 0; k <= to; k++) {
    const int at = to - k;
    out->distance[at] = s->extent * exp2(-0.5 * k);
    out->sum[at] = closer[k] / all;
    for (int a = 0; a < BATCHES; a++) value[a] = less[a][k] / all_less[a];
    out->sum_error[at] = jackknife(value);
  }
  if (to - from + 1 < DIMENSION_LEAST) return;
  const int half = (from + to) / 2, quarter = (to - from) / 4;
  for (int a = 0; a < BATCHES; a++) value[a] = slope(less[a], from, to);
  out->dimension = slope(closer, from, to);
  const double ends = slope(closer, from, half) - slope(closer, half, to);
  const double middle = slope(closer, from + quarter, to - quarter) - out->dimension;
  out->dimension_error = 2.0 * jackknife(value) + fmax(fabs(ends), fabs(middle)) +
                         dimension_rounding;
  out->longest = s->extent * exp2(-0.5 * from);
  out->shortest = s->extent * exp2(-0.5 * to);
}

/* ---- the calls ----------------------------------------------------------------------------- */

/* The points in units of their extent, x within one turn. */
static void place(survey *s, const double *x, const double *v, double turn, double *to_x,
                  double *to_v)
{
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (size_t i = 0; i < s->n; i++) {
    to_x[i] = turn > 0.0 ? x[i] - turn * floor(x[i] / turn) : x[i];
    to_v[i] = v[i];
    low[0] = fmin(low[0], to_x[i]);
    high[0] = fmax(high[0], to_x[i]);
    low[1] = fmin(low[1], v[i]);
    high[1] = fmax(high[1], v[i]);
  }
  /* A little more than the longest distance, for rounding. */
  double across = high[0] - low[0];
  if (turn > 0.0) across = fmin(across, 0.5 * turn);
  s->extent = hypot(across, high[1] - low[1]) * (1.0 + 1e-12);
  s->turn = turn > 0.0 ? turn / s->extent : INFINITY;
  for (size_t i = 0; i < s->n && s->extent > 0.0; i++) {
    to_x[i] /= s->extent;
    to_v[i] /= s->extent;
  }
  s->x = to_x;
  s->v = to_v;
}

static pendres_status measure(pendres_context *ctx, survey *s, double resolution,
                              pendres_correlation *out)
{
  *out = (pendres_correlation){
    .dimension = NAN, .dimension_error = NAN, .shortest = NAN, .longest = NAN};
  /* All points are one, within the resolution. */
  if (s->extent <= resolution) {
    out->dimension = out->dimension_error = 0.0;
    return PENDRES_OK;
  }
  const pendres_status status = pendres_threads_run(ctx, BATCHES * BATCHES, 1, count_some, s);
  if (status == PENDRES_OK) judge(s, resolution, out);
  return status;
}

static pendres_status correlation_measure(pendres_context *ctx, const pendres_section *section,
                                          double resolution, pendres_correlation *out)
{
  if (section == NULL || section->x == NULL || section->v == NULL || out == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "section, its x and v, and out");
  const size_t n = section->n;
  const double *x = section->x, *v = section->v, turn = section->turn;
  if (n < 2 || !(turn >= 0.0) || !(resolution >= 0.0) || !isfinite(turn))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "two points or more, a turn and a resolution that are not "
                                "negative, please");
  for (size_t i = 0; i < n; i++)
    if (!isfinite(x[i]) || !isfinite(v[i]))
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "point %zu is no number", i);
  pendres_room room = pendres_room_open(ctx, "points");
  survey *s = pendres_room_take(&room, 1, sizeof *s);
  double *x_in_units = pendres_room_take(&room, n, sizeof *x_in_units);
  double *v_in_units = pendres_room_take(&room, n, sizeof *v_in_units);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  s->n = n;
  place(s, x, v, turn, x_in_units, v_in_units);
  return pendres_room_close(&room, measure(ctx, s, resolution, out));
}

pendres_status pendres_correlation_find(pendres_context *ctx, const pendres_section *section,
                                        double resolution, pendres_correlation *out)
{
  return PENDRES_CONTEXT_CALL(ctx, correlation_measure(ctx, section, resolution, out));
}

double pendres_lyapunov_dimension(const pendres_pendulum *p, double exponent,
                                  double exponent_error, double *error)
{
  const double rate =
    pendres_pendulum_check(p, NULL) == PENDRES_OK ? pendres_equation_contraction(p) : NAN;
  const int known = rate > 0.0 && isfinite(exponent) && exponent != 0.0;
  if (error != NULL) *error = NAN;
  if (!known) return NAN;
  const double both = exponent + rate;
  if (error != NULL)
    *error = exponent < 0.0 ? 0.0 : rate / (both * both) * fabs(exponent_error);
  return exponent < 0.0 ? 0.0 : 1.0 + exponent / both;
}
