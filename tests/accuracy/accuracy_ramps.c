/*
 * accuracy_ramps.c -- parameters that move in real time, past the end of a state: trajectories, the
 * values at which pendulums leave the state, and how these scatter with noise.
 *
 * What is true is told by a simulation of its own (accuracy_own.c), and by the definition of
 * leaving in ramp.h, written down once more for first harmonics. Statistics may differ by four
 * standard errors, and by what the parameter moves in one window.
 */
#include "accuracy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum {
  SEARCHED = 33, /* values of the sweep that looks for the end of a state */
  POINTS = 41,   /* of the path that the ramp takes */
  NOISY = 48,
  STEPS = 1200,  /* a drive period of the own simulation, ... */
  FEW_STEPS = 50, /* ... and with noise */
  MOST_PERIODS = 1500,
  CHECKS = 8,    /* strobe points that are compared */
  HOW = 600
};

static const double sigmas = 4.0;
/* The share of a window by which an own reading may be late: some 1/STEPS^2. */
static const double read = 1e-5;

typedef struct item {
  pendres_ramp ramp;
  long period[2];
  double value[2];
  pendres_hysteresis *path;
  int found;            /* the path has one end of a state, at which the pendulum jumps */
  pendres_status status;
  double x[CHECKS], v[CHECKS], dx[CHECKS], dv[CHECKS], own_x[CHECKS], own_v[CHECKS];
  pendres_ramp_jump jump;
  double own;           /* where the own simulation leaves */
  double window;        /* how far the parameter moves in one */
  pendres_ramp_summary noisy, own_noisy;
} item;

/* ---- draws ---- */

static pendres_pendulum model(accuracy_random *r)
{
  pendres_pendulum p = {.damping = accuracy_logarithmic(r, 0.05, 0.3),
                        .drive_amplitude = accuracy_uniform(r, 0.1, 0.3),
                        .drive_frequency = accuracy_uniform(r, 0.5, 1.0)};
  const int which = accuracy_choice(r, 4);
  if (which < 2) return p;
  p.force = PENDRES_FORCE_POLYNOMIAL;
  p.force_coefficients[0] = which == 2 ? 1.0 : -1.0;
  p.force_coefficients[2] = which == 2 ? accuracy_uniform(r, 0.2, 1.0) : 1.0;
  if (which == 2) p.drive_frequency += 0.4;
  return p;
}

static pendres_status sweep(pendres_context *ctx, const pendres_pendulum *p,
                            pendres_parameter parameter, const double range[2], int n,
                            const pendres_state *start, pendres_hysteresis **out)
{
  double value[POINTS];
  for (int i = 0; i < n; i++) value[i] = range[0] + (range[1] - range[0]) * i / (n - 1.0);
  const pendres_hysteresis_path path = {parameter, (size_t)n, value};
  return pendres_hysteresis_find(ctx, p, start, &path, out);
}

/* Whether a jump leads from one closed orbit to another that x goes round with alike. */
static int plain(const pendres_hysteresis *h, size_t k)
{
  const pendres_jump *j = pendres_hysteresis_jump_get(h, k);
  const pendres_hysteresis_point *a = pendres_hysteresis_get(h, j->step - 1);
  const pendres_orbit *o = &a->attractor.orbit, *q = &a[1].attractor.orbit;
  return a->outcome == PENDRES_OK && a[1].outcome == PENDRES_OK && !j->gradual && o->period > 0 &&
         q->period > 0 && o->winding * q->period == q->winding * o->period;
}

/* A sweep finds an end; the ramp goes from before it to behind it. */
static void lay(accuracy_random *r, pendres_context *ctx, item *t)
{
  static const double range[][2] = {{0.5, 1.3}, {0.05, 0.3}, {0.05, 0.3}, {-0.4, 0.4}};
  const pendres_pendulum p = model(r);
  const pendres_parameter parameter = (pendres_parameter)accuracy_choice(r, PENDRES_TORQUE + 1);
  const pendres_state start = {accuracy_uniform(r, -1.0, 2.0), 0.0};
  const int up = accuracy_choice(r, 2);
  const double reach = accuracy_logarithmic(r, 3e-3, 3e-2);
  const long periods = (long)accuracy_logarithmic(r, 100, MOST_PERIODS);
  const double ends[2] = {range[parameter][!up], range[parameter][up]};
  pendres_hysteresis *h = NULL, *near = NULL;
  size_t k = 0;
  t->status = sweep(ctx, &p, parameter, ends, SEARCHED, &start, &h);
  while (t->status == PENDRES_OK && k < pendres_hysteresis_jump_count(h) && !plain(h, k)) k++;
  if (t->status == PENDRES_OK && k < pendres_hysteresis_jump_count(h)) {
    const pendres_jump *j = pendres_hysteresis_jump_get(h, k);
    const pendres_hysteresis_point *a = pendres_hysteresis_get(h, j->step - 1);
    t->value[0] = j->value - j->direction * fmin(3.0 * reach, fabs(j->value - a->value));
    t->value[1] = j->value + j->direction * 6.0 * reach;
    const double way[2] = {a->value, t->value[0]};
    t->status = sweep(ctx, &p, parameter, way, 2, &(pendres_state){a->x, a->v}, &near);
    if (t->status == PENDRES_OK) {
      const pendres_hysteresis_point *b = pendres_hysteresis_get(near, 1);
      t->status = sweep(ctx, &p, parameter, t->value, POINTS, &(pendres_state){b->x, b->v},
                        &t->path);
    }
  }
  t->period[1] = periods;
  t->ramp = (pendres_ramp){.pendulum = p, .parameter = parameter, .corners = 2,
                           .period = t->period, .value = t->value, .points = POINTS,
                           .point = pendres_hysteresis_get(t->path, 0),
                           .jumps = pendres_hysteresis_jump_count(t->path),
                           .jump = pendres_hysteresis_jump_get(t->path, 0)};
  t->found = t->path != NULL && t->ramp.jumps == 1 && plain(t->path, 0) && periods >= CHECKS;
  pendres_hysteresis_free(h);
  pendres_hysteresis_free(near);
}

