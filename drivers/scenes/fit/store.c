/*
 * store.c -- data of a fit from a file of results: its variables as lines of text, which
 * data.c reads as it reads others. See file.h.
 */
#define _POSIX_C_SOURCE 200809L /* fdopen, fileno, ftruncate */
#include "scenes/fit/file.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scenes/numbers.h"
#include "system/apart.h"
#include "system/bytes.h"

enum { COLUMNS = 16, CELL = 25 /* characters of a number at most, with what separates it */ };

typedef struct table {
  scene_run *run;
  pendres_store *store;
  int rank;
  uint64_t size[PENDRES_STORE_RANK];
  size_t n;
  size_t columns;
  char name[COLUMNS][DECK_NAME];
  double *value[COLUMNS]; /* [n]; NULL: texts of the dimension */
} table;

/* Whether a variable of numbers has the shape of the table; the first one makes it. */
static int belongs(table *t, const char *name)
{
  int rank = 0;
  uint64_t size[PENDRES_STORE_RANK];
  if (!pendres_store_has(t->store, NULL, name) ||
      pendres_store_shape(t->store, NULL, name, &rank, size) != PENDRES_OK || rank == 0)
    return 0;
  if (t->rank != 0) return rank == t->rank && memcmp(size, t->size, sizeof size) == 0;
  t->rank = rank;
  memcpy(t->size, size, sizeof size);
  t->n = 1;
  for (int i = 0; i < rank; i++) t->n *= (size_t)size[i];
  return 1;
}

/* What makes SI of a variable, where the deck speaks it and the file tells. */
static double factor_of(const table *t, const char *name)
{
  double factor = 1.0;
  if (!deck_has_units(t->run->deck) ||
      pendres_store_read_attribute_double(t->store, NULL, name, "si_factor", &factor) != PENDRES_OK)
    return 1.0;
  return factor;
}

/* A variable as a column, or the values of a dimension, n of them, to be repeated. */
static double *read_column(table *t, const char *name, size_t n)
{
  const double factor = factor_of(t, name);
  double *value = scene_array(t->run, n, sizeof *value);
  if (value == NULL) return NULL;
  scene_stored(t->run,
               pendres_store_read(t->store, NULL, name, PENDRES_STORE_DOUBLE, value, n));
  for (size_t i = 0; i < n; i++) value[i] *= factor;
  return value;
}

static void add_variable(table *t, const char *name)
{
  for (size_t k = 0; k < t->columns; k++)
    if (strcmp(t->name[k], name) == 0) return;
  if (t->columns + PENDRES_STORE_RANK >= COLUMNS || !belongs(t, name)) return;
  snprintf(t->name[t->columns], DECK_NAME, "%s", name);
  t->value[t->columns++] = read_column(t, name, t->n);
}

/* The observables, and what the deck names as columns. */
static void find_variables(table *t)
{
  const deck *d = t->run->deck;
  for (size_t i = 0; i < d->data.observables.count; i++)
    add_variable(t, d->data.observables.name[i]);
  if (d->data.observables.count == 0) add_variable(t, "amplitude");
  for (size_t i = 0; i < d->data.columns.count; i++) {
    const char *equals = strchr(d->data.columns.name[i], '=');
    add_variable(t, equals != NULL ? equals + 1 : d->data.columns.name[i]);
  }
}

/* ---- text ---------------------------------------------------------------------------------- */

static void write_row(const table *t, FILE *out, size_t row, char *const *name,
                      double *const *along)
{
  size_t rest = row, at[PENDRES_STORE_RANK];
  for (int i = t->rank - 1; i >= 0; i--) {
    at[i] = rest % (size_t)t->size[i];
    rest /= (size_t)t->size[i];
  }
  for (int i = 0; i < t->rank; i++) {
    char *text = NULL;
    if (along[i] != NULL) fprintf(out, "%.17g;", along[i][at[i]]);
    else if (scene_stored(t->run, pendres_store_read_text(t->store, NULL, name[i], at[i], &text)) ==
             PENDRES_OK)
      fprintf(out, "%s;", text);
    free(text);
  }
  for (size_t k = 0; k < t->columns; k++)
    fprintf(out, "%.17g%s", t->value[k][row], k + 1 < t->columns ? ";" : "\n");
}

/* Whether a number has this name, and no text. */
static int is_number(const table *t, const char *name)
{
  pendres_store_type type;
  char *member = NULL;
  int same = 0;
  for (uint64_t i = 0; !same && pendres_store_member(t->store, "", i, &type, &member) == PENDRES_OK;
       i++) {
    same = strcmp(member, name) == 0;
    free(member);
  }
  return same && type != PENDRES_STORE_STRING && type != PENDRES_STORE_TYPE_COUNT;
}

