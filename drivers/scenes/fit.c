/*
 * fit.c -- parameters of an oscillator from measured responses: values with their covariance,
 * residuals, and the model's curves with their unstable parts.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/columns.h"
#include "scenes/fit_data.h"

enum { MOST = PENDRES_FIT_QUANTITY_COUNT };

typedef struct work {
  scene_run *run;
  const deck *d;
  fit_data data;
  pendres_pendulum model;
  size_t n, free;          /* unknowns, of which the first ones are free */
  pendres_fit_unknown unknown[MOST];
  pendres_fit *fit;
} work;

/* ---- unknowns ------------------------------------------------------------------------------ */

static int quantity_of(const char *name)
{
  for (int q = 0; q < MOST; q++)
    if (strcmp(pendres_fit_quantity_name(q), name) == 0) return q;
  return -1;
}

static pendres_fit_unknown *unknown_of(work *w, int quantity)
{
  for (size_t i = 0; i < w->n; i++)
    if (w->unknown[i].quantity == quantity) return &w->unknown[i];
  return NULL;
}

/* "NAME 1 2" with any of blanks, commas, colons and equals signs between; 0: it is not so. */
static int read_entry(const char *text, size_t count, int *quantity, double *number)
{
  static const char between[] = " \t,:=";
  char word[DECK_NAME];
  snprintf(word, sizeof word, "%s", text);
  char *at = word + strspn(word, between);
  char *end = at + strcspn(at, between);
  const int last = *end == '\0';
  *end = '\0';
  *quantity = quantity_of(at);
  at = last ? end : end + 1;
  for (size_t i = 0; i < count; i++) {
    at += strspn(at, between);
    number[i] = strtod(at, &end);
    if (end == at || !isfinite(number[i])) return 0;
    at = end;
  }
  return *quantity >= 0 && at[strspn(at, between)] == '\0';
}

/* The entries of a key; each is of an unknown, which is added as a fixed one if `add` is set. */
static void read_entries(work *w, const deck_names *names, const char *key, const char *form,
                         void (*set)(pendres_fit_unknown *u, const double number[2]))
{
  const int add = strcmp(key, "fixed") == 0;
  for (size_t i = 0; i < names->count && scene_going(w->run); i++) {
    double number[2] = {NAN, NAN};
    int q = -1;
    const int good = read_entry(names->name[i], add ? 1 : 2, &q, number);
    pendres_fit_unknown *u = q >= 0 ? unknown_of(w, q) : NULL;
    if (!good)
      (void)scene_fail(w->run, PENDRES_INVALID_ARGUMENT,
                       "%s: fit.%s: '%s' is not of the form '%s' with a quantity of fit.free",
                       w->d->name, key, names->name[i], form);
    else if (add && u != NULL)
      (void)scene_fail(w->run, PENDRES_INVALID_ARGUMENT,
                       "%s: fit.fixed: '%s' is in fit.free, or here twice: leave one out",
                       w->d->name, names->name[i]);
    else if (!add && (u == NULL || u->fixed))
      (void)scene_fail(w->run, PENDRES_INVALID_ARGUMENT,
                       "%s: fit.%s: '%s' is not of what fit.free names: name it there, or leave "
                       "this out", w->d->name, key, names->name[i]);
    if (!scene_going(w->run)) return;
    if (add) {
      u = &w->unknown[w->n++];
      *u = (pendres_fit_unknown){.quantity = q, .fixed = 1};
    }
    set(u, number);
  }
}

static void set_fixed(pendres_fit_unknown *u, const double number[2])
{
  u->guess = number[0];
}

static void set_bounds(pendres_fit_unknown *u, const double number[2])
{
  u->low = number[0];
  u->high = number[1];
}

static void set_prior(pendres_fit_unknown *u, const double number[2])
{
  u->prior = number[0];
  u->prior_error = number[1];
}

