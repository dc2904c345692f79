/* scene.c -- the list of scenes, and what several of them need; see scene.h. */
#include "scenes/scene.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A line for each scene_NAME.c. */
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
  X(lyapunov_map)

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
                            .seed = deck_seed(d) };
  /* Other scenes ask how long chaos lasts, too: their averages are as long as the library's. */
  if (d->kind == DECK_BIFURCATION_DIAGRAM)
    out->exponent_error = d->diagram.exponents ? d->precision.exponent_error : 1.0;
  const char *method = d->precision.method, *table = d->precision.table;
  if (method[0] != '\0')
    out->method = (pendres_method)pendres_name_find(PENDRES_NAMES_METHOD, method);
  if (table[0] != '\0') out->table = (pendres_table)pendres_name_find(PENDRES_NAMES_TABLE, table);
  *why = pendres_options_check(out);
  return *why == NULL ? PENDRES_OK : PENDRES_INVALID_ARGUMENT;
}

/* ---- failures ------------------------------------------------------------------------------ */

int scene_going(const scene_run *run)
{
  return run->status == PENDRES_OK;
}

int scene_prints(const scene_run *run)
{
  return run->table != NULL && scene_going(run);
}

pendres_status scene_fail(scene_run *run, pendres_status status, const char *format, ...)
{
  va_list args;
  if (!scene_going(run)) return run->status;
  run->status = status;
  va_start(args, format);
  (void)vsnprintf(run->message, sizeof run->message, format, args);
  va_end(args);
  return status;
}

pendres_status scene_stored(scene_run *run, pendres_status status)
{
  if (status != PENDRES_OK) (void)scene_fail(run, status, "%s", pendres_store_message(run->store));
  return run->status;
}

