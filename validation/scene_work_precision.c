/*
 * scene_work_precision.c -- speed against error, of the library's methods and of a peer.
 *
 * Every method and tolerance advances the same pendulums by 100 drive periods; their errors then
 * are known from extended precision. benchmark.h says how each is run and timed: one after another,
 * so that the one that is timed runs alone.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/points.h"
#include "system/clock.h"
#include "validation/benchmark.h"

enum { OTHERS = 5, ERRORS = 4 };

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

/* What it costs to find the attractor on which a pendulum settles, and the share of pendulums for
   which it is found. */
typedef struct settling {
  double cost_periods, cost_periods_error, seconds, seconds_error, resolved, resolved_error;
} settling;

typedef struct work {
  const deck *d;
  farm *farm;
  work_unit unit;
  size_t methods, tolerances;
  benchmark *benchmark; /* [method][tolerance] */
  settling settled;
} work;

/* With the deck's own tolerance. */
static pendres_status settle(const scene_some *some)
{
  const work *w = some->of->arg;
  pendres_context *ctx = some->ctx;
  settling *out = some->rows;
  const size_t n = w->unit.n;
  pendres_settled *outcome = malloc(n * sizeof *outcome);
  double *v = calloc(n, sizeof *v), resolved = 0.0;
  pendres_cost cost;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (outcome == NULL || v == NULL) goto done;
  pendres_context_cost_reset(ctx);
  const double start = clock_thread();
  status = pendres_settle(ctx, n, w->unit.pendulum, w->unit.x, v, outcome, NULL);
  const double took = clock_thread() - start;
  if (status != PENDRES_OK) goto done;
  pendres_context_cost(ctx, &cost);
  for (size_t i = 0; i < n; i++) resolved += outcome[i].attractor >= 0;
  *out = (settling){.cost_periods = cost.pendulum_periods / (double)n,
                    .seconds = took / (double)n,
                    .seconds_error = NAN,
                    .resolved = resolved / (double)n};
done:
  free(outcome);
  free(v);
  return status;
}

static pendres_status measure(const scene_some *some)
{
  const work *w = some->of->arg;
  const size_t method = some->first / w->tolerances, tolerance = some->first % w->tolerances;
  const benchmark_rules rules = {
    .tolerance = w->d->axis[DECK_AXIS_TOLERANCE].value[tolerance],
    .block_lanes = (int)w->d->precision.block_lanes, .stop = farm_stopped, .stop_arg = w->farm};
  return benchmark_run(&w->unit, w->d->methods.name[method], &rules, some->rows);
}

/* ---- writing ------------------------------------------------------------------------------- */

/*
 * Speed at an error: between the tightest two neighbouring tolerances whose errors enclose it, on
 * the logarithmic line (a looser one that is as good is luck); NaN outside.
 */
static double speed_at(const work *w, size_t method, double error)
{
  const benchmark *c = w->benchmark + method * w->tolerances;
  const int last = WORK_UNIT_MARKS - 1;
  for (size_t i = 0; i + 1 < w->tolerances; i++) {
    const double a = c[i].error[last], b = c[i + 1].error[last];
    if (!(a > 0.0 && b > 0.0 && a != b) || !(fmin(a, b) <= error && error <= fmax(a, b))) continue;
    const double t = log(error / a) / log(b / a);
    return exp((1.0 - t) * log(c[i].throughput) + t * log(c[i + 1].throughput));
  }
  return NAN;
}

/* A benchmark as a row of results. */
typedef struct row {
  char method[DECK_NAME], failure[sizeof((benchmark *)0)->failure];
  double tolerance;
  double error_10, error_10_error, error_100, error_100_error;
  double estimated_error, estimated_error_error;
  double steps_per_period, steps_per_period_error, rhs_per_period, rhs_per_period_error;
  double seconds, seconds_error, throughput, throughput_error, millions;
  double estimate_ratio_least, estimate_ratio_median, pendulums;
} row;

#define NOTE(field, words, unit)                                                    \
  {.name = #field, .long_name = words, .units = unit, .type = SCENE_PLAIN,          \
   .value = offsetof(row, field)}
