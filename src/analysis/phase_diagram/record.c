/*
 * record.c -- lines of a phase diagram as plain bytes; see internal.h.
 */

#include <stdlib.h>
#include <string.h>

#include "analysis/phase_diagram/internal.h"
#include "continuation/sets.h"

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

void pendres_phase_mark_pass(pendres_bytes *b, pendres_phase_mark *m)
{
  size_t length = m->message != NULL ? strlen(m->message) + 1 : 0;
  pendres_bytes_pass(b, 1, sizeof m->outcome, &m->outcome);
  pendres_bytes_pass(b, 1, sizeof length, &length);
  pendres_bytes_pass_array(b, length, 1, &m->message);
  (void)pendres_bytes_fit(b, (unsigned)m->outcome < PENDRES_STATUS_COUNT &&
                               (length == 0 || (m->message != NULL &&
                                                memchr(m->message, '\0', length) != NULL)));
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

static int point_fits(const pendres_phase_point *p)
{
  return pendres_model_of(p->pendulum.force) != NULL &&
         (unsigned)p->regime < PENDRES_REGIME_COUNT && (unsigned)p->exact < PENDRES_REGIME_COUNT &&
         (unsigned)p->other < 2 * PENDRES_OTHER_UNSTABLE;
}

static int line_fits(const pendres_phase_done *l)
{
  int good = 1;
  for (size_t k = 0; k < l->values && good; k++)
    good = l->place[k] == PENDRES_PHASE_NOWHERE || l->place[k] < l->count;
  for (size_t k = 0; k < l->count && good; k++) good = point_fits(&l->points[k]);
  return good;
}

void pendres_phase_done_pass(pendres_bytes *b, pendres_phase_done *l)
{
  size_t head[2] = {l->values, l->count};
  pendres_curves *branches = pendres_branches_set(l->branches);
  pendres_bytes_pass(b, 2, sizeof *head, head);
  if (!pendres_bytes_fit(b, head[0] == l->values && head[1] <= l->values)) return;
  if (b->reads) l->count = head[1];
  pendres_bytes_pass(b, l->values, sizeof *l->place, l->place);
  pendres_bytes_pass(b, l->count, sizeof *l->points, l->points);
  (void)pendres_bytes_fit(b, line_fits(l));
  for (size_t k = 0; k < l->values; k++) pendres_phase_mark_pass(b, &l->mark[k]);
  pendres_curves_pass(b, 1, &branches);
  if (b->reads && branches != NULL) l->branches = pendres_branches_of(branches);
}

pendres_status pendres_phase_done_read(size_t values, pendres_bytes *b, pendres_phase_done *out)
{
  pendres_status status = pendres_phase_done_create(values, out);
  if (status == PENDRES_OK) {
    pendres_phase_done_pass(b, out);
    status = pendres_bytes_end(b) ? PENDRES_OK : b->status;
  }
  if (status != PENDRES_OK) pendres_phase_done_free(out);
  return status;
}
