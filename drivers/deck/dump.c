/*
 * dump.c -- the resolved deck as a namelist for Fortran and for deck_read_set: every key in
 * use, reals as the shortest decimals that come back to the last bit.
 */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L /* uselocale */
#endif
#include "deck/table.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/text.h"

enum { LINE = 80 };

/* A list that is broken into lines. */
typedef struct writer {
  FILE *stream;
  int column;
  int first; /* nothing was written yet */
} writer;

static void put(writer *w, const char *text)
{
  const int n = (int)strlen(text);
  if (!w->first) w->column += fprintf(w->stream, ",") > 0;
  if (w->column + n + 2 > LINE && !w->first) {
    fprintf(w->stream, "\n   ");
    w->column = 3;
  }
  fprintf(w->stream, " %s", text);
  w->column += n + 1;
  w->first = 0;
}

static void put_real(writer *w, double x)
{
  char text[DECK_DECIMAL];
  put(w, deck_decimal(x, text));
}

static void put_integer(writer *w, int64_t n)
{
  char text[40];
  snprintf(text, sizeof text, "%lld", (long long)n);
  put(w, text);
}

static void put_string(writer *w, const char *s)
{
  char text[2 * DECK_PATH + 3];
  size_t n = 0;
  text[n++] = '\'';
  for (; *s != '\0' && n < sizeof text - 4; s++) {
    if (*s == '\'') text[n++] = '\'';
    text[n++] = *s;
  }
  text[n++] = '\'';
  text[n] = '\0';
  put(w, text);
}

static writer begin(FILE *stream, const char *name, const char *suffix)
{
  const int n = fprintf(stream, "  %s%s =", name, suffix);
  return (writer){ stream, n, 1 };
}

static void dump_axis(const deck_key *key, const deck_axis *axis, FILE *stream)
{
  if (axis->listed_count > 0) {
    writer w = begin(stream, key->name, "");
    for (size_t i = 0; i < axis->listed_count; i++) put_real(&w, axis->listed[i]);
    fprintf(stream, "\n");
  }
  if (axis->range_count > 0) {
    writer w = begin(stream, key->name, "_range");
    put_real(&w, axis->range_first);
    put_real(&w, axis->range_last);
    put_integer(&w, (int64_t)axis->range_count);
    fprintf(stream, "\n");
  }
}

static void dump_key(const deck_key *key, const deck *d, FILE *stream)
{
  const void *f = (const char *)d + key->offset;
  const deck_names *names = f;
  writer w = { 0 };
  if (key->type == DECK_SWEEP) {
    dump_axis(key, &d->axis[key->axis], stream);
    return;
  }
  const deck_numbers *numbers = f;
  if (key->type == DECK_CHOICES && names->count == 0) return;
  if (key->type == DECK_LIST && numbers->count == 0) return;
  w = begin(stream, key->name, "");
  switch (key->type) {
  case DECK_REAL:
    put_real(&w, *(const double *)f);
    break;
  case DECK_BOUNDS:
    put_real(&w, ((const double *)f)[0]);
    put_real(&w, ((const double *)f)[1]);
    break;
  case DECK_NUMBERS:
    for (size_t i = 0; i < key->size / sizeof(double); i++) put_real(&w, ((const double *)f)[i]);
    break;
  case DECK_LIST:
    for (size_t i = 0; i < numbers->count; i++) put_real(&w, numbers->number[i]);
    break;
  case DECK_INTEGER:
    put_integer(&w, *(const int64_t *)f);
    break;
  case DECK_LOGICAL:
    put(&w, *(const int *)f ? ".true." : ".false.");
    break;
  case DECK_CHOICES:
    for (size_t i = 0; i < names->count; i++) put_string(&w, names->name[i]);
    break;
  default:
    put_string(&w, key->offset == offsetof(deck, kind) ? deck_kind_name(d->kind) : f);
    break;
  }
  fprintf(stream, "\n");
}

/* A number that was not given and has no default. */
static int has_no_value(const deck_key *key, const deck *d)
{
  return key->type == DECK_REAL && isnan(*(const double *)((const char *)d + key->offset));
}

static void dump_groups(const deck *d, FILE *stream)
{
  const unsigned scene = 1u << d->kind;
  const char *group = NULL;
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if ((key->scenes & scene) == 0 || key->type == DECK_SWEEP_VALUE) continue;
    if (!deck_key_applies(key, d) || has_no_value(key, d) || deck_outer_is(d, key)) continue;
    if (group == NULL || strcmp(group, key->group) != 0) {
      if (group != NULL) fprintf(stream, "/\n");
      group = key->group;
      fprintf(stream, "&%s\n", group);
    }
    dump_key(key, d, stream);
  }
  if (group != NULL) fprintf(stream, "/\n");
}

pendres_status deck_dump(const deck *d, FILE *stream)
{
  /* Other locales write 0,2 for 0.2. */
  const locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  locale_t before = (locale_t)0;
  if (c == (locale_t)0) return PENDRES_OUT_OF_MEMORY;
  before = uselocale(c);
  deck shown = *d;
  if (d->outer.known && d->outer.coefficient > 0) /* it stands in &outer */
    shown.pendulum.force_coefficients[d->outer.coefficient - 1] = 0.0;
  dump_groups(&shown, stream);
  uselocale(before);
  freelocale(c);
  return ferror(stream) ? PENDRES_IO : PENDRES_OK;
}

pendres_status deck_resolved(const deck *d, char **out)
{
  text t;
  const int written = text_open(&t) && deck_dump(d, t.stream) == PENDRES_OK;
  *out = written ? text_close(&t) : NULL;
  if (!written) text_drop(&t);
  return *out != NULL ? PENDRES_OK : PENDRES_OUT_OF_MEMORY;
}
