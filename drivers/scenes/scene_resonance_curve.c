/*
 * scene_resonance_curve.c -- resonance frequency against amplitude, a point a damping.
 *
 * The paper's Fig. 2 and its inset. One task a damping: pendres_resonance_find.
 */
#include <math.h>
#include <stdlib.h>

#include "scenes/scene_failed.h"

typedef struct curve {
  const deck *d;
  pendres_sweep sweep;
  pendres_ensemble ensemble;
  pendres_resonance *points; /* one a damping */
  pendres_status *outcome;
  scene_failures failed;
} curve;

static void plan(const deck *d, FILE *out)
{
  fprintf(out,
          "resonances at %zu dampings %g to %g, drive amplitude %g: the largest mean loop area of\n"
          "%lld members over drive frequencies %g to %g\n",
          d->axis[DECK_AXIS_DAMPING].count, d->axis[DECK_AXIS_DAMPING].value[0],
          d->axis[DECK_AXIS_DAMPING].value[d->axis[DECK_AXIS_DAMPING].count - 1],
          d->pendulum.drive_amplitude, (long long)d->ensemble.members, d->search[0], d->search[1]);
}

/* What a task finds of its damping. */
typedef struct record {
  pendres_status outcome;
  pendres_resonance point;
  scene_verdict verdict;
} record;

static pendres_status compute(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const curve *c = arg;
  record *r = out->data;
  pendres_pendulum p = pendres_sweep_pendulum(&c->sweep, task, NULL, NULL);
  p.drive_frequency = c->d->search[0];
  r->outcome = pendres_resonance_find_ensemble(ctx, &p, c->d->search[0], c->d->search[1],
                                               &c->ensemble, &r->point);
  if (r->outcome == PENDRES_OK && !r->point.complete)
    scene_verdict_mark(&r->verdict, SCENE_FAILURE_BUDGET, NULL);
  /* A damping whose area has no peak in the range is a point without a result, not a failure. */
  return scene_verdict_note(&r->verdict, r->outcome, pendres_context_message(ctx));
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  curve *c = arg;
  const record *r = in->data;
  c->outcome[task] = r->outcome;
  c->points[task] = r->point;
  scene_failures_take(&c->failed, task, &r->verdict);
  return PENDRES_OK;
}

/* ---- results ---- */

typedef struct value {
  double result, error;
} value;

static value frequency(const pendres_resonance *r)
{
  return (value){r->frequency, r->frequency_error};
}

static value period(const pendres_resonance *r)
{
  const double tau = 2.0 * PENDRES_PI / r->frequency;
  return (value){tau, tau * r->frequency_error / r->frequency};
}

static value area(const pendres_resonance *r)
{
  return (value){r->loop_area, r->loop_area_error};
}

static value loop_amplitude(const pendres_resonance *r)
{
  return (value){r->response.mean_loop_amplitude, r->response.mean_loop_amplitude_error};
}

static value amplitude(const pendres_resonance *r)
{
  return (value){r->response.mean_amplitude, r->response.mean_amplitude_error};
}

static value phase_lag(const pendres_resonance *r)
{
  return (value){r->response.phase_lag, r->response.phase_lag_error};
}

static value power(const pendres_resonance *r)
{
  return (value){r->response.mean_power, r->response.mean_power_error};
}

static value sa_fraction(const pendres_resonance *r)
{
  return (value){r->response.sa_fraction, r->response.sa_fraction_error};
}

static value free_frequency(const pendres_resonance *r)
{
  const double a = r->response.mean_loop_amplitude, e = r->response.mean_loop_amplitude_error;
  const double f = pendres_free_frequency(a);
  return (value){f, fabs(pendres_free_frequency(a + e) - f) + 4e-16};
}

static value fold(const pendres_resonance *r)
{
  return (value){r->fold_frequency, r->fold_frequency_error};
}