static const scene_column columns[] = {
  SCENE_COLUMN(row, error_10, "largest error of x and v after 10 drive periods"),
  SCENE_COLUMN(row, error_100, "largest error of x and v after 100 drive periods"),
  {SCENE_AS("estimated_error", row, estimated_error,
            "largest estimate of the error after 100 drive periods", NULL),
   .comment = "largest over the members; infinite where the method says of one that nothing is "
              "known of it, NaN where the method makes no estimate"},
  SCENE_COLUMN(row, steps_per_period, "steps a pendulum and drive period"),
  SCENE_COLUMN(row, rhs_per_period, "right-hand sides a pendulum and drive period"),
  {SCENE_AS("seconds", row, seconds, "processor time of the best run", NULL), .units = "s",
   .comment = "of the fastest of several runs. Its error is the distance to the next, and NaN "
              "where one run took so long that it was the only one"},
  {SCENE_AS("throughput", row, throughput, "pendulum-periods a second on one thread", NULL),
   .units = "s-1"},
  /* What is said about the figures: no results, so without errors. */
  NOTE(estimate_ratio_least, "least estimate of a member's error over its true one", NULL),
  NOTE(estimate_ratio_median, "median over members of estimate over true error", NULL),
  NOTE(pendulums, "pendulums of the unit that were run", NULL),
  SCENE_COLUMN_OF(SCENE_TEXT, row, failure, "why there are no figures; else empty"),
};

static row row_of(const work *w, size_t i)
{
  const benchmark *c = &w->benchmark[i];
  row r = {.tolerance = w->d->axis[DECK_AXIS_TOLERANCE].value[i % w->tolerances],
           .error_10 = c->error[0], .error_10_error = end_rounding,
           .error_100 = c->error[1], .error_100_error = end_rounding,
           .estimated_error = c->estimate,
           .estimated_error_error =
             isfinite(c->estimate) ? fabs(c->estimate - c->error[1]) : NAN,
           .steps_per_period = c->steps, .rhs_per_period = c->rhs,
           .seconds = c->seconds, .seconds_error = c->spread,
           .throughput = c->throughput,
           .throughput_error = c->throughput * (c->spread / c->seconds),
           .millions = 1e-6 * c->throughput,
           .estimate_ratio_least = c->honesty, .estimate_ratio_median = c->padding,
           .pendulums = (double)c->pendulums};
  memcpy(r.method, w->d->methods.name[i / w->tolerances], sizeof r.method);
  memcpy(r.failure, c->failure, sizeof r.failure);
  return r;
}

/* Members that no method could help; see benchmark.h. */
static size_t left_out_of(const work *w, int mark)
{
  size_t some = 0;
  for (size_t i = 0; i < w->unit.n; i++) some += !(w->unit.growth[mark][i] <= BENCHMARK_WILD);
  return some;
}

static void write_left_out(scene_run *run, const work *w)
{
  static const scene_column column = {
    .name = "left_out", .type = SCENE_PLAIN,
    .long_name = "members left out of the largest errors: what was off at the start is 1000-fold "
                 "there"};
  double left_out[WORK_UNIT_MARKS];
  const scene_table table = {.dimensions = {"mark"}, SCENE_ROWS(left_out, WORK_UNIT_MARKS)};
  for (int m = 0; m < WORK_UNIT_MARKS; m++) left_out[m] = (double)left_out_of(w, m);
  const pendres_store_spec marks = {.name = "mark", .type = PENDRES_STORE_INT64,
                                    .long_name = "drive periods after which errors are measured"};
  scene_put_dimension(run, &marks, (const int64_t[]){10, 100}, WORK_UNIT_MARKS);
  scene_columns_write(run, &table, 1, &column);
}

static void write_settling(scene_run *run, const settling *settled)
{
  static const scene_column about[] = {
    SCENE_COLUMN(settling, cost_periods, "drive periods integrated for each pendulum that is asked "
                 "what it settles on, search and proof of attractors included"),
    {SCENE_AS("seconds", settling, seconds, "time for each of them", NULL), .units = "s"},
    SCENE_COLUMN(settling, resolved, "share of them that got an answer"),
  };
  const scene_table table = {.prefix = "settling", SCENE_ROWS(settled, 1)};
  SCENE_WRITE(run, &table, about);
}

