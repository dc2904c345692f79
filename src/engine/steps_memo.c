/* steps_memo.c -- the steps that were chosen for cells of a lattice; see steps_memo.h. */
#include "engine/steps_memo.h"

#include <stdlib.h>

#include "base/grow.h"

typedef struct entry {
  pendres_steps_cell cell;
  int steps;
} entry;

struct pendres_steps_memo {
  entry *entries;
  size_t used, size;
};

pendres_status pendres_steps_memo_create(pendres_steps_memo **out)
{
  *out = calloc(1, sizeof **out);
  return *out != NULL ? PENDRES_OK : PENDRES_OUT_OF_MEMORY;
}

void pendres_steps_memo_free(pendres_steps_memo *memo)
{
  if (memo == NULL) return;
  free(memo->entries);
  free(memo);
}

static int same(const pendres_steps_cell *a, const pendres_steps_cell *b)
{
  int equal = a->damping == b->damping && a->frequency == b->frequency && a->drive == b->drive &&
              a->speed == b->speed && a->tolerance == b->tolerance && a->torque == b->torque &&
              a->parametric == b->parametric && a->force == b->force;
  for (int i = 0; i < PENDRES_FORCE_COEFFICIENTS && equal; i++)
    equal = a->coefficients[i] == b->coefficients[i];
  return equal;
}

int pendres_steps_memo_find(const pendres_steps_memo *memo, const pendres_steps_cell *cell)
{
  /* The latest cells first: neighbours in a list of pendulums share a cell. */
  for (size_t i = memo->used; i-- > 0;)
    if (same(&memo->entries[i].cell, cell)) return memo->entries[i].steps;
  return 0;
}

pendres_status pendres_steps_memo_add(pendres_steps_memo *memo, const pendres_steps_cell *cell,
                                      int steps)
{
  entry *entries = pendres_grow(memo->entries, memo->used, &memo->size, sizeof *entries);
  if (entries == NULL) return PENDRES_OUT_OF_MEMORY;
  memo->entries = entries;
  memo->entries[memo->used++] = (entry){.cell = *cell, .steps = steps};
  return PENDRES_OK;
}
