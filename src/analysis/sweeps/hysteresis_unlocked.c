/* hysteresis_unlocked.c -- a pendulum on rotations without a lock; see hysteresis_unlocked.h. */
#include "analysis/sweeps/hysteresis_unlocked.h"

#include <math.h>
#include <stdlib.h>

#include "continuation/parameter.h"
#include "engine/context_internal.h"
#include "analysis/sweeps/hysteresis_left.h"
#include "analysis/sweeps/numbers.h"

/* A rotation that is known. */
struct pendres_unlocked {
  double value;
  int tried, found;
  int again; /* it is tried once more, from a rotation that is nearer */
  int slips; /* not found: it turns past the end of a lock too seldom */
  double x, v, turns, turns_error;
};

static int ascending(const void *a, const void *b)
{
  const pendres_unlocked *p = a, *q = b;
  return (p->value > q->value) - (p->value < q->value);
}

static pendres_unlocked *at(const pendres_path *w, double value)
{
  const pendres_unlocked key = {.value = value};
  return bsearch(&key, w->unlocked, w->values, sizeof key, ascending);
}

static pendres_status make_table(pendres_path *w)
{
  size_t count = 0;
  if (w->unlocked != NULL) return PENDRES_OK;
  w->unlocked = calloc(w->n + 1, sizeof *w->unlocked);
  if (w->unlocked == NULL)
    return pendres_context_fail(w->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu rotations",
                                w->n);
  for (size_t i = 0; i < w->n; i++) w->unlocked[i].value = w->value[i];
  qsort(w->unlocked, w->n, sizeof *w->unlocked, ascending);
  for (size_t i = 0; i < w->n; i++)
    if (count == 0 || w->unlocked[i].value != w->unlocked[count - 1].value)
      w->unlocked[count++] = w->unlocked[i];
  w->values = count;
  return PENDRES_OK;
}

void pendres_path_unlocked_pass(pendres_bytes *b, pendres_path *w)
{
  pendres_bytes_pass(b, 1, sizeof w->values, &w->values);
  pendres_bytes_pass_array(b, w->values, sizeof *w->unlocked, &w->unlocked);
  for (size_t i = 0; b->reads && w->unlocked != NULL && i < w->n; i++)
    (void)pendres_bytes_fit(b, at(w, w->value[i]) != NULL);
}

void pendres_path_unlocked_free(pendres_path *w)
{
  free(w->unlocked);
  w->unlocked = NULL;
}

/* Rotations that slip too seldom for their means to be known go on for as long again: by then some
   have come to the lock that they were on their way to. */
