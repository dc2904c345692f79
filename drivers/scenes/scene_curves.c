/* scene_curves.c -- folds, flips and cusps of a deck's dampings; see scene_curves.h. */
#include "scenes/scene_curves.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene_failed.h"

void scene_curves_free(scene_curves *c)
{
  free(c->list);
  pendres_curves_free(c->curves);
  *c = (scene_curves){0};
}

pendres_status scene_curves_add(scene_curves *c, const pendres_branches *branches)
{
  for (size_t i = 0; i < pendres_branches_count(branches); i++) {
    const pendres_branch *b = pendres_branches_get(branches, i);
    for (size_t k = 0; k < pendres_branch_bifurcations(b); k++) {
      if (c->count == c->capacity) {
        const size_t capacity = 2 * c->capacity + 64;
        pendres_bifurcation *grown = realloc(c->list, capacity * sizeof *grown);
        if (grown == NULL) return PENDRES_OUT_OF_MEMORY;
        c->list = grown;
        c->capacity = capacity;
      }
      c->list[c->count++] = *pendres_branch_bifurcation(b, k);
    }
  }
  return PENDRES_OK;
}

/* ---- curves -------------------------------------------------------------------------------- */

/* SA, LA and the orbits between: period one, their own mirror images. */
static int named_family(const pendres_orbit *o)
{
  return o->period == 1 && o->winding == 0 && o->symmetric;
}

static int is_named_fold(const pendres_bifurcation *b)
{
  return b->kind == PENDRES_FOLD && named_family(&b->orbit);
}

/* The cusp of the named family with the largest damping. */
static void find_cusp(scene_curves *c)
{
  for (size_t i = 0; i < pendres_curves_count(c->curves); i++) {
    const pendres_curve *curve = pendres_curves_get(c->curves, i);
    for (size_t k = 0; k < pendres_curve_cusps(curve); k++) {
      const pendres_cusp *cusp = pendres_curve_cusp(curve, k);
      if (!named_family(&cusp->orbit)) continue;
      if (c->has_cusp && cusp->value[1] <= c->cusp.value[1]) continue;
      c->cusp = *cusp;
      c->has_cusp = 1;
    }
  }
}

pendres_status scene_curves_follow(scene_run *run, scene_curves *c)
{
  const deck_axis *damping = &run->deck->axis[DECK_AXIS_DAMPING];
  const deck_axis *frequency = &run->deck->axis[DECK_AXIS_DRIVE_FREQUENCY];
  const double low = frequency->value[0], high = frequency->value[frequency->count - 1];
  const double weakest = damping->value[0], strongest = damping->value[damping->count - 1];
  /* Up in damping as far as the cusp, wherever it is; down a little below the deck's own. */
  const pendres_curve_options options = {
    .second = PENDRES_DAMPING,
    .low = {fmin(0.8 * low, 0.7), fmin(0.06, 0.98 * weakest)},
    .high = {fmax(1.1 * high, 1.1), fmax(2.0, strongest)}};
  pendres_context *ctx = farm_context(run->farm);
  if (ctx == NULL) return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for a context");
  const pendres_status status =
    c->curves == NULL ? pendres_curves_find(ctx, c->count, c->list, &options, &c->curves)
                      : pendres_curves_extend(ctx, c->count, c->list, &options, c->curves);
  const scene_failure reason = scene_failure_of(status);
  if (status != PENDRES_OK && reason == SCENE_FAILURE_NONE)
    return scene_fail(run, status, "%s", pendres_context_message(ctx));
  /* What was found stays; that there may be more is said, once. */
  if (reason != SCENE_FAILURE_NONE && c->failed == SCENE_FAILURE_NONE) {
    run->failed_points++;
    scene_failure_tell(run, reason, pendres_context_message(ctx), "curves of bifurcations");
    c->failed = (int8_t)reason;
  }
  find_cusp(c);
  return PENDRES_OK;
}

/* ---- arrays -------------------------------------------------------------------------------- */

