/* orbit_write.c -- what the scene `orbit` writes; see orbit.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/columns.h"
#include "scenes/failed.h"
#include "scenes/orbit.h"

static const double eps = 2.220446049250313e-16;

enum { MULTIPLIERS = 2 };

static double number_at(const pendres_orbit *o, size_t offset)
{
  double number;
  memcpy(&number, (const char *)o + offset, sizeof number);
  return number;
}

/* What is exact is rounded all the same, in the three operations and the constant of a work. */
static double error_of(const pendres_orbit *o, const pendres_orbit_quantity *q)
{
  return q->error == PENDRES_ORBIT_EXACT ? 2.0 * eps * fabs(number_at(o, q->value))
                                         : number_at(o, q->error);
}

/* A result without dimensions, or NaN. */
static pendres_status put_scalar(scene_run *run, const scene_column *column, double value,
                                 double error)
{
  const double pair[2] = {value, isnan(value) ? NAN : error};
  const scene_table table = {.n = 1, .stride = sizeof pair, .rows = pair};
  return scene_columns_write(run, &table, 1, column);
}

/* Such a column: the error stands behind the value. */
#define SCALAR(what, words, unit) \
  {.name = what, .long_name = words, .units = unit, .error = sizeof(double)}

/* Whether a measure is written: those of forces that the pendulum does not have are all 0. */
static int is_shown(const orbit_work *w, const pendres_orbit_quantity *q)
{
  return !q->of_forces || !deck_is_plain(w->d);
}

static pendres_status put_quantities(scene_run *run, const orbit_work *w)
{
  const orbit_found *f = &w->found;
  const int there = f->closed || f->label == PENDRES_LABEL_CHAOTIC;
  const pendres_orbit_quantity *q;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; status == PENDRES_OK && (q = pendres_orbit_quantity_get(k)) != NULL; k++) {
    const scene_column column = SCALAR(q->name, q->long_name, q->units);
    const double value = there ? number_at(&f->orbit, q->value) : NAN;
    if (is_shown(w, q))
      status = put_scalar(run, &column, value, error_of(&f->orbit, q));
  }
  return status;
}

static pendres_status put_scalars(scene_run *run, const orbit_work *w)
{
  const orbit_found *f = &w->found;
  const pendres_orbit *o = &f->orbit;
  const double waited = f->settling_periods >= 0 ? (double)f->settling_periods : NAN;
  const struct {
    scene_column column;
    double value, error;
    enum { CLOSED, CHAOTIC, ALWAYS } of; /* closed orbits alone, chaos too, whatever there is */
  } scalars[] = {
    { SCALAR("period", "drive periods until the orbit closes", "1"), o->period, 0.0, CLOSED },
    { SCALAR("winding", "whole turns until the orbit closes", "1"), o->winding, 0.0, CLOSED },
    { SCALAR("well", "number of the well of the orbit", "1"),
      o->winding == 0 ? (double)f->well : NAN, 0.0, CLOSED },
    { SCALAR("settling_periods", "drive periods from the start to the trapping region", "1"),
      waited, 0.0, ALWAYS },
    { SCALAR("lyapunov_exponent", "largest Lyapunov exponent a unit time", "1"), f->lyapunov,
      f->lyapunov_error, ALWAYS },
    { SCALAR("drift", "mean whole turns a drive period, of chaos", "1"), f->drift,
      f->drift_error, CHAOTIC },
    { SCALAR("watched_periods",
             "drive periods that chaos was watched for without ending, all walkers", "1"),
      f->watched_periods, 0.0, CHAOTIC },
    { SCALAR("escape_rate_bound",
             "largest rate of ending, a drive period, that is not excluded at 95 %", "1"),
      f->escape_rate_bound, 0.0, CHAOTIC },
  };
  pendres_status status = put_quantities(run, w);
  for (size_t i = 0; i < sizeof scalars / sizeof *scalars && status == PENDRES_OK; i++) {
    const int there = f->closed || scalars[i].of == ALWAYS ||
                      (scalars[i].of == CHAOTIC && f->label == PENDRES_LABEL_CHAOTIC);
    status = put_scalar(run, &scalars[i].column, there ? scalars[i].value : NAN,
                        scalars[i].error);
  }
  return status;
}

