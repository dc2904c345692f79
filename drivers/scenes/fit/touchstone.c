/*
 * touchstone.c -- network parameters from Touchstone files, versions 1 and 2, as tables of real and
 * imaginary parts; see file.h.
 *
 * Source: Touchstone File Format Specification, versions 1.1 (2003) and 2.1 (2024), IBIS Open
 * Forum. The option line has its words in any order. Version 1 knows the number of ports by the
 * file's name, puts N21 before N12 of two ports, ends before noise parameters, which begin where a
 * frequency does not ascend, and has Z, Y, H and G normalised to R; version 2 does none of that.
 */
#include "scenes/fit/file.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "system/grow.h"
#include "system/text.h"

enum { PORTS = 5, WORD = 40, MOST_NUMBERS = 1 + 2 * PORTS * PORTS };

typedef struct touchstone {
  scene_run *run;
  const char *path;
  text out;
  fit_file *file;
  size_t line, rows, capacity;
  int version, ports;
  int told, columns; /* the options have been read; the line of names has been written */
  int first_21, half;                /* order of two ports; -1: lower, 1: upper triangle */
  double unit, resistance;
  char parameter, format; /* 'S', 'Z', ...; 'M'agnitude, 'D'ecibels, 'R'eal */
  enum { HEAD, REFERENCE, INFORMATION, NETWORK, BEHIND } place;
  double number[MOST_NUMBERS], last; /* of a record, and the last frequency */
  int count;
} touchstone;

static void fail(touchstone *t, const char *what, const char *word)
{
  (void)scene_fail(t->run, PENDRES_INVALID_ARGUMENT, "%s:%zu: %s%s%.40s%s", t->path, t->line, what,
                   word != NULL ? " '" : "", word != NULL ? word : "", word != NULL ? "'" : "");
}

/* The next word of a line; NULL: there is none. */
static char *next_word(char **at)
{
  char *word = *at + strspn(*at, " \t\r");
  if (*word == '\0') return NULL;
  *at = word + strcspn(word, " \t\r");
  if (**at != '\0') *(*at)++ = '\0';
  return word;
}

static int number_in(const char *word, double *out)
{
  char *end;
  *out = strtod(word, &end);
  return end != word && *end == '\0' && isfinite(*out);
}

/* ---- what stands in front of the data ------------------------------------------------------ */

static void read_options(touchstone *t, char *at)
{
  static const struct { const char *name; double unit; } units[] = {
    {"HZ", 1.0}, {"KHZ", 1e3}, {"MHZ", 1e6}, {"GHZ", 1e9}};
  int resistances = 0;
  double number = 0.0;
  if (t->told) return; /* others after the first are ignored */
  t->told = 1;
  for (char *word = next_word(&at); word != NULL && scene_going(t->run); word = next_word(&at)) {
    int known = 0;
    for (int k = 0; k < 4; k++) {
      if (strcasecmp(word, units[k].name) != 0) continue;
      t->unit = units[k].unit;
      known = 1;
    }
    if (strcasecmp(word, "MA") == 0 || strcasecmp(word, "DB") == 0 || strcasecmp(word, "RI") == 0) {
      t->format = (char)toupper((unsigned char)*word);
      known = 1;
    } else if (strlen(word) == 1 && strchr("SZYHGszyhg", *word) != NULL) {
      t->parameter = (char)toupper((unsigned char)*word);
      known = 1;
    } else if (strcasecmp(word, "R") == 0) {
      resistances = known = 1;
    } else if (resistances && number_in(word, &number) && number > 0.0) {
      known = 1;
      if (resistances++ > 1 && number != t->resistance && t->parameter != 'S')
        fail(t, "ports of several resistances: give S parameters, not", word);
      t->resistance = number;
    }
    if (!known) fail(t, "the option line has no such word as", word);
  }
}

