/* charts.c -- the strobe map of weakly damped pendulums by charts; see charts.h. */
#include "engine/charts.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "base/grow.h"
#include "engine/chart.h"
#include "engine/context_internal.h"
#include "engine/kernels/coordinates.h"
#include "engine/numbers.h"
#include "engine/steps.h"
#include "model/equation.h"
#include "model/model.h"

enum { PLACES = PENDRES_CHART_PLACES, SIDE = 2 * CHARTS_FAR };

typedef enum square_state {
  SQUARE_NEW,
  SQUARE_CHARTED,
  SQUARE_DIVIDED,
  SQUARE_NOT /* it cannot be charted, nor divided any further */
} square_state;

typedef struct square {
  square_state state;
  size_t at; /* the number of its chart, or of the first of its four parts; of a new one: how often
                it is to be divided before a chart is tried */
} square;

typedef struct charted {
  pendres_chart map;
  double missed; /* by the image, at most */
  double added;  /* variance */
} charted;

/* The charts over one number of periods. */
typedef struct level {
  size_t squares, square_room, count, room;
  square *square; /* those that cover the plane come first */
  charted *chart;
} level;

struct pendres_charts {
  pendres_pendulum pendulum;
  size_t bottoms;
  double bottom[PENDRES_CHARTS_BOTTOMS];
  double settling; /* periods in which a small oscillation decays to 1/e */
  int levels;
  level level[CHARTS_LEVELS];
  unsigned long used;
};

struct pendres_charts_memo {
  size_t count;
  unsigned long clock;
  pendres_charts *charts[CHARTS_KEPT];
};

/* A square, by its centre. */
typedef struct place {
  double y, w, half;
} place;

static long periods_of(int number)
{
  return number > 0 ? CHARTS_TIMES * periods_of(number - 1) : 1;
}

int pendres_charts_worth(const pendres_context *ctx, const pendres_pendulum *p)
{
  return ctx->options.method == PENDRES_BLOCK_FIXED && ctx->options.steps_per_period == 0 &&
         pendres_equation_undamped(p) == NULL && pendres_model_settling(p) >= charts_worth;
}

/* ---- what a context keeps ---- */

static void charts_free(pendres_charts *c)
{
  if (c == NULL) return;
  for (int k = 0; k < CHARTS_LEVELS; k++) {
    free(c->level[k].square);
    free(c->level[k].chart);
  }
  free(c);
}

void pendres_charts_memo_free(pendres_charts_memo *memo)
{
  if (memo == NULL) return;
  for (size_t i = 0; i < memo->count; i++) charts_free(memo->charts[i]);
  free(memo);
}

static pendres_status no_memory(pendres_context *ctx)
{
  return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for charts");
}

static pendres_charts *charts_make(const pendres_pendulum *p, size_t n, const double *bottom)
{
  pendres_charts *c = calloc(1, sizeof *c);
  if (c == NULL) return NULL;
  c->pendulum = *p;
  for (c->bottoms = 0; c->bottoms < n && c->bottoms < PENDRES_CHARTS_BOTTOMS; c->bottoms++)
    c->bottom[c->bottoms] = bottom[c->bottoms];
  c->settling = pendres_model_settling(p);
  while (c->levels < CHARTS_LEVELS &&
         (double)periods_of(c->levels) <= charts_longest * c->settling)
    c->levels++;
  for (int k = 0; k < c->levels; k++) {
    level *l = &c->level[k];
    l->square = calloc(SIDE * SIDE, sizeof *l->square);
    if (l->square == NULL) {
      charts_free(c);
      return NULL;
    }
    l->squares = l->square_room = SIDE * SIDE;
  }
  return c;
}

