/* orbits.c -- orbits at data, their observables and derivatives of these; see internal.h. */
#include "analysis/fit_model/internal.h"

#include <math.h>
#include <string.h>

#include "base/angles.h"
#include "continuation/parameter.h"
#include "engine/block.h"
#include "model/equation.h"

/* One lane: its samples on the closed orbit, and their derivatives by the fit's parameters. */
typedef struct orbit {
  const fit_model *m;
  const fit_samples *s;
  size_t lane;
  double shift[FIT_PLACES];                            /* to the closed orbit, */
  double by[PENDRES_PARAMETER_FOLLOWED][FIT_PLACES];   /* and how that moves with parameters */
  double scale;                                        /* of the axis in the border */
  double *y, *w, *dy;                                  /* [steps]; dy: [parameters][steps] */
} orbit;

static double sample(const orbit *o, size_t k, int row)
{
  return pendres_fit_sample(o->s, o->lane, k, row);
}

/* The rows of (y, w) derived by a parameter. */
static int row_of(int parameter)
{
  return PENDRES_ROW_BY_PARAMETERS + 2 * parameter;
}

static void record(void *arg, int step, const pendres_rows *rows)
{
  const fit_samples *s = arg;
  double *to = s->at + (size_t)step * s->rows * s->lanes;
  for (size_t r = 0; r < s->rows; r++, to += s->lanes)
    memcpy(to, rows->at + r * rows->stride, s->lanes * sizeof *to);
}

/* The part of the first harmonic in a row that is in phase with the drive turned by a lag, whose
   cosine and sine these are. */
static double in_phase(const orbit *o, int row, double cosine, double sine)
{
  const size_t n = o->s->steps;
  double c = 0.0, s = 0.0;
  for (size_t k = 0; k < n; k++) {
    const double theta = two_pi * (double)k / (double)n;
    c += 2.0 / (double)n * sample(o, k, row) * cos(theta);
    s += 2.0 / (double)n * sample(o, k, row) * sin(theta);
  }
  return c * cosine - s * sine;
}

/* By how much a row breaks the third equation, that of the border. */
static double third(const orbit *o, const fit_lane *l, int row)
{
  return l->tuned ? in_phase(o, row, l->turn[0], l->turn[1]) : 0.0;
}

/* The inverse of the equations' derivative by the scaled (y, w, axis), bordered; 0: singular. */
static int inverse(const orbit *o, const fit_lane *l, double inv[FIT_PLACES][FIT_PLACES])
{
  const size_t end = o->s->steps;
  const int axis = row_of((int)o->m->axis);
  double a[3][3];
  for (int i = 0; i < 2; i++) {
    a[i][0] = sample(o, end, PENDRES_ROW_BY_Y + i) - (i == 0);
    a[i][1] = sample(o, end, PENDRES_ROW_BY_W + i) - (i == 1);
    a[i][2] = sample(o, end, axis + i) * o->scale;
  }
  memcpy(a[2], l->border, sizeof a[2]);
  if (l->tuned) {
    a[2][0] = third(o, l, PENDRES_ROW_BY_Y);
    a[2][1] = third(o, l, PENDRES_ROW_BY_W);
    a[2][2] = third(o, l, axis) * o->scale;
  }
  double det = 0.0;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      const int r = (k + 1) % 3, s = (k + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      inv[i][k] = a[r][c] * a[s][d] - a[r][d] * a[s][c];
    }
  for (int k = 0; k < 3; k++) det += a[k][0] * inv[0][k];
  if (!(fabs(det) > 0.0) || !isfinite(det)) return 0;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) inv[i][k] /= det;
  return 1;
}

/* The place at which the equations, which are off by f, hold. */
static void solve(double inv[FIT_PLACES][FIT_PLACES], const double f[FIT_PLACES],
                  double out[FIT_PLACES])
{
  for (int i = 0; i < FIT_PLACES; i++)
    out[i] = -(inv[i][0] * f[0] + inv[i][1] * f[1] + inv[i][2] * f[2]);
}

