/* hysteresis_names.c -- what the states along a path are called; see hysteresis_names.h. */
#include "analysis/sweeps/hysteresis_names.h"

#include <stdlib.h>

#include "engine/context_internal.h"
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

/* Note which of two parts with points at the same value has the smaller orbit, if both orbits
   are of one drive period. */
static void compare(const pendres_hysteresis *h, size_t i, size_t k, unsigned char *met)
{
  const pendres_attractor *a = &h->point[i].attractor, *b = &h->point[k].attractor;
  if (h->part[i] == h->part[k]) return;
  if (!pendres_settled_closed(a) || !pendres_settled_closed(b)) return;
  if (!pendres_label_named(&a->orbit) || !pendres_label_named(&b->orbit)) return;
  pendres_label_states states = {.count = 0};
  pendres_label_note(&states, &a->orbit);
  pendres_label_note(&states, &b->orbit);
  if (states.count < 2) return;
  const int less = a->orbit.amplitude < b->orbit.amplitude;
  met[h->part[i]] |= less ? SMALLER : LARGER;
  met[h->part[k]] |= less ? LARGER : SMALLER;
}

/* Compare all pairs of points with the same value; `places` has room for all points. */
static void compare_all(const pendres_hysteresis *h, place *places, unsigned char *met)
{
  for (size_t i = 0; i < h->count; i++) places[i] = (place){h->point[i].value, i};
  qsort(places, h->count, sizeof *places, by_value);
  for (size_t i = 0; i < h->count; i++)
    for (size_t k = i; k-- > 0 && places[k].value == places[i].value;)
      compare(h, places[i].point, places[k].point, met);
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

static pendres_label name_of(const pendres_attractor *a, unsigned met)
{
  const pendres_label_states alone = {.count = 0};
  if (!pendres_settled_closed(a)) return a->label;
  if (!pendres_label_named(&a->orbit)) return pendres_label_of(&alone, NULL, &a->orbit);
  if (met == SMALLER) return PENDRES_LABEL_SA;
  if (met == LARGER) return PENDRES_LABEL_LA;
  return pendres_label_of(&alone, NULL, &a->orbit);
}

pendres_status pendres_hysteresis_name(pendres_context *ctx, pendres_hysteresis *h)
{
  unsigned char *met = calloc(h->parts + 2, 1);
  place *places = malloc((h->count + 1) * sizeof *places);
  if (met == NULL || places == NULL) {
    free(met);
    free(places);
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for names");
  }
  compare_all(h, places, met);
  for (size_t i = 0; i < h->count; i++) {
    pendres_attractor *a = &h->point[i].attractor;
    a->label = name_of(a, met[h->part[i]]);
  }
  for (size_t k = 0; k < h->jumps; k++)
    name_jump(h, h->jump_from[k], h->jump_to[k], &h->jump[k]);
  free(met);
  free(places);
  return PENDRES_OK;
}