pendres_status pendres_charts_of(pendres_context *ctx, const pendres_pendulum *p, size_t n,
                                 const double *bottom, pendres_charts **out)
{
  if (ctx->charts == NULL) ctx->charts = calloc(1, sizeof *ctx->charts);
  pendres_charts_memo *memo = ctx->charts;
  if (memo == NULL) return no_memory(ctx);
  size_t oldest = 0, charted = 0;
  memo->clock++;
  for (size_t i = 0; i < memo->count; i++) {
    *out = memo->charts[i];
    if (pendres_model_same(&(*out)->pendulum, p)) {
      (*out)->used = memo->clock;
      return PENDRES_OK;
    }
    if (memo->charts[i]->used < memo->charts[oldest]->used) oldest = i;
    for (int k = 0; k < CHARTS_LEVELS; k++) charted += memo->charts[i]->level[k].count;
  }
  *out = charts_make(p, n, bottom);
  if (*out == NULL) return no_memory(ctx);
  (*out)->used = memo->clock;
  if (oldest < memo->count && (memo->count == CHARTS_KEPT || charted > CHARTS_MOST)) {
    charts_free(memo->charts[oldest]);
    memo->charts[oldest] = *out;
  } else {
    memo->charts[memo->count++] = *out;
  }
  return PENDRES_OK;
}

/* ---- making a chart ---- */

static double distance_of(const pendres_charts *c, const place *at)
{
  double distance = INFINITY;
  for (size_t i = 0; i < c->bottoms; i++)
    distance = fmin(distance, hypot(at->y - c->bottom[i], at->w));
  return distance;
}

/* What may be missed in a period: a share of the distance of the place in the square that is next
   to the bottom, a little more than half a diagonal from its centre. */
static double tolerance(const pendres_charts *c, const place *at)
{
  return charts_missed / c->settling * fmax(distance_of(c, at) - 1.5 * at->half, at->half);
}

/* Follow places over one period by the integrator. */
static pendres_status integrate(pendres_context *ctx, const pendres_charts *c, const place *at,
                                pendres_strobe_lane *lanes, int *known)
{
  const double omega = c->pendulum.drive_frequency, half = at->half;
  const double x = fabs(at->y) + half, v = (fabs(at->w) + half) * omega;
  const double origin = pendres_model_origin(&c->pendulum);
  const double speed = fmax(pendres_steps_speed(&c->pendulum, origin + x, v),
                            pendres_steps_speed(&c->pendulum, origin - x, v));
  int steps = 0;
  *known = 0;
  pendres_status status =
    pendres_steps_choose(ctx, &c->pendulum, speed, charts_integrated * tolerance(c, at), &steps);
  if (status == PENDRES_TOLERANCE_UNREACHABLE) return PENDRES_OK;
  for (int i = 0; i < PLACES; i++) lanes[i].steps = steps;
  const pendres_uncounted work = pendres_uncounted_begin(ctx);
  if (status == PENDRES_OK) status = pendres_strobe_run_until(ctx, PLACES, lanes, 1);
  pendres_uncounted_end(ctx, &work);
  *known = status == PENDRES_OK;
  return status;
}

/* The same over eight times the periods of charts that there are; *missed: what these miss together
   at most. */
static pendres_status repeat(pendres_context *ctx, pendres_charts *c, int number,
                             pendres_strobe_lane *lanes, double *missed, int *known);

/* How often a square is to be divided until a chart may miss no more than it may. */
static size_t divisions(double missed, double may)
{
  size_t times = 0;
  while (missed > may && isfinite(missed)) {
    missed /= charts_falls;
    times++;
  }
  return isfinite(missed) ? times : 1;
}

