/*
 * response_noise.c -- loop area, phase lag and amplitude against temperature.
 *
 * There is one task for each temperature, damping and drive period: see
 * pendres_response_noise_find.
 */
#include "scenes/response_noise.h"

typedef struct work {
  const deck *d;
  const scene_response_grid *grid;
  size_t plane;        /* points at each temperature */
  scene_points points; /* [temperature][damping][drive] of pendres_response_noise */
} work;

static pendres_status compute(const scene_some *some)
{
  const work *w = some->of->arg;
  const double temperature = w->d->axis[DECK_AXIS_TEMPERATURE].value[some->first / w->plane];
  pendres_response still;
  const pendres_status status =
    scene_temporary_get(w->grid->kept, some->first % w->plane, 1, &still, some->message,
                        SCENE_MESSAGE);
  if (status != PENDRES_OK) return status;
  return pendres_response_noise_find(some->ctx, &still, temperature,
                                     (size_t)w->d->noise.trajectories, (long)w->d->noise.periods,
                                     some->rows);
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

static void write_still(scene_run *run, const work *w, const scene_table *table)
{
  const double *temperature = w->d->axis[DECK_AXIS_TEMPERATURE].value;
  scene_response_row *rows = scene_array(run, table->n, sizeof *rows);
  if (rows == NULL) return;
  scene_temporary_read(run, w->grid->rows, 0, w->plane, rows);
  for (size_t i = table->n; i-- > 0;) {
    rows[i] = rows[i % w->plane];
    if (temperature[i / w->plane] > 0.0) SCENE_BLANK(still, &rows[i]);
  }
  scene_table without = *table;
  without.stride = sizeof *rows;
  without.rows = rows;
  SCENE_WRITE(run, &without, still);
}

static void write_results(scene_run *run, const work *w)
{
  const scene_table table = scene_points_table(&w->points, w->d);
  scene_dimension(run, "", DECK_AXIS_TEMPERATURE);
  scene_points_write(run, &w->points);
  write_still(run, w, &table);
  scene_columns_write(run, &table, 1, &steps);
  scene_points_write_failed(run, &w->points, "noise_failed",
                            "why there is no whole result for the response with noise");
}

/* Along the temperatures, at the first damping and the middle of the drive axis. */
static void print_table(scene_run *run, const work *w)
{
  FILE *out = run->table;
  const size_t drives = w->d->axis[w->points.axis[2]].count, at = drives / 2;
  const pendres_response_noise *points = w->points.rows;
  pendres_response still;
  scene_temporary_read(run, w->grid->kept, at, 1, &still);
  if (!scene_prints(run)) return;
  fprintf(out, "damping %g, drive period %g:\n", still.pendulum.damping,
          2.0 * PENDRES_PI / still.pendulum.drive_frequency);
  fprintf(out, "temperature  loop area     +-        phase lag   +-        amplitude   +-\n");
  for (size_t i = at; i < w->points.n; i += w->plane) {
    const pendres_response_noise *q = &points[i];
    fprintf(out, "%-12g %-13.8f %-9.2g %-11.7f %-9.2g %-11.7f %.2g\n",
            w->d->axis[DECK_AXIS_TEMPERATURE].value[i / w->plane], q->loop_area.value,
            q->loop_area.error, q->phase_lag.value, q->phase_lag.error, q->amplitude.value,
            q->amplitude.error);
  }
}

void scene_response_write_noise(scene_run *run, const scene_response_grid *grid)
{
  work w = {.d = run->deck, .grid = grid, .plane = grid->points->n,
            .points = {.size = sizeof(pendres_response_noise), .chunk = 1, .compute = compute,
                       SCENE_COLUMNS(results), .what = "response with noise", .arg = &w}};
  deck_axis_id axis[DECK_AXES + 1] = {DECK_AXIS_TEMPERATURE};
  for (int i = 0; i < grid->points->axes; i++) axis[1 + i] = grid->points->axis[i];
  scene_points_over(&w.points, run->deck, 1 + grid->points->axes, axis);
  SCENE_COMPUTE(run, &w.points, "points with noise", .last = 1);
  write_results(run, &w);
  print_table(run, &w);
}
