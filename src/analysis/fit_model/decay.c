/*
 * decay.c -- a free decay: the motion at the data's times, and its derivatives; see internal.h.
 *
 * The clock of a block is a drive's, which is absent here: its period is 2 pi canonical units of
 * time. States go first, period after period; the derivatives over all periods then follow side by
 * side, and are multiplied.
 */
#include "analysis/fit_model/internal.h"

#include <math.h>
#include <string.h>

#include "base/angles.h"
#include "engine/block.h"
#include "engine/steps.h"

enum { STARTS = 2, COLUMNS = STARTS + PENDRES_PARAMETER_FOLLOWED };

typedef struct decay {
  fit_model *m;
  pendres_u u;
  pendres_pendulum pendulum;
  double rate; /* the model's time over the data's */
  int steps;
  size_t periods;
  double *y, *w; /* [periods] states at their beginnings */
  double by[2][COLUMNS]; /* derivatives of the state at the beginning of a period */
  size_t next; /* station */
} decay;

static int is_finite(const double *x, size_t n)
{
  for (size_t i = 0; i < n; i++)
    if (!isfinite(x[i])) return 0;
  return 1;
}

static double time_of(const decay *d, size_t station)
{
  return d->rate * (d->m->station[station].axis - d->m->station[0].axis);
}

/* ---- states ---- */

static pendres_status run_states(decay *d)
{
  pendres_block *b;
  pendres_status status = pendres_block_open(d->m->ctx, PENDRES_FLOW_STATE, d->steps, &b);
  if (status != PENDRES_OK) return status;
  pendres_block_resize(b, 1);
  pendres_block_load(b, 0, &d->pendulum, d->y[0], d->w[0]);
  for (size_t k = 1; k < d->periods && status == PENDRES_OK; k++) {
    status = pendres_block_period(b);
    const pendres_rows rows = pendres_block_rows(b);
    d->y[k] = pendres_rows_get(&rows, PENDRES_ROW_Y, 0);
    d->w[k] = pendres_rows_get(&rows, PENDRES_ROW_W, 0);
  }
  return status;
}

/* ---- between samples ---- */

/* The cubic with these values and slopes at the ends of a step, at the share t of it. */
static double cubic(double step, double t, const double f[2], const double slope[2])
{
  const double d = f[1] - f[0], a = step * slope[0], b = step * slope[1];
  return f[0] + t * (a + t * (3.0 * d - 2.0 * a - b + t * (a + b - 2.0 * d)));
}

/* The quintic that has the second derivatives as well; *out_slope: that of it. */
static double quintic(double step, double t, const double f[2], const double slope[2],
                      const double bend[2], double *out_slope)
{
  const double a = step * slope[0], c = 0.5 * step * step * bend[0];
  const double p = f[1] - f[0] - a - c;
  const double q = step * slope[1] - a - 2.0 * c, r = step * step * bend[1] - 2.0 * c;
  const double c3 = 10.0 * p - 4.0 * q + 0.5 * r, c4 = -15.0 * p + 7.0 * q - r;
  const double c5 = 6.0 * p - 3.0 * q + 0.5 * r;
  *out_slope = (a + t * (2.0 * c + t * (3.0 * c3 + t * (4.0 * c4 + t * 5.0 * c5)))) / step;
  return f[0] + t * (a + t * (c + t * (c3 + t * (c4 + t * c5))));
}

/* A row derived by something, and its slope, between samples k and k + 1. */
static double between(const fit_samples *s, size_t lane, size_t k, double step, double t, int row)
{
  const double f[2] = {pendres_fit_sample(s, lane, k, row),
                       pendres_fit_sample(s, lane, k + 1, row)};
  const double slope[2] = {pendres_fit_sample(s, lane, k, row + 1),
                           pendres_fit_sample(s, lane, k + 1, row + 1)};
  return cubic(step, t, f, slope);
}

static int row_of(const fit_model *m, int parameter)
{
  return PENDRES_ROW_BY_PARAMETERS + 2 * m->parameter[parameter];
}

/* The same of a derivative by the state at the period's beginning, whose second derivatives follow
   from those of the force, by y and w at both samples: a linear motion is such derivatives times
   its start, and what they were off by would seem to tell the one from the other. */