/* What it is. */
typedef struct verdict {
  int label, uncertain, failed;
} verdict;

static const scene_column of_failures[] = {
  SCENE_CODE(verdict, failed, "why there is no orbit", scene_failure_names),
};

/* Only where it is: files of starts that are sure have none. */
static const scene_column of_doubts[] = {
  {.name = "uncertain", .type = SCENE_FLAG, .value = offsetof(verdict, uncertain),
   .names = scene_doubt_names,
   .long_name = "whether errors that the start amplifies may have chosen the attractor"},
};

static pendres_status put_label(scene_run *run, const orbit_work *w)
{
  const scene_verdict *late = &w->found.verdict;
  const int unresolved = w->found.label == PENDRES_LABEL_UNRESOLVED && !w->transient;
  const int lost = unresolved || late->reason != SCENE_FAILURE_NONE;
  const int failed = late->reason != SCENE_FAILURE_NONE ? late->reason
                     : unresolved                       ? SCENE_FAILURE_UNRESOLVED
                                                        : SCENE_FAILURE_NONE;
  const verdict of = {(int)w->found.label, w->found.uncertain, failed};
  const scene_table table = {.n = 1, .stride = sizeof of, .rows = &of};
  const scene_column label = {
    .name = "label", .long_name = "kind of attractor", .type = SCENE_FLAG,
    .value = offsetof(verdict, label),
    .names = pendres_pendulum_leaves(&w->pendulum) ? scene_fate_names : scene_label_names};
  if (lost)
    scene_failure_tell(run, (scene_failure)failed, late->words[0] != '\0' ? late->words : NULL,
                       "orbit");
  run->failed_points = (size_t)lost;
  pendres_status status = scene_columns_write(run, &table, 1, &label);
  if (status == PENDRES_OK) status = SCENE_WRITE(run, &table, of_failures);
  if (status == PENDRES_OK && of.uncertain) status = SCENE_WRITE(run, &table, of_doubts);
  return status;
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

static pendres_status put_multipliers(scene_run *run, const orbit_work *w)
{
  const orbit_found *f = &w->found;
  multiplier rows[MULTIPLIERS];
  const scene_table table = {.dimensions = {"multiplier"}, .n = MULTIPLIERS,
                             .stride = sizeof *rows, .rows = rows};
  for (int i = 0; i < MULTIPLIERS; i++)
    rows[i] = f->closed ? (multiplier){f->orbit.multiplier_re[i], f->orbit.multiplier_im[i],
                                       f->orbit.multiplier_error}
                        : (multiplier){NAN, NAN, NAN};
  const pendres_status status =
    scene_numbering(run, "multiplier", MULTIPLIERS, "number of the Floquet multiplier");
  return status == PENDRES_OK ? SCENE_WRITE(run, &table, of_multipliers) : status;
}

/* ---- samples ------------------------------------------------------------------------------- */

static pendres_status define(orbit_work *w, const char *name, const char *long_name,
                             const char *units, orbit_variable *out)
{
  const pendres_store_spec spec = { .name = name, .dimensions = { "sample" },
                                    .long_name = long_name, .units = units };
  const pendres_status status =
    pendres_store_variable(w->run->store, &spec, &out->value, &out->error);
  return scene_stored(w->run, status);
}

static pendres_status define_samples(orbit_work *w)
{
  const size_t n = (size_t)w->d->orbit.periods * (size_t)w->d->orbit.samples;
  pendres_status status = scene_numbering(w->run, "sample", n, "number of the sample");
  if (status == PENDRES_OK)
    status = define(w, "drive_phase", "phase of the drive, omega t", "rad", &w->phase);
  if (status == PENDRES_OK) status = define(w, "x", "position", "rad", &w->x);
  if (status == PENDRES_OK) status = define(w, "v", "velocity", "1", &w->v);
  if (status == PENDRES_OK)
    status = define(w, "drive", "drive, F0 cos(omega t)", "1", &w->drive);
  return status;
}

static pendres_status put_rows(orbit_work *w, const orbit_variable *to, uint64_t first, size_t n,
                               const double *value, const double *error)
{
  pendres_store *store = w->run->store;
  pendres_status status = pendres_store_write_rows(store, to->value, first, n, value, n);
  if (status == PENDRES_OK)
    status = pendres_store_write_rows(store, to->error, first, n, error, n);
  return scene_stored(w->run, status);
}

pendres_status scene_orbit_put_samples(orbit_work *w, long first, long periods,
                                       const pendres_record *s)
{
  const size_t count = (size_t)w->d->orbit.samples, n = (size_t)periods * count;
  const uint64_t at = (uint64_t)first * count;
  const double f0 = w->pendulum.drive_amplitude;
  double *value = calloc(2 * n, sizeof *value);
  if (value == NULL)
    return scene_fail(w->run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu samples", n);
  double *error = value + n;
  for (size_t k = 0; k < n; k++) {
    value[k] = 2.0 * PENDRES_PI * (double)(at + k) / (double)count;
    error[k] = eps * value[k];
  }
  pendres_status status = put_rows(w, &w->phase, at, n, value, error);
  if (status == PENDRES_OK) status = put_rows(w, &w->x, at, n, s->x, s->x_error);
  if (status == PENDRES_OK) status = put_rows(w, &w->v, at, n, s->v, s->v_error);
  for (size_t k = 0; k < n; k++) {
    const size_t within = k % count; /* no need for large arguments */
    value[k] = f0 * cos(2.0 * PENDRES_PI * (double)within / (double)count);
    error[k] = 8.0 * eps * fabs(f0);
  }
  if (status == PENDRES_OK) status = put_rows(w, &w->drive, at, n, value, error);
  free(value);
  return status;
}

pendres_status scene_orbit_put_found(orbit_work *w)
{
  pendres_status status = put_label(w->run, w);
  if (status == PENDRES_OK) status = put_scalars(w->run, w);
  if (status == PENDRES_OK) status = put_multipliers(w->run, w);
  if (status == PENDRES_OK) status = define_samples(w);
  return status;
}

/* ---- the table ----------------------------------------------------------------------------- */
static void tabulate_dimensions(FILE *out, const orbit_work *w)
{
  const pendres_correlation *c = &w->measures.correlation;
  double error = NAN;
  const double value = pendres_lyapunov_dimension(&w->pendulum, w->found.lyapunov,
                                                  w->found.lyapunov_error, &error);
  if (w->measures.points == 0) return;
  fprintf(out, "%-26s %.4f +- %.0e\n%-26s %.4f +- %.0e\n", "Lyapunov dimension", value, error,
          "correlation dimension", c->dimension, c->dimension_error);
}

void scene_orbit_tabulate(FILE *out, const orbit_work *w)
{
  const orbit_found *f = &w->found;
  const pendres_orbit *o = &f->orbit;
  if (out == NULL) return;
  fprintf(out, "%-26s %s%s\n", "label", pendres_name_get(PENDRES_NAMES_LABEL, f->label),
          f->uncertain ? " (uncertain: errors as small as rounding choose it)" : "");
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
  tabulate_dimensions(out, w);
  if (!f->closed) return;
  fprintf(out, "%-26s %d\n%-26s %d\n", "period", o->period, "winding", o->winding);
  if (o->winding == 0) fprintf(out, "%-26s %ld\n", "well", f->well);
  const pendres_orbit_quantity *q;
  for (size_t k = 0; (q = pendres_orbit_quantity_get(k)) != NULL; k++) {
    char words[32];
    (void)snprintf(words, sizeof words, "%s", q->name);
    for (char *at = words; *at != '\0'; at++)
      if (*at == '_') *at = ' ';
    if (is_shown(w, q))
      fprintf(out, "%-26s %#.13g +- %.0e\n", words, number_at(o, q->value),
              error_of(o, q));
  }
  for (int i = 0; i < MULTIPLIERS; i++)
    fprintf(out, "%-26s %.10f %+.10f i\n", "Floquet multiplier", o->multiplier_re[i],
            o->multiplier_im[i]);
}