pendres_context *scene_context(scene_run *run)
{
  pendres_context *ctx = scene_going(run) ? farm_context(run->farm) : NULL;
  if (ctx == NULL) (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for a context");
  return ctx;
}

pendres_status scene_asked(scene_run *run, pendres_status status)
{
  if (status != PENDRES_OK)
    (void)scene_fail(run, status, "%s", pendres_context_message(farm_context(run->farm)));
  return run->status;
}

pendres_status scene_compute(scene_run *run, const farm_stage *stage)
{
  if (!scene_going(run)) return run->status;
  const pendres_status status = farm_run(run->farm, stage);
  return status == PENDRES_OK ? run->status : scene_fail(run, status, "%s",
                                                         farm_message(run->farm));
}

pendres_status scene_put(scene_run *run, const pendres_store_spec *spec, const void *values,
                         const double *errors, size_t n)
{
  if (!scene_going(run)) return run->status;
  return scene_stored(run, pendres_store_put(run->store, spec, values, errors, n));
}

pendres_status scene_put_dimension(scene_run *run, const pendres_store_spec *spec,
                                   const void *values, size_t n)
{
  if (!scene_going(run)) return run->status;
  return scene_stored(run, pendres_store_dimension(run->store, spec, n, values));
}

/* ---- arrays -------------------------------------------------------------------------------- */

/* Before the elements of an array, which are aligned as those of malloc are. */
typedef struct scene_held {
  struct scene_held *next;
  max_align_t elements[];
} scene_held;

void *scene_array(scene_run *run, size_t n, size_t size)
{
  if (!scene_going(run)) return NULL;
  const size_t head = sizeof(scene_held);
  scene_held *held = size == 0 || n < (SIZE_MAX - head) / size ? calloc(1, head + (n + 1) * size)
                                                               : NULL;
  if (held == NULL) {
    (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu results", n);
    return NULL;
  }
  held->next = run->held;
  run->held = held;
  return held->elements;
}

void scene_end(scene_run *run)
{
  while (run->held != NULL) {
    scene_held *next = run->held->next;
    free(run->held);
    run->held = next;
  }
}

/* ---- axes, fixed parameters and ensembles -------------------------------------------------- */

static const struct { const char *words, *units; } about[DECK_AXIS_COUNT] = {
  [DECK_AXIS_AMPLITUDE] = { "amplitude of the angle", "rad" },
  [DECK_AXIS_DAMPING] = { "friction coefficient gamma", "1" },
  [DECK_AXIS_DRIVE_AMPLITUDE] = { "drive amplitude F0", "1" },
  [DECK_AXIS_DRIVE_FREQUENCY] = { "angular frequency of the drive", "1" },
  [DECK_AXIS_DRIVE_PERIOD] = { "period of the drive", "1" },
  [DECK_AXIS_TORQUE] = { "constant torque I", "1" },
  [DECK_AXIS_PARAMETRIC_AMPLITUDE] = { "amplitude b of the parametric drive", "1" },
  [DECK_AXIS_X] = { "initial position", "rad" },
  [DECK_AXIS_V] = { "initial velocity", "1" },
  [DECK_AXIS_TEMPERATURE] = { "temperature k T / (m g l)", "1" },
  [DECK_AXIS_TOLERANCE] = { "tolerance asked for", "1" },
};

#define PARAMETER(axis, singular, plural, above, in_tables, words, kind) \
  {DECK_AXIS_##axis, singular, plural, "groups of " plural, above, in_tables, words, \
   PENDRES_##axis, kind}
const scene_parameter scene_parameters[SCENE_PARAMETERS] = {
  PARAMETER(DAMPING, "damping", "dampings", "damping   ", "damping", "friction coefficient",
            PENDRES_DAMPING),
  PARAMETER(DRIVE_FREQUENCY, "drive frequency", "drive frequencies", "drive     ", "frequency",
            "drive frequency", PENDRES_DRIVE_FREQUENCY),
  PARAMETER(DRIVE_AMPLITUDE, "drive amplitude", "drive amplitudes", "drive     ",
            "drive_amplitude", "drive amplitude", PENDRES_DRIVE_AMPLITUDE),
  PARAMETER(TORQUE, "torque", "torques", "torque    ", "torque", "torque", PENDRES_TORQUE),
  PARAMETER(PARAMETRIC_AMPLITUDE, "parametric amplitude", "parametric amplitudes", "parametric",
            "parametric_amplitude", "amplitude of the parametric drive",
            PENDRES_PARAMETRIC_AMPLITUDE),
  PARAMETER(DRIVE_PERIOD, "drive period", "drive periods", "drive     ", "period", "drive period",
            PENDRES_DRIVE_FREQUENCY),
};

const scene_parameter *scene_parameter_of(deck_axis_id axis)
{
  int i = 0;
  while (i + 1 < SCENE_PARAMETERS && scene_parameters[i].axis != axis) i++;
  return &scene_parameters[i];
}

static pendres_status write_dimension(scene_run *run, const char *group, deck_axis_id axis,
                                      const char *words)
{
  const deck_axis *a = &run->deck->axis[axis];
  return scene_put_dimension(
    run, &(pendres_store_spec){.group = group, .name = deck_axis_name(axis), .long_name = words,
                               .units = about[axis].units}, a->value, a->count);
}

pendres_status scene_dimension(scene_run *run, const char *group, deck_axis_id axis)
{
  return write_dimension(run, group, axis, about[axis].words);
}

pendres_status scene_dimension_short(scene_run *run, deck_axis_id axis)
{
  /* Short ones would say too little of these. */
  const int in_full = axis == DECK_AXIS_TORQUE || axis == DECK_AXIS_PARAMETRIC_AMPLITUDE;
  return write_dimension(run, "", axis,
                         in_full ? about[axis].words : scene_parameter_of(axis)->one);
}

pendres_status scene_numbering(scene_run *run, const char *name, size_t n, const char *words)
{
  return scene_put_dimension(run, &(pendres_store_spec){.name = name, .long_name = words}, NULL, n);
}

void scene_plane(const deck *d, deck_axis_id axis[2])
{
  const deck_axis_id drive = d->axis[DECK_AXIS_DRIVE_PERIOD].count > 0 ? DECK_AXIS_DRIVE_PERIOD
                                                                       : DECK_AXIS_DRIVE_FREQUENCY;
  deck_axis_id extra = DECK_AXIS_DAMPING;
  const int has_extra = deck_extra_axis(d, &extra);
  const int tongue = has_extra && d->axis[DECK_AXIS_DAMPING].count == 1 && d->axis[drive].count > 1;
  axis[0] = tongue ? extra : DECK_AXIS_DAMPING;
  axis[1] = has_extra && !tongue ? extra : drive;
}

int scene_axes(const deck *d, deck_axis_id axis[SCENE_AXES])
{
  deck_axis_id plane[2], extra;
  scene_plane(d, plane);
  const size_t drives =
    d->axis[DECK_AXIS_DRIVE_PERIOD].count + d->axis[DECK_AXIS_DRIVE_FREQUENCY].count;
  if (d->kind != DECK_RESPONSE || !deck_extra_axis(d, &extra) ||
      d->axis[DECK_AXIS_DAMPING].count < 2 || drives < 2) {
    axis[0] = plane[0];
    axis[1] = plane[1];
    return 2;
  }
  axis[0] = extra;
  axis[1] = DECK_AXIS_DAMPING;
  axis[2] = d->axis[DECK_AXIS_DRIVE_PERIOD].count > 0 ? DECK_AXIS_DRIVE_PERIOD
                                                      : DECK_AXIS_DRIVE_FREQUENCY;
  return 3;
}

/* Whether it is one of the scene's axes. */
static int is_axis(const deck *d, deck_axis_id axis)
{
  deck_axis_id axes[SCENE_AXES];
  const int n = scene_axes(d, axes);
  for (int i = 0; i < n; i++)
    if (axes[i] == axis) return 1;
  return 0;
}

double scene_fixed(const deck *d, deck_axis_id axis)
{
  deck_axis_id extra;
  if (d->axis[axis].count > 0) {
    /* In a scene in which some parameters move, the others are axes of one value. */
    const int moves = d->kind == DECK_HYSTERESIS || d->kind == DECK_BIFURCATION_DIAGRAM ||
                      d->kind == DECK_LYAPUNOV_MAP;
    const int curve = d->kind == DECK_RESONANCE_CURVE; /* has one axis */
    const int left_out =
      deck_extra_axis(d, &extra) && (curve ? axis != extra : !is_axis(d, axis));
    return d->axis[axis].count == 1 && (moves || left_out) ? d->axis[axis].value[0] : NAN;
  }
  switch (axis) {
  case DECK_AXIS_DRIVE_AMPLITUDE: return d->pendulum.drive_amplitude;
  case DECK_AXIS_DAMPING: return d->pendulum.damping;
  case DECK_AXIS_DRIVE_FREQUENCY: return d->pendulum.drive_frequency;
  case DECK_AXIS_DRIVE_PERIOD: return d->pendulum.drive_period;
  case DECK_AXIS_TORQUE: return d->pendulum.torque != 0.0 ? d->pendulum.torque : NAN;
  case DECK_AXIS_PARAMETRIC_AMPLITUDE:
    return d->pendulum.parametric_amplitude != 0.0 ? d->pendulum.parametric_amplitude : NAN;
  default: return NAN;
  }
}

/* The coefficients of a force; their names are added to those of coordinates. */
static pendres_status write_coefficients(scene_run *run, char *coordinates)
{
  const pendres_pendulum p = deck_pendulum(run->deck);
  const pendres_model *model = pendres_model_of(p.force);
  pendres_status status = PENDRES_OK;
  for (int i = 0; i < model->coefficients && status == PENDRES_OK; i++) {
    const pendres_store_spec spec = { .name = model->coefficient_names[i],
                                      .long_name = p.force == PENDRES_FORCE_POLYNOMIAL
                                                     ? "coefficient of the polynomial force"
                                                     : "coefficient of the force" };
    status = pendres_store_put(run->store, &spec, &p.force_coefficients[i], NULL, 1);
    if (coordinates[0] != '\0') strcat(coordinates, " ");
    strcat(coordinates, spec.name);
  }
  return status;
}

pendres_status scene_write_identity(scene_run *run)
{
  const deck *d = run->deck;
  static const deck_axis_id parameters[] = { DECK_AXIS_DRIVE_AMPLITUDE, DECK_AXIS_DAMPING,
                                             DECK_AXIS_DRIVE_FREQUENCY, DECK_AXIS_DRIVE_PERIOD,
                                             DECK_AXIS_TORQUE, DECK_AXIS_PARAMETRIC_AMPLITUDE,
                                             DECK_AXIS_TEMPERATURE };
  char coordinates[(7 + PENDRES_FORCE_COEFFICIENTS) * DECK_NAME] = "";
  const char *slash = strrchr(d->name, '/');
  pendres_status status =
    pendres_store_attribute(run->store, "", NULL, "scene", deck_kind_name(d->kind));
  if (status == PENDRES_OK)
    status = pendres_store_attribute(run->store, "", NULL, "deck",
                                          slash != NULL ? slash + 1 : d->name);
  for (size_t i = 0; i < sizeof parameters / sizeof *parameters && status == PENDRES_OK; i++) {
    const deck_axis_id axis = parameters[i];
    const double value = scene_fixed(d, axis);
    if (isnan(value)) continue;
    /* In other scenes the temperature is a dimension, even with one value. */
    if (axis == DECK_AXIS_TEMPERATURE && d->kind != DECK_HYSTERESIS) continue;
    const pendres_store_spec spec = { .name = deck_axis_name(axis),
                                      .long_name = about[axis].words,
                                      .units = about[axis].units };
    status = pendres_store_put(run->store, &spec, &value, NULL, 1);
    if (coordinates[0] != '\0') strcat(coordinates, " ");
    strcat(coordinates, spec.name);
  }
  if (status == PENDRES_OK) status = write_coefficients(run, coordinates);
  if (status == PENDRES_OK && coordinates[0] != '\0')
    status = pendres_store_attribute(run->store, "", NULL, "coordinates", coordinates);
  return status == PENDRES_OK ? scene_define(run) : scene_stored(run, status);
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
  pendres_sweep s = { .pendulum = deck_pendulum(d) };
  for (int axis = 0; axis < DECK_AXIS_COUNT; axis++) {
    const scene_parameter *of = scene_parameter_of((deck_axis_id)axis);
    const deck_axis *a = &d->axis[axis];
    if (a->count > 0 && (int)of->axis == axis)
      s.axis[s.axes++] = (pendres_axis){ of->quantity, a->count, a->value };
  }
  return s;
}

/* ---- the group `paper` --------------------------------------------------------------------- */

enum { PAPER_PRINTED, PAPER_COMPUTED, PAPER_DIFFERENCE, PAPER_COUNT };

static double paper_value(const scene_printed *v, int which)
{
  return which == PAPER_PRINTED    ? v->printed
         : which == PAPER_COMPUTED ? v->computed
                                   : v->computed - v->printed;
}

static pendres_status put_paper(pendres_store *store, size_t n, const scene_printed *values,
                                int which, double *number, double *error)
{
  static const char *const names[PAPER_COUNT] = { "printed", "computed", "difference" };
  static const char *const words[PAPER_COUNT] = { "value printed in the paper", "value of this run",
                                                  "computed less printed" };
  const pendres_store_spec spec = { .group = "paper", .name = names[which],
                                    .dimensions = { "quantity" }, .long_name = words[which] };
  for (size_t i = 0; i < n; i++) {
    number[i] = paper_value(&values[i], which);
    error[i] = values[i].error;
  }
  return pendres_store_put(store, &spec, number, which == PAPER_PRINTED ? NULL : error, n);
}

pendres_status scene_write_paper(scene_run *run, size_t n, const scene_printed *values)
{
  pendres_status status = PENDRES_OK;
  if (n == 0) return status;
  const char **name = malloc(n * sizeof *name);
  double *number = malloc(2 * n * sizeof *number);
  if (name == NULL || number == NULL) {
    status = scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu printed values", n);
    goto done;
  }
  for (size_t i = 0; i < n; i++) name[i] = values[i].name;
  status = pendres_store_dimension(
    run->store,
    &(pendres_store_spec){.group = "paper", .name = "quantity", .type = PENDRES_STORE_STRING,
                          .long_name = "quantity"}, n, name);
  for (int which = 0; which < PAPER_COUNT && status == PENDRES_OK; which++)
    status = put_paper(run->store, n, values, which, number, number + n);
  (void)scene_stored(run, status);
done:
  free(name);
  free(number);
  return status;
}

