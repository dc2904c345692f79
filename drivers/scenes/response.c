/*
 * response.c -- amplitude and phase lag of the mean loop along lines of pendulums.
 *
 * The paper's Figs. 3 and 4 have one line for each damping, along the drive period or frequency.
 * Each task computes some points of a line, or its resonance. There may be one line for each drive
 * amplitude, torque or parametric amplitude instead, or for each pair of such a parameter and a
 * damping, which makes a volume; or lines may go along one of these, and then have no resonance.
 * With temperatures in the deck the results have one more dimension: see response_noise.c.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/check.h"
#include "scenes/failed.h"
#include "scenes/peak.h"
#include "scenes/response_noise.h"

enum { CHUNK = 16 /* points a task */ };

typedef struct grid {
  scene_run *run;
  const deck *d;
  pendres_sweep sweep;
  pendres_ensemble ensemble;
  deck_axis_id axis[SCENE_AXES]; /* from line to line, and along them */
  int axes;
  size_t lines, values;       /* and points of a line */
  size_t chunks;              /* tasks a line */
  int peaked;                 /* whether lines have resonances: along the drive's frequency */
  scene_temporary points;         /* [line][value] of pendres_response, until its line has names */
  scene_temporary rows;           /* [line][value] of scene_response_row */
  scene_peak *peaks;          /* [line] */
  int8_t *no_peak;            /* [line] not 0: there is none */
  scene_failures failed;      /* [line][value] */
  scene_failures peak_failed; /* [line] */
} grid;

static void describe(const deck *d, FILE *out)
{
  deck_axis_id axis[SCENE_AXES];
  const int axes = scene_axes(d, axis);
  const deck_axis *along = &d->axis[axis[axes - 1]];
  fprintf(out, "mean response of %lld members at ", (long long)d->ensemble.members);
  for (int i = 0; i + 1 < axes; i++)
    fprintf(out, "%zu values of %s%s", d->axis[axis[i]].count, deck_axis_name(axis[i]),
            axes == 3 && i == 0 ? ", " : " and ");
  fprintf(out, "%zu values of %s, %g to %g", along->count, deck_axis_name(axis[axes - 1]),
          along->value[0], along->value[along->count - 1]);
  if (deck_searches(d))
    fprintf(out, ";\nand the resonance of each %s, looked for at frequencies %g to %g",
            axes == 3 ? "line" : deck_axis_name(axis[0]), d->search[0], d->search[1]);
  fprintf(out, "\n");
}

/* The axes of a sweep in the order of the results'; others, of one value each, after them. */
static void order_sweep(const deck *d, int axes, const deck_axis_id *axis, pendres_sweep *s)
{
  for (int k = axes - 1; k >= 0; k--)
    for (size_t i = 1; i < s->axes; i++) {
      const pendres_axis one = s->axis[i];
      if (one.value != d->axis[axis[k]].value) continue;
      memmove(&s->axis[1], &s->axis[0], i * sizeof one);
      s->axis[0] = one;
    }
}

static pendres_pendulum pendulum_at(const grid *g, size_t line, size_t k)
{
  return pendres_sweep_pendulum(&g->sweep, line * g->values + k, NULL, NULL);
}

/* What a task finds: a handful of points, or, of the tasks after these, a resonance. */
typedef struct point_record {
  pendres_response point[CHUNK];
  scene_verdict verdict[CHUNK];
} point_record;

typedef struct peak_record {
  pendres_status outcome;
  pendres_resonance peak;
  scene_verdict verdict;
} peak_record;

static pendres_status compute_peak(const grid *g, size_t i, pendres_context *ctx, farm_record *out)
{
  peak_record *r = out->data;
  enum { FREQUENCIES = 50 /* of a search, about */ };
  char words[120];
  pendres_pendulum p = pendulum_at(g, i, 0);
  p.drive_frequency = g->d->search[0];
  if (scene_failure_too_long(&p, FREQUENCIES, words, sizeof words)) {
    scene_verdict_mark(&r->verdict, SCENE_FAILURE_TOO_LONG, words);
    r->outcome = PENDRES_NOT_CONVERGED;
    return PENDRES_OK;
  }
  scene_point_name(g->d, i, g->axes - 1, g->axis, words, sizeof words);
  farm_point(out, 1, "resonance at %s", words);
  r->outcome = pendres_resonance_find_ensemble(ctx, &p, g->d->search[0], g->d->search[1],
                                               &g->ensemble, &r->peak);
  if (r->outcome == PENDRES_OK && !r->peak.complete)
    scene_verdict_mark(&r->verdict, SCENE_FAILURE_BUDGET, NULL);
  return scene_verdict_point(&r->verdict, r->outcome, pendres_context_message(ctx), out);
}

