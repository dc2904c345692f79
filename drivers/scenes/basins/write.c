/* write.c -- the file and the table of scene `basins`; see basins.h. */
#include "scenes/basins/basins.h"
#include "scenes/numbers.h"
#include "results/columns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { QUICK = 1 /* level of compression for the largest arrays: higher ones gain little */ };

/* ---- states -------------------------------------------------------------------------------- */

/* A state as a row of results. */
typedef struct state_row {
  int label, attractor, well, settling_periods, failed, uncertain;
} state_row;

static const scene_column of_states[BASINS_VARIABLES] = {
  SCENE_CODE(state_row, label, "what the pendulum settles on", scene_motion_names),
  {SCENE_TYPED(SCENE_NUMBER, "attractor_index", state_row, attractor,
               "number of the attractor that the pendulum settles on"),
   .comment = "-1: unresolved"},
  {SCENE_TYPED(SCENE_NUMBER, "well", state_row, well,
               "number of the well that the pendulum settles in"),
   .comment = "0 for running and chaotic pendulums"},
  {SCENE_TYPED(SCENE_NUMBER, "settling_periods", state_row, settling_periods,
               "drive periods until the pendulum is inside its attractor's trapping region"),
   .comment = "-1: unresolved; -2: filled in by refinement, not integrated; -3: ended by --budget"},
  SCENE_CODE(state_row, failed, "why there is no label for the state", scene_failure_names),
  {SCENE_TYPED(SCENE_FLAG, "uncertain", state_row, uncertain,
               "whether the errors that the pendulum carried may change where it settles"),
   .names = scene_doubt_names, .comment = "no: they may not, or the state was not integrated"},
};

static void state_rows(size_t n, const pendres_basin_state *state, state_row *rows)
{
  for (size_t i = 0; i < n; i++) {
    const pendres_basin_state *s = &state[i];
    const int unknown = s->attractor == PENDRES_ATTRACTOR_UNKNOWN;
    const int late = s->settling_periods == BASINS_GIVEN_UP;
    rows[i] = (state_row){
      .label = s->label, .attractor = s->attractor, .well = s->well,
      .settling_periods = s->settling_periods,
      .failed = late      ? SCENE_FAILURE_OUT_OF_TIME
                : unknown ? SCENE_FAILURE_UNRESOLVED
                          : SCENE_FAILURE_NONE,
      .uncertain = s->how == PENDRES_BASIN_UNCERTAIN};
  }
}

static scene_table state_table(const char *group, const char *second, size_t n,
                               const state_row *rows)
{
  return (scene_table){.group = group, .dimensions = {"x", second}, .n = n,
                       .stride = sizeof *rows, .rows = rows, .deflate = QUICK};
}

static scene_variables variables_of(basins *b)
{
  return (scene_variables){BASINS_VARIABLES, b->column, b->variable};
}

/* Whether the force is one of those that may drive pendulums to infinity. */
static int may_escape(const basins *b)
{
  return pendres_model_of(b->d->pendulum.force)->outward != NULL;
}

void basins_define(basins *b)
{
  const scene_table table = state_table("", "v", 0, NULL);
  const scene_variables of = variables_of(b);
  memcpy(b->column, of_states, sizeof of_states);
  /* The first two columns have values for what is on no attractor. */
  b->column[0].names = scene_settled_names(&b->pendulum);
  if (may_escape(b)) b->column[1].comment = "-1: unresolved; -2: escapes to infinity";
  if (b->pendulum.drive_amplitude == 0.0)
    b->column[1].comment =
      "-1: unresolved; -2: escapes to infinity; -3: at rest in an unstable state";
  scene_dimension(b->run, "", DECK_AXIS_X);
  scene_dimension(b->run, "", DECK_AXIS_V);
  scene_columns_define(b->run, &table, &of);
}

