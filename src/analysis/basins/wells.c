/* wells.c -- sums over the states that go to each well; see wells.h. */
#include "analysis/basins/wells.h"

#include <stdint.h>
#include <stdlib.h>

/* Where an entry is, or would be: there is always a free place. */
static size_t find(const pendres_basin_entry *place, size_t places, int attractor, long well)
{
  const uint64_t key = ((uint64_t)well << 16) + (uint64_t)attractor;
  size_t i = (size_t)((key * UINT64_C(0x9e3779b97f4a7c15)) >> 32) & (places - 1);
  while (place[i].well.states > 0 &&
         (place[i].well.attractor != attractor || place[i].well.well != well))
    i = (i + 1) & (places - 1);
  return i;
}

/* At most half of the places are taken. */
static pendres_status make_room(pendres_basin_tally *t)
{
  enum { FIRST = 64 };
  if (2 * (t->used + 1) <= t->places) return PENDRES_OK;
  const size_t places = t->places > 0 ? 2 * t->places : FIRST;
  pendres_basin_entry *place = calloc(places, sizeof *place);
  if (place == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < t->places; i++)
    if (t->place[i].well.states > 0)
      place[find(place, places, t->place[i].well.attractor, t->place[i].well.well)] = t->place[i];
  free(t->place);
  t->place = place;
  t->places = places;
  return PENDRES_OK;
}

pendres_basin_member *pendres_basin_tally_add(pendres_basin_tally *t, int attractor, long well,
                                              size_t states)
{
  if (make_room(t) != PENDRES_OK) return NULL;
  pendres_basin_entry *e = &t->place[find(t->place, t->places, attractor, well)];
  if (e->well.states == 0) {
    e->well = (pendres_basin_well){.attractor = attractor, .well = well};
    t->used++;
  }
  e->well.states += states;
  return &e->sums;
}

static int by_attractor(const void *a, const void *b)
{
  const pendres_basin_well *p = &((const pendres_basin_entry *)a)->well;
  const pendres_basin_well *q = &((const pendres_basin_entry *)b)->well;
  if (p->attractor != q->attractor) return p->attractor < q->attractor ? -1 : 1;
  return (p->well > q->well) - (p->well < q->well);
}

pendres_basin_entry *pendres_basin_tally_list(const pendres_basin_tally *t)
{
  size_t n = 0;
  pendres_basin_entry *out = malloc((t->used + 1) * sizeof *out);
  if (out == NULL) return NULL;
  for (size_t i = 0; i < t->places; i++)
    if (t->place[i].well.states > 0) out[n++] = t->place[i];
  if (n > 0) qsort(out, n, sizeof *out, by_attractor);
  return out;
}

void pendres_basin_tally_free(pendres_basin_tally *t)
{
  free(t->place);
  *t = (pendres_basin_tally){0};
}
