/* benchmark.c -- one method at one tolerance on a work unit; see benchmark.h. */
#include "validation/benchmark.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include "oracle/reference.h"

#include "system/clock.h"
#include "validation/exact.h"

enum { MOST_REPEATS = 50 };

static const double long_enough = 0.15;   /* seconds of timing */
static const double end_rounding = 1e-15; /* of x and v as doubles: errors below it are luck */

/* ---- Methods by name ------------------------------------------------------------------------- */

/* "block_fixed", "block_adaptive_tsit5", "single_order8", "cvode_bdf", ... */
static pendres_options options_named(const char *name)
{
  pendres_options o = { 0 };
  for (int m = 0; m < PENDRES_METHOD_COUNT; m++) {
    const char *method = pendres_name_get(PENDRES_NAMES_METHOD, m);
    const size_t length = strlen(method);
    if (strncmp(name, method, length) != 0) continue;
    if (name[length] != '\0' && name[length] != '_') continue;
    o.method = (pendres_method)m;
    if (name[length] == '\0') continue;
    const int table = pendres_name_find(PENDRES_NAMES_TABLE, name + length + 1);
    if (strcmp(name + length, "_order5") == 0) o.table = PENDRES_TABLE_DP5;
    else if (table >= 0) o.table = (pendres_table)table;
  }
  return o;
}

static int is_gsl(const char *name)
{
  return strcmp(name, "gsl_rk8pd") == 0;
}

static size_t pendulums_of(const work_unit *unit, const char *name)
{
  const int fast = strncmp(name, "block", 5) == 0 || is_gsl(name);
  return fast || unit->n < BENCHMARK_FEW ? unit->n : BENCHMARK_FEW;
}

/* ---- A peer ---------------------------------------------------------------------------------- */

/*
 * GSL's Dormand-Prince 8(9), one problem a pendulum: somebody else's code to be measured against.
 * The equation is that of the library's blocks, over drive phase, with libm's sine:
 * dw/dtheta = (F0 cos theta - sin y) / omega^2 - (gamma / omega) w, y = x - pi/2.
 */
typedef struct problem {
  double stiffness, drive, friction;
  double evaluations;
} problem;

static int slope(double theta, const double s[], double out[], void *arg)
{
  problem *b = arg;
  b->evaluations += 1.0;
  out[0] = s[1];
  out[1] = b->drive * cos(theta) - b->stiffness * sin(s[0]) - b->friction * s[1];
  return GSL_SUCCESS;
}

/* Advance a pendulum by drive periods, x and v in place, with the relative and absolute tolerance
   of each step. What that took is added to *cost. */
static pendres_status advance_gsl(const pendres_pendulum *p, double *x, double *v, long periods,
                                  double tolerance, pendres_cost *cost)
{
  const double omega = p->drive_frequency, end = 2.0 * pi * (double)periods;
  problem b = { .stiffness = 1.0 / (omega * omega), .drive = p->drive_amplitude / (omega * omega),
                .friction = p->damping / omega };
  const gsl_odeiv2_system system = { slope, NULL, 2, &b };
  gsl_odeiv2_driver *driver =
    gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-2, tolerance, tolerance);
  double theta = 0.0, s[2] = { *x - 0.5 * pi, *v / omega };

  if (driver == NULL) return PENDRES_OUT_OF_MEMORY;
  /* GSL's handler would end the program. Nobody else uses GSL's errors at this time. */
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  const int code = gsl_odeiv2_driver_apply(driver, &theta, end, s);
  (void)gsl_set_error_handler(handler);
  cost->pendulum_periods += (double)periods;
  cost->rhs_evaluations += b.evaluations;
  cost->steps += (double)driver->n;
  gsl_odeiv2_driver_free(driver);
  if (code != GSL_SUCCESS) return PENDRES_INTEGRATION_FAILED;
  *x = s[0] + 0.5 * pi;
  *v = s[1] * omega;
  return PENDRES_OK;
}

/* ---- One run --------------------------------------------------------------------------------- */

typedef struct runner {
  const work_unit *unit;
  const benchmark_rules *rules;
  pendres_context *ctx; /* NULL: GSL */
  size_t n;
  pendres_pendulum *p;
  double *x, *v, *estimate, *ratio;
  pendres_cost cost;
} runner;

