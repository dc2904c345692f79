/* csv.c -- results as text; see run.h. */
#define _POSIX_C_SOURCE 200809L /* fsync */
#include "run.h"
#include "system/bytes.h"
#include "system/file.h"
#include "system/grow.h"
#include "system/text.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <pendres/store.h>

/* Axes of a table: two of results, and an outer one; response has all of them. */
enum { MOST_ROWS = 100000, MOST_AXES = 4, ROOM = DECK_PATH + 500 };

/* What the first line begins with: a file that begins otherwise is another one's. */
static const char sign[] = "# resonance: ";

/* A variable of the file. A dimension is one whose only dimension is itself. */
typedef struct column {
  char *name;
  pendres_store_type type;
  int rank; /* 0 to MOST_AXES */
  uint64_t size[MOST_AXES];
  char *dimension[MOST_AXES];
  double *value; /* or, of a text, */
  char **text;
  double si_factor; /* that the values were multiplied by; 0: they are as the file has them */
} column;

typedef struct tables {
  pendres_store *store;
  column *list;
  size_t count, room;
  pendres_status status; /* the first failure */
  progress *progress;
} tables;

/* ---- reading ------------------------------------------------------------------------------- */

static uint64_t rows_of(const column *c)
{
  uint64_t n = 1;
  for (int k = 0; k < c->rank; k++) n *= c->size[k];
  return n;
}

static void drop(column *c)
{
  for (uint64_t i = 0; c->text != NULL && i < rows_of(c); i++) free(c->text[i]);
  free(c->text);
  free(c->value);
  free(c->name);
  for (int k = 0; k < MOST_AXES; k++) free(c->dimension[k]);
  *c = (column){ 0 };
}

/* Its shape and the names of its dimensions; PENDRES_UNSUPPORTED if no table has room for it. */
static pendres_status describe(pendres_store *store, column *c)
{
  uint64_t sizes[PENDRES_STORE_RANK];
  if (c->type == PENDRES_STORE_TYPE_COUNT) return PENDRES_UNSUPPORTED;
  pendres_status status = pendres_store_shape(store, "", c->name, &c->rank, sizes);
  if (status == PENDRES_OK && c->rank > (c->type == PENDRES_STORE_STRING ? 1 : MOST_AXES))
    return PENDRES_UNSUPPORTED;
  for (int k = 0; k < MOST_AXES; k++) c->size[k] = sizes[k];
  for (int k = 0; k < c->rank && status == PENDRES_OK; k++)
    status = pendres_store_dimension_of(store, "", c->name, k, &c->dimension[k]);
  return status;
}

/* Its values; PENDRES_OK also where they are too many for a table, and none are read. */
static pendres_status load(pendres_store *store, column *c)
{
  const size_t n = (size_t)rows_of(c);
  pendres_status status = PENDRES_OK;
  if (n > MOST_ROWS) return status;
  if (c->type != PENDRES_STORE_STRING) {
    c->value = calloc(n + 1, sizeof *c->value);
    if (c->value == NULL) return PENDRES_OUT_OF_MEMORY;
    status = pendres_store_read(store, "", c->name, PENDRES_STORE_DOUBLE, c->value, n);
    if (pendres_store_read_attribute_double(store, "", c->name, "si_factor", &c->si_factor) !=
        PENDRES_OK)
      c->si_factor = 0.0;
    for (size_t i = 0; i < n && c->si_factor > 0.0; i++) c->value[i] *= c->si_factor;
    return status;
  }
  c->text = calloc(n + 1, sizeof *c->text);
  if (c->text == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    status = pendres_store_read_text(store, "", c->name, i, &c->text[i]);
  return status;
}

/* All members of the root that fit. */
static void read_columns(tables *t)
{
  for (uint64_t i = 0; t->status == PENDRES_OK; i++) {
    if (!grow_to(&t->list, t->count + 1, &t->room, sizeof *t->list)) {
      t->status = PENDRES_OUT_OF_MEMORY;
      return;
    }
    column *c = &t->list[t->count];
    *c = (column){ 0 };
    pendres_status status = pendres_store_member(t->store, "", i, &c->type, &c->name);
    if (status == PENDRES_NOT_FOUND) return;
    if (status == PENDRES_OK) status = describe(t->store, c);
    if (status == PENDRES_OK) status = load(t->store, c);
    if (status == PENDRES_OK) t->count++;
    else drop(c);
    if (status != PENDRES_UNSUPPORTED) t->status = status;
  }
}

static column *find(tables *t, const char *name)
{
  for (size_t i = 0; i < t->count; i++)
    if (strcmp(t->list[i].name, name) == 0) return &t->list[i];
  return NULL;
}

static int is_dimension(const column *c)
{
  return c->rank == 1 && strcmp(c->name, c->dimension[0]) == 0;
}

/* Are they of one table? */
static int alike(const column *a, const column *b)
{
  if (a->rank != b->rank || is_dimension(a) || is_dimension(b)) return 0;
  for (int k = 0; k < a->rank; k++)
    if (strcmp(a->dimension[k], b->dimension[k]) != 0) return 0;
  return 1;
}

/* ---- writing ------------------------------------------------------------------------------- */

/* As few digits as give the same double again, but no more than `most`. */
static void put_number(double x, int most, FILE *out)
{
  char text[40];
  if (isnan(x)) {
    fputs("NaN", out);
    return;
  }
  if (isinf(x)) {
    fputs(x > 0 ? "Inf" : "-Inf", out);
    return;
  }
  for (int digits = fabs(x) < DBL_MIN ? 1 : DBL_DIG; digits <= most; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, x);
    if (strtod(text, NULL) == x) break;
  }
  fputs(text, out);
}