static const struct {
  const char *name, *long_name, *units;
  value (*of)(const pendres_resonance *r);
} results[] = {
  {"resonance_frequency", "drive frequency of the largest mean loop area", "1", frequency},
  {"resonance_period", "drive period of the largest mean loop area", "1", period},
  {"mean_loop_area", "mean loop area of the ensemble at resonance", "1", area},
  {"mean_loop_amplitude", "amplitude of the ensemble-averaged loop", "rad", loop_amplitude},
  {"mean_amplitude", "mean of the members' amplitudes", "rad", amplitude},
  {"phase_lag", "phase lag of the ensemble-averaged loop", "rad", phase_lag},
  {"mean_power", "mean power taken up from the drive", "1", power},
  {"sa_fraction", "share of the members on the small-amplitude state", "1", sa_fraction},
  {"free_frequency", "frequency of the free undamped pendulum of that loop amplitude", "1",
   free_frequency},
  {"fold_frequency", "drive frequency of the fold that makes the edge", "1", fold},
};

enum { RESULTS = sizeof results / sizeof results[0] };

/* What kind of peak a point is, and why there is none. */
static pendres_status write_kinds(scene_run *run, const curve *c, int8_t *peak)
{
  static const char *const meanings[] = {"smooth", "edge", "ragged", "none"};
  static const deck_axis_id axis = DECK_AXIS_DAMPING;
  const size_t n = c->d->axis[axis].count;
  const pendres_store_spec spec = {.name = "peak", .type = PENDRES_STORE_INT8,
                                   .dimensions = {"damping"}, .flag_count = 4,
                                   .flag_meanings = meanings,
                                   .long_name = "a smooth maximum, the largest value at a jump, or "
                                                "the largest found where jumps have no end"};
  for (size_t i = 0; i < n; i++)
    peak[i] = c->outcome[i] == PENDRES_OK ? (int8_t)c->points[i].peak : 3;
  const pendres_status status = pendres_store_put(run->store, &spec, peak, n);
  if (status != PENDRES_OK) return status;
  return scene_failures_write(run, &c->failed, "failed", "resonance", 1, &axis);
}

static pendres_status write_uncertain(scene_run *run, const curve *c)
{
  static const deck_axis_id axis = DECK_AXIS_DAMPING;
  const size_t n = c->d->axis[axis].count;
  int64_t *count = malloc(n * sizeof *count);
  if (count == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < n; i++) count[i] = (int64_t)c->points[i].response.uncertain;
  const pendres_status status = scene_write_uncertain(run, 1, &axis, count);
  free(count);
  return status;
}

static pendres_status write_results(scene_run *run, const curve *c)
{
  const deck_axis *axis = &c->d->axis[DECK_AXIS_DAMPING];
  const size_t n = axis->count;
  double *value_of = malloc(n * sizeof *value_of), *error = malloc(n * sizeof *error);
  int8_t *peak = malloc(n * sizeof *peak);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (value_of == NULL || error == NULL || peak == NULL) {
    (void)scene_fail(run, status, "out of memory for %zu results", n);
    goto done;
  }
  status = pendres_store_dimension(run->store, "", "damping", n, axis->value, "damping", "1");
  for (int k = 0; k < RESULTS && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = {.name = results[k].name, .dimensions = {"damping"},
                                     .long_name = results[k].long_name, .units = results[k].units};
    for (size_t i = 0; i < n; i++) {
      const value v =
        c->outcome[i] == PENDRES_OK ? results[k].of(&c->points[i]) : (value){NAN, NAN};
      value_of[i] = v.result;
      error[i] = v.error;
    }
    status = pendres_store_put_result(run->store, &spec, value_of, error, n);
  }
  if (status == PENDRES_OK) status = write_uncertain(run, c);
  if (status == PENDRES_OK) status = write_kinds(run, c, peak);
  if (status != PENDRES_OK) (void)scene_store_failed(run, status);
done:
  free(value_of);
  free(error);
  free(peak);
  return status;
}

/* ---- the paper's figures ---- */

/* Printed resonant periods (paper, Figs. 3 and 4) at F0 = 0.2. */
static const struct {
  double damping, period;
  const char *name;
} printed_periods[] = {
  {0.24, 6.66, "resonance_period_damping_0_24"},
  {0.32, 6.542, "resonance_period_damping_0_32"},
  {0.80, 6.865, "resonance_period_damping_0_80"},
  {0.90, 7.02, "resonance_period_damping_0_90"},
};