/* ---- the definition of leaving, once more ---- */

/* The first harmonic of a state at a value, between two of the points first to last. */
static void look(const item *t, size_t first, size_t last, double value, double out[2])
{
  const pendres_hysteresis_point *p = t->ramp.point;
  size_t i = first;
  while (i + 1 < last && (p[i + 1].value - value) * (p[i].value - value) > 0.0) i++;
  const size_t next = i < last ? i + 1 : last;
  const pendres_orbit *o = &p[i].attractor.orbit, *q = &p[next].attractor.orbit;
  const double way = p[next].value - p[i].value;
  double part = way != 0.0 ? (value - p[i].value) / way : 0.0;
  if ((value - p[first].value) * (p[POINTS - 1].value - p[0].value) <= 0.0) {
    o = q = &p[first].attractor.orbit;
  } else if ((value - p[last].value) * (p[POINTS - 1].value - p[0].value) >= 0.0) {
    o = q = &p[last].attractor.orbit;
  }
  part = fmin(1.0, fmax(0.0, part));
  out[0] = o->cosine[0] + part * (q->cosine[0] - o->cosine[0]);
  out[1] = o->sine[0] + part * (q->sine[0] - o->sine[0]);
}

/* The value at which an own trajectory leaves, NaN if it does not; its strobe points, unless x is
   NULL, at CHECKS times. */
static double leave(const item *t, int steps, accuracy_random *noise, double *x, double *v)
{
  const size_t step = t->ramp.jump->step;
  const pendres_orbit *o = &t->ramp.point[step - 1].attractor.orbit;
  const pendres_orbit *q = &t->ramp.point[step].attractor.orbit;
  const long all = t->period[1], q_all = o->period > q->period ? o->period : q->period;
  const accuracy_own own = {.pendulum = t->ramp.pendulum, .parameter = t->ramp.parameter,
                            .from = t->value[0], .rate = (t->value[1] - t->value[0]) / (double)all,
                            .steps = steps};
  /* In whole windows, begun ones included. */
  const double fading = 2.0 * o->pendulum.drive_frequency / (6.2831853 * o->pendulum.damping);
  const double patience = (double)q_all * ceil(fading / (double)q_all);
  double s[2] = {t->ramp.point[0].x, t->ramp.point[0].v}, sum[2] = {0.0, 0.0}, before = 0.0;
  double left = NAN, since = 0.0;
  int check = 0;
  for (long k = 0; k < all; k++) {
    double h[2], a[2], b[2];
    accuracy_own_period(&own, k, noise, s, h);
    for (int i = 0; i < 2; i++) sum[i] += h[i] / (double)q_all;
    while (x != NULL && check < CHECKS && (k + 1) == (check + 1) * (all / CHECKS)) {
      x[check] = s[0];
      v[check++] = s[1];
    }
    if ((k + 1) % q_all != 0 || since > patience) continue;
    const double middle = (double)(k + 1) - 0.5 * (double)q_all;
    const double value = own.from + own.rate * middle;
    look(t, 0, step - 1, value, a);
    look(t, step, POINTS - 1, value, b);
    const double c = b[0] - a[0], d = b[1] - a[1], square = c * c + d * d;
    const double e = sum[0] - a[0], f = sum[1] - a[1];
    const double way = fmax(2.0 * (c * e + d * f) / square, sqrt((e * e + f * f) / square));
    if (way < 1.0) left = NAN, since = 0.0;
    else if (isnan(left))
      left = value - own.rate * (double)q_all * (1.0 - (1.0 - before) / (way - before));
    if (way >= 1.0) since += (double)q_all;
    before = way;
    sum[0] = sum[1] = 0.0;
  }
  return left;
}

/* ---- comparisons ---- */

