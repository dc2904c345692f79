/* hysteresis_names.c -- what the states along a path are called; see hysteresis_names.h. */
#include "analysis/sweeps/hysteresis_names.h"

#include <stdlib.h>

#include "engine/room.h"
#include "orbits/label.h"
#include "analysis/sweeps/hysteresis_jump.h"

enum { UNNAMED = 0, SMALLER = 1, LARGER = 2 };

/* A point of the path, to be sorted by its value. */
typedef struct place {
  double value;
  size_t point;
} place;

static int by_value(const void *a, const void *b)
{
  const place *p = a, *q = b;
  return (p->value > q->value) - (p->value < q->value);
}

/* What points of the path are met with at their values. */
typedef struct meeting {
  const pendres_hysteresis *h;
  size_t *state;        /* [parts + 2] the way to the first of the parts of one state */
  unsigned char *here;  /* [points] which of two states it is by what is met there, ... */
  unsigned char *along; /* ... [parts + 2] and anywhere, by the first of its parts */
} meeting;

/* The first of the parts that are of the same state as this one. */
static size_t first_of(const meeting *m, size_t part)
{
  while (m->state[part] != part) part = m->state[part];
  return part;
}

/* Note which of two orbits of one drive period at the same value is the smaller one, or that they
   are one state: a sweep comes to it by several ways, on a part each. */
static void compare(const meeting *m, size_t i, size_t k)
{
  const pendres_hysteresis *h = m->h;
  const pendres_attractor *a = &h->point[i].attractor, *b = &h->point[k].attractor;
  if (h->part[i] == h->part[k]) return;
  if (!pendres_attractor_closes(a) || !pendres_attractor_closes(b)) return;
  if (!pendres_label_named(&a->orbit) || !pendres_label_named(&b->orbit)) return;
  if (!a->orbit.stable || !b->orbit.stable) return;
  pendres_label_states states = {.count = 0};
  pendres_label_note(&states, &a->orbit);
  pendres_label_note(&states, &b->orbit);
  if (states.count < 2) {
    const size_t p = first_of(m, h->part[i]), q = first_of(m, h->part[k]);
    m->state[p > q ? p : q] = p > q ? q : p;
    return;
  }
  const int less = a->orbit.amplitude < b->orbit.amplitude;
  m->here[i] |= less ? SMALLER : LARGER;
  m->here[k] |= less ? LARGER : SMALLER;
}

/* Compare all pairs of points with the same value; `places` has room for all points. */
static void compare_all(const meeting *m, place *places)
{
  const pendres_hysteresis *h = m->h;
  for (size_t i = 0; i < h->count; i++) places[i] = (place){h->point[i].value, i};
  for (size_t i = 0; i < h->parts + 2; i++) m->state[i] = i;
  qsort(places, h->count, sizeof *places, by_value);
  for (size_t i = 0; i < h->count; i++)
    for (size_t k = i; k-- > 0 && places[k].value == places[i].value;)
      compare(m, places[i].point, places[k].point);
  for (size_t i = 0; i < h->count; i++) m->along[first_of(m, h->part[i])] |= m->here[i];
}

/* Give a jump the names of the parts that it comes from and leads to. */
static void name_jump(const pendres_hysteresis *h, size_t from, size_t to, pendres_jump *jump)
{
  const size_t step = jump->step;
  for (size_t i = step < h->count ? step : h->count; i-- > 0;)
    if (h->part[i] == from) {
      jump->from = h->point[i].attractor.label;
      break;
    }
  if (step < h->count && h->part[step] == to) jump->to = h->point[step].attractor.label;
}

/* By what a point is met with, at its own value or else where its state is met at others: the way
   in which the path came to it does not matter. Of more than two the smallest is SA. */
static pendres_label name_of(const meeting *m, size_t i)
{
  const pendres_attractor *a = &m->h->point[i].attractor;
  const pendres_label_states alone = {.count = 0};
  const unsigned here = m->here[i], along = m->along[first_of(m, m->h->part[i])];
  if (!pendres_attractor_closes(a)) return a->label;
  if (!pendres_label_named(&a->orbit)) return pendres_label_of(&alone, NULL, &a->orbit);
  if (here != UNNAMED) return here == SMALLER ? PENDRES_LABEL_SA : PENDRES_LABEL_LA;
  if (along == SMALLER) return PENDRES_LABEL_SA;
  if (along == LARGER) return PENDRES_LABEL_LA;
  return pendres_label_of(&alone, NULL, &a->orbit);
}

pendres_status pendres_hysteresis_name(pendres_context *ctx, pendres_hysteresis *h)
{
  pendres_room room = pendres_room_open(ctx, "names");
  place *places = pendres_room_take(&room, h->count, sizeof *places);
  const meeting m = {h, pendres_room_take(&room, h->parts + 2, sizeof *m.state),
                     pendres_room_take(&room, h->count, 1),
                     pendres_room_take(&room, h->parts + 2, 1)};
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  compare_all(&m, places);
  for (size_t i = 0; i < h->count; i++) h->point[i].attractor.label = name_of(&m, i);
  for (size_t k = 0; k < h->jumps; k++)
    name_jump(h, h->jump_from[k], h->jump_to[k], &h->jump[k]);
  return pendres_room_close(&room, PENDRES_OK);
}
