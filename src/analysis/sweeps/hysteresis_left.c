/* hysteresis_left.c -- values that a path leaves out; see hysteresis_left.h. */
#include "analysis/sweeps/hysteresis_left.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/sweeps/numbers.h"
#include "engine/context_internal.h"

int pendres_path_own(pendres_status status)
{
  return status == PENDRES_TOLERANCE_UNREACHABLE || status == PENDRES_NOT_CONVERGED ||
         status == PENDRES_INTEGRATION_FAILED || status == PENDRES_UNRESOLVED;
}

pendres_status pendres_path_left_open(pendres_path *w, pendres_path_left *left)
{
  const size_t n = w->n;
  *left = (pendres_path_left){.value = malloc((n + 1) * sizeof *left->value),
                              .index = malloc((n + 1) * sizeof *left->index),
                              .outcome = calloc(n + 1, sizeof *left->outcome), .all = n};
  if (left->value == NULL || left->index == NULL || left->outcome == NULL)
    return pendres_context_fail(w->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu values", n);
  for (size_t i = 0; i < n; i++) {
    left->value[i] = w->value[i];
    left->index[i] = i;
  }
  w->value = left->value;
  return PENDRES_OK;
}

void pendres_path_left_close(pendres_path_left *left)
{
  free(left->value);
  free(left->index);
  free(left->outcome);
}

void pendres_path_allow(pendres_path *w)
{
  const double most = w->most_slopes > 0.0 ? w->most_slopes : sweep_usual_slopes;
  w->ctx->most_slopes = pendres_context_slopes(w->ctx) + most;
}

void pendres_path_allow_all(pendres_path *w)
{
  w->ctx->most_slopes = INFINITY;
}

/* What was begun within the limit counts, not what was noticed to be beyond it. */
void pendres_path_search_beyond(pendres_path *w, int direction, double end)
{
  if (pendres_context_slopes(w->ctx) > w->ctx->most_slopes) return;
  w->beyond = direction;
  w->end = end;
}

pendres_path_mark pendres_path_mark_here(const pendres_path *w)
{
  return (pendres_path_mark){.path = *w, .jumps = w->h->jumps, .parts = w->h->parts};
}

/* Go back to the mark, where nothing is followed. */
static void go_back(pendres_path *w, const pendres_path_mark *mark)
{
  pendres_unlocked *unlocked = w->unlocked;
  const size_t values = w->values;
  struct pendres_crisis_seen *seen = w->seen;
  pendres_part_free(&w->part);
  *w = mark->path;
  w->part = pendres_part_none;
  w->unlocked = unlocked;
  w->values = values;
  w->seen = seen;
  w->h->jumps = mark->jumps;
  w->h->parts = mark->parts;
}

/* Where a path turns round it comes to the same value twice. */
static void leave_out(pendres_path *w, pendres_path_left *left, size_t i, pendres_status why)
{
  size_t end = i + 1;
  while (end < w->n && left->value[end] == left->value[i]) end++;
  for (size_t k = i; k < end; k++) left->outcome[left->index[k]] = why;
  memmove(left->value + i, left->value + end, (w->n - end) * sizeof *left->value);
  memmove(left->index + i, left->index + end, (w->n - end) * sizeof *left->index);
  w->n -= end - i;
}

/* The work decides, not when it was noticed, which would depend on the size of blocks. */
int pendres_path_spent(const pendres_path *w, pendres_status status)
{
  return pendres_context_slopes(w->ctx) > w->ctx->most_slopes &&
         (status == PENDRES_OK || status == PENDRES_INTERRUPTED);
}

int pendres_path_came(pendres_path *w, pendres_path_left *left, const pendres_path_mark *mark,
                      size_t i, pendres_status *status)
{
  const int spent = pendres_path_spent(w, *status);
  if (!spent && !pendres_path_own(*status)) return 1;
  const int beyond = w->beyond;
  const double end = w->end;
  go_back(w, mark);
  do
    leave_out(w, left, i, spent ? PENDRES_UNRESOLVED : *status);
  while (i < w->n && (left->value[i] - end) * beyond > 0.0);
  *status = PENDRES_OK;
  return 0;
}

void pendres_path_number(pendres_path *w, const pendres_path_left *left)
{
  pendres_hysteresis *h = w->h;
  for (size_t k = w->n; k-- > 0;) {
    h->point[left->index[k]] = h->point[k];
    h->part[left->index[k]] = h->part[k];
  }
  for (size_t k = 0; k < h->jumps; k++) h->jump[k].step = left->index[h->jump[k].step];
  /* Entries that were moved have left copies behind, which are overwritten here. */
  size_t k = 0;
  for (size_t i = 0; i < left->all; i++) {
    const int there = k < w->n && left->index[k] == i;
    k += (size_t)there;
    if (there && !isnan(h->point[i].value)) continue;
    h->point[i] = pendres_path_nothing(w, w->all[i]);
    h->point[i].outcome = there ? PENDRES_INTERRUPTED : left->outcome[i];
    h->part[i] = h->parts + 1;
  }
}
