/*
 * text.c -- tables in text, as instruments write them; see text.h.
 *
 * A line is a datum: cells between commas, semicolons or tabs, or else blanks. A first line with a
 * cell that is no number names the columns, or the last comment before data that has as many words
 * as these have numbers; a line of units may follow. What instruments put around a table is told by
 * its own marks: [DATA] in front of it, or BEGIN and END.
 */
#define _POSIX_C_SOURCE 200809L /* strcasecmp */
#include "scenes/fit/text.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define FAIL(t, ...) (void)scene_fail((t)->run, PENDRES_INVALID_ARGUMENT, __VA_ARGS__)

/* ---- cells --------------------------------------------------------------------------------- */

static const char digits[] = "0123456789";

/* Take commas out of a quoted number that has them between thousands. */
static void close_thousands(char *cell)
{
  char *to = cell + (*cell == '-' || *cell == '+');
  const size_t first = strspn(to, digits);
  const char *from = to + first;
  if (first == 0 || first > 3) return;
  while (*from == ',' && strspn(from + 1, digits) == 3) from += 4;
  if (*from != '\0' && *from != '.') return;
  for (from = to; *from != '\0'; from++)
    if (*from != ',') *to++ = *from;
  *to = '\0';
}

/* The cells of a line, in place; their number. */
static size_t split(const fit_text *t, char *text, char *cell[FIT_COLUMNS])
{
  const char separator = t->separator;
  size_t n = 0;
  char *at = text;
  while (n < FIT_COLUMNS) {
    at += strspn(at, separator == '\t' ? " \r" : " \t\r");
    if (separator == ' ' && *at == '\0') break;
    char *from = *at == '"' && strchr(at + 1, '"') != NULL ? strchr(at + 1, '"') : at;
    char *end = from + strcspn(from, separator == ' ' ? " \t" : (char[]){separator, '\0'});
    const int last = *end == '\0';
    *end = '\0';
    for (char *tail = end; tail > at && strchr(" \t\r", tail[-1]) != NULL;) *--tail = '\0';
    const size_t length = strlen(at);
    if (length > 1 && at[0] == '"' && at[length - 1] == '"') {
      at[length - 1] = '\0';
      at++;
      if (!t->comma && separator != ';') close_thousands(at); /* beside ; a comma is a point */
    }
    cell[n++] = at;
    if (last) break;
    at = end + 1;
  }
  return n;
}

int fit_text_number(const fit_text *t, const char *cell, double *out)
{
  char typed[FIT_CELL], *end;
  const size_t n = strlen(cell);
  if (n == 0 || n >= sizeof typed || (t->comma && strchr(cell, '.') != NULL)) return 0;
  memcpy(typed, cell, n + 1);
  for (char *at = typed; *at != '\0'; at++) {
    if (t->comma && *at == ',') *at = '.';
    const int behind = at > typed && (isdigit((unsigned char)at[-1]) || at[-1] == '.');
    if (behind && (*at == 'd' || *at == 'D')) *at = 'e';
  }
  *out = strtod(typed, &end);
  return *end == '\0';
}

/* What separates cells of a line. */
static char separator_of(const fit_text *t, const char *line)
{
  static const char known[] = ";\t,";
  for (size_t i = 0; known[i] != '\0'; i++)
    if (strchr(line, known[i]) != NULL && !(known[i] == ',' && t->comma)) return known[i];
  return ' ';
}

/* ---- names and units ----------------------------------------------------------------------- */

/* Whether all cells are units, or none: '(V)', '[deg]', 'Hz', '-'. */
static int are_units(size_t n, char *const *cell)
{
  deck_column_unit unit;
  size_t known = 0;
  for (size_t i = 0; i < n; i++) {
    char text[FIT_CELL];
    snprintf(text, sizeof text, "%s", cell[i]);
    const size_t length = strlen(text);
    const int bracket = length > 1 && strchr("([", text[0]) && strchr(")]", text[length - 1]);
    if (bracket) text[length - 1] = '\0';
    const char *inner = text + bracket;
    const int none = *inner == '\0' || strcmp(inner, "-") == 0;
    if (!none && !deck_column_unit_read(inner, NULL, &unit)) return 0;
    known += !none && strcmp(inner, "1") != 0; /* which is also a number */
  }
  return known > 0;
}

