/*
 * hysteresis.c -- one parameter swept slowly, up and then down, from a stated state: what an
 * experimenter sees. One task: each value is approached from the one before.
 */
#include "scenes/along.h"

#include <math.h>

/* Up and down again; points of the way back are put in the order of the axis, too. */
static void compute(scene_run *run, deck_axis_id axis, scene_along_path *path)
{
  const deck_axis *a = &run->deck->axis[axis];
  const size_t n = SCENE_DIRECTIONS * a->count;
  double *value = scene_array(run, n, sizeof *value);
  for (size_t i = 0; value != NULL && i < a->count; i++) value[i] = value[n - 1 - i] = a->value[i];
  scene_along_compute(run, &(scene_along_way){axis, n, value, 0}, path, 0, NULL);
  pendres_hysteresis_point *back = path->point + a->count;
  for (size_t i = 0; scene_going(run) && i < a->count / 2; i++) {
    const pendres_hysteresis_point kept = back[i];
    back[i] = back[a->count - 1 - i];
    back[a->count - 1 - i] = kept;
  }
}

/* ---- results ------------------------------------------------------------------------------- */

static const scene_column of_points[] = {
  {SCENE_AS("mean_velocity", scene_along_row, of.mean_velocity, NULL, NULL)},
  SCENE_COLUMN(scene_along_row, period, NULL),
  SCENE_COLUMN(scene_along_row, winding, NULL),
  {SCENE_AS("lyapunov", scene_along_row, of.attractor.lyapunov, NULL, NULL)},
};

static const char *const directions[SCENE_DIRECTIONS] = {"up", "down"};

static const char *direction_names(int value)
{
  return value < SCENE_DIRECTIONS ? directions[value] : NULL;
}

SCENE_NAMES(gradual_names, "jump", "gradual")
SCENE_NAMES(certain_names, "uncertain", "certain")

static const scene_column of_jumps[] = {
  SCENE_COLUMN(scene_along_jump, parameter, "value at which the state ends"),
  SCENE_COLUMN(scene_along_jump, period, "drive periods of the orbit jumped to"),
  {SCENE_AS("winding", scene_along_jump, winding, "whole turns of the orbit jumped to", NULL),
   .when = scene_along_turns},
  {SCENE_AS("mean_velocity", scene_along_jump, mean_velocity,
            "mean velocity of x on the orbit jumped to", NULL), .when = scene_along_turns},
  SCENE_COLUMN(scene_along_jump, share, "share of the trials that went to that state"),
  SCENE_CODE(scene_along_jump, direction, "way in which the parameter goes", direction_names),
  SCENE_CODE(scene_along_jump, kind, "bifurcation that ends the state", scene_jump_names),
  SCENE_CODE(scene_along_jump, from, "state that ends", scene_motion_names),
  SCENE_CODE(scene_along_jump, to, "state that the pendulum goes to", scene_motion_names),
  SCENE_CODE(scene_along_jump, gradual, "whether the new state grows out of the old one",
             gradual_names),
  SCENE_CODE(scene_along_jump, certain, "whether all trials went to the same state",
             certain_names),
};

/* A step as a row of results. */
typedef struct step_row {
  pendres_step of;
  double mean_velocity, mean_velocity_error;
} step_row;

static const char *step_end_names(int value)
{
  return pendres_name_get(PENDRES_NAMES_STEP_END, value);
}

static const scene_column of_steps[] = {
  {SCENE_TYPED(SCENE_NUMBER, "winding", step_row, of.winding,
               "whole turns in step_period drive periods")},
  {SCENE_TYPED(SCENE_NUMBER, "period", step_row, of.period,
               "drive periods of step_winding turns, without a common factor")},
  {SCENE_AS("mean_velocity", step_row, mean_velocity, "mean velocity of x on the step", NULL)},
  {SCENE_AS("lower", step_row, of.lower, "least value at which the step was met", "parameter")},
  {SCENE_AS("upper", step_row, of.upper, "largest value at which the step was met", "parameter")},
  {SCENE_AS("width", step_row, of.width, "width of the step", "parameter"),
   .comment = "NaN: one of the ends is none of the step (see step_lower_end, step_upper_end)"},
  {SCENE_TYPED(SCENE_FLAG, "lower_end", step_row, of.lower_end,
               "what is known of the step's lower end"), .names = step_end_names},
  {SCENE_TYPED(SCENE_FLAG, "upper_end", step_row, of.upper_end,
               "what is known of the step's upper end"), .names = step_end_names},
};

