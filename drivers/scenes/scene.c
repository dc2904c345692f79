/* scene.c -- the list of scenes, and what several of them need; see scene.h. */
#define _POSIX_C_SOURCE 200809L /* mkstemp, posix_fallocate */
#include "scenes/scene.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

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

void scene_compute(scene_run *run, const farm_stage *stage)
{
  if (!scene_going(run)) return;
  const pendres_status status = farm_run(run->farm, stage);
  if (status != PENDRES_OK) scene_fail(run, status, "%s", farm_message(run->farm));
}

static void put_on_tape(scene_run *run, const pendres_store_spec *spec, const void *values,
                        const double *errors, size_t n)
{
  int id = -1, error_id = -1;
  results_variable(run, spec, &id, errors != NULL ? &error_id : NULL);
  results_write(run, id, 0, 0, values, n);
  if (errors != NULL) results_write(run, error_id, 0, 0, errors, n);
}

void scene_put_as(scene_run *run, const char *quantity, const pendres_store_spec *spec,
                  const void *values, const double *errors, size_t n)
{
  char words[SCENE_WORDS];
  pendres_store_spec defined = *spec;
  const pendres_kind kind = scene_define(run, scene_quantity(run, quantity, spec->name),
                                         &defined, words);
  if (!scene_going(run)) return;
  if (run->tape != NULL) put_on_tape(run, &defined, values, errors, n);
  else scene_stored(run, pendres_store_put(run->store, &defined, values, errors, n));
  scene_mark_units(run, &defined, kind, errors != NULL);
}

void scene_put(scene_run *run, const pendres_store_spec *spec, const void *values,
               const double *errors, size_t n)
{
  scene_put_as(run, NULL, spec, values, errors, n);
}

void scene_put_dimension_as(scene_run *run, const char *quantity, const pendres_store_spec *spec,
                            const void *values, size_t n)
{
  char words[SCENE_WORDS];
  pendres_store_spec defined = *spec;
  const pendres_kind kind = scene_define(run, scene_quantity(run, quantity, spec->name),
                                         &defined, words);
  if (!scene_going(run)) return;
  results_dimension(run, &defined, n, values);
  if (defined.comment != NULL)
    results_attribute(run, spec->group, spec->name, "comment", defined.comment);
  scene_mark_units(run, &defined, kind, 0);
}

void scene_put_dimension(scene_run *run, const pendres_store_spec *spec, const void *values,
                         size_t n)
{
  scene_put_dimension_as(run, NULL, spec, values, n);
}

/* ---- arrays -------------------------------------------------------------------------------- */

/* Before the elements of an array, which are aligned as those of malloc are. */
typedef struct scene_held {
  struct scene_held *next;
  size_t mapped; /* bytes of the file that holds it; 0: it is in memory */
  max_align_t elements[];
} scene_held;

int scene_unnamed(scene_run *run, size_t bytes)
{
  char path[DECK_PATH + 32];
  const char *folder = getenv("TMPDIR"), *output = run->deck->output;
  const char *slash = strrchr(output, '/');
  if (folder != NULL && *folder != '\0')
    snprintf(path, sizeof path, "%.1000s/resonance-XXXXXX", folder);
  else
    snprintf(path, sizeof path, "%.*s.resonance-XXXXXX",
             slash != NULL ? (int)(slash - output) + 1 : 0, output);
  const int file = mkstemp(path);
  int why = file < 0 || unlink(path) != 0 ? errno : 0;
  /* A signal that asks a run to stop is heeded between tasks, not here. */
  if (why == 0 && bytes > 0) do why = posix_fallocate(file, 0, (off_t)bytes); while (why == EINTR);
  if (why == 0) return file;
  (void)scene_fail(run, PENDRES_IO, "a temporary file, %s: %s", path, strerror(why));
  if (file >= 0) (void)close(file);
  return -1;
}

static scene_held *map_file(scene_run *run, size_t bytes)
{
  const int file = scene_unnamed(run, bytes);
  if (file < 0) return NULL;
  scene_held *held = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  (void)close(file);
  if (held == MAP_FAILED) return NULL;
  held->mapped = bytes;
  return held;
}

