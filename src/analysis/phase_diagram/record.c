/*
 * record.c -- lines of a phase diagram as plain bytes; see internal.h.
 *
 * A record is a head, the place of every point, the points that have results, the branches, and
 * of every point its outcome and its message with the zero at its end.
 */

#include <stdlib.h>
#include <string.h>

#include "analysis/phase_diagram/internal.h"
#include "continuation/sets.h"

typedef struct head {
  size_t values, count, branches; /* points; those that have results; bytes */
} head;

/* ---- marks ---- */

pendres_status pendres_phase_mark_set(pendres_phase_mark *m, pendres_status outcome,
                                      const char *message)
{
  const size_t size = strlen(message) + 1;
  char *copy = malloc(size);
  if (copy == NULL) return PENDRES_OUT_OF_MEMORY;
  memcpy(copy, message, size);
  pendres_phase_mark_free(m);
  *m = (pendres_phase_mark){.outcome = outcome, .message = copy};
  return PENDRES_OK;
}

void pendres_phase_mark_free(pendres_phase_mark *m)
{
  free(m->message);
  *m = (pendres_phase_mark){.outcome = PENDRES_OK};
}

/* ---- lines ---- */

pendres_status pendres_phase_done_create(size_t values, pendres_phase_done *out)
{
  *out = (pendres_phase_done){.values = values,
                              .points = calloc(values + 1, sizeof *out->points),
                              .place = calloc(values + 1, sizeof *out->place),
                              .mark = calloc(values + 1, sizeof *out->mark)};
  if (out->points == NULL || out->place == NULL || out->mark == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t k = 0; k < values; k++) out->place[k] = PENDRES_PHASE_NOWHERE;
  return PENDRES_OK;
}

void pendres_phase_done_free(pendres_phase_done *l)
{
  for (size_t k = 0; l->mark != NULL && k < l->values; k++) pendres_phase_mark_free(&l->mark[k]);
  free(l->points);
  free(l->place);
  free(l->mark);
  pendres_branches_free(l->branches);
  *l = (pendres_phase_done){.values = 0};
}

pendres_status pendres_phase_done_copy(const pendres_phase_done *from, pendres_phase_done *to)
{
  pendres_phase_bytes r = {0, NULL};
  *to = (pendres_phase_done){.values = 0};
  pendres_status status = pendres_phase_done_pack(from, &r);
  if (status == PENDRES_OK) status = pendres_phase_done_unpack(from->values, r.size, r.bytes, to);
  free(r.bytes);
  return status;
}

/* ---- bytes ---- */

static char *put(char *to, const void *from, size_t size)
{
  if (size > 0) memcpy(to, from, size);
  return to + size;
}

static const char *words_of(const pendres_phase_mark *m)
{
  return m->message != NULL ? m->message : "";
}

pendres_status pendres_phase_done_pack(const pendres_phase_done *l, pendres_phase_bytes *out)
{
  const head h = {l->values, l->count, pendres_branches_packed_size(l->branches)};
  size_t size = sizeof h + h.values * sizeof *l->place + h.count * sizeof *l->points + h.branches;
  for (size_t k = 0; k < h.values; k++)
    size += sizeof l->mark[k].outcome + strlen(words_of(&l->mark[k])) + 1;
  *out = (pendres_phase_bytes){size, malloc(size)};
  if (out->bytes == NULL) return PENDRES_OUT_OF_MEMORY;
  char *to = put(out->bytes, &h, sizeof h);
  to = put(to, l->place, h.values * sizeof *l->place);
  to = put(to, l->points, h.count * sizeof *l->points);
  pendres_branches_pack(l->branches, to);
  to += h.branches;
  for (size_t k = 0; k < h.values; k++) {
    const char *words = words_of(&l->mark[k]);
    to = put(to, &l->mark[k].outcome, sizeof l->mark[k].outcome);
    to = put(to, words, strlen(words) + 1);
  }
  return PENDRES_OK;
}

/* Bytes that are still to be read. */
typedef struct source {
  const char *at;
  size_t left;
} source;

static int get(source *s, void *to, size_t n, size_t size)
{
  if (n > s->left / size) return 0;
  memcpy(to, s->at, n * size);
  s->at += n * size;
  s->left -= n * size;
  return 1;
}

static pendres_status get_marks(source *s, pendres_phase_done *l)
{
  for (size_t k = 0; k < l->values; k++) {
    pendres_status outcome;
    if (!get(s, &outcome, 1, sizeof outcome) || (unsigned)outcome >= PENDRES_STATUS_COUNT)
      return PENDRES_INVALID_ARGUMENT;
    const char *end = memchr(s->at, '\0', s->left);
    if (end == NULL) return PENDRES_INVALID_ARGUMENT;
    const size_t length = (size_t)(end - s->at);
    l->mark[k].outcome = outcome;
    if (length > 0 && pendres_phase_mark_set(&l->mark[k], outcome, s->at) != PENDRES_OK)
      return PENDRES_OUT_OF_MEMORY;
    s->at += length + 1;
    s->left -= length + 1;
  }
  return s->left == 0 ? PENDRES_OK : PENDRES_INVALID_ARGUMENT;
}

static int point_fits(const pendres_phase_point *p)
{
  return (unsigned)p->pendulum.force < PENDRES_FORCE_COUNT &&
         (unsigned)p->regime < PENDRES_REGIME_COUNT && (unsigned)p->exact < PENDRES_REGIME_COUNT &&
         (unsigned)p->other < 2 * PENDRES_OTHER_UNRESOLVED;
}

static pendres_status get_line(source *s, const head *h, pendres_phase_done *l)
{
  if (!get(s, l->place, h->values, sizeof *l->place) ||
      !get(s, l->points, h->count, sizeof *l->points) || h->branches > s->left)
    return PENDRES_INVALID_ARGUMENT;
  for (size_t k = 0; k < h->values; k++)
    if (l->place[k] != PENDRES_PHASE_NOWHERE && l->place[k] >= h->count)
      return PENDRES_INVALID_ARGUMENT;
  for (size_t k = 0; k < h->count; k++)
    if (!point_fits(&l->points[k])) return PENDRES_INVALID_ARGUMENT;
  l->count = h->count;
  const pendres_status status = pendres_branches_unpack(h->branches, s->at, &l->branches);
  if (status != PENDRES_OK) return status;
  s->at += h->branches;
  s->left -= h->branches;
  return get_marks(s, l);
}

pendres_status pendres_phase_done_unpack(size_t values, size_t size, const void *bytes,
                                         pendres_phase_done *out)
{
  source s = {.at = bytes, .left = size};
  head h;
  *out = (pendres_phase_done){.values = 0};
  if (!get(&s, &h, 1, sizeof h) || h.values != values || h.count > values)
    return PENDRES_INVALID_ARGUMENT;
  pendres_status status = pendres_phase_done_create(values, out);
  if (status == PENDRES_OK) status = get_line(&s, &h, out);
  if (status != PENDRES_OK) pendres_phase_done_free(out);
  return status;
}
