/* attractor_set_order.c -- one order of attractors, whatever that of discovery; see
   attractor_set.h. */
#include "orbits/attractor_set.h"

#include <math.h>
#include <stdlib.h>

enum { KEYS = 3 };

/* An attractor on its way to its place. Attractors of one group agree in all earlier keys. */
typedef struct placed {
  int group;
  double key;
  int number; /* the old one */
} placed;

static int by_group_and_key(const void *a, const void *b)
{
  const placed *p = a, *q = b;
  if (p->group != q->group) return p->group < q->group ? -1 : 1;
  return (p->key > q->key) - (p->key < q->key);
}

static const pendres_cover *cover_of(const pendres_attractor_set *c, int attractor)
{
  for (size_t i = 0; i < c->covers; i++)
    if (c->cover[i]->attractor == attractor) return c->cover[i];
  return NULL;
}

/*
 * An attractor's key number k, and *same: how far apart two such keys may be by rounding alone. The
 * amplitudes of mirror images, for one, differ by rounding, which must not decide their order.
 */
static double key_of(const pendres_attractor_set *c, int attractor, int k, double *same)
{
  static const double rounding[KEYS] = {1e-7, 1e-6, 0.0};
  const pendres_attractor *a = &c->attractors[attractor];
  const pendres_cover *cover = cover_of(c, attractor);
  const double orbit[KEYS] = {a->orbit.amplitude, a->orbit.x, a->orbit.v};
  const double chaos[KEYS] = {cover != NULL ? cover->mean_w : 0.0,
                              cover != NULL ? cover->mean_y : 0.0, a->lyapunov};
  const double key = cover != NULL ? chaos[k] : orbit[k];
  *same = cover != NULL ? 0.0 : rounding[k];
  return isnan(key) ? INFINITY : key; /* last, and not in everybody's way */
}

/* Give a group of their own to attractors that are further from their neighbour than rounding. */
static void part(const pendres_attractor_set *c, placed *p, int k)
{
  int group = 0, before = 0; /* the new group, and the old one of the attractor before */
  for (size_t i = 0; i < c->count; i++) {
    const int old = p[i].group;
    double same;
    (void)key_of(c, p[i].number, k, &same);
    if (i > 0 && (old != before || p[i].key - p[i - 1].key > same)) group++;
    before = old;
    p[i].group = group;
  }
}

int pendres_attractor_set_sort(const pendres_attractor_set *c, int *order)
{
  double same;
  placed *p = malloc((c->count + 1) * sizeof *p);
  if (p == NULL) return -1;
  for (size_t i = 0; i < c->count; i++)
    p[i] = (placed){.group = cover_of(c, (int)i) != NULL, .number = (int)i};
  for (int k = 0; k < KEYS; k++) {
    for (size_t i = 0; i < c->count; i++) p[i].key = key_of(c, p[i].number, k, &same);
    qsort(p, c->count, sizeof *p, by_group_and_key);
    part(c, p, k);
  }
  for (size_t i = 0; i < c->count; i++) order[i] = p[i].number;
  free(p);
  return 0;
}