void basins_write_rows(basins *b, size_t first, size_t rows, const pendres_basin_state *state)
{
  const size_t nv = b->grid.nv;
  const scene_variables of = variables_of(b);
  state_row *some = calloc((rows < BASINS_ROWS ? rows : BASINS_ROWS) * nv + 1, sizeof *some);
  if (some == NULL) scene_fail(b->run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu rows", rows);
  for (size_t i = 0; i < rows && scene_going(b->run); i += BASINS_ROWS) {
    const size_t n = rows - i < BASINS_ROWS ? rows - i : BASINS_ROWS;
    const scene_table table = state_table("", "v", n * nv, some);
    state_rows(n * nv, state + i * nv, some);
    scene_columns_write_rows(b->run, &table, first + i, n, &of);
  }
  free(some);
}

static void write_cut(basins *b)
{
  const size_t n = b->grid.nx;
  state_row *rows = scene_array(b->run, n, sizeof *rows);
  const scene_table table = state_table("cut", NULL, n, rows);
  if (rows == NULL) return;
  state_rows(n, b->cut, rows);
  scene_dimension(b->run, "cut", DECK_AXIS_X);
  SCENE_WRITE(b->run, &table, b->column);
  results_attribute(b->run, "cut", NULL, "description", "the line v = 0");
}

/* ---- attractors ---------------------------------------------------------------------------- */

/* An attractor and its share of the window. */
typedef struct row {
  size_t number;
  pendres_attractor of;
  double basin_fraction, basin_fraction_error;
  size_t basin_states, basin_wells;
  double period, winding; /* of the orbit; NaN where it does not close */
  double mean_velocity, mean_velocity_error;
} row;

static const scene_column of_label =
  {SCENE_TYPED(SCENE_FLAG, "attractor_label", row, of.label, "kind of attractor")};

static const scene_column of_attractors[] = {
  {SCENE_TYPED(SCENE_NUMBER, "attractor_period", row, of.orbit.period,
               "drive periods until the orbit closes; 0: it does not")},
  {SCENE_TYPED(SCENE_NUMBER, "attractor_winding", row, of.orbit.winding,
               "whole turns in that time")},
  {SCENE_AS("attractor_x", row, of.orbit.x, "position at drive phase 0, in well 0", "x")},
  {SCENE_AS("attractor_v", row, of.orbit.v, "velocity at drive phase 0", "v")},
  {SCENE_AS("attractor_lyapunov", row, of.lyapunov, NULL, "lyapunov")},
};

static const scene_column of_drift =
  {SCENE_AS("attractor_drift", row, of.drift, "mean whole turns a drive period, of chaos", NULL)};

static const scene_column of_chaos[] = {
  {SCENE_TYPED(SCENE_PLAIN, "attractor_watched_periods", row, of.watched_periods,
               "drive periods that chaos was watched for without ending, all walkers together")},
  {SCENE_TYPED(SCENE_PLAIN, "attractor_escape_rate_bound", row, of.escape_rate_bound,
               "largest rate of ending of chaos, a drive period, that is not excluded at 95 %")},
  {SCENE_AS("basin_fraction", row, basin_fraction, "share of the window's area", NULL),
   .comment = "each state stands for what is nearest to it: ends of a range count half; plain "
              "counts are basin_states"},
};

/* Where the pendulum may rotate for ever. */
static const scene_column of_rotations[] = {
  {SCENE_AS("attractor_mean_velocity", row, mean_velocity, "mean velocity", "mean_velocity")},
};

static const scene_column of_wells[] = {
  SCENE_COLUMN_OF(SCENE_COUNT, row, basin_states, "states of the grid that go there"),
  SCENE_COLUMN_OF(SCENE_COUNT, row, basin_wells, "wells that these states settle in"),
};

static void make_rows(basins *b, const double *fraction, const double *error, row *rows)
{
  size_t *states = scene_array(b->run, pendres_attractors_count(b->set), sizeof *states);
  if (states == NULL) return;
  scene_asked(b->run, pendres_basin_sums_counts(b->sums, states));
  for (size_t i = 0; i < pendres_attractors_count(b->set); i++) {
    const pendres_attractor *a = pendres_attractors_get(b->set, i);
    const int closed = a->orbit.period > 0;
    const double turned = closed ? (double)a->orbit.winding / a->orbit.period : a->drift;
    rows[i] = (row){.number = i, .of = *a,
                    .mean_velocity = turned * b->pendulum.drive_frequency,
                    .mean_velocity_error =
                      closed ? 0.0 : a->drift_error * b->pendulum.drive_frequency,
                    .basin_fraction = fraction[i], .basin_fraction_error = error[i],
                    .basin_states = states[i], .basin_wells = basins_wells_of(b, (int)i),
                    .period = closed ? a->orbit.period : NAN,
                    .winding = closed ? a->orbit.winding : NAN};
  }
}

static void write_attractors(basins *b, size_t n, const row *rows)
{
  const scene_table table = {.dimensions = {"attractor"}, SCENE_ROWS(rows, n)};
  const scene_table orbits = {.dimensions = {"attractor"}, .prefix = "attractor",
                              SCENE_ROWS(rows, n)};
  scene_numbering(b->run, "attractor", n, "attractor, by amplitude, then by position");
  const int rotates = pendres_pendulum_rotates(&b->pendulum);
  scene_column label = of_label, drift = of_drift;
  label.names = scene_settled_names(&b->pendulum);
  scene_columns_write(b->run, &table, 1, &label);
  SCENE_WRITE(b->run, &table, of_attractors);
  if (rotates) drift.long_name = "mean whole turns a drive period, of what does not close";
  scene_columns_write(b->run, &table, 1, &drift);
  SCENE_WRITE(b->run, &table, of_chaos);
  if (rotates) SCENE_WRITE(b->run, &table, of_rotations);
  scene_columns_write_orbits(b->run, &orbits, offsetof(row, of.orbit));
  SCENE_WRITE(b->run, &table, of_wells);
  basins_write_wells(b);
}

/* ---- statistics ---------------------------------------------------------------------------- */

static void look_closer(basins *b, pendres_basin_statistics *s)
{
  pendres_context *ctx = scene_context(b->run);
  if (ctx != NULL)
    scene_asked(b->run, pendres_basin_statistics_refine(ctx, b->set, &b->grid, s,
                                                        &b->random_states));
}

static const scene_column of_statistics[] = {
  {SCENE_AS("basin_entropy", pendres_basin_statistics, entropy, NULL, NULL)},
  {SCENE_AS("boundary_basin_entropy", pendres_basin_statistics, boundary_entropy, NULL, NULL)},
  SCENE_COLUMN(pendres_basin_statistics, uncertainty_exponent,
               "exponent of the share of uncertain states over distance"),
};

/* The statistics hold shares as arrays of doubles: one row is one double away from the next. */
static const scene_column of_distances[] = {
  {SCENE_AS("uncertain_fraction", pendres_basin_statistics, uncertain, NULL, NULL)},
};

static void write_statistics(basins *b, const pendres_basin_statistics *s)
{
  static const scene_column random = {
    .name = "uncertainty_random_states", .type = SCENE_COUNT,
    .long_name = "random states that the exponent is from; 0: the states of the grid"};
  const scene_table whole = {SCENE_ROWS(s, 1)};
  const scene_table states = {SCENE_ROWS(&b->random_states, 1)};
  const scene_table distances = {.dimensions = {"distance"}, .n = (size_t)s->scales,
                                 .stride = sizeof s->uncertain[0], .rows = s};
  const pendres_store_spec distance = {.name = "distance",
                                       .long_name = "distance in initial velocity"};
  SCENE_WRITE(b->run, &whole, of_statistics);
  scene_columns_write(b->run, &states, 1, &random);
  if (s->scales == 0) return;
  scene_put_dimension_as(b->run, "v", &distance, s->distance, distances.n);
  SCENE_WRITE(b->run, &distances, of_distances);
}

/* How many states there are of each kind. */
typedef struct counts {
  size_t unresolved_states, uncertain_states;
  size_t integrated_states, filled_states, verified_states, verification_misses, suspected_states;
} counts;

static const scene_column of_counts[] = {
  SCENE_COLUMN_OF(SCENE_COUNT, counts, unresolved_states, "states without an attractor"),
  SCENE_COLUMN_OF(SCENE_COUNT, counts, uncertain_states,
                  "integrated states that may go to another attractor, or well"),
};
static const scene_column of_refinement[] = {
  SCENE_COLUMN_OF(SCENE_COUNT, counts, integrated_states, "states that were integrated"),
  SCENE_COLUMN_OF(SCENE_COUNT, counts, filled_states, "states that were filled in"),
  SCENE_COLUMN_OF(SCENE_COUNT, counts, verified_states,
                  "filled states that were integrated as a check"),
  SCENE_COLUMN_OF(SCENE_COUNT, counts, verification_misses,
                  "verified states that had been filled in wrongly, and were put right with their "
                  "surroundings until a fresh sample was clean"),
  SCENE_COLUMN_OF(SCENE_COUNT, counts, suspected_states,
                  "filled states that may be wrong at most, with a confidence of 95 %"),
};

/* The states that go to infinity, where they may. */
static const scene_column of_escapes[] = {
  {SCENE_TYPED(SCENE_COUNT, "escaped_states", pendres_basin_statistics, escaped,
               "states that escape to infinity")},
  {SCENE_AS("escape_fraction", pendres_basin_statistics, escape_fraction,
            "share of the window's area that escapes", NULL)},
};

static void write_escapes(basins *b, const pendres_basin_statistics *s)
{
  const scene_table table = {SCENE_ROWS(s, 1)};
  if (may_escape(b)) SCENE_WRITE(b->run, &table, of_escapes);
}

static void write_counts(basins *b)
{
  const counts of = {
    b->unresolved, b->uncertain, b->integrated, b->grid.nx * b->grid.nv - b->integrated,
    b->verified, b->missed, (size_t)ceil(pendres_basin_plan_suspected(b->filled, b->clean))};
  const scene_table table = {SCENE_ROWS(&of, 1)};
  SCENE_WRITE(b->run, &table, of_counts);
  if (b->d->basins.refine) SCENE_WRITE(b->run, &table, of_refinement);
}

/* ---- what the paper says ------------------------------------------------------------------- */

/* Share of the starts at rest between two positions that settle on `label` in well 0. */
static double share_between(const basins *b, double low, double high, pendres_label label)
{
  size_t all = 0, there = 0;
  for (size_t i = 0; i < b->grid.nx; i++) {
    if (b->grid.x[i] < low || b->grid.x[i] > high) continue;
    all++;
    there += b->cut[i].label == (int8_t)label && (label != PENDRES_LABEL_SA || b->cut[i].well == 0);
  }
  return all > 0 ? (double)there / (double)all : NAN;
}

static void write_paper(basins *b)
{
  const pendres_pendulum *p = &b->pendulum;
  if (fabs(p->damping - 0.12) > 1e-12 || fabs(p->drive_amplitude - 0.2) > 1e-12 ||
      fabs(p->drive_frequency - 0.25 * PENDRES_PI) > 1e-12 || !scene_going(b->run))
    return;
  scene_printed values[] = {
    {.name = "attractors", .printed = 2.0, .computed = (double)pendres_attractors_count(b->set)},
    {.name = "share_sa_x_0.2pi_to_1.1pi", .printed = 1.0,
     .computed = share_between(b, 0.2 * PENDRES_PI, 1.1 * PENDRES_PI, PENDRES_LABEL_SA)},
    {.name = "share_la_x_-0.3pi_to_0", .printed = 1.0,
     .computed = share_between(b, -0.3 * PENDRES_PI, 0.0, PENDRES_LABEL_LA)}};
  scene_write_paper(b->run, 3, values);
}

/* ---- the table ----------------------------------------------------------------------------- */

static const scene_cell cells[] = {
  {.heading = "attractor   ", .format = "%2zu ", .type = SCENE_COUNT,
   .value = offsetof(row, number)},
  {.heading = "", .format = "%-10s", .type = SCENE_FLAG, .value = offsetof(row, of.label),
   .names = scene_motion_names},
  {.heading = "period ", .format = "%4.0f ", .none = "   - ", .value = offsetof(row, period)},
  {.heading = "winding ", .format = "%6.0f   ", .none = "     -   ",
   .value = offsetof(row, winding)},
  {.heading = "x          ", .format = "%10.6f ", .none = "         - ",
   .value = offsetof(row, of.orbit.x)},
  {.heading = "amplitude    ", .format = "%.8f   ", .none = "-            ",
   .value = offsetof(row, of.orbit.amplitude)},
  {.heading = "phase lag    ", .format = "%.8f   ", .none = "-            ",
   .value = offsetof(row, of.orbit.phase_lag)},
  SCENE_CELL(row, of.lyapunov, "Lyapunov exponent     ", "%9.6f +- "),
  SCENE_CELL(row, of.lyapunov_error, "", "%.0e   "),
  SCENE_CELL(row, basin_fraction, "share of the area", "%.6f +- "),
  SCENE_CELL(row, basin_fraction_error, "", "%.0e"),
};

/* How fast rotations are, and how long chaos was watched. */
static void print_open(FILE *out, size_t n, const row *rows)
{
  for (size_t i = 0; i < n; i++)
    if (isnan(rows[i].period) && rows[i].of.label != PENDRES_LABEL_CHAOTIC)
      fprintf(out, "%2zu rotates with the mean velocity %.10g +- %.0e\n", i, rows[i].mean_velocity,
              rows[i].mean_velocity_error);
    else if (rows[i].of.label == PENDRES_LABEL_CHAOTIC)
      fprintf(out, "%2zu was watched for %.3g drive periods: chaos that ends at a rate above %.1e "
                   "would have been seen to\n",
              i, rows[i].of.watched_periods, rows[i].of.escape_rate_bound);
}

static void print_statistics(FILE *out, const pendres_basin_statistics *s, pendres_basin_end by)
{
  if (!(s->boundary_boxes > 0.0)) {
    if (isnan(s->boundary_boxes)) fprintf(out, "too few states for statistics of the boundary\n");
    else
      fprintf(out, "no boundary between basins of different %s\n",
              by == PENDRES_BASIN_BY_WELL ? "wells" : "attractors");
    return;
  }
  fprintf(out, "boundary basin entropy %.4f +- %.4f, uncertainty exponent ", s->boundary_entropy,
          s->boundary_entropy_error);
  if (isnan(s->uncertainty_exponent))
    fprintf(out, "unknown: boundary met too rarely, or nearly everywhere\n");
  else fprintf(out, "%.3f +- %.3f\n", s->uncertainty_exponent, s->uncertainty_exponent_error);
}

static void print_table(const basins *b, const pendres_basin_statistics *s, size_t n,
                        const row *rows)
{
  FILE *out = b->run->table;
  const scene_table table = {SCENE_ROWS(rows, n)};
  SCENE_PRINT(out, &table, n, cells, NULL);
  if (s->escaped > 0)
    fprintf(out, "%-13s%83s%.6f +- %.0e\n", "   escape", "", s->escape_fraction,
            s->escape_fraction_error);
  print_open(out, n, rows);
  fprintf(out, "%zu states, %zu unresolved, %zu uncertain\n", s->states, b->unresolved,
          s->uncertain_states);
  if (b->d->basins.refine)
    fprintf(out,
            "integrated %zu (%.2f %%), filled in and verified %zu of them: %zu wrong%s,\n"
            "of %zu that are filled in at most %.0f are wrong with a confidence of 95 %%\n",
            b->integrated, 100.0 * (double)b->integrated / (double)s->states, b->verified,
            b->missed, b->missed > 0 ? " and put right" : "", b->filled,
            ceil(pendres_basin_plan_suspected(b->filled, b->clean)));
  basins_print_wells(b, out);
  if (b->d->basins.statistics) print_statistics(out, s, b->grid.by);
  if (b->curve != NULL) fprintf(out, "boundary as a curve: %s\n", b->curve);
}

void basins_write_results(basins *b)
{
  if (!scene_going(b->run)) return;
  const size_t n = pendres_attractors_count(b->set);
  const int statistics = b->d->basins.statistics;
  pendres_basin_statistics s;
  double *fraction = scene_array(b->run, 2 * n, sizeof *fraction);
  row *rows = scene_array(b->run, n, sizeof *rows);
  if (rows == NULL) return;
  if (pendres_basin_sums_result(b->sums, &s, fraction, fraction + n) != PENDRES_OK) {
    scene_fail(b->run, PENDRES_INVALID_ARGUMENT, "there are no states");
    return;
  }
  b->uncertain = s.uncertain_states;
  make_rows(b, fraction, fraction + n, rows);
  if (statistics) look_closer(b, &s);
  write_attractors(b, n, rows);
  write_cut(b);
  write_counts(b);
  write_escapes(b, &s);
  if (statistics) write_statistics(b, &s);
  if (b->d->basins.boundary) basins_write_boundary(b);
  write_paper(b);
  if (scene_prints(b->run)) print_table(b, &s, n, rows);
}
