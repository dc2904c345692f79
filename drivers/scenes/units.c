/*
 * units.c -- frequencies in Hz and drive periods in seconds beside ours, where the deck tells
 * the pendulum's natural frequency: a copy NAME_hz or NAME_s of each such result, error included.
 *
 * Copies, so that ours stay what they are: files with and without can be put together, and
 * `damping` and the rest need no units.
 */
#include "scenes/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PRINTED = 24 };

/* How a result is converted into a laboratory's units. */
typedef struct conversion {
  const char *suffix, *units;
  double factor;
} conversion;

static int ends(const char *name, const char *with)
{
  const size_t n = strlen(name), m = strlen(with);
  return n >= m && strcmp(name + n - m, with) == 0;
}

/* How a result is converted; 0: it is neither a frequency nor a time of the drive. The deck tells
   what is swept. */
static int convert(const deck *d, const char *name, conversion *out)
{
  const double natural = d->units.natural_frequency;
  deck_axis_id moving[DECK_AXES] = {DECK_AXIS_COUNT};
  const int along = ends(name, "_parameter") || strcmp(name, "cascade_limit") == 0;
  if (along) (void)deck_axes(d, moving);
  *out = (conversion){"_hz", "Hz", natural};
  if (ends(name, "_error")) return 0; /* it goes with its result */
  if (ends(name, "_hz")) return 0;    /* it is a copy */
  if (ends(name, "_frequency") || strncmp(name, "frequency_", 10) == 0) return 1;
  if (along && moving[0] == DECK_AXIS_DRIVE_FREQUENCY) return 1;
  *out = (conversion){"_s", "s", 1.0 / (2.0 * PENDRES_PI * natural)};
  return strcmp(name, "drive_period") == 0 || strcmp(name, "resonance_period") == 0 ||
         (along && moving[0] == DECK_AXIS_DRIVE_PERIOD);
}

/* A result of at most one dimension. */
typedef struct result {
  const char *name, *dimension; /* dimension NULL: none */
  size_t n;
  const double *value, *error;  /* error NULL: none */
} result;

/* One line a point, with its dimension's value in front, for results that a reader takes in at a
   glance. */
static pendres_status tell(scene_run *run, const result *r)
{
  double axis[MOST_PRINTED];
  if (r->n == 0 || r->n > MOST_PRINTED || (r->n > 1 && r->dimension == NULL)) return PENDRES_OK;
  const pendres_status status =
    r->dimension == NULL
      ? PENDRES_OK
      : pendres_store_read(run->store, "", r->dimension, PENDRES_STORE_DOUBLE, axis, r->n);
  if (status != PENDRES_OK) return status;
  fprintf(run->table, "%s\n", r->name);
  for (size_t i = 0; i < r->n; i++) {
    if (isnan(r->value[i])) continue;
    if (r->dimension != NULL) fprintf(run->table, "  %s %-9.4g", r->dimension, axis[i]);
    fprintf(run->table, "  %.10g", r->value[i]);
    if (r->error != NULL) fprintf(run->table, " +- %.1g", r->error[i]);
    fputs("\n", run->table);
  }
  return PENDRES_OK;
}

