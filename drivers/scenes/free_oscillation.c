/*
 * free_oscillation.c -- the frequency without damping and drive against the amplitude. Of the plain
 * pendulum, Fig. 1 of the paper: by the elliptic integral, by two approximations (eqs. 1.1 to 1.5),
 * and by integrating the equation of motion, which is a check from end to end. Of every other force
 * by quadrature of the period, with the turning points.
 */
#include "scenes/points.h"

#include <math.h>

#include <pendres/free.h>

enum { TABLE_ROWS = 13 };

/* A row of results; those of the other forces are blank for the plain pendulum, and these for the
   others. */
typedef struct row {
  double amplitude, frequency_exact, frequency_exact_error;
  double frequency_kittel, frequency_kittel_error, frequency_belendez, frequency_belendez_error;
  double frequency_integrated, frequency_integrated_error;
  double frequency, frequency_error, turning_point_low, turning_point_high;
  double turning_point_error; /* of both */
} row;

/* ---- the plain pendulum ---- */

/* The three formulas, each with its rounding, beside the integration. */
static row row_of(double amplitude, double integrated, double error)
{
  static const double rounding = 4.5e-16;
  pendres_free f;
  pendres_free_get(amplitude, &f);
  return (row){.amplitude = amplitude, .frequency_exact = f.frequency,
               .frequency_exact_error = f.frequency_error, .frequency_kittel = f.kittel,
               .frequency_kittel_error = rounding, .frequency_belendez = f.belendez,
               .frequency_belendez_error = rounding, .frequency_integrated = integrated,
               .frequency_integrated_error = error};
}

static pendres_status compute_plain(const scene_some *some, const double *amplitude)
{
  double frequency[SCENE_PENDULUMS], error[SCENE_PENDULUMS];
  row *rows = some->rows;
  const pendres_status status =
    pendres_free_find(some->ctx, some->n, amplitude, frequency, error);
  for (size_t i = 0; i < some->n && status == PENDRES_OK; i++)
    rows[i] = row_of(amplitude[i], frequency[i], error[i]);
  return status;
}

/* ---- any force ---- */

static pendres_status compute_force(const scene_some *some, const double *amplitude)
{
  const deck *d = some->of->arg;
  pendres_pendulum p[SCENE_PENDULUMS];
  pendres_free_oscillation free[SCENE_PENDULUMS];
  pendres_status outcome[SCENE_PENDULUMS];
  row *rows = some->rows;
  for (size_t i = 0; i < some->n; i++) {
    p[i] = d->pendulum;
    p[i].damping = p[i].drive_amplitude = 0.0;
  }
  pendres_status status =
    pendres_free_oscillation_find(some->ctx, some->n, p, amplitude, free, outcome);
  for (size_t i = 0; i < some->n && status == PENDRES_OK; i++) {
    rows[i].amplitude = amplitude[i];
    rows[i].frequency = free[i].frequency;
    rows[i].frequency_error = free[i].frequency_error;
    rows[i].turning_point_low = free[i].low;
    rows[i].turning_point_high = free[i].high;
    rows[i].turning_point_error = free[i].turn_error;
    const char *none = "no oscillation has this amplitude, or it is that of a separatrix";
    status = scene_mark_status(some, i, outcome[i],
                               outcome[i] != PENDRES_NOT_FOUND ? NULL : none);
  }
  return status;
}

static pendres_status compute(const scene_some *some)
{
  const deck *d = some->of->arg;
  const double *amplitude = d->axis[DECK_AXIS_AMPLITUDE].value + some->first;
  return deck_is_plain(d) ? compute_plain(some, amplitude) : compute_force(some, amplitude);
}

static void leave_out(const scene_points *p, size_t point, void *out)
{
  const deck *d = p->arg;
  const double amplitude = d->axis[DECK_AXIS_AMPLITUDE].value[point];
  if (deck_is_plain(d)) *(row *)out = row_of(amplitude, NAN, NAN);
  else ((row *)out)->amplitude = amplitude;
}

/* ---- results ---- */

static int is_other(const deck *d)
{
  return !deck_is_plain(d);
}

