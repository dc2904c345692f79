/*
 * scene_orbit.c -- one pendulum's orbit: position, velocity and drive over some drive periods, and
 * all that is measured on the closed orbit. Figs. 5 and 6 of the paper.
 *
 * The orbit is a named attractor of the parameter set (start = 'sa', 'la', or
 * '1', '2', ... by amplitude), or what a start at
 * x, v settles on, in the well where it settles. With transient = .true. the trajectory is
 * recorded from the start itself, and the measures are still those of the orbit it goes to.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene_along.h"
#include "scenes/scene_failed.h"

static const double eps = 2.220446049250313e-16;

enum {
  MULTIPLIERS = 2,
  WANDERING = 100 /* periods before a chaotic orbit is recorded */
};

/* What the task finds of the pendulum; in its record, the samples follow it: x, v and their errors,
   `room` of each. */
typedef struct found {
  pendres_label label;
  long well, settling_periods;   /* -1: no start to settle from */
  int closed;                    /* nonzero: there is a closed orbit */
  pendres_orbit orbit;
  double lyapunov, lyapunov_error;
  double drift, drift_error, watched_periods, escape_rate_bound; /* of chaos; NaN */
} found;

typedef struct work {
  const deck *d;
  pendres_pendulum pendulum;
  int transient;
  size_t points, room;               /* periods * samples, and one more */
  found found;
  double *x, *v, *x_error, *v_error; /* [room] */
} work;

static void place_samples(work *w, double *memory)
{
  w->x = memory;
  w->v = w->x + w->room;
  w->x_error = w->v + w->room;
  w->v_error = w->x_error + w->room;
}

/* ---- what the pendulum settles on ---------------------------------------------------------- */

static void keep_orbit(work *w, const pendres_attractor *a)
{
  w->found.label = a->label;
  w->found.closed = a->label != PENDRES_LABEL_CHAOTIC;
  w->found.orbit = a->orbit;
  w->found.lyapunov = a->lyapunov;
  w->found.lyapunov_error = a->lyapunov_error;
  w->found.drift = a->drift;
  w->found.drift_error = a->drift_error;
  w->found.watched_periods = a->watched_periods;
  w->found.escape_rate_bound = a->escape_rate_bound;
}

static pendres_status find_named(work *w, pendres_context *ctx, farm_record *out)
{
  pendres_attractor a;
  const pendres_status status = scene_along_named(ctx, &w->pendulum, w->d->orbit.start, &a,
                                                  out->message, sizeof out->message);
  if (status == PENDRES_OK) keep_orbit(w, &a);
  return status;
}

static pendres_status find_from_start(work *w, pendres_context *ctx)
{
  pendres_attractors *set = NULL;
  pendres_outcome outcome = { .label = PENDRES_LABEL_UNRESOLVED, .settling_periods = -1 };
  w->found.label = PENDRES_LABEL_UNRESOLVED;
  if (w->pendulum.damping == 0.0) return PENDRES_OK; /* nothing attracts without friction */
  const pendres_status status = pendres_settle(ctx, 1, &w->pendulum, &w->d->orbit.x,
                                               &w->d->orbit.v, &outcome, &set);
  if (status == PENDRES_OK && outcome.attractor >= 0) {
    const pendres_attractor *a = pendres_attractors_get(set, (size_t)outcome.attractor);
    if (a != NULL) keep_orbit(w, a);
    w->found.well = outcome.well;
    w->found.settling_periods = outcome.settling_periods;
  }
  pendres_attractors_free(set);
  return status;
}

/* ---- the trajectory ------------------------------------------------------------------------ */

/*
 * Samples of the closed orbit over the deck's periods. Their errors: samples with 1.4 times the
 * steps differ by the error of integration, and the orbit's own point carries its error around.
 */
static pendres_status sample_orbit(work *w, pendres_context *ctx)
{
  const size_t count = (size_t)w->d->orbit.samples, n = count * (size_t)w->found.orbit.period;
  const double point = 2.0 * (w->found.orbit.x_error + w->found.orbit.v_error);
  pendres_orbit finer = w->found.orbit;
  double *memory = malloc(4 * n * sizeof *memory);
  if (memory == NULL) return PENDRES_OUT_OF_MEMORY;
  double *x = memory, *v = x + n, *x2 = v + n, *v2 = x2 + n;
  finer.steps = (7 * finer.steps + 4) / 5;

  pendres_status status = pendres_orbit_sample(ctx, &w->found.orbit, (int)count, x, v);
  if (status == PENDRES_OK) status = pendres_orbit_sample(ctx, &finer, (int)count, x2, v2);
  for (size_t k = 0; k < w->points && status == PENDRES_OK; k++) {
    const size_t i = k % n;
    const double turns = (double)w->found.well + (double)w->found.orbit.winding * (double)(k / n);
    w->x[k] = x2[i] + 2.0 * PENDRES_PI * turns;
    w->v[k] = v2[i];
    w->x_error[k] = fabs(x[i] - x2[i]) + point + eps * fabs(w->x[k]);
    w->v_error[k] = fabs(v[i] - v2[i]) + point;
  }
  free(memory);
  return status;
}

