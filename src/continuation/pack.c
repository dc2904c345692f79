/*
 * pack.c -- branches and curves as plain bytes and back; see continuation.h and sets.h.
 *
 * The bytes are a head, then of each curve a head and its arrays as they stand in memory.
 */
#include "continuation/sets.h"

#include <stdlib.h>
#include <string.h>

typedef struct set_head {
  size_t count, skipped;
} set_head;

enum { ARRAYS = 5 };

/* The arrays of a curve: an element's size and how many there are. */
static void arrays_of(const pendres_curve *c, size_t size[ARRAYS], size_t count[ARRAYS])
{
  const int branch = pendres_curve_is_branch(c);
  const size_t sizes[ARRAYS] = {sizeof *c->branch_point, sizeof *c->bifurcation,
                                sizeof *c->point, sizeof *c->cusp, sizeof *c->u};
  const size_t counts[ARRAYS] = {branch ? c->count : 0, branch ? c->specials : 0,
                                 branch ? 0 : c->count, branch ? 0 : c->specials,
                                 branch ? 0 : c->count};
  memcpy(size, sizes, sizeof sizes);
  memcpy(count, counts, sizeof counts);
}

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

size_t pendres_curves_packed_size(const pendres_curves *set)
{
  size_t bytes = sizeof(set_head);
  for (size_t i = 0; set != NULL && i < set->count; i++) {
    size_t size[ARRAYS], count[ARRAYS];
    arrays_of(set->curve[i], size, count);
    bytes += sizeof(pendres_curve);
    for (int k = 0; k < ARRAYS; k++) bytes += size[k] * count[k];
  }
  return bytes;
}

static char *put(char *to, const void *from, size_t size)
{
  if (size > 0) memcpy(to, from, size);
  return to + size;
}

void pendres_curves_pack(const pendres_curves *set, void *bytes)
{
  set_head head = {0, 0};
  if (set != NULL) head = (set_head){set->count, set->skipped};
  char *to = put(bytes, &head, sizeof head);
  for (size_t i = 0; i < head.count; i++) {
    const pendres_curve *c = set->curve[i], h = head_of(c);
    const void *const array[ARRAYS] = {c->branch_point, c->bifurcation, c->point, c->cusp, c->u};
    size_t size[ARRAYS], count[ARRAYS];
    arrays_of(c, size, count);
    to = put(to, &h, sizeof h);
    for (int k = 0; k < ARRAYS; k++) to = put(to, array[k], size[k] * count[k]);
  }
}

/* Bytes that are still to be read. */
typedef struct source {
  const char *at;
  size_t left;
} source;

static int get(source *s, void *to, size_t size)
{
  if (size > s->left) return 0;
  if (size > 0) memcpy(to, s->at, size);
  s->at += size;
  s->left -= size;
  return 1;
}

/* Read an array of n elements; NULL and a *status if there are fewer, or no memory. */
static void *get_array(source *s, size_t n, size_t size, pendres_status *status)
{
  void *array = NULL;
  if (*status != PENDRES_OK) return NULL;
  if (n > s->left / size) {
    *status = PENDRES_INVALID_ARGUMENT;
    return NULL;
  }
  array = malloc(n * size + 1);
  if (array == NULL) *status = PENDRES_OUT_OF_MEMORY;
  else (void)get(s, array, n * size);
  return array;
}

/* ---- whether bytes can be what they seem: they may come from elsewhere ---- */

enum { LONGEST_PERIOD = 1000000 };

static int orbit_fits(const pendres_orbit *o)
{
  return (unsigned)o->pendulum.force < PENDRES_FORCE_COUNT && o->period >= 1 &&
         o->period <= LONGEST_PERIOD;
}

static int map_fits(const pendres_map *m)
{
  return (unsigned)m->force < PENDRES_FORCE_COUNT && (unsigned)m->mirror <= PENDRES_MIRROR_WHOLE &&
         m->period >= 1 && m->period <= LONGEST_PERIOD;
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

static pendres_status get_curve(source *s, int branches, pendres_curve **out)
{
  pendres_curve h;
  size_t size[ARRAYS], count[ARRAYS];
  void *array[ARRAYS];
  pendres_status status = PENDRES_OK;
  if (!get(s, &h, sizeof h) || !head_fits(&h) || pendres_curve_is_branch(&h) != branches)
    return PENDRES_INVALID_ARGUMENT;
  pendres_branch *b = calloc(1, sizeof *b);
  if (b == NULL) return PENDRES_OUT_OF_MEMORY;
  pendres_curve *c = &b->curve;
  *c = head_of(&h);
  arrays_of(c, size, count);
  for (int k = 0; k < ARRAYS; k++)
    array[k] = count[k] > 0 ? get_array(s, count[k], size[k], &status) : NULL;
  c->branch_point = array[0];
  c->bifurcation = array[1];
  c->point = array[2];
  c->cusp = array[3];
  c->u = array[4];
  if (status == PENDRES_OK && !(branches ? branch_fits(c) : curve_fits(c)))
    status = PENDRES_INVALID_ARGUMENT;
  if (status == PENDRES_OK) *out = c;
  else pendres_curve_free(c);
  return status;
}

static pendres_status unpack(size_t size, const void *bytes, int branches, pendres_curves **out)
{
  source s = {.at = bytes, .left = size};
  set_head head;
  pendres_status status = PENDRES_OK;
  if (bytes == NULL || !get(&s, &head, sizeof head) || head.count > s.left / sizeof(pendres_curve))
    return PENDRES_INVALID_ARGUMENT;
  pendres_curves *set = pendres_curves_create();
  if (set == NULL) return PENDRES_OUT_OF_MEMORY;
  set->skipped = head.skipped;
  set->capacity = head.count;
  set->curve = calloc(head.count + 1, sizeof(pendres_curve *));
  if (set->curve == NULL) status = PENDRES_OUT_OF_MEMORY;
  for (; set->count < head.count && status == PENDRES_OK; set->count += status == PENDRES_OK)
    status = get_curve(&s, branches, &set->curve[set->count]);
  if (status == PENDRES_OK && s.left > 0) status = PENDRES_INVALID_ARGUMENT;
  if (status == PENDRES_OK) *out = set;
  else pendres_curves_free(set);
  return status;
}

pendres_status pendres_curves_unpack(size_t size, const void *bytes, pendres_curves **out)
{
  *out = NULL;
  return unpack(size, bytes, 0, out);
}

size_t pendres_branches_packed_size(const pendres_branches *branches)
{
  return pendres_curves_packed_size(branches != NULL ? &branches->set : NULL);
}

void pendres_branches_pack(const pendres_branches *branches, void *bytes)
{
  if (bytes != NULL) pendres_curves_pack(branches != NULL ? &branches->set : NULL, bytes);
}

pendres_status pendres_branches_unpack(size_t size, const void *bytes, pendres_branches **out)
{
  pendres_curves *set = NULL;
  if (out == NULL) return PENDRES_INVALID_ARGUMENT;
  const pendres_status status = unpack(size, bytes, 1, &set);
  *out = set != NULL ? pendres_branches_of(set) : NULL;
  return status;
}
