/*
 * data.c -- data of a fit from a text file; see data.h.
 *
 * A line is a datum: cells between commas, semicolons or tabs, or else blanks. A first line with a
 * cell that is no number names the columns. What the columns are is told by the deck, or by these
 * names.
 */
#define _POSIX_C_SOURCE 200809L /* strdup */
#include "scenes/fit/data.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "scenes/numbers.h"
#include "system/bytes.h"
#include "system/file.h"

enum { MOST_COLUMNS = 64, CELL = 128, NONE = -1 };

/* A file while it is read. */
typedef struct reader {
  scene_run *run;
  const deck *d;
  fit_data *out;
  char separator;                 /* ' ': blanks */
  size_t names, line;
  char name[MOST_COLUMNS][CELL];  /* of columns, "" where the file has none */
  /* Columns of what is needed, from 0 on. */
  int axis, direction, other, observable[PENDRES_FIT_OBSERVABLE_COUNT];
  int error[PENDRES_FIT_OBSERVABLE_COUNT];
  size_t observables, room;
  int gaps; /* some lines have not all of them */
  pendres_fit_observable kind[PENDRES_FIT_OBSERVABLE_COUNT];
} reader;

#define FAIL(r, ...) (void)scene_fail((r)->run, PENDRES_INVALID_ARGUMENT, __VA_ARGS__)

/* ---- lines and cells ----------------------------------------------------------------------- */

/* The cells of a line, in place; their number. */
static size_t split(char *text, char separator, char *cell[MOST_COLUMNS])
{
  size_t n = 0;
  char *at = text;
  while (n < MOST_COLUMNS) {
    at += strspn(at, separator == '\t' ? " \r" : " \t\r");
    if (separator == ' ' && *at == '\0') break;
    char *end = at + strcspn(at, separator == ' ' ? " \t" : (char[]){separator, '\0'});
    const int last = *end == '\0';
    *end = '\0';
    for (char *tail = end; tail > at && strchr(" \t\r", tail[-1]) != NULL;) *--tail = '\0';
    /* Names may stand in quotes. */
    const size_t length = strlen(at);
    if (length > 1 && at[0] == '"' && at[length - 1] == '"') {
      at[length - 1] = '\0';
      at++;
    }
    cell[n++] = at;
    if (last) break;
    at = end + 1;
  }
  return n;
}

static int number_of(const char *cell, double *out)
{
  char *end;
  *out = strtod(cell, &end);
  return end != cell && *end == '\0';
}

/* What separates cells of a line. */
static char separator_of(const char *line)
{
  static const char known[] = ";\t,";
  for (size_t i = 0; known[i] != '\0'; i++)
    if (strchr(line, known[i]) != NULL) return known[i];
  return ' ';
}

/* ---- columns ------------------------------------------------------------------------------- */

/* The column of a name or a number, told by the deck; NONE, and a failure, if there is none. */
static int column_of(const reader *r, const char *word)
{
  double number;
  char list[300] = "";
  for (size_t i = 0; i < r->names; i++)
    if (r->name[i][0] != '\0' && strcmp(r->name[i], word) == 0) return (int)i;
  if (number_of(word, &number) && number == floor(number) && number >= 1.0 &&
      number <= (double)r->names)
    return (int)number - 1;
  for (size_t i = 0; i < r->names; i++)
    snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", i > 0 ? ", " : "",
             r->name[i][0] != '\0' ? r->name[i] : "(no name)");
  FAIL(r, "%s:%zu: there is no column '%.60s' among the %zu that the file has (%s): give names "
       "or numbers from 1 on in data.columns", r->out->path, r->line, word, r->names, list);
  return NONE;
}

/* The parameter that differs between sweeps. */
static int is_parameter(const reader *r, const char *role, pendres_parameter *p)
{
  const int k = pendres_name_find(PENDRES_NAMES_PARAMETER, role);
  if (k < 0 || k >= PENDRES_PARAMETER_FOLLOWED || k == (int)r->out->of.axis) return 0;
  *p = (pendres_parameter)k;
  return 1;
}

