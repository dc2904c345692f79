/* scene.c -- the list of scenes, and what several of them need; see scene.h. */
#include "scenes/scene.h"

#include <math.h>
#include <string.h>

/* A line for each kind. */
#define SCENES(X)          \
  X(free_oscillation)      \
  X(resonance_curve)       \
  X(response)              \
  X(orbit)                 \
  X(basins)                \
  X(work_precision)        \
  X(phase_diagram)         \
  X(branches)              \
  X(switching)             \
  X(hard_cases)            \
  X(hysteresis)            \
  X(bifurcation_diagram)   \
  X(lyapunov_map)          \
  X(escape)                \
  X(fit)

#define DECLARE(name) extern const scene_kind scene_##name;
SCENES(DECLARE)

#define ADDRESS(name) &scene_##name,
static const scene_kind *const scenes[] = { SCENES(ADDRESS) };

const scene_kind *scene_find(deck_kind kind)
{
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
    if (scenes[i]->kind == kind) return scenes[i];
  return NULL;
}

/* ---- options ------------------------------------------------------------------------------- */

pendres_status scene_precision(const deck *d, pendres_options *out, const char **why)
{
  *out = (pendres_options){ .tolerance = d->precision.tolerance,
                            .steps_per_period = (int)d->precision.steps_per_period,
                            .block_lanes = (int)d->precision.block_lanes,
                            .period_budget = (long)d->precision.period_budget,
                            .seed = (uint64_t)d->noise.seed };
  const scene_kind *scene = scene_find(d->kind);
  if (scene != NULL && scene->options != NULL) scene->options(d, out);
  const char *method = d->precision.method, *table = d->precision.table;
  if (method[0] != '\0')
    out->method = (pendres_method)pendres_name_find(PENDRES_NAMES_METHOD, method);
  if (table[0] != '\0') out->table = (pendres_table)pendres_name_find(PENDRES_NAMES_TABLE, table);
  *why = pendres_options_check(out);
  return *why == NULL ? PENDRES_OK : PENDRES_INVALID_ARGUMENT;
}

/* ---- fixed parameters, ensembles and sweeps ------------------------------------------------- */

double scene_fixed(const deck *d, deck_axis_id axis)
{
  const deck_axis *a = &d->axis[axis];
  const pendres_parameter parameter = deck_axis_parameter(axis);
  const pendres_parameter_info *info = pendres_parameter_of(parameter);
  const int coefficients = pendres_model_of(d->pendulum.force)->coefficients;
  if (a->count > 0) return a->count == 1 && !deck_has_axis(d, axis) ? a->value[0] : NAN;
  if (axis == DECK_AXIS_DRIVE_PERIOD) return d->drive_period;
  if ((int)parameter >= PENDRES_PARAMETER_FOLLOWED) return NAN; /* another one stands for it */
  const double value = pendres_parameter_get(parameter, &d->pendulum);
  if (info->coefficient > 0) return info->coefficient <= coefficients ? value : NAN;
  return value != 0.0 || info->plain ? value : NAN;
}

/* Whether the outer axis varies it: frequency and period of the drive are one. */
static int is_outer(const deck *d, deck_axis_id axis)
{
  char name[2 * DECK_NAME];
  if (deck_slices(d) == 0) return 0;
  deck_outer_name(d, name);
  if (deck_is_clock(axis))
    return strcmp(name, "drive_frequency") == 0 || strcmp(name, "drive_period") == 0;
  return strcmp(name, deck_axis_name(axis)) == 0;
}

/* A parameter that the deck holds fixed; its name is added to those of coordinates. */
static void write_fixed(scene_run *run, deck_axis_id axis, char *coordinates)
{
  const deck *d = run->deck;
  const double value = scene_fixed(d, axis);
  const int coefficient = pendres_parameter_of(deck_axis_parameter(axis))->coefficient;
  pendres_store_spec spec = { .name = deck_axis_name(axis), .long_name = scene_axis_words(axis) };
  if (isnan(value) || is_outer(d, axis)) return;
  if (deck_fit_has(d, spec.name)) return; /* a guess, or not the value that is used */
  /* In other scenes the temperature is a dimension, even with one value. */
  if (axis == DECK_AXIS_TEMPERATURE && !scene_find(d->kind)->one_temperature) return;
  if (coefficient > 0)
    spec.long_name = d->pendulum.force == PENDRES_FORCE_POLYNOMIAL
                       ? "coefficient of the polynomial force"
                       : "coefficient of the force";
  if (coordinates[0] != '\0') strcat(coordinates, " ");
  strcat(coordinates, spec.name);
  scene_put(run, &spec, &value, NULL, 1);
}

static void put_attribute(scene_run *run, const char *name, const char *text)
{
  results_attribute(run, "", NULL, name, text);
}

void scene_write_identity(scene_run *run)
{
  const deck *d = run->deck;
  char coordinates[DECK_AXIS_COUNT * DECK_NAME] = "";
  const char *slash = strrchr(d->name, '/');
  if (!scene_going(run)) return;
  put_attribute(run, "scene", deck_kind_name(d->kind));
  put_attribute(run, "deck", slash != NULL ? slash + 1 : d->name);
  for (int i = 0; i <= DECK_AXIS_TEMPERATURE; i++) write_fixed(run, (deck_axis_id)i, coordinates);
  if (coordinates[0] != '\0') put_attribute(run, "coordinates", coordinates);
}

pendres_ensemble scene_ensemble(const deck *d)
{
  pendres_ensemble e = { .members = (size_t)d->ensemble.members,
                         .x_first = d->ensemble.x_first,
                         .x_last = d->ensemble.x_last,
                         .v = d->ensemble.v,
                         .v_last = d->ensemble.v_last,
                         .rows = (size_t)d->ensemble.rows,
                         .seed = (uint64_t)d->ensemble.seed };
  const int shape = pendres_name_find(PENDRES_NAMES_ENSEMBLE_SHAPE, d->ensemble.shape);
  if (shape >= 0) e.shape = (pendres_ensemble_shape)shape;
  return e;
}

pendres_sweep scene_sweep(const deck *d)
{
  deck_axis_id axis[DECK_AXES];
  const int n = deck_axes(d, axis);
  pendres_sweep s = { .pendulum = deck_pendulum(d), .axes = (size_t)n };
  for (int i = 0; i < n; i++)
    s.axis[i] = (pendres_axis){ deck_axis_parameter(axis[i]), d->axis[axis[i]].count,
                                d->axis[axis[i]].value };
  return s;
}
