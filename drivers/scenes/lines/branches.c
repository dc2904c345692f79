/*
 * branches.c -- amplitudes of SA and LA along lines, with the branches between.
 *
 * The paper's Fig. 9. One task a damping. Beside the ensemble's means stand the branches
 * themselves, unstable parts included, the curves of folds that bound the coexistence region (the
 * figure's thick lines), and two backbones: the driven one's at a lag of pi/2, and that of free
 * oscillations; of a pendulum without a drive, the rotations that a torque keeps up.
 */
#include <math.h>

#include <pendres/free.h>
#include <pendres/rotation.h>

#include "scenes/lines/lines.h"

enum {
  BACKBONE = 101, /* points of the backbone, */
  FREE = 156,     /* and of free oscillations, of the pendulum's 0.02 apart up to pi */
  MOST_PARTS = 64 /* parts of a branch that the table tells */
};

static void describe(const deck *d, FILE *out)
{
  fprintf(out, "amplitudes of ");
  scene_lines_describe(d, out);
  fprintf(out, "; the branches of orbits that they lie on, curves of folds, and backbones\n");
}

/* ---- the grid ------------------------------------------------------------------------------ */

static const scene_column columns[] = {
  {SCENE_AS("sa_amplitude", pendres_phase_point, sa_amplitude,
            "amplitude of the small-amplitude orbit, reached by members or not", "amplitude")},
  {SCENE_AS("la_amplitude", pendres_phase_point, la_amplitude,
            "amplitude of the large-amplitude orbit, reached by members or not", "amplitude")},
  SCENE_COLUMN(pendres_phase_point, mean_loop_amplitude, NULL),
  SCENE_COLUMN(pendres_phase_point, mean_loop_area, NULL),
  SCENE_COLUMN(pendres_phase_point, sa_fraction, NULL),
  SCENE_COLUMN(pendres_phase_point, la_fraction, NULL),
  SCENE_CODE(pendres_phase_point, regime, "states of motion that members settle on",
             scene_regime_names),
};

/* ---- branches ------------------------------------------------------------------------------ */

/* Points of all branches of all lines, one after another. */
typedef struct row {
  scene_place place;
  pendres_orbit of;
  double multiplier_error[2]; /* of both the same */
  int kind, doubt, number;
} row;

SCENE_NAMES(stabilities, "unstable", "stable")

static const int8_t doubt_bits[] = {0, PENDRES_DOUBT_SIGN, PENDRES_DOUBT_TURN,
                                    PENDRES_DOUBT_BIFURCATION};

static const char *doubts(int value)
{
  if (value == 0) return "none";
  return value < (int)sizeof doubt_bits ? pendres_name_get(PENDRES_NAMES_DOUBT, doubt_bits[value])
                                        : NULL;
}

static const scene_column of_points[] = {
  {.name = "multiplier_re", .long_name = "real part of the Floquet multiplier", .pairs = 1,
   .value = offsetof(row, of.multiplier_re), .error = offsetof(row, multiplier_error)},
  {.name = "multiplier_im", .long_name = "imaginary part of the Floquet multiplier", .pairs = 1,
   .value = offsetof(row, of.multiplier_im), .error = offsetof(row, multiplier_error)},
  {SCENE_TYPED(SCENE_FLAG, "stable", row, of.stable, "whether the orbit attracts"),
   .names = stabilities},
  SCENE_CODE(row, kind, "what happens at the point", scene_special_names),
  {SCENE_TYPED(SCENE_FLAG, "doubt", row, doubt,
               "what the bifurcations do not explain there: sum of the flags"), .names = doubts,
   .codes = doubt_bits},
  {SCENE_TYPED(SCENE_NUMBER, "number", row, number, "number of the branch")},
  {SCENE_TYPED(SCENE_NUMBER, "period", row, of.period, NULL)},
};

static row row_of(const scene_lines *l, const pendres_branch_point *p, int number)
{
  const pendres_orbit *o = &p->orbit;
  const double error[2] = {p->parameter_error, 0.0};
  return (row){.place = scene_lines_place(l, &o->pendulum, error), .of = *o,
               .multiplier_error = {o->multiplier_error, o->multiplier_error},
               .kind = (int)p->kind, .doubt = p->doubt, .number = number};
}