static void *hold(scene_room *room, scene_held *held)
{
  if (held == NULL) return NULL;
  held->next = room->held;
  room->held = held;
  return held->elements;
}

/* Bytes of n elements, with one more, so that none is an array, too; 0: there cannot be as many. */
static size_t bytes_of(size_t n, size_t size)
{
  const size_t head = sizeof(scene_held);
  return size > 0 && n >= (SIZE_MAX - head) / size - 1 ? 0 : head + (n + 1) * size;
}

void *scene_room_take(scene_room *room, size_t n, size_t size)
{
  const size_t bytes = bytes_of(n, size);
  return hold(room, bytes > 0 ? calloc(1, bytes) : NULL);
}

void scene_room_end(scene_room *room)
{
  while (room->held != NULL) {
    scene_held *held = room->held;
    room->held = held->next;
    if (held->mapped > 0) (void)munmap(held, held->mapped);
    else free(held);
  }
}

/* Of a run; NULL: why is on record. */
static void *of_run(scene_run *run, void *elements, size_t n)
{
  if (elements == NULL)
    (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu results", n);
  return elements;
}

void *scene_array(scene_run *run, size_t n, size_t size)
{
  return scene_going(run) ? of_run(run, scene_room_take(&run->room, n, size), n) : NULL;
}

void *scene_large(scene_run *run, size_t n, size_t size)
{
  const size_t bytes = bytes_of(n, size);
  if (bytes <= SCENE_MEMORY || !scene_going(run)) return scene_array(run, n, size);
  return of_run(run, hold(&run->room, map_file(run, bytes)), n);
}

/* ---- axes, fixed parameters and ensembles -------------------------------------------------- */

const char *scene_spaced(pendres_parameter parameter, char text[DECK_NAME])
{
  (void)snprintf(text, DECK_NAME, "%s", pendres_parameter_of(parameter)->name);
  for (char *c = text; *c != '\0'; c++)
    if (*c == '_') *c = ' ';
  return text;
}

const char *scene_column_name(pendres_parameter parameter)
{
  return parameter == PENDRES_DRIVE_FREQUENCY ? "frequency" : pendres_parameter_of(parameter)->name;
}

scene_heading scene_heading_of(deck_axis_id axis)
{
  enum { WIDTH = 9 };
  scene_heading h = { .words = "" };
  const char *name = deck_axis_name(axis);
  const size_t n = strlen(name), width = n > WIDTH ? n : WIDTH;
  memset(h.words, ' ', width + 1);
  memcpy(h.words, name, n);
  (void)snprintf(h.format, sizeof h.format, "%%-%d.4g ", (int)width);
  return h;
}

static const char *words_of(deck_axis_id axis)
{
  const pendres_parameter_info *info = pendres_parameter_of(deck_axis_parameter(axis));
  if (info != NULL) return info->words;
  return axis == DECK_AXIS_AMPLITUDE ? "amplitude of the angle" : "tolerance asked for";
}

static void write_dimension(scene_run *run, const char *group, deck_axis_id axis,
                            const char *words)
{
  const deck_axis *a = &run->deck->axis[axis];
  scene_put_dimension(
    run, &(pendres_store_spec){.group = group, .name = deck_axis_name(axis), .long_name = words},
    a->value, a->count);
}

void scene_dimension(scene_run *run, const char *group, deck_axis_id axis)
{
  write_dimension(run, group, axis, words_of(axis));
}

void scene_dimension_short(scene_run *run, deck_axis_id axis)
{
  /* A short name says too little of a parameter that a plain pendulum does not have. */
  const pendres_parameter parameter = deck_axis_parameter(axis);
  char text[DECK_NAME];
  write_dimension(run, "", axis, pendres_parameter_of(parameter)->plain
                                          ? scene_spaced(parameter, text)
                                          : words_of(axis));
}

void scene_numbering(scene_run *run, const char *name, size_t n, const char *words)
{
  scene_put_dimension(run, &(pendres_store_spec){.name = name, .long_name = words}, NULL, n);
}

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
  pendres_store_spec spec = { .name = deck_axis_name(axis), .long_name = words_of(axis) };
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