static void set_unknowns(work *w)
{
  const deck *d = w->d;
  w->model = d->pendulum;
  w->model.temperature = 0.0;
  for (size_t i = 0; i < d->fit.free.count; i++) {
    const int q = quantity_of(d->fit.free.name[i]);
    double guess = q < PENDRES_PARAMETER_FOLLOWED
                     ? pendres_parameter_get((pendres_parameter)q, &w->model) : NAN;
    /* Coefficients, torque and parametric drive that the deck does not give are 0. */
    if (guess == 0.0 && q >= (int)PENDRES_A1) guess = NAN;
    w->unknown[w->n++] = (pendres_fit_unknown){.quantity = q, .guess = guess};
  }
  w->free = w->n;
  read_entries(w, &d->fit.fixed, "fixed", "NAME VALUE", set_fixed);
  read_entries(w, &d->fit.bounds, "bounds", "NAME LOW HIGH", set_bounds);
  read_entries(w, &d->fit.prior, "prior", "NAME MEAN ERROR", set_prior);
}

/* What the model needs and nothing gives. */
static void check_model(work *w)
{
  static const pendres_parameter needed[] = {PENDRES_DAMPING, PENDRES_DRIVE_AMPLITUDE,
                                             PENDRES_DRIVE_FREQUENCY};
  for (size_t i = 0; i < sizeof needed / sizeof *needed && scene_going(w->run); i++) {
    const pendres_parameter p = needed[i];
    if (!isnan(pendres_parameter_get(p, &w->model)) || p == w->data.of.axis ||
        p == w->data.of.other || unknown_of(w, (int)p) != NULL)
      continue;
    (void)scene_fail(w->run, PENDRES_INVALID_ARGUMENT,
                     "%s: '%s' is neither in &pendulum, nor free, nor a column of the data: give "
                     "one of these", w->d->name, pendres_parameter_of(p)->name);
  }
}

/* ---- results ------------------------------------------------------------------------------- */

typedef struct value_row {
  char name[DECK_NAME];
  double value, value_error;
} value_row;

static double error_of(const work *w, size_t i)
{
  return sqrt(pendres_fit_covariance(w->fit, i, i));
}

static void write_values(const work *w)
{
  static const scene_column columns[] = {
    {SCENE_TYPED(SCENE_TEXT, "parameter_name", value_row, name, "name of the fitted quantity")},
    SCENE_COLUMN(value_row, value, "fitted value; its error is the standard error", "1")};
  const pendres_store_spec spec = {.name = "covariance", .units = "1",
                                   .dimensions = {"parameter", "with_parameter"},
                                   .long_name = "covariance of the fitted quantities"};
  value_row rows[MOST];
  double covariance[MOST * MOST];
  for (size_t i = 0; i < w->free; i++) {
    rows[i] = (value_row){.value = pendres_fit_value(w->fit, i), .value_error = error_of(w, i)};
    snprintf(rows[i].name, sizeof rows[i].name, "%s",
             pendres_fit_quantity_name(w->unknown[i].quantity));
    for (size_t k = 0; k < w->free; k++)
      covariance[i * w->free + k] = pendres_fit_covariance(w->fit, i, k);
  }
  const scene_table table = {.dimensions = {"parameter"}, SCENE_ROWS(rows, w->free)};
  scene_numbering(w->run, "parameter", w->free, "number of the fitted quantity");
  scene_numbering(w->run, "with_parameter", w->free, "the same, in the second place");
  SCENE_WRITE(w->run, &table, columns);
  scene_put(w->run, &spec, covariance, NULL, w->free * w->free);
}

typedef struct datum_row {
  pendres_fit_datum of;
  pendres_fit_point at;
  double unused;
} datum_row;

static const char *observable_names(int value)
{
  return pendres_fit_observable_name(value);
}

SCENE_NAMES(beyond_names, "on_a_state", "beyond_its_end")