/* Take a column in a role by name; 0: it is none. */
static int take_role(reader *r, const char *role, int column)
{
  pendres_parameter p;
  if (strcmp(role, "direction") == 0) {
    r->direction = column;
    return 1;
  }
  if (strcmp(role, "axis") == 0 || strcmp(role, r->d->data.axis) == 0) {
    r->axis = column;
    return 1;
  }
  for (size_t i = 0; i < r->observables; i++) {
    const char *name = pendres_name_get(PENDRES_NAMES_FIT_OBSERVABLE, (int)r->kind[i]);
    const size_t n = strlen(name);
    if (strncmp(role, name, n) != 0) continue;
    if (role[n] == '\0') r->observable[i] = column;
    else if (strcmp(role + n, "_error") == 0) r->error[i] = column;
    else continue;
    return 1;
  }
  if (strcmp(role, "error") == 0 && r->observables == 1) {
    r->error[0] = column;
    return 1;
  }
  if (!is_parameter(r, role, &p)) return 0;
  r->out->of.other = p;
  r->other = column;
  return 1;
}

/* Whether all data are places of jumps or resonances, which are values of the axis themselves. */
static int are_places(const reader *r)
{
  for (size_t i = 0; i < r->observables; i++)
    if (!fit_is_place(r->kind[i])) return 0;
  return 1;
}

/* Columns that stand without a role, in their order: axis, observables, their errors, direction. */
static void take_in_order(reader *r, size_t n, const int *column)
{
  const size_t m = r->observables;
  size_t k = 0;
  if (r->axis == NONE && k < n && !are_places(r)) r->axis = column[k++];
  for (size_t i = 0; i < m && k < n; i++)
    if (r->observable[i] == NONE) r->observable[i] = column[k++];
  /* One more than there are observables: the last is the direction. */
  const int errors = n - k >= m && r->error[0] == NONE;
  for (size_t i = 0; i < m && errors; i++) r->error[i] = column[k++];
  if (k < n && r->direction == NONE) r->direction = column[k++];
  if (k < n)
    FAIL(r, "data.columns has %zu columns more than there are roles for: axis, %zu observable%s, "
         "%s errors, direction; say what the others are, as 'drive_amplitude=%d'", n - k, m,
         m == 1 ? "" : "s", m == 1 ? "its" : "their", column[k] + 1);
}

static void take_told(reader *r)
{
  const deck_names *told = &r->d->data.columns;
  int column[MOST_COLUMNS];
  size_t n = 0;
  for (size_t i = 0; i < told->count && scene_going(r->run); i++) {
    char word[DECK_NAME];
    snprintf(word, sizeof word, "%s", told->name[i]);
    char *equals = strchr(word, '=');
    if (equals != NULL) *equals = '\0';
    const int at = column_of(r, equals != NULL ? equals + 1 : word);
    if (at == NONE) return;
    if (equals != NULL && !take_role(r, word, at))
      FAIL(r, "data.columns: '%s' is no role: roles are axis, the observables, these with _error, "
           "direction, and a parameter", word);
    /* A name that is a role in itself says more than its place. */
    if (equals == NULL && !(r->name[at][0] != '\0' && (strcmp(r->name[at], "direction") == 0) &&
                            take_role(r, r->name[at], at)) &&
        n < MOST_COLUMNS)
      column[n++] = at;
  }
  if (scene_going(r->run)) take_in_order(r, n, column);
}

/* Whether one of some words, between blanks, stands in a name: letters and what is no ASCII. */
static int has_word(const char *name, const char *words)
{
  for (const char *at = name; *at != '\0';) {
    char word[CELL + 2] = " ";
    size_t n = 1;
    for (; n < CELL && (isalpha((unsigned char)*at) || (unsigned char)*at > 127); at++)
      word[n++] = (char)tolower((unsigned char)*at);
    word[n] = ' ';
    if (n > 1 && strstr(words, word) != NULL) return 1;
    at += n == 1;
  }
  return 0;
}