/* Chart a square. *divided: how often it is to be divided before a chart is known; 0: it is. */
static pendres_status chart_square(pendres_context *ctx, pendres_charts *c, int number,
                                   const place *at, charted *out, size_t *divided)
{
  const double turn = pendres_model_turn(&c->pendulum);
  pendres_strobe_lane lanes[PLACES];
  double image[PLACES][2], most = 0.0;
  for (int i = 0; i < PLACES; i++) {
    double a, b;
    pendres_chart_place(i, &a, &b);
    lanes[i] = (pendres_strobe_lane){
      .pendulum = &c->pendulum, .y = at->y + at->half * a, .w = at->w + at->half * b};
    pendres_coordinates_wrap(&c->pendulum, &lanes[i].y, &lanes[i].turns);
  }
  double before = charts_integrated * tolerance(c, at);
  int known = 0;
  const pendres_status status = number == 0
                                  ? integrate(ctx, c, at, lanes, &known)
                                  : repeat(ctx, c, number - 1, lanes, &before, &known);
  *divided = 1;
  if (status != PENDRES_OK || !known) return status;
  for (int i = 0; i < PLACES; i++) {
    const pendres_strobe_lane *l = &lanes[i];
    image[i][0] = l->turns != 0 ? l->y + turn * (double)l->turns : l->y;
    image[i][1] = l->w;
    most = fmax(most, l->off.yy + l->off.ww);
  }
  const double missed = pendres_chart_fit((const double (*)[2])image, &out->map);
  const double own = charts_between * missed, periods = (double)periods_of(number);
  /* Nearer than what shorter charts miss no other can come to them. */
  *divided = divisions(missed, fmax(before, tolerance(c, at) * periods));
  out->missed = own + before;
  const double each = number == 0 ? out->missed : own;
  out->added = most + each * each * fmax(1.0, 2.0 * c->settling / periods);
  return status;
}

/* ---- squares ---- */

/* The least half side of a square: a pendulum that winds round comes back to it so often that it is
   worth charting. */
static double least_side(const pendres_charts *c, int number, const place *at)
{
  const double share = sqrt(charts_rounds / c->settling) * (double)(1 << number);
  return fmax(charts_smallest, distance_of(c, at) * share);
}

/* Divide a square, so many times before charts are tried. */
static pendres_status divide(pendres_context *ctx, level *l, size_t s, size_t times)
{
  const size_t first = l->squares;
  if (first + 4 > l->square_room) {
    const size_t larger = l->square_room + l->square_room / 2;
    if (!pendres_regrow(&l->square, larger, sizeof *l->square)) return no_memory(ctx);
    l->square_room = larger;
  }
  for (size_t k = 0; k < 4; k++) l->square[first + k] = (square){SQUARE_NEW, times - 1};
  l->squares += 4;
  l->square[s] = (square){SQUARE_DIVIDED, first};
  return PENDRES_OK;
}

static pendres_status find(pendres_context *ctx, pendres_charts *c, int number,
                           const pendres_strobe_lane *lane, const charted **out, place *at);

/* Chart a new square that a lane is in, or divide it, or find that neither is possible. Over more
   periods no larger square is tried than over fewer. */
static pendres_status open_square(pendres_context *ctx, pendres_charts *c, int number, size_t s,
                                  const place *at, const pendres_strobe_lane *lane)
{
  level *l = &c->level[number];
  charted made;
  size_t divided = l->square[s].at;
  pendres_status status = PENDRES_OK;
  if (number > 0 && divided == 0) {
    const charted *chart;
    place within;
    status = find(ctx, c, number - 1, lane, &chart, &within);
    divided = chart == NULL || within.half < at->half;
  }
  if (status == PENDRES_OK && divided == 0)
    status = chart_square(ctx, c, number, at, &made, &divided);
  if (status != PENDRES_OK) return status;
  if (divided == 0) {
    charted *grown = pendres_grow(l->chart, l->count, &l->room, sizeof *grown);
    if (grown == NULL) return no_memory(ctx);
    l->chart = grown;
    l->chart[l->count] = made;
    l->square[s] = (square){SQUARE_CHARTED, l->count++};
  } else if (at->half >= least_side(c, number, at)) {
    status = divide(ctx, l, s, divided);
  } else {
    l->square[s].state = SQUARE_NOT;
  }
  return status;
}

/* Find the chart of the square that a lane is in; *out: NULL where there is none, else valid until
   another is made. */