static void write_data(const work *w)
{
  static const scene_column columns[] = {
    {SCENE_TYPED(SCENE_PLAIN, "datum_axis", datum_row, of.axis,
                 "value of the swept parameter, in the data's unit")},
    {.name = "observed", .long_name = "what was measured; its error is the standard error used",
     .units = "1", .value = offsetof(datum_row, of.observed),
     .error = offsetof(datum_row, at.error)},
    {SCENE_AS("modelled", datum_row, at.modelled, "the model's value there", "1")},
    {.name = "residual", .long_name = "observed less modelled", .units = "1",
     .value = offsetof(datum_row, at.residual), .error = offsetof(datum_row, at.error)},
    {SCENE_TYPED(SCENE_FLAG, "datum_observable", datum_row, of.observable, "what was measured"),
     .names = observable_names},
    {SCENE_TYPED(SCENE_NUMBER, "datum_direction", datum_row, of.direction,
                 "1: measured while the axis grew, -1: fell")},
    {SCENE_TYPED(SCENE_NUMBER, "datum_part", datum_row, at.part,
                 "jumps that the model has made before in this sweep")},
    {SCENE_TYPED(SCENE_FLAG, "datum_beyond", datum_row, at.beyond,
                 "whether the model's state has ended before the datum"), .names = beyond_names},
  };
  static const scene_column other[] = {
    {SCENE_TYPED(SCENE_PLAIN, "datum_other", datum_row, of.other,
                 "value of the parameter that differs between sweeps, in the data's unit")}};
  const size_t n = w->data.of.n;
  datum_row *rows = scene_array(w->run, n, sizeof *rows);
  const scene_table table = {.dimensions = {"datum"}, SCENE_ROWS(rows, n)};
  for (size_t i = 0; i < n && rows != NULL; i++)
    rows[i] = (datum_row){w->data.datum[i], *pendres_fit_point_get(w->fit, i), 0.0};
  scene_numbering(w->run, "datum", n, "number of the datum, in the order of the file");
  SCENE_WRITE(w->run, &table, columns);
  if (w->data.of.other != PENDRES_PARAMETER_COUNT) SCENE_WRITE(w->run, &table, other);
}

static void write_jumps(const work *w)
{
  static const scene_column columns[] = {
    {SCENE_AS("parameter", pendres_fit_jump, value,
              "value of the axis at which the model's state ends, in the data's unit; its error "
              "is the standard error", "1")},
    {SCENE_TYPED(SCENE_PLAIN, "measured_from", pendres_fit_jump, measured[0],
                 "last datum before the jump of the data")},
    {SCENE_TYPED(SCENE_PLAIN, "measured_to", pendres_fit_jump, measured[1],
                 "first datum behind it")},
    {SCENE_TYPED(SCENE_PLAIN, "other", pendres_fit_jump, other,
                 "value of the parameter that differs between sweeps")},
    {SCENE_TYPED(SCENE_NUMBER, "direction", pendres_fit_jump, direction,
                 "1: the axis grows, -1: it falls")},
  };
  const size_t n = pendres_fit_jump_count(w->fit);
  pendres_fit_jump *rows = scene_array(w->run, n, sizeof *rows);
  const scene_table table = {.dimensions = {"jump"}, .prefix = "jump", SCENE_ROWS(rows, n)};
  for (size_t i = 0; i < n && rows != NULL; i++) rows[i] = *pendres_fit_jump_get(w->fit, i);
  scene_numbering(w->run, "jump", n, "number of the model's jump");
  SCENE_WRITE(w->run, &table, columns);
}

static void put_scalar(const work *w, const char *name, const char *words, double value)
{
  const pendres_store_spec spec = {.name = name, .long_name = words, .units = "1"};
  scene_put(w->run, &spec, &value, NULL, 1);
}

