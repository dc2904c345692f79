/* basin_wells.c -- how many states go to each well; see basin_wells.h. */
#include "questions/basin_wells.h"

#include <stdint.h>
#include <stdlib.h>

/* Where an entry is, or would be: there is always a free place. */
static size_t find(const pendres_basin_well *place, size_t places, int attractor, long well)
{
  const uint64_t key = ((uint64_t)well << 16) + (uint64_t)attractor;
  size_t i = (size_t)((key * UINT64_C(0x9e3779b97f4a7c15)) >> 32) & (places - 1);
  while (place[i].states > 0 && (place[i].attractor != attractor || place[i].well != well))
    i = (i + 1) & (places - 1);
  return i;
}

/* At most half of the places are taken. */
static pendres_status make_room(pendres_basin_tally *t)
{
  enum { FIRST = 64 };
  if (2 * (t->used + 1) <= t->places) return PENDRES_OK;
  const size_t places = t->places > 0 ? 2 * t->places : FIRST;
  pendres_basin_well *place = calloc(places, sizeof *place);
  if (place == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < t->places; i++)
    if (t->place[i].states > 0)
      place[find(place, places, t->place[i].attractor, t->place[i].well)] = t->place[i];
  free(t->place);
  t->place = place;
  t->places = places;
  return PENDRES_OK;
}

pendres_status pendres_basin_tally_add(pendres_basin_tally *t, int attractor, long well,
                                       size_t states)
{
  const pendres_status status = make_room(t);
  if (status != PENDRES_OK) return status;
  const size_t i = find(t->place, t->places, attractor, well);
  if (t->place[i].states == 0) {
    t->place[i] = (pendres_basin_well){.attractor = attractor, .well = well};
    t->used++;
  }
  t->place[i].states += states;
  return PENDRES_OK;
}

static int by_attractor(const void *a, const void *b)
{
  const pendres_basin_well *p = a, *q = b;
  if (p->attractor != q->attractor) return p->attractor < q->attractor ? -1 : 1;
  return (p->well > q->well) - (p->well < q->well);
}

void pendres_basin_tally_list(const pendres_basin_tally *t, pendres_basin_well *out)
{
  size_t n = 0;
  for (size_t i = 0; i < t->places; i++)
    if (t->place[i].states > 0) out[n++] = t->place[i];
  if (n > 0) qsort(out, n, sizeof *out, by_attractor);
}

void pendres_basin_tally_free(pendres_basin_tally *t)
{
  free(t->place);
  *t = (pendres_basin_tally){0};
}
