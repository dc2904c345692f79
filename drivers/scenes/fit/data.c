/*
 * data.c -- data of a fit from a file; see data.h.
 *
 * A line of a table is a datum of each observable. What the columns are is told by the deck, or by
 * their names; what they are in by units of the deck, or by the file.
 */
#include "scenes/fit/data.h"

#include <math.h>
#include <stdlib.h>
#include <strings.h>

#include "scenes/fit/file.h"
#include "scenes/fit/text.h"

enum { NONE = -1, OBSERVABLES = PENDRES_FIT_OBSERVABLE_COUNT };

/* A file while it is read. */
typedef struct reader {
  fit_text text;
  scene_run *run;
  const deck *d;
  fit_data *out;
  /* Columns of what is needed, from 0 on. */
  int axis, direction, other, observable[OBSERVABLES], error[OBSERVABLES];
  size_t observables, room;
  int gaps; /* some lines have not all of them */
  pendres_fit_observable kind[OBSERVABLES];
  deck_column_unit unit[FIT_COLUMNS];
  int line, polar; /* the observables are parts of an S-parameter; or magnitude and phase */
  int sign;        /* of i w t in the data */
} reader;

#define FAIL(r, ...) (void)scene_fail((r)->run, PENDRES_INVALID_ARGUMENT, __VA_ARGS__)

/* ---- columns ------------------------------------------------------------------------------- */

/* The column of a name or number that the deck tells; NONE, and a failure, if there is none. */
static int column_of(const reader *r, const char *word)
{
  double number;
  char list[300] = "";
  for (size_t i = 0; i < r->text.columns; i++)
    if (r->text.name[i][0] != '\0' &&
        (strcmp(r->text.name[i], word) == 0 || strcmp(r->text.plain[i], word) == 0))
      return (int)i;
  if (fit_text_number(&r->text, word, &number) && number == floor(number) && number >= 1.0 &&
      number <= (double)r->text.columns)
    return (int)number - 1;
  for (size_t i = 0; i < r->text.columns; i++)
    snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", i > 0 ? ", " : "",
             r->text.name[i][0] != '\0' ? r->text.name[i] : "(no name)");
  FAIL(r, "%s:%zu: there is no column '%.60s' among the %zu that the file has (%s): give names "
       "or numbers from 1 on in data.columns", r->out->path, r->text.line, word, r->text.columns,
       list);
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

/* The two columns of an S-parameter that a file of such names, as S21; 0: it has none. */
static int take_parameter(reader *r, const char *word)
{
  static const char *const part[] = {"real", "imaginary"};
  int found = 0;
  for (size_t i = 0; i < r->text.columns; i++)
    for (int k = 0; k < 2; k++) {
      char name[FIT_CELL + 16];
      snprintf(name, sizeof name, "%s_%s", word, part[k]);
      if (strcasecmp(r->text.name[i], name) != 0) continue;
      r->observable[k] = (int)i;
      found++;
    }
  return found == 2;
}

static void take_told(reader *r)
{
  const deck_names *told = &r->d->data.columns;
  int column[FIT_COLUMNS];
  size_t n = 0;
  for (size_t i = 0; i < told->count && scene_going(r->run); i++) {
    char word[DECK_NAME];
    snprintf(word, sizeof word, "%s", told->name[i]);
    char *equals = strchr(word, '=');
    if (equals != NULL) *equals = '\0';
    if (r->line && take_parameter(r, equals != NULL ? equals + 1 : word)) continue;
    const int at = column_of(r, equals != NULL ? equals + 1 : word);
    if (at == NONE) return;
    if (equals != NULL && !take_role(r, word, at))
      FAIL(r, "data.columns: '%s' is no role: roles are axis, the observables, these with _error, "
           "direction, and a parameter", word);
    /* A name that is a role in itself says more than its place. */
    if (equals != NULL || (strcmp(r->text.plain[at], "direction") == 0 &&
                           take_role(r, "direction", at))) continue;
    if (n < FIT_COLUMNS) column[n++] = at;
  }
  if (scene_going(r->run)) take_in_order(r, n, column);
}

