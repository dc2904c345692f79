/*
 * fit.c -- parameters of an oscillator from measured responses: values with their covariance,
 * residuals, and the model's curves with their unstable parts.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "results/columns.h"
#include "scenes/fit/data.h"

/* ---- unknowns ------------------------------------------------------------------------------ */

static int quantity_of(const char *name)
{
  return pendres_name_find(PENDRES_NAMES_FIT_QUANTITY, name);
}

static pendres_fit_unknown *unknown_of(fit_work *w, int quantity)
{
  for (size_t i = 0; i < w->n; i++)
    if (w->unknown[i].quantity == quantity) return &w->unknown[i];
  return NULL;
}

/* The entries of a key; each is of an unknown, which is added as a fixed one if `add` is set. They
   were checked with the deck. */
static void read_entries(fit_work *w, const deck_names *names, const char *form, int add,
                         void (*set)(pendres_fit_unknown *u, const double number[2]))
{
  char why[DECK_FIT_WHY];
  deck_fit_value v;
  for (size_t i = 0; i < names->count; i++) {
    (void)deck_fit_entry(w->d, names->name[i], form, &v, why);
    const int q = quantity_of(v.name);
    if (add) w->unknown[w->n++] = (pendres_fit_unknown){.quantity = q, .fixed = 1};
    set(unknown_of(w, q), v.number);
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

/* Whether the force is linear, so that the response over the drive does not depend on the drive. */
static int is_linear(const deck *d)
{
  int bent = d->pendulum.force != PENDRES_FORCE_POLYNOMIAL;
  for (int k = 1; k < PENDRES_FORCE_POWERS; k++) {
    bent |= d->pendulum.force_coefficients[k] != 0.0;
    bent |= deck_fit_has(d, pendres_name_get(PENDRES_NAMES_FIT_QUANTITY, PENDRES_A1 + k));
  }
  return !bent;
}

static void set_unknowns(fit_work *w)
{
  const deck *d = w->d;
  w->model = d->pendulum;
  w->model.temperature = 0.0;
  if (fit_is_rotation(d) && isnan(w->model.drive_amplitude)) w->model.drive_amplitude = 0.0;
  if (fit_is_line(d) && isnan(w->model.drive_amplitude) && is_linear(d))
    w->model.drive_amplitude = 1.0;
  for (size_t i = 0; i < d->fit.free.count; i++) {
    const int q = quantity_of(d->fit.free.name[i]);
    double guess = q < PENDRES_PARAMETER_FOLLOWED
                     ? pendres_parameter_get((pendres_parameter)q, &w->model) : NAN;
    /* Coefficients, torque and parametric drive that the deck does not give are 0. */
    if (guess == 0.0 && q >= (int)PENDRES_A1) guess = NAN;
    w->unknown[w->n++] = (pendres_fit_unknown){.quantity = q, .guess = guess};
  }
  /* A free decay begins anywhere, unless its start is told. */
  for (int q = PENDRES_FIT_START_DISPLACEMENT; fit_is_decay(d) && q <= PENDRES_FIT_START_VELOCITY;
       q++)
    if (!deck_fit_has(d, pendres_name_get(PENDRES_NAMES_FIT_QUANTITY, q)))
      w->unknown[w->n++] = (pendres_fit_unknown){.quantity = q, .guess = NAN};
  w->free = w->n;
  read_entries(w, &d->fit.fixed, "NAME VALUE", 1, set_fixed);
  read_entries(w, &d->fit.bounds, "NAME LOW HIGH", 0, set_bounds);
  read_entries(w, &d->fit.prior, "NAME MEAN ERROR", 0, set_prior);
}

double fit_error(const fit_work *w, size_t i)
{
  return sqrt(pendres_fit_covariance(w->fit, i, i));
}

/* What the model needs and nothing gives. */
static void check_model(fit_work *w)
{
  static const pendres_parameter needed[] = {PENDRES_DAMPING, PENDRES_DRIVE_AMPLITUDE,
                                             PENDRES_DRIVE_FREQUENCY};
  for (size_t i = 0; i < sizeof needed / sizeof *needed && scene_going(w->run); i++) {
    const pendres_parameter p = needed[i];
    if (!isnan(pendres_parameter_get(p, &w->model)) || p == w->data.of.axis ||
        p == w->data.of.other || unknown_of(w, (int)p) != NULL ||
        ((fit_is_decay(w->d) || fit_is_rotation(w->d)) && p != PENDRES_DAMPING) ||
        (fit_is_line(w->d) && p == PENDRES_DAMPING))
      continue;
    (void)scene_fail(w->run, PENDRES_INVALID_ARGUMENT,
                     "%s: '%s' is neither in &pendulum, nor free, nor a column of the data: give "
                     "one of these", w->d->name, pendres_parameter_of(p)->name);
  }
}

/* &units tell no unit of accelerations. */
static void check_acceleration(fit_work *w)
{
  for (size_t i = 0; i < w->data.of.n && scene_going(w->run); i++)
    if (w->data.datum[i].observable == PENDRES_FIT_ACCELERATION && deck_has_units(w->d) &&
        !deck_fit_has(w->d, "amplitude_scale"))
      (void)scene_fail(w->run, PENDRES_INVALID_ARGUMENT, "%s: &units do not tell the unit of an "
                       "acceleration_amplitude: free or fix 'amplitude_scale'", w->d->name);
}

/* ---- the table ----------------------------------------------------------------------------- */

/* A value with its error in SI, with the prefix that it takes; "" where the deck does not tell. */
static const char *in_si(const deck_si *si, int known, double value, double error, char text[80])
{
  text[0] = '\0';
  if (!known) return text;
  const deck_si in = deck_si_prefixed(si, si->factor * value);
  snprintf(text, 80, " = %.8g +- %.2g %s", in.factor * value, in.factor * error, in.units);
  return text;
}

static void print_values(FILE *out, const fit_work *w)
{
  const int width = deck_has_units(w->d) ? 34 : 0;
  deck_si si;
  char text[80];
  fprintf(out, "%-22s %18s %11s   %-*scorrelations\n", "quantity", "value", "error", width,
          width > 0 ? "   in SI" : "");
  for (size_t i = 0; i < w->free; i++) {
    const char *name = pendres_name_get(PENDRES_NAMES_FIT_QUANTITY, w->unknown[i].quantity);
    const double value = pendres_fit_value(w->fit, i), error = fit_error(w, i);
    fprintf(out, "%-22s %18.10g %11.2g  %-*s", name, value, error, width,
            in_si(&si, deck_fit_si(w->d, name, &si), value, error, text));
    for (size_t k = 0; k < i; k++) {
      const double both = error * fit_error(w, k);
      fprintf(out, " %5.2f", both > 0.0 ? pendres_fit_covariance(w->fit, i, k) / both : 0.0);
    }
    fputc('\n', out);
  }
}

static void print_jump(FILE *out, const fit_work *w, const pendres_fit_jump *j)
{
  deck_si si;
  char text[80];
  fprintf(out, "%s the model jumps at %.10g +- %.1g", j->direction > 0 ? "up:  " : "down:",
          j->value, j->value_error);
  if (!isnan(j->measured[0]) && !isnan(j->measured[1]))
    fprintf(out, ", the data between %.10g and %.10g", j->measured[0], j->measured[1]);
  const int known = fit_units_of_data(w->d, w->data.of.axis, &si);
  fprintf(out, "%s\n", in_si(&si, known, j->value, j->value_error, text));
}

static void print_table(FILE *out, const fit_work *w)
{
  const pendres_fit_summary s = pendres_fit_summary_get(w->fit);
  print_values(out, w);
  fprintf(out, "chi-square %.6g, degrees of freedom %g", s.chi_square, s.degrees_of_freedom);
  if (isnan(s.probability)) fprintf(out, " (errors follow from the scatter)\n");
  else fprintf(out, ", probability %.3g\n", s.probability);
  for (size_t i = 0; pendres_fit_jump_get(w->fit, i) != NULL; i++)
    print_jump(out, w, pendres_fit_jump_get(w->fit, i));
  for (size_t i = 0; pendres_fit_note_get(w->fit, i) != NULL; i++)
    fprintf(out, "note: %s\n", pendres_fit_note_get(w->fit, i));
}

/* ---- the scene ----------------------------------------------------------------------------- */

static void find_fit(fit_work *w)
{
  const deck *d = w->d;
  pendres_context *ctx = scene_context(w->run);
  if (ctx == NULL) return;
  deck_si si;
  const double axis = fit_units_of_data(w->d, w->data.of.axis, &si) ? si.factor : 1.0;
  const pendres_fit_options options = {.huber = d->fit.huber,
                                       .jump_error = d->fit.jump_error * w->data.axis_factor / axis,
                                       .starts = (int)d->fit.starts,
                                       .iterations = (int)d->fit.iterations};
  const pendres_fit_model model = {.pendulum = w->model, .unknowns = w->n, .unknown = w->unknown};
  char doing[160];
  snprintf(doing, sizeof doing, "the fit of %.100s has no answer yet", w->data.path);
  farm_doing(w->run->farm, doing);
  farm_keep_begin(w->run->farm, ctx, "fit");
  const pendres_status status = pendres_fit_find(ctx, &w->data.of, &model, &options, &w->fit);
  farm_keep_end(w->run->farm, ctx);
  farm_doing(w->run->farm, "");
  if (status == PENDRES_OK) return;
  size_t datum = w->data.of.n;
  const char *why = NULL;
  (void)pendres_fit_data_check(&w->data.of, &model, &datum, &why);
  if (datum < w->data.of.n)
    (void)scene_fail(w->run, status, "%s:%zu: %s", w->data.path, w->data.line[datum], why);
  else if (w->fit == NULL)
    (void)scene_fail(w->run, status, "%s: %s", w->data.path, pendres_context_message(ctx));
  if (w->fit == NULL) return;
  scene_failure_count(w->run, SCENE_FAILURE_NOT_CONVERGED, 1);
  scene_failure_tell(w->run, SCENE_FAILURE_NOT_CONVERGED, NULL, "the fit of %s", w->data.path);
}

static pendres_status run_scene(scene_run *run)
{
  fit_work w = {.run = run, .d = run->deck};
  fit_data_read(run, &w.data);
  if (scene_going(run)) set_unknowns(&w);
  if (scene_going(run)) check_model(&w);
  if (scene_going(run)) check_acceleration(&w);
  if (scene_going(run)) fit_units_take(&w);
  if (scene_going(run)) find_fit(&w);
  if (scene_going(run)) fit_write(&w);
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