/* Their number; rows may be NULL. */
static size_t take_points(const scene_lines *l, row *rows)
{
  size_t n = 0;
  int number = 0;
  for (size_t i = 0; i < l->grid.lines; i++) {
    const pendres_branches *all = pendres_phase_diagram_branches_get(l->diagram, i);
    for (size_t k = 0; k < pendres_branches_count(all); k++, number++) {
      const pendres_branch *b = pendres_branches_get(all, k);
      for (size_t m = 0; m < pendres_branch_count(b); m++, n++)
        if (rows != NULL) rows[n] = row_of(l, pendres_branch_get(b, m), number);
    }
  }
  return n;
}

static void write_branches(const scene_lines *l)
{
  const size_t n = take_points(l, NULL);
  row *rows = scene_array(l->run, n, sizeof *rows);
  if (rows == NULL) return;
  (void)take_points(l, rows);
  const scene_table table = {.dimensions = {"point"}, .prefix = "branch", .inner = "multiplier",
                             SCENE_ROWS(rows, n)};
  scene_numbering(l->run, "point", n, "number of the point, in order along each branch");
  scene_numbering(l->run, "multiplier", 2, "Floquet multiplier, the larger modulus first");
  scene_lines_write_places(l, &table, NULL, sizeof of_points / sizeof *of_points, of_points);
  scene_columns_write_orbits(l->run, &table, offsetof(row, of));
}

/* ---- backbones ----------------------------------------------------------------------------- */

typedef struct backbone_row {
  double frequency, frequency_error, amplitude, amplitude_error, loop_area, loop_area_error;
} backbone_row;

static const scene_column of_backbone[] = {
  SCENE_COLUMN(backbone_row, frequency,
               "drive frequency at which the orbit lags by a quarter turn"),
  SCENE_COLUMN(backbone_row, amplitude, "amplitude of that orbit"),
  SCENE_COLUMN(backbone_row, loop_area, "loop area of that orbit"),
};

/* Where it is looked for: n pendulums, and the values in which they differ. */
typedef struct backbone_points {
  size_t n;
  pendres_pendulum p[BACKBONE];
  double value[BACKBONE];
} backbone_points;

/* Dampings in a geometric series, from below where the backbone begins to twice the deck's own; but
   not to where too many steps are needed, and the pendulum has long been a linear one. */
static void backbone_dampings(const scene_lines *l, backbone_points *at)
{
  const double first = l->grid.line_value[0], last = l->grid.line_value[l->grid.lines - 1];
  const double rate = 1.0 / pendres_units_of(&l->grid.pendulum).time, low = 0.5 * first;
  const double high = fmax(fmax(rate, 2.0 * first), fmin(2.0 * last, 100.0 * rate));
  at->n = BACKBONE;
  for (int i = 0; i < BACKBONE; i++) {
    at->value[i] = low * pow(high / low, i / (BACKBONE - 1.0));
    at->p[i] = l->grid.pendulum;
    at->p[i].damping = at->value[i];
  }
}

/* The lines' own pendulums, where they are few: each has a curve of its own over the damping, which
   takes as long as all points of one. None where one of them is not driven or damped. */
static void backbone_lines(const scene_lines *l, backbone_points *at)
{
  at->n = l->grid.lines <= BACKBONE ? l->grid.lines : 0;
  for (size_t i = 0; i < at->n; i++) {
    at->value[i] = l->grid.line_value[i];
    at->p[i] = scene_lines_pendulum(l, i * l->grid.values);
    if (!(at->p[i].drive_amplitude > 0.0 && at->p[i].damping > 0.0)) at->n = 0;
  }
}

/* Find the backbone at all of them at once or, where that fails, at each of them alone. */
static pendres_status find_backbone(pendres_context *ctx, const backbone_points *at,
                                    pendres_orbit *orbit, double *error, pendres_status *outcome)
{
  pendres_status status = pendres_backbone_find(ctx, at->n, at->p, orbit, error, outcome);
  if (scene_failure_of(status) == SCENE_FAILURE_NONE) return status;
  status = PENDRES_OK;
  for (size_t i = 0; i < at->n && status == PENDRES_OK; i++) {
    status = pendres_backbone_find(ctx, 1, &at->p[i], &orbit[i], &error[i], &outcome[i]);
    if (scene_failure_of(status) == SCENE_FAILURE_NONE) continue;
    outcome[i] = PENDRES_NOT_FOUND; /* the backbone ends, or cannot be followed, there */
    status = PENDRES_OK;
  }
  return status;
}