static pendres_status run_gsl(runner *r, long periods)
{
  pendres_status status = PENDRES_OK;
  r->cost = (pendres_cost){ 0 };
  for (size_t k = 0; k < r->n && status == PENDRES_OK; k++)
    status = advance_gsl(&r->p[k], &r->x[k], &r->v[k], periods, r->rules->tolerance, &r->cost);
  return status;
}

/* All pendulums from their starts. estimates[n], if not NULL, are NaN where a method gives none. */
static pendres_status run_once(runner *r, long periods, double *estimates)
{
  if (r->rules->stop != NULL && r->rules->stop(r->rules->stop_arg)) return PENDRES_INTERRUPTED;
  for (size_t k = 0; k < r->n; k++) {
    r->x[k] = r->unit->x[work_unit_pick(r->unit, r->n, k)];
    r->v[k] = 0.0;
    if (estimates != NULL) estimates[k] = NAN;
  }
  if (r->ctx == NULL) return run_gsl(r, periods);
  pendres_context_cost_reset(r->ctx);
  const pendres_status status =
    pendres_strobe_advance(r->ctx, r->n, r->p, r->x, r->v, periods, estimates);
  pendres_context_cost(r->ctx, &r->cost);
  return status;
}

/* The best of several, until the clock can be believed. */
static pendres_status time_runs(runner *r, long periods, benchmark *c)
{
  double best = INFINITY, second = INFINITY, total = 0.0;
  for (int k = 0; k < 2 || (k < MOST_REPEATS && total < long_enough); k++) {
    const double start = clock_thread();
    const pendres_status status = run_once(r, periods, NULL);
    if (status != PENDRES_OK) return status;
    const double took = clock_thread() - start;
    second = fmin(second, fmax(best, took));
    best = fmin(best, took);
    total += took;
    if (took > long_enough) break;
  }
  c->seconds = best;
  c->spread = isfinite(second) ? second - best : NAN;
  c->throughput = r->cost.pendulum_periods / best;
  c->steps = r->cost.steps / r->cost.pendulum_periods;
  c->rhs = r->cost.rhs_evaluations / r->cost.pendulum_periods;
  return PENDRES_OK;
}

/* ---- Errors, and what was believed of them --------------------------------------------------- */

static double largest_error(const runner *r, int mark)
{
  double most = NAN;
  for (size_t k = 0; k < r->n; k++) {
    const size_t i = work_unit_pick(r->unit, r->n, k);
    if (r->unit->growth[mark][i] <= BENCHMARK_WILD)
      most = fmax(most, work_unit_error(r->unit, i, mark, r->x[k], r->v[k]));
  }
  return most;
}

