/* write.c -- what the scene `orbit` writes; see orbit.h. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "results/columns.h"
#include "results/failed.h"
#include "scenes/orbit/orbit.h"

static const double eps = DBL_EPSILON;

enum { MULTIPLIERS = 2 };

static double number_at(const pendres_orbit *o, size_t offset)
{
  double number;
  memcpy(&number, (const char *)o + offset, sizeof number);
  return number;
}

/* Measures without an error of their own are works, which three operations and a constant round. */
static double error_of(const pendres_orbit *o, const pendres_orbit_quantity *q)
{
  return q->error == PENDRES_ORBIT_EXACT ? 2.0 * eps * fabs(number_at(o, q->value))
                                         : number_at(o, q->error);
}

/* A result without dimensions, or NaN. */
static void put_scalar(scene_run *run, const scene_column *column, double value, double error)
{
  const double pair[2] = {value, isnan(value) ? NAN : error};
  const scene_table table = {.n = 1, .stride = sizeof pair, .rows = pair};
  scene_columns_write(run, &table, 1, column);
}

/* A column of such a pair: the error stands behind the value. */
#define SCALAR(what, words) {.name = what, .long_name = words, .error = sizeof(double)}

/* Whether a measure is written: those of forces that the pendulum does not have are all 0. */
static int is_shown(const orbit_work *w, const pendres_orbit_quantity *q)
{
  return !q->of_forces || !deck_is_plain(w->d);
}

static void put_quantities(scene_run *run, const orbit_work *w)
{
  const orbit_found *f = &w->found;
  const int there = f->closed || scene_orbit_open(f);
  const pendres_orbit_quantity *q;
  for (size_t k = 0; (q = pendres_orbit_quantity_get(k)) != NULL; k++) {
    const scene_column column = SCALAR(q->name, NULL);
    const double value = there ? number_at(&f->of.orbit, q->value) : NAN;
    if (is_shown(w, q)) put_scalar(run, &column, value, error_of(&f->of.orbit, q));
  }
}

static void put_scalars(scene_run *run, const orbit_work *w)
{
  const orbit_found *f = &w->found;
  const pendres_orbit *o = &f->of.orbit;
  const double waited = f->settling_periods >= 0 ? (double)f->settling_periods : NAN;
  const struct {
    scene_column column;
    double value, error;
    enum { CLOSED, OPEN, ALWAYS } of; /* closed orbits alone, what does not close too, whatever */
  } scalars[] = {
    { SCALAR("period", NULL), o->period, 0.0, CLOSED },
    { SCALAR("winding", NULL), o->winding, 0.0, CLOSED },
    { SCALAR("well", "number of the well of the orbit"),
      o->winding == 0 ? (double)f->well : NAN, 0.0, CLOSED },
    { SCALAR("settling_periods", "drive periods from the start to the trapping region"),
      waited, 0.0, ALWAYS },
    { SCALAR("lyapunov_exponent", NULL), f->of.lyapunov, f->of.lyapunov_error, ALWAYS },
    { SCALAR("drift", pendres_pendulum_rotates(&w->pendulum)
                         ? "mean whole turns a drive period, of what does not close"
                         : "mean whole turns a drive period, of chaos"), f->of.drift,
      f->of.drift_error, OPEN },
    { SCALAR("watched_periods",
             "drive periods that chaos was watched for without ending, all walkers"),
      f->of.watched_periods, 0.0, OPEN },
    { SCALAR("escape_rate_bound",
             "largest rate of ending, a drive period, that is not excluded at 95 %"),
      f->of.escape_rate_bound, 0.0, OPEN },
  };
  put_quantities(run, w);
  for (size_t i = 0; i < sizeof scalars / sizeof *scalars; i++) {
    const int there = f->closed || scalars[i].of == ALWAYS ||
                      (scalars[i].of == OPEN && scene_orbit_open(f));
    put_scalar(run, &scalars[i].column, there ? scalars[i].value : NAN, scalars[i].error);
  }
}

