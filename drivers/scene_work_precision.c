/*
 * scene_work_precision.c -- speed against error, of the library's methods and of a peer.
 *
 * Every method and tolerance advances the same pendulums by 100 drive periods; how far they are off
 * then is known from extended precision (work_unit.h). Members that amplify an error of their start
 * more than a thousandfold are left out of the largest error, as no method could help them.
 *
 * Runs are timed one after another on one thread, the best of several. Methods with one problem a
 * pendulum are hundreds of times slower than blocks and get a handful of pendulums (`pendulums` in
 * the file says how many), spread over the unit; a pendulum's cost does not depend on the others.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "peer_gsl.h"
#include "scene.h"
#include "work_unit.h"

enum { FEW = 5 /* pendulums for the slow ones */, MOST_REPEATS = 50, OTHERS = 5, ERRORS = 4 };

static const double wild = 1000.0;        /* growth of an error that is left out */
static const double long_enough = 0.15;   /* seconds of timing */
static const double end_rounding = 1e-15; /* of x and v as doubles, in which errors are measured */

/* Errors at which speeds are compared, and speeds of others there on the unit `ensemble`, million
   pendulum-periods a second on one AVX-512 core. */
static const double error_marks[ERRORS] = { 1e-6, 1e-8, 1e-10, 2e-14 };
static const struct {
  const char *name;
  double speed[ERRORS];
} others[OTHERS] = {
  { "simd_taylor", { 1.34, 1.30, 1.25, 1.0 } },
  { "simd_odeint", { 1.83, 1.15, 0.76, NAN } },
  { "gsl_rk8pd", { 0.32, 0.21, 0.13, NAN } },
  { "scipy_dop853", { 0.11, 0.09, 0.06, NAN } },
  { "arkode_single", { 0.05, 0.03, 0.02, NAN } },
};

/* One method by one tolerance. */
typedef struct contest {
  double error[WORK_UNIT_MARKS];
  double estimate;      /* at the last mark; NaN where a method gives none */
  double steps, rhs;    /* a pendulum and period */
  double seconds, spread; /* of the best run; of the next best over it */
  double throughput;
  size_t pendulums;
  int failed;
} contest;

typedef struct work {
  const deck *d;
  work_unit unit;
  size_t methods, tolerances;
  contest *contest; /* [method][tolerance] */
  double settled[3], settled_error[3]; /* periods, seconds a pendulum; share that is resolved */
} work;

static double seconds_now(void)
{
  struct timespec t;
  return timespec_get(&t, TIME_UTC) != 0 ? (double)t.tv_sec + 1e-9 * (double)t.tv_nsec : NAN;
}

/* ---- methods by name ----------------------------------------------------------------------- */

static pendres_table table_named(const char *name)
{
  for (int t = PENDRES_TABLE_DEFAULT + 1; t < PENDRES_TABLE_COUNT; t++)
    if (strcmp(name, pendres_table_name((pendres_table)t)) == 0) return (pendres_table)t;
  return PENDRES_TABLE_DEFAULT;
}

/* "block_fixed", "block_adaptive_tsit5", "single_order8", "cvode_bdf", ... */
static pendres_options options_named(const char *name)
{
  pendres_options o = { 0 };
  for (int m = 0; m < PENDRES_METHOD_COUNT; m++) {
    const char *method = pendres_method_name((pendres_method)m);
    const size_t length = strlen(method);
    if (strncmp(name, method, length) != 0) continue;
    if (name[length] != '\0' && name[length] != '_') continue;
    o.method = (pendres_method)m;
    if (strcmp(name + length, "_order5") == 0) o.table = PENDRES_TABLE_DP5;
    else if (name[length] == '_') o.table = table_named(name + length + 1);
  }
  return o;
}

static int is_gsl(const char *name)
{
  return strcmp(name, "gsl_rk8pd") == 0;
}

static size_t pendulums_of(const work *w, const char *name)
{
  return strncmp(name, "block", 5) == 0 || w->unit.n < FEW ? w->unit.n : FEW;
}

/* ---- one contest --------------------------------------------------------------------------- */