/* The words behind a keyword. */
static void read_keyword(touchstone *t, char *line)
{
  char *end = strchr(line, ']'), *at = end != NULL ? end + 1 : line;
  double number = 0.0;
  if (end == NULL) {
    fail(t, "a keyword ends with ], and this does not:", line);
    return;
  }
  const size_t n = (size_t)(end - line) + 1;
  char *word = next_word(&at);
  const int whole = word != NULL && number_in(word, &number);
  const int is_one = whole && number >= 1.0 && number == floor(number);
  if (t->place == REFERENCE) t->place = HEAD;
  if (strncasecmp(line, "[Version]", n) == 0) t->version = 2;
  else if (strncasecmp(line, "[Number of Ports]", n) == 0 && is_one)
    t->ports = (int)fmin(number, PORTS + 1);
  else if (strncasecmp(line, "[Two-Port", 9) == 0 && word != NULL)
    t->first_21 = strcmp(word, "21_12") == 0;
  else if (strncasecmp(line, "[Matrix Format]", n) == 0 && word != NULL)
    t->half = strcasecmp(word, "Lower") == 0 ? -1 : strcasecmp(word, "Upper") == 0;
  else if (strncasecmp(line, "[Reference]", n) == 0) t->place = REFERENCE;
  else if (strncasecmp(line, "[Begin Information]", n) == 0) t->place = INFORMATION;
  else if (strncasecmp(line, "[End Information]", n) == 0) t->place = HEAD;
  else if (strncasecmp(line, "[Network Data]", n) == 0) t->place = NETWORK;
  else if (strncasecmp(line, "[Noise Data]", n) == 0 || strncasecmp(line, "[End]", n) == 0)
    t->place = BEHIND;
  else if (t->place != INFORMATION && strncasecmp(line, "[Number of", 10) != 0)
    fail(t, "this keyword is not read; leave out mixed modes and what else it says:", line);
}

/* ---- data ---------------------------------------------------------------------------------- */

/* The numbers of a record. */
static int record_of(const touchstone *t)
{
  return 1 + (t->half != 0 ? t->ports * (t->ports + 1) : 2 * t->ports * t->ports);
}

/* Which entry, from 0 on by rows, pair number k of a record is. */
static int entry_of(const touchstone *t, int k)
{
  const int n = t->ports;
  if (n == 2 && t->half == 0 && t->first_21 && (k == 1 || k == 2)) return 3 - k;
  if (t->half == 0) return k;
  for (int i = 0; i < n; i++)
    for (int j = t->half < 0 ? 0 : i; j < (t->half < 0 ? i + 1 : n); j++)
      if (k-- == 0) return i * n + j;
  return 0;
}

/* What version 1 has an entry normalised by. */
static double resistance_of(const touchstone *t, int entry)
{
  const double r = t->resistance;
  if (t->version == 2 || t->parameter == 'S') return 1.0;
  if (t->parameter == 'Z') return r;
  if (t->parameter == 'Y') return 1.0 / r;
  if (entry == 1 || entry == 2) return 1.0;
  return (entry == 0) == (t->parameter == 'H') ? r : 1.0 / r;
}

static void write_names(touchstone *t)
{
  fprintf(t->out.stream, "drive_frequency");
  for (int k = 0; k < t->ports * t->ports; k++)
    for (int part = 0; part < 2; part++)
      fprintf(t->out.stream, ";%c%d%d_%s", t->parameter, k / t->ports + 1, k % t->ports + 1,
              part == 0 ? "real" : "imaginary");
  fputc('\n', t->out.stream);
  t->columns = 1;
}

static void write_record(touchstone *t)
{
  double part[2 * PORTS * PORTS];
  const int n = t->ports;
  for (int k = 0; 2 * k + 1 < t->count; k++) {
    const double a = t->number[1 + 2 * k], b = t->number[2 + 2 * k], turn = PENDRES_PI / 180.0;
    const double size = t->format == 'D' ? pow(10.0, a / 20.0) : a;
    const int at = entry_of(t, k), mirror = at % n * n + at / n;
    const double r = resistance_of(t, at);
    const int real = t->format == 'R';
    const double both[2] = {r * (real ? a : size * cos(b * turn)),
                            r * (real ? b : size * sin(b * turn))};
    memcpy(&part[2 * at], both, sizeof both);
    if (t->half != 0) memcpy(&part[2 * mirror], both, sizeof both);
  }
  if (!t->columns) write_names(t);
  if (!grow_to(&t->file->lines, t->rows + 2, &t->capacity, sizeof *t->file->lines)) {
    (void)scene_fail(t->run, PENDRES_OUT_OF_MEMORY, "out of memory for data");
    return;
  }
  t->file->lines[++t->rows] = t->line; /* behind the line of names */
  fprintf(t->out.stream, "%.17g", t->unit * t->number[0]);
  for (int k = 0; k < 2 * n * n; k++) fprintf(t->out.stream, ";%.17g", part[k]);
  fputc('\n', t->out.stream);
  t->last = t->number[0];
  t->count = 0;
}

/* The number of ports, where only the first line of data tells it. */
static void guess_ports(touchstone *t, size_t numbers)
{
  if (t->ports == 0) t->ports = numbers == 3 ? 1 : numbers == 9 ? 2 : 0;
  if (t->ports == 0 || t->ports > PORTS)
    fail(t, t->ports == 0 ? "the number of ports is not known: name the file .s1p, .s2p, ..."
                          : "more than 5 ports are not read: take those of the oscillator", NULL);
}