/* A point without a response: nothing is known of any member. */
static pendres_response no_response(const pendres_pendulum *p, size_t members)
{
  pendres_response r = { .pendulum = *p, .unresolved = members };
  pendres_response_average(&r);
  return r;
}

/* Compute n points from the first on, together or, where that fails, each alone. */
static pendres_status compute_points(const grid *g, size_t first, size_t n,
                                     const pendres_pendulum *pendulums, pendres_context *ctx,
                                     farm_record *out)
{
  point_record *r = out->data;
  pendres_status status = PENDRES_OK;
  char words[120];
  int too_long = 0;
  for (size_t i = 0; i < n; i++)
    too_long |= scene_failure_too_long(&pendulums[i], 1.0, words, sizeof words);
  if (!too_long) {
    scene_point_begin(out, g->d, first, n, g->axes, g->axis);
    status = pendres_response_compute(ctx, n, pendulums, &g->ensemble, r->point);
    if (scene_failure_of(status) == SCENE_FAILURE_NONE && !farm_gave_up(out, status))
      return status;
  }
  status = PENDRES_OK;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    if (scene_failure_too_long(&pendulums[i], 1.0, words, sizeof words)) {
      r->point[i] = no_response(&pendulums[i], g->ensemble.members);
      scene_verdict_mark(&r->verdict[i], SCENE_FAILURE_TOO_LONG, words);
      continue;
    }
    scene_point_begin(out, g->d, first + i, 1, g->axes, g->axis);
    status = pendres_response_compute(ctx, 1, &pendulums[i], &g->ensemble, &r->point[i]);
    if (status == PENDRES_OK) continue;
    r->point[i] = no_response(&pendulums[i], g->ensemble.members);
    status = scene_verdict_point(&r->verdict[i], status, pendres_context_message(ctx), out);
  }
  return status;
}

/* Mark a point that was computed, but not wholly. */
static void judge_point(const grid *g, const pendres_response *p, scene_verdict *verdict)
{
  if (verdict->reason != SCENE_FAILURE_NONE) return;
  char words[SCENE_TOLD];
  if (p->escaped > 0 && p->escaped == p->unresolved) {
    const int all = p->escaped == g->ensemble.members;
    snprintf(words, sizeof words, "%zu of %zu members escape to infinity%s", p->escaped,
             g->ensemble.members, all ? "" : ": means are those of the others");
    scene_verdict_mark(verdict, all ? SCENE_FAILURE_NO_MEAN : SCENE_FAILURE_UNRESOLVED, words);
  } else if (p->unresolved > 0) {
    scene_failure_unsettled(g->d, p->unresolved, g->ensemble.members, "members",
                            pendres_response_weakest_multiplier(p), words);
    scene_verdict_mark(verdict, SCENE_FAILURE_UNRESOLVED, words);
  } else if (isnan(p->mean_loop_area)) {
    scene_verdict_mark(verdict, SCENE_FAILURE_NO_MEAN, NULL);
  }
}

/* The points of a task: *n of them from the first on. */
static size_t first_of(const grid *g, size_t task, size_t *n)
{
  const size_t place = task % g->chunks * CHUNK;
  *n = g->values - place < CHUNK ? g->values - place : CHUNK;
  return task / g->chunks * g->values + place;
}

static pendres_status compute(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const grid *g = arg;
  pendres_pendulum pendulums[CHUNK] = { 0 };
  size_t n;
  if (task >= g->lines * g->chunks) {
    peak_record *peak = farm_record_resize(out, sizeof *peak);
    return peak == NULL ? PENDRES_OUT_OF_MEMORY
                        : compute_peak(g, task - g->lines * g->chunks, ctx, out);
  }
  point_record *r = farm_record_resize(out, sizeof *r);
  if (r == NULL) return PENDRES_OUT_OF_MEMORY;
  const size_t first = first_of(g, task, &n);
  for (size_t k = 0; k < n; k++)
    pendulums[k] = pendres_sweep_pendulum(&g->sweep, first + k, NULL, NULL);
  const pendres_status status = compute_points(g, first, n, pendulums, ctx, out);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++)
    judge_point(g, &r->point[k], &r->verdict[k]);
  return status;
}

