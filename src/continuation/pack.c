/*
 * pack.c -- sets of branches and curves as plain bytes and back; see sets.h.
 *
 * The bytes are a head, then of each curve a head and its arrays as they stand in memory.
 */
#include "continuation/numbers.h"
#include "continuation/sets.h"

#include <stdlib.h>
#include <string.h>

/* The head before the arrays: equal curves have equal bytes, padding included. */
static pendres_curve head_of(const pendres_curve *c)
{
  pendres_curve h;
  memset(&h, 0, sizeof h);
  h.kind.system.map = c->kind.system.map;
  h.kind.system.condition = c->kind.system.condition;
  h.kind.system.unknowns = c->kind.system.unknowns;
  memcpy(h.kind.system.unknown, c->kind.system.unknown, sizeof h.kind.system.unknown);
  for (int k = 0; k < 2; k++) h.end[k] = c->end[k];
  h.start = c->start;
  h.count = c->count;
  h.specials = c->specials;
  return h;
}

/* ---- whether bytes can be what they seem: they may come from elsewhere ---- */

static int orbit_fits(const pendres_orbit *o)
{
  return pendres_model_of(o->pendulum.force) != NULL && o->period >= 1 &&
         o->period <= ORBIT_LONGEST_PERIOD;
}

static int map_fits(const pendres_map *m)
{
  return pendres_model_of(m->force) != NULL && (unsigned)m->mirror <= PENDRES_MIRROR_WHOLE &&
         m->period >= 1 && m->period <= ORBIT_LONGEST_PERIOD;
}

static int ends_fit(const pendres_branch_end end[2])
{
  return (unsigned)end[0] < PENDRES_END_COUNT && (unsigned)end[1] < PENDRES_END_COUNT;
}

static int head_fits(const pendres_curve *c)
{
  const pendres_system *s = &c->kind.system;
  int good = map_fits(&s->map) && ends_fit(c->end) &&
             (unsigned)s->condition < PENDRES_CONDITION_LAG && /* which has no public curves */
             s->unknowns == (pendres_curve_is_branch(c) ? 3 : 4);
  for (int k = 2; k < s->unknowns && good; k++)
    good = s->unknown[k] >= PENDRES_U_OMEGA && s->unknown[k] < PENDRES_U_COUNT;
  return good;
}

static int branch_fits(const pendres_curve *b)
{
  int good = 1;
  for (size_t i = 0; i < b->count && good; i++) {
    const pendres_branch_point *p = &b->branch_point[i];
    good = (unsigned)p->kind < PENDRES_SPECIAL_COUNT && orbit_fits(&p->orbit) &&
           (p->kind == PENDRES_REGULAR
              ? p->bifurcation == -1
              : p->bifurcation >= 0 && (size_t)p->bifurcation < b->specials);
  }
  for (size_t i = 0; i < b->specials && good; i++)
    good = (unsigned)b->bifurcation[i].kind < PENDRES_SPECIAL_COUNT &&
           (unsigned)b->bifurcation[i].parameter < PENDRES_PARAMETER_FOLLOWED &&
           orbit_fits(&b->bifurcation[i].orbit);
  return good;
}

static int curve_fits(const pendres_curve *c)
{
  int good = 1;
  for (size_t i = 0; i < c->count && good; i++)
    good = orbit_fits(&c->point[i].orbit) && c->point[i].cusp >= -1 &&
           (c->point[i].cusp < 0 || (size_t)c->point[i].cusp < c->specials);
  for (size_t i = 0; i < c->specials && good; i++)
    good = orbit_fits(&c->cusp[i].orbit) &&
           (unsigned)c->cusp[i].parameter[0] < PENDRES_PARAMETER_FOLLOWED &&
           (unsigned)c->cusp[i].parameter[1] < PENDRES_PARAMETER_FOLLOWED;
  return good;
}

static void pass_curve(pendres_bytes *b, int branch, pendres_curve *c)
{
  pendres_curve h = head_of(c);
  pendres_bytes_pass(b, 1, sizeof h, &h);
  if (!pendres_bytes_fit(b, head_fits(&h) && pendres_curve_is_branch(&h) == branch)) return;
  if (b->reads) *c = head_of(&h);
  if (branch) {
    pendres_bytes_pass_array(b, h.count, sizeof *c->branch_point, &c->branch_point);
    pendres_bytes_pass_array(b, h.specials, sizeof *c->bifurcation, &c->bifurcation);
  } else {
    pendres_bytes_pass_array(b, h.count, sizeof *c->point, &c->point);
    pendres_bytes_pass_array(b, h.specials, sizeof *c->cusp, &c->cusp);
    pendres_bytes_pass_array(b, h.count, sizeof *c->u, &c->u);
  }
  (void)(b->status == PENDRES_OK && pendres_bytes_fit(b, branch ? branch_fits(c) : curve_fits(c)));
}

/* Read the curves of a set. */
static void read_set(pendres_bytes *b, int branches, size_t n, pendres_curves *set)
{
  set->curve = calloc(n + 1, sizeof(pendres_curve *));
  if (set->curve == NULL) b->status = PENDRES_OUT_OF_MEMORY;
  for (set->capacity = n; set->count < n && b->status == PENDRES_OK; set->count++) {
    pendres_curve *c = calloc(1, sizeof(pendres_branch));
    set->curve[set->count] = c;
    if (c != NULL) pass_curve(b, branches, c);
    else b->status = PENDRES_OUT_OF_MEMORY;
  }
}

void pendres_curves_pass(pendres_bytes *b, int branches, pendres_curves **set)
{
  const pendres_curves none = {.count = 0};
  const pendres_curves *from = b->reads || *set == NULL ? &none : *set;
  size_t head[2] = {from->count, from->skipped};
  pendres_bytes_pass(b, 2, sizeof *head, head);
  for (size_t i = 0; i < from->count; i++) pass_curve(b, branches, from->curve[i]);
  if (!b->reads) return;
  *set = NULL;
  if (!pendres_bytes_fit(b, head[0] <= (b->size - b->at) / sizeof(pendres_curve))) return;
  *set = pendres_curves_create();
  if (*set == NULL) b->status = PENDRES_OUT_OF_MEMORY;
  else read_set(b, branches, head[0], *set);
  if (*set != NULL) (*set)->skipped = head[1];
}
