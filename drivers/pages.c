/*
 * pages.c -- subjects of the pages of docs/, for readers of --explain; see pages.h.
 *
 * The build makes the lines by pages.awk: '@' is a page, '#' a heading, 'H' the head of a table,
 * 'R' a row of it, whose cells end at a bar, 'P' a paragraph.
 */
#define _POSIX_C_SOURCE 200809L /* strcasecmp */
#include "pages.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

#include "deck/deck.h"

static const char *const lines[] = {
  "@", /* there may be no pages */
#include "pages.inc"
};

enum { LINES = sizeof lines / sizeof *lines, MOST_CELLS = 8, CELL = 1200, MOST_ROWS = 12,
       MOST_SECTIONS = 12 };

/* Where one is in the pages. */
typedef struct place {
  const char *page, *heading, *head;
} place;

static void pass(place *at, const char *line)
{
  if (line[0] == '@') *at = (place){line + 1, "", NULL};
  else if (line[0] == '#') at->heading = line + 1;
  else if (line[0] == 'H') at->head = line + 1;
}

/* Copy cell number k of a row, without blanks around it; 0: there is none. */
static int cell_of(const char *row, int k, char out[CELL])
{
  for (; k > 0 && row != NULL; k--) {
    row = strchr(row, '|');
    if (row != NULL) row++;
  }
  if (row == NULL || *row == '\0') return 0;
  row += strspn(row, " ");
  size_t n = strcspn(row, "|");
  while (n > 0 && row[n - 1] == ' ') n--;
  snprintf(out, CELL, "%.*s", (int)n, row);
  return 1;
}

static int same_letter(char a, char b)
{
  return tolower((unsigned char)a) == tolower((unsigned char)b);
}

/* Whether a text has the word, or its plural, and what stands behind it; NULL: it has not. */
static const char *find(const char *text, const char *word)
{
  const size_t n = strlen(word);
  if (n == 0 || !isalnum((unsigned char)word[0])) return NULL;
  for (const char *at = text; *at != '\0'; at++) {
    size_t i = 0;
    if (at > text && (isalnum((unsigned char)at[-1]) || at[-1] == '_')) continue;
    while (i < n && same_letter(at[i], word[i])) i++;
    if (i < n) continue;
    const char *end = at + n;
    if (*end == 's' || *end == 'S') end++;
    if (!isalnum((unsigned char)*end)) return end;
  }
  return NULL;
}

/* A row with what its columns are called. */
static void write_row(FILE *out, const place *at, const char *row)
{
  char cell[CELL], name[CELL], text[2 * CELL + 8];
  (void)cell_of(row, 0, cell);
  deck_write_wrapped(out, "", cell);
  for (int k = 1; k < MOST_CELLS && cell_of(row, k, cell); k++) {
    if (cell[0] == '\0') continue;
    if (at->head == NULL || !cell_of(at->head, k, name)) name[0] = '\0';
    snprintf(text, sizeof text, "%s%s%s", name, name[0] != '\0' ? ": " : "", cell);
    deck_write_wrapped(out, "    ", text);
  }
}

/* Whether a word is a name, or one of several with commas between them. */
static int is_one_of(const char *names, const char *word)
{
  const size_t n = strlen(word);
  for (const char *at = names; at != NULL; at = strchr(at, ',')) {
    at += strspn(at, ", ");
    if (strncasecmp(at, word, n) == 0 && (at[n] == '\0' || at[n] == ',')) return n > 0;
  }
  return 0;
}

/* Rows that have the word among their names, or else, unless exact, in one. Returns how many, from
   `found` on. */
static int tell_named(const char *word, int named, int exact, int found, FILE *out)
{
  char name[CELL];
  place at = {"", "", NULL}, told = at;
  for (int i = 0; i < LINES && found < MOST_ROWS; i++) {
    pass(&at, lines[i]);
    if (lines[i][0] != 'R' || !cell_of(lines[i] + 1, 0, name)) continue;
    const char *behind = find(name, word);
    const int is_named = is_one_of(name, word), has = behind != NULL && *behind != '_';
    if (is_named != named || (!named && !has)) continue;
    if (found == 0 && exact) fputs("\n", out);
    if (told.page != at.page || told.heading != at.heading)
      fprintf(out, "%s%s, %s:\n", found > 0 ? "\n" : "", at.page, at.heading);
    found++;
    told = at;
    write_row(out, &at, lines[i] + 1);
  }
  return found;
}

/* Rows that are named so; names, or lists of these, that only begin with the word come behind. */
static int tell_rows(const char *word, int exact, FILE *out)
{
  char name[CELL], last[CELL] = "";
  int found = tell_named(word, 1, exact, 0, out), more = 0;
  if (!exact) found = tell_named(word, 0, exact, found, out);
  for (int i = 0; i < LINES && !exact; i++) {
    if (lines[i][0] != 'R' || !cell_of(lines[i] + 1, 0, name)) continue;
    const char *behind = find(name, word);
    const int words = strchr(name, ' ') != NULL && strchr(name, ',') == NULL;
    const int is_name = behind != NULL && *behind == '_' && !words;
    if (!is_name || strcmp(name, last) == 0) continue;
    snprintf(last, sizeof last, "%s", name);
    fprintf(out, "%s%s", more > 0 ? ", " : found > 0 ? "\nalso: " : "there are: ", name);
    more++;
  }
  if (more > 0) fputs("\n", out);
  return found + more;
}

/* The sections that have the word in their headings, and then the others that have it. */
static int tell_sections(const char *word, int before, FILE *out)
{
  int found = 0;
  for (int titled = 1; titled >= 0; titled--) {
    place at = {"", "", NULL};
    const char *told = NULL;
    for (int i = 0; i < LINES && found <= MOST_SECTIONS; i++) {
      pass(&at, lines[i]);
      if (at.heading == told || (find(at.heading, word) != NULL) != titled) continue;
      if (!titled && (lines[i][0] == '@' || find(lines[i] + 1, word) == NULL)) continue;
      told = at.heading;
      if (found++ == 0) fprintf(out, "%sread about it:\n", before > 0 ? "\n" : "");
      if (found <= MOST_SECTIONS) fprintf(out, "  %s, %s\n", at.page, at.heading);
    }
  }
  if (found > MOST_SECTIONS) fprintf(out, "  and elsewhere\n");
  return found;
}

int pages_tell(const char *word, int exact, FILE *out)
{
  const int found = tell_rows(word, exact, out);
  return exact ? found : found + tell_sections(word, found, out);
}