/* What the search has come to. */
typedef struct verdict {
  int label, uncertain, failed;
} verdict;

static const scene_column of_failures[] = {
  SCENE_CODE(verdict, failed, "why there is no orbit", scene_failure_names),
};

/* Written only where it is 1: files of starts that are certain have no such variable. */
static const scene_column of_doubts[] = {
  {SCENE_TYPED(SCENE_FLAG, "uncertain", verdict, uncertain,
               "whether errors that the start amplifies may have chosen the attractor"),
   .names = scene_doubt_names},
};

static void put_label(scene_run *run, const orbit_work *w)
{
  const scene_failed *late = &w->search.failed[0];
  const int unresolved = w->found.of.label == PENDRES_LABEL_UNRESOLVED && !w->transient;
  const int failed = late->reason != SCENE_FAILURE_NONE ? (int)late->reason
                     : unresolved                          ? SCENE_FAILURE_UNRESOLVED
                                                           : SCENE_FAILURE_NONE;
  const verdict of = {(int)w->found.of.label, w->found.uncertain, failed};
  const scene_table table = {SCENE_ROWS(&of, 1)};
  const scene_column label = {SCENE_TYPED(SCENE_FLAG, "label", verdict, label,
                                          "kind of attractor"),
    .names = scene_settled_names(&w->pendulum)};
  run->points++;
  if (failed != SCENE_FAILURE_NONE) {
    scene_failure_count(run, (scene_failure)failed, 1);
    scene_failure_tell(run, (scene_failure)failed, late->words, "orbit");
  }
  scene_columns_write(run, &table, 1, &label);
  SCENE_WRITE(run, &table, of_failures);
  if (of.uncertain) SCENE_WRITE(run, &table, of_doubts);
}

typedef struct multiplier {
  double re, im, error;
} multiplier;

static const scene_column of_multipliers[] = {
  {.name = "multiplier_re", .long_name = "Floquet multiplier, real part",
   .value = offsetof(multiplier, re), .error = offsetof(multiplier, error)},
  {.name = "multiplier_im", .long_name = "Floquet multiplier, imaginary part",
   .value = offsetof(multiplier, im), .error = offsetof(multiplier, error)},
};

static void put_multipliers(scene_run *run, const orbit_work *w)
{
  const orbit_found *f = &w->found;
  multiplier rows[MULTIPLIERS];
  const scene_table table = {.dimensions = {"multiplier"}, SCENE_ROWS(rows, MULTIPLIERS)};
  for (int i = 0; i < MULTIPLIERS; i++)
    rows[i] = f->closed ? (multiplier){f->of.orbit.multiplier_re[i], f->of.orbit.multiplier_im[i],
                                       f->of.orbit.multiplier_error}
                        : (multiplier){NAN, NAN, NAN};
  scene_numbering(run, "multiplier", MULTIPLIERS, "number of the Floquet multiplier");
  SCENE_WRITE(run, &table, of_multipliers);
}

/* ---- samples ------------------------------------------------------------------------------- */

/* A sample as a row. */
typedef struct sample {
  double drive_phase, drive_phase_error, x, x_error, v, v_error, drive, drive_error;
} sample;

static const scene_column of_samples[ORBIT_VARIABLES] = {
  SCENE_COLUMN(sample, drive_phase, NULL),
  SCENE_COLUMN(sample, x, NULL),
  SCENE_COLUMN(sample, v, NULL),
  SCENE_COLUMN(sample, drive, NULL),
};

static sample sample_of(const orbit_work *w, uint64_t number, const double *s)
{
  const double turn = 2.0 * PENDRES_PI, f0 = w->pendulum.drive_amplitude;
  const uint64_t count = (uint64_t)w->d->orbit.samples;
  const double phase = turn * (double)number / (double)count;
  const uint64_t within = number % count; /* no need for large arguments */
  return (sample){phase, eps * phase, s[0], s[2 * w->room], s[w->room], s[3 * w->room],
                  f0 * cos(turn * (double)within / (double)count), 8.0 * eps * fabs(f0)};
}

