/*
 * resonance_curve.c -- resonance frequency against amplitude, one point for each damping.
 *
 * The paper's Fig. 2 and its inset. A task has some neighbouring dampings, which are searched side
 * by side: pendres_resonance_find_many. With drive amplitudes, torques or parametric amplitudes in
 * &sweep there is one point for each of these instead, at one damping.
 */
#include <math.h>

#include "scenes/numbers.h"
#include "scenes/peak.h"
#include "scenes/points.h"

typedef struct curve {
  const deck *d;
  pendres_sweep sweep;
  pendres_ensemble ensemble;
  deck_axis_id axis;    /* damping or another parameter */
  scene_points points;  /* of scene_peak, one a value of the axis */
} curve;

static void describe(const deck *d, FILE *out)
{
  deck_axis_id axis[DECK_AXES];
  (void)deck_axes(d, axis);
  const deck_axis *a = &d->axis[axis[0]];
  const deck_axis_id held =
    axis[0] == DECK_AXIS_DAMPING ? DECK_AXIS_DRIVE_AMPLITUDE : DECK_AXIS_DAMPING;
  fprintf(out,
          "resonances at %zu values of %s, %g to %g, %s %g: the largest mean loop area of\n"
          "%lld members over drive frequencies %g to %g\n",
          a->count, deck_axis_name(axis[0]), a->value[0], a->value[a->count - 1],
          deck_axis_name(held), scene_fixed(d, held), (long long)d->ensemble.members, d->search[0],
          d->search[1]);
}

/*
 * How many points a task has: neighbours side by side take less time, but few tasks keep few
 * processors busy, and a search may take some hundred times as long as others. The number depends
 * on the deck alone, so that a journal fits whatever the threads are.
 */
static size_t group_of(size_t points)
{
  const size_t group = points / RESONANCE_TASKS;
  return group < 1 ? 1 : group < TASK_RESONANCES ? group : TASK_RESONANCES;
}

/* What a search has found. A pendulum whose area has no peak in the range is a point without a
   result. */
static pendres_status judge(const scene_some *some, size_t i, const pendres_resonance_search *s)
{
  const curve *c = some->of->arg;
  scene_peak *peak = some->rows;
  scene_peak_set(&peak[i], c->d->axis[c->axis].value[some->first + i], s->outcome, &s->resonance);
  if (s->outcome == PENDRES_OK && !s->resonance.complete)
    scene_mark(some, i, SCENE_FAILURE_BUDGET, NULL);
  return scene_mark_status(some, i, s->outcome, s->message);
}

/* Resonances next to each other. */
static pendres_status compute(const scene_some *some)
{
  const curve *c = some->of->arg;
  pendres_resonance_search *s = scene_room_take(some->room, some->n, sizeof *s);
  if (s == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < some->n; i++) {
    s[i].pendulum = pendres_sweep_pendulum(&c->sweep, some->first + i, NULL, NULL);
    s[i].lowest = s[i].pendulum.drive_frequency = c->d->search[0];
    s[i].highest = c->d->search[1];
  }
  pendres_status status = pendres_resonance_find_many(some->ctx, some->n, s, &c->ensemble);
  for (size_t i = 0; i < some->n && status == PENDRES_OK; i++) status = judge(some, i, &s[i]);
  return status;
}

static void leave_out(const scene_points *p, size_t point, void *row)
{
  const curve *c = p->arg;
  scene_peak_set(row, c->d->axis[c->axis].value[point], PENDRES_INTERRUPTED, NULL);
}

/* ---- results ---- */

static const scene_column columns[] = {
  SCENE_COLUMN(scene_peak, resonance_frequency, NULL),
  SCENE_COLUMN(scene_peak, resonance_period, NULL),
  SCENE_COLUMN(scene_peak, mean_loop_area, "mean loop area of the ensemble at resonance"),
  SCENE_COLUMN(scene_peak, mean_loop_amplitude, NULL),
  SCENE_COLUMN(scene_peak, mean_amplitude, NULL),
  SCENE_COLUMN(scene_peak, phase_lag, "phase lag of the ensemble-averaged loop"),
  SCENE_COLUMN(scene_peak, mean_power, "mean power taken up from the drive"),
  SCENE_COLUMN(scene_peak, sa_fraction, NULL),
  {SCENE_AS("free_frequency", scene_peak, free_frequency,
            "frequency of the free undamped pendulum of that loop amplitude", NULL),
   .when = deck_is_plain},
  {SCENE_AS("fold_frequency", scene_peak, fold_frequency,
            "drive frequency of the fold that makes the edge", "frequency")},
  SCENE_UNCERTAIN(scene_peak, uncertain),
  {SCENE_TYPED(SCENE_FLAG, "peak", scene_peak, kind, "a smooth maximum, the largest value at a "
               "jump, or the largest found where jumps have no end"), .names = scene_peak_names},
};

static void print_table(FILE *out, const curve *c)
{
  const scene_heading at = scene_heading_of(c->axis);
  const scene_cell cells[] = {
    {.heading = at.words, .format = at.format, .value = offsetof(scene_peak, at)},
    SCENE_CELL(scene_peak, resonance_frequency, "frequency     ", "%.10f  "),
    SCENE_CELL(scene_peak, resonance_frequency_error, "+-       ", "%.0e  "),
    SCENE_CELL(scene_peak, resonance_period, "period       ", "%.9f  "),
    SCENE_CELL(scene_peak, mean_loop_amplitude, "amplitude  ", "%.6f   "),
    SCENE_CELL(scene_peak, mean_loop_area, "area         ", "%.8f   "),
    {.heading = "peak", .format = "%s", .type = SCENE_FLAG, .value = offsetof(scene_peak, kind),
     .names = scene_peak_names},
  };
  const scene_table table = scene_points_table(&c->points, c->d);
  SCENE_PRINT(out, &table, 20, cells, scene_peak_instead);
}

