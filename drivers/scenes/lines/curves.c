/* curves.c -- folds, flips and cusps of a diagram; see lines.h. */
#include "scenes/lines/lines.h"

#include <math.h>

/* Which branch ends at a fold. */
SCENE_NAMES(endings, "sa", "la", "other")

/* ---- points of curves, and bifurcations along lines ---------------------------------------- */

typedef struct row {
  scene_place place;
  double amplitude, amplitude_error;
  double multiplier, other_multiplier, multiplier_error, curvature, curvature_error;
  int curve, branch, kind, period;
} row;

static const scene_column columns[] = {
  SCENE_COLUMN(row, amplitude, "amplitude of the orbit there"),
  SCENE_COLUMN(row, multiplier, "Floquet multiplier of the larger modulus"),
  {.name = "other_multiplier", .long_name = "Floquet multiplier of the smaller modulus",
   .value = offsetof(row, other_multiplier),
   .error = offsetof(row, multiplier_error)},
  {SCENE_TYPED(SCENE_NUMBER, "period", row, period, NULL)},
};

static const scene_column of_folds[] = {
  {SCENE_TYPED(SCENE_NUMBER, "curve", row, curve, "number of the curve; its points are in order")},
  SCENE_CODE(row, branch, "which branch ends there", endings),
};

static const scene_column of_flips[] = {
  {SCENE_TYPED(SCENE_NUMBER, "curve", row, curve, "number of the curve; its points are in order")},
  SCENE_CODE(row, kind, "what happens there", scene_special_names),
};

static const scene_column of_bifurcations[] = {
  SCENE_COLUMN(row, curvature, "of a fold: second derivative of the frequency by arclength in "
               "(x, v); below 0: orbits exist below"),
  SCENE_CODE(row, kind, "what happens there", scene_special_names),
  SCENE_CODE(row, branch, "which branch ends there", endings),
};

static row row_of(const scene_lines *l, const pendres_orbit *o, const double error[2],
                  pendres_special kind, double curvature)
{
  const pendres_label ending = kind == PENDRES_FOLD
                                 ? pendres_phase_diagram_ending_get(l->diagram, o, curvature)
                                 : PENDRES_LABEL_PERIODIC;
  return (row){.place = scene_lines_place(l, &o->pendulum, error),
               .amplitude = o->amplitude,
               .amplitude_error = o->amplitude_error,
               .multiplier = o->multiplier_re[0],
               .other_multiplier = o->multiplier_re[1],
               .multiplier_error = o->multiplier_error,
               .curvature = curvature,
               .branch = ending == PENDRES_LABEL_SA ? 0 : ending == PENDRES_LABEL_LA ? 1 : 2,
               .kind = (int)kind,
               .period = o->period};
}

static void write_table(const scene_lines *l, const char *dimension, size_t n,
                        const row *rows)
{
  const scene_table table = {.dimensions = {dimension}, .prefix = dimension, SCENE_ROWS(rows, n)};
  const scene_column *rest = dimension[0] == 'b' ? of_bifurcations
                             : dimension[1] == 'o' ? of_folds
                                                   : of_flips;
  scene_numbering(l->run, dimension, n, "number of the point");
  scene_lines_write_places(l, &table, "there", sizeof columns / sizeof *columns, columns);
  scene_columns_write(l->run, &table, rest == of_bifurcations ? 3 : 2, rest);
}

/* All points of the curves of folds, or of the others. */
static size_t take_curves(const scene_lines *l, int folds, row *rows)
{
  const pendres_curves *curves = pendres_phase_diagram_get(l->diagram).curves;
  size_t n = 0;
  int number = 0;
  for (size_t i = 0; i < pendres_curves_count(curves); i++) {
    const pendres_curve *curve = pendres_curves_get(curves, i);
    const pendres_special kind = pendres_curve_kind_get(curve);
    if ((kind == PENDRES_FOLD) != folds) continue;
    for (size_t k = 0; k < pendres_curve_count(curve); k++, n++) {
      const pendres_curve_point *p = pendres_curve_get(curve, k);
      if (rows == NULL) continue;
      rows[n] = row_of(l, &p->orbit, p->value_error, kind, p->curvature);
      rows[n].curve = number;
    }
    number++;
  }
  return n;
}

static void write_curves(const scene_lines *l, int folds)
{
  const size_t n = take_curves(l, folds, NULL);
  row *rows = scene_array(l->run, n, sizeof *rows);
  if (rows != NULL) (void)take_curves(l, folds, rows);
  write_table(l, folds ? "fold" : "flip", n, rows);
}

