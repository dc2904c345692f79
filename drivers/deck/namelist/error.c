/*
 * error.c -- the list of errors of a deck and how one error looks:
 *
 *   f02.nml:3:11: error: 'dampng' is not a key of &pendulum (did you mean 'damping'?)
 *     dampng = 0.24
 *     ^~~~~~
 */
#include "deck/namelist/namelist.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "terminal/safe_text.h"
#include "system/grow.h"
#include "system/text.h"

/* What is shown of a long source line, and how much of it stands before the caret. */
enum { WINDOW = 100, BEFORE = 60, MESSAGE = 600 };

/* The source line and the caret below it. Tabs stay tabs in both, so that they line up. */
static void write_source(FILE *out, const namelist *nl, namelist_place where)
{
  const char *text = nl->text + nl->line[where.line - 1];
  size_t left = 0;
  const int column = where.column, first = column > WINDOW ? column - BEFORE : 1;
  int at = 1, shown = 0;
  char pad[WINDOW + 1];
  int pads = 0;

  while (text[left] != '\0' && text[left] != '\n') left++;
  while (left > 0 && (text[left - 1] == '\r' || text[left - 1] == ' ')) left--;
  fprintf(out, "\n  %s", first > 1 ? "..." : "");
  while (left > 0 && shown < WINDOW) {
    int safe;
    const size_t size = safe_text_character(text, left, &safe);
    if (at >= first) {
      const int tab = *text == '\t';
      if (safe || tab) fwrite(text, 1, size, out);
      else fputc('?', out);
      if (at < column) pad[pads++] = tab ? '\t' : ' ';
      shown++;
    }
    text += size;
    left -= size;
    at++;
  }
  if (left > 0) fputs("...", out);
  while (at < column && pads < WINDOW) {
    pad[pads++] = ' ';
    at++;
  }
  pad[pads] = '\0';
  fprintf(out, "\n  %s%s^", first > 1 ? "   " : "", pad);
  for (int i = 1; i < where.width && i + pads < WINDOW; i++) fputc('~', out);
}

static char *format_error(const namelist *nl, namelist_place at, const char *message)
{
  text t;
  const char *name = nl->name != NULL ? nl->name : "deck";
  (void)text_open(&t);
  FILE *out = t.stream;
  if (out == NULL) return NULL;
  /* The deck's own words are in the message, and the name may be anything. */
  safe_text_write(out, name);
  if (at.line < 1) fputs(": error: ", out);
  else fprintf(out, ":%d:%d: error: ", at.line, at.column);
  safe_text_write(out, message);
  if (at.line >= 1 && at.line <= nl->lines) write_source(out, nl, at);
  return text_close(&t);
}

const namelist_place namelist_whole = { 0, 0, 0 };

void namelist_error_at(const namelist *nl, namelist_place at, namelist_errors *errors,
                       const char *format, ...)
{
  char message[MESSAGE];
  char *text = NULL;
  va_list arguments;

  if (errors->count >= NAMELIST_MAX_ERRORS) {
    errors->dropped++;
    return;
  }
  va_start(arguments, format);
  const int written = vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  if (written < 0) snprintf(message, sizeof message, "(a message that cannot be shown)");
  text = format_error(nl, at, message);
  if (text == NULL || !grow_to(&errors->item, errors->count + 1, &errors->capacity,
                               sizeof *errors->item)) {
    free(text);
    errors->out_of_memory = 1;
    return;
  }
  errors->item[errors->count++] = (namelist_error){ nl->order, at, text };
}

/* Does a stand behind b? */
static int is_later(const namelist_error *a, const namelist_error *b)
{
  if (a->order != b->order) return a->order > b->order;
  if (a->at.line != b->at.line) return a->at.line > b->at.line;
  return a->at.column > b->at.column;
}

void namelist_errors_sort(namelist_errors *errors)
{
  /* Insertion keeps the order of errors at one position; the list is short. */
  for (size_t i = 1; i < errors->count; i++) {
    const namelist_error e = errors->item[i];
    size_t j = i;
    for (; j > 0 && is_later(&errors->item[j - 1], &e); j--) errors->item[j] = errors->item[j - 1];
    errors->item[j] = e;
  }
}

void namelist_errors_print(const namelist_errors *errors, FILE *stream)
{
  for (size_t i = 0; i < errors->count; i++) fprintf(stream, "%s\n", errors->item[i].text);
  if (errors->dropped > 0) fprintf(stream, "... and %zu more errors\n", errors->dropped);
  if (errors->out_of_memory) fprintf(stream, "error: out of memory while reading the deck\n");
}

void namelist_errors_free(namelist_errors *errors)
{
  if (errors == NULL) return;
  for (size_t i = 0; i < errors->count; i++) free(errors->item[i].text);
  free(errors->item);
  *errors = (namelist_errors){ 0 };
}