/* Over damping, also between lines and beyond; over any other parameter at the lines. */
static void write_backbone(const scene_lines *l)
{
  pendres_status outcome[BACKBONE];
  double error[BACKBONE];
  backbone_row rows[BACKBONE];
  backbone_points at;
  const int over_damping = l->points.axis[0] == DECK_AXIS_DAMPING;
  const pendres_store_spec along = {.name = "backbone_damping"};
  if (over_damping && !(l->grid.pendulum.drive_amplitude > 0.0)) return;
  if (over_damping) backbone_dampings(l, &at);
  else backbone_lines(l, &at);
  if (at.n == 0) return;
  const scene_table table = {
    .dimensions = {over_damping ? along.name : deck_axis_name(l->points.axis[0])},
    .prefix = "backbone", SCENE_ROWS(rows, at.n)};
  pendres_context *ctx = scene_context(l->run);
  pendres_orbit *orbit = scene_array(l->run, at.n, sizeof *orbit);
  if (orbit == NULL) return;
  if (scene_asked(l->run, find_backbone(ctx, &at, orbit, error, outcome)) != PENDRES_OK) return;
  for (size_t i = 0; i < at.n; i++) {
    const pendres_orbit *o = &orbit[i];
    const int has = outcome[i] == PENDRES_OK || outcome[i] == PENDRES_TOLERANCE_UNREACHABLE;
    rows[i] = (backbone_row){o->pendulum.drive_frequency, error[i], o->amplitude,
                             o->amplitude_error, o->loop_area, o->loop_area_error};
    if (!has) SCENE_BLANK(of_backbone, &rows[i]);
  }
  if (over_damping) scene_put_dimension_as(l->run, "damping", &along, at.value, at.n);
  SCENE_WRITE(l->run, &table, of_backbone);
}

/* The largest amplitude of all branches, rotations aside. */
static double largest_amplitude(const scene_lines *l)
{
  double largest = 0.0;
  for (size_t i = 0; i < l->grid.lines; i++) {
    const pendres_branches *all = pendres_phase_diagram_branches_get(l->diagram, i);
    for (size_t k = 0; k < pendres_branches_count(all); k++) {
      const pendres_branch *b = pendres_branches_get(all, k);
      for (size_t m = 0; m < pendres_branch_count(b); m++) {
        const pendres_orbit *o = &pendres_branch_get(b, m)->orbit;
        if (o->winding == 0) largest = fmax(largest, o->amplitude);
      }
    }
  }
  return largest;
}

/* The free oscillation, without damping and drive. */
typedef struct free_curve {
  double amplitude[FREE], frequency[FREE], error[FREE];
} free_curve;

/* The plain pendulum's: exact. Returns how many points there are. */
static size_t find_plain(free_curve *c)
{
  for (int i = 0; i < FREE; i++) {
    c->amplitude[i] = 0.02 * (i + 1);
    c->frequency[i] = pendres_free_frequency(c->amplitude[i]);
    c->error[i] = 2e-15 * c->frequency[i]; /* some units in the last place */
  }
  return FREE;
}

/* That of any force, somewhat higher than the branches, with a gap between swings about a well and
   those across barriers; none where lines have different forces. */
static size_t find_free(const scene_lines *l, free_curve *c)
{
  pendres_pendulum p[FREE];
  pendres_free_oscillation of[FREE];
  pendres_status outcome[FREE];
  const double most = 1.1 * largest_amplitude(l);
  size_t n = 0;
  for (int k = 0; k < PENDRES_PARAMETER_FOLLOWED; k++) {
    const pendres_parameter_info *info = pendres_parameter_of((pendres_parameter)k);
    const int of_force = k == (int)PENDRES_TORQUE || info->coefficient > 0;
    if (of_force && scene_lines_changes(l, (pendres_parameter)k)) return 0;
  }
  for (int i = 0; i < FREE; i++) {
    p[i] = l->grid.pendulum;
    p[i].damping = p[i].drive_amplitude = 0.0;
    c->amplitude[i] = most * (i + 1) / FREE;
  }
  if (!(most > 0.0)) return 0;
  pendres_context *ctx = scene_context(l->run);
  if (scene_asked(l->run, pendres_free_oscillation_find(ctx, FREE, p, c->amplitude, of, outcome)) !=
      PENDRES_OK)
    return 0;
  for (size_t i = 0; i < FREE; i++) {
    c->frequency[i] = of[i].frequency;
    c->error[i] = of[i].frequency_error;
    if (isfinite(of[i].frequency)) n = i + 1;
  }
  return n;
}

