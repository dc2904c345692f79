/*
 * response.c -- amplitude and phase lag of the mean loop along lines of pendulums.
 *
 * The paper's Figs. 3 and 4 have one line for each damping, along the drive period or frequency.
 * Each task computes some points of a line, or its resonance. There may be one line for each drive
 * amplitude, torque or parametric amplitude instead, or for each pair of such a parameter and a
 * damping, which makes a volume; or lines may go along one of these, and then have no resonance.
 * With temperatures in the deck the results have one more dimension; there is a task for each of
 * their points then (pendres_response_noise_find).
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "results/columns.h"
#include "scenes/numbers.h"
#include "scenes/peak.h"
#include "scenes/points.h"

typedef struct grid {
  scene_run *run;
  const deck *d;
  pendres_sweep sweep;
  pendres_ensemble ensemble;
  deck_axis_id axis[DECK_AXES]; /* from line to line, and along them */
  int axes;
  size_t values;           /* points of a line */
  scene_points points;     /* [line][value] of pendres_response */
  scene_points peaks;      /* [line] of scene_peak; none where lines have no resonances */
} grid;

static void describe(const deck *d, FILE *out)
{
  deck_axis_id axis[DECK_AXES];
  const int axes = deck_axes(d, axis);
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

/* ---- points -------------------------------------------------------------------------------- */

static pendres_pendulum pendulum_at(const grid *g, size_t point)
{
  return pendres_sweep_pendulum(&g->sweep, point, NULL, NULL);
}

static int point_too_long(const scene_points *p, size_t point, char *words, size_t size)
{
  const grid *g = p->arg;
  const pendres_pendulum at = pendulum_at(g, point);
  return scene_settling_too_long(g->d, &at, 1.0, words, size);
}

/* Nothing is known of any member. */
static void no_response(const scene_points *p, size_t point, void *row)
{
  const grid *g = p->arg;
  pendres_response *r = row;
  *r = (pendres_response){ .pendulum = pendulum_at(g, point), .unresolved = g->ensemble.members };
  pendres_response_average(r);
}

/* Mark a point at which not all members have settled on what means are taken of. Those that escape
   are an answer, and are counted. */
static void judge(const scene_some *some, size_t i)
{
  const grid *g = some->of->arg;
  const pendres_response *p = (const pendres_response *)some->rows + i;
  char words[SCENE_TOLD];
  if (p->unresolved > 0) {
    scene_failure_unsettled(g->d, p->unresolved, g->ensemble.members, "members",
                            pendres_response_weakest_multiplier(p), words);
    scene_mark(some, i, SCENE_FAILURE_UNRESOLVED, words);
  } else if (isnan(p->mean_loop_area) && p->unstable + p->escaped < g->ensemble.members) {
    scene_mark(some, i, SCENE_FAILURE_NO_MEAN, NULL);
  }
}

static pendres_status compute(const scene_some *some)
{
  const grid *g = some->of->arg;
  pendres_pendulum pendulums[TASK_ATTRACTORS] = { 0 };
  for (size_t i = 0; i < some->n; i++) pendulums[i] = pendulum_at(g, some->first + i);
  const pendres_status status =
    pendres_response_find(some->ctx, some->n, pendulums, &g->ensemble, some->rows);
  for (size_t i = 0; i < some->n && status == PENDRES_OK; i++) judge(some, i);
  return status;
}

static int check(const scene_points *p, const void *row)
{
  (void)p;
  return scene_check_response(row);
}

/* ---- resonances ---------------------------------------------------------------------------- */

static int peak_too_long(const scene_points *p, size_t line, char *words, size_t size)
{
  enum { FREQUENCIES = 50 /* of a search, about */ };
  const grid *g = p->arg;
  pendres_pendulum at = pendulum_at(g, line * g->values);
  at.drive_frequency = g->d->search[0];
  return scene_settling_too_long(g->d, &at, FREQUENCIES, words, size);
}

/* The resonance of a line, whose parameters are the axes but the last. */
static void set_peak(const grid *g, size_t line, pendres_status outcome,
                     const pendres_resonance *r, scene_peak *p)
{
  const deck_axis *last = &g->d->axis[g->axis[g->axes - 2]], *first = &g->d->axis[g->axis[0]];
  scene_peak_set(p, last->value[line % last->count], outcome, r);
  p->beside = first->value[line / (g->peaks.n / first->count)];
}

static void no_peak(const scene_points *p, size_t line, void *row)
{
  set_peak(p->arg, line, PENDRES_NOT_CONVERGED, NULL, row);
}

static pendres_status find_peak(const scene_some *some)
{
  const grid *g = some->of->arg;
  const double *search = g->d->search;
  pendres_pendulum p = pendulum_at(g, some->first * g->values);
  pendres_resonance found;
  p.drive_frequency = search[0];
  const pendres_status status = pendres_resonance_find_ensemble(some->ctx, &p, search[0], search[1],
                                                                &g->ensemble, &found);
  if (status != PENDRES_OK && status != PENDRES_NOT_FOUND) return status;
  set_peak(g, some->first, status, &found, some->rows);
  if (status == PENDRES_OK && !found.complete) scene_mark(some, 0, SCENE_FAILURE_BUDGET, NULL);
  return scene_mark_status(some, 0, status, pendres_context_message(some->ctx));
}

/* ---- names --------------------------------------------------------------------------------- */

/* States that are alone at a point have their names from the others of its line, whose points these
   are. */
static pendres_status name_states(const scene_some *some)
{
  const grid *g = some->of->arg;
  const pendres_response *points = g->points.rows;
  memcpy(some->rows, points + some->first, some->n * sizeof *points);
  return pendres_response_label(some->ctx, some->n, some->rows);
}

/* ---- noise --------------------------------------------------------------------------------- */

typedef struct noisy {
  const grid *still;
  size_t plane;        /* points at each temperature: those of the grid */
  scene_points points; /* [temperature][line][value] of pendres_response_noise */
} noisy;

static pendres_status add_noise(const scene_some *some)
{
  const noisy *w = some->of->arg;
  const deck *d = w->still->d;
  const double temperature = d->axis[DECK_AXIS_TEMPERATURE].value[some->first / w->plane];
  const pendres_response *still = w->still->points.rows;
  return pendres_response_noise_find(some->ctx, &still[some->first % w->plane], temperature,
                                     (size_t)d->noise.trajectories, (long)d->noise.periods,
                                     some->rows);
}

/* A mean, and what finite steps add to it. */
#define NOISY(label, bias_label, field, words)                                                \
  {SCENE_ESTIMATE(label, pendres_response_noise, field, words, NULL)},                         \
  {SCENE_AS(bias_label, pendres_response_noise, field.bias, "bias by finite steps: " words, label)}

static const scene_column of_noise[] = {
  NOISY("mean_loop_area", "bias_loop_area", loop_area, "mean loop area of the ensemble"),
  NOISY("first_harmonic_amplitude", "bias_first_harmonic_amplitude", amplitude,
        "amplitude of the mean loop's first harmonic"),
  NOISY("phase_lag", "bias_phase_lag", phase_lag, "phase lag of the ensemble-averaged loop"),
  NOISY("mean_power", "bias_mean_power", mean_power, "mean power taken up from the drive"),
};

static const scene_column steps[] = {
  {SCENE_TYPED(SCENE_NUMBER, "noise_steps_per_period", pendres_response_noise, steps_per_period,
               "steps a drive period of the noisy integrator")},
};

/* The columns of results that exist only without noise. */
static const scene_column of_still[] = {
  SCENE_COLUMN(pendres_response, mean_loop_amplitude, NULL),
  SCENE_COLUMN(pendres_response, mean_amplitude, NULL),
  SCENE_COLUMN(pendres_response, sa_fraction, NULL),
  SCENE_COLUMN(pendres_response, la_fraction, NULL),
};

static void write_still(scene_run *run, const noisy *w, const scene_table *table)
{
  const double *temperature = w->still->d->axis[DECK_AXIS_TEMPERATURE].value;
  const pendres_response *still = w->still->points.rows;
  pendres_response *rows = scene_large(run, table->n, sizeof *rows);
  for (size_t i = 0; rows != NULL && i < table->n; i++) {
    rows[i] = still[i % w->plane];
    if (temperature[i / w->plane] > 0.0) SCENE_BLANK(of_still, &rows[i]);
  }
  scene_table without = *table;
  without.stride = sizeof *rows;
  without.rows = rows;
  SCENE_WRITE(run, &without, of_still);
}

static void write_noisy(scene_run *run, const noisy *w)
{
  const scene_table table = scene_points_table(&w->points, w->still->d);
  scene_dimension(run, "", DECK_AXIS_TEMPERATURE);
  scene_points_write(run, &w->points);
  write_still(run, w, &table);
  SCENE_WRITE(run, &table, steps);
  scene_points_write_failed(run, &w->points, "noise_failed",
                            "why there is no whole result for the response with noise");
}

/* Along the temperatures, at the first damping and the middle of the drive axis. */
static void print_noisy(FILE *out, const noisy *w)
{
  const size_t drives = w->still->d->axis[w->points.axis[2]].count, at = drives / 2;
  const pendres_response_noise *points = w->points.rows;
  const pendres_pendulum *still = &((const pendres_response *)w->still->points.rows)[at].pendulum;
  fprintf(out, "damping %g, drive period %g:\n", still->damping,
          2.0 * PENDRES_PI / still->drive_frequency);
  fprintf(out, "temperature  loop area     +-        phase lag   +-        amplitude   +-\n");
  for (size_t i = at; i < w->points.n; i += w->plane) {
    const pendres_response_noise *q = &points[i];
    fprintf(out, "%-12g %-13.8f %-9.2g %-11.7f %-9.2g %-11.7f %.2g\n",
            w->still->d->axis[DECK_AXIS_TEMPERATURE].value[i / w->plane], q->loop_area.value,
            q->loop_area.error, q->phase_lag.value, q->phase_lag.error, q->amplitude.value,
            q->amplitude.error);
  }
}

/* The response at the deck's temperatures, with a dimension of them before those of the grid; at
   temperature 0 it is what the grid holds. */
static void write_noise(const grid *g)
{
  noisy w = {.still = g, .plane = g->points.n,
             .points = {.size = sizeof(pendres_response_noise), .chunk = 1, .compute = add_noise,
                        SCENE_COLUMNS(of_noise), .what = "response with noise", .arg = &w}};
  deck_axis_id axis[DECK_AXES + 1] = {DECK_AXIS_TEMPERATURE};
  for (int i = 0; i < g->axes; i++) axis[1 + i] = g->axis[i];
  scene_points_over(&w.points, g->d, 1 + g->axes, axis);
  SCENE_COMPUTE(g->run, &w.points, "points with noise", .last = 1);
  write_noisy(g->run, &w);
  if (scene_prints(g->run)) print_noisy(g->run->table, &w);
}

/* ---- results ------------------------------------------------------------------------------- */

static const scene_column columns[] = {
  SCENE_COLUMN(pendres_response, mean_loop_area, NULL),
  SCENE_COLUMN(pendres_response, mean_loop_amplitude, NULL),
  SCENE_COLUMN(pendres_response, mean_amplitude, NULL),
  SCENE_COLUMN(pendres_response, phase_lag, "phase lag of the ensemble-averaged loop"),
  SCENE_COLUMN(pendres_response, mean_power, "mean power taken up from the drive"),
  SCENE_COLUMN(pendres_response, sa_fraction, NULL),
  SCENE_COLUMN(pendres_response, la_fraction, NULL),
};

static const scene_column doubts[] = {SCENE_UNCERTAIN(pendres_response, uncertain),
                                      SCENE_ESCAPED(pendres_response, escaped)};

static void write_points(const grid *g, size_t count, const scene_column *some)
{
  const scene_table table = scene_points_table(&g->points, g->d);
  scene_columns_write(g->run, &table, count, some);
}

/* Where the deck has frequencies, the resonance frequency is written, too. */
static int by_frequency(const deck *d)
{
  deck_axis_id axis[DECK_AXES];
  return axis[deck_axes(d, axis) - 1] == DECK_AXIS_DRIVE_FREQUENCY;
}

static const scene_column of_peaks[] = {
  SCENE_COLUMN(scene_peak, resonance_period, NULL),
  {SCENE_AS("resonance_frequency", scene_peak, resonance_frequency, NULL, NULL),
   .when = by_frequency},
  {SCENE_AS("resonance_loop_area", scene_peak, mean_loop_area, "mean loop area at resonance",
            "mean_loop_area")},
  {SCENE_AS("resonance_amplitude", scene_peak, mean_loop_amplitude,
            "amplitude of the ensemble-averaged loop at resonance", "mean_loop_amplitude")},
  {SCENE_AS("resonance_phase_lag", scene_peak, phase_lag,
            "phase lag of the ensemble-averaged loop at resonance", "phase_lag")},
};

static void write_results(const grid *g)
{
  scene_run *run = g->run;
  scene_printed values[SCENE_PRINTED_PERIODS];
  for (int i = 0; i < g->axes; i++) scene_dimension_short(run, g->axis[i]);
  if (g->d->axis[DECK_AXIS_TEMPERATURE].count > 0)
    write_noise(g);
  else
    write_points(g, sizeof columns / sizeof *columns, columns);
  write_points(g, sizeof doubts / sizeof *doubts, doubts);
  if (g->peaks.n > 0) scene_points_write(run, &g->peaks);
  scene_points_write_failed(run, &g->points, "failed",
                            "why there is no whole result for the response");
  if (g->peaks.n == 0) return;
  scene_points_write_failed(run, &g->peaks, "resonance_failed",
                            "why there is no whole result for the resonance");
  if (scene_going(run))
    scene_write_paper(run, scene_peak_printed(g->d, g->peaks.n, g->peaks.rows, values), values);
}

static void print_table(FILE *out, const grid *g)
{
  const int frequencies = by_frequency(g->d), both = g->axes == 3;
  const scene_heading beside = scene_heading_of(g->axis[0]);
  const scene_heading at = scene_heading_of(g->axis[g->axes - 2]);
  const scene_cell cells[] = {
    {.heading = beside.words, .format = beside.format, .value = offsetof(scene_peak, beside)},
    {.heading = at.words, .format = at.format, .value = offsetof(scene_peak, at)},
    {.heading = frequencies ? "resonant freq.   " : "resonant period  ", .format = "%.9f      ",
     .value = frequencies ? offsetof(scene_peak, resonance_frequency)
                          : offsetof(scene_peak, resonance_period)},
    SCENE_CELL(scene_peak, mean_loop_amplitude, "amplitude  ", "%.6f   "),
    SCENE_CELL(scene_peak, phase_lag, "phase lag  ", "%.6f   "),
    SCENE_CELL(scene_peak, mean_loop_area, "loop area", "%.8f"),
  };
  const scene_table table = scene_points_table(&g->peaks, g->d);
  if (table.n > 0)
    scene_columns_print(out, &table, both ? SCENE_TABLE_LINES : table.n,
                        sizeof cells / sizeof *cells - (both ? 0 : 1), both ? cells : cells + 1,
                        scene_peak_instead);
}

/* All points and resonances in one stage; then names along each line. */
static void compute_all(scene_run *run, grid *g)
{
  scene_points names = {.n = g->points.n, .chunk = g->values, .size = sizeof(pendres_response),
                        .compute = name_states, .check = check, .unmarked = 1, .arg = g};
  g->points.rows = names.rows = scene_large(run, g->points.n, sizeof(pendres_response));
  scene_points_compute(run, &(farm_stage){.what = "chunks"}, g->peaks.n > 0 ? 2 : 1,
                       (scene_points *[]){&g->points, &g->peaks});
  SCENE_COMPUTE(run, &names, "lines", .cheap = 1);
}

static pendres_status run_scene(scene_run *run)
{
  const deck *d = run->deck;
  grid g = {.run = run, .d = d,
            .sweep = scene_sweep(d),
            .ensemble = scene_ensemble(d),
            .points = {.size = sizeof(pendres_response), .chunk = TASK_ATTRACTORS,
                       .compute = compute, .too_long = point_too_long,
                       .leave_out = no_response, .check = check,
                       .what = "response", .arg = &g},
            .peaks = {.size = sizeof(scene_peak), .chunk = 1, .compute = find_peak,
                      .too_long = peak_too_long, .leave_out = no_peak, SCENE_COLUMNS(of_peaks),
                      .what = "resonance", .arg = &g}};
  g.axes = deck_axes(d, g.axis);
  scene_points_over(&g.points, d, g.axes, g.axis);
  if (deck_searches(d)) scene_points_over(&g.peaks, d, g.axes - 1, g.axis);
  g.values = d->axis[g.axis[g.axes - 1]].count;
  compute_all(run, &g);
  write_results(&g);
  if (scene_prints(run)) print_table(run->table, &g);
  return run->status;
}

/* The records of all points are in memory as long as these are few (scene_large()). */
static scene_more more(const deck *d, const farm_trial *trial, double points)
{
  (void)d;
  (void)trial;
  return (scene_more){.memory = fmin(7e3 * points, (double)SCENE_MEMORY)};
}

const scene_kind scene_response = {
  .kind = DECK_RESPONSE,
  .figures = "Figs. 3 and 4",
  .references = "; with temperature: S. A. Chin, Phys. Lett. A 226 (1997) 344; H. A. Forbert "
                "and S. A. Chin, Phys. Rev. E 63 (2000) 016703",
  .budget = 1,
  .size = {.head = 50e3, .point = 128.0, .memory = 300.0, .stages = 2.0, .after = 1.0,
           .seconds = 4e-4, .more = more},
  .describe = describe,
  .run = run_scene};