static int by_value(const void *a, const void *b)
{
  const double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

/* After a run to the last mark with estimates. */
static void judge(runner *r, benchmark *c)
{
  const int mark = WORK_UNIT_MARKS - 1;
  c->estimate = c->honesty = c->padding = NAN;
  for (size_t k = 0; k < r->n; k++) {
    const size_t i = work_unit_pick(r->unit, r->n, k);
    const double error = work_unit_error(r->unit, i, mark, r->x[k], r->v[k]);
    if (isnan(r->estimate[k])) return;
    if (r->unit->growth[mark][i] <= BENCHMARK_WILD) c->estimate = fmax(c->estimate, r->estimate[k]);
    /* "Nothing is known" is true of whatever came out. */
    r->ratio[k] =
      isinf(r->estimate[k]) ? INFINITY : r->estimate[k] / fmax(error, end_rounding);
  }
  qsort(r->ratio, r->n, sizeof *r->ratio, by_value);
  c->honesty = r->ratio[0];
  c->padding = r->ratio[r->n / 2];
}

static pendres_status compare(runner *r, benchmark *c)
{
  const int last = WORK_UNIT_MARKS - 1;
  pendres_status status = PENDRES_OK;
  for (int m = 0; m < last && status == PENDRES_OK; m++) {
    status = run_once(r, work_unit_periods[m], NULL);
    c->error[m] = largest_error(r, m);
  }
  if (status == PENDRES_OK) status = time_runs(r, work_unit_periods[last], c);
  c->error[last] = largest_error(r, last);
  if (status == PENDRES_OK && r->ctx != NULL)
    status = run_once(r, work_unit_periods[last], r->estimate);
  else
    for (size_t k = 0; k < r->n; k++) r->estimate[k] = NAN;
  if (status == PENDRES_OK) judge(r, c);
  return status;
}

static void fail(benchmark *c, const char *why)
{
  *c = (benchmark){ .error = { NAN, NAN }, .estimate = NAN, .honesty = NAN, .padding = NAN,
                  .steps = NAN, .rhs = NAN, .seconds = NAN, .spread = NAN, .throughput = NAN,
                  .pendulums = c->pendulums };
  snprintf(c->failure, sizeof c->failure, "%s", why);
}

static pendres_status open_context(runner *r, const pendres_options *o)
{
  const pendres_status status = pendres_context_create(o, &r->ctx);
  if (status == PENDRES_OK)
    pendres_context_set_interrupt(r->ctx, r->rules->stop, r->rules->stop_arg);
  return status;
}

pendres_status benchmark_run(const work_unit *unit, const char *name, const benchmark_rules *rules,
                             benchmark *c)
{
  runner r = { .unit = unit, .rules = rules, .n = pendulums_of(unit, name) };
  pendres_options o = options_named(name);
  pendres_status status = PENDRES_OUT_OF_MEMORY;

  *c = (benchmark){ .pendulums = r.n };
  o.tolerance = rules->tolerance;
  o.block_lanes = rules->block_lanes;
  r.p = malloc(r.n * sizeof *r.p);
  r.x = malloc(4 * r.n * sizeof *r.x);
  if (r.p == NULL || r.x == NULL) goto done;
  r.v = r.x + r.n, r.estimate = r.v + r.n, r.ratio = r.estimate + r.n;
  for (size_t k = 0; k < r.n; k++) r.p[k] = unit->pendulum[work_unit_pick(unit, r.n, k)];

  const char *why = is_gsl(name) ? NULL : pendres_options_check(&o);
  if (why != NULL) {
    fail(c, why);
    status = PENDRES_OK;
    goto done;
  }
  status = is_gsl(name) ? PENDRES_OK : open_context(&r, &o);
  if (status != PENDRES_OK) goto done;
  status = compare(&r, c);
  if (status != PENDRES_OK && status != PENDRES_OUT_OF_MEMORY && status != PENDRES_INTERRUPTED) {
    fail(c, r.ctx != NULL ? pendres_context_message(r.ctx) : "GSL gave up");
    status = PENDRES_OK;
  }
done:
  pendres_context_free(r.ctx);
  free(r.p);
  free(r.x);
  return status;
}

const long work_unit_periods[WORK_UNIT_MARKS] = { 10, 100 };

enum { CHUNK = 8 /* pendulums a task */ };

static void place(work_unit *w, int sweep)
{
  const double two_pi = 2.0 * pi, plastic = 1.32471795724474602596;
  const double n = (double)w->n;
  for (size_t i = 0; i < w->n; i++) {
    const double k = (double)(i + 1);
    pendres_pendulum *p = &w->pendulum[i];
    *p = (pendres_pendulum){ .damping = 0.12, .drive_amplitude = 0.2,
                             .drive_frequency = two_pi / 8.0 };
    if (sweep) {
      p->drive_frequency = 0.6 + 0.6 * fmod(k / plastic, 1.0);
      p->damping = 0.06 + 0.94 * fmod(k / (plastic * plastic), 1.0);
    }
    w->x[i] = -0.25 * two_pi + two_pi * k / n;
  }
}

pendres_status work_unit_make(const char *name, work_unit *w)
{
  const int sweep = strcmp(name, "sweep") == 0;
  w->n = sweep ? 1000 : 200;
  w->pendulum = calloc(w->n, sizeof *w->pendulum);
  w->x = calloc(w->n, sizeof *w->x);
  int good = w->pendulum != NULL && w->x != NULL;
  for (int m = 0; m < WORK_UNIT_MARKS; m++) {
    w->angle[m] = calloc(w->n, sizeof *w->angle[m]);
    w->velocity[m] = calloc(w->n, sizeof *w->velocity[m]);
    w->growth[m] = calloc(w->n, sizeof *w->growth[m]);
    good = good && w->angle[m] != NULL && w->velocity[m] != NULL && w->growth[m] != NULL;
  }
  if (!good) {
    work_unit_free(w);
    return PENDRES_OUT_OF_MEMORY;
  }
  place(w, sweep);
  return PENDRES_OK;
}

void work_unit_free(work_unit *w)
{
  free(w->pendulum);
  free(w->x);
  for (int m = 0; m < WORK_UNIT_MARKS; m++) {
    free(w->angle[m]);
    free(w->velocity[m]);
    free(w->growth[m]);
  }
  memset(w, 0, sizeof *w);
}

/* Where a pendulum is at each mark. */
typedef struct marks {
  long double angle[WORK_UNIT_MARKS], velocity[WORK_UNIT_MARKS];
  double growth[WORK_UNIT_MARKS];
} marks;

/* From mark to mark, with the product of the derivatives. */
static pendres_status refer_one(const work_unit *w, size_t i, marks *out)
{
  long double y = (long double)w->x[i] - half_pi_exact, v = 0.0L;
  long double growth[2][2] = { { 1.0L, 0.0L }, { 0.0L, 1.0L } };
  long turns = 0, done = 0;
  for (int m = 0; m < WORK_UNIT_MARKS; m++) {
    reference_image to;
    const pendres_status status =
      reference_map(&w->pendulum[i], y, v, work_unit_periods[m] - done, &to);
    if (status != PENDRES_OK) return status;
    long double product[2][2], largest = 0.0L;
    for (int a = 0; a < 2; a++)
      for (int b = 0; b < 2; b++) {
        product[a][b] = to.monodromy[a][0] * growth[0][b] + to.monodromy[a][1] * growth[1][b];
        largest = fmaxl(largest, fabsl(product[a][b]));
      }
    memcpy(growth, product, sizeof growth);
    y = to.y, v = to.v, turns += to.turns, done = work_unit_periods[m];
    out->angle[m] = y + 2.0L * pi_exact * (long double)turns;
    out->velocity[m] = v;
    out->growth[m] = (double)largest;
  }
  return PENDRES_OK;
}

static pendres_status refer_chunk(const void *arg, size_t task, pendres_context *ctx,
                                  farm_record *out)
{
  const work_unit *w = arg;
  marks *m = out->data;
  (void)ctx;
  for (size_t i = task * CHUNK; i < w->n && i < (task + 1) * CHUNK; i++) {
    const pendres_status status = refer_one(w, i, &m[i - task * CHUNK]);
    if (status != PENDRES_OK) return status;
  }
  return PENDRES_OK;
}

static pendres_status keep_chunk(void *arg, size_t task, const farm_record *in)
{
  work_unit *w = arg;
  const marks *of = in->data;
  for (size_t i = task * CHUNK; i < w->n && i < (task + 1) * CHUNK; i++, of++)
    for (int m = 0; m < WORK_UNIT_MARKS; m++) {
      w->angle[m][i] = of->angle[m];
      w->velocity[m][i] = of->velocity[m];
      w->growth[m][i] = of->growth[m];
    }
  return PENDRES_OK;
}

pendres_status work_unit_refer(work_unit *w, farm *f)
{
  return farm_run(f, &(farm_stage){ .what = "reference", .tasks = (w->n + CHUNK - 1) / CHUNK,
                                    .record_size = CHUNK * sizeof(marks), .task = refer_chunk,
                                    .collect = keep_chunk, .arg = w });
}

size_t work_unit_pick(const work_unit *w, size_t some, size_t k)
{
  return some >= w->n ? k : (2 * k + 1) * w->n / (2 * some);
}

double work_unit_error(const work_unit *w, size_t i, int mark, double x, double v)
{
  const double dx = (double)((long double)x - half_pi_exact - w->angle[mark][i]);
  const double dv = (double)((long double)v - w->velocity[mark][i]);
  if (isnan(dx) || isnan(dv)) return INFINITY;
  return fmax(fabs(dx), fabs(dv));
}
