/* contest.c -- one method at one tolerance on a work unit; see contest.h. */
#include "validation/contest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/clock.h"
#include "validation/peer_gsl.h"

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
  return fast || unit->n < CONTEST_FEW ? unit->n : CONTEST_FEW;
}

/* ---- One run --------------------------------------------------------------------------------- */

typedef struct runner {
  const work_unit *unit;
  const contest_rules *rules;
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
    status =
      peer_gsl_advance(&r->p[k], &r->x[k], &r->v[k], periods, r->rules->tolerance, &r->cost);
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
static pendres_status time_runs(runner *r, long periods, contest *c)
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
    if (r->unit->growth[mark][i] <= CONTEST_WILD)
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
static void judge(runner *r, contest *c)
{
  const int mark = WORK_UNIT_MARKS - 1;
  c->estimate = c->honesty = c->padding = NAN;
  for (size_t k = 0; k < r->n; k++) {
    const size_t i = work_unit_pick(r->unit, r->n, k);
    const double error = work_unit_error(r->unit, i, mark, r->x[k], r->v[k]);
    if (isnan(r->estimate[k])) return;
    if (r->unit->growth[mark][i] <= CONTEST_WILD) c->estimate = fmax(c->estimate, r->estimate[k]);
    /* "Nothing is known" is true of whatever came out. */
    r->ratio[k] =
      isinf(r->estimate[k]) ? INFINITY : r->estimate[k] / fmax(error, end_rounding);
  }
  qsort(r->ratio, r->n, sizeof *r->ratio, by_value);
  c->honesty = r->ratio[0];
  c->padding = r->ratio[r->n / 2];
}

static pendres_status compare(runner *r, contest *c)
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

static void fail(contest *c, const char *why)
{
  *c = (contest){ .error = { NAN, NAN }, .estimate = NAN, .honesty = NAN, .padding = NAN,
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

pendres_status contest_run(const work_unit *unit, const char *name, const contest_rules *rules,
                           contest *c)
{
  runner r = { .unit = unit, .rules = rules, .n = pendulums_of(unit, name) };
  pendres_options o = options_named(name);
  pendres_status status = PENDRES_OUT_OF_MEMORY;

  *c = (contest){ .pendulums = r.n };
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