/* How the orbit closes, and how that moves with parameters. */
static int close_orbit(orbit *o, fit_lane *l)
{
  const size_t end = o->s->steps;
  double inv[FIT_PLACES][FIT_PLACES];
  o->scale = pendres_parameter_scale_at(o->m->axis, l->u[pendres_fit_place(o->m)]);
  if (!inverse(o, l, inv)) return 0;
  solve(inv, (double[]){sample(o, end, PENDRES_ROW_Y) - l->u[PENDRES_U_Y],
                        sample(o, end, PENDRES_ROW_W) - l->u[PENDRES_U_W],
                        third(o, l, PENDRES_ROW_Y)}, o->shift);
  for (int k = 0; k < o->m->parameters; k++) {
    const int row = row_of(o->m->parameter[k]);
    solve(inv, (double[]){sample(o, end, row), sample(o, end, row + 1), third(o, l, row)},
          o->by[k]);
    l->axis_slope[o->m->parameter[k]] = o->by[k][2] * o->scale;
  }
  if (l->tuned)
    l->axis_by_lag =
      -inv[2][2] * in_phase(o, PENDRES_ROW_Y, -l->turn[1], l->turn[0]) * o->scale;
  const double trace = sample(o, end, PENDRES_ROW_BY_Y) + sample(o, end, PENDRES_ROW_BY_W + 1);
  const pendres_pendulum p = pendres_map_pendulum(o->m->base.force, l->u);
  const double det = pendres_equation_left(
    pendres_equation_contraction(&p) * two_pi / p.drive_frequency,
    sample(o, end, PENDRES_ROW_BY_Y) * sample(o, end, PENDRES_ROW_BY_W + 1) -
      sample(o, end, PENDRES_ROW_BY_Y + 1) * sample(o, end, PENDRES_ROW_BY_W));
  l->stable = 1.0 - trace + det > 0.0 && 1.0 + trace + det > 0.0;
  l->moved = sqrt(o->shift[0] * o->shift[0] + o->shift[1] * o->shift[1] +
                  o->shift[2] * o->shift[2]);
  return isfinite(l->moved);
}

/* A row's change where (y, w, axis) at the start change so. */
static double along(const orbit *o, size_t k, int component, const double by[FIT_PLACES])
{
  return sample(o, k, PENDRES_ROW_BY_Y + component) * by[0] +
         sample(o, k, PENDRES_ROW_BY_W + component) * by[1] +
         sample(o, k, row_of((int)o->m->axis) + component) * by[2] * o->scale;
}

static void straighten(orbit *o)
{
  const size_t n = o->s->steps;
  for (size_t k = 0; k < n; k++) {
    o->y[k] = sample(o, k, PENDRES_ROW_Y) + along(o, k, 0, o->shift);
    o->w[k] = sample(o, k, PENDRES_ROW_W) + along(o, k, 1, o->shift);
  }
  for (int p = 0; p < o->m->parameters; p++)
    for (size_t k = 0; k < n; k++)
      o->dy[(size_t)p * n + k] =
        sample(o, k, row_of(o->m->parameter[p])) + along(o, k, 0, o->by[p]);
}

/* ---- observables ---- */

/* What a trigonometric interpolation takes of sample k at a distance from it. */
static double weight(size_t n, double distance)
{
  const double half = (double)((n - 1) / 2) + 0.5, bottom = sin(0.5 * distance);
  if (fabs(bottom) < 1e-9) return 1.0;
  return sin(half * distance) / (2.0 * half * bottom);
}

static double interpolate(size_t n, const double *x, double theta)
{
  double sum = 0.0, all = 0.0;
  for (size_t k = 0; k < n; k++) {
    const double c = weight(n, theta - two_pi * (double)k / (double)n);
    sum += c * x[k];
    all += c;
  }
  return sum / all;
}

/* Phase of an extreme, next to sample k: a zero of the slope, by two secants. */
static double extreme_near(const orbit *o, size_t k)
{
  const size_t n = o->s->steps;
  const double step = two_pi / (double)n;
  double a = (double)k * step, fa = o->w[k];
  const size_t next = fa * (o->w[(k + 1) % n]) <= 0.0 ? (k + 1) % n : (k + n - 1) % n;
  double b = a + (next == (k + 1) % n ? step : -step), fb = o->w[next];
  for (int i = 0; i < 4 && fb != fa; i++) {
    const double c = fmin(fmax(b - fb * (b - a) / (fb - fa), a - 2 * step), a + 2 * step);
    a = b;
    fa = fb;
    b = c;
    fb = interpolate(n, o->w, b);
  }
  return b;
}