static double by_start(const fit_samples *s, size_t lane, size_t k, double t, int row,
                       double force[2][2])
{
  double f[2], slope[2], bend[2], unused;
  for (size_t i = 0; i < 2; i++) {
    f[i] = pendres_fit_sample(s, lane, k + i, row);
    slope[i] = pendres_fit_sample(s, lane, k + i, row + 1);
    bend[i] = force[i][0] * f[i] + force[i][1] * slope[i];
  }
  return quintic(two_pi / (double)s->steps, t, f, slope, bend, &unused);
}

/* ---- stations ---- */

/* The motion at a station, which is in the period of this lane. */
static void measure(decay *d, const fit_samples *s, size_t lane, size_t period, fit_station *at)
{
  fit_model *m = d->m;
  const double step = two_pi / (double)d->steps, origin = pendres_model_of(m->base.force)->origin;
  const double time = time_of(d, d->next), theta = time - two_pi * (double)period;
  const size_t last = (size_t)d->steps - 1;
  const size_t k = theta > 0.0 ? (size_t)fmin(floor(theta / step), (double)last) : 0;
  const double t = theta / step - (double)k;
  double y[2], w[2], bend[2], force[2][2], velocity;
  for (size_t i = 0; i < 2; i++) {
    y[i] = pendres_fit_sample(s, lane, k + i, PENDRES_ROW_Y);
    w[i] = pendres_fit_sample(s, lane, k + i, PENDRES_ROW_W);
    bend[i] = pendres_pendulum_acceleration(&d->pendulum, y[i] + origin, w[i], 0.0);
    pendres_model_jacobian(&d->pendulum, y[i] + origin, w[i], &force[i][0], &force[i][1]);
  }
  fit_lane *l = &m->lane[m->lanes];
  *l = (fit_lane){.border = {0.0, 0.0, 1.0}, .found = 1, .stable = 1};
  memcpy(l->u, d->u, sizeof l->u);
  l->base[PENDRES_FIT_DISPLACEMENT] = quintic(step, t, y, w, bend, &velocity);
  l->u[PENDRES_U_Y] = l->base[PENDRES_FIT_DISPLACEMENT];
  l->u[PENDRES_U_W] = velocity;
  l->time_slope = velocity * time;
  const double of_y = by_start(s, lane, k, t, PENDRES_ROW_BY_Y, force);
  const double of_w = by_start(s, lane, k, t, PENDRES_ROW_BY_W, force);
  for (int c = 0; c < STARTS; c++) l->start_slope[c] = of_y * d->by[0][c] + of_w * d->by[1][c];
  for (int p = 0; p < m->parameters; p++)
    l->slope[PENDRES_FIT_DISPLACEMENT][m->parameter[p]] =
      of_y * d->by[0][STARTS + p] + of_w * d->by[1][STARTS + p] +
      between(s, lane, k, step, t, row_of(m, p));
  at->lane[0] = (long)m->lanes++;
}

/* The derivatives of the state at the end of a lane's period. */
static void advance(decay *d, const fit_samples *s, size_t lane)
{
  const size_t end = s->steps;
  double next[2][COLUMNS];
  for (int i = 0; i < 2; i++)
    for (int c = 0; c < STARTS + d->m->parameters; c++) {
      next[i][c] = pendres_fit_sample(s, lane, end, PENDRES_ROW_BY_Y + i) * d->by[0][c] +
                   pendres_fit_sample(s, lane, end, PENDRES_ROW_BY_W + i) * d->by[1][c];
      if (c >= STARTS)
        next[i][c] += pendres_fit_sample(s, lane, end, row_of(d->m, c - STARTS) + i);
    }
  memcpy(d->by, next, sizeof next);
}

