/*
 * resonance_curve.c -- resonance frequency against amplitude, one point for each damping.
 *
 * The paper's Fig. 2 and its inset. A task has some neighbouring dampings, which are searched side
 * by side: pendres_resonance_find_many. With drive amplitudes, torques or parametric amplitudes in
 * &sweep there is one point for each of these instead, at one damping.
 */
#include <math.h>
#include <stdlib.h>

#include "scenes/check.h"
#include "scenes/failed.h"
#include "scenes/peak.h"

typedef struct curve {
  const deck *d;
  pendres_sweep sweep;
  pendres_ensemble ensemble;
  deck_axis_id axis;         /* damping or another parameter */
  size_t group;              /* points of a task */
  scene_peak *points;        /* one a value of the axis */
  int8_t *no_peak;           /* not 0: the point has none */
  scene_failures failed;
} curve;

static deck_axis_id axis_of(const deck *d)
{
  deck_axis_id axis = DECK_AXIS_DAMPING;
  (void)deck_extra_axis(d, &axis);
  return axis;
}

static void describe(const deck *d, FILE *out)
{
  const deck_axis *a = &d->axis[axis_of(d)];
  const int dampings = axis_of(d) == DECK_AXIS_DAMPING;
  fprintf(out,
          "resonances at %zu %s %g to %g, %s %g: the largest mean loop area of\n"
          "%lld members over drive frequencies %g to %g\n",
          a->count, scene_parameter_of(axis_of(d))->many, a->value[0], a->value[a->count - 1],
          dampings ? "drive amplitude" : "damping",
          dampings ? d->pendulum.drive_amplitude : d->axis[DECK_AXIS_DAMPING].value[0],
          (long long)d->ensemble.members, d->search[0], d->search[1]);
}

/*
 * How many points a task has: neighbours side by side take less time, but few tasks keep few
 * processors busy, and a search may take some hundred times as long as others. The number depends
 * on the deck alone, so that a journal fits whatever the threads are.
 */
static size_t group_of(size_t points)
{
  enum { MOST = 8, TASKS = 12 };
  const size_t group = points / TASKS;
  return group < 1 ? 1 : group < MOST ? group : MOST;
}

/* What a task finds of each of its points. */
typedef struct record {
  pendres_status outcome;
  pendres_resonance point;
  scene_verdict verdict;
} record;

static size_t points_of(const curve *c, size_t task)
{
  const size_t left = c->d->axis[c->axis].count - task * c->group;
  return left < c->group ? left : c->group;
}

static pendres_status judge(record *r, const pendres_resonance_search *s, farm_record *out)
{
  r->outcome = s->outcome;
  r->point = s->resonance;
  if (r->outcome == PENDRES_OK && !r->point.complete)
    scene_verdict_mark(&r->verdict, SCENE_FAILURE_BUDGET, NULL);
  /* A pendulum whose area has no peak in the range is a point without a result, not a failure. */
  return scene_verdict_point(&r->verdict, r->outcome, s->message, out);
}

/* Look for n resonances next to each other, the first of which has the number `first`. */
static pendres_status find(const curve *c, size_t first, size_t n, pendres_context *ctx,
                           pendres_resonance_search *s, farm_record *out)
{
  scene_point_begin(out, c->d, first, n, 1, &c->axis);
  for (size_t i = 0; i < n; i++) {
    s[i].pendulum = pendres_sweep_pendulum(&c->sweep, first + i, NULL, NULL);
    s[i].lowest = s[i].pendulum.drive_frequency = c->d->search[0];
    s[i].highest = c->d->search[1];
  }
  return pendres_resonance_find_many(ctx, n, s, &c->ensemble);
}

static pendres_status compute(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const curve *c = arg;
  record *r = out->data;
  const size_t first = task * c->group, n = points_of(c, task);
  pendres_resonance_search *s = calloc(n, sizeof *s);
  if (s == NULL) return PENDRES_OUT_OF_MEMORY;
  pendres_status status = find(c, first, n, ctx, s, out);
  const int over = farm_gave_up(out, status), alone = over && n > 1;
  if (over) status = PENDRES_OK;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    if (alone) status = find(c, first + i, 1, ctx, &s[i], out);
    if (status == PENDRES_OK || farm_gave_up(out, status)) status = judge(&r[i], &s[i], out);
  }
  free(s);
  return status;
}