static void measure_amplitude(const orbit *o, fit_lane *l)
{
  const size_t n = o->s->steps;
  size_t top = 0, bottom = 0;
  for (size_t k = 1; k < n; k++) {
    if (o->y[k] > o->y[top]) top = k;
    if (o->y[k] < o->y[bottom]) bottom = k;
  }
  const double at[2] = {extreme_near(o, top), extreme_near(o, bottom)};
  l->base[PENDRES_FIT_AMPLITUDE] =
    0.5 * (interpolate(n, o->y, at[0]) - interpolate(n, o->y, at[1]));
  for (int p = 0; p < o->m->parameters; p++) {
    const double *dy = o->dy + (size_t)p * n;
    l->slope[PENDRES_FIT_AMPLITUDE][o->m->parameter[p]] =
      0.5 * (interpolate(n, dy, at[0]) - interpolate(n, dy, at[1]));
  }
}

/* Sums over a period: mean, first harmonic. */
typedef struct sums {
  double mean, cosine, sine;
} sums;

static sums sums_of(size_t n, const double *x)
{
  sums s = {0.0, 0.0, 0.0};
  for (size_t k = 0; k < n; k++) {
    const double theta = two_pi * (double)k / (double)n;
    s.mean += x[k] / (double)n;
    s.cosine += 2.0 / (double)n * x[k] * cos(theta);
    s.sine += 2.0 / (double)n * x[k] * sin(theta);
  }
  return s;
}

static double product(size_t n, const double *x, const double *y)
{
  double sum = 0.0;
  for (size_t k = 0; k < n; k++) sum += x[k] * y[k] / (double)n;
  return sum;
}

static void measure(const orbit *o, fit_lane *l)
{
  const size_t n = o->s->steps;
  const sums s = sums_of(n, o->y);
  const double r = hypot(s.cosine, s.sine), drive = l->u[PENDRES_U_DRIVE];
  const double rate = l->u[PENDRES_U_OMEGA] / o->m->clock;
  const double rms = sqrt(fmax(0.0, product(n, o->y, o->y) - s.mean * s.mean));
  l->base[PENDRES_FIT_RMS] = rms;
  l->base[PENDRES_FIT_FIRST_HARMONIC] = r;
  l->base[PENDRES_FIT_PHASE_LAG] = atan2(s.sine, s.cosine);
  l->base[PENDRES_FIT_IN_PHASE] = s.cosine;
  l->base[PENDRES_FIT_QUADRATURE] = s.sine;
  l->base[PENDRES_FIT_LOOP_AREA] = pi * drive * s.sine;
  l->base[PENDRES_FIT_VELOCITY] = rate * r;
  l->base[PENDRES_FIT_ACCELERATION] = rate * rate * r;
  for (int p = 0; p < o->m->parameters; p++) {
    const int q = o->m->parameter[p];
    const double *dy = o->dy + (size_t)p * n;
    const sums d = sums_of(n, dy);
    l->slope[PENDRES_FIT_RMS][q] = (product(n, o->y, dy) - s.mean * d.mean) / rms;
    l->slope[PENDRES_FIT_FIRST_HARMONIC][q] = (s.cosine * d.cosine + s.sine * d.sine) / r;
    l->slope[PENDRES_FIT_PHASE_LAG][q] = (s.cosine * d.sine - s.sine * d.cosine) / (r * r);
    l->slope[PENDRES_FIT_IN_PHASE][q] = d.cosine;
    l->slope[PENDRES_FIT_QUADRATURE][q] = d.sine;
    const double by_r = l->slope[PENDRES_FIT_FIRST_HARMONIC][q];
    const double by_rate = ((q == (int)PENDRES_DRIVE_FREQUENCY) +
                            (o->m->axis == PENDRES_DRIVE_FREQUENCY ? l->axis_slope[q] : 0.0)) /
                           o->m->clock;
    l->slope[PENDRES_FIT_VELOCITY][q] = rate * by_r + by_rate * r;
    l->slope[PENDRES_FIT_ACCELERATION][q] = rate * (rate * by_r + 2.0 * by_rate * r);
    /* At a fold the drive itself is what moves, where it is the axis. */
    const double by_drive = (q == (int)PENDRES_DRIVE_AMPLITUDE) +
                            (o->m->axis == PENDRES_DRIVE_AMPLITUDE ? l->axis_slope[q] : 0.0);
    l->slope[PENDRES_FIT_LOOP_AREA][q] = pi * (drive * d.sine + by_drive * s.sine);
  }
  if (o->m->measured[PENDRES_FIT_AMPLITUDE]) measure_amplitude(o, l);
}