/* Speeds at equal errors, [method][error], in a group of their own. */
static void write_speeds(scene_run *run, const char *group, size_t methods,
                         const char *const *names, const double *speed, const char *comment)
{
  const scene_column column = {.name = "throughput", .units = "s-1", .type = SCENE_PLAIN,
                               .long_name = "pendulum-periods a second at an error",
                               .comment = comment};
  const scene_table table = {.group = group, .dimensions = {"method", "error"},
                             SCENE_ROWS(speed, methods * ERRORS)};
  const pendres_store_spec method = {.group = group, .name = "method", .long_name = "method",
                                     .type = PENDRES_STORE_STRING};
  const pendres_store_spec error = {.group = group, .name = "error",
                                    .long_name = "largest error after 100 drive periods"};
  scene_put_dimension(run, &method, names, methods);
  scene_put_dimension(run, &error, error_marks, ERRORS);
  scene_columns_write(run, &table, 1, &column);
}

static void write_ours(scene_run *run, const work *w)
{
  double *speed = scene_array(run, w->methods * ERRORS, sizeof *speed);
  const char **names = scene_array(run, w->methods, sizeof *names);
  if (names == NULL) return;
  for (size_t m = 0; m < w->methods; m++) {
    names[m] = w->d->methods.name[m];
    for (size_t e = 0; e < ERRORS; e++) speed[m * ERRORS + e] = speed_at(w, m, error_marks[e]);
  }
  write_speeds(run, "at_error", w->methods, names, speed,
               "interpolated between the tightest tolerances whose errors enclose it");
}

static void write_others(scene_run *run)
{
  const char *names[OTHERS];
  double speed[OTHERS * ERRORS];
  for (size_t m = 0; m < OTHERS; m++) {
    names[m] = others[m].name;
    for (size_t e = 0; e < ERRORS; e++) speed[m * ERRORS + e] = 1e6 * others[m].speed[e];
  }
  write_speeds(run, "others", OTHERS, names, speed,
               "unit 'ensemble' on one AVX-512 core; arkode_single: one ARKODE problem a pendulum");
}

static void write_results(scene_run *run, const work *w, const scene_table *benchmarks)
{
  static const scene_column name = {.name = "method_name", .long_name = "method",
                                    .type = SCENE_TEXT};
  const pendres_store_spec unit = {.name = "unit", .long_name = "pendulums that were run",
                                   .type = PENDRES_STORE_STRING};
  const char *words = w->d->unit;
  const scene_table methods = {.dimensions = {"method"},
                               SCENE_ROWS(w->d->methods.name, w->methods)};
  scene_numbering(run, "method", w->methods, "method, by number");
  scene_columns_write(run, &methods, 1, &name);
  scene_dimension(run, NULL, DECK_AXIS_TOLERANCE);
  SCENE_WRITE(run, benchmarks, columns);
  write_left_out(run, w);
  scene_put(run, &unit, &words, NULL, 1);
  write_settling(run, &w->settled);
  write_ours(run, w);
  write_others(run);
}

/* ---- the scene ----------------------------------------------------------------------------- */

static const scene_cell cells[] = {
  {.heading = "method                ", .format = "%-21s ", .type = SCENE_TEXT,
   .value = offsetof(row, method)},
  SCENE_CELL(row, tolerance, "tolerance ", "%9.0e "),
  SCENE_CELL(row, error_10, "error 10 ", "%8.1e "),
  SCENE_CELL(row, error_100, "error 100 ", "%9.1e "),
  SCENE_CELL(row, estimated_error, "estimate ", "%8.1e "),
  SCENE_CELL(row, estimate_ratio_least, "   least ", "%8.2g "),
  SCENE_CELL(row, steps_per_period, "  steps ", "%7.1f "),
  SCENE_CELL(row, rhs_per_period, "    rhs ", "%7.1f "),
  SCENE_CELL(row, millions, "     M/s ", "%8.4f "),
  SCENE_CELL(row, pendulums, "   n", "%4.0f"),
};

