/*
 * scene_work_precision.c -- speed against error, of the library's methods and of a peer.
 *
 * Every method and tolerance advances the same pendulums by 100 drive periods; how far they are off
 * then is known from extended precision (work_unit.h). contest.h says how each is run and timed;
 * one after another, so that whoever is timed is alone.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "validation/contest.h"
#include "scenes/scene.h"

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

typedef struct work {
  const deck *d;
  farm *farm;
  work_unit unit;
  size_t methods, tolerances;
  contest *contest; /* [method][tolerance] */
  double settled[3], settled_error[3]; /* periods, seconds a pendulum; share that is resolved */
} work;

/* What a pendulum costs that is only asked what it settles on. */
typedef struct settling {
  double value[3]; /* periods, seconds a pendulum; share that is resolved */
} settling;

/* With the deck's own tolerance. */
static pendres_status settle(const work *w, pendres_context *ctx, settling *out)
{
  const size_t n = w->unit.n;
  pendres_outcome *outcome = malloc(n * sizeof *outcome);
  double *v = calloc(n, sizeof *v), resolved = 0.0;
  pendres_cost cost;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (outcome == NULL || v == NULL) goto done;
  pendres_context_cost_reset(ctx);
  const double start = contest_clock();
  status = pendres_settle(ctx, n, w->unit.pendulum, w->unit.x, v, outcome, NULL);
  const double took = contest_clock() - start;
  if (status != PENDRES_OK) goto done;
  pendres_context_cost(ctx, &cost);
  for (size_t i = 0; i < n; i++) resolved += outcome[i].attractor >= 0;
  out->value[0] = cost.pendulum_periods / (double)n;
  out->value[1] = took / (double)n;
  out->value[2] = resolved / (double)n;
done:
  free(outcome);
  free(v);
  return status;
}

/* A contest; the last task is settling. */
static pendres_status measure(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const work *w = arg;
  if (task == w->methods * w->tolerances) {
    settling *s = farm_record_resize(out, sizeof *s);
    return s != NULL ? settle(w, ctx, s) : PENDRES_OUT_OF_MEMORY;
  }
  contest *c = farm_record_resize(out, sizeof *c);
  if (c == NULL) return PENDRES_OUT_OF_MEMORY;
  return contest_run(&w->unit, w->d->methods.name[task / w->tolerances],
                     w->d->axis[DECK_AXIS_TOLERANCE].value[task % w->tolerances],
                     (int)w->d->precision.block_lanes, farm_stopped, w->farm, c);
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  if (task == w->methods * w->tolerances) memcpy(w->settled, in->data, sizeof w->settled);
  else w->contest[task] = *(const contest *)in->data;
  return PENDRES_OK;
}

/* ---- writing ------------------------------------------------------------------------------- */

/*
 * Speed at an error: between the tightest two neighbouring tolerances whose errors enclose it, on
 * the logarithmic line (a looser one that is as good is luck); NaN outside.
 */
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
  { "seconds", "processor time of the best run", "s" },
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

/* Members that no method could help; see contest.h. */
static size_t left_out_of(const work *w, int mark)
{
  size_t some = 0;
  for (size_t i = 0; i < w->unit.n; i++) some += !(w->unit.growth[mark][i] <= CONTEST_WILD);
  return some;
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
  return status;
}