/* The unit that a name ends in: behind it in brackets, which `plain` is without, or its last word,
   if that is one of what is measured by waves. */
static void unit_of_name(const char *name, char unit[FIT_CELL], char plain[FIT_CELL])
{
  static const char *const words[] = {"Hz", "kHz", "MHz", "GHz", "mV", "uV", "nV", "dB", "dBm",
                                      "dBV", "deg", "degree", "degrees", "\302\260"};
  deck_column_unit read;
  const size_t n = strlen(name);
  const char *at = name + n;
  unit[0] = '\0';
  memcpy(plain, name, n + 1);
  if (n > 2 && (at[-1] == ')' || at[-1] == ']')) {
    while (at > name && *at != '(' && *at != '[') at--;
    snprintf(unit, FIT_CELL, "%.*s", (int)(name + n - at) - 2, at + 1);
    if (!deck_column_unit_read(unit, NULL, &read)) unit[0] = '\0';
    while (unit[0] != '\0' && at > name && at[-1] == ' ') at--;
    if (unit[0] != '\0') plain[at - name] = '\0';
    return;
  }
  while (at > name && strchr(" _/.-:", at[-1]) == NULL) at--;
  for (size_t k = 0; k < sizeof words / sizeof *words; k++)
    if (k > 6 ? strcasecmp(at, words[k]) == 0 : strcmp(at, words[k]) == 0)
      snprintf(unit, FIT_CELL, "%s", at);
}

static void take_names(fit_text *t, size_t n, char *const *cell)
{
  for (size_t i = 0; i < n; i++) {
    snprintf(t->name[i], FIT_CELL, "%.*s", FIT_CELL - 1, cell[i]);
    unit_of_name(t->name[i], t->unit[i], t->plain[i]);
  }
}

static void take_units(fit_text *t, size_t n, char *const *cell)
{
  for (size_t i = 0; i < n; i++) {
    const int bracket = cell[i][0] == '(' || cell[i][0] == '[';
    const int length = (int)strlen(cell[i]) - 2 * bracket;
    if (length > 0 && strcmp(cell[i], "-") != 0)
      snprintf(t->unit[i], FIT_CELL, "%.*s", length, cell[i] + bracket);
  }
}

static int has_words(const fit_text *t, size_t n, char *const *cell)
{
  double unused;
  int words = 0;
  for (size_t i = 0; i < n; i++)
    words |= !fit_text_number(t, cell[i], &unused) && strcasecmp(cell[i], "up") != 0 &&
             strcasecmp(cell[i], "down") != 0;
  return words;
}

/* ---- lines --------------------------------------------------------------------------------- */

/* Where the lines are that have been read: names, units, data. */
typedef enum place { BEFORE, NAMED, WITHIN } place;

/* The names in the last comment, if they are as many as the columns. */
static void take_comment(fit_text *t, char *comment)
{
  char *cell[FIT_COLUMNS];
  double unused;
  if (comment == NULL) return;
  const size_t n = split(t, comment, cell);
  t->whispered = n == t->columns && n > 1;
  for (size_t i = 0; i < n; i++) t->whispered &= !fit_text_number(t, cell[i], &unused);
  if (t->whispered) take_names(t, n, cell);
}