static pendres_status find(pendres_context *ctx, pendres_charts *c, int number,
                           const pendres_strobe_lane *lane, const charted **out, place *at)
{
  const double y = lane->y, w = lane->w;
  *out = NULL;
  if (!(fabs(y) < CHARTS_FAR && fabs(w) < CHARTS_FAR)) return PENDRES_OK;
  level *l = &c->level[number];
  *at = (place){floor(y) + 0.5, floor(w) + 0.5, 0.5};
  size_t s = (size_t)(floor(y) + CHARTS_FAR) * SIDE + (size_t)(floor(w) + CHARTS_FAR);
  for (;;) {
    if (l->square[s].state == SQUARE_NEW) {
      const pendres_status status = open_square(ctx, c, number, s, at, lane);
      if (status != PENDRES_OK) return status;
    }
    if (l->square[s].state != SQUARE_DIVIDED) break;
    const int right = y >= at->y, above = w >= at->w;
    at->half *= 0.5;
    at->y += right ? at->half : -at->half;
    at->w += above ? at->half : -at->half;
    s = l->square[s].at + (size_t)(2 * right + above);
  }
  if (l->square[s].state == SQUARE_CHARTED) *out = &l->chart[l->square[s].at];
  return PENDRES_OK;
}

/* ---- advancing ---- */

/* Put a lane where a chart maps it to. */
static void move(const charted *chart, const place *at, long periods, pendres_strobe_lane *lane)
{
  double image[2], d[2][2];
  const double per = 1.0 / at->half;
  pendres_chart_kernel()->at(&chart->map, (lane->y - at->y) * per, (lane->w - at->w) * per, image,
                             d);
  const pendres_flow_error e = lane->off;
  const double yy = d[0][0] * per, yw = d[0][1] * per, wy = d[1][0] * per, ww = d[1][1] * per;
  lane->off.yy = yy * yy * e.yy + 2.0 * yy * yw * e.yw + yw * yw * e.ww + chart->added;
  lane->off.yw = yy * wy * e.yy + (yy * ww + yw * wy) * e.yw + yw * ww * e.ww;
  lane->off.ww = wy * wy * e.yy + 2.0 * wy * ww * e.yw + ww * ww * e.ww + chart->added;
  lane->y = image[0];
  lane->w = image[1];
  lane->period += periods;
  pendres_coordinates_arrive(lane->pendulum, &lane->y, &lane->w, &lane->turns);
  const double off = lane->off.yy + lane->off.ww;
  if (!(off <= lane->worst)) lane->worst = off;
}

static pendres_status repeat(pendres_context *ctx, pendres_charts *c, int number,
                             pendres_strobe_lane *lanes, double *missed, int *known)
{
  pendres_status status = PENDRES_OK;
  *known = 0;
  *missed = 0.0;
  for (int i = 0; i < PLACES && status == PENDRES_OK; i++) {
    double together = 0.0;
    for (int k = 0; k < CHARTS_TIMES; k++) {
      const charted *chart;
      place at;
      status = find(ctx, c, number, &lanes[i], &chart, &at);
      if (status != PENDRES_OK || chart == NULL) return status;
      move(chart, &at, periods_of(number), &lanes[i]);
      together += chart->missed;
    }
    *missed = fmax(*missed, together);
  }
  *known = status == PENDRES_OK;
  return status;
}

int pendres_charts_levels(const pendres_charts *c)
{
  return c->levels;
}

long pendres_charts_periods(int number)
{
  return periods_of(number);
}

pendres_status pendres_charts_advance(pendres_context *ctx, pendres_charts *c, int highest,
                                      pendres_strobe_lane *lane, int *number)
{
  const charted *chart = NULL;
  place at;
  pendres_status status = PENDRES_OK;
  for (*number = highest; *number >= 0; --*number) {
    status = find(ctx, c, *number, lane, &chart, &at);
    if (status != PENDRES_OK) return status;
    if (chart != NULL) break;
  }
  if (chart == NULL) return status;
  move(chart, &at, periods_of(*number), lane);
  ctx->cost.pendulum_periods += (double)periods_of(*number);
  ctx->cost.rhs_evaluations += charts_slopes;
  return status;
}