/* Columns whose names say that they are in what no observable is in. */
static void check_units(const reader *r)
{
  for (size_t i = 0; i < r->observables && scene_going(r->run); i++) {
    const char *name = r->name[r->observable[i]];
    const int phase = r->kind[i] == PENDRES_FIT_PHASE_LAG;
    if (phase && has_word(name, " deg degree degrees \xc2\xb0 "))
      FAIL(r, "%s:%zu: column '%.60s' is in degrees, and a phase_lag is in rad: multiply it by "
           "pi/180 and name it anew", r->out->path, r->line, name);
    if (!phase && has_word(name, " db dbm dbv dbu "))
      FAIL(r, "%s:%zu: column '%.60s' is in dB, and %s is not: make it 10^(dB/20) and name it anew",
           r->out->path, r->line, name,
           pendres_name_get(PENDRES_NAMES_FIT_OBSERVABLE, (int)r->kind[i]));
  }
}

static void find_columns(reader *r)
{
  if (r->d->data.columns.count > 0) {
    take_told(r);
  } else {
    int named = 0;
    for (size_t i = 0; i < r->names; i++)
      named += r->name[i][0] != '\0' && take_role(r, r->name[i], (int)i);
    const int first[MOST_COLUMNS] = {0, 1, 2, 3};
    if (named == 0) take_in_order(r, r->names < 4 ? r->names : 4, first);
  }
  if (!scene_going(r->run)) return;
  const char *missing = r->axis == NONE && !are_places(r) ? r->d->data.axis : NULL;
  for (size_t i = 0; i < r->observables; i++)
    if (r->observable[i] == NONE && missing == NULL)
      missing = pendres_name_get(PENDRES_NAMES_FIT_OBSERVABLE, (int)r->kind[i]);
  if (missing != NULL)
    FAIL(r, "%s:%zu: no column of '%s' is known: name it in the first line, or tell the columns in "
         "data.columns", r->out->path, r->line, missing);
  else check_units(r);
}

/* The first line that is no comment: names, or the first data. Returns whether it has names. */
static int read_head(reader *r, char *line)
{
  char *cell[MOST_COLUMNS];
  double unused;
  int names = 0;
  r->separator = separator_of(line);
  r->names = split(line, r->separator, cell);
  for (size_t i = 0; i < r->names; i++) {
    const int word = !number_of(cell[i], &unused);
    names |= word && strcmp(cell[i], "up") != 0 && strcmp(cell[i], "down") != 0;
  }
  for (size_t i = 0; i < r->names && names; i++)
    snprintf(r->name[i], CELL, "%.*s", CELL - 1, cell[i]);
  find_columns(r);
  return names;
}

/* ---- data ---------------------------------------------------------------------------------- */

static double read_number(const reader *r, size_t n, char *const *cell, int column,
                          const char *what)
{
  double x = NAN;
  if (!scene_going(r->run)) return NAN;
  if (column >= (int)n)
    FAIL(r, "%s:%zu: the line has %zu columns, and column %d is to be the %s: complete or remove "
         "the line", r->out->path, r->line, n, column + 1, what);
  else if (!number_of(cell[column], &x))
    FAIL(r, "%s:%zu: '%.60s' in column %d is no number, and is to be the %s%s", r->out->path,
         r->line, cell[column], column + 1, what,
         strchr(cell[column], ',') != NULL ? ": decimals have a point" : ": correct or remove it");
  else if (!isfinite(x))
    FAIL(r, "%s:%zu: the %s in column %d is not finite: remove the line, or make it a comment "
         "by #", r->out->path, r->line, what, column + 1);
  return x;
}

static int read_direction(const reader *r, size_t n, char *const *cell)
{
  if (r->direction == NONE) return 0;
  if (r->direction < (int)n && strcmp(cell[r->direction], "up") == 0) return 1;
  if (r->direction < (int)n && strcmp(cell[r->direction], "down") == 0) return -1;
  const double x = read_number(r, n, cell, r->direction, "direction (1, -1, up or down)");
  if (scene_going(r->run) && x == 0.0)
    FAIL(r, "%s:%zu: a direction is 1 or up, -1 or down, not 0", r->out->path, r->line);
  return x > 0.0 ? 1 : -1;
}

/* Room for one more line's data. */
static int make_room(reader *r)
{
  fit_data *out = r->out;
  if (out->of.n + r->observables <= r->room) return 1;
  r->room = 2 * r->room + 256;
  pendres_fit_datum *more = scene_array(r->run, r->room, sizeof *more);
  size_t *line = scene_array(r->run, r->room, sizeof *line);
  if (more == NULL || line == NULL) return 0;
  if (out->of.n > 0) {
    memcpy(more, out->datum, out->of.n * sizeof *more);
    memcpy(line, out->line, out->of.n * sizeof *line);
  }
  out->datum = more;
  out->line = line;
  return 1;
}

