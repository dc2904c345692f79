/* lanes_replay.c -- the operations of a drive period, recorded to be repeated; see lanes_replay.h.
   */
#include "engine/sundials/lanes_replay.h"

#include <stdlib.h>
#include <string.h>

#include "base/numbers.h"

enum {
  MOST_OPERATIONS = 16384, /* operations of one record, a thousand steps; longer periods are not
                              kept */
  MOST_SUMS = 64,          /* different sums of one record: those of a few steps, as the last step
                              of a period is unlike the others */
  MOST_KINDS = 64,
  MOST_KEPT = 65536        /* operations of all records together, 4 MB */
};

typedef struct entry {
  pendres_lanes_replay_kind kind;
  pendres_lanes_replay replay; /* of the latest period that was recorded */
  int agreed;                  /* two periods one after the other have done the same */
  int tries;
} entry;

struct pendres_lanes_replays {
  int recording;
  size_t used, latest, kept;
  entry entries[MOST_KINDS];
  pendres_lanes_replay record; /* the current period; it has room for the most */
};

static void clear(pendres_lanes_replay *p)
{
  free(p->operation);
  free(p->sum);
  free(p->end);
  *p = (pendres_lanes_replay){0};
}

/* Make room; 0 if out of memory. */
static int reserve(pendres_lanes_replay *p, size_t operations, size_t sums, size_t parts)
{
  *p = (pendres_lanes_replay){.operation = malloc((operations + 1) * sizeof *p->operation),
                              .sum = malloc((sums + 1) * sizeof *p->sum),
                              .end = malloc((parts + 1) * sizeof *p->end)};
  if (p->operation != NULL && p->sum != NULL && p->end != NULL) return 1;
  clear(p);
  return 0;
}

pendres_lanes_replays *pendres_lanes_replays_create(void)
{
  pendres_lanes_replays *r = calloc(1, sizeof *r);
  if (r == NULL) return NULL;
  if (reserve(&r->record, MOST_OPERATIONS, MOST_SUMS, MOST_OPERATIONS)) return r;
  free(r);
  return NULL;
}

void pendres_lanes_replays_free(pendres_lanes_replays *r)
{
  if (r == NULL) return;
  for (size_t i = 0; i < r->used; i++) clear(&r->entries[i].replay);
  clear(&r->record);
  free(r);
}

static int same_kind(const pendres_lanes_replay_kind *a, const pendres_lanes_replay_kind *b)
{
  return a->steps == b->steps && a->span == b->span && a->carried == b->carried &&
         a->driven == b->driven;
}

/* The kind's entry; NULL if it has none. */
static entry *find(pendres_lanes_replays *r, const pendres_lanes_replay_kind *kind)
{
  if (r->latest < r->used && same_kind(&r->entries[r->latest].kind, kind))
    return &r->entries[r->latest];
  for (size_t i = 0; i < r->used; i++)
    if (same_kind(&r->entries[i].kind, kind)) {
      r->latest = i;
      return &r->entries[i];
    }
  return NULL;
}

const pendres_lanes_replay *pendres_lanes_replays_find(pendres_lanes_replays *r,
                                                       const pendres_lanes_replay_kind *kind)
{
  const entry *e = find(r, kind);
  return e != NULL && e->agreed ? &e->replay : NULL;
}

/* ---- recording ---- */

void pendres_lanes_replays_begin(pendres_lanes_replays *r)
{
  r->recording = 1;
  r->record.operations = r->record.sums = r->record.parts = r->record.slopes = 0;
}

static int same_sum(const pendres_sum *a, const pendres_sum *b)
{
  if (a->terms != b->terms || a->z != b->z) return 0;
  for (int i = 0; i < a->terms; i++)
    if (a->term[i].c != b->term[i].c || a->term[i].x != b->term[i].x) return 0;
  return 1;
}

/* The record's own copy of a sum; NULL if there is no room left. */
static const pendres_sum *keep_sum(pendres_lanes_replay *p, const pendres_sum *sum)
{
  for (size_t i = p->sums; i-- > 0;)
    if (same_sum(&p->sum[i], sum)) return &p->sum[i];
  if (p->sums == MOST_SUMS) return NULL;
  p->sum[p->sums] = *sum;
  return &p->sum[p->sums++];
}