static void write_summary(const work *w)
{
  static const char *const names[] = {"no", "yes"};
  const pendres_fit_summary s = pendres_fit_summary_get(w->fit);
  const int8_t converged = (int8_t)s.converged;
  const pendres_store_spec spec = {.name = "converged", .type = PENDRES_STORE_INT8,
                                   .long_name = "whether the fit has converged",
                                   .flag_count = 2, .flag_meanings = names};
  put_scalar(w, "chi_square", "chi-square of data, jumps and priors", s.chi_square);
  put_scalar(w, "degrees_of_freedom", "their number less that of the fitted quantities",
             s.degrees_of_freedom);
  put_scalar(w, "probability",
             "of a larger chi-square by chance; NaN where the errors follow from the fit",
             s.probability);
  scene_put(w->run, &spec, &converged, NULL, 1);
  for (size_t i = 0; pendres_fit_note_get(w->fit, i) != NULL && scene_going(w->run); i++) {
    char name[32];
    snprintf(name, sizeof name, "note_%zu", i + 1);
    scene_stored(w->run, pendres_store_attribute(w->run->store, NULL, NULL, name,
                                                 pendres_fit_note_get(w->fit, i)));
  }
}

/* ---- the model's curves -------------------------------------------------------------------- */

typedef struct curve_row {
  pendres_orbit of;
  double axis, axis_error, other, multiplier_error[2];
  int stable, kind, number, period;
} curve_row;

SCENE_NAMES(stabilities, "unstable", "stable")

static double value_of(const work *w, int quantity)
{
  for (size_t i = 0; i < w->n; i++)
    if (w->unknown[i].quantity == quantity) return pendres_fit_value(w->fit, i);
  return 1.0;
}

/* The scale of a parameter in the data: what the model's is divided by. */
static double scale_of(const work *w, pendres_parameter p)
{
  return p == PENDRES_DRIVE_FREQUENCY   ? 1.0 / value_of(w, PENDRES_FIT_FREQUENCY_SCALE)
         : p == PENDRES_DRIVE_AMPLITUDE ? value_of(w, PENDRES_FIT_DRIVE_SCALE)
                                        : 1.0;
}

/* The branches at the value of the other parameter that datum `from` has. */
static pendres_branches *find_branches(const work *w, size_t from)
{
  const pendres_fit_data *data = &w->data.of;
  const double scale = scale_of(w, data->axis);
  double low = INFINITY, high = -INFINITY;
  pendres_branches *found = NULL;
  pendres_orbit orbit;
  pendres_status outcome = PENDRES_OK;
  pendres_context *ctx = scene_context(w->run);
  for (size_t i = 0; i < data->n; i++) {
    if (w->data.datum[i].other != w->data.datum[from].other) continue;
    low = fmin(low, w->data.datum[i].axis * scale);
    high = fmax(high, w->data.datum[i].axis * scale);
  }
  const pendres_branch_options options = {.parameter = data->axis, .low = low, .high = high};
  const pendres_orbit_guess *guess = &pendres_fit_point_get(w->fit, from)->orbit;
  if (ctx == NULL || !(low < high) ||
      scene_failure_of(pendres_orbit_find(ctx, 1, guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome)) !=
        SCENE_FAILURE_NONE ||
      (outcome != PENDRES_OK && outcome != PENDRES_TOLERANCE_UNREACHABLE))
    return NULL;
  const pendres_status status = pendres_branches_find(ctx, 1, &orbit, &options, &found);
  if (scene_failure_of(status) == SCENE_FAILURE_NONE) (void)scene_asked(w->run, status);
  return found;
}

static curve_row row_of(const work *w, const pendres_branch_point *p, double other, int number)
{
  const pendres_parameter axis = w->data.of.axis;
  const double scale = scale_of(w, axis);
  return (curve_row){.of = p->orbit, .other = other,
                     .axis = pendres_parameter_get(axis, &p->orbit.pendulum) / scale,
                     .axis_error = p->parameter_error / scale, .stable = p->orbit.stable,
                     .kind = (int)p->kind, .number = number, .period = p->orbit.period,
                     .multiplier_error = {p->orbit.multiplier_error, p->orbit.multiplier_error}};
}