/* Steps are asked for where a torque drives a coordinate around. */
static int has_steps(const deck *d, const scene_along_path *path)
{
  return path->axis == DECK_AXIS_TORQUE && scene_along_turns(d);
}

static void write_steps(scene_run *run, const scene_along_path *path)
{
  step_row *rows = scene_array(run, path->steps, sizeof *rows);
  for (size_t i = 0; rows != NULL && i < path->steps; i++) {
    const pendres_step *s = &path->step[i];
    const double v =
      scene_along_velocity(run->deck, path->axis, s->lower, s->winding, s->period);
    rows[i] = (step_row){*s, v, scene_along_velocity_error(path->axis, v, s->lower, 0.0)};
  }
  const scene_table table = {.dimensions = {"step"}, .prefix = "step",
                             SCENE_ROWS(rows, path->steps)};
  scene_numbering(run, "step", table.n, "number of the step, by mean velocity");
  SCENE_WRITE(run, &table, of_steps);
}

static void write(scene_run *run, deck_axis_id axis, const scene_along_path *path)
{
  const scene_along_row *rows = scene_along_rows(run, path);
  const scene_table table = {.dimensions = {"direction", deck_axis_name(axis)},
                             SCENE_ROWS(rows, path->points)};
  const pendres_store_spec ways = {.name = "direction", .type = PENDRES_STORE_STRING,
                                   .long_name = "way in which the parameter goes"};
  scene_put_dimension(run, &ways, directions, SCENE_DIRECTIONS);
  scene_dimension(run, NULL, axis);
  scene_columns_write_orbits(run, &table, offsetof(scene_along_row, of.attractor.orbit));
  SCENE_WRITE(run, &table, of_points);
  scene_along_write_verdicts(run, path, &table);
  scene_along_tell(run, axis, path, SCENE_DIRECTIONS);
  SCENE_ALONG_WRITE_JUMPS(run, path, "jump", of_jumps);
  if (has_steps(run->deck, path)) write_steps(run, path);
}

/* ---- the scene ----------------------------------------------------------------------------- */

/* An end of a step in a cell: the value with its error, or why it is none of the step. */
static void print_end(FILE *out, pendres_step_end end, double value, double error)
{
  char cell[60];
  if (end == PENDRES_STEP_END_LEFT) snprintf(cell, sizeof cell, "%.12g +- %.0e", value, error);
  else snprintf(cell, sizeof cell, "%.6g (%s)", value, step_end_names((int)end));
  fprintf(out, "  %-24s", cell);
}

/* How many steps were met over a wider interval. */
static size_t wider(const scene_along_path *path, const pendres_step *than)
{
  size_t n = 0;
  for (size_t i = 0; i < path->steps; i++) {
    const pendres_step *s = &path->step[i];
    n += s->upper - s->lower > than->upper - than->lower;
  }
  return n;
}

/* The widest ones; only where there is one but the pendulum's rest. */
static void tabulate_steps(FILE *out, const scene_along_path *path)
{
  size_t turning = 0, told = 0;
  for (size_t i = 0; i < path->steps; i++) turning += path->step[i].winding != 0;
  if (turning == 0) return;
  fprintf(out, "\n%-9s %-25s %-25s %s\n", "step", "from torque", "to", "width");
  for (size_t i = 0; i < path->steps && told < SCENE_TABLE_LINES; i++) {
    const pendres_step *s = &path->step[i];
    char name[30];
    if (wider(path, s) >= SCENE_TABLE_LINES) continue;
    told++;
    if (s->period == 1) snprintf(name, sizeof name, "%d", s->winding);
    else snprintf(name, sizeof name, "%d/%d", s->winding, s->period);
    fprintf(out, "%-8s", name);
    print_end(out, s->lower_end, s->lower, s->lower_error);
    print_end(out, s->upper_end, s->upper, s->upper_error);
    if (isnan(s->width)) fputs("  -\n", out);
    else fprintf(out, "  %.12g +- %.0e\n", s->width, s->width_error);
  }
  if (path->steps > told) fprintf(out, "and %zu narrower ones\n", path->steps - told);
}