static pendres_status go_on(pendres_context *ctx, size_t n, pendres_arrival *s)
{
  size_t count = 0;
  pendres_arrival *some = malloc((n + 1) * sizeof *some);
  if (some == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for rotations");
  for (size_t k = 0; k < n; k++)
    if (s[k].slips)
      some[count++] = pendres_arrival_at(&s[k].pendulum, s[k].x, s[k].v);
  const pendres_status status = pendres_arrivals_turning(ctx, count, some);
  count = 0;
  for (size_t k = 0; k < n; k++)
    if (s[k].slips) s[k] = some[count++];
  free(some);
  return status;
}

/* Whether value number k is one of the next few from number i on, before the path turns round. */
static int is_next(const pendres_path *w, size_t i, size_t k)
{
  const int way = pendres_path_direction(w, i);
  return k > i && k - i < SWEEP_AT_LEAST && (w->value[k] - w->value[k - 1]) * way > 0.0;
}

/* Take over what has been found at a value; where it had been tried before, from a rotation further
   away, only that there is one. */
static void keep(const pendres_arrival *s, pendres_unlocked *u)
{
  const int found = s->attractor.label == PENDRES_LABEL_QUASI_PERIODIC, again = u->again;
  u->again = 0;
  if (again && !found) return;
  u->found = found;
  u->slips = s->slips;
  u->x = s->x;
  u->v = s->v;
  u->turns = s->attractor.drift;
  u->turns_error = s->attractor.drift_error;
}

/* Average the rotations at values from number i on that are not known yet, side by side; with them
   the next few again, since one alone takes as long. *next receives what is found at value number
   i. */
static pendres_status average(pendres_path *w, size_t i, pendres_arrival *next)
{
  const double scale = pendres_parameter_scale(w->parameter);
  pendres_unlocked *known[SWEEP_ABREAST];
  int onward = 1;
  pendres_arrival *s = malloc(SWEEP_ABREAST * sizeof *s);
  size_t n = 0;
  if (s == NULL)
    return pendres_context_fail(w->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for rotations");
  for (size_t k = i; k < w->n && n < SWEEP_ABREAST; k++) {
    if (fabs(w->value[k] - w->at) > sweep_side_by_side * scale && k > i) break;
    pendres_unlocked *u = at(w, w->value[k]);
    onward = onward && (k == i || is_next(w, i, k));
    const int again = k > i && u->tried && !u->found && onward;
    if (u->tried && k > i && !again) continue;
    u->again = again;
    const pendres_pendulum p = pendres_path_pendulum(w, u->value);
    u->tried = 1;
    known[n] = u;
    s[n++] = pendres_arrival_at(&p, w->state.x, w->state.v);
  }
  pendres_path_allow_all(w); /* the work is that of many values */
  pendres_status status = pendres_arrivals_turning(w->ctx, n, s);
  if (status == PENDRES_OK) status = go_on(w->ctx, n, s);
  pendres_path_allow(w);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) keep(&s[k], known[k]);
  *next = s[0];
  free(s);
  return status;
}

/* The pendulum is on a rotation that is known. */
static void stand_on(pendres_path *w, const pendres_unlocked *u)
{
  const pendres_pendulum p = pendres_path_pendulum(w, u->value);
  w->state = pendres_arrival_at(&p, u->x, u->v);
  w->state.attractor.label = PENDRES_LABEL_QUASI_PERIODIC;
  w->state.attractor.lyapunov = w->state.attractor.lyapunov_error = 0.0;
  w->state.attractor.drift = u->turns;
  w->state.attractor.drift_error = u->turns_error;
}

static void take(pendres_path *w, size_t i, const pendres_unlocked *u)
{
  stand_on(w, u);
  w->at = u->value;
  pendres_path_put(w, i, &w->state.attractor);
}

/* The rotation goes on beyond a value at which its mean is not known. */
static void leave_open(pendres_path *w, size_t i)
{
  const pendres_pendulum p = pendres_path_pendulum(w, w->value[i]);
  const pendres_attractor nothing = pendres_arrival_nothing(&p);
  pendres_path_put(w, i, &nothing);
}

pendres_status pendres_path_unlocked(pendres_path *w, size_t *i, pendres_arrival *next)
{
  const double close = sweep_close_by * pendres_parameter_scale(w->parameter);
  const size_t first = *i;
  pendres_status status = make_table(w);
  next->attractor.label = PENDRES_LABEL_UNRESOLVED;
  while (*i < w->n && status == PENDRES_OK) {
    const pendres_unlocked *u = at(w, w->value[*i]);
    /* What it goes to where there is no rotation is asked when it has come there. */
    if (!u->found && !u->slips && u->tried && *i > first) break;
    if (!u->found && !u->slips) status = average(w, *i, next);
    if (status != PENDRES_OK || !(u->found || u->slips)) break;
    if (u->found) take(w, (*i)++, u);
    else leave_open(w, (*i)++);
  }
  if (*i < w->n && fabs(w->value[*i] - w->at) > close)
    next->attractor.label = PENDRES_LABEL_UNRESOLVED;
  return status;
}

pendres_status pendres_path_unlocked_at(pendres_path *w, size_t i, int *found)
{
  pendres_arrival ignored;
  pendres_status status = make_table(w);
  const pendres_unlocked *u = status == PENDRES_OK ? at(w, w->value[i]) : NULL;
  if (status == PENDRES_OK && !u->tried) status = average(w, i, &ignored);
  *found = status == PENDRES_OK && u->found;
  if (*found) stand_on(w, u);
  return status;
}
