/*
 * response_noise.c -- loop area, phase lag and amplitude against temperature.
 *
 * There is one task for each temperature, damping and drive period: see pendres_response_add_noise.
 */
#include "scenes/response_noise.h"

#include <stdlib.h>

#include "scenes/check.h"
#include "scenes/columns.h"
#include "scenes/failed.h"

/* A point, as a task finds it. */
typedef struct point {
  pendres_response_noise response;
  scene_verdict verdict;
} point;

typedef struct work {
  const deck *d;
  const scene_response_grid *grid;
  size_t temperatures;
  pendres_response_noise *points; /* [temperature][damping][drive] */
  scene_failures failed;          /* the same; of what noise adds alone */
} work;

static pendres_status compute(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const work *w = arg;
  const size_t plane = w->grid->dampings * w->grid->drives;
  const double temperature = w->d->axis[DECK_AXIS_TEMPERATURE].value[task / plane];
  deck_axis_id axis[3] = {DECK_AXIS_TEMPERATURE};
  point *p = out->data;
  scene_plane(w->d, &axis[1]);
  scene_point_begin(out, w->d, task, 1, 3, axis);
  pendres_response still;
  pendres_status status = scene_temporary_get(w->grid->points, task % plane, 1, &still,
                                              out->message,
                                              sizeof out->message);
  if (status != PENDRES_OK) return status;
  status =
    pendres_response_add_noise(ctx, &still, temperature, (size_t)w->d->noise.trajectories,
                               (long)w->d->noise.periods, &p->response);
  return scene_verdict_point(&p->verdict, status, pendres_context_message(ctx), out);
}

static int check(const void *arg, size_t task, const farm_record *in)
{
  const point *p = in->data;
  (void)arg;
  (void)task;
  return in->size == sizeof *p && p->response.steps_per_period >= 0 &&
         scene_check_verdict(&p->verdict);
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  const point *p = in->data;
  w->points[task] = p->response;
  scene_failures_take(&w->failed, task, &p->verdict);
  return PENDRES_OK;
}

/* ---- results ------------------------------------------------------------------------------- */

#define MEAN(label, field, words, unit)                                                       \
  {.name = #label, .long_name = words, .units = unit,                                         \
   .value = offsetof(pendres_response_noise, field.value),                                    \
   .error = offsetof(pendres_response_noise, field.error)}
#define BIAS(label, field, words, unit)                                                       \
  {.name = "bias_" #label, .long_name = "bias by finite steps: " words, .units = unit,        \
   .value = offsetof(pendres_response_noise, field.bias),                                     \
   .error = offsetof(pendres_response_noise, field.bias_error)}

static const scene_column results[] = {
  MEAN(mean_loop_area, loop_area, "mean loop area of the ensemble", "1"),
  BIAS(loop_area, loop_area, "mean loop area of the ensemble", "1"),
  MEAN(first_harmonic_amplitude, amplitude, "amplitude of the mean loop's first harmonic", "rad"),
  BIAS(first_harmonic_amplitude, amplitude, "amplitude of the mean loop's first harmonic", "rad"),
  MEAN(phase_lag, phase_lag, "phase lag of the ensemble-averaged loop", "rad"),
  BIAS(phase_lag, phase_lag, "phase lag of the ensemble-averaged loop", "rad"),
  MEAN(mean_power, mean_power, "mean power taken up from the drive", "1"),
  BIAS(mean_power, mean_power, "mean power taken up from the drive", "1"),
};

static const scene_column steps = {
  .name = "noise_steps_per_period", .long_name = "steps a drive period of the noisy integrator",
  .type = SCENE_NUMBER, .value = offsetof(pendres_response_noise, steps_per_period)};