/* ---- the paper's figures ---- */

/* Printed dampings of the largest resonance frequency, and below which the curve breaks off. */
static const struct {
  double drive_amplitude, top, break_off;
} printed_turns[] = {{0.2, 0.38, 0.165}, {0.1, 0.28, 0.099}};

/* The damping of the largest resonance frequency, from the point of the smooth part of the curve
   that has it; 0 if there is none. */
static int turning_point(scene_run *run, const curve *c, pendres_resonance_turn *turn)
{
  const double *damping = c->d->axis[DECK_AXIS_DAMPING].value;
  const scene_peak *points = c->points.rows;
  size_t top = 0;
  for (size_t i = 1; i + 1 < c->points.n; i++)
    if (points[i].outcome == PENDRES_OK &&
        (top == 0 || points[i].resonance_frequency > points[top].resonance_frequency))
      top = i;
  if (top == 0 || points[top].kind != PENDRES_PEAK_SMOOTH) return 0;
  pendres_context *ctx = scene_context(run);
  if (ctx == NULL) return 0;
  const pendres_pendulum near = {.damping = damping[top],
                                 .drive_amplitude = c->d->pendulum.drive_amplitude};
  const pendres_status status = pendres_resonance_turn_find(
    ctx, &near, c->d->search[0], c->d->search[1], &c->ensemble, turn);
  if (scene_failure_of(status) == SCENE_FAILURE_NONE) scene_asked(run, status);
  return status == PENDRES_OK;
}

/* Middle of the gap in damping where the peak turns from an edge to smooth. */
static int break_off(const curve *c, double *damping, double *error)
{
  const deck_axis *axis = &c->d->axis[DECK_AXIS_DAMPING];
  const scene_peak *points = c->points.rows;
  for (size_t i = 0; i + 1 < axis->count; i++)
    if (points[i].kind == PENDRES_PEAK_EDGE && points[i + 1].kind == PENDRES_PEAK_SMOOTH) {
      *damping = 0.5 * (axis->value[i] + axis->value[i + 1]);
      *error = 0.5 * (axis->value[i + 1] - axis->value[i]);
      return 1;
    }
  return 0;
}

static void write_paper(scene_run *run, const curve *c)
{
  enum { MOST = SCENE_PRINTED_PERIODS + 2 };
  scene_printed values[MOST];
  size_t n = 0;
  const double f0 = c->d->pendulum.drive_amplitude;
  if (!scene_going(run) || c->axis != DECK_AXIS_DAMPING || !deck_is_plain(c->d)) return;
  for (size_t k = 0; k < sizeof printed_turns / sizeof printed_turns[0]; k++) {
    double damping, error;
    pendres_resonance_turn turn;
    if (fabs(f0 - printed_turns[k].drive_amplitude) > 1e-12) continue;
    if (turning_point(run, c, &turn))
      values[n++] = (scene_printed){.name = "damping_of_largest_frequency",
                                    .printed = printed_turns[k].top, .computed = turn.damping,
                                    .error = turn.damping_error};
    if (break_off(c, &damping, &error))
      values[n++] = (scene_printed){.name = "damping_of_break",
                                    .printed = printed_turns[k].break_off, .computed = damping,
                                    .error = error};
  }
  n += scene_peak_printed(c->d, c->points.n, c->points.rows, values + n);
  scene_write_paper(run, n, values);
}

static pendres_status run_scene(scene_run *run)
{
  deck_axis_id axis[DECK_AXES];
  (void)deck_axes(run->deck, axis);
  curve c = {.d = run->deck,
             .sweep = scene_sweep(run->deck),
             .ensemble = scene_ensemble(run->deck),
             .axis = axis[0],
             .points = {.size = sizeof(scene_peak), .compute = compute, .leave_out = leave_out,
                        SCENE_COLUMNS(columns), .what = "resonance", .arg = &c}};
  scene_points *p = &c.points;
  scene_points_over(p, run->deck, 1, &c.axis);
  p->chunk = group_of(p->n);
  SCENE_COMPUTE(run, p, p->chunk > 1 ? "groups of resonances" : "resonances", .last = 1);
  scene_dimension_short(run, c.axis);
  scene_points_write(run, p);
  scene_points_write_failed(run, p, "failed", "why there is no whole result for the resonance");
  write_paper(run, &c);
  if (scene_prints(run)) print_table(run->table, &c);
  return run->status;
}

const scene_kind scene_resonance_curve = {
  .kind = DECK_RESONANCE_CURVE,
  .figures = "Fig. 2",
  .references = "; Ch. Tsitouras and S. N. Papakostas, SIAM J. Sci. Comput. 20 (1999) 2067",
  .budget = 1,
  .size = {.head = 32e3, .point = 240.0, .memory = 2e3, .stages = 1.0, .after = 1.0, .members = 1,
           .seconds = 0.02, .searched = 20.0},
  .describe = describe,
  .run = run_scene};