/* Read, convert and write one result; its dimensions are those of the original. */
static pendres_status copy(scene_run *run, const char *name, const conversion *c, int rank,
                           char *const *dimension, size_t n)
{
  char error_name[DECK_NAME + 8], converted[DECK_NAME + 8], words[2 * DECK_NAME];
  pendres_store_spec spec = {.name = converted, .long_name = words, .units = c->units};
  double *value = malloc((2 * n + 1) * sizeof *value), *error = NULL;
  pendres_status status = value == NULL ? PENDRES_OUT_OF_MEMORY : PENDRES_OK;
  (void)snprintf(error_name, sizeof error_name, "%.64s_error", name);
  (void)snprintf(converted, sizeof converted, "%.64s%s", name, c->suffix);
  (void)snprintf(words, sizeof words, "%.64s in %s", name, c->units);
  for (int k = 0; k < rank; k++) spec.dimensions[k] = dimension[k];
  if (status == PENDRES_OK)
    status = pendres_store_read(run->store, "", name, PENDRES_STORE_DOUBLE, value, n);
  if (status == PENDRES_OK && pendres_store_has(run->store, "", error_name)) {
    error = value + n;
    status = pendres_store_read(run->store, "", error_name, PENDRES_STORE_DOUBLE, error, n);
  }
  for (size_t i = 0; i < (error != NULL ? 2 * n : n) && status == PENDRES_OK; i++)
    value[i] *= c->factor;
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &spec, value, error, n);
  /* Axes stand in front of every other result already. */
  if (status == PENDRES_OK && rank <= 1 && (rank == 0 || strcmp(dimension[0], name) != 0))
    status = tell(run, &(result){converted, rank == 1 ? dimension[0] : NULL, n, value, error});
  free(value);
  return status;
}

static pendres_status copy_if_wanted(scene_run *run, const char *name)
{
  conversion c;
  int rank = 0;
  size_t n = 1;
  uint64_t sizes[PENDRES_STORE_RANK];
  char *dimension[PENDRES_STORE_RANK] = {NULL};
  if (!convert(run->deck, name, &c)) return PENDRES_OK;
  pendres_status status = pendres_store_shape(run->store, "", name, &rank, sizes);
  for (int k = 0; k < rank && status == PENDRES_OK; k++) {
    n *= (size_t)sizes[k];
    status = pendres_store_dimension_of(run->store, "", name, k, &dimension[k]);
  }
  if (status == PENDRES_OK) status = copy(run, name, &c, rank, dimension, n);
  for (int k = 0; k < PENDRES_STORE_RANK; k++) free(dimension[k]);
  return status;
}

/* The parameters among the copies are coordinates as those are that they come from. */
static pendres_status extend_coordinates(scene_run *run)
{
  static const char *const names[] = {"natural_frequency_hz", "drive_frequency_hz",
                                      "drive_period_s"};
  char list[1024] = "", *old = NULL;
  const pendres_status found =
    pendres_store_read_attribute_text(run->store, "", NULL, "coordinates", &old);
  if (found == PENDRES_OK) (void)snprintf(list, sizeof list - 100, "%s", old);
  free(old);
  if (found != PENDRES_OK && found != PENDRES_NOT_FOUND) return found;
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    if (!pendres_store_has(run->store, "", names[i])) continue;
    if (list[0] != '\0') strcat(list, " ");
    strcat(list, names[i]);
  }
  return pendres_store_attribute(run->store, "", NULL, "coordinates", list);
}

/* Copies are added to the list of members while the loop goes through it. */
void scene_write_units(scene_run *run)
{
  pendres_status status = PENDRES_OK;
  const double natural = run->deck->units.natural_frequency;
  const pendres_store_spec spec = {.name = "natural_frequency_hz", .units = "Hz",
                                   .long_name = "frequency of small free oscillations"};
  if (!(natural > 0.0) || !scene_going(run)) return;
  if (run->table != NULL) fprintf(run->table, "with a natural frequency of %g Hz:\n", natural);
  for (uint64_t i = 0; status == PENDRES_OK; i++) {
    char *name = NULL;
    pendres_store_type type;
    status = pendres_store_member(run->store, "", i, &type, &name);
    if (status == PENDRES_NOT_FOUND) break;
    if (status == PENDRES_OK && type == PENDRES_STORE_DOUBLE) status = copy_if_wanted(run, name);
    free(name);
  }
  if (status == PENDRES_OK || status == PENDRES_NOT_FOUND)
    status = pendres_store_put(run->store, &spec, &natural, NULL, 1);
  if (status == PENDRES_OK) status = extend_coordinates(run);
  scene_stored(run, status);
}