/* Of several observables some may not have been measured: a cell is empty then, or '-'. */
static int is_empty(reader *r, size_t n, char *const *cell, int column)
{
  const int empty = r->observables > 1 && column < (int)n &&
                    (cell[column][0] == '\0' || strcmp(cell[column], "-") == 0);
  r->gaps |= empty;
  return empty;
}

static void read_line(reader *r, char *line)
{
  const deck *d = r->d;
  char *cell[MOST_COLUMNS];
  const size_t n = split(line, r->separator, cell);
  pendres_fit_datum one = {.axis = 0.0};
  if (r->axis != NONE) one.axis = read_number(r, n, cell, r->axis, "axis");
  one.direction = read_direction(r, n, cell);
  if (r->other != NONE) one.other = read_number(r, n, cell, r->other, "parameter of the sweep");
  const double axis = one.axis;
  for (size_t i = 0; i < r->observables && scene_going(r->run); i++) {
    if (is_empty(r, n, cell, r->observable[i])) continue;
    one.observable = r->kind[i];
    one.observed = read_number(r, n, cell, r->observable[i],
                               pendres_name_get(PENDRES_NAMES_FIT_OBSERVABLE, (int)r->kind[i]));
    one.error = r->error[i] != NONE
                  ? read_number(r, n, cell, r->error[i], "standard error")
                  : hypot(d->data.error, d->data.relative_error * one.observed);
    one.axis = fit_is_place(one.observable) ? one.observed : axis;
    if (r->error[i] != NONE && scene_going(r->run) && !(one.error > 0.0))
      FAIL(r, "%s:%zu: the standard error must be above 0: give all data one, or leave the column "
           "out", r->out->path, r->line);
    if (!scene_going(r->run) || !make_room(r)) continue;
    r->out->line[r->out->of.n] = r->line;
    r->out->datum[r->out->of.n++] = one;
  }
}

/* Without a column the order of the lines tells the direction, sweep by sweep: that to the next
   line, for the last one of a sweep that from the line before. Resonances have none. */
static void set_directions(reader *r)
{
  fit_data *out = r->out;
  const size_t m = r->gaps ? 1 : r->observables, lines = out->of.n / m;
  const char *told = r->d->data.direction;
  int jumps = 0, resonances = 1;
  for (size_t i = 0; i < r->observables; i++) {
    jumps |= r->kind[i] == PENDRES_FIT_JUMP;
    resonances &= r->kind[i] == PENDRES_FIT_RESONANCE;
  }
  if (r->direction == NONE && (jumps || r->gaps) && strcmp(told, "file") == 0)
    FAIL(r, "%s: which way the axis went does not follow from the lines where there are jumps or "
         "empty cells: give a column for the direction, or data.direction", out->path);
  if (!scene_going(r->run)) return;
  for (size_t i = 0; i < lines && r->direction == NONE; i++) {
    const pendres_fit_datum *here = &out->datum[i * m];
    const pendres_fit_datum *next = i + 1 < lines ? here + m : NULL;
    const pendres_fit_datum *last = i > 0 ? here - m : NULL;
    int way = 1;
    if (last != NULL && last->other == here->other && last->axis != here->axis)
      way = here->axis > last->axis ? 1 : -1;
    else if (next != NULL && next->other == here->other)
      way = next->axis >= here->axis ? 1 : -1;
    if (strcmp(told, "up") == 0 || fit_is_decay(r->d) || resonances) way = 1;
    if (strcmp(told, "down") == 0) way = -1;
    for (size_t k = 0; k < m; k++) out->datum[i * m + k].direction = way;
  }
}

/* ---- the file ------------------------------------------------------------------------------ */

/* From the deck's folder, unless the path begins at the root. */
static int open_file(reader *r)
{
  char why[FILE_WORDS];
  const char *file = r->d->data.file, *slash = strrchr(r->d->name, '/');
  const int folder = file[0] != '/' && slash != NULL ? (int)(slash - r->d->name) + 1 : 0;
  const int length =
    snprintf(r->out->path, sizeof r->out->path, "%.*s%s", folder, r->d->name, file);
  if (length < 0 || (size_t)length >= sizeof r->out->path) {
    FAIL(r, "data.file: the path is too long");
    return -1;
  }
  const int fd = file_open(r->out->path, FILE_READ, 0, why);
  if (fd < 0) FAIL(r, "%s: data.file is looked for from the deck's folder", why);
  return fd;
}