/* The resonance of a line, whose parameters are the axes but the last. */
static scene_peak peak_of(const grid *g, size_t line, const peak_record *r)
{
  const deck_axis *last = &g->d->axis[g->axis[g->axes - 2]], *first = &g->d->axis[g->axis[0]];
  scene_peak p = scene_peak_of(last->value[line % last->count], r->outcome, &r->peak);
  p.beside = first->value[line / (g->lines / first->count)];
  return p;
}

static pendres_status keep_points(const grid *g, size_t first, size_t n,
                                  const pendres_response *points)
{
  char why[200];
  const pendres_status status = scene_temporary_put(&g->points, first, n, points, why, sizeof why);
  return status == PENDRES_OK ? status : scene_fail(g->run, status, "%s", why);
}

static int check(const void *arg, size_t task, const farm_record *in)
{
  const grid *g = arg;
  size_t n;
  if (task >= g->lines * g->chunks) {
    const peak_record *r = in->data;
    return in->size == sizeof *r && scene_check_resonance(&r->peak, r->outcome) &&
           scene_check_verdict(&r->verdict);
  }
  const point_record *r = in->data;
  int good = in->size == sizeof *r;
  (void)first_of(g, task, &n);
  for (size_t k = 0; good && k < n; k++)
    good = scene_check_response(&r->point[k]) && scene_check_verdict(&r->verdict[k]);
  return good;
}

static int check_names(const void *arg, size_t task, const farm_record *in)
{
  const grid *g = arg;
  const pendres_response *points = in->data;
  int good = in->size == g->values * sizeof *points;
  (void)task;
  for (size_t i = 0; good && i < g->values; i++) good = scene_check_response(&points[i]);
  return good;
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  grid *g = arg;
  size_t n;
  if (task >= g->lines * g->chunks) {
    const peak_record *r = in->data;
    const size_t i = task - g->lines * g->chunks;
    g->peaks[i] = peak_of(g, i, r);
    g->no_peak[i] = r->outcome != PENDRES_OK;
    scene_failures_take(&g->peak_failed, i, &r->verdict);
    return PENDRES_OK;
  }
  const point_record *r = in->data;
  const size_t first = first_of(g, task, &n);
  for (size_t k = 0; k < n; k++) scene_failures_take(&g->failed, first + k, &r->verdict[k]);
  return keep_points(g, first, n, r->point);
}

static scene_response_row row_of(const pendres_response *p)
{
#define PAIR(field) .field = p->field, .field##_error = p->field##_error
  return (scene_response_row){PAIR(mean_loop_area), PAIR(mean_loop_amplitude), PAIR(mean_amplitude),
                              PAIR(phase_lag), PAIR(mean_power), PAIR(sa_fraction),
                              PAIR(la_fraction), .uncertain = p->uncertain};
#undef PAIR
}

/* States that are alone at a point have their names from the others of its line: the record is the
   line's points anew. */
static pendres_status name_states(const void *arg, size_t task, pendres_context *ctx,
                                  farm_record *out)
{
  const grid *g = arg;
  const pendres_status status = scene_temporary_get(&g->points, task * g->values, g->values,
                                                    out->data,
                                                    out->message, sizeof out->message);
  return status == PENDRES_OK ? pendres_response_name(ctx, g->values, out->data) : status;
}

static pendres_status collect_names(void *arg, size_t task, const farm_record *in)
{
  const grid *g = arg;
  const pendres_response *points = in->data;
  const size_t first = task * g->values;
  char why[200];
  for (size_t i = 0; i < g->values; i++) {
    const scene_response_row row = row_of(&points[i]);
    const pendres_status status = scene_temporary_put(&g->rows, first + i, 1, &row, why,
                                                      sizeof why);
    if (status != PENDRES_OK) return scene_fail(g->run, status, "%s", why);
  }
  /* Noise begins from the whole of a point. */
  if (g->d->axis[DECK_AXIS_TEMPERATURE].count == 0) return PENDRES_OK;
  return keep_points(g, first, g->values, points);
}

static const scene_column columns[] = {
  SCENE_COLUMN(scene_response_row, mean_loop_area, "mean loop area of the ensemble", "1"),
  SCENE_COLUMN(scene_response_row, mean_loop_amplitude, "amplitude of the ensemble-averaged loop",
               "rad"),
  SCENE_COLUMN(scene_response_row, mean_amplitude, "mean of the members' amplitudes", "rad"),
  SCENE_COLUMN(scene_response_row, phase_lag, "phase lag of the ensemble-averaged loop", "rad"),
  SCENE_COLUMN(scene_response_row, mean_power, "mean power taken up from the drive", "1"),
  SCENE_COLUMN(scene_response_row, sa_fraction, "share of the members on the small-amplitude state",
               "1"),
  SCENE_COLUMN(scene_response_row, la_fraction, "share of the members on the large-amplitude state",
               "1"),
};