/* ---- units --------------------------------------------------------------------------------- */

/* Take a column's unit: what makes SI of it, if that is known; `of`: the SI unit of what it is,
   NULL: whatever it tells. */
static void take_unit(reader *r, int column, const char *of, const char *what)
{
  const char *unit = r->text.unit[column];
  if (unit[0] == '\0' || !scene_going(r->run)) return;
  const int fits = deck_column_unit_read(unit, of, &r->unit[column]);
  if (fits <= 0)
    FAIL(r, "%s:%zu: column %d is in '%.40s', and is to be the %s%s%s: tell its unit in data.units",
         r->out->path, r->text.line, column + 1, unit, what, of == NULL ? "" : ", in ",
         of == NULL ? "" : of[0] == '\0' ? "numbers without a unit" : of);
}

/* The SI unit of data; NULL: any. */
static const char *unit_of_observable(const reader *r, pendres_fit_observable o, deck_si *si)
{
  if (o == PENDRES_FIT_PHASE_LAG) return "rad";
  return fit_units_of_observable(r->d, o, si) ? si->units : NULL;
}

static const char *unit_of_parameter(const reader *r, pendres_parameter p, deck_si *si)
{
  if (fit_units_of_data(r->d, p, si)) return si->units;
  return p == PENDRES_DRIVE_FREQUENCY ? "Hz" : p == PENDRES_PARAMETER_COUNT ? "s" : NULL;
}

/* Units that the deck tells, in the order of its columns, or else of the file's. */
static void take_told_units(reader *r)
{
  const deck_names *told = &r->d->data.units, *columns = &r->d->data.columns;
  if (told->count > (columns->count > 0 ? columns->count : r->text.columns))
    FAIL(r, "data.units has %zu units for %zu columns", told->count,
         columns->count > 0 ? columns->count : r->text.columns);
  for (size_t i = 0; i < told->count && scene_going(r->run); i++) {
    const char *name = columns->count > 0 ? columns->name[i] : "";
    const char *equals = strchr(name, '=');
    const int at = *name == '\0' ? (int)i : column_of(r, equals != NULL ? equals + 1 : name);
    if (at != NONE) snprintf(r->text.unit[at], FIT_CELL, "%s", told->name[i]);
  }
}

static int is_angle(const char *unit)
{
  deck_column_unit read;
  return unit[0] != '\0' && strcmp(unit, "1") != 0 && deck_column_unit_read(unit, "rad", &read) > 0;
}

/* A phase is the second of the two columns of an S-parameter, and has a unit. */
static void check_part(const reader *r, size_t i)
{
  const int at = r->observable[i], angle = is_angle(r->text.unit[at]);
  const int phase = strncasecmp(r->text.name[at], "phase", 5) == 0;
  if ((i == 0 && angle) || (phase && r->text.unit[at][0] == '\0'))
    FAIL(r, "%s:%zu: column %d is %s: tell frequency, magnitude and phase of S in this order in "
         "data.columns, and their units, as 'deg', in data.units", r->out->path, r->text.line,
         at + 1, angle ? "an angle, and not a part or the magnitude" : "a phase without a unit");
}