void pendres_lanes_replays_add(pendres_lanes_replays *r, const pendres_operation *operations,
                               size_t n)
{
  pendres_lanes_replay *p = &r->record;
  if (!r->recording) return;
  for (size_t i = 0; i < n; i++) {
    pendres_operation o = operations[i];
    if (o.sum == NULL && o.from == NULL && o.to == NULL) continue; /* found to be unnecessary */
    if (o.sum != NULL) o.sum = keep_sum(p, o.sum);
    if (p->operations == MOST_OPERATIONS || (operations[i].sum != NULL && o.sum == NULL)) {
      r->recording = 0;
      return;
    }
    p->slopes += o.slope != NULL;
    p->operation[p->operations++] = o;
  }
}

void pendres_lanes_replays_part(pendres_lanes_replays *r)
{
  if (!r->recording) return;
  r->recording = r->record.parts < MOST_OPERATIONS;
  if (r->recording) r->record.end[r->record.parts++] = r->record.operations;
}

/* ---- what was recorded ---- */

static int same_operation(const pendres_lanes_replay *p, const pendres_operation *a,
                          const pendres_lanes_replay *q, const pendres_operation *b)
{
  if ((a->sum == NULL) != (b->sum == NULL)) return 0;
  if (a->sum != NULL && a->sum - p->sum != b->sum - q->sum) return 0;
  return a->from == b->from && a->to == b->to && a->slope == b->slope &&
         a->cos_theta == b->cos_theta && a->carry == b->carry && a->second == b->second &&
         a->keep == b->keep;
}

static int same(const pendres_lanes_replay *p, const pendres_lanes_replay *q)
{
  if (p->operations != q->operations || p->sums != q->sums || p->parts != q->parts) return 0;
  for (size_t i = 0; i < p->sums; i++)
    if (!same_sum(&p->sum[i], &q->sum[i])) return 0;
  for (size_t i = 0; i < p->operations; i++)
    if (!same_operation(p, &p->operation[i], q, &q->operation[i])) return 0;
  for (size_t i = 0; i < p->parts; i++)
    if (p->end[i] != q->end[i]) return 0;
  return 1;
}

/* Into a copy with no more room than is needed; 0 if out of memory. */
static int copy(const pendres_lanes_replay *from, pendres_lanes_replay *to)
{
  if (!reserve(to, from->operations, from->sums, from->parts)) return 0;
  to->operations = from->operations;
  to->sums = from->sums;
  to->parts = from->parts;
  to->slopes = from->slopes;
  memcpy(to->sum, from->sum, from->sums * sizeof *to->sum);
  memcpy(to->end, from->end, from->parts * sizeof *to->end);
  for (size_t i = 0; i < from->operations; i++) {
    to->operation[i] = from->operation[i];
    if (from->operation[i].sum != NULL)
      to->operation[i].sum = to->sum + (from->operation[i].sum - from->sum);
  }
  return 1;
}

static void forget_all(pendres_lanes_replays *r)
{
  for (size_t i = 0; i < r->used; i++) clear(&r->entries[i].replay);
  r->used = r->kept = 0;
}

/* An entry for a kind; if there is none left, all others are discarded. */
static entry *place_for(pendres_lanes_replays *r, const pendres_lanes_replay_kind *kind)
{
  entry *e = find(r, kind);
  if (e == NULL || r->kept + r->record.operations > MOST_KEPT) {
    if (r->used == MOST_KINDS || r->kept + r->record.operations > MOST_KEPT) forget_all(r);
    e = &r->entries[r->used++];
    *e = (entry){.kind = *kind};
  }
  return e;
}

void pendres_lanes_replays_end(pendres_lanes_replays *r, const pendres_lanes_replay_kind *kind,
                               int whole)
{
  const int recorded = r->recording;
  r->recording = 0;
  if (!recorded || !whole) return;
  entry *e = place_for(r, kind);
  if (e->agreed || e->tries == TRIES) return;
  e->tries++;
  if (e->replay.operations > 0 && same(&e->replay, &r->record)) {
    e->agreed = 1;
    return;
  }
  r->kept -= e->replay.operations;
  clear(&e->replay);
  if (copy(&r->record, &e->replay)) r->kept += e->replay.operations;
}