static void write_table(table *t, FILE *out)
{
  char *name[PENDRES_STORE_RANK] = {NULL};
  double *along[PENDRES_STORE_RANK] = {NULL};
  for (int i = 0; i < t->rank && scene_going(t->run); i++) {
    scene_stored(t->run, pendres_store_dimension_of(t->store, NULL, t->name[0], i, &name[i]));
    if (!scene_going(t->run)) break;
    fprintf(out, "%s;", name[i]);
    if (is_number(t, name[i])) along[i] = read_column(t, name[i], (size_t)t->size[i]);
  }
  for (size_t k = 0; k < t->columns; k++)
    fprintf(out, "%s%s", t->name[k], k + 1 < t->columns ? ";" : "\n");
  for (size_t i = 0; i < t->n && scene_going(t->run); i++) {
    int whole = 1; /* what failed has no value */
    for (size_t k = 0; k < t->columns; k++) whole &= isfinite(t->value[k][i]) != 0;
    if (whole) write_row(t, out, i, name, along);
  }
  for (int i = 0; i < t->rank; i++) free(name[i]);
}

/* ---- in a process of its own --------------------------------------------------------------- */

typedef struct task {
  scene_run *run;
  const char *path;
  struct stat is; /* the file that the caller has opened: the child has its name alone */
  FILE *out;
} task;

static int is_the_same(const task *w)
{
  struct stat now;
  return stat(w->path, &now) == 0 && now.st_dev == w->is.st_dev && now.st_ino == w->is.st_ino;
}

/* The text into the file, or the reason why there is none, which the status tells. */
static int read_apart(const void *arg)
{
  const task *w = arg;
  scene_run *run = w->run;
  table t = {.run = run};
  const pendres_status status = pendres_store_open(w->path, &run->store);
  t.store = run->store; /* whose words scene_stored() tells: the results' are not this process's */
  if (status == PENDRES_OK && !is_the_same(w))
    (void)scene_fail(run, PENDRES_IO, "it was replaced while it was being read");
  else if (status == PENDRES_OK) find_variables(&t);
  else
    (void)scene_fail(run, status == PENDRES_IO ? PENDRES_INVALID_ARGUMENT : status,
                     "the file of results cannot be read (%s): it is broken, or no file of this "
                     "program: write it anew", pendres_store_message(run->store));
  if (t.columns == 0)
    (void)scene_fail(run, PENDRES_INVALID_ARGUMENT,
                     "the file has no variable with the name of an observable: give those of its "
                     "variables in data.columns, as 'rms=amplitude'");
  else if (t.n > FIT_MOST_BYTES / CELL / (t.columns + PENDRES_STORE_RANK))
    (void)scene_fail(run, PENDRES_INVALID_ARGUMENT, "it has more data than a fit takes");
  if (scene_going(run)) write_table(&t, w->out);
  if (fflush(w->out) != 0 || ferror(w->out))
    (void)scene_fail(run, PENDRES_IO, "%s", strerror(errno));
  if (scene_going(run)) return PENDRES_OK;
  rewind(w->out);
  const int bad = ftruncate(fileno(w->out), 0) != 0 || fputs(run->message, w->out) < 0;
  return bad || fflush(w->out) != 0 ? PENDRES_STATUS_COUNT : (int)run->status;
}

/* As of one for whose words there was no room. */
static const char no_reason[] = "the process that reads it ended without a reason";

pendres_status fit_store_text(scene_run *run, const char *path, int fd, char **text,
                              size_t *length)
{
  int code = APART_FAILED;
  pendres_status status = PENDRES_IO;
  const int file = scene_unnamed(run, 0);
  FILE *out = file >= 0 ? fdopen(file, "w") : NULL;
  task w = {.run = run, .path = path, .out = out};
  if (out != NULL && fstat(fd, &w.is) == 0) code = apart(read_apart, &w, w.is.st_size, file);
  if (code >= 0 && code < PENDRES_STATUS_COUNT && lseek(file, 0, SEEK_SET) == 0)
    status = bytes_text(file, FIT_MOST_BYTES, text, length);
  else if (code != APART_FAILED)
    (void)scene_fail(run, PENDRES_INVALID_ARGUMENT, "%s: the file of results cannot be read: %s",
                     path, code == APART_ENDLESS   ? "reading it does not end"
                           : code == APART_CRASHED ? "HDF5 crashes when it reads it"
                                                   : no_reason);
  if (out != NULL) (void)fclose(out);
  else if (file >= 0) (void)close(file);
  if (status != PENDRES_OK || code == PENDRES_OK) return status;
  (void)scene_fail(run, (pendres_status)code, "%s: %s", path,
                   (*text)[0] != '\0' ? *text : no_reason);
  free(*text);
  *text = NULL;
  return status;
}