static void take_units(reader *r)
{
  deck_si si;
  const pendres_parameter axis = r->out->of.axis, other = r->out->of.other;
  take_told_units(r);
  for (int i = 0; i < FIT_COLUMNS; i++) r->unit[i] = (deck_column_unit){ .factor = 1.0 };
  if (r->axis != NONE) take_unit(r, r->axis, unit_of_parameter(r, axis, &si), r->d->data.axis);
  if (r->other != NONE)
    take_unit(r, r->other, unit_of_parameter(r, other, &si), pendres_parameter_of(other)->name);
  for (size_t i = 0; i < r->observables; i++) {
    const char *of = fit_is_place(r->kind[i]) ? unit_of_parameter(r, axis, &si)
                                              : unit_of_observable(r, r->kind[i], &si);
    const char *name = pendres_name_get(PENDRES_NAMES_FIT_OBSERVABLE, (int)r->kind[i]);
    const int at = r->observable[i], error = r->error[i];
    if (r->line && scene_going(r->run)) check_part(r, i);
    r->polar |= i == 1 && r->line && is_angle(r->text.unit[at]);
    take_unit(r, at, i == 1 && r->polar ? "rad" : of, name);
    if (r->polar && error != NONE)
      FAIL(r, "%s:%zu: the standard errors of a magnitude and a phase are not taken: give that of "
           "the complex number as data.error or relative_error", r->out->path, r->text.line);
    if (error != NONE && r->text.unit[error][0] == '\0') r->unit[error] = r->unit[at];
    else if (error != NONE) take_unit(r, error, of, "standard error");
    const int logarithms = r->unit[at].decibel || (error != NONE && r->unit[error].decibel);
    if (logarithms && r->kind[i] == PENDRES_FIT_LOOP_AREA)
      FAIL(r, "%s:%zu: a loop_area is an energy, and dB are taken for those of amplitudes: make it "
           "10^(dB/10)", r->out->path, r->text.line);
    if (logarithms && scene_going(r->run) && error != NONE && !r->unit[at].decibel)
      FAIL(r, "%s:%zu: the standard error is in dB, and the %s is not: tell both in data.units",
           r->out->path, r->text.line, name);
  }
}

/* A number of a column in SI; of drives in dBm what arrives. */
static double in_si(const reader *r, int column, double x)
{
  const deck_column_unit *u = &r->unit[column];
  if (!u->decibel) return x * u->factor;
  const int drive = column == r->other || column == r->axis;
  return u->factor * pow(10.0, (x - (drive && u->milliwatt ? r->d->data.loss : 0.0)) / 20.0);
}

/* The same of a standard error in that unit, of what `value` is in SI. */
static double error_in_si(const deck_column_unit *u, double error, double value)
{
  return u->decibel ? error * fabs(value) * log(10.0) / 20.0 : error * u->factor;
}

/* What the names in the file say, or without such the order of the columns. */
static void take_names(reader *r)
{
  const reader before = *r;
  const int first[4] = {0, 1, 2, 3};
  int named = 0, whole = 1;
  for (size_t i = 0; i < r->text.columns; i++)
    named += r->text.name[i][0] != '\0' && take_role(r, r->text.plain[i], (int)i);
  for (size_t i = 0; i < r->observables; i++) whole &= r->observable[i] != NONE;
  whole &= r->axis != NONE || are_places(r);
  if (named > 0 && (whole || !r->text.whispered)) return;
  *r = before;
  take_in_order(r, r->text.columns < 4 ? r->text.columns : 4, first);
}

/* What the columns are, before the first data. */
static void find_columns(void *to)
{
  reader *r = to;
  const int named = strcmp(r->text.name[0], pendres_parameter_of(PENDRES_DRIVE_FREQUENCY)->name);
  if (r->d->data.columns.count > 0) take_told(r);
  else if (!r->line || !(take_parameter(r, "S21") || take_parameter(r, "S11"))) take_names(r);
  if (r->line && r->axis == NONE && named == 0) r->axis = 0;
  if (!scene_going(r->run)) return;
  const char *missing = r->axis == NONE && !are_places(r) ? r->d->data.axis : NULL;
  for (size_t i = 0; i < r->observables; i++)
    if (r->observable[i] == NONE && missing == NULL)
      missing = r->line ? "s_parameter" : pendres_name_get(PENDRES_NAMES_FIT_OBSERVABLE,
                                                           (int)r->kind[i]);
  if (missing != NULL)
    FAIL(r, "%s:%zu: no column of '%s' is known: name it in the first line, or tell the columns in "
         "data.columns", r->out->path, r->text.line, missing);
  else take_units(r);
}

