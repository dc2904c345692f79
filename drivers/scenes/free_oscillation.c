/*
 * free_oscillation.c -- the frequency of the undamped, undriven pendulum against its
 * amplitude, Fig. 1 of the paper: by the elliptic integral, by two approximations (eqs. 1.1 to
 * 1.5), and by integrating the equation of motion, which is a check from end to end.
 */
#include "scenes/points.h"

#include <math.h>

#include <pendres/free.h>

enum { TABLE_ROWS = 13 };

/* A row of results. */
typedef struct row {
  double amplitude, frequency_exact, frequency_exact_error;
  double frequency_kittel, frequency_kittel_error, frequency_belendez, frequency_belendez_error;
  double frequency_integrated, frequency_integrated_error;
} row;

/* The three formulas, each with its rounding, beside the integration. */
static row row_of(double amplitude, double integrated, double error)
{
  static const double rounding = 4.5e-16;
  pendres_free f;
  pendres_free_get(amplitude, &f);
  return (row){amplitude, f.frequency, f.frequency_error, f.kittel, rounding, f.belendez, rounding,
               integrated, error};
}

static pendres_status compute(const scene_some *some)
{
  const double *amplitude = (const double *)some->of->arg + some->first;
  double frequency[SCENE_PENDULUMS], error[SCENE_PENDULUMS];
  row *rows = some->rows;
  const pendres_status status =
    pendres_free_find(some->ctx, some->n, amplitude, frequency, error);
  for (size_t i = 0; i < some->n && status == PENDRES_OK; i++)
    rows[i] = row_of(amplitude[i], frequency[i], error[i]);
  return status;
}

static void leave_out(const scene_points *p, size_t point, void *out)
{
  *(row *)out = row_of(((const double *)p->arg)[point], NAN, NAN);
}

static const scene_column columns[] = {
  SCENE_COLUMN(row, frequency_exact, "frequency by the elliptic integral", NULL),
  SCENE_COLUMN(row, frequency_kittel, "frequency by Kittel's approximation", NULL),
  SCENE_COLUMN(row, frequency_belendez, "frequency by the approximation of Belendez et al.", NULL),
  SCENE_COLUMN(row, frequency_integrated, "frequency by integration of the equation of motion",
               NULL),
};

static const scene_cell cells[] = {
  SCENE_CELL(row, amplitude, " amplitude", "%10.6f"),
  SCENE_CELL(row, frequency_integrated, "         integrated", " %18.14f"),
  SCENE_CELL(row, frequency_integrated_error, "      error", " %10.1e"),
  SCENE_CELL(row, frequency_exact, "              exact", " %18.14f"),
  SCENE_CELL(row, frequency_kittel, "     Kittel", " %10.6f"),
  SCENE_CELL(row, frequency_belendez, "   Belendez", " %10.6f"),
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
                    .arg = run->deck->axis[DECK_AXIS_AMPLITUDE].value};
  scene_points_over(&p, run->deck, 1, axis);
  SCENE_COMPUTE(run, &p, "blocks of amplitudes", .last = 1);
  const scene_table table = scene_points_table(&p, run->deck);
  scene_dimension(run, NULL, DECK_AXIS_AMPLITUDE);
  scene_points_write(run, &p);
  scene_points_write_failed(run, &p, "failed",
                                  "why there is no whole result for the frequency");
  if (scene_prints(run)) tabulate(run->table, &table);
  return run->status;
}

static void describe(const deck *d, FILE *out)
{
  const deck_axis *a = &d->axis[DECK_AXIS_AMPLITUDE];
  fprintf(out, "frequency of the free pendulum at %zu amplitudes from %g to %g rad,\n", a->count,
          a->value[0], a->value[a->count - 1]);
  fprintf(out, "by the elliptic integral, by two approximations and by integration\n");
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