pendres_status scene_curves_put(scene_run *run, const char *dimension, const char *name,
                                const char *long_name, const char *units, const double *value,
                                const double *error, size_t n)
{
  const pendres_store_spec spec = {
    .name = name, .dimensions = {dimension}, .long_name = long_name, .units = units};
  const pendres_status status = pendres_store_put_result(run->store, &spec, value, error, n);
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

static pendres_status put_flags(scene_run *run, const char *dimension, const char *name,
                                const char *long_name, int count, const char *const *meanings,
                                const int8_t *value, size_t n)
{
  const pendres_store_spec spec = {.name = name,
                                   .type = PENDRES_STORE_INT8,
                                   .dimensions = {dimension},
                                   .long_name = long_name,
                                   .flag_count = count,
                                   .flag_meanings = meanings};
  const pendres_status status = pendres_store_put(run->store, &spec, value, n);
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

static pendres_status put_integers(scene_run *run, const char *dimension, const char *name,
                                   const char *long_name, const int32_t *value, size_t n)
{
  const pendres_store_spec spec = {
    .name = name, .type = PENDRES_STORE_INT32, .dimensions = {dimension}, .long_name = long_name};
  const pendres_status status = pendres_store_put(run->store, &spec, value, n);
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

static const char *const branch_meanings[] = {"sa", "la", "other"};
static const char *const kind_meanings[] = {"regular", "fold", "period_doubling",
                                            "symmetry_breaking"};

/* Columns of a table of points, each of n. */
enum { DAMPING, DAMPING_ERROR, FREQUENCY, FREQUENCY_ERROR, AMPLITUDE, AMPLITUDE_ERROR, CURVATURE,
       CURVATURE_ERROR, LARGER_MULTIPLIER, LARGER_MULTIPLIER_ERROR, SMALLER_MULTIPLIER,
       SMALLER_MULTIPLIER_ERROR, COLUMNS };

typedef struct table {
  size_t n;
  double *column[COLUMNS];
  int8_t *flag, *kind;
  int32_t *number, *period;
} table;

static void table_free(table *t)
{
  for (int i = 0; i < COLUMNS; i++) free(t->column[i]);
  free(t->flag);
  free(t->kind);
  free(t->number);
  free(t->period);
}

static pendres_status table_create(scene_run *run, size_t n, table *t)
{
  *t = (table){.n = 0};
  for (int i = 0; i < COLUMNS; i++) {
    t->column[i] = malloc((n + 1) * sizeof *t->column[i]);
    if (t->column[i] == NULL) goto no_memory;
  }
  t->flag = malloc(n + 1);
  t->kind = malloc(n + 1);
  t->number = malloc((n + 1) * sizeof *t->number);
  t->period = malloc((n + 1) * sizeof *t->period);
  if (t->flag == NULL || t->kind == NULL || t->number == NULL || t->period == NULL) goto no_memory;
  return PENDRES_OK;
no_memory:
  return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu points of curves", n);
}

static void table_add(table *t, const pendres_orbit *o, double damping_error,
                      double frequency_error)
{
  const size_t i = t->n++;
  t->column[DAMPING][i] = o->pendulum.damping;
  t->column[DAMPING_ERROR][i] = damping_error;
  t->column[FREQUENCY][i] = o->pendulum.drive_frequency;
  t->column[FREQUENCY_ERROR][i] = frequency_error;
  t->column[AMPLITUDE][i] = o->amplitude;
  t->column[AMPLITUDE_ERROR][i] = o->amplitude_error;
  t->column[LARGER_MULTIPLIER][i] = o->multiplier_re[0];
  t->column[LARGER_MULTIPLIER_ERROR][i] = o->multiplier_error;
  t->column[SMALLER_MULTIPLIER][i] = o->multiplier_re[1];
  t->column[SMALLER_MULTIPLIER_ERROR][i] = o->multiplier_error;
  t->period[i] = o->period;
}

static pendres_status put_column(scene_run *run, const table *t, const char *dimension, int column,
                                 const char *what, const char *words, const char *units)
{
  char name[64];
  (void)snprintf(name, sizeof name, "%s_%s", dimension, what);
  return scene_curves_put(run, dimension, name, words, units, t->column[column],
                          t->column[column + 1], t->n);
}

/* What all three tables have. */
static pendres_status put_table(scene_run *run, const table *t, const char *dimension)
{
  char name[64];
  pendres_status status =
    pendres_store_dimension(run->store, "", dimension, t->n, NULL, "number of the point", "1");
  if (status != PENDRES_OK) return scene_store_failed(run, status);
  status = put_column(run, t, dimension, DAMPING, "damping", "friction coefficient there", "1");
  if (status == PENDRES_OK)
    status = put_column(run, t, dimension, FREQUENCY, "frequency", "drive frequency there", "1");
  if (status == PENDRES_OK)
    status = put_column(run, t, dimension, AMPLITUDE, "amplitude",
                        "amplitude of the orbit there", "rad");
  if (status == PENDRES_OK)
    status = put_column(run, t, dimension, LARGER_MULTIPLIER, "multiplier",
                        "Floquet multiplier of the larger modulus", "1");
  if (status == PENDRES_OK)
    status = put_column(run, t, dimension, SMALLER_MULTIPLIER, "other_multiplier",
                        "Floquet multiplier of the smaller modulus", "1");
  (void)snprintf(name, sizeof name, "%s_period", dimension);
  if (status == PENDRES_OK)
    status = put_integers(run, dimension, name, "drive periods until the orbit closes", t->period,
                          t->n);
  return status;
}

/* Which branch ends in a fold: on either side of the cusp another one. */
static int8_t branch_ending(const scene_curves *c, const pendres_orbit *o, double curvature)
{
  if (!named_family(o)) return 2;
  if (c->has_cusp) return o->amplitude < c->cusp.orbit.amplitude ? 0 : 1;
  return curvature < 0.0 ? 0 : 1;
}

static size_t count_points(const scene_curves *c, int folds)
{
  size_t n = 0;
  for (size_t i = 0; i < pendres_curves_count(c->curves); i++) {
    const pendres_curve *curve = pendres_curves_get(c->curves, i);
    if ((pendres_curve_kind(curve) == PENDRES_FOLD) == folds) n += pendres_curve_count(curve);
  }
  return n;
}

/* All points of the curves of folds, or of the others. */
static pendres_status write_points(scene_run *run, const scene_curves *c, int folds)
{
  const char *dimension = folds ? "fold" : "flip";
  table t;
  pendres_status status = table_create(run, count_points(c, folds), &t);
  int32_t number = 0;
  for (size_t i = 0; i < pendres_curves_count(c->curves) && status == PENDRES_OK; i++) {
    const pendres_curve *curve = pendres_curves_get(c->curves, i);
    if ((pendres_curve_kind(curve) == PENDRES_FOLD) != folds) continue;
    for (size_t k = 0; k < pendres_curve_count(curve); k++) {
      const pendres_curve_point *p = pendres_curve_get(curve, k);
      t.flag[t.n] = branch_ending(c, &p->orbit, p->curvature);
      t.kind[t.n] = (int8_t)pendres_curve_kind(curve);
      t.number[t.n] = number;
      table_add(&t, &p->orbit, p->value_error[1], p->value_error[0]);
    }
    number++;
  }
  if (status == PENDRES_OK) status = put_table(run, &t, dimension);
  if (status == PENDRES_OK)
    status = put_integers(run, dimension, folds ? "fold_curve" : "flip_curve",
                          "number of the curve; its points are in order", t.number, t.n);
  if (status == PENDRES_OK && folds)
    status = put_flags(run, dimension, "fold_branch", "which branch ends there", 3,
                       branch_meanings, t.flag, t.n);
  if (status == PENDRES_OK && !folds)
    status = put_flags(run, dimension, "flip_kind", "what happens there", 4, kind_meanings, t.kind,
                       t.n);
  table_free(&t);
  return status;
}

/* The bifurcations met along the deck's dampings. */
static pendres_status write_bifurcations(scene_run *run, const scene_curves *c)
{
  table t;
  pendres_status status = table_create(run, c->count, &t);
  for (size_t i = 0; i < c->count && status == PENDRES_OK; i++) {
    const pendres_bifurcation *b = &c->list[i];
    t.flag[t.n] = b->kind == PENDRES_FOLD ? branch_ending(c, &b->orbit, b->curvature) : 2;
    t.kind[t.n] = (int8_t)b->kind;
    t.column[CURVATURE][t.n] = b->curvature;
    t.column[CURVATURE_ERROR][t.n] = b->curvature_error;
    table_add(&t, &b->orbit, 0.0, b->value_error);
  }
  if (status == PENDRES_OK) status = put_table(run, &t, "bifurcation");
  if (status == PENDRES_OK)
    status = put_column(run, &t, "bifurcation", CURVATURE, "curvature", "of a fold: second "
                        "derivative of the frequency by arclength in (x, v); below 0: orbits "
                        "exist below", "1");
  if (status == PENDRES_OK)
    status = put_flags(run, "bifurcation", "bifurcation_kind", "what happens there", 4,
                       kind_meanings, t.kind, t.n);
  if (status == PENDRES_OK)
    status = put_flags(run, "bifurcation", "bifurcation_branch", "which branch ends there", 3,
                       branch_meanings, t.flag, t.n);
  table_free(&t);
  return status;
}

static pendres_status put_scalar(scene_run *run, const char *name, const char *long_name,
                                 const char *units, double value, double error)
{
  const pendres_store_spec spec = {.name = name, .long_name = long_name, .units = units};
  const pendres_status status = pendres_store_put_result(run->store, &spec, &value, &error, 1);
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

static pendres_status write_failed(scene_run *run, const scene_curves *c)
{
  pendres_store_spec spec = {.name = "curves_failed",
                             .long_name = "why the curves of bifurcations are not whole"};
  scene_failure_flags(&spec);
  const pendres_status status = pendres_store_put(run->store, &spec, &c->failed, 1);
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

static pendres_status write_cusp(scene_run *run, const scene_curves *c)
{
  const pendres_cusp *k = &c->cusp;
  const int has = c->has_cusp;
  pendres_status status =
    put_scalar(run, "cusp_damping", "damping at which SA and LA become one", "1",
               has ? k->value[1] : NAN, has ? k->value_error[1] : NAN);
  if (status == PENDRES_OK)
    status = put_scalar(run, "cusp_frequency", "drive frequency there", "1",
                        has ? k->value[0] : NAN, has ? k->value_error[0] : NAN);
  if (status == PENDRES_OK)
    status = put_scalar(run, "cusp_amplitude", "amplitude of the orbit there", "rad",
                        has ? k->orbit.amplitude : NAN, has ? k->orbit.amplitude_error : NAN);
  return status;
}

pendres_status scene_curves_write(scene_run *run, const scene_curves *c)
{
  pendres_status status = write_points(run, c, 1);
  if (status == PENDRES_OK) status = write_points(run, c, 0);
  if (status == PENDRES_OK) status = write_bifurcations(run, c);
  if (status == PENDRES_OK) status = write_cusp(run, c);
  if (status == PENDRES_OK) status = write_failed(run, c);
  return status;
}

/* ---- the paper ----------------------------------------------------------------------------- */

const pendres_bifurcation *scene_curves_fold(const scene_curves *c, double damping, int la)
{
  const pendres_bifurcation *best = NULL;
  for (size_t i = 0; i < c->count; i++) {
    const pendres_bifurcation *b = &c->list[i];
    if (!is_named_fold(b) || fabs(b->orbit.pendulum.damping - damping) > 1e-9) continue;
    if ((b->curvature > 0.0) != la) continue;
    /* Of several on a line the one next to the cusp: the highest frequency. */
    if (best == NULL || b->value > best->value) best = b;
  }
  return best;
}

pendres_status scene_curves_write_paper(scene_run *run, const scene_curves *c)
{
  scene_printed values[4];
  size_t n = 0;
  const double drive = run->deck->pendulum.drive_amplitude;
  const int main_case = fabs(drive - 0.2) < 1e-9, inset = fabs(drive - 0.1) < 1e-9;
  if (c->has_cusp && (main_case || inset))
    values[n++] = (scene_printed){.name = "critical_damping",
                                  .printed = main_case ? 0.164 : 0.099,
                                  .computed = c->cusp.value[1],
                                  .error = c->cusp.value_error[1]};
  const pendres_bifurcation *la = scene_curves_fold(c, 0.13, 1);
  const pendres_bifurcation *sa = scene_curves_fold(c, 0.13, 0);
  if (main_case && la != NULL)
    values[n++] = (scene_printed){.name = "sa_only_below_frequency_damping_0_13",
                                  .printed = 0.74, .computed = la->value, .error = la->value_error};
  if (main_case && sa != NULL)
    values[n++] = (scene_printed){.name = "la_only_above_frequency_damping_0_13",
                                  .printed = 0.85, .computed = sa->value, .error = sa->value_error};
  return n > 0 ? scene_write_paper(run, n, values) : PENDRES_OK;
}