static void print_table(FILE *out, const work *w, const scene_table *benchmarks)
{
  const row *rows = benchmarks->rows;
  SCENE_PRINT(out, benchmarks, benchmarks->n, cells, NULL);
  fprintf(out, "least: of estimate over true error, over all n members; %zu of %zu members are "
               "left out of error 10\nand %zu of error 100, which grow whatever was off at the "
               "start %d-fold. M/s: million pendulum-periods\na second of one thread.\n",
          left_out_of(w, 0), w->unit.n, left_out_of(w, 1), BENCHMARK_WILD);
  for (size_t i = 0; i < benchmarks->n; i++)
    if (rows[i].failure[0] != '\0')
      fprintf(out, "%s at %g failed: %s\n", rows[i].method, rows[i].tolerance, rows[i].failure);
  fprintf(out, "\n%-21s", "M/s at an error of");
  for (int e = 0; e < ERRORS; e++) fprintf(out, " %9.0e", error_marks[e]);
  for (size_t m = 0; m < w->methods; m++) {
    fprintf(out, "\n%-21s", w->d->methods.name[m]);
    for (int e = 0; e < ERRORS; e++) fprintf(out, " %9.4f", 1e-6 * speed_at(w, m, error_marks[e]));
  }
  fprintf(out,
          "\n\nA pendulum that is asked what it settles on costs %.2f drive periods, %.2e s; "
          "%.4g %% got an answer.\n",
          w->settled.cost_periods, w->settled.seconds, 100.0 * w->settled.resolved);
}

static void tell(scene_run *run, const work *w)
{
  const size_t n = w->methods * w->tolerances;
  row *rows = scene_array(run, n, sizeof *rows);
  const scene_table benchmarks = {.dimensions = {"method", "tolerance"}, SCENE_ROWS(rows, n)};
  if (rows == NULL) return;
  for (size_t i = 0; i < n; i++) {
    rows[i] = row_of(w, i);
    run->failed_points += rows[i].failure[0] != '\0';
  }
  write_results(run, w, &benchmarks);
  if (scene_prints(run)) print_table(run->table, w, &benchmarks);
}

static void describe(const deck *d, FILE *out)
{
  fprintf(out, "%zu methods by %zu tolerances on the unit '%s', one after another on one thread\n",
          d->methods.count, d->axis[DECK_AXIS_TOLERANCE].count, d->unit);
}

static pendres_status run_scene(scene_run *run)
{
  const deck *d = run->deck;
  work w = { .d = d, .farm = run->farm,
             .methods = d->methods.count, .tolerances = d->axis[DECK_AXIS_TOLERANCE].count };
  const size_t n = w.methods * w.tolerances;
  pendres_status status = work_unit_make(d->unit, &w.unit);
  if (status != PENDRES_OK) scene_fail(run, status, "out of memory for the unit '%s'", d->unit);
  scene_points runs = {.n = n, .chunk = 1, .size = sizeof *w.benchmark, .compute = measure,
                       .unmarked = 1, .arg = &w};
  scene_points last = {.n = 1, .chunk = 1, .size = sizeof w.settled, .compute = settle,
                       .unmarked = 1, .rows = &w.settled, .arg = &w};
  w.benchmark = runs.rows = scene_array(run, n, sizeof *w.benchmark);
  if (scene_going(run)) {
    status = work_unit_refer(&w.unit, run->farm);
    if (status != PENDRES_OK) scene_fail(run, status, "%s", farm_message(run->farm));
  }
  scene_points_compute(run, &(farm_stage){.what = "runs", .last = 1, .timed = 1}, 2,
                       (scene_points *[]){&runs, &last});
  tell(run, &w);
  work_unit_free(&w.unit);
  return run->status;
}

static double runs_of(const deck *d)
{
  return (double)d->axis[DECK_AXIS_TOLERANCE].count * (double)(1 + d->methods.count);
}

const scene_kind scene_work_precision = {
  .kind = DECK_WORK_PRECISION,
  .references = "E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations "
                "I, section II.10",
  .size = {.head = 45e3, .point = 200.0, .memory = 1e3, .stages = 0.0, .after = 1.0,
           .seconds = 0.5, .points = runs_of},
  .timed = 1,
  .any_method = 1,
  .describe = describe,
  .run = run_scene
};