typedef struct runner {
  const work *w;
  const char *name;
  double tolerance;
  pendres_context *ctx; /* NULL: GSL */
  size_t n;
  pendres_pendulum *p;
  double *x, *v, *error;
  pendres_cost cost;
} runner;

static pendres_status run_once(runner *r, long periods, double *error)
{
  for (size_t k = 0; k < r->n; k++) {
    r->x[k] = r->w->unit.x[work_unit_pick(&r->w->unit, r->n, k)];
    r->v[k] = 0.0;
    if (error != NULL) error[k] = NAN;
  }
  if (r->ctx == NULL)
    return peer_gsl_advance(r->n, r->p, r->x, r->v, periods, r->tolerance, &r->cost);
  pendres_context_cost_reset(r->ctx);
  const pendres_status status =
    pendres_strobe_advance(r->ctx, r->n, r->p, r->x, r->v, periods, error);
  pendres_context_cost(r->ctx, &r->cost);
  return status;
}

/* Largest over the members that are not left out; NaN if there is none. */
static double largest(const runner *r, int mark, int estimates)
{
  double most = NAN;
  for (size_t k = 0; k < r->n; k++) {
    const size_t i = work_unit_pick(&r->w->unit, r->n, k);
    if (!(r->w->unit.growth[mark][i] <= wild)) continue;
    most = fmax(most, estimates ? r->error[k]
                                : work_unit_error(&r->w->unit, i, mark, r->x[k], r->v[k]));
  }
  return most;
}

static pendres_status time_runs(runner *r, long periods, contest *c)
{
  double best = INFINITY, second = INFINITY, total = 0.0;
  int repeats = 0;
  while (repeats < 2 || (total < long_enough && repeats < MOST_REPEATS)) {
    const double start = seconds_now();
    const pendres_status status = run_once(r, periods, NULL);
    if (status != PENDRES_OK) return status;
    const double took = seconds_now() - start;
    second = fmin(second, fmax(best, took));
    best = fmin(best, took);
    total += took;
    if (++repeats == 1 && took > long_enough) break;
  }
  c->seconds = best;
  c->spread = isfinite(second) ? second - best : NAN;
  c->throughput = r->cost.pendulum_periods / best;
  c->steps = r->cost.steps / r->cost.pendulum_periods;
  c->rhs = r->cost.rhs_evaluations / r->cost.pendulum_periods;
  return PENDRES_OK;
}

static pendres_status compare(runner *r, contest *c)
{
  pendres_status status = PENDRES_OK;
  for (int m = 0; m < WORK_UNIT_MARKS && status == PENDRES_OK; m++) {
    const int last = m == WORK_UNIT_MARKS - 1;
    status = run_once(r, work_unit_periods[m], last ? r->error : NULL);
    if (status != PENDRES_OK) break;
    c->error[m] = largest(r, m, 0);
    if (last) c->estimate = largest(r, m, 1);
  }
  return status == PENDRES_OK ? time_runs(r, work_unit_periods[WORK_UNIT_MARKS - 1], c) : status;
}

static void not_run(contest *c)
{
  *c = (contest){ .error = { NAN, NAN }, .estimate = NAN, .steps = NAN, .rhs = NAN,
                  .seconds = NAN, .spread = NAN, .throughput = NAN, .failed = 1 };
}

/* A method that refuses a tolerance is a finding, not a failure of the run. */
static pendres_status contend(work *w, size_t task)
{
  contest *c = &w->contest[task];
  const char *name = w->d->methods.name[task / w->tolerances];
  runner r = { .w = w, .name = name, .n = pendulums_of(w, name),
               .tolerance = w->d->axis[DECK_AXIS_TOLERANCE].value[task % w->tolerances] };
  pendres_options o = options_named(name);
  pendres_status status = PENDRES_OUT_OF_MEMORY;

  not_run(c);
  o.tolerance = r.tolerance;
  o.block_lanes = (int)w->d->precision.block_lanes;
  r.p = malloc(r.n * sizeof *r.p);
  r.x = malloc(3 * r.n * sizeof *r.x);
  if (r.p == NULL || r.x == NULL) goto done;
  r.v = r.x + r.n, r.error = r.v + r.n;
  for (size_t k = 0; k < r.n; k++)
    r.p[k] = w->unit.pendulum[work_unit_pick(&w->unit, r.n, k)];
  status = PENDRES_OK;
  if (!is_gsl(name)) {
    if (pendres_options_check(&o) != NULL) goto done;
    status = pendres_context_create(&o, &r.ctx);
  }
  if (status == PENDRES_OK) {
    contest result = { .pendulums = r.n };
    const pendres_status met = compare(&r, &result);
    if (met == PENDRES_OK) *c = result;
    if (met == PENDRES_OUT_OF_MEMORY) status = met;
  }
done:
  pendres_context_free(r.ctx);
  free(r.p);
  free(r.x);
  return status;
}

