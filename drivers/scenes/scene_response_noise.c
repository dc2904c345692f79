/*
 * scene_response_noise.c -- loop area, phase lag and amplitude against temperature.
 *
 * One task a temperature, damping and drive period: see pendres_response_add_noise.
 */
#include "scenes/scene_response_noise.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene_failed.h"

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
  point *p = out->data;
  const pendres_status status = pendres_response_add_noise(
    ctx, &w->grid->points[task % plane], temperature, (size_t)w->d->noise.trajectories,
    (long)w->d->noise.periods, &p->response);
  return scene_verdict_note(&p->verdict, status, pendres_context_message(ctx));
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

static const struct {
  const char *name, *bias, *long_name, *units;
  size_t of; /* where it stands in a response */
} results[] = {
  { "mean_loop_area", "bias_loop_area", "mean loop area of the ensemble", "1",
    offsetof(pendres_response_noise, loop_area) },
  { "first_harmonic_amplitude", "bias_first_harmonic_amplitude",
    "amplitude of the mean loop's first harmonic", "rad", offsetof(pendres_response_noise, amplitude) },
  { "phase_lag", "bias_phase_lag", "phase lag of the ensemble-averaged loop", "rad",
    offsetof(pendres_response_noise, phase_lag) },
  { "mean_power", "bias_mean_power", "mean power taken up from the drive", "1",
    offsetof(pendres_response_noise, mean_power) },
};

/* What is known without noise alone. */
#define STILL(name, text, unit) \
  { #name, text, unit, offsetof(pendres_response, name), offsetof(pendres_response, name##_error) }
static const struct {
  const char *name, *long_name, *units;
  size_t value, error;
} still[] = {
  STILL(mean_loop_amplitude, "amplitude of the ensemble-averaged loop", "rad"),
  STILL(mean_amplitude, "mean of the members' amplitudes", "rad"),
  STILL(sa_fraction, "share of the members on the small-amplitude state", "1"),
  STILL(la_fraction, "share of the members on the large-amplitude state", "1"),
};

static pendres_status put(scene_run *run, const work *w, const char *name, const char *long_name,
                          const char *units, const char *comment, const double *value,
                          const double *error)
{
  const pendres_store_spec spec = {
    .name = name, .dimensions = { "temperature", w->grid->damping, w->grid->drive },
    .long_name = long_name, .units = units, .comment = comment };
  return pendres_store_put_result(run->store, &spec, value, error,
                                  w->temperatures * w->grid->dampings * w->grid->drives);
}

static pendres_status write_noisy(scene_run *run, const work *w, double *value, double *error)
{
  const size_t plane = w->grid->dampings * w->grid->drives, n = w->temperatures * plane;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < 2 * sizeof results / sizeof results[0] && status == PENDRES_OK; k++) {
    const size_t r = k / 2;
    const int bias = k % 2 == 1;
    char words[120];
    for (size_t i = 0; i < n; i++) {
      pendres_response_mean q;
      memcpy(&q, (const char *)&w->points[i] + results[r].of, sizeof q);
      value[i] = bias ? q.bias : q.value;
      error[i] = bias ? q.bias_error : q.error;
    }
    snprintf(words, sizeof words, bias ? "bias by finite steps: %s" : "%s", results[r].long_name);
    status = put(run, w, bias ? results[r].bias : results[r].name, words, results[r].units, NULL,
                 value, error);
  }
  return status;
}

static double field(const pendres_response *r, size_t offset)
{
  double value;
  memcpy(&value, (const char *)r + offset, sizeof value);
  return value;
}

static pendres_status write_still(scene_run *run, const work *w, double *value, double *error)
{
  const size_t plane = w->grid->dampings * w->grid->drives, n = w->temperatures * plane;
  const double *temperature = w->d->axis[DECK_AXIS_TEMPERATURE].value;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < sizeof still / sizeof still[0] && status == PENDRES_OK; k++) {
    for (size_t i = 0; i < n; i++) {
      const int cold = !(temperature[i / plane] > 0.0);
      value[i] = cold ? field(&w->grid->points[i % plane], still[k].value) : NAN;
      error[i] = cold ? field(&w->grid->points[i % plane], still[k].error) : NAN;
    }
    status = put(run, w, still[k].name, still[k].long_name, still[k].units,
                 "at temperature 0 alone", value, error);
  }
  return status;
}

static pendres_status write_results(scene_run *run, const work *w)
{
  const size_t n = w->temperatures * w->grid->dampings * w->grid->drives;
  const pendres_store_spec steps = {
    .name = "noise_steps_per_period", .type = PENDRES_STORE_INT32,
    .dimensions = { "temperature", w->grid->damping, w->grid->drive },
    .long_name = "steps a drive period of the noisy integrator" };
  double *value = malloc(2 * n * sizeof *value);
  int32_t *steps_of = malloc(n * sizeof *steps_of);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (value == NULL || steps_of == NULL) {
    (void)scene_fail(run, status, "out of memory for %zu results", n);
    goto done;
  }
  for (size_t i = 0; i < n; i++) steps_of[i] = w->points[i].steps_per_period;
  status = scene_dimension(run, "", DECK_AXIS_TEMPERATURE);
  if (status == PENDRES_OK) status = write_noisy(run, w, value, value + n);
  if (status == PENDRES_OK) status = write_still(run, w, value, value + n);
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &steps, steps_of, n);
  if (status != PENDRES_OK) (void)scene_store_failed(run, status);
done:
  free(value);
  free(steps_of);
  return status;
}

/* Along the temperatures, at the first damping and the middle of the drive axis. */
static void print_table(FILE *out, const work *w)
{
  const size_t plane = w->grid->dampings * w->grid->drives, at = w->grid->drives / 2;
  const pendres_pendulum *p = &w->grid->points[at].pendulum;
  fprintf(out, "damping %g, drive period %g:\n", p->damping, 2.0 * PENDRES_PI / p->drive_frequency);
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
  if (w.points == NULL || scene_failures_create(n, &w.failed) != PENDRES_OK) {
    free(w.points);
    return scene_fail(run, status, "out of memory for %zu points", n);
  }
  status = scene_compute(run, &(farm_stage){ .what = "points with noise", .last = 1, .tasks = n,
                                             .task = compute, .record_size = sizeof(point),
                                             .collect = collect, .arg = &w });
  if (status == PENDRES_OK) status = write_results(run, &w);
  if (status == PENDRES_OK) status = write_failed(run, &w);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &w);
  scene_failures_free(&w.failed);
  free(w.points);
  return status;
}