static int check(const void *arg, size_t task, const farm_record *in)
{
  const curve *c = arg;
  const record *r = in->data;
  int good = in->size == c->group * sizeof *r;
  for (size_t i = 0; good && i < points_of(c, task); i++)
    good = scene_check_resonance(&r[i].point, r[i].outcome) && scene_check_verdict(&r[i].verdict);
  return good;
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  curve *c = arg;
  const record *r = in->data;
  for (size_t i = 0; i < points_of(c, task); i++) {
    const size_t point = task * c->group + i;
    c->points[point] = scene_peak_of(c->d->axis[c->axis].value[point], r[i].outcome, &r[i].point);
    c->no_peak[point] = r[i].outcome != PENDRES_OK;
    scene_failures_take(&c->failed, point, &r[i].verdict);
  }
  return PENDRES_OK;
}

/* ---- results ---- */

static const scene_column columns[] = {
  SCENE_COLUMN(scene_peak, resonance_frequency, "drive frequency of the largest mean loop area",
               "1"),
  SCENE_COLUMN(scene_peak, resonance_period, "drive period of the largest mean loop area", "1"),
  SCENE_COLUMN(scene_peak, mean_loop_area, "mean loop area of the ensemble at resonance", "1"),
  SCENE_COLUMN(scene_peak, mean_loop_amplitude, "amplitude of the ensemble-averaged loop", "rad"),
  SCENE_COLUMN(scene_peak, mean_amplitude, "mean of the members' amplitudes", "rad"),
  SCENE_COLUMN(scene_peak, phase_lag, "phase lag of the ensemble-averaged loop", "rad"),
  SCENE_COLUMN(scene_peak, mean_power, "mean power taken up from the drive", "1"),
  SCENE_COLUMN(scene_peak, sa_fraction, "share of the members on the small-amplitude state", "1"),
};

/* Of the plain pendulum. */
static const scene_column free_frequency[] = {
  SCENE_COLUMN(scene_peak, free_frequency,
               "frequency of the free undamped pendulum of that loop amplitude", "1"),
};

static const scene_column more_columns[] = {
  SCENE_COLUMN(scene_peak, fold_frequency, "drive frequency of the fold that makes the edge", "1"),
  SCENE_UNCERTAIN(scene_peak, uncertain),
  {.name = "peak", .long_name = "a smooth maximum, the largest value at a jump, or the largest "
                                "found where jumps have no end",
   .type = SCENE_FLAG, .value = offsetof(scene_peak, kind), .names = scene_peak_names},
};

static scene_table table_of(const curve *c)
{
  return (scene_table){.dimensions = {deck_axis_name(c->axis)}, .n = c->d->axis[c->axis].count,
                       .stride = sizeof *c->points, .rows = c->points, .missing = c->no_peak};
}

static void print_table(FILE *out, const curve *c)
{
  const scene_cell cells[] = {
    {.heading = scene_parameter_of(c->axis)->heading, .format = "%-9.4g ",
     .value = offsetof(scene_peak, at)},
    SCENE_CELL(scene_peak, resonance_frequency, "frequency     ", "%.10f  "),
    SCENE_CELL(scene_peak, resonance_frequency_error, "+-       ", "%.0e  "),
    SCENE_CELL(scene_peak, resonance_period, "period       ", "%.9f  "),
    SCENE_CELL(scene_peak, mean_loop_amplitude, "amplitude  ", "%.6f   "),
    SCENE_CELL(scene_peak, mean_loop_area, "area         ", "%.8f   "),
    {.heading = "peak", .format = "%s", .type = SCENE_FLAG, .value = offsetof(scene_peak, kind),
     .names = scene_peak_names},
  };
  const scene_table table = table_of(c);
  SCENE_PRINT(out, &table, 20, cells, scene_peak_instead);
}

static pendres_status write_results(scene_run *run, const curve *c)
{
  const scene_table table = table_of(c);
  pendres_status status = scene_dimension_short(run, c->axis);
  if (status == PENDRES_OK) status = SCENE_WRITE(run, &table, columns);
  if (status == PENDRES_OK && deck_is_plain(c->d))
    status = scene_columns_write(run, &table, 1, free_frequency);
  if (status == PENDRES_OK)
    status = SCENE_WRITE(run, &table, more_columns);
  return status == PENDRES_OK
           ? scene_failures_write(run, &c->failed, "failed", "resonance", 1, &c->axis)
           : status;
}

/* ---- the paper's figures ---- */

/* Printed dampings of the largest resonance frequency, and below which the curve breaks off. */
static const struct {
  double drive_amplitude, top, break_off;
} printed_turns[] = {{0.2, 0.38, 0.165}, {0.1, 0.28, 0.099}};

/* The damping of the largest resonance frequency, from the point of the smooth part of the curve
   that has it; *there: 0 if there is none. */