static const scene_column uncertain = SCENE_UNCERTAIN(scene_response_row, uncertain);

static pendres_status write_points(scene_run *run, const grid *g, size_t count,
                                   const scene_column *some)
{
  scene_table table = {.n = g->lines * g->values, .stride = sizeof(scene_response_row),
                       .spill = &g->rows, .first = g->d->axis[g->axis[0]].count};
  for (int i = 0; i < g->axes; i++) table.dimensions[i] = deck_axis_name(g->axis[i]);
  return scene_columns_write(run, &table, count, some);
}

/* ---- resonances ---------------------------------------------------------------------------- */

static const scene_column by_period =
  SCENE_COLUMN(scene_peak, resonance_period, "drive period of the largest mean loop area", "1");
static const scene_column by_frequency = SCENE_COLUMN(
  scene_peak, resonance_frequency, "drive frequency of the largest mean loop area", "1");

#define AT_RESONANCE(label, field, words, unit)                                               \
  {.name = "resonance_" #label, .long_name = words, .units = unit,                            \
   .value = offsetof(scene_peak, field), .error = offsetof(scene_peak, field##_error)}
static const scene_column of_peaks[] = {
  AT_RESONANCE(loop_area, mean_loop_area, "mean loop area at resonance", "1"),
  AT_RESONANCE(amplitude, mean_loop_amplitude,
               "amplitude of the ensemble-averaged loop at resonance", "rad"),
  AT_RESONANCE(phase_lag, phase_lag, "phase lag of the ensemble-averaged loop at resonance", "rad"),
};

static scene_table table_of_peaks(const grid *g)
{
  scene_table table = {.n = g->lines, .stride = sizeof *g->peaks, .rows = g->peaks,
                       .missing = g->no_peak};
  for (int i = 0; i + 1 < g->axes; i++) table.dimensions[i] = deck_axis_name(g->axis[i]);
  return table;
}

static pendres_status write_peaks(scene_run *run, const grid *g)
{
  const scene_table table = table_of_peaks(g);
  pendres_status status = scene_columns_write(run, &table, 1, &by_period);
  /* Where the deck has frequencies, the resonance frequency is written, too. */
  if (status == PENDRES_OK && g->axis[g->axes - 1] == DECK_AXIS_DRIVE_FREQUENCY)
    status = scene_columns_write(run, &table, 1, &by_frequency);
  return status == PENDRES_OK ? SCENE_WRITE(run, &table, of_peaks) : status;
}

static pendres_status write_failures(scene_run *run, const grid *g)
{
  const pendres_status status =
    scene_failures_write(run, &g->failed, "failed", "response", g->axes, g->axis);
  if (status != PENDRES_OK || !g->peaked) return status;
  return scene_failures_write(run, &g->peak_failed, "resonance_failed", "resonance", g->axes - 1,
                              g->axis);
}

static pendres_status write_results(scene_run *run, const grid *g)
{
  const scene_response_grid noisy = {
    .dampings = g->lines, .drives = g->values, .damping = deck_axis_name(g->axis[0]),
    .drive = deck_axis_name(g->axis[1]), .points = &g->points,
    .rows = &g->rows};
  pendres_status status = PENDRES_OK;
  for (int i = 0; i < g->axes && status == PENDRES_OK; i++)
    status = scene_dimension_short(run, g->axis[i]);
  if (status == PENDRES_OK)
    status = g->d->axis[DECK_AXIS_TEMPERATURE].count > 0
                 ? scene_response_write_noise(run, &noisy)
                 : write_points(run, g, sizeof columns / sizeof *columns, columns);
  if (status == PENDRES_OK) status = write_points(run, g, 1, &uncertain);
  if (status == PENDRES_OK && g->peaked) status = write_peaks(run, g);
  if (status == PENDRES_OK) status = write_failures(run, g);
  return scene_stored(run, status);
}

static pendres_status write_paper(scene_run *run, const grid *g)
{
  scene_printed values[SCENE_PRINTED_PERIODS];
  const size_t n = scene_peak_printed(g->d, g->lines, g->peaks, values);
  return g->peaked && n > 0 ? scene_write_paper(run, n, values) : PENDRES_OK;
}

static void print_table(FILE *out, const grid *g)
{
  enum { MOST_LINES = 40 };
  const int frequencies = g->axis[g->axes - 1] == DECK_AXIS_DRIVE_FREQUENCY;
  const int both = g->axes == 3;
  const scene_cell cells[] = {
    {.heading = scene_parameter_of(g->axis[0])->heading, .format = "%-9.4g ",
     .value = offsetof(scene_peak, beside)},
    {.heading = scene_parameter_of(g->axis[g->axes - 2])->heading, .format = "%-9.4g ",
     .value = offsetof(scene_peak, at)},
    {.heading = frequencies ? "resonant freq.   " : "resonant period  ", .format = "%.9f      ",
     .value = frequencies ? offsetof(scene_peak, resonance_frequency)
                          : offsetof(scene_peak, resonance_period)},
    SCENE_CELL(scene_peak, mean_loop_amplitude, "amplitude  ", "%.6f   "),
    SCENE_CELL(scene_peak, phase_lag, "phase lag  ", "%.6f   "),
    SCENE_CELL(scene_peak, mean_loop_area, "loop area", "%.8f"),
  };
  const scene_table table = table_of_peaks(g);
  if (g->peaked)
    scene_columns_print(out, &table, both ? MOST_LINES : g->lines,
                        sizeof cells / sizeof *cells - (both ? 0 : 1), both ? cells : cells + 1,
                        scene_peak_instead);
}

static pendres_status compute_all(scene_run *run, grid *g)
{
  const size_t peaks = g->peaked ? g->lines : 0;
  const farm_stage points = {.what = "chunks", .tasks = g->lines * g->chunks + peaks,
                             .task = compute, .check = check, .collect = collect, .arg = g};
  const farm_stage names = {.what = "lines", .tasks = g->lines, .cheap = 1, .task = name_states,
                            .record_size = g->values * sizeof(pendres_response),
                            .check = check_names, .collect = collect_names, .arg = g};
  pendres_status status = scene_temporary_create(run, g->lines * g->values,
                                                 sizeof(pendres_response),
                                                 SCENE_TEMPORARY_MEMORY, &g->points);
  if (status == PENDRES_OK)
    status = scene_temporary_create(run, g->lines * g->values, sizeof(scene_response_row),
                                    SCENE_TEMPORARY_MEMORY, &g->rows);
  if (status == PENDRES_OK) status = scene_compute(run, &points);
  return status == PENDRES_OK ? scene_compute(run, &names) : status;
}

static pendres_status run_scene(scene_run *run)
{
  const deck *d = run->deck;
  grid g = {.run = run, .d = d,
            .sweep = scene_sweep(d),
            .ensemble = scene_ensemble(d),
            .axis = {DECK_AXIS_DAMPING, DECK_AXIS_DRIVE_FREQUENCY}, .lines = 1};
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  g.axes = scene_axes(d, g.axis);
  order_sweep(d, g.axes, g.axis, &g.sweep);
  for (int i = 0; i + 1 < g.axes; i++) g.lines *= d->axis[g.axis[i]].count;
  g.values = d->axis[g.axis[g.axes - 1]].count;
  g.peaked = deck_searches(d);
  g.chunks = (g.values + CHUNK - 1) / CHUNK;
  g.peaks = calloc(g.lines, sizeof *g.peaks);
  g.no_peak = calloc(g.lines, 1);
  if (g.peaks == NULL || g.no_peak == NULL ||
      scene_failures_create(run, g.lines * g.values, &g.failed) != PENDRES_OK ||
      scene_failures_create(run, g.lines, &g.peak_failed) != PENDRES_OK) {
    (void)scene_fail(run, status, "out of memory for %zu points", g.lines * g.values);
    goto done;
  }
  status = compute_all(run, &g);
  if (status == PENDRES_OK) status = write_results(run, &g);
  if (status == PENDRES_OK) status = write_paper(run, &g);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &g);
done:
  scene_temporary_free(&g.points);
  scene_temporary_free(&g.rows);
  free(g.peaks);
  free(g.no_peak);
  return status;
}

const scene_kind scene_response = {
  .kind = DECK_RESPONSE,
  .references = "D. Kharkongor and M. C. Mahato, Resonance oscillation of a damped driven simple "
                "pendulum, Figs. 3 and 4; with temperature: S. A. Chin, Phys. Lett. A 226 (1997) "
                "344; H. A. Forbert and S. A. Chin, Phys. Rev. E 63 (2000) 016703",
  .budget = 1,
  .size = {50e3, 128.0, 300.0, 2.0, 1.0, 4e-4},
  .describe = describe,
  .run = run_scene};