/* What a pendulum costs that is only asked what it settles on: the tolerance of default contexts. */
static pendres_status settle(work *w, pendres_context *ctx)
{
  const size_t n = w->unit.n;
  pendres_outcome *outcome = malloc(n * sizeof *outcome);
  double *v = calloc(n, sizeof *v), resolved = 0.0;
  pendres_cost cost;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (outcome == NULL || v == NULL) goto done;
  pendres_context_cost_reset(ctx);
  const double start = seconds_now();
  status = pendres_settle(ctx, n, w->unit.pendulum, w->unit.x, v, outcome, NULL);
  const double took = seconds_now() - start;
  if (status != PENDRES_OK) goto done;
  pendres_context_cost(ctx, &cost);
  for (size_t i = 0; i < n; i++) resolved += outcome[i].attractor >= 0;
  w->settled[0] = cost.pendulum_periods / (double)n;
  w->settled[1] = took / (double)n;
  w->settled[2] = resolved / (double)n;
done:
  free(outcome);
  free(v);
  return status;
}

/* Threads take turns: whoever is timed is alone. The last task is settling. */
static pendres_status take_turn(void *arg, size_t task, pendres_context *ctx)
{
  work *w = arg;
  pendres_status status;
#pragma omp critical(work_precision)
  status = task < w->methods * w->tolerances ? contend(w, task) : settle(w, ctx);
  return status;
}

/* ---- writing ------------------------------------------------------------------------------- */

/* Speed at an error, between two neighbouring tolerances on the logarithmic line; NaN outside. */
static double speed_at(const work *w, size_t method, double error)
{
  const contest *c = w->contest + method * w->tolerances;
  const int last = WORK_UNIT_MARKS - 1;
  for (size_t i = 0; i + 1 < w->tolerances; i++) {
    const double a = c[i].error[last], b = c[i + 1].error[last];
    if (!(a > 0.0 && b > 0.0 && a != b) || !(fmin(a, b) <= error && error <= fmax(a, b))) continue;
    const double t = log(error / a) / log(b / a);
    return exp((1.0 - t) * log(c[i].throughput) + t * log(c[i + 1].throughput));
  }
  return NAN;
}

typedef struct column {
  const char *name, *long_name, *units;
} column;

static const column columns[] = {
  { "error_10", "largest error of x and v after 10 drive periods", "1" },
  { "error_100", "largest error of x and v after 100 drive periods", "1" },
  { "estimated_error", "largest estimate of the error after 100 drive periods", "1" },
  { "steps_per_period", "steps a pendulum and drive period", "1" },
  { "rhs_per_period", "right-hand sides a pendulum and drive period", "1" },
  { "seconds", "time of the best run", "s" },
  { "throughput", "pendulum-periods a second on one thread", "s-1" },
};

static void cell(const contest *c, size_t column, double *value, double *error)
{
  const double relative = c->spread / c->seconds;
  switch (column) {
  case 0: *value = c->error[0], *error = end_rounding; break;
  case 1: *value = c->error[1], *error = end_rounding; break;
  case 2: *value = c->estimate, *error = fabs(c->estimate - c->error[1]); break;
  case 3: *value = c->steps, *error = 0.0; break;
  case 4: *value = c->rhs, *error = 0.0; break;
  case 5: *value = c->seconds, *error = c->spread; break;
  default: *value = c->throughput, *error = c->throughput * relative; break;
  }
}