/* Printed dampings of the largest resonance frequency, and below which the curve breaks off. */
static const struct {
  double drive_amplitude, top, break_off;
} printed_turns[] = {{0.2, 0.38, 0.165}, {0.1, 0.28, 0.099}};

/* Index of a damping of the axis; -1 if it is not there. */
static int index_of(const deck_axis *axis, double damping)
{
  for (size_t i = 0; i < axis->count; i++)
    if (fabs(axis->value[i] - damping) < 1e-12) return (int)i;
  return -1;
}

/* Vertex of the parabola through three points; 0 if it does not open downwards. */
static int vertex(const double x[3], const double y[3], double *at)
{
  const double left = (y[1] - y[0]) / (x[1] - x[0]), right = (y[2] - y[1]) / (x[2] - x[1]);
  const double bend = (right - left) / (x[2] - x[0]);
  if (!(bend < 0.0)) return 0;
  *at = 0.5 * (x[0] + x[1]) - left / (2.0 * bend);
  return 1;
}

/*
 * The vertex through three dampings around a middle one, computed for the purpose. *there: 0 where
 * one of them has no resonance, or the three no vertex; what ends the run is returned.
 */
static pendres_status vertex_near(scene_run *run, const curve *c, double middle, double spacing,
                                  double *at, int *there)
{
  double x[3], y[3];
  pendres_context *ctx = farm_context(run->farm);
  *there = 0;
  if (ctx == NULL)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for the turning point");
  for (int k = 0; k < 3; k++) {
    pendres_resonance r;
    x[k] = middle + (k - 1) * spacing;
    const pendres_pendulum p = {.damping = x[k],
                                .drive_amplitude = c->d->pendulum.drive_amplitude};
    const pendres_status status = pendres_resonance_find_ensemble(
      ctx, &p, c->d->search[0], c->d->search[1], &c->ensemble, &r);
    if (status != PENDRES_OK && scene_failure_of(status) == SCENE_FAILURE_NONE)
      return scene_fail(run, status, "%s", pendres_context_message(ctx));
    if (status != PENDRES_OK) return PENDRES_OK;
    y[k] = r.frequency;
  }
  *there = vertex(x, y, at);
  return PENDRES_OK;
}

/*
 * Damping of the largest resonance frequency on the smooth part of the curve, from three dampings
 * ever closer together; the last change is a bound on the cubic term that is left.
 */
static pendres_status turning_point(scene_run *run, const curve *c, double *damping, double *error,
                                    int *there)
{
  const deck_axis *axis = &c->d->axis[DECK_AXIS_DAMPING];
  size_t top = 0;
  double coarse;
  *there = 0;
  for (size_t i = 1; i + 1 < axis->count; i++)
    if (c->outcome[i] == PENDRES_OK &&
        (top == 0 || c->points[i].frequency > c->points[top].frequency))
      top = i;
  if (top == 0 || c->points[top].peak != PENDRES_PEAK_SMOOTH) return PENDRES_OK;
  pendres_status status = vertex_near(run, c, axis->value[top], 4e-3, &coarse, there);
  if (status == PENDRES_OK && *there) status = vertex_near(run, c, coarse, 1e-3, damping, there);
  if (status == PENDRES_OK && *there) *error = fabs(*damping - coarse) + 1e-7;
  return status;
}

/* Middle of the gap in damping where the peak turns from an edge to smooth. */
static int break_off(const curve *c, double *damping, double *error)
{
  const deck_axis *axis = &c->d->axis[DECK_AXIS_DAMPING];
  for (size_t i = 0; i + 1 < axis->count; i++)
    if (c->outcome[i] == PENDRES_OK && c->outcome[i + 1] == PENDRES_OK &&
        c->points[i].peak == PENDRES_PEAK_EDGE && c->points[i + 1].peak == PENDRES_PEAK_SMOOTH) {
      *damping = 0.5 * (axis->value[i] + axis->value[i + 1]);
      *error = 0.5 * (axis->value[i + 1] - axis->value[i]);
      return 1;
    }
  return 0;
}