static void read_numbers(touchstone *t, char *line)
{
  char *at = line;
  double number[MOST_NUMBERS];
  size_t n = 0;
  for (char *word = next_word(&at); word != NULL && scene_going(t->run); word = next_word(&at)) {
    if (n == MOST_NUMBERS || !number_in(word, &number[n])) fail(t, "this is no number:", word);
    else n++;
  }
  if (!scene_going(t->run)) return;
  if (t->rows == 0 && t->count == 0) guess_ports(t, n);
  if (!scene_going(t->run)) return;
  if (t->count == 0 && t->rows > 0 && !(number[0] > t->last)) {
    t->place = BEHIND;
    if (t->version == 2 || t->ports != 2 || n != 5)
      fail(t, "frequencies ascend in these files, and here they do not", NULL);
    return;
  }
  if (t->count + (int)n > record_of(t)) {
    fail(t, "the line has more numbers than the matrix has left: see the number of ports", NULL);
    return;
  }
  if (n % 2 != (t->count == 0)) {
    fail(t, t->count == 0 ? "one of a pair of numbers is missing behind the frequency"
                          : "pairs of the matrix before this line are missing: see the number of "
                            "ports that the file's name tells", NULL);
    return;
  }
  memcpy(&t->number[t->count], number, n * sizeof *number);
  t->count += (int)n;
  if (t->count == record_of(t)) write_record(t);
}

static void read_line(touchstone *t, char *line)
{
  line[strcspn(line, "!")] = '\0';
  line += strspn(line, " \t\r");
  if (*line == '\0') return;
  if (*line == '[') read_keyword(t, line);
  else if (t->place == INFORMATION || t->place == BEHIND || t->place == REFERENCE) return;
  else if (*line == '#') read_options(t, line + 1);
  else read_numbers(t, line);
}

/* ---- the file ------------------------------------------------------------------------------ */

/* The ports that a name ends in, as .s2p; 0: it does not. */
static int ports_of(const char *path)
{
  const char *dot = strrchr(path, '.');
  char *end;
  if (dot == NULL || tolower((unsigned char)dot[1]) != 's') return 0;
  if (!isdigit((unsigned char)dot[2])) return 0;
  const long n = strtol(dot + 2, &end, 10);
  return strcasecmp(end, "p") == 0 && n > 0 ? (int)(n > PORTS ? PORTS + 1 : n) : 0;
}

int fit_is_touchstone(const char *path, const char *text)
{
  static const char *const words[] = {"HZ", "KHZ", "MHZ", "GHZ", "S", "Z", "Y", "H", "G", "MA",
                                      "DB", "RI", "R", NULL};
  char line[200], *at = line;
  int known = 0;
  if (ports_of(path) > 0) return 1;
  for (;; text += strcspn(text, "\n") + 1) {
    const char *from = text + strspn(text, " \t\r\n");
    if (*from != '!' || strchr(from, '\n') == NULL) break;
    text = from;
  }
  text += strspn(text, " \t\r\n");
  snprintf(line, sizeof line, "%.*s", (int)strcspn(text, "\n"), text);
  line[strcspn(line, "!")] = '\0';
  if (strncasecmp(line, "[Version]", 9) == 0) return 1;
  if (*at++ != '#') return 0;
  for (char *word = next_word(&at); word != NULL; word = next_word(&at)) {
    int k = 0;
    double number;
    while (words[k] != NULL && strcasecmp(words[k], word) != 0) k++;
    if (words[k] == NULL && !number_in(word, &number)) return 0;
    known++;
  }
  return known > 1;
}

void fit_touchstone(scene_run *run, fit_file *file)
{
  touchstone t = {.run = run, .path = file->path, .file = file, .unit = 1e9, .resistance = 50.0,
                  .parameter = 'S', .format = 'M', .first_21 = 1, .version = 1,
                  .ports = ports_of(file->path)};
  char *const end = file->text + file->length;
  if (!text_open(&t.out)) {
    (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for data");
    return;
  }
  for (char *line = file->text, *stop; line < end && scene_going(run); line = stop + 1) {
    stop = memchr(line, '\n', (size_t)(end - line));
    if (stop == NULL) stop = end;
    *stop = '\0';
    t.line++;
    if (line + strlen(line) == stop) read_line(&t, line);
    else fail(&t, "a zero byte: data are read as text", NULL);
  }
  if (scene_going(run) && t.count > 0) fail(&t, "the last matrix is not complete", NULL);
  free(file->text);
  file->text = text_close(&t.out);
  if (file->text == NULL && scene_going(run))
    (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for data");
  file->length = file->text != NULL ? strlen(file->text) : 0;
}