static void with_noise(accuracy_random *r, pendres_context *ctx, item *t)
{
  double time[NOISY], value[NOISY], own[NOISY];
  const double temperature = accuracy_logarithmic(r, 1e-5, 1e-3);
  t->ramp.pendulum.temperature = temperature;
  t->status = pendres_ramp_scatter(ctx, &t->ramp, NOISY, 0, time, value);
  for (int i = 0; i < NOISY; i++) own[i] = leave(t, FEW_STEPS, r, NULL, NULL);
  if (t->status == PENDRES_OK) t->status = pendres_ramp_summarize(NOISY, value, &t->noisy);
  if (t->status == PENDRES_OK) t->status = pendres_ramp_summarize(NOISY, own, &t->own_noisy);
}

static void compute(accuracy_random *r, void *of, long number)
{
  item *t = of;
  pendres_context *ctx = NULL;
  const double tolerance = accuracy_logarithmic(r, 1e-8, 1e-5);
  (void)number;
  t->status = pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx);
  if (t->status == PENDRES_OK) lay(r, ctx, t);
  if (t->status == PENDRES_OK && t->found) {
    const long all = t->period[1], every = all / CHECKS;
    const size_t n = (size_t)(all / every) + 1;
    double *rows = calloc(4 * n, sizeof *rows);
    const pendres_orbit *o = &t->ramp.point[t->ramp.jump->step - 1].attractor.orbit;
    const int longest = o[0].period > t->ramp.point[t->ramp.jump->step].attractor.orbit.period
                          ? o->period : t->ramp.point[t->ramp.jump->step].attractor.orbit.period;
    t->window = fabs(t->value[1] - t->value[0]) / (double)all * longest;
    t->status = PENDRES_OUT_OF_MEMORY;
    if (rows != NULL)
      t->status = pendres_ramp_find(
        ctx, &t->ramp,
        &(pendres_ramp_record){every, rows, rows + n, rows + 2 * n, rows + 3 * n}, &t->jump);
    for (size_t i = 0; i < CHECKS && t->status == PENDRES_OK; i++) {
      t->x[i] = rows[i + 1], t->v[i] = rows[n + i + 1];
      t->dx[i] = rows[2 * n + i + 1], t->dv[i] = rows[3 * n + i + 1];
    }
    free(rows);
    t->own = leave(t, STEPS, NULL, t->own_x, t->own_v);
    if (t->status == PENDRES_OK) with_noise(r, ctx, t);
  }
  pendres_hysteresis_free(t->path);
  pendres_context_free(ctx);
}

static void note(accuracy *a, const void *of, long number, void *counts)
{
  const item *t = of;
  const pendres_pendulum *p = &t->ramp.pendulum;
  const pendres_ramp_summary *n = &t->noisy, *o = &t->own_noisy;
  char how[HOW];
  snprintf(how, sizeof how, "item %ld: %s, force %.17g %.17g %.17g, damping %.17g, F0 %.17g, "
           "omega %.17g, T %.3g; %s %.17g to %.17g in %ld periods", number,
           pendres_model_of(p->force)->name, p->force_coefficients[0], p->force_coefficients[1],
           p->force_coefficients[2], p->damping, p->drive_amplitude, p->drive_frequency,
           p->temperature, pendres_name_get(PENDRES_NAMES_PARAMETER, t->ramp.parameter),
           t->value[0], t->value[1], t->period[1]);
  if (t->status != PENDRES_OK) accuracy_complain(a, "a ramp failed", how);
  if (t->status != PENDRES_OK || !t->found) return;
  ++*(long *)counts;
  for (int i = 0; i < CHECKS; i++) {
    accuracy_note(a, "x of a ramp", t->x[i], t->dx[i], t->own_x[i], how);
    accuracy_note(a, "v of a ramp", t->v[i], t->dv[i], t->own_v[i], how);
  }
  if (isnan(t->own) != isnan(t->jump.value)) accuracy_complain(a, "only one leaves", how);
  if (!isnan(t->own) && !isnan(t->jump.value))
    accuracy_note(a, "where it leaves", t->jump.value, t->jump.value_error + read * t->window,
                  t->own, how);
  if (n->count == NOISY && o->count == NOISY) {
    accuracy_note(a, "mean with noise, 4 sigma", n->mean,
                  t->window + sigmas * hypot(n->mean_error, o->mean_error), o->mean, how);
    accuracy_note(a, "deviation, 4 sigma", n->deviation,
                  t->window + sigmas * hypot(n->deviation_error, o->deviation_error),
                  o->deviation, how);
    return;
  }
  accuracy_note(a, "share that leaves, 4 sigma", (double)n->count / NOISY,
                sigmas * sqrt(0.5 / NOISY), (double)o->count / NOISY, how);
}

void accuracy_ramps(accuracy *a)
{
  long ramps = 0;
  const accuracy_work work = {.items = (accuracy_get_options(a)->points + 3) / 4, .at_once = 4,
                              .size = sizeof(item), .compute = compute, .note = note,
                              .tally = &ramps};
  const long items = accuracy_each(a, &work);
  printf("\nramps: %ld of %ld draws have an end to pass\n", ramps, items);
}
