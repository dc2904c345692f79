/*
 * write.c -- what the file of a fit holds; see data.h.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "results/columns.h"
#include "scenes/fit/data.h"

/* ---- results ------------------------------------------------------------------------------- */

typedef struct value_row {
  char name[DECK_NAME];
  double value, value_error, value_si, value_si_error;
  char units[DECK_UNITS];
} value_row;

static void write_values(const fit_work *w)
{
  static const scene_column columns[] = {
    {SCENE_TYPED(SCENE_TEXT, "parameter_name", value_row, name, "name of the fitted quantity")},
    SCENE_COLUMN(value_row, value, "fitted value; its error is the standard error")};
  static const scene_column in_si[] = {
    SCENE_COLUMN(value_row, value_si, "the same in SI, of what has a unit"),
    {SCENE_TYPED(SCENE_TEXT, "value_units", value_row, units, "its unit")}};
  const pendres_store_spec spec = {.name = "covariance",
                                   .dimensions = {"parameter", "with_parameter"},
                                   .long_name = "covariance of the fitted quantities"};
  value_row rows[FIT_MOST];
  double covariance[FIT_MOST * FIT_MOST];
  for (size_t i = 0; i < w->free; i++) {
    rows[i] = (value_row){.value = pendres_fit_value(w->fit, i), .value_error = fit_error(w, i)};
    snprintf(rows[i].name, sizeof rows[i].name, "%s",
             pendres_name_get(PENDRES_NAMES_FIT_QUANTITY, w->unknown[i].quantity));
    deck_si si = {.factor = NAN};
    if (deck_fit_si(w->d, rows[i].name, &si)) memcpy(rows[i].units, si.units, sizeof si.units);
    rows[i].value_si = si.factor * rows[i].value;
    rows[i].value_si_error = si.factor * rows[i].value_error;
    for (size_t k = 0; k < w->free; k++)
      covariance[i * w->free + k] = pendres_fit_covariance(w->fit, i, k);
  }
  const scene_table table = {.dimensions = {"parameter"}, SCENE_ROWS(rows, w->free)};
  scene_numbering(w->run, "parameter", w->free, "number of the fitted quantity");
  scene_numbering(w->run, "with_parameter", w->free, "the same, in the second place");
  SCENE_WRITE(w->run, &table, columns);
  if (deck_has_units(w->d)) SCENE_WRITE(w->run, &table, in_si);
  scene_put(w->run, &spec, covariance, NULL, w->free * w->free);
}

typedef struct datum_row {
  pendres_fit_datum of;
  pendres_fit_point at;
  double unused;
} datum_row;

static const char *observable_names(int value)
{
  return pendres_name_get(PENDRES_NAMES_FIT_OBSERVABLE, value);
}

SCENE_NAMES(beyond_names, "on_a_state", "beyond_its_end")

static void write_data(const fit_work *w)
{
  static const scene_column columns[] = {
    {SCENE_TYPED(SCENE_PLAIN, "datum_axis", datum_row, of.axis,
                 "value of the swept parameter, in the data's unit")},
    {.name = "observed", .long_name = "what was measured; its error is the standard error used",
     .value = offsetof(datum_row, of.observed),
     .error = offsetof(datum_row, at.error)},
    {SCENE_AS("modelled", datum_row, at.modelled, "the model's value there", NULL)},
    {.name = "residual", .long_name = "observed less modelled",
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

static void write_jumps(const fit_work *w)
{
  static const scene_column columns[] = {
    {SCENE_AS("parameter", pendres_fit_jump, value,
              "value of the axis at which the model's state ends, in the data's unit; its error "
              "is the standard error", NULL)},
    {SCENE_TYPED(SCENE_PLAIN, "measured_from", pendres_fit_jump, measured[0],
                 "last datum before the jump of the data")},
    {SCENE_TYPED(SCENE_PLAIN, "measured_to", pendres_fit_jump, measured[1],
                 "first datum behind it")},
    {SCENE_TYPED(SCENE_PLAIN, "other", pendres_fit_jump, other,
                 "value of the parameter that differs between sweeps")},
    {SCENE_TYPED(SCENE_NUMBER, "direction", pendres_fit_jump, direction,
                 "1: the axis grows, -1: it falls")},
  };
  size_t n = 0;
  while (pendres_fit_jump_get(w->fit, n) != NULL) n++;
  pendres_fit_jump *rows = scene_array(w->run, n, sizeof *rows);
  const scene_table table = {.dimensions = {"jump"}, .prefix = "jump", SCENE_ROWS(rows, n)};
  for (size_t i = 0; i < n && rows != NULL; i++) rows[i] = *pendres_fit_jump_get(w->fit, i);
  scene_numbering(w->run, "jump", n, "number of the model's jump");
  SCENE_WRITE(w->run, &table, columns);
}

static void put_scalar(const fit_work *w, const char *name, const char *words, double value)
{
  const pendres_store_spec spec = {.name = name, .long_name = words};
  scene_put(w->run, &spec, &value, NULL, 1);
}

static void write_summary(const fit_work *w)
{
  static const char *const names[] = {"no", "yes", "to_no_possible_chi_square"};
  const pendres_fit_summary s = pendres_fit_summary_get(w->fit);
  const int8_t converged = (int8_t)s.converged;
  const pendres_store_spec spec = {.name = "converged", .type = PENDRES_STORE_INT8,
                                   .long_name = "whether the fit has converged",
                                   .flag_count = 3, .flag_meanings = names};
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

static double value_of(const fit_work *w, int quantity)
{
  for (size_t i = 0; i < w->n; i++)
    if (w->unknown[i].quantity == quantity) return pendres_fit_value(w->fit, i);
  return 1.0;
}

/* The scale of a parameter in the data: what the model's is divided by. */
static double scale_of(const fit_work *w, pendres_parameter p)
{
  return p == PENDRES_DRIVE_FREQUENCY   ? 1.0 / value_of(w, PENDRES_FIT_FREQUENCY_SCALE)
         : p == PENDRES_DRIVE_AMPLITUDE ? value_of(w, PENDRES_FIT_DRIVE_SCALE)
                                        : 1.0;
}

/* The branches at the value of the other parameter that datum `from` has. */
static pendres_branches *find_branches(const fit_work *w, size_t from)
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

static curve_row row_of(const fit_work *w, const pendres_branch_point *p, double other, int number)
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
static size_t take_points(const fit_work *w, const pendres_branches *set, double other, size_t n,
                          curve_row *rows)
{
  for (size_t k = 0; k < pendres_branches_count(set); k++) {
    const pendres_branch *b = pendres_branches_get(set, k);
    for (size_t i = 0; i < pendres_branch_count(b); i++, n++)
      if (rows != NULL) rows[n] = row_of(w, pendres_branch_get(b, i), other, (int)k);
  }
  return n;
}

static void write_points(const fit_work *w, const curve_row *rows, size_t n)
{
  static const scene_column columns[] = {
    {SCENE_AS("axis", curve_row, axis, "value of the swept parameter, in the data's unit", NULL)},
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
    {SCENE_TYPED(SCENE_NUMBER, "period", curve_row, period, NULL)},
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

static void write_curves(const fit_work *w)
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

void fit_write(const fit_work *w)
{
  write_values(w);
  write_summary(w);
  write_data(w);
  write_jumps(w);
  if (!fit_is_decay(w->d) && !fit_is_rotation(w->d)) write_curves(w);
  fit_units_mark(w);
}