/* A text of one line, in quotes if a reader of tables would take it apart. */
static void put_text(const char *text, int cell, FILE *out)
{
  const int quotes = cell && strpbrk(text, ",\"#\r\n") != NULL;
  if (quotes) putc('"', out);
  for (; *text != '\0'; text++) {
    if (quotes && *text == '"') putc('"', out);
    putc((unsigned char)*text < ' ' ? ' ' : *text, out);
  }
  if (quotes) putc('"', out);
}

static void put_cell(const column *c, size_t i, FILE *out)
{
  if (c->text != NULL) put_text(c->text[i], 1, out);
  else put_number(c->value[i], c->si_factor > 0.0 ? DBL_DIG : DBL_DECIMAL_DIG, out);
}

/* A text of the file, and what it was asked with: NULL if it has none. */
static char *text_of(tables *t, pendres_status status, char *text)
{
  if (status == PENDRES_OUT_OF_MEMORY && t->status == PENDRES_OK) t->status = status;
  return text;
}

/* An attribute of the file or of a variable. */
static char *attribute(tables *t, const char *object, const char *name)
{
  char *text = NULL;
  const pendres_status status =
    pendres_store_read_attribute_text(t->store, "", object, name, &text);
  return text_of(t, status, text);
}

/* Keys set on the command line. */
static char *settings(tables *t)
{
  char *text = NULL;
  const pendres_status status =
    pendres_store_read_text(t->store, "provenance", "settings", 0, &text);
  return text_of(t, status, text);
}

/* A line of the head, without one that says nothing. Frees the text. */
static void put_told(const char *name, char *text, FILE *out)
{
  if (text != NULL && *text != '\0') {
    fprintf(out, "# %s: ", name);
    put_text(text, 0, out);
    putc('\n', out);
  }
  free(text);
}

/* What is true of the whole run, and numbers without dimensions. The date, which changes from run
 * to run, is left to the HDF5 file. */
static void put_head(tables *t, FILE *out)
{
  static const char *const told[] = { "title", "scene", "source", "deck" };
  fprintf(out, "%sresults as text; the HDF5 file tells more\n", sign);
  for (size_t i = 0; i < sizeof told / sizeof *told; i++)
    put_told(told[i], attribute(t, NULL, told[i]), out);
  put_told("settings", settings(t), out);
  for (size_t i = 0; i < t->count; i++) {
    const column *c = &t->list[i];
    if (c->rank > 0) continue;
    fprintf(out, "# %s = ", c->name);
    put_cell(c, 0, out);
    char *units = c->si_factor > 0.0 ? attribute(t, c->name, "si_units") : NULL;
    fprintf(out, "%s%s\n", units != NULL ? " " : "", units != NULL ? units : "");
    free(units);
  }
}