/* ---- data ---------------------------------------------------------------------------------- */

static double read_number(const reader *r, size_t n, char *const *cell, int column,
                          const char *what)
{
  double x = NAN;
  if (!scene_going(r->run)) return NAN;
  if (column >= (int)n)
    FAIL(r, "%s:%zu: the line has %zu columns, and column %d is to be the %s: complete or remove "
         "the line", r->out->path, r->text.line, n, column + 1, what);
  else if (!fit_text_number(&r->text, cell[column], &x))
    FAIL(r, "%s:%zu: '%.60s' in column %d is no number, and is to be the %s: %s", r->out->path,
         r->text.line, cell[column], column + 1, what,
         strchr(cell[column], ',') != NULL && !r->text.comma
           ? "decimals have a point, or else tell data.decimal" : "correct or remove it");
  else if (!isfinite(x))
    FAIL(r, "%s:%zu: the %s in column %d is not finite: remove the line, or make it a comment "
         "by #", r->out->path, r->text.line, what, column + 1);
  return x;
}

static int read_direction(const reader *r, size_t n, char *const *cell)
{
  if (r->direction == NONE) return 0;
  if (r->direction < (int)n && strcasecmp(cell[r->direction], "up") == 0) return 1;
  if (r->direction < (int)n && strcasecmp(cell[r->direction], "down") == 0) return -1;
  const double x = read_number(r, n, cell, r->direction, "direction (1, -1, up or down)");
  if (scene_going(r->run) && fabs(x) != 1.0)
    FAIL(r, "%s:%zu: a direction is 1 or up, -1 or down, not %g as in column %d", r->out->path,
         r->text.line, x, r->direction + 1);
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

/* Of several observables some may not have been measured: a cell is empty then, or '-', or no
   number; the latter also of one where an instrument wrote the file. */
static int is_empty(reader *r, size_t n, char *const *cell, int column)
{
  double x;
  if (column >= (int)n) return 0;
  const int number = fit_text_number(&r->text, cell[column], &x);
  const int none = cell[column][0] == '\0' || strcmp(cell[column], "-") == 0;
  const int empty = (r->observables > 1 && none) ||
                    (number && isnan(x) && (r->observables > 1 || r->text.gaps));
  r->gaps |= empty;
  return empty;
}

/* The datum of observable number i in a line. */
static void read_datum(reader *r, size_t n, char *const *cell, size_t i, pendres_fit_datum *one)
{
  const deck *d = r->d;
  const int at = r->observable[i], error = r->error[i];
  const double x = read_number(r, n, cell, at, pendres_name_get(PENDRES_NAMES_FIT_OBSERVABLE,
                                                                (int)r->kind[i]));
  one->observable = r->kind[i];
  one->observed = in_si(r, at, x);
  one->error = error != NONE
                 ? error_in_si(&r->unit[error], read_number(r, n, cell, error, "standard error"),
                               one->observed)
                 : hypot(error_in_si(&r->unit[at], d->data.error, one->observed),
                         d->data.relative_error * one->observed);
  if (one->observable == PENDRES_FIT_PHASE_LAG && r->text.unit[at][0] != '\0')
    one->observed = remainder(one->observed, 2.0 * PENDRES_PI);
  if (error != NONE && scene_going(r->run) && !(one->error > 0.0))
    FAIL(r, "%s:%zu: the standard error must be above 0: give all data one, or leave the column "
         "out", r->out->path, r->text.line);
}

/* Make real and imaginary part of magnitude and phase, and of time's other sign. `of`: the data of
   a line, which are the last ones. */
static void turn(const reader *r, size_t n, pendres_fit_datum *of)
{
  if (r->line && r->polar && n == 2) {
    const double size = of[0].observed, phase = of[1].observed;
    of[0].observed = size * cos(phase);
    of[1].observed = size * sin(phase);
    of[1].error = of[0].error;
  }
  for (size_t i = 0; i < n; i++) {
    const int flips = r->line ? i == 1 && r->sign < 0
                              : of[i].observable == PENDRES_FIT_QUADRATURE && r->sign > 0;
    if (flips) of[i].observed = -of[i].observed;
  }
}

static void read_line(void *to, size_t n, char *const *cell)
{
  reader *r = to;
  pendres_fit_datum one = {.axis = 0.0};
  if (r->axis != NONE) one.axis = in_si(r, r->axis, read_number(r, n, cell, r->axis, "axis"));
  one.direction = read_direction(r, n, cell);
  if (r->other != NONE)
    one.other = in_si(r, r->other, read_number(r, n, cell, r->other, "parameter of the sweep"));
  const double axis = one.axis;
  const size_t before = r->out->of.n;
  for (size_t i = 0; i < r->observables && scene_going(r->run); i++) {
    if (is_empty(r, n, cell, r->observable[i])) continue;
    read_datum(r, n, cell, i, &one);
    one.axis = fit_is_place(one.observable) ? one.observed : axis;
    if (!scene_going(r->run) || !make_room(r)) continue;
    r->out->line[r->out->of.n] = r->text.line;
    r->out->datum[r->out->of.n++] = one;
  }
  const size_t read = r->out->of.n - before;
  if (scene_going(r->run) && read > 0 && r->line && read < r->observables)
    FAIL(r, "%s:%zu: one part of the S-parameter is missing: remove the line", r->out->path,
         r->text.line);
  if (scene_going(r->run)) turn(r, read, &r->out->datum[before]);
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

void fit_data_read(scene_run *run, fit_data *out)
{
  const deck *d = run->deck;
  reader r = {.run = run, .d = d, .out = out, .axis = NONE, .direction = NONE, .other = NONE};
  *out = (fit_data){.of = {.axis = fit_axis(d), .other = PENDRES_PARAMETER_COUNT}};
  for (int k = 0; k < OBSERVABLES; k++) r.observable[k] = r.error[k] = NONE;
  r.sign = (int)d->data.time_sign;
  r.line = fit_is_line(d);
  for (size_t i = 0; i < d->data.observables.count; i++) {
    char name[DECK_NAME + 16];
    snprintf(name, sizeof name, "%s%s", r.line ? d->fit.model : d->data.observables.name[i],
             r.line ? "_real" : "");
    r.kind[r.observables++] =
      (pendres_fit_observable)pendres_name_find(PENDRES_NAMES_FIT_OBSERVABLE, name);
    if (r.line) r.kind[r.observables++] = (pendres_fit_observable)(r.kind[0] + 1);
  }
  if (r.observables == 0)
    r.kind[r.observables++] = fit_is_decay(d) ? PENDRES_FIT_DISPLACEMENT : PENDRES_FIT_AMPLITUDE;
  fit_file file;
  fit_file_read(run, &file);
  memcpy(out->path, file.path, sizeof out->path);
  r.text = (fit_text){.run = run, .path = out->path, .format = d->data.format, .to = &r,
                      .comma = strcmp(d->data.decimal, "comma") == 0, .head = find_columns,
                      .row = read_line};
  r.text.lines = file.lines;
  if (scene_going(run)) fit_text_read(&r.text, file.text, file.length);
  free(file.text);
  free(file.lines);
  if (scene_going(run) && out->of.n == 0)
    FAIL(&r, "%s: there are no data in the file", out->path);
  if (!scene_going(run)) return;
  out->axis_factor = r.axis != NONE ? r.unit[r.axis].factor : r.unit[r.observable[0]].factor;
  set_directions(&r);
  out->of.datum = out->datum;
}