/* What a jump leads to: how often it turns in how many drive periods, or these alone. */
static void print_orbit(FILE *out, const pendres_jump *j, int turns)
{
  if (!turns) fprintf(out, "%d", j->to_period);
  else if (j->to_period > 0) fprintf(out, "%d/%d", j->to_winding, j->to_period);
  else fputs("-", out);
}

static void tabulate(FILE *out, const scene_run *run, const scene_along_path *path)
{
  const int turns = has_steps(run->deck, path);
  fprintf(out, "%-5s %-11s %-28s %-14s %-14s %s\n", "way", "ends by", deck_axis_name(path->axis),
          "from", "to", turns ? "turns/periods" : "period");
  for (size_t i = 0; i < path->jumps && i < SCENE_TABLE_LINES; i++) {
    const pendres_jump *j = &path->jump[i];
    char where[60];
    snprintf(where, sizeof where, "%.14g +- %.0e", j->value, j->value_error);
    fprintf(out, "%-5s %-11s %-28s %-14s %-14s ", j->direction > 0 ? "up" : "down",
            pendres_name_get(PENDRES_NAMES_JUMP, j->kind), where,
            pendres_name_get(PENDRES_NAMES_LABEL, j->from),
            pendres_name_get(PENDRES_NAMES_LABEL, j->to));
    print_orbit(out, j, turns);
    fprintf(out, "%s%s\n", j->gradual ? ", gradual" : "", j->certain ? "" : ", uncertain");
  }
  if (scene_along_uncertain(path))
    fprintf(out, "uncertain: errors as small as rounding choose the state that it begins on\n");
  if (path->jumps == 0) fprintf(out, "the state does not end within the range\n");
  if (path->jumps > SCENE_TABLE_LINES)
    fprintf(out, "and %zu more\n", path->jumps - SCENE_TABLE_LINES);
}

static pendres_status run_scene(scene_run *run)
{
  deck_axis_id axis[DECK_AXES];
  scene_along_path path = {.points = 0};
  (void)deck_axes(run->deck, axis);
  compute(run, axis[0], &path);
  write(run, axis[0], &path);
  if (scene_prints(run)) {
    tabulate(run->table, run, &path);
    if (has_steps(run->deck, &path)) tabulate_steps(run->table, &path);
  }
  scene_ramp_run(run, axis[0], &path);
  return run->status;
}

static void describe(const deck *d, FILE *out)
{
  deck_axis_id axis[DECK_AXES];
  (void)deck_axes(d, axis);
  const deck_axis *a = &d->axis[axis[0]];
  fprintf(out, "the state of a pendulum while %s goes slowly from %g to %g and back,\n"
               "at %zu values each way, and the jumps on the way; ",
          deck_axis_name(axis[0]), a->value[0], a->value[a->count - 1], a->count);
  if (d->orbit.start[0] != '\0') fprintf(out, "it starts on attractor '%s'\n", d->orbit.start);
  else fprintf(out, "it starts at x = %g, v = %g\n", d->orbit.x, d->orbit.v);
  scene_ramp_describe(d, axis[0], out);
}

/* Bytes of a ramp, and of what noise does to it. */
static scene_more more(const deck *d, const farm_trial *trial, double points)
{
  (void)trial;
  (void)points;
  if (!deck_has_ramp(d)) return (scene_more){0.0, 0.0};
  const double trajectories = deck_has_noise(d) ? (double)d->noise.trajectories : 0.0;
  return (scene_more){.output = 45.0 * 2.0 * (double)d->ramp.points + 14.0 * trajectories};
}

const scene_kind scene_hysteresis = {
  .kind = DECK_HYSTERESIS,
  .references = "; Y. A. Kuznetsov, Elements of Applied Bifurcation Theory, chapter 4; J. M. T. "
                "Thompson and M. S. Soliman, Proceedings of the Royal Society A 432 (1991) 101",
  .budget = 1,
  .path = 1,
  .size = {.head = 40e3, .point = 240.0, .memory = 60e3, .stages = 1.0, .after = 1.0,
           .seconds = 0.03, .slowest = SCENE_SLOWEST_BRANCH,
           .journal = SCENE_DIRECTIONS * SCENE_PATH_JOURNAL, .more = more},
  .one_temperature = 1,
  .describe = describe,
  .run = run_scene,
};
