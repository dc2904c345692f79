/*
 * pack.c -- branches and curves as plain bytes and back; see continuation.h.
 *
 * The bytes are a head, then of each branch a head, its points and its bifurcations, as they stand
 * in memory; of each curve a head, its points and its cusps.
 */
#include <pendres/continuation.h>

#include <stdlib.h>
#include <string.h>

#include "continuation/branch.h"
#include "continuation/layout.h"
#include "continuation/families.h"

typedef struct set_head {
  size_t count, skipped;
} set_head;

typedef struct branch_head {
  pendres_parameter parameter;
  pendres_continuation_map map;
  pendres_branch_end end[2];
  size_t count, bifurcations;
} branch_head;

size_t pendres_branches_packed_size(const pendres_branches *branches)
{
  size_t size = sizeof(set_head);
  for (size_t i = 0; branches != NULL && i < branches->count; i++) {
    const pendres_branch *b = branches->branch[i];
    size += sizeof(branch_head) + b->count * sizeof *b->point +
            b->bifurcations * sizeof *b->bifurcation;
  }
  return size;
}

static char *put(char *to, const void *from, size_t size)
{
  if (size > 0) memcpy(to, from, size);
  return to + size;
}

void pendres_branches_pack(const pendres_branches *branches, void *bytes)
{
  set_head head = { 0, 0 };
  char *to = bytes;
  if (bytes == NULL) return;
  if (branches != NULL) head = (set_head){ branches->count, branches->skipped };
  to = put(to, &head, sizeof head);
  for (size_t i = 0; i < head.count; i++) {
    const pendres_branch *b = branches->branch[i];
    branch_head h;
    memset(&h, 0, sizeof h); /* so that the same branches give the same bytes, padding included */
    h.parameter = b->parameter;
    h.map = b->map;
    h.end[0] = b->end[0], h.end[1] = b->end[1];
    h.count = b->count;
    h.bifurcations = b->bifurcations;
    to = put(to, &h, sizeof h);
    to = put(to, b->point, b->count * sizeof *b->point);
    to = put(to, b->bifurcation, b->bifurcations * sizeof *b->bifurcation);
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

static int map_fits(const pendres_continuation_map *m)
{
  return (unsigned)m->force < PENDRES_FORCE_COUNT && (unsigned)m->mirror <= PENDRES_MIRROR_WHOLE &&
         m->period >= 1 && m->period <= LONGEST_PERIOD;
}

static int ends_fit(const pendres_branch_end end[2])
{
  return (unsigned)end[0] < PENDRES_END_COUNT && (unsigned)end[1] < PENDRES_END_COUNT;
}

static int branch_fits(const pendres_branch *b)
{
  int good = (unsigned)b->parameter < PENDRES_PARAMETER_FOLLOWED && map_fits(&b->map) &&
             ends_fit(b->end);
  for (size_t i = 0; i < b->count && good; i++) {
    const pendres_branch_point *p = &b->point[i];
    good = (unsigned)p->kind < PENDRES_SPECIAL_COUNT && orbit_fits(&p->orbit) &&
           (p->kind == PENDRES_REGULAR ? p->bifurcation == -1
                                       : p->bifurcation >= 0 &&
                                           (size_t)p->bifurcation < b->bifurcations);
  }
  for (size_t i = 0; i < b->bifurcations && good; i++)
    good = (unsigned)b->bifurcation[i].kind < PENDRES_SPECIAL_COUNT &&
           (unsigned)b->bifurcation[i].parameter < PENDRES_PARAMETER_FOLLOWED &&
           orbit_fits(&b->bifurcation[i].orbit);
  return good;
}

static pendres_status get_branch(source *s, pendres_branch **out)
{
  branch_head h;
  pendres_status status = PENDRES_OK;
  *out = NULL;
  if (!get(s, &h, sizeof h)) return PENDRES_INVALID_ARGUMENT;
  pendres_branch *b = calloc(1, sizeof *b);
  if (b == NULL) return PENDRES_OUT_OF_MEMORY;
  b->parameter = h.parameter;
  b->map = h.map;
  b->end[0] = h.end[0], b->end[1] = h.end[1];
  b->count = h.count;
  b->bifurcations = h.bifurcations;
  b->point = get_array(s, h.count, sizeof *b->point, &status);
  b->bifurcation = get_array(s, h.bifurcations, sizeof *b->bifurcation, &status);
  if (status == PENDRES_OK && !branch_fits(b)) status = PENDRES_INVALID_ARGUMENT;
  if (status == PENDRES_OK) *out = b;
  else pendres_branch_free(b);
  return status;
}

pendres_status pendres_branches_unpack(size_t size, const void *bytes, pendres_branches **out)
{
  source s = { .at = bytes, .left = size };
  set_head head;
  pendres_status status = PENDRES_OK;
  if (out == NULL) return PENDRES_INVALID_ARGUMENT;
  *out = NULL;
  if (bytes == NULL || !get(&s, &head, sizeof head) || head.count > s.left / sizeof(branch_head))
    return PENDRES_INVALID_ARGUMENT;
  pendres_branches *set = calloc(1, sizeof *set);
  if (set == NULL) return PENDRES_OUT_OF_MEMORY;
  set->skipped = head.skipped;
  set->capacity = head.count;
  set->branch = calloc(head.count + 1, sizeof(pendres_branch *));
  if (set->branch == NULL) status = PENDRES_OUT_OF_MEMORY;
  for (; set->count < head.count && status == PENDRES_OK; set->count += status == PENDRES_OK)
    status = get_branch(&s, &set->branch[set->count]);
  if (status == PENDRES_OK && s.left > 0) status = PENDRES_INVALID_ARGUMENT;
  if (status == PENDRES_OK) *out = set;
  else pendres_branches_free(set);
  return status;
}

/* ---- curves ---- */

/* The head of a curve, which stands before its arrays. */
static pendres_curve head_of(const pendres_curve *c)
{
  pendres_curve h;
  memset(&h, 0, sizeof h);
  h.kind = c->kind;
  h.map = c->map;
  h.condition = c->condition;
  for (int k = 0; k < 2; k++) {
    h.parameter[k] = c->parameter[k];
    h.end[k] = c->end[k];
  }
  h.count = c->count;
  h.cusps = c->cusps;
  h.start = c->start;
  return h;
}

size_t pendres_curves_packed_size(const pendres_curves *curves)
{
  size_t size = sizeof curves->count;
  for (size_t i = 0; i < curves->count; i++) {
    const pendres_curve *c = curves->curve[i];
    size += sizeof *c + c->count * (sizeof *c->point + sizeof *c->u) + c->cusps * sizeof *c->cusp;
  }
  return size;
}

void pendres_curves_pack(const pendres_curves *curves, void *bytes)
{
  char *to = put(bytes, &curves->count, sizeof curves->count);
  for (size_t i = 0; i < curves->count; i++) {
    const pendres_curve *c = curves->curve[i], h = head_of(c);
    to = put(to, &h, sizeof h);
    to = put(to, c->point, c->count * sizeof *c->point);
    to = put(to, c->u, c->count * sizeof *c->u);
    to = put(to, c->cusp, c->cusps * sizeof *c->cusp);
  }
}

static int curve_fits(const pendres_curve *c)
{
  int good = (unsigned)c->kind < PENDRES_SPECIAL_COUNT && map_fits(&c->map) && ends_fit(c->end) &&
             (unsigned)c->condition < PENDRES_CONDITION_COUNT;
  for (int k = 0; k < 2; k++) good = good && (unsigned)c->parameter[k] < PENDRES_PARAMETER_FOLLOWED;
  for (size_t i = 0; i < c->count && good; i++)
    good = orbit_fits(&c->point[i].orbit) && c->point[i].cusp >= -1 &&
           (c->point[i].cusp < 0 || (size_t)c->point[i].cusp < c->cusps);
  for (size_t i = 0; i < c->cusps && good; i++)
    good = orbit_fits(&c->cusp[i].orbit) &&
           (unsigned)c->cusp[i].parameter[0] < PENDRES_PARAMETER_FOLLOWED &&
           (unsigned)c->cusp[i].parameter[1] < PENDRES_PARAMETER_FOLLOWED;
  return good;
}

static pendres_status get_curve(source *s, pendres_curve **out)
{
  pendres_curve h;
  pendres_status status = PENDRES_OK;
  if (!get(s, &h, sizeof h)) return PENDRES_INVALID_ARGUMENT;
  pendres_curve *c = malloc(sizeof *c);
  if (c == NULL) return PENDRES_OUT_OF_MEMORY;
  *c = h;
  c->point = get_array(s, h.count, sizeof *c->point, &status);
  c->u = get_array(s, h.count, sizeof *c->u, &status);
  c->cusp = get_array(s, h.cusps, sizeof *c->cusp, &status);
  if (status == PENDRES_OK && !curve_fits(c)) status = PENDRES_INVALID_ARGUMENT;
  if (status == PENDRES_OK) *out = c;
  else pendres_curve_free(c);
  return status;
}

pendres_status pendres_curves_unpack(size_t size, const void *bytes, pendres_curves **out)
{
  source s = { .at = bytes, .left = size };
  size_t count;
  pendres_status status = PENDRES_OK;
  *out = NULL;
  if (!get(&s, &count, sizeof count) || count > s.left / sizeof(pendres_curve))
    return PENDRES_INVALID_ARGUMENT;
  pendres_curves *set = pendres_curves_create();
  if (set == NULL) return PENDRES_OUT_OF_MEMORY;
  set->capacity = count;
  set->curve = calloc(count + 1, sizeof(pendres_curve *));
  if (set->curve == NULL) status = PENDRES_OUT_OF_MEMORY;
  for (; set->count < count && status == PENDRES_OK; set->count += status == PENDRES_OK)
    status = get_curve(&s, &set->curve[set->count]);
  if (status == PENDRES_OK && s.left > 0) status = PENDRES_INVALID_ARGUMENT;
  if (status == PENDRES_OK) *out = set;
  else pendres_curves_free(set);
  return status;
}