/* Derivatives of as many periods at once as a block takes. */
static pendres_status run_derivatives(decay *d, pendres_room *room)
{
  fit_model *m = d->m;
  pendres_block *b;
  pendres_status status = pendres_block_open(m->ctx, m->flow, d->steps, &b);
  if (status != PENDRES_OK) return status;
  const size_t all = pendres_block_capacity(b), most = all < d->periods ? all : d->periods;
  fit_samples s = {.steps = (size_t)d->steps, .rows = pendres_flow_kind_rows(m->flow)};
  s.at = pendres_room_take(room, (s.steps + 1) * s.rows * most, sizeof *s.at);
  fit_lane *start = pendres_room_take(room, most, sizeof *start);
  fit_lane **lanes = pendres_room_take(room, most, sizeof(fit_lane *));
  status = room->status;
  for (size_t from = 0; from < d->periods && status == PENDRES_OK; from += most) {
    const size_t n = d->periods - from < most ? d->periods - from : most;
    for (size_t i = 0; i < n; i++) {
      lanes[i] = &start[i];
      memcpy(start[i].u, d->u, sizeof start[i].u);
      start[i].u[PENDRES_U_Y] = d->y[from + i];
      start[i].u[PENDRES_U_W] = d->w[from + i];
    }
    status = pendres_fit_sample_period(m, d->steps, n, lanes, &s);
    for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
      const double until = two_pi * (double)(from + i + 1);
      for (; d->next < m->active && time_of(d, d->next) < until; d->next++)
        measure(d, &s, i, from + i, &m->station[d->next]);
      advance(d, &s, i);
    }
  }
  return status;
}

/* ---- all ---- */

static pendres_status begin(decay *d, const fit_values v, pendres_room *room)
{
  fit_model *m = d->m;
  const double y = v[PENDRES_FIT_START_DISPLACEMENT], w = v[PENDRES_FIT_START_VELOCITY];
  d->u[PENDRES_U_Y] = y;
  d->u[PENDRES_U_W] = w;
  for (int q = 0; q < PENDRES_PARAMETER_FOLLOWED; q++) d->u[PENDRES_U_OMEGA + q] = v[q];
  d->u[PENDRES_U_OMEGA] = 1.0;
  d->u[PENDRES_U_DRIVE] = d->u[PENDRES_U_OMEGA + (int)PENDRES_PARAMETRIC_AMPLITUDE] = 0.0;
  d->pendulum = pendres_map_pendulum(m->base.force, d->u);
  d->rate = two_pi * v[PENDRES_FIT_FREQUENCY_SCALE];
  if (pendres_pendulum_check(&d->pendulum, NULL) != PENDRES_OK || !is_finite(d->u, 2))
    return pendres_fit_lose(m, "the model has no such values");
  const double periods = floor(time_of(d, m->active - 1) / two_pi) + 1.0;
  if (!(periods < fit_decay_periods))
    return pendres_fit_lose(m, "the model's motion is too fast for the data");
  d->periods = (size_t)periods;
  d->y = pendres_room_take(room, d->periods, sizeof *d->y);
  d->w = pendres_room_take(room, d->periods, sizeof *d->w);
  if (room->status != PENDRES_OK) return room->status;
  d->y[0] = y;
  d->w[0] = w;
  for (int c = 0; c < STARTS; c++) d->by[c][c] = 1.0;
  /* Errors of the phase add up until the motion has decayed. */
  const double lost = two_pi * pendres_pendulum_decay_rate(&d->pendulum);
  const double count = fmin(periods, 1.0 + 2.0 / (lost + 1e-12));
  const double x = y + pendres_model_of(m->base.force)->origin;
  const pendres_status status =
    pendres_steps_choose(m->ctx, &d->pendulum, pendres_steps_speed(&d->pendulum, x, w),
                         fmax(fit_accuracy / count, fit_decay_least), &d->steps);
  if (status == PENDRES_OK && d->steps > FIT_MOST_STEPS)
    return pendres_fit_lose(m, "the values lead to motions far from those of the data");
  return status;
}

pendres_status pendres_fit_decay(fit_model *m, const fit_values v)
{
  decay d = {.m = m};
  pendres_room room = pendres_room_open(m->ctx, "a free decay");
  m->lost = NULL;
  m->lanes = 0;
  m->track[0].stages = 1;
  pendres_status status = begin(&d, v, &room);
  if (status == PENDRES_OK) status = run_states(&d);
  if (status == PENDRES_OK && (!is_finite(d.y, d.periods) || !is_finite(d.w, d.periods)))
    status = pendres_fit_lose(m, "the model's motion leaves its well for good");
  if (status == PENDRES_OK) status = run_derivatives(&d, &room);
  for (size_t i = 0; i < m->stations; i++) {
    m->station[i].beyond[0] = 0;
    if (status == PENDRES_OK && i >= d.next) m->station[i].lane[0] = (long)m->lanes - 1;
  }
  return pendres_room_close(&room, status);
}