static pendres_status sample_trajectory(work *w, pendres_context *ctx)
{
  double x = w->d->orbit.x, v = w->d->orbit.v, error = 0.0;
  const long periods = (long)w->d->orbit.periods;
  pendres_status status = PENDRES_OK;
  if (!w->transient) /* on the chaotic attractor */
    status = pendres_strobe_advance(ctx, 1, &w->pendulum, &x, &v, WANDERING, &error);
  if (status == PENDRES_OK)
    status = pendres_strobe_record(ctx, &w->pendulum, x, v, periods, (int)w->d->orbit.samples,
                                   w->x, w->v, w->x_error, w->v_error);
  return status;
}

static void no_samples(work *w)
{
  for (size_t k = 0; k < w->points; k++)
    w->x[k] = w->v[k] = w->x_error[k] = w->v_error[k] = NAN;
}

static pendres_status sample(work *w, pendres_context *ctx)
{
  if (w->transient || w->found.label == PENDRES_LABEL_CHAOTIC) return sample_trajectory(w, ctx);
  if (w->found.closed) return sample_orbit(w, ctx);
  no_samples(w);
  return PENDRES_OK;
}

static pendres_status compute(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  work w = *(const work *)arg;
  (void)task;
  const int named = w.d->orbit.start[0] != '\0';
  place_samples(&w, (double *)((found *)out->data + 1));
  pendres_status status = named ? find_named(&w, ctx, out) : find_from_start(&w, ctx);
  if (status == PENDRES_OK) status = sample(&w, ctx);
  *(found *)out->data = w.found;
  return status;
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  const found *f = in->data;
  (void)task;
  w->found = *f;
  memcpy(w->x, f + 1, 4 * w->room * sizeof *w->x);
  return PENDRES_OK;
}

/* ---- writing ------------------------------------------------------------------------------- */

/* A sample with the drive. */
typedef struct row {
  double drive_phase, drive_phase_error, x, x_error, v, v_error, drive, drive_error;
} row;

static const scene_column of_samples[] = {
  SCENE_COLUMN(row, drive_phase, "phase of the drive, omega t", "rad"),
  SCENE_COLUMN(row, x, "position", "rad"),
  SCENE_COLUMN(row, v, "velocity", "1"),
  SCENE_COLUMN(row, drive, "drive, F0 cos(omega t)", "1"),
};

static pendres_status put_samples(scene_run *run, const work *w)
{
  const size_t n = w->points;
  const double samples = (double)w->d->orbit.samples, f0 = w->pendulum.drive_amplitude;
  row *rows = malloc(n * sizeof *rows);
  if (rows == NULL)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu samples", n);
  for (size_t k = 0; k < n; k++) {
    const size_t within = k % (size_t)w->d->orbit.samples; /* no need for large arguments */
    const double phase = 2.0 * PENDRES_PI * (double)k / samples;
    const double drive = f0 * cos(2.0 * PENDRES_PI * (double)within / samples);
    rows[k] = (row){phase,   eps * phase,   w->x[k], w->x_error[k],
                    w->v[k], w->v_error[k], drive,   8.0 * eps * fabs(f0)};
  }
  const scene_table table = {.dimensions = {"sample"}, .n = n, .stride = sizeof *rows,
                             .rows = rows};
  pendres_status status =
    pendres_store_dimension(run->store, NULL, "sample", n, NULL, "number of the sample", "1");
  if (status != PENDRES_OK) (void)scene_store_failed(run, status);
  else
    status = scene_columns_write(run, &table, sizeof of_samples / sizeof *of_samples, of_samples);
  free(rows);
  return status;
}