/* What a column is, and what its codes stand for. */
static void put_meaning(tables *t, const column *c, FILE *out)
{
  char *what = attribute(t, c->name, "long_name");
  char *units = attribute(t, c->name, c->si_factor > 0.0 ? "si_units" : "units");
  char *codes = attribute(t, c->name, "flag_meanings");
  double unused = 0.0;
  /* An array, which cannot be read as a number, but is there: codes are sums of 0, 1, 2, 4, ... */
  const int bits = pendres_store_read_attribute_double(t->store, "", c->name, "flag_masks",
                                                       &unused) != PENDRES_NOT_FOUND;
  fprintf(out, "# %s: ", c->name);
  put_text(what != NULL ? what : "", 0, out);
  if (units != NULL && codes == NULL) fprintf(out, " [%s]", units);
  int number = 0;
  for (const char *word = codes; word != NULL && *word != '\0'; number++) {
    const size_t length = strcspn(word, " ");
    fprintf(out, "%s %d %.*s", number > 0 ? "," : ";", bits && number > 0 ? 1 << (number - 1)
            : number, (int)length, word);
    word += length + (word[length] == ' ');
  }
  fprintf(out, "%s\n", bits && codes != NULL ? ", or sums of them" : "");
  free(what);
  free(units);
  free(codes);
}

/* The columns of the table that holds `first`: coordinates, then results. Returns their number. */
static size_t gather(tables *t, const column *first, column **wanted)
{
  size_t n = 0;
  for (int k = 0; k < first->rank; k++) {
    column *scale = find(t, first->dimension[k]);
    if (scale != NULL) wanted[n++] = scale;
  }
  for (size_t i = 0; i < t->count; i++)
    if (alike(first, &t->list[i])) wanted[n++] = &t->list[i];
  return n;
}

/* The element of a column in a row of the table: of a dimension the one along it. */
static size_t place_of(const column *c, const column *first, uint64_t row)
{
  uint64_t along = row;
  if (!is_dimension(c)) return (size_t)row;
  for (int k = first->rank - 1; k >= 0; k--) {
    if (strcmp(c->name, first->dimension[k]) == 0) return (size_t)(along % first->size[k]);
    along /= first->size[k];
  }
  return (size_t)row;
}

static void put_table(tables *t, const column *first, column **wanted, FILE *out)
{
  const uint64_t rows = rows_of(first);
  const size_t n = gather(t, first, wanted);
  put_head(t, out);
  for (size_t i = 0; i < n; i++) put_meaning(t, wanted[i], out);
  if (t->status != PENDRES_OK) return;
  for (size_t i = 0; i < n; i++) fprintf(out, "%s%s", i > 0 ? "," : "", wanted[i]->name);
  putc('\n', out);
  for (uint64_t row = 0; row < rows; row++) {
    for (size_t i = 0; i < n; i++) {
      if (i > 0) putc(',', out);
      put_cell(wanted[i], place_of(wanted[i], first, row), out);
    }
    putc('\n', out);
  }
}

/* ---- files --------------------------------------------------------------------------------- */

/* NAME.csv for NAME.h5; NAME.DIMENSION.csv for another table. */
static void name_file(const deck *d, const column *other, char path[ROOM])
{
  const size_t n = strlen(d->output);
  const int stem = (int)(n > 3 && strcmp(d->output + n - 3, ".h5") == 0 ? n - 3 : n);
  int used = snprintf(path, ROOM, "%.*s", stem, d->output);
  for (int k = 0; other != NULL && k < other->rank; k++)
    used += snprintf(path + used, ROOM - (size_t)used, ".%.100s", other->dimension[k]);
  snprintf(path + used, ROOM - (size_t)used, ".csv");
}

/* Is the open file a table of this program, or the beginning of one? */
static int is_table(int fd)
{
  char start[sizeof sign - 1];
  struct stat s;
  return fstat(fd, &s) == 0 &&
         (s.st_size == 0 ||
          (bytes_read(fd, 0, start, sizeof start) && memcmp(start, sign, sizeof start) == 0));
}

/* Is there nothing at path that is another one's? */
static int may_replace(const char *path, progress *p)
{
  char why[FILE_WORDS];
  const int fd = file_open(path, FILE_READ, 0, why), absent = fd < 0 && errno == ENOENT;
  const int table = absent || (fd >= 0 && is_table(fd));
  if (fd < 0 && !absent) progress_error(p, "%s: no table can be written there", why);
  else if (!table)
    progress_error(p, "%s is there and is no table of this program: it is left as it is; --force "
                   "replaces it", path);
  if (fd >= 0) (void)close(fd);
  return table;
}

int csv_check(const deck *d, progress *p)
{
  char path[ROOM];
  name_file(d, NULL, path);
  return may_replace(path, p) ? 0 : 2;
}

/* The part file of a table, which replaces none but one that a killed run has left. */
static int open_part(const char *part, char *why)
{
  int fd = file_open(part, FILE_NEW, 0, why);
  if (fd >= 0 || errno != EEXIST) return fd;
  const int left = file_open(part, FILE_TRUSTED, 0, why);
  if (left < 0) return -1;
  if (!is_table(left)) snprintf(why, FILE_WORDS, "'%.300s' was not left by a killed run", part);
  else if (file_remove(left, part) == 0) fd = file_open(part, FILE_NEW, 0, why);
  (void)close(left);
  return fd;
}