void scene_orbit_put_samples(orbit_work *w, long first, long periods, const double *samples)
{
  const size_t count = (size_t)w->d->orbit.samples, n = (size_t)periods * count;
  const size_t at = (size_t)first * count;
  const scene_variables of = {ORBIT_VARIABLES, of_samples, w->variable};
  sample *rows = calloc(n + 1, sizeof *rows);
  const scene_table table = {.dimensions = {"sample"}, SCENE_ROWS(rows, n)};
  if (rows == NULL) scene_fail(w->run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu samples", n);
  for (size_t k = 0; rows != NULL && k < n; k++) rows[k] = sample_of(w, at + k, samples + k);
  scene_columns_write_rows(w->run, &table, at, n, &of);
  free(rows);
}

void scene_orbit_put_found(orbit_work *w)
{
  const size_t n = (size_t)w->d->orbit.periods * (size_t)w->d->orbit.samples;
  const scene_variables of = {ORBIT_VARIABLES, of_samples, w->variable};
  const scene_table samples = {.dimensions = {"sample"}};
  if (!scene_going(w->run)) return;
  put_label(w->run, w);
  put_scalars(w->run, w);
  put_multipliers(w->run, w);
  scene_numbering(w->run, "sample", n, "number of the sample");
  scene_columns_define(w->run, &samples, &of);
}

/* ---- the table ----------------------------------------------------------------------------- */

static void tabulate_dimensions(FILE *out, const orbit_work *w)
{
  const pendres_correlation *c = &w->measures.correlation;
  double error = NAN;
  const double value = pendres_lyapunov_dimension(&w->pendulum, w->found.of.lyapunov,
                                                  w->found.of.lyapunov_error, &error);
  if (w->measures.points == 0) return;
  fprintf(out, "%-26s %.4f +- %.0e\n%-26s %.4f +- %.0e\n", "Lyapunov dimension", value, error,
          "correlation dimension", c->dimension, c->dimension_error);
}

void scene_orbit_tabulate(FILE *out, const orbit_work *w)
{
  const orbit_found *f = &w->found;
  const pendres_orbit *o = &f->of.orbit;
  fprintf(out, "%-26s %s%s\n", "label", pendres_name_get(PENDRES_NAMES_LABEL, f->of.label),
          f->uncertain ? " (uncertain: errors as small as rounding choose it)" : "");
  if (f->settling_periods >= 0)
    fprintf(out, "%-26s %ld\n", "settling periods", f->settling_periods);
  if (isfinite(f->of.lyapunov))
    fprintf(out, "%-26s %.*f +- %.0e\n", "Lyapunov exponent", f->closed ? 12 : 6, f->of.lyapunov,
            f->of.lyapunov_error);
  if (f->of.label == PENDRES_LABEL_CHAOTIC)
    fprintf(out, "%-26s %.4g drive periods; ends at less than %.1g a period, if at all\n"
                 "%-26s %.6f +- %.0e\n%-26s %.6f +- %.0e\n%-26s %.6f +- %.0e\n",
            "watched for", f->of.watched_periods, f->of.escape_rate_bound, "drift", f->of.drift,
            f->of.drift_error, "mean loop area", o->loop_area, o->loop_area_error,
            "mean amplitude", o->amplitude, o->amplitude_error);
  else if (scene_orbit_open(f))
    fprintf(out, "%-26s %.13g +- %.0e\n%-26s %.13g +- %.0e\n", "drift", f->of.drift,
            f->of.drift_error, "mean velocity", f->of.drift * w->pendulum.drive_frequency,
            f->of.drift_error * w->pendulum.drive_frequency);
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
