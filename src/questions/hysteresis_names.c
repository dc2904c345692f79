/* hysteresis_names.c -- what the states along a path are called; see hysteresis_names.h. */
#include "questions/hysteresis_names.h"

#include <stdlib.h>

#include "engine/context_internal.h"
#include "orbits/label.h"
#include "questions/hysteresis_jump.h"

enum { UNNAMED = 0, SMALLER = 1, LARGER = 2 };

/* Stretches on which there are orbits of one drive period, by what they meet at the same values. */
static void compare(const pendres_hysteresis *h, unsigned char *met)
{
  for (size_t i = 0; i < h->count; i++)
    for (size_t k = 0; k < i; k++) {
      const pendres_attractor *a = &h->point[i].attractor, *b = &h->point[k].attractor;
      if (h->point[i].value != h->point[k].value || h->stretch[i] == h->stretch[k]) continue;
      if (!pendres_settled_closed(a) || !pendres_settled_closed(b)) continue;
      if (!pendres_label_named(&a->orbit) || !pendres_label_named(&b->orbit)) continue;
      pendres_label_states states = {.count = 0};
      pendres_label_note(&states, &a->orbit);
      pendres_label_note(&states, &b->orbit);
      if (states.count < 2) continue;
      const int less = a->orbit.amplitude < b->orbit.amplitude;
      met[h->stretch[i]] |= less ? SMALLER : LARGER;
      met[h->stretch[k]] |= less ? LARGER : SMALLER;
    }
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
  unsigned char *met = calloc(h->stretches + 2, 1);
  if (met == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for names");
  compare(h, met);
  for (size_t i = 0; i < h->count; i++) {
    pendres_attractor *a = &h->point[i].attractor;
    a->label = name_of(a, met[h->stretch[i]]);
  }
  /* A jump comes from and leads to what its stretches are called. */
  for (size_t k = 0; k < h->jumps; k++)
    for (size_t i = 0; i < h->count; i++) {
      if (h->stretch[i] == h->jump_from[k] && i < h->jump[k].step)
        h->jump[k].from = h->point[i].attractor.label;
      if (h->stretch[i] == h->jump_to[k] && i == h->jump[k].step)
        h->jump[k].to = h->point[i].attractor.label;
    }
  free(met);
  return PENDRES_OK;
}