static pendres_status write_paper(scene_run *run, const curve *c)
{
  enum { MOST = sizeof printed_periods / sizeof printed_periods[0] + 2 };
  scene_printed values[MOST];
  size_t n = 0;
  const double f0 = c->d->pendulum.drive_amplitude;
  for (size_t k = 0; k < sizeof printed_turns / sizeof printed_turns[0]; k++) {
    double damping, error;
    if (fabs(f0 - printed_turns[k].drive_amplitude) > 1e-12) continue;
    int there = 0;
    const pendres_status status = turning_point(run, c, &damping, &error, &there);
    if (status != PENDRES_OK) return status;
    if (there)
      values[n++] = (scene_printed){"damping_of_largest_frequency", printed_turns[k].top, damping,
                                    error};
    if (break_off(c, &damping, &error))
      values[n++] = (scene_printed){"damping_of_break", printed_turns[k].break_off, damping, error};
  }
  for (size_t k = 0; k < sizeof printed_periods / sizeof printed_periods[0]; k++) {
    const int i = index_of(&c->d->axis[DECK_AXIS_DAMPING], printed_periods[k].damping);
    if (i < 0 || fabs(f0 - 0.2) > 1e-12 || c->outcome[i] != PENDRES_OK) continue;
    const value v = period(&c->points[i]);
    values[n++] =
      (scene_printed){printed_periods[k].name, printed_periods[k].period, v.result, v.error};
  }
  return n > 0 ? scene_write_paper(run, n, values) : PENDRES_OK;
}

static void print_table(FILE *out, const curve *c)
{
  const deck_axis *axis = &c->d->axis[DECK_AXIS_DAMPING];
  fprintf(out, "damping   frequency     +-       period       amplitude  area         peak\n");
  for (size_t i = 0; i < axis->count; i++) {
    const pendres_resonance *r = &c->points[i];
    /* Some twenty lines show the curve. */
    if (axis->count > 24 && i % (axis->count / 20 + 1) != 0 && i + 1 != axis->count) continue;
    if (c->outcome[i] != PENDRES_OK)
      fprintf(out, "%-9.4g %s\n", axis->value[i],
              c->outcome[i] == PENDRES_NOT_FOUND ? "no peak in the range" : "failed");
    else
      fprintf(out, "%-9.4g %.10f  %.0e  %.9f  %.6f   %.8f   %s\n", axis->value[i], r->frequency,
              r->frequency_error, 2.0 * PENDRES_PI / r->frequency,
              r->response.mean_loop_amplitude, r->loop_area, pendres_peak_name(r->peak));
  }
}

static pendres_status run_scene(scene_run *run)
{
  curve c = {.d = run->deck,
             .sweep = scene_sweep(run->deck),
             .ensemble = scene_ensemble(run->deck)};
  const size_t n = run->deck->axis[DECK_AXIS_DAMPING].count;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  c.points = calloc(n, sizeof *c.points);
  c.outcome = calloc(n, sizeof *c.outcome);
  if (c.points == NULL || c.outcome == NULL || scene_failures_create(n, &c.failed) != PENDRES_OK) {
    (void)scene_fail(run, status, "out of memory for %zu dampings", n);
    goto done;
  }
  status = scene_compute(run, &(farm_stage){ .what = "dampings", .last = 1, .tasks = n, .task = compute,
                                             .record_size = sizeof(record), .collect = collect,
                                             .arg = &c });
  if (status == PENDRES_OK) status = write_results(run, &c);
  if (status == PENDRES_OK) status = write_paper(run, &c);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &c);
done:
  free(c.points);
  free(c.outcome);
  scene_failures_free(&c.failed);
  return status;
}

const scene_kind scene_resonance_curve = {
  .kind = DECK_RESONANCE_CURVE,
  .references = "D. Kharkongor and M. C. Mahato, Resonance oscillation of a damped driven simple "
                "pendulum, Fig. 2; Ch. Tsitouras and S. N. Papakostas, SIAM J. Sci. Comput. 20 "
                "(1999) 2067",
  .plan = plan,
  .run = run_scene};