/* The table as a text, to be freed: made before there is a file, since HDF5, which is asked for it,
   may end the program. NULL: no memory, or t->status says why. */
static char *table_text(tables *t, const column *first, size_t *size)
{
  text made;
  column **wanted = calloc(t->count + MOST_AXES, sizeof(column *));
  if (text_open(&made) && wanted != NULL) put_table(t, first, wanted, made.stream);
  const int whole = wanted != NULL && t->status == PENDRES_OK && text_whole(&made);
  free(wanted);
  *size = made.size;
  if (whole) return text_close(&made);
  text_drop(&made);
  return NULL;
}

/* The text into the part file of `path`, and that to its name; 0, or `why` it cannot be. */
static int put_file(const char *text, size_t size, const char *path, char *why)
{
  char part[ROOM + 8];
  const int length = snprintf(part, sizeof part, "%s.part", path), fits = length < (int)sizeof part;
  const int fd = fits ? open_part(part, why) : -1;
  if (!fits) snprintf(why, FILE_WORDS, "'%.300s': %s", path, strerror(ENAMETOOLONG));
  if (fd < 0) return 1;
  file_like(fd, path);
  const int failed = !bytes_write(fd, 0, text, size) || fsync(fd) != 0 || !file_is(fd, part) ||
                     rename(part, path) != 0;
  if (failed) snprintf(why, FILE_WORDS, "'%.300s': %s", part, strerror(errno));
  if (failed) (void)file_remove(fd, part);
  (void)close(fd);
  return failed;
}

/* One table, whole or not at all. 0, or 1 after an error; t->status tells of reading. */
static int write_file(tables *t, const column *first, const char *path)
{
  char why[FILE_WORDS] = "";
  char *target = NULL;
  size_t size = 0;
  char *text = table_text(t, first, &size);
  int failed = text == NULL || pendres_store_target(path, &target, why, sizeof why) != PENDRES_OK;
  if (!failed) failed = put_file(text, size, target, why);
  free(target);
  free(text);
  if (failed && t->status == PENDRES_OK)
    progress_error(t->progress, "%s%s; the results are whole in the HDF5 file",
                   why[0] != '\0' ? why : path, why[0] != '\0' ? "" : ": out of memory");
  return failed;
}

/* The main table: that of the points which can fail, else the longest. NULL: there is none. */
static const column *main_table(tables *t)
{
  const column *failed = find(t, "failed"), *longest = NULL;
  if (failed != NULL && failed->rank > 0) return failed;
  for (size_t i = 0; i < t->count; i++) {
    const column *c = &t->list[i];
    if (c->rank == 0 || is_dimension(c)) continue;
    if (longest == NULL || rows_of(c) > rows_of(longest)) longest = c;
  }
  return longest;
}

static int write_all(tables *t, const deck *d, int force)
{
  char path[ROOM];
  const column *first = main_table(t);
  if (first == NULL) progress_note(t->progress, "there is no table to write as text");
  for (size_t i = 0; i < t->count && t->status == PENDRES_OK; i++) {
    const column *c = &t->list[i];
    int told = c->rank == 0 || is_dimension(c);
    for (size_t k = 0; k < i && !told; k++) told = alike(c, &t->list[k]);
    if (told) continue;
    name_file(d, alike(c, first) ? NULL : c, path);
    if (rows_of(c) > MOST_ROWS) {
      progress_note(t->progress, "%s is left out: more than %d rows are for HDF5 alone", path,
                    MOST_ROWS);
      continue;
    }
    if (!force && !may_replace(path, t->progress)) return 1;
    if (write_file(t, c, path) != 0) return 1;
    progress_note(t->progress, "%s written", path);
  }
  return 0;
}

int csv_write(const deck *d, int force, progress *p)
{
  tables t = { .progress = p };
  int code = 0;
  t.status = pendres_store_open(d->output, &t.store);
  if (t.status == PENDRES_OK) read_columns(&t);
  if (t.status == PENDRES_OK) code = write_all(&t, d, force);
  if (t.status != PENDRES_OK) {
    const char *words = pendres_store_message(t.store);
    progress_error(p, "no text of %s is written: %s", d->output, progress_words(words, t.status));
    code = 1;
  }
  for (size_t i = 0; i < t.count; i++) drop(&t.list[i]);
  free(t.list);
  pendres_store_free(t.store);
  return code;
}
