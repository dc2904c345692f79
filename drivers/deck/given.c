/* given.c -- what a deck gives of a key, and complaints about it; see table.h. */
#include "deck/table.h"

#include <stdarg.h>
#include <string.h>

/* Where a key was given, or another one in its place, whose name is underlined. */
namelist_place deck_place_of(const deck_given *given, const char *name)
{
  return (namelist_place){ given->at.line, given->at.column, (int)strlen(name) };
}

/* Of the whole deck: where its kind is given. */
namelist_place deck_place_of_kind(const deck_builder *b)
{
  return (namelist_place){ b->kind_at.line, b->kind_at.column, 1 };
}

void deck_complain(deck_builder *b, const deck_given *at, const char *name, const char *format, ...)
{
  char message[500];
  va_list args;
  va_start(args, format);
  (void)vsnprintf(message, sizeof message, format, args);
  va_end(args);
  const namelist *nl = at->nl != NULL ? at->nl : b->nl;
  namelist_error_at(nl, deck_place_of(at, name), b->errors, "%s", message);
}

void deck_complain_of_group(deck_builder *b, const namelist_group *g, const char *message)
{
  if (g != NULL)
    namelist_error_at(b->nl, g->at, b->errors, "%s", message);
  else
    namelist_error_at(b->kind_nl, deck_place_of_kind(b), b->errors, "%s", message);
}

const deck_given *deck_given_of(const deck_builder *b, const char *group, const char *name)
{
  static const deck_given absent = { 0 };
  int range = 0;
  const size_t row = deck_table_find(group, name, b->scene, &range);
  return row < deck_table_size ? &b->given[row] : &absent;
}

int deck_is_there(const deck_given *g)
{
  return g->at.line > 0 && (g->given || g->broken);
}

int deck_in_scene(const deck_builder *b, const char *group, const char *name)
{
  int range = 0;
  return deck_table_find(group, name, b->scene, &range) < deck_table_size;
}