static pendres_status write_columns(scene_run *run, const work *w, double *value, double *error)
{
  const size_t n = w->methods * w->tolerances;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < sizeof columns / sizeof *columns && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = { .name = columns[k].name,
                                      .dimensions = { "method", "tolerance" },
                                      .long_name = columns[k].long_name,
                                      .units = columns[k].units };
    for (size_t i = 0; i < n; i++) cell(&w->contest[i], k, &value[i], &error[i]);
    status = pendres_store_put_result(run->store, &spec, value, error, n);
  }
  for (size_t i = 0; i < n; i++) value[i] = (double)w->contest[i].pendulums;
  const pendres_store_spec count = { .name = "pendulums", .dimensions = { "method", "tolerance" },
                                     .long_name = "pendulums of the unit that were run" };
  return status == PENDRES_OK ? pendres_store_put(run->store, &count, value, n) : status;
}

static pendres_status write_settling(scene_run *run, const work *w)
{
  static const column about[] = {
    { "settling_cost_periods", "drive periods integrated for each pendulum that is asked what it "
                               "settles on, search and proof of attractors included", "1" },
    { "settling_seconds", "time for each of them", "s" },
    { "settling_resolved", "share of them that got an answer", "1" },
  };
  pendres_status status = PENDRES_OK;
  for (int k = 0; k < 3 && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = { .name = about[k].name, .long_name = about[k].long_name,
                                      .units = about[k].units };
    status = pendres_store_put_result(run->store, &spec, &w->settled[k], &w->settled_error[k], 1);
  }
  return status;
}

/* Ours and others' speeds at equal errors. */
static pendres_status write_speeds(scene_run *run, const work *w, double *value)
{
  const char *names[OTHERS], *comment =
    "unit 'ensemble' on one AVX-512 core; arkode_single: one ARKODE problem a pendulum";
  const pendres_store_spec ours = { .group = "at_error", .name = "throughput",
                                    .dimensions = { "method", "error" }, .units = "s-1",
                                    .long_name = "pendulum-periods a second at an error" };
  const pendres_store_spec theirs = { .group = "others", .name = "throughput",
                                      .dimensions = { "method", "error" }, .units = "s-1",
                                      .long_name = "pendulum-periods a second at an error",
                                      .comment = comment };
  const char *about = "largest error after 100 drive periods";
  pendres_status status =
    pendres_store_dimension(run->store, "at_error", "method", w->methods, NULL, "method", "1");
  if (status == PENDRES_OK)
    status = pendres_store_dimension(run->store, "at_error", "error", ERRORS, error_marks, about,
                                     "1");
  for (size_t m = 0; m < w->methods; m++)
    for (size_t e = 0; e < ERRORS; e++) value[m * ERRORS + e] = speed_at(w, m, error_marks[e]);
  if (status == PENDRES_OK)
    status = pendres_store_put(run->store, &ours, value, w->methods * ERRORS);
  for (size_t m = 0; m < OTHERS; m++) names[m] = others[m].name;
  if (status == PENDRES_OK)
    status = pendres_store_dimension_text(run->store, "others", "method", OTHERS, names, "method");
  if (status == PENDRES_OK)
    status = pendres_store_dimension(run->store, "others", "error", ERRORS, error_marks, about,
                                     "1");
  double speed[OTHERS * ERRORS];
  for (size_t i = 0; i < OTHERS * ERRORS; i++)
    speed[i] = 1e6 * others[i / ERRORS].speed[i % ERRORS];
  if (status == PENDRES_OK)
    status = pendres_store_put(run->store, &theirs, speed, OTHERS * ERRORS);
  return status;
}