static void write_free(const scene_lines *l)
{
  free_curve c;
  const int plain = deck_is_plain(l->run->deck);
  const pendres_store_spec spec = {
    .name = "free_frequency", .dimensions = {"free_amplitude"},
    .long_name = plain ? "frequency of the undamped, undriven pendulum"
                       : "frequency of oscillations without damping and drive"};
  const pendres_store_spec along = {
    .name = "free_amplitude",
    .long_name = plain ? "amplitude of the free pendulum" : "amplitude of the free oscillation"};
  const size_t n = plain ? find_plain(&c) : find_free(l, &c);
  if (n == 0) return;
  scene_put_dimension(l->run, &along, c.amplitude, n);
  scene_put(l->run, &spec, c.frequency, c.error, n);
}

/* ---- rotations without a drive ------------------------------------------------------------- */

/*
 * Without a drive of either kind the equation is autonomous. What stands still are equilibria,
 * which are orbits of every strobe map and are followed as branches; what rotates has a period of
 * its own and is no such orbit. Where a rotation exists there is one, so that its branch over the
 * torque is found point by point; it ends at the least torque, in a homoclinic connection or a
 * saddle-node (pendres/rotation.h).
 */

typedef struct rotation {
  pendres_rotation of;
  pendres_rotation_onset onset;
} rotation;

static const scene_column of_rotations[] = {
  {SCENE_AS("period", rotation, of.period,
            NULL, "rotation_period")},
  {SCENE_AS("mean_velocity", rotation, of.mean_velocity, "mean velocity of the rotation", NULL)},
  {SCENE_AS("multiplier", rotation, of.multiplier,
            "Floquet multiplier of the rotation; the other one is 1", NULL)},
  {SCENE_AS("least_torque", rotation, onset.torque,
            "least torque, of either sign, that keeps a rotation up", "torque")}};

/* Whether the lines are those of a pendulum under a torque, without a drive of either kind. */
static int are_rotations(const scene_lines *l)
{
  const pendres_pendulum *p = &l->grid.pendulum;
  return p->force == PENDRES_FORCE_PENDULUM && p->drive_amplitude == 0.0 &&
         p->parametric_amplitude == 0.0 && !scene_lines_changes(l, PENDRES_DRIVE_AMPLITUDE) &&
         !scene_lines_changes(l, PENDRES_PARAMETRIC_AMPLITUDE) &&
         (p->torque != 0.0 || scene_lines_changes(l, PENDRES_TORQUE));
}

/* No rotation is given for dampings below 1e-9 and above 100. */
static rotation rotation_at(const pendres_pendulum *p)
{
  rotation found, out = {.of = {.period = NAN}};
  SCENE_BLANK(of_rotations, &out);
  if (pendres_rotation_onset_find(p->damping, &found.onset) == PENDRES_OK) out.onset = found.onset;
  if (pendres_rotation_find(p, &found.of, NULL) == PENDRES_OK) out.of = found.of;
  return out;
}

/* NaN where there is no rotation. */
static void write_rotations(const scene_lines *l)
{
  rotation *rows = scene_array(l->run, l->points.n, sizeof *rows);
  for (size_t i = 0; rows != NULL && i < l->points.n; i++) {
    const pendres_pendulum p = scene_lines_pendulum(l, i);
    rows[i] = rotation_at(&p);
  }
  const scene_table table = {
    .dimensions = {deck_axis_name(l->points.axis[0]), deck_axis_name(l->points.axis[1])},
    .prefix = "rotation", SCENE_ROWS(rows, l->points.n)};
  SCENE_WRITE(l->run, &table, of_rotations);
}

/* ---- the scene ----------------------------------------------------------------------------- */

/* A part of a branch that attracts, from its lower value of the parameter to the higher one. */
typedef struct part {
  double line, value[2], error[2];
  size_t branch;
  int period;
  char why[2][24]; /* it ends there */
} part;