/* What is said about the figures: no results, so without errors. */
static pendres_status write_notes(scene_run *run, const work *w, double *value)
{
  static const column notes[] = {
    { "estimate_ratio_least", "least estimate of a member's error over its true one", "1" },
    { "estimate_ratio_median", "median over members of estimate over true error", "1" },
    { "pendulums", "pendulums of the unit that were run", "1" },
  };
  const size_t n = w->methods * w->tolerances;
  pendres_status status = PENDRES_OK;
  for (int k = 0; k < 3 && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = { .name = notes[k].name, .units = notes[k].units,
                                      .dimensions = { "method", "tolerance" },
                                      .long_name = notes[k].long_name };
    for (size_t i = 0; i < n; i++) {
      const contest *c = &w->contest[i];
      value[i] = k == 0 ? c->honesty : k == 1 ? c->padding : (double)c->pendulums;
    }
    status = pendres_store_put(run->store, &spec, value, n);
  }
  const char **why = malloc(n * sizeof *why);
  if (why == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < n; i++) why[i] = w->contest[i].failure;
  const pendres_store_spec failure = { .name = "failure", .type = PENDRES_STORE_STRING,
                                       .dimensions = { "method", "tolerance" },
                                       .long_name = "why there are no figures; else empty" };
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &failure, why, n);
  free(why);
  double left_out[WORK_UNIT_MARKS];
  for (int m = 0; m < WORK_UNIT_MARKS; m++) left_out[m] = (double)left_out_of(w, m);
  const pendres_store_spec out = { .name = "left_out", .dimensions = { "mark" },
                                   .long_name = "members left out of the largest errors: what "
                                                "was off at the start is 1000-fold there" };
  if (status == PENDRES_OK)
    status = pendres_store_dimension_integer(run->store, NULL, "mark", WORK_UNIT_MARKS,
                                             (const int64_t[]){ 10, 100 },
                                             "drive periods after which errors are measured", "1");
  if (status == PENDRES_OK)
    status = pendres_store_put(run->store, &out, left_out, WORK_UNIT_MARKS);
  if (status == PENDRES_OK)
    status = pendres_store_put_text(run->store, NULL, "unit", "pendulums that were run",
                                    w->d->unit);
  return status;
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
static pendres_status write_speeds(scene_run *run, const work *w, const char **ours_names,
                                   double *value)
{
  const char *names[OTHERS], *comment =
    "unit 'ensemble' on one AVX-512 core; arkode_single: one ARKODE problem a pendulum";
  const pendres_store_spec ours = { .group = "at_error", .name = "throughput",
                                    .dimensions = { "method", "error" }, .units = "s-1",
                                    .long_name = "pendulum-periods a second at an error",
                                    .comment = "interpolated between the tightest tolerances "
                                               "whose errors enclose it" };
  const pendres_store_spec theirs = { .group = "others", .name = "throughput",
                                      .dimensions = { "method", "error" }, .units = "s-1",
                                      .long_name = "pendulum-periods a second at an error",
                                      .comment = comment };
  const char *about = "largest error after 100 drive periods";
  pendres_status status = pendres_store_dimension_text(run->store, "at_error", "method",
                                                       w->methods, ours_names, "method");
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
  if (status == PENDRES_OK) status = write_notes(run, w, value);
  if (status == PENDRES_OK) status = write_settling(run, w);
  if (status == PENDRES_OK) status = write_speeds(run, w, names, value);
  if (status != PENDRES_OK) (void)scene_store_failed(run, status);
done:
  free(value);
  free(names);
  return status;
}

/* ---- the scene ----------------------------------------------------------------------------- */

static void print_contests(FILE *out, const work *w)
{
  fprintf(out, "%-21s %9s %8s %9s %8s %8s %7s %7s %8s %4s\n", "method", "tolerance", "error 10",
          "error 100", "estimate", "least", "steps", "rhs", "M/s", "n");
  for (size_t i = 0; i < w->methods * w->tolerances; i++) {
    const contest *c = &w->contest[i];
    fprintf(out, "%-21s %9.0e %8.1e %9.1e %8.1e %8.2g %7.1f %7.1f %8.4f %4zu\n",
            w->d->methods.name[i / w->tolerances],
            w->d->axis[DECK_AXIS_TOLERANCE].value[i % w->tolerances], c->error[0], c->error[1],
            c->estimate, c->honesty, c->steps, c->rhs, 1e-6 * c->throughput, c->pendulums);
  }
  fprintf(out, "least: of estimate over true error, over all n members; %zu of %zu members are "
               "left out of error 10\nand %zu of error 100, which grow whatever was off at the "
               "start %d-fold. M/s: million pendulum-periods\na second of one thread.\n",
          left_out_of(w, 0), w->unit.n, left_out_of(w, 1), CONTEST_WILD);
  for (size_t i = 0; i < w->methods * w->tolerances; i++)
    if (w->contest[i].failure[0] != '\0')
      fprintf(out, "%s at %g failed: %s\n", w->d->methods.name[i / w->tolerances],
              w->d->axis[DECK_AXIS_TOLERANCE].value[i % w->tolerances], w->contest[i].failure);
}

static void print_table(FILE *out, const work *w)
{
  print_contests(out, w);
  fprintf(out, "\n%-21s", "M/s at an error of");
  for (int e = 0; e < ERRORS; e++) fprintf(out, " %9.0e", error_marks[e]);
  for (size_t m = 0; m < w->methods; m++) {
    fprintf(out, "\n%-21s", w->d->methods.name[m]);
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
  work w = { .d = d, .farm = run->farm,
             .methods = d->methods.count, .tolerances = d->axis[DECK_AXIS_TOLERANCE].count,
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
  if (status != PENDRES_OK) {
    (void)scene_fail(run, status, "%s", farm_message(run->farm));
    goto done;
  }
  status = scene_compute(run, &(farm_stage){ .what = "runs", .last = 1, .tasks = n + 1,
                                             .task = measure,
                                             .timed = 1, .collect = collect, .arg = &w });
  if (status != PENDRES_OK) goto done;
  for (size_t i = 0; i < n; i++) run->failed_points += w.contest[i].failure[0] != '\0';
  status = write_results(run, &w);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &w);
done:
  free(w.contest);
  work_unit_free(&w.unit);
  return status;
}

const scene_kind scene_work_precision = {
  .kind = DECK_WORK_PRECISION,
  .references = "E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations "
                "I, section II.10",
  .plan = plan,
  .run = run_scene
};
