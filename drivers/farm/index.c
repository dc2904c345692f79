/* index.c -- where the records of a journal's files are; see index.h. */
#define _XOPEN_SOURCE 700 /* tsearch */
#include "farm/index.h"

#include <search.h>
#include <stdlib.h>

static int compare(const void *one, const void *other)
{
  const journal_slot *a = one, *b = other;
  if (a->stage != b->stage) return a->stage < b->stage ? -1 : 1;
  return (a->task > b->task) - (a->task < b->task);
}

static int is_state(uint64_t task)
{
  return (task & JOURNAL_STATE) != 0;
}

journal_slot *index_find(const journal_index *x, uint64_t stage, uint64_t task)
{
  const journal_slot wanted = { .stage = stage, .task = task };
  journal_slot *const *found = tfind(&wanted, &x->tree, compare);
  return found != NULL ? *found : NULL;
}

/* What a slot held counts no more. */
static void outdate(journal_index *x, const journal_slot *s)
{
  if (!is_state(s->task) || s->file != 0) return;
  x->states--;
  x->dead += s->length;
}

static void drop(journal_index *x, journal_slot *s)
{
  if (s == NULL) return;
  outdate(x, s);
  (void)tdelete(s, &x->tree, compare);
  free(s);
}

int index_note(journal_index *x, size_t file, const journal_entry *e, off_t at)
{
  journal_slot *s = malloc(sizeof *s);
  if (s == NULL) return 0;
  *s = (journal_slot){ e->stage, e->task, file, at, (off_t)(sizeof *e + e->stored) };
  journal_slot **found = tsearch(s, &x->tree, compare);
  if (found == NULL) {
    free(s);
    return 0;
  }
  if (*found == s) x->count += !is_state(e->task);
  else {
    outdate(x, *found);
    **found = *s;
    free(s);
  }
  x->states += is_state(e->task) && file == 0;
  if (!is_state(e->task)) drop(x, index_find(x, e->stage, e->task | JOURNAL_STATE));
  return 1;
}

void index_free(journal_index *x)
{
  while (x->tree != NULL) {
    journal_slot *s = *(journal_slot **)x->tree; /* of the root */
    (void)tdelete(s, &x->tree, compare);
    free(s);
  }
}