static pendres_status write_results(scene_run *run, const work *w)
{
  const size_t n = w->methods * (w->tolerances > ERRORS ? w->tolerances : ERRORS);
  double *value = malloc(2 * n * sizeof *value);
  const char **names = malloc(w->methods * sizeof *names);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (value == NULL || names == NULL) {
    (void)scene_fail(run, status, "out of memory for %zu results", n);
    goto done;
  }
  for (size_t m = 0; m < w->methods; m++) names[m] = w->d->methods.name[m];
  status =
    pendres_store_dimension(run->store, NULL, "method", w->methods, NULL, "method, by number", "1");
  const pendres_store_spec name = { .name = "method_name", .type = PENDRES_STORE_STRING,
                                    .dimensions = { "method" }, .long_name = "method" };
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &name, names, w->methods);
  if (status == PENDRES_OK) status = scene_dimension(run, NULL, DECK_AXIS_TOLERANCE);
  if (status == PENDRES_OK) status = write_columns(run, w, value, value + n);
  if (status == PENDRES_OK) status = write_settling(run, w);
  if (status == PENDRES_OK) status = write_speeds(run, w, value);
  if (status != PENDRES_OK) (void)scene_store_failed(run, status);
done:
  free(value);
  free(names);
  return status;
}

/* ---- the scene ----------------------------------------------------------------------------- */

static void print_table(FILE *out, const work *w)
{
  fprintf(out, "%-22s %9s %9s %9s %9s %8s %8s %10s %5s\n", "method", "tolerance", "error 10",
          "error 100", "estimate", "steps", "rhs", "M/s", "n");
  for (size_t i = 0; i < w->methods * w->tolerances; i++) {
    const contest *c = &w->contest[i];
    fprintf(out, "%-22s %9.0e %9.1e %9.1e %9.1e %8.1f %8.1f %10.4f %5zu\n",
            w->d->methods.name[i / w->tolerances],
            w->d->axis[DECK_AXIS_TOLERANCE].value[i % w->tolerances], c->error[0], c->error[1],
            c->estimate, c->steps, c->rhs, 1e-6 * c->throughput, c->pendulums);
  }
  fprintf(out, "\n%-22s", "M/s at an error of");
  for (int e = 0; e < ERRORS; e++) fprintf(out, " %9.0e", error_marks[e]);
  for (size_t m = 0; m < w->methods; m++) {
    fprintf(out, "\n%-22s", w->d->methods.name[m]);
    for (int e = 0; e < ERRORS; e++) fprintf(out, " %9.4f", 1e-6 * speed_at(w, m, error_marks[e]));
  }
  fprintf(out,
          "\n\nA pendulum that is asked what it settles on costs %.2f drive periods, %.2e s; "
          "%.4g %% got an answer.\n",
          w->settled[0], w->settled[1], 100.0 * w->settled[2]);
}

static void plan(const deck *d, FILE *out)
{
  fprintf(out, "%zu methods by %zu tolerances on the unit '%s', one after another on one thread\n",
          d->methods.count, d->axis[DECK_AXIS_TOLERANCE].count, d->unit);
}

static pendres_status run_scene(scene_run *run)
{
  const deck *d = run->deck;
  work w = { .d = d, .methods = d->methods.count,
             .tolerances = d->axis[DECK_AXIS_TOLERANCE].count,
             .settled = { NAN, NAN, NAN }, .settled_error = { 0.0, NAN, 0.0 } };
  const size_t n = w.methods * w.tolerances;
  pendres_status status = work_unit_make(d->unit, &w.unit);
  if (status == PENDRES_OK) {
    w.contest = calloc(n, sizeof *w.contest);
    if (w.contest == NULL) status = PENDRES_OUT_OF_MEMORY;
  }
  if (status != PENDRES_OK) {
    (void)scene_fail(run, status, "out of memory for the unit '%s'", d->unit);
    goto done;
  }
  status = work_unit_refer(&w.unit, run->farm);
  if (status == PENDRES_OK) status = farm_run(run->farm, "runs", n + 1, take_turn, NULL, &w);
  if (status != PENDRES_OK) {
    (void)scene_farm_failed(run, status);
    goto done;
  }
  for (size_t i = 0; i < n; i++) run->failed_points += w.contest[i].failed != 0;
  status = write_results(run, &w);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &w);
done:
  free(w.contest);
  work_unit_free(&w.unit);
  return status;
}

const scene_kind scene_work_precision = {
  .kind = DECK_WORK_PRECISION,
  .references = "E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, "
                "section II.10",
  .plan = plan,
  .run = run_scene
};