static pendres_status turning_point(scene_run *run, const curve *c, pendres_resonance_turn *turn,
                                    int *there)
{
  const deck_axis *axis = &c->d->axis[DECK_AXIS_DAMPING];
  size_t top = 0;
  *there = 0;
  for (size_t i = 1; i + 1 < axis->count; i++)
    if (!c->no_peak[i] && (top == 0 || c->points[i].resonance_frequency >
                                         c->points[top].resonance_frequency))
      top = i;
  if (top == 0 || c->points[top].kind != PENDRES_PEAK_SMOOTH) return PENDRES_OK;
  pendres_context *ctx = scene_context(run);
  if (ctx == NULL) return PENDRES_OUT_OF_MEMORY;
  const pendres_pendulum near = {.damping = axis->value[top],
                                 .drive_amplitude = c->d->pendulum.drive_amplitude};
  const pendres_status status = pendres_resonance_turn_find(
    ctx, &near, c->d->search[0], c->d->search[1], &c->ensemble, turn);
  *there = status == PENDRES_OK;
  return scene_failure_of(status) == SCENE_FAILURE_NONE ? scene_asked(run, status) : PENDRES_OK;
}

/* Middle of the gap in damping where the peak turns from an edge to smooth. */
static int break_off(const curve *c, double *damping, double *error)
{
  const deck_axis *axis = &c->d->axis[DECK_AXIS_DAMPING];
  for (size_t i = 0; i + 1 < axis->count; i++)
    if (c->points[i].kind == PENDRES_PEAK_EDGE && c->points[i + 1].kind == PENDRES_PEAK_SMOOTH) {
      *damping = 0.5 * (axis->value[i] + axis->value[i + 1]);
      *error = 0.5 * (axis->value[i + 1] - axis->value[i]);
      return 1;
    }
  return 0;
}

static pendres_status write_paper(scene_run *run, const curve *c)
{
  enum { MOST = SCENE_PRINTED_PERIODS + 2 };
  scene_printed values[MOST];
  size_t n = 0;
  const double f0 = c->d->pendulum.drive_amplitude;
  if (c->axis != DECK_AXIS_DAMPING || !deck_is_plain(c->d)) return PENDRES_OK;
  for (size_t k = 0; k < sizeof printed_turns / sizeof printed_turns[0]; k++) {
    double damping, error;
    if (fabs(f0 - printed_turns[k].drive_amplitude) > 1e-12) continue;
    int there = 0;
    pendres_resonance_turn turn;
    const pendres_status status = turning_point(run, c, &turn, &there);
    if (status != PENDRES_OK) return status;
    if (there)
      values[n++] = (scene_printed){"damping_of_largest_frequency", printed_turns[k].top,
                                    turn.damping, turn.damping_error};
    if (break_off(c, &damping, &error))
      values[n++] = (scene_printed){"damping_of_break", printed_turns[k].break_off, damping, error};
  }
  n += scene_peak_printed(c->d, c->d->axis[DECK_AXIS_DAMPING].count, c->points, values + n);
  return n > 0 ? scene_write_paper(run, n, values) : PENDRES_OK;
}

static pendres_status run_scene(scene_run *run)
{
  curve c = {.d = run->deck,
             .sweep = scene_sweep(run->deck),
             .ensemble = scene_ensemble(run->deck),
             .axis = axis_of(run->deck)};
  const scene_parameter *of = scene_parameter_of(c.axis);
  const size_t n = run->deck->axis[c.axis].count;
  c.group = group_of(n);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  c.points = calloc(n, sizeof *c.points);
  c.no_peak = calloc(n, 1);
  if (c.points == NULL || c.no_peak == NULL || scene_failures_create(n, &c.failed) != PENDRES_OK) {
    (void)scene_fail(run, status, "out of memory for %zu resonances", n);
    goto done;
  }
  status = scene_compute(run, &(farm_stage){ .what = c.group > 1 ? of->groups : of->many,
                                             .last = 1,
                                             .tasks = (n + c.group - 1) / c.group,
                                             .task = compute, .check = check, .collect = collect,
                                             .record_size = c.group * sizeof(record),
                                             .arg = &c });
  if (status == PENDRES_OK) status = write_results(run, &c);
  if (status == PENDRES_OK) status = write_paper(run, &c);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &c);
done:
  free(c.points);
  free(c.no_peak);
  scene_failures_free(&c.failed);
  return status;
}

const scene_kind scene_resonance_curve = {
  .kind = DECK_RESONANCE_CURVE,
  .references = "D. Kharkongor and M. C. Mahato, Resonance oscillation of a damped driven simple "
                "pendulum, Fig. 2; Ch. Tsitouras and S. N. Papakostas, SIAM J. Sci. Comput. 20 "
                "(1999) 2067",
  .budget = 1,
  .size = {32e3, 240.0, 2e3, 1.0, 1.0, 0.02},
  .describe = describe,
  .run = run_scene};
