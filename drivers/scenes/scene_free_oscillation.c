/*
 * scene_free_oscillation.c -- frequency of the undamped, undriven pendulum against its amplitude:
 * Fig. 1 of the paper. The elliptic integral and two approximations (eqs. 1.1 to 1.5), and beside
 * them the frequency found by integrating the equation of motion: a check from end to end.
 */
#include "scenes/scene_failed.h"

#include <math.h>
#include <stdlib.h>

/* Amplitudes a task takes: a block of the library. */
enum { CHUNK = 192, TABLE_ROWS = 12 };

typedef struct work {
  const double *amplitude;
  size_t count;
  double *frequency, *error;
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
  /* What cannot be had of several at a time is had, or not, of each. */
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

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  const record *r = in->data;
  for (size_t i = 0; i < count_of(w, task); i++) {
    w->frequency[task * CHUNK + i] = r->frequency[i];
    w->error[task * CHUNK + i] = r->error[i];
    scene_failures_take(&w->failed, task * CHUNK + i, &r->verdict[i]);
  }
  return PENDRES_OK;
}

/*
 * Rounding of the elliptic integral: some units in the last place, and the last bit of pi where
 * the amplitude comes near to it (its derivative there is 1 / ((pi - a) K) of the value).
 */
static double exact_error(double amplitude, double frequency)
{
  const double eps = 2.220446049250313e-16;
  const double k = 0.5 * PENDRES_PI / frequency;
  return frequency * eps * (4.0 + 1.0 / ((PENDRES_PI - amplitude) * k));
}

static pendres_status put(scene_run *run, const char *name, const char *long_name,
                          const double *value, const double *error, size_t n)
{
  const pendres_store_spec spec = { .name = name, .long_name = long_name,
                                    .dimensions = { "amplitude" } };
  const pendres_status status = pendres_store_put_result(run->store, &spec, value, error, n);
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

/* The three formulas, each with its rounding. */
static pendres_status put_formulas(scene_run *run, const work *w, double *value, double *error)
{
  static const struct {
    const char *name, *words;
    double (*formula)(double amplitude);
  } formulas[] = {
    { "frequency_exact", "frequency by the elliptic integral", pendres_free_frequency },
    { "frequency_kittel", "frequency by Kittel's approximation", pendres_free_frequency_kittel },
    { "frequency_belendez", "frequency by the approximation of Belendez et al.",
      pendres_free_frequency_belendez },
  };
  pendres_status status = scene_dimension(run, NULL, DECK_AXIS_AMPLITUDE);
  for (size_t k = 0; k < sizeof formulas / sizeof *formulas && status == PENDRES_OK; k++) {
    for (size_t i = 0; i < w->count; i++) {
      value[i] = formulas[k].formula(w->amplitude[i]);
      error[i] = k == 0 ? exact_error(w->amplitude[i], value[i]) : 4.5e-16;
    }
    status = put(run, formulas[k].name, formulas[k].words, value, error, w->count);
  }
  return status;
}

static void tabulate(FILE *out, const work *w)
{
  double largest = 0.0;
  if (out == NULL) return;
  for (size_t i = 0; i < w->count; i++)
    largest = fmax(largest, fabs(w->frequency[i] / pendres_free_frequency(w->amplitude[i]) - 1.0));
  fprintf(out, "%10s %18s %10s %18s %10s %10s\n", "amplitude", "integrated", "error", "exact",
          "Kittel", "Belendez");
  const size_t step = w->count > TABLE_ROWS ? (w->count - 1) / (TABLE_ROWS - 1) : 1;
  for (size_t i = 0; i < w->count; i += step)
    fprintf(out, "%10.6f %18.14f %10.1e %18.14f %10.6f %10.6f\n", w->amplitude[i], w->frequency[i],
            w->error[i], pendres_free_frequency(w->amplitude[i]),
            pendres_free_frequency_kittel(w->amplitude[i]),
            pendres_free_frequency_belendez(w->amplitude[i]));
  fprintf(out, "largest relative difference of integrated and exact: %.1e\n", largest);
}

static pendres_status run(scene_run *r)
{
  const deck_axis *axis = &r->deck->axis[DECK_AXIS_AMPLITUDE];
  const size_t n = axis->count;
  pendres_status status = PENDRES_OK;
  double *memory = malloc(4 * n * sizeof *memory);
  if (memory == NULL)
    return scene_fail(r, PENDRES_OUT_OF_MEMORY, "out of memory for %zu amplitudes", n);
  work w = { .amplitude = axis->value, .count = n, .frequency = memory, .error = memory + n };
  if (scene_failures_create(n, &w.failed) != PENDRES_OK) {
    free(memory);
    return scene_fail(r, PENDRES_OUT_OF_MEMORY, "out of memory for %zu amplitudes", n);
  }

  status = scene_compute(r, &(farm_stage){ .what = "blocks of amplitudes", .last = 1,
                                           .tasks = (n + CHUNK - 1) / CHUNK, .task = integrate,
                                           .record_size = sizeof(record), .collect = collect,
                                           .arg = &w });
  if (status == PENDRES_OK) status = put_formulas(r, &w, memory + 2 * n, memory + 3 * n);
  if (status == PENDRES_OK)
    status = put(r, "frequency_integrated", "frequency by integration of the equation of motion",
                 w.frequency, w.error, n);
  static const deck_axis_id axes[] = { DECK_AXIS_AMPLITUDE };
  if (status == PENDRES_OK)
    status = scene_failures_write(r, &w.failed, "failed", "frequency", 1, axes);
  if (status == PENDRES_OK) tabulate(r->table, &w);
  scene_failures_free(&w.failed);
  free(memory);
  return status;
}

static void plan(const deck *d, FILE *out)
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
  .plan = plan,
  .run = run,
};