/* The columns of results that exist only without noise. */
#define STILL(field, words, unit)                                                             \
  {.name = #field, .long_name = words, .units = unit, .comment = "at temperature 0 alone",    \
   .value = offsetof(scene_response_row, field),                                              \
   .error = offsetof(scene_response_row, field##_error)}
static const scene_column still[] = {
  STILL(mean_loop_amplitude, "amplitude of the ensemble-averaged loop", "rad"),
  STILL(mean_amplitude, "mean of the members' amplitudes", "rad"),
  STILL(sa_fraction, "share of the members on the small-amplitude state", "1"),
  STILL(la_fraction, "share of the members on the large-amplitude state", "1"),
};

static pendres_status write_still(scene_run *run, const work *w, const scene_table *table)
{
  const size_t plane = w->grid->dampings * w->grid->drives;
  const double *temperature = w->d->axis[DECK_AXIS_TEMPERATURE].value;
  scene_response_row *rows = malloc(table->n * sizeof *rows);
  int8_t *warm = malloc(table->n);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (rows == NULL || warm == NULL) {
    (void)scene_fail(run, status, "out of memory for %zu results", table->n);
    goto done;
  }
  char why[200];
  status = scene_temporary_get(w->grid->rows, 0, plane, rows, why, sizeof why);
  if (status != PENDRES_OK) {
    (void)scene_fail(run, status, "%s", why);
    goto done;
  }
  for (size_t i = 0; i < table->n; i++) {
    rows[i] = rows[i % plane];
    warm[i] = temperature[i / plane] > 0.0;
  }
  scene_table without = *table;
  without.stride = sizeof *rows;
  without.rows = rows;
  without.missing = warm;
  status = SCENE_WRITE(run, &without, still);
done:
  free(rows);
  free(warm);
  return status;
}

static pendres_status write_results(scene_run *run, const work *w)
{
  const scene_table table = {.dimensions = {"temperature", w->grid->damping, w->grid->drive},
                             .n = w->temperatures * w->grid->dampings * w->grid->drives,
                             .stride = sizeof *w->points, .rows = w->points};
  pendres_status status = scene_dimension(run, "", DECK_AXIS_TEMPERATURE);
  if (status == PENDRES_OK) status = SCENE_WRITE(run, &table, results);
  if (status == PENDRES_OK) status = write_still(run, w, &table);
  return status == PENDRES_OK ? scene_columns_write(run, &table, 1, &steps) : status;
}

/* Along the temperatures, at the first damping and the middle of the drive axis. */
static void print_table(FILE *out, const work *w)
{
  const size_t plane = w->grid->dampings * w->grid->drives, at = w->grid->drives / 2;
  pendres_response still;
  char why[200];
  if (scene_temporary_get(w->grid->points, at, 1, &still, why, sizeof why) != PENDRES_OK) return;
  fprintf(out, "damping %g, drive period %g:\n", still.pendulum.damping,
          2.0 * PENDRES_PI / still.pendulum.drive_frequency);
  fprintf(out, "temperature  loop area     +-        phase lag   +-        amplitude   +-\n");
  for (size_t i = 0; i < w->temperatures; i++) {
    const pendres_response_noise *q = &w->points[i * plane + at];
    fprintf(out, "%-12g %-13.8f %-9.2g %-11.7f %-9.2g %-11.7f %.2g\n",
            w->d->axis[DECK_AXIS_TEMPERATURE].value[i], q->loop_area.value, q->loop_area.error,
            q->phase_lag.value, q->phase_lag.error, q->amplitude.value, q->amplitude.error);
  }
}

static pendres_status write_failed(scene_run *run, const work *w)
{
  deck_axis_id axes[] = { DECK_AXIS_TEMPERATURE, DECK_AXIS_DAMPING, DECK_AXIS_DRIVE_FREQUENCY };
  scene_plane(w->d, axes + 1);
  return scene_failures_write(run, &w->failed, "noise_failed", "response with noise", 3, axes);
}

pendres_status scene_response_write_noise(scene_run *run, const scene_response_grid *grid)
{
  work w = { .d = run->deck, .grid = grid,
             .temperatures = run->deck->axis[DECK_AXIS_TEMPERATURE].count };
  const size_t n = w.temperatures * grid->dampings * grid->drives;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  w.points = calloc(n, sizeof *w.points);
  if (w.points == NULL || scene_failures_create(run, n, &w.failed) != PENDRES_OK) {
    free(w.points);
    return scene_fail(run, status, "out of memory for %zu points", n);
  }
  status = scene_compute(run, &(farm_stage){ .what = "points with noise", .last = 1, .tasks = n,
                                             .task = compute, .record_size = sizeof(point),
                                             .check = check, .collect = collect, .arg = &w });
  if (status == PENDRES_OK) status = write_results(run, &w);
  if (status == PENDRES_OK) status = write_failed(run, &w);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &w);
  free(w.points);
  return status;
}