#define PLAIN(field, words) \
  {SCENE_AS(#field, row, field, words, "frequency"), .when = deck_is_plain}
#define TURNING(field, words) \
  {SCENE_TYPED(SCENE_REAL, #field, row, field, words), .quantity = "x", .when = is_other, \
   .error = offsetof(row, turning_point_error)}

static const scene_column columns[] = {
  PLAIN(frequency_exact, "frequency by the elliptic integral"),
  PLAIN(frequency_kittel, "frequency by Kittel's approximation"),
  PLAIN(frequency_belendez, "frequency by the approximation of Belendez et al."),
  PLAIN(frequency_integrated, "frequency by integration of the equation of motion"),
  {SCENE_AS("frequency", row, frequency, "frequency of the free oscillation, by quadrature", NULL),
   .when = is_other},
  TURNING(turning_point_low, "lowest x of the free oscillation"),
  TURNING(turning_point_high, "highest x of the free oscillation"),
};

static const scene_cell cells[] = {
  SCENE_CELL(row, amplitude, " amplitude", "%10.6f"),
  SCENE_CELL(row, frequency_integrated, "         integrated", " %18.14f"),
  SCENE_CELL(row, frequency_integrated_error, "      error", " %10.1e"),
  SCENE_CELL(row, frequency_exact, "              exact", " %18.14f"),
  SCENE_CELL(row, frequency_kittel, "     Kittel", " %10.6f"),
  SCENE_CELL(row, frequency_belendez, "   Belendez", " %10.6f"),
};

static const scene_cell cells_of_force[] = {
  SCENE_CELL(row, amplitude, "   amplitude", "%12g"),
  SCENE_CELL(row, frequency, "         frequency", " %18.14g"),
  SCENE_CELL(row, frequency_error, "      error", " %10.1e"),
  SCENE_CELL(row, turning_point_low, "         from", " %12.6g"),
  SCENE_CELL(row, turning_point_high, "           to", " %12.6g"),
};

static void tabulate(FILE *out, const scene_table *table)
{
  const row *rows = table->rows;
  double largest = 0.0;
  for (size_t i = 0; i < table->n; i++)
    largest = fmax(largest, fabs(rows[i].frequency_integrated / rows[i].frequency_exact - 1.0));
  SCENE_PRINT(out, table, TABLE_ROWS, cells, NULL);
  fprintf(out, "largest relative difference of integrated and exact: %.1e\n", largest);
}

static pendres_status run_scene(scene_run *run)
{
  static const deck_axis_id axis[] = {DECK_AXIS_AMPLITUDE};
  scene_points p = {.size = sizeof(row), .chunk = SCENE_PENDULUMS, .compute = compute,
                    .leave_out = leave_out, SCENE_COLUMNS(columns), .what = "frequency",
                    .arg = (void *)run->deck};
  scene_points_over(&p, run->deck, 1, axis);
  SCENE_COMPUTE(run, &p, "blocks of amplitudes", .last = 1);
  const scene_table table = scene_points_table(&p, run->deck);
  scene_dimension(run, NULL, DECK_AXIS_AMPLITUDE);
  scene_points_write(run, &p);
  scene_points_write_failed(run, &p, "failed",
                                  "why there is no whole result for the frequency");
  if (!scene_prints(run)) return run->status;
  if (deck_is_plain(run->deck)) tabulate(run->table, &table);
  else SCENE_PRINT(run->table, &table, TABLE_ROWS, cells_of_force, NULL);
  return run->status;
}

static void describe(const deck *d, FILE *out)
{
  const deck_axis *a = &d->axis[DECK_AXIS_AMPLITUDE];
  fprintf(out, "frequency of free oscillations at %zu amplitudes from %g to %g,\n", a->count,
          a->value[0], a->value[a->count - 1]);
  fprintf(out, deck_is_plain(d)
                 ? "by the elliptic integral, by two approximations and by integration\n"
                 : "by quadrature of the period\n");
}

const scene_kind scene_free_oscillation = {
  .kind = DECK_FREE_OSCILLATION,
  .figures = "Fig. 1",
  .size = {.head = 26e3, .point = 40.0, .memory = 100.0, .stages = 1.0, .after = 1.0,
           .seconds = 1e-5},
  .any_method = 1,
  .describe = describe,
  .run = run_scene,
};
