/*
 * free_oscillation.c -- the frequency of the undamped, undriven pendulum against its
 * amplitude, Fig. 1 of the paper: by the elliptic integral, by two approximations (eqs. 1.1 to
 * 1.5), and by integrating the equation of motion, which is a check from end to end.
 */
#include "scenes/check.h"
#include "scenes/columns.h"
#include "scenes/failed.h"

#include <math.h>
#include <stdlib.h>

/* Amplitudes a task takes: a block of the library. */
enum { CHUNK = 192, TABLE_ROWS = 13 };

/* A row of results. */
typedef struct row {
  double amplitude, frequency_exact, frequency_exact_error;
  double frequency_kittel, frequency_kittel_error, frequency_belendez, frequency_belendez_error;
  double frequency_integrated, frequency_integrated_error;
} row;

typedef struct work {
  const double *amplitude;
  size_t count;
  row *rows;
  scene_failures failed;
} work;

/* What a task finds. */
typedef struct record {
  double frequency[CHUNK], error[CHUNK];
  scene_verdict verdict[CHUNK];
} record;

static size_t count_of(const work *w, size_t task)
{
  const size_t left = w->count - task * CHUNK;
  return left < CHUNK ? left : CHUNK;
}

static pendres_status integrate(const void *arg, size_t task, pendres_context *ctx,
                                farm_record *out)
{
  const work *w = arg;
  record *r = out->data;
  const double *amplitude = w->amplitude + task * CHUNK;
  const size_t n = count_of(w, task);
  pendres_status status =
    pendres_free_frequency_integrate(ctx, n, amplitude, r->frequency, r->error);
  if (scene_failure_of(status) == SCENE_FAILURE_NONE) return status;
  /* Where several amplitudes fail together, each is computed alone. */
  status = PENDRES_OK;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    status =
      pendres_free_frequency_integrate(ctx, 1, &amplitude[i], &r->frequency[i], &r->error[i]);
    if (scene_failure_of(status) == SCENE_FAILURE_NONE) continue;
    r->frequency[i] = r->error[i] = NAN;
    status = scene_verdict_note(&r->verdict[i], status, pendres_context_message(ctx));
  }
  return status;
}

/* The three formulas, each with its rounding, beside the integration. */
static row row_of(double amplitude, double integrated, double error)
{
  static const double rounding = 4.5e-16;
  return (row){amplitude, pendres_free_frequency(amplitude),
               pendres_free_frequency_error(amplitude),
               pendres_free_frequency_kittel(amplitude), rounding,
               pendres_free_frequency_belendez(amplitude), rounding, integrated, error};
}

static int check(const void *arg, size_t task, const farm_record *in)
{
  const record *r = in->data;
  int good = in->size == sizeof *r;
  for (size_t i = 0; good && i < count_of(arg, task); i++)
    good = scene_check_verdict(&r->verdict[i]);
  return good;
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  const record *r = in->data;
  for (size_t i = 0; i < count_of(w, task); i++) {
    const size_t at = task * CHUNK + i;
    w->rows[at] = row_of(w->amplitude[at], r->frequency[i], r->error[i]);
    scene_failures_take(&w->failed, at, &r->verdict[i]);
  }
  return PENDRES_OK;
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

static void tabulate(FILE *out, const scene_table *table, const row *rows)
{
  double largest = 0.0;
  for (size_t i = 0; i < table->n; i++)
    largest = fmax(largest, fabs(rows[i].frequency_integrated / rows[i].frequency_exact - 1.0));
  SCENE_PRINT(out, table, TABLE_ROWS, cells, NULL);
  fprintf(out, "largest relative difference of integrated and exact: %.1e\n", largest);
}

static pendres_status run(scene_run *r)
{
  const deck_axis *axis = &r->deck->axis[DECK_AXIS_AMPLITUDE];
  const size_t n = axis->count;
  pendres_status status = PENDRES_OK;
  work w = { .amplitude = axis->value, .count = n, .rows = malloc(n * sizeof *w.rows) };
  if (w.rows == NULL || scene_failures_create(n, &w.failed) != PENDRES_OK) {
    free(w.rows);
    return scene_fail(r, PENDRES_OUT_OF_MEMORY, "out of memory for %zu amplitudes", n);
  }

  status = scene_compute(r, &(farm_stage){ .what = "blocks of amplitudes", .last = 1,
                                           .tasks = (n + CHUNK - 1) / CHUNK, .task = integrate,
                                           .record_size = sizeof(record), .check = check,
                                           .collect = collect,
                                           .arg = &w });
  const scene_table table = { .dimensions = { "amplitude" }, .n = n, .stride = sizeof *w.rows,
                              .rows = w.rows };
  if (status == PENDRES_OK) status = scene_dimension(r, NULL, DECK_AXIS_AMPLITUDE);
  if (status == PENDRES_OK)
    status = SCENE_WRITE(r, &table, columns);
  static const deck_axis_id axes[] = { DECK_AXIS_AMPLITUDE };
  if (status == PENDRES_OK)
    status = scene_failures_write(r, &w.failed, "failed", "frequency", 1, axes);
  if (status == PENDRES_OK && r->table != NULL) tabulate(r->table, &table, w.rows);
  scene_failures_free(&w.failed);
  free(w.rows);
  return status;
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
  .references = "D. Kharkongor and M. C. Mahato, Resonance oscillation of a damped driven simple "
                "pendulum, Fig. 1",
  .size = {26e3, 40.0, 100.0, 1.0, 1.0, 1e-5},
  .describe = describe,
  .run = run,
};