/* The points of all branches of a set behind the n that rows have; rows may be NULL. */
static size_t take_points(const work *w, const pendres_branches *set, double other, size_t n,
                          curve_row *rows)
{
  for (size_t k = 0; k < pendres_branches_count(set); k++) {
    const pendres_branch *b = pendres_branches_get(set, k);
    for (size_t i = 0; i < pendres_branch_count(b); i++, n++)
      if (rows != NULL) rows[n] = row_of(w, pendres_branch_get(b, i), other, (int)k);
  }
  return n;
}

static void write_points(const work *w, const curve_row *rows, size_t n)
{
  static const scene_column columns[] = {
    {SCENE_AS("axis", curve_row, axis, "value of the swept parameter, in the data's unit", "1")},
    {SCENE_TYPED(SCENE_PLAIN, "other", curve_row, other,
                 "value of the parameter that differs between sweeps, in the data's unit")},
    {.name = "multiplier_re", .long_name = "real part of the Floquet multiplier", .pairs = 1,
     .value = offsetof(curve_row, of.multiplier_re),
     .error = offsetof(curve_row, multiplier_error)},
    {.name = "multiplier_im", .long_name = "imaginary part of the Floquet multiplier", .pairs = 1,
     .value = offsetof(curve_row, of.multiplier_im),
     .error = offsetof(curve_row, multiplier_error)},
    {SCENE_TYPED(SCENE_FLAG, "stable", curve_row, stable, "whether the orbit attracts"),
     .names = stabilities},
    SCENE_CODE(curve_row, kind, "what happens at the point", scene_special_names),
    {SCENE_TYPED(SCENE_NUMBER, "number", curve_row, number, "number of the branch")},
    {SCENE_TYPED(SCENE_NUMBER, "period", curve_row, period,
                 "drive periods until the orbit closes")},
  };
  static const scene_column of_parameters[] = {
    {SCENE_TYPED(SCENE_PLAIN, "damping", curve_row, of.pendulum.damping, "friction coefficient")},
    {SCENE_TYPED(SCENE_PLAIN, "frequency", curve_row, of.pendulum.drive_frequency,
                 "drive frequency")},
    {SCENE_TYPED(SCENE_PLAIN, "drive_amplitude", curve_row, of.pendulum.drive_amplitude,
                 "drive amplitude")}};
  const scene_table table = {.dimensions = {"point"}, .prefix = "branch", .inner = "multiplier",
                             SCENE_ROWS(rows, n)};
  scene_numbering(w->run, "point", n, "number of the point, in order along each branch");
  scene_numbering(w->run, "multiplier", 2, "Floquet multiplier, the larger modulus first");
  SCENE_WRITE(w->run, &table, of_parameters);
  SCENE_WRITE(w->run, &table, columns);
  scene_columns_write_orbits(w->run, &table, offsetof(curve_row, of));
}

static void write_curves(const work *w)
{
  const size_t data = w->data.of.n;
  size_t n = 0, room = 0;
  curve_row *rows = NULL;
  for (size_t i = 0; i < data && scene_going(w->run); i++) {
    int before = pendres_fit_point_get(w->fit, i)->beyond;
    for (size_t k = 0; k < i && !before; k++)
      before = w->data.datum[k].other == w->data.datum[i].other &&
               !pendres_fit_point_get(w->fit, k)->beyond;
    if (before) continue;
    pendres_branches *set = find_branches(w, i);
    const size_t all = take_points(w, set, 0.0, n, NULL);
    if (all > room) {
      room = all;
      curve_row *more = scene_array(w->run, room, sizeof *more);
      if (more != NULL && n > 0) memcpy(more, rows, n * sizeof *more);
      rows = more;
    }
    if (rows != NULL) n = take_points(w, set, w->data.datum[i].other, n, rows);
    pendres_branches_free(set);
  }
  if (scene_going(w->run)) write_points(w, rows, n);
}

/* ---- the table ----------------------------------------------------------------------------- */