/* All of the file, to be freed; of one of results, by its first bytes, its variables in place of
   it. NULL: the run has failed. */
static char *read_text(reader *r, size_t *length)
{
  static const char results[4] = "\211HDF";
  char first[sizeof results], *text = NULL;
  const int fd = open_file(r);
  if (fd < 0) return NULL;
  const int stored = bytes_read(fd, 0, first, sizeof first) &&
                     memcmp(first, results, sizeof first) == 0;
  const pendres_status status = stored ? fit_store_text(r->run, r->out->path, fd, &text, length)
                                       : bytes_text(fd, FIT_MOST_BYTES, &text, length);
  if (status == PENDRES_UNSUPPORTED)
    FAIL(r, "%s: more than %d MiB of data are not read: leave out what is no datum", r->out->path,
         FIT_MOST_BYTES >> 20);
  else if (status != PENDRES_OK)
    (void)scene_fail(r->run, status, "%s: %s", r->out->path,
                     status == PENDRES_IO ? strerror(errno) : "out of memory for data");
  (void)close(fd);
  return text;
}

/* A line without its end. */
static void take_line(reader *r, char *line, int *head)
{
  char *from = r->line == 1 && strncmp(line, "\xef\xbb\xbf", 3) == 0 ? line + 3 : line;
  from[strcspn(from, "#!")] = '\0';
  if (from[strspn(from, " \t\r")] == '\0') return;
  if (!*head) {
    char *copy = strdup(from);
    if (copy == NULL) (void)scene_fail(r->run, PENDRES_OUT_OF_MEMORY, "out of memory for data");
    *head = 1;
    const int names = copy != NULL && read_head(r, copy);
    free(copy);
    if (names) return;
  }
  if (scene_going(r->run)) read_line(r, from);
}

static void read_lines(reader *r, char *text, size_t length)
{
  int head = 0;
  char *const end = text + length;
  for (char *line = text, *next; line < end && scene_going(r->run); line = next) {
    char *stop = memchr(line, '\n', (size_t)(end - line));
    if (stop == NULL) stop = end;
    next = stop + 1;
    *stop = '\0';
    r->line++;
    if (line + strlen(line) == stop) take_line(r, line, &head);
    else FAIL(r, "%s:%zu: a zero byte: data are read as text", r->out->path, r->line);
  }
}

void fit_data_read(scene_run *run, fit_data *out)
{
  const deck *d = run->deck;
  reader r = {.run = run, .d = d, .out = out, .axis = NONE, .direction = NONE, .other = NONE};
  *out = (fit_data){.of = {.axis = PENDRES_PARAMETER_COUNT, .other = PENDRES_PARAMETER_COUNT}};
  for (int k = 0; k < PENDRES_PARAMETER_FOLLOWED; k++)
    if (strcmp(pendres_parameter_of((pendres_parameter)k)->name, d->data.axis) == 0)
      out->of.axis = (pendres_parameter)k;
  for (int k = 0; k < PENDRES_FIT_OBSERVABLE_COUNT; k++) r.observable[k] = r.error[k] = NONE;
  for (size_t i = 0; i < d->data.observables.count; i++)
    r.kind[r.observables++] = (pendres_fit_observable)pendres_name_find(
      PENDRES_NAMES_FIT_OBSERVABLE, d->data.observables.name[i]);
  if (r.observables == 0)
    r.kind[r.observables++] = fit_is_decay(d) ? PENDRES_FIT_DISPLACEMENT : PENDRES_FIT_AMPLITUDE;
  size_t length = 0;
  char *text = read_text(&r, &length);
  if (text != NULL) read_lines(&r, text, length);
  free(text);
  if (scene_going(run) && out->of.n == 0)
    FAIL(&r, "%s: there are no data in the file", out->path);
  if (!scene_going(run)) return;
  set_directions(&r);
  out->of.datum = out->datum;
}