static pendres_status put_scalars(scene_run *run, const work *w)
{
  const found *f = &w->found;
  const pendres_orbit *o = &f->orbit;
  const double waited = f->settling_periods >= 0 ? (double)f->settling_periods : NAN;
  const struct {
    const char *name, *long_name, *units;
    double value, error;
    enum { CLOSED, CHAOTIC, ALWAYS } of; /* closed orbits alone, chaos too, or whatever there is */
  } scalars[] = {
    { "loop_area", "area of the hysteresis loop, a drive cycle", "1", o->loop_area,
      o->loop_area_error, CHAOTIC },
    { "dissipation", "energy dissipated a drive cycle", "1", o->dissipation,
      o->dissipation_error, CHAOTIC },
    { "amplitude", "half peak to peak of the angle", "rad", o->amplitude, o->amplitude_error,
      CHAOTIC },
    { "first_harmonic_amplitude", "amplitude of the angle's first harmonic", "rad",
      o->first_harmonic_amplitude, o->first_harmonic_amplitude_error, CLOSED },
    { "phase_lag", "lag of the first harmonic behind the drive", "rad", o->phase_lag,
      o->phase_lag_error, CLOSED },
    { "mean_power", "mean power taken from the drive", "1", o->mean_power, o->mean_power_error,
      CHAOTIC },
    { "period", "drive periods until the orbit closes", "1", o->period, 0.0, CLOSED },
    { "winding", "whole turns until the orbit closes", "1", o->winding, 0.0, CLOSED },
    { "well", "number of the well of the orbit", "1", o->winding == 0 ? (double)f->well : NAN, 0.0,
      CLOSED },
    { "settling_periods", "drive periods from the start to the trapping region", "1", waited, 0.0,
      ALWAYS },
    { "lyapunov_exponent", "largest Lyapunov exponent a unit time", "1", f->lyapunov,
      f->lyapunov_error, ALWAYS },
    { "drift", "mean whole turns a drive period, of chaos", "1", f->drift, f->drift_error,
      CHAOTIC },
    { "watched_periods", "drive periods that chaos was watched for without ending, all walkers",
      "1",
      f->watched_periods, 0.0, CHAOTIC },
    { "escape_rate_bound", "largest rate of ending, a drive period, that is not excluded at 95 %",
      "1", f->escape_rate_bound, 0.0, CHAOTIC },
  };
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < sizeof scalars / sizeof *scalars && status == PENDRES_OK; i++) {
    const int there = f->closed || scalars[i].of == ALWAYS ||
                      (scalars[i].of == CHAOTIC && f->label == PENDRES_LABEL_CHAOTIC);
    const double value = there ? scalars[i].value : NAN;
    const double error = isnan(value) ? NAN : scalars[i].error;
    const double pair[2] = {value, error};
    const scene_column column = {.name = scalars[i].name, .long_name = scalars[i].long_name,
                                 .units = scalars[i].units, .error = sizeof value};
    const scene_table table = {.n = 1, .stride = sizeof pair, .rows = pair};
    status = scene_columns_write(run, &table, 1, &column);
  }
  return status;
}

/* What it is. */
typedef struct verdict {
  int label, failed;
} verdict;

static const scene_column of_verdicts[] = {
  {.name = "label", .long_name = "kind of attractor", .type = SCENE_FLAG,
   .value = offsetof(verdict, label), .names = scene_label_names},
  {.name = "failed", .long_name = "why there is no orbit", .type = SCENE_FLAG,
   .value = offsetof(verdict, failed), .names = scene_failure_names},
};

static pendres_status put_label(scene_run *run, const work *w)
{
  const int lost = w->found.label == PENDRES_LABEL_UNRESOLVED && !w->transient;
  const verdict of = {(int)w->found.label, lost ? SCENE_FAILURE_UNRESOLVED : SCENE_FAILURE_NONE};
  const scene_table table = {.n = 1, .stride = sizeof of, .rows = &of};
  if (lost) scene_failure_tell(run, SCENE_FAILURE_UNRESOLVED, NULL, "orbit");
  run->failed_points = (size_t)lost;
  return scene_columns_write(run, &table, sizeof of_verdicts / sizeof *of_verdicts, of_verdicts);
}

typedef struct multiplier {
  double re, im, error;
} multiplier;

static const scene_column of_multipliers[] = {
  {.name = "multiplier_re", .long_name = "Floquet multiplier, real part", .units = "1",
   .value = offsetof(multiplier, re), .error = offsetof(multiplier, error)},
  {.name = "multiplier_im", .long_name = "Floquet multiplier, imaginary part", .units = "1",
   .value = offsetof(multiplier, im), .error = offsetof(multiplier, error)},
};

static pendres_status put_multipliers(scene_run *run, const work *w)
{
  const found *f = &w->found;
  multiplier rows[MULTIPLIERS];
  const scene_table table = {.dimensions = {"multiplier"}, .n = MULTIPLIERS,
                             .stride = sizeof *rows, .rows = rows};
  for (int i = 0; i < MULTIPLIERS; i++)
    rows[i] = f->closed ? (multiplier){f->orbit.multiplier_re[i], f->orbit.multiplier_im[i],
                                       f->orbit.multiplier_error}
                        : (multiplier){NAN, NAN, NAN};
  const pendres_status status = pendres_store_dimension(
    run->store, NULL, "multiplier", MULTIPLIERS, NULL, "number of the Floquet multiplier", "1");
  if (status != PENDRES_OK) return scene_store_failed(run, status);
  return scene_columns_write(run, &table, sizeof of_multipliers / sizeof *of_multipliers,
                             of_multipliers);
}