/* A line of cells. */
static void take_line(fit_text *t, char *line, char *comment, place *at)
{
  char *cell[FIT_COLUMNS];
  if (*at == BEFORE) t->separator = separator_of(t, line);
  const size_t n = split(t, line, cell);
  const place before = *at;
  const int words = before == BEFORE && has_words(t, n, cell);
  const int units = before == NAMED && are_units(n, cell);
  if (before == BEFORE) t->columns = n;
  *at = words ? NAMED : units ? NAMED : WITHIN;
  if (words) take_names(t, n, cell);
  else if (units) take_units(t, n, cell);
  else if (before == BEFORE) take_comment(t, comment);
  if (*at == WITHIN && before != WITHIN) t->head(t->to);
  if (*at == WITHIN && scene_going(t->run)) t->row(t->to, n, cell);
}

/* A mark around the table, in a line of n bytes: 1 before it, 2 behind it. */
static int mark_of(const char *line, size_t n)
{
  while (n > 0 && strchr(" \t\r", line[n - 1]) != NULL) n--;
  if (n == 6 && strncasecmp(line, "[DATA]", 6) == 0) return 1;
  if (n >= 5 && strncmp(line, "BEGIN", 5) == 0 && (n == 5 || line[5] == ' ')) return 1;
  return n == 3 && strncmp(line, "END", 3) == 0 ? 2 : 0;
}

/* Where the table begins and ends, if it is within marks: text before and behind is no data. */
static void find_table(const fit_text *t, char *text, const char *end, char **from, const char **to)
{
  const int told = strcmp(t->format, "any") != 0;
  const int marked = strcmp(t->format, "nanonis") == 0 || strcmp(t->format, "analyser") == 0;
  *from = NULL;
  *to = end;
  for (char *line = text; line < end && !(told && !marked);) {
    char *stop = memchr(line, '\n', (size_t)(end - line));
    const int mark = mark_of(line, stop != NULL ? (size_t)(stop - line) : (size_t)(end - line));
    if (mark == 1 && *from != NULL)
      FAIL(t, "%s: there are several tables, each behind a mark BEGIN or [DATA]: leave one of them",
           t->path);
    if (mark == 1) *from = line;
    if (mark == 2 && *from != NULL) *to = line;
    if (mark == 2 && *from != NULL) return;
    if (stop == NULL) break;
    line = stop + 1;
  }
  if (*from == NULL && marked)
    FAIL(t, "%s: '%s' has a line %s in front of its table, and there is none: leave data.format "
         "out", t->path, t->format, t->format[0] == 'n' ? "[DATA]" : "BEGIN");
}

/* A line without its end. */
static void take_text(fit_text *t, char *line, char **comment, place *at)
{
  char *from = strncmp(line, "\xef\xbb\xbf", 3) == 0 && t->line == 1 ? line + 3 : line;
  from += strspn(from, " \t\r");
  if (*from == '#' || *from == '!' || *from == '%') {
    if (*at == BEFORE) *comment = from + strspn(from, "#!% \t");
    return;
  }
  from[strcspn(from, "#!")] = '\0';
  if (*from != '\0') take_line(t, from, *comment, at);
}

void fit_text_read(fit_text *t, char *text, size_t length)
{
  char *const end = text + length, *comment = NULL, *from;
  const char *to;
  place at = BEFORE;
  t->line = 0;
  t->gaps = strcmp(t->format, "any") != 0 && strcmp(t->format, "text") != 0;
  find_table(t, text, end, &from, &to);
  t->gaps |= from != NULL;
  size_t number = 0;
  for (char *line = text, *next; line < to && scene_going(t->run); line = next) {
    char *stop = memchr(line, '\n', (size_t)(end - line));
    if (stop == NULL) stop = end;
    next = stop + 1;
    *stop = '\0';
    t->line = t->lines != NULL ? t->lines[number] : number + 1;
    number++;
    if (line + strlen(line) != stop)
      FAIL(t, "%s:%zu: a zero byte: data are read as text", t->path, t->line);
    else if (from == NULL || line > from) take_text(t, line, &comment, &at);
  }
  if (at != WITHIN && scene_going(t->run)) FAIL(t, "%s: there are no data in the file", t->path);
}