static part part_of(const scene_lines *l, const pendres_branch *b, const pendres_branch_part *of)
{
  const pendres_branch_point *p[2] = {pendres_branch_get(b, of->first),
                                      pendres_branch_get(b, of->last)};
  const pendres_special kind[2] = {of->begins, of->ends};
  const pendres_parameter along = l->grid.options.parameter;
  const int back = pendres_parameter_get(along, &p[0]->orbit.pendulum) >
                   pendres_parameter_get(along, &p[1]->orbit.pendulum);
  part out = {.period = p[0]->orbit.period};
  for (int i = 0; i < 2; i++) {
    const int k = back ? 1 - i : i;
    out.value[i] = pendres_parameter_get(along, &p[k]->orbit.pendulum);
    out.error[i] = p[k]->parameter_error;
    snprintf(out.why[i], sizeof out.why[i], "%s",
             kind[k] != PENDRES_REGULAR ? pendres_name_get(PENDRES_NAMES_SPECIAL, kind[k])
                                        : pendres_name_get(PENDRES_NAMES_BRANCH_END,
                                                           pendres_branch_end_get(b, k)));
  }
  return out;
}

/* Take all parts of branches that attract; returns their number. rows may be NULL. */
static size_t take_parts(const scene_lines *l, part *rows)
{
  size_t count = 0;
  for (size_t i = 0; i < l->grid.lines; i++) {
    const pendres_branches *all = pendres_phase_diagram_branches_get(l->diagram, i);
    for (size_t k = 0; k < pendres_branches_count(all); k++) {
      const pendres_branch *b = pendres_branches_get(all, k);
      pendres_branch_part found[MOST_PARTS];
      const size_t n = pendres_branch_parts(b, MOST_PARTS, found);
      for (size_t m = 0; m < n && m < MOST_PARTS; m++, count++) {
        if (rows == NULL) continue;
        rows[count] = part_of(l, b, &found[m]);
        rows[count].line = l->grid.line_value[i];
        rows[count].branch = k;
      }
    }
  }
  return count;
}

static void print_table(FILE *out, const scene_lines *l)
{
  char line[64], from[96];
  const scene_cell cells[] = {
    SCENE_CELL(part, line, line, "%-15.6g  "),
    {.heading = "branch  ", .format = "%-6zu  ", .type = SCENE_COUNT,
     .value = offsetof(part, branch)},
    {.heading = "period  ", .format = "%-6d  ", .type = SCENE_NUMBER,
     .value = offsetof(part, period)},
    SCENE_CELL(part, value[0], from, "%#.13g +- "),
    SCENE_CELL(part, error[0], "                  ", "%.0e "),
    {.heading = "to", .format = "%-17s  ", .type = SCENE_TEXT, .value = offsetof(part, why[0])},
    SCENE_CELL(part, value[1], "", "%#.13g +- "),
    SCENE_CELL(part, error[1], "", "%.0e "),
    {.heading = "", .format = "%s", .type = SCENE_TEXT, .value = offsetof(part, why[1])},
  };
  const size_t n = take_parts(l, NULL);
  part *rows = scene_array(l->run, n, sizeof *rows);
  const scene_table table = {SCENE_ROWS(rows, n)};
  if (rows == NULL) return;
  (void)take_parts(l, rows);
  char across[DECK_NAME], along[DECK_NAME];
  snprintf(line, sizeof line, "%-15s  ", scene_spaced(l->grid.across, across));
  snprintf(from, sizeof from, "attracts from %s",
           scene_spaced(l->grid.options.parameter, along));
  SCENE_PRINT(out, &table, n, cells, NULL);
  scene_lines_print(l, out);
}

static void write_results(const scene_lines *l)
{
  scene_lines_write(l, sizeof columns / sizeof *columns, columns);
  if (are_rotations(l)) write_rotations(l);
  write_branches(l);
  scene_lines_write_doubts(l);
  scene_curves_write(l);
  if (l->points.axis[1] == DECK_AXIS_DRIVE_FREQUENCY) write_backbone(l);
  write_free(l);
  scene_curves_write_paper(l);
}

static pendres_status run_scene(scene_run *run)
{
  scene_lines l;
  scene_lines_compute(run, 0.0, &l);
  if (scene_going(run)) write_results(&l);
  if (scene_prints(run)) print_table(run->table, &l);
  scene_lines_free(&l);
  return run->status;
}

const scene_kind scene_branches = {
  .kind = DECK_BRANCHES,
  .figures = "Fig. 9",
  .references = "; Y. A. Kuznetsov, Elements of Applied Bifurcation Theory, chapters 4, 9 and "
                "10",
  .budget = 1,
  .size = {.head = 60e3, .point = 470.0, .memory = 1e3, .stages = 2.0, .after = 1.1, .members = 1,
           .seconds = 2e-3, .slowest = SCENE_SLOWEST_BRANCH},
  .describe = describe,
  .run = run_scene};