static void tabulate(FILE *out, const work *w)
{
  const found *f = &w->found;
  const pendres_orbit *o = &f->orbit;
  if (out == NULL) return;
  fprintf(out, "%-26s %s\n", "label", pendres_label_name(f->label));
  if (f->settling_periods >= 0)
    fprintf(out, "%-26s %ld\n", "settling periods", f->settling_periods);
  if (isfinite(f->lyapunov))
    fprintf(out, "%-26s %.*f +- %.0e\n", "Lyapunov exponent", f->closed ? 12 : 6, f->lyapunov,
            f->lyapunov_error);
  if (f->label == PENDRES_LABEL_CHAOTIC)
    fprintf(out, "%-26s %.4g drive periods; ends at less than %.1g a period, if at all\n"
                 "%-26s %.6f +- %.0e\n%-26s %.6f +- %.0e\n%-26s %.6f +- %.0e\n",
            "watched for", f->watched_periods, f->escape_rate_bound, "drift", f->drift,
            f->drift_error, "mean loop area", o->loop_area, o->loop_area_error,
            "mean amplitude", o->amplitude, o->amplitude_error);
  if (!f->closed) return;
  fprintf(out, "%-26s %d\n%-26s %d\n", "period", o->period, "winding", o->winding);
  if (o->winding == 0) fprintf(out, "%-26s %ld\n", "well", f->well);
  const struct { const char *name; double value, error; } rows[] = {
    { "amplitude", o->amplitude, o->amplitude_error },
    { "first harmonic amplitude", o->first_harmonic_amplitude, o->first_harmonic_amplitude_error },
    { "phase lag", o->phase_lag, o->phase_lag_error },
    { "loop area", o->loop_area, o->loop_area_error },
    { "dissipation", o->dissipation, o->dissipation_error },
    { "mean power", o->mean_power, o->mean_power_error },
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    fprintf(out, "%-26s %.12f +- %.0e\n", rows[i].name, rows[i].value, rows[i].error);
  for (int i = 0; i < MULTIPLIERS; i++)
    fprintf(out, "%-26s %.10f %+.10f i\n", "Floquet multiplier", o->multiplier_re[i],
            o->multiplier_im[i]);
}

static pendres_status write_all(scene_run *run, const work *w)
{
  pendres_status status = put_label(run, w);
  if (status == PENDRES_OK) status = put_scalars(run, w);
  if (status == PENDRES_OK) status = put_multipliers(run, w);
  if (status == PENDRES_OK) status = put_samples(run, w);
  return status;
}

static pendres_status run_scene(scene_run *run)
{
  const deck *d = run->deck;
  work w = { .d = d, .points = (size_t)(d->orbit.periods * d->orbit.samples),
             .found = { .settling_periods = -1, .lyapunov = NAN, .lyapunov_error = NAN,
                        .drift = NAN, .drift_error = NAN, .watched_periods = NAN,
                        .escape_rate_bound = NAN },
             /* On a named attractor there is no transient. */
             .transient = d->orbit.transient && d->orbit.start[0] == '\0',
             .pendulum = scene_pendulum(d) };
  w.room = w.points + 1;
  const size_t bytes = 4 * w.room * sizeof *w.x;
  double *memory = malloc(bytes);
  if (memory == NULL)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu samples", w.points);
  place_samples(&w, memory);
  pendres_status status =
    scene_compute(run, &(farm_stage){ .what = "orbits", .last = 1, .tasks = 1, .task = compute,
                                      .record_size = sizeof(found) + bytes, .collect = collect,
                                      .arg = &w });
  if (status == PENDRES_OK) status = write_all(run, &w);
  if (status == PENDRES_OK) tabulate(run->table, &w);
  free(memory);
  return status;
}

static void plan(const deck *d, FILE *out)
{
  fprintf(out, "orbit at damping %g, drive amplitude %g, drive period %g\n", d->pendulum.damping,
          d->pendulum.drive_amplitude, d->pendulum.drive_period);
  if (d->orbit.start[0] != '\0') fprintf(out, "of the attractor '%s'", d->orbit.start);
  else
    fprintf(out, "%s x = %g, v = %g", d->orbit.transient ? "recorded from" : "that is reached from",
            d->orbit.x, d->orbit.v);
  fprintf(out, ", %lld samples over %lld periods\n",
          (long long)(d->orbit.periods * d->orbit.samples), (long long)d->orbit.periods);
}

const scene_kind scene_orbit = {
  .kind = DECK_ORBIT,
  .references = "D. Kharkongor and M. C. Mahato, Resonance oscillation of a damped driven simple "
                "pendulum, Figs. 5 and 6",
  .plan = plan,
  .run = run_scene,
};