/* The bifurcations met along the lines. */
static void write_bifurcations(const scene_lines *l)
{
  const pendres_phase_curves of = pendres_phase_diagram_get(l->diagram);
  const pendres_bifurcation *b = of.bifurcation;
  const size_t n = of.bifurcations;
  row *rows = scene_array(l->run, n, sizeof *rows);
  for (size_t i = 0; rows != NULL && i < n; i++) {
    rows[i] = row_of(l, &b[i].orbit, (const double[2]){b[i].value_error, 0.0}, b[i].kind,
                     b[i].curvature);
    rows[i].curvature_error = b[i].curvature_error;
  }
  write_table(l, "bifurcation", n, rows);
}

/* ---- the cusp ------------------------------------------------------------------------------ */

static void put_scalar(const scene_lines *l, const char *quantity, const char *name,
                       const char *long_name, const double value[2])
{
  const pendres_store_spec spec = {.name = name, .long_name = long_name};
  scene_put_as(l->run, quantity, &spec, &value[0], &value[1], 1);
}

static void write_cusp(const scene_lines *l)
{
  const pendres_cusp *c = pendres_phase_diagram_get(l->diagram).cusp;
  const scene_place place =
    c != NULL ? scene_lines_place(l, &c->orbit.pendulum, c->value_error) : (scene_place){0};
  for (int k = 0; k < PENDRES_PARAMETER_FOLLOWED; k++) {
    const pendres_parameter of = (pendres_parameter)k;
    const double value[2] = {c != NULL ? place.value[k] : NAN, c != NULL ? place.error[k] : NAN};
    char name[2 * DECK_NAME], words[2 * DECK_NAME], spaced[DECK_NAME];
    if (!scene_lines_changes(l, of)) continue;
    (void)snprintf(name, sizeof name, "cusp_%s", scene_column_name(of));
    (void)snprintf(words, sizeof words, "%s %s", scene_spaced(of, spaced),
                   of == PENDRES_DAMPING ? "at which SA and LA become one" : "there");
    put_scalar(l, pendres_parameter_of(of)->name, name, words, value);
  }
  const double amplitude[2] = {c != NULL ? c->orbit.amplitude : NAN,
                               c != NULL ? c->orbit.amplitude_error : NAN};
  put_scalar(l, "amplitude", "cusp_amplitude", "amplitude of the orbit there", amplitude);
}

static void write_failed(const scene_lines *l)
{
  const scene_failed of = {scene_failure_of(pendres_phase_diagram_get(l->diagram).outcome), NULL};
  const scene_table table = {SCENE_ROWS(&of, 1)};
  scene_columns_write_failed(l->run, &table, "curves_failed",
                             "why the curves of bifurcations are not whole");
}

void scene_curves_write(const scene_lines *l)
{
  write_curves(l, 1);
  write_curves(l, 0);
  write_bifurcations(l);
  write_cusp(l);
  write_failed(l);
}

/* ---- the paper ----------------------------------------------------------------------------- */

/* The line of a damping; the number of lines if there is none. */
static size_t line_at(const scene_lines *l, double damping)
{
  size_t i = 0;
  while (i < l->grid.lines && fabs(l->grid.line_value[i] - damping) > 1e-9) i++;
  return i;
}

void scene_curves_write_paper(const scene_lines *l)
{
  scene_printed values[4];
  size_t n = 0;
  if (l->points.axis[0] != DECK_AXIS_DAMPING || l->points.axis[1] != DECK_AXIS_DRIVE_FREQUENCY ||
      !deck_is_plain(l->run->deck))
    return;
  const double f0 = l->grid.pendulum.drive_amplitude;
  const int main_case = fabs(f0 - 0.2) < 1e-9, inset = fabs(f0 - 0.1) < 1e-9;
  const pendres_cusp *c = pendres_phase_diagram_get(l->diagram).cusp;
  if (c != NULL && (main_case || inset))
    values[n++] = (scene_printed){.name = "critical_damping",
                                  .printed = main_case ? 0.164 : 0.099,
                                  .computed = c->value[1],
                                  .error = c->value_error[1]};
  const size_t line = line_at(l, 0.13);
  const pendres_bifurcation *la = pendres_phase_diagram_fold_get(l->diagram, line,
                                                                 PENDRES_LABEL_LA);
  const pendres_bifurcation *sa = pendres_phase_diagram_fold_get(l->diagram, line,
                                                                 PENDRES_LABEL_SA);
  if (main_case && la != NULL)
    values[n++] = (scene_printed){.name = "sa_only_below_frequency_damping_0_13",
                                  .printed = 0.74, .computed = la->value, .error = la->value_error};
  if (main_case && sa != NULL)
    values[n++] = (scene_printed){.name = "la_only_above_frequency_damping_0_13",
                                  .printed = 0.85, .computed = sa->value, .error = sa->value_error};
  scene_write_paper(l->run, n, values);
}