static void print_table(FILE *out, const work *w)
{
  const pendres_fit_summary s = pendres_fit_summary_get(w->fit);
  fprintf(out, "%-22s %18s %11s   correlations\n", "quantity", "value", "error");
  for (size_t i = 0; i < w->free; i++) {
    fprintf(out, "%-22s %18.10g %11.2g  ", pendres_fit_quantity_name(w->unknown[i].quantity),
            pendres_fit_value(w->fit, i), error_of(w, i));
    for (size_t k = 0; k < i; k++)
      fprintf(out, " %5.2f",
              pendres_fit_covariance(w->fit, i, k) / (error_of(w, i) * error_of(w, k)));
    fputc('\n', out);
  }
  fprintf(out, "chi-square %.6g, degrees of freedom %g", s.chi_square, s.degrees_of_freedom);
  if (isnan(s.probability)) fprintf(out, " (errors follow from the scatter)\n");
  else fprintf(out, ", probability %.3g\n", s.probability);
  for (size_t i = 0; i < pendres_fit_jump_count(w->fit); i++) {
    const pendres_fit_jump *j = pendres_fit_jump_get(w->fit, i);
    fprintf(out, "%s the model jumps at %.10g +- %.1g", j->direction > 0 ? "up:  " : "down:",
            j->value, j->value_error);
    if (!isnan(j->measured[0]) && !isnan(j->measured[1]))
      fprintf(out, ", the data between %.10g and %.10g", j->measured[0], j->measured[1]);
    fputc('\n', out);
  }
  for (size_t i = 0; pendres_fit_note_get(w->fit, i) != NULL; i++)
    fprintf(out, "note: %s\n", pendres_fit_note_get(w->fit, i));
}

/* ---- the scene ----------------------------------------------------------------------------- */

static void find_fit(work *w)
{
  const deck *d = w->d;
  pendres_context *ctx = scene_context(w->run);
  if (ctx == NULL) return;
  const pendres_fit_options options = {.huber = d->fit.huber, .jump_error = d->fit.jump_error,
                                       .starts = (int)d->fit.starts,
                                       .iterations = (int)d->fit.iterations};
  const pendres_fit_model model = {.pendulum = w->model, .unknowns = w->n, .unknown = w->unknown};
  const pendres_status status = pendres_fit_find(ctx, &w->data.of, &model, &options, &w->fit);
  if (status == PENDRES_OK) return;
  if (w->fit == NULL) {
    (void)scene_fail(w->run, status, "%s: %s", w->data.path, pendres_context_message(ctx));
    return;
  }
  w->run->failed_points++;
  scene_failure_tell(w->run, SCENE_FAILURE_NOT_CONVERGED, NULL, "the fit of %s", w->data.path);
}

static pendres_status run_scene(scene_run *run)
{
  work w = {.run = run, .d = run->deck};
  fit_data_read(run, &w.data);
  if (scene_going(run)) set_unknowns(&w);
  if (scene_going(run)) check_model(&w);
  if (scene_going(run)) find_fit(&w);
  if (scene_going(run)) {
    write_values(&w);
    write_summary(&w);
    write_data(&w);
    write_jumps(&w);
    write_curves(&w);
  }
  if (scene_prints(run)) print_table(run->table, &w);
  pendres_fit_free(w.fit);
  return run->status;
}

static void describe(const deck *d, FILE *out)
{
  fprintf(out, "fit of %zu quantities to the data in %s, which are over %s\n", d->fit.free.count,
          d->data.file, d->data.axis);
}

const scene_kind scene_fit = {
  .kind = DECK_FIT,
  .references = "A. H. Nayfeh and D. T. Mook, Nonlinear Oscillations, chapter 4; J. Nocedal and "
                "S. J. Wright, Numerical Optimization, chapter 10",
  .size = {.head = 60e3, .point = 100.0, .memory = 1e6, .stages = 1.0, .after = 1.0,
           .seconds = 1.0},
  .describe = describe,
  .run = run_scene};