/* ---- passes ---- */

pendres_status pendres_fit_sample_period(const fit_model *m, int steps, size_t n,
                                         fit_lane *const *lanes, fit_samples *s)
{
  pendres_block *b;
  pendres_status status = pendres_block_open(m->ctx, m->flow, steps, &b);
  if (status != PENDRES_OK) return status;
  pendres_block_resize(b, n);
  for (size_t i = 0; i < n; i++) {
    const pendres_pendulum p = pendres_map_pendulum(m->base.force, lanes[i]->u);
    pendres_block_load(b, i, &p, lanes[i]->u[PENDRES_U_Y], lanes[i]->u[PENDRES_U_W]);
  }
  s->lanes = n;
  const pendres_rows rows = pendres_block_rows(b);
  record(s, 0, &rows);
  return pendres_block_period_sampled(b, record, s);
}

/* One step of Newton's method for some lanes of a block; those that have arrived are measured. */
static void improve(const fit_model *m, const fit_samples *s, double *work, size_t n,
                    fit_lane *const *lanes)
{
  const int axis = pendres_fit_place(m);
  for (size_t i = 0; i < n; i++) {
    fit_lane *l = lanes[i];
    orbit o = {.m = m, .s = s, .lane = i, .y = work, .w = work + s->steps,
               .dy = work + 2 * s->steps};
    l->found = 0;
    if (!close_orbit(&o, l)) {
      l->moved = NAN;
      continue;
    }
    l->u[PENDRES_U_Y] += o.shift[0];
    l->u[PENDRES_U_W] += o.shift[1];
    l->u[axis] += o.shift[2] * o.scale;
    const double size = hypot(l->u[PENDRES_U_Y], l->u[PENDRES_U_W]);
    l->found = l->moved < fit_last_step * size;
    if (!l->found) continue;
    straighten(&o);
    measure(&o, l);
  }
}

/* Lanes that have not arrived and are not lost, at most as many as a block takes. */
static size_t gather(size_t n, fit_lane *lanes, size_t most, size_t *next, fit_lane **out)
{
  size_t count = 0;
  for (; *next < n && count < most; ++*next) {
    const fit_lane *l = &lanes[*next];
    const pendres_pendulum p = pendres_map_pendulum(PENDRES_FORCE_PENDULUM, l->u);
    const double size = hypot(l->u[PENDRES_U_Y], l->u[PENDRES_U_W]);
    if (!l->found && l->moved < fmax(1.0, size) && p.drive_frequency > 0.0 && isfinite(size))
      out[count++] = &lanes[*next];
  }
  return count;
}

pendres_status pendres_fit_orbits(const fit_model *m, int steps, size_t n, fit_lane *lanes)
{
  pendres_room room = pendres_room_open(m->ctx, "orbits at data");
  pendres_block *b;
  pendres_status status = pendres_block_open(m->ctx, m->flow, steps, &b);
  if (status != PENDRES_OK) return status;
  const size_t most = pendres_block_capacity(b);
  fit_samples s = {.steps = (size_t)steps, .rows = pendres_flow_kind_rows(m->flow)};
  s.at = pendres_room_take(&room, (s.steps + 1) * s.rows * most, sizeof *s.at);
  double *work = pendres_room_take(&room, (2 + (size_t)m->parameters) * s.steps, sizeof *work);
  fit_lane **some = pendres_room_take(&room, most, sizeof(fit_lane *));
  status = room.status;
  for (size_t i = 0; i < n; i++) {
    lanes[i].found = 0;
    lanes[i].moved = 0.0;
  }
  for (int pass = 0; pass < FIT_PASSES && status == PENDRES_OK; pass++) {
    size_t next = 0, count, all = 0;
    while (status == PENDRES_OK && (count = gather(n, lanes, most, &next, some)) > 0) {
      status = pendres_fit_sample_period(m, steps, count, some, &s);
      if (status == PENDRES_OK) improve(m, &s, work, count, some);
      m->ctx->cost.newton_steps += (double)count;
      all += count;
    }
    if (all == 0) break;
  }
  return pendres_room_close(&room, status);
}
