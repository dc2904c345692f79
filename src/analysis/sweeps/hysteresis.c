/* hysteresis.c -- the state of a pendulum along a path of a parameter; see hysteresis.h. */
#include <pendres/hysteresis.h>

#include <math.h>
#include <stdlib.h>

#include "continuation/parameter.h"
#include "engine/context_internal.h"
#include "engine/door.h"
#include "engine/keep.h"
#include "analysis/sweeps/hysteresis_chaos.h"
#include "analysis/sweeps/hysteresis_crisis.h"
#include "analysis/sweeps/hysteresis_left.h"
#include "analysis/sweeps/hysteresis_orbit.h"
#include "analysis/sweeps/hysteresis_rotation.h"
#include "analysis/sweeps/hysteresis_state.h"
#include "analysis/sweeps/hysteresis_steps.h"
#include "analysis/sweeps/hysteresis_unlocked.h"
#include "settling/exponents/lyapunov_move.h"
#include "analysis/sweeps/numbers.h"
#include "model/equation.h"
#include "model/model.h"
#include "model/parameter.h"

void pendres_hysteresis_free(pendres_hysteresis *h)
{
  if (h == NULL) return;
  free(h->point);
  free(h->jump);
  free(h->step);
  free(h->part);
  free(h->jump_from);
  free(h->jump_to);
  free(h);
}

size_t pendres_hysteresis_count(const pendres_hysteresis *h)
{
  return h != NULL ? h->count : 0;
}

const pendres_hysteresis_point *pendres_hysteresis_get(const pendres_hysteresis *h, size_t i)
{
  return h != NULL && i < h->count ? &h->point[i] : NULL;
}

size_t pendres_hysteresis_jump_count(const pendres_hysteresis *h)
{
  return h != NULL ? h->jumps : 0;
}

const pendres_jump *pendres_hysteresis_jump_get(const pendres_hysteresis *h, size_t i)
{
  return h != NULL && i < h->jumps ? &h->jump[i] : NULL;
}

size_t pendres_hysteresis_step_count(const pendres_hysteresis *h)
{
  return h != NULL ? h->steps : 0;
}

const pendres_step *pendres_hysteresis_step_get(const pendres_hysteresis *h, size_t i)
{
  return h != NULL && i < h->steps ? &h->step[i] : NULL;
}

/* ---- along the path ---- */

typedef pendres_path path;

/* Whether it is a rotation without a drive. */
static int rotates_freely(const pendres_attractor *a)
{
  return a->label == PENDRES_LABEL_RUNNING && !pendres_attractor_closes(a);
}

/* The last value at which the old state has not ended. An unstable one may end right at its last
   value, where it attracts from one side: then it is the value before. */
static double last_before(const path *w, size_t step, const pendres_arrival *old)
{
  if (old->attractor.label != PENDRES_LABEL_UNSTABLE || step < 2 ||
      w->h->point[step - 2].attractor.label != PENDRES_LABEL_UNSTABLE ||
      pendres_path_direction(w, step) != pendres_path_direction(w, step - 1))
    return w->at;
  return w->value[step - 2];
}

/* Chaos has ended between the last value and this one, at which the pendulum is on an orbit.
   w->state becomes the first orbit that it goes to, at this value or an earlier one, where that is
   looked for; otherwise it stays. */
static pendres_status end_chaos(path *w, size_t step, const pendres_arrival *old, int look)
{
  const double to = w->value[step];
  pendres_jump j = {
    .step = step, .direction = pendres_path_direction(w, step), .kind = PENDRES_JUMP_OTHER,
    .share = NAN};
  pendres_status status = PENDRES_OK;
  const int back = (to - w->at) * j.direction <= 0.0; /* from trials beyond the value */
  if (look && w->tries <= TRIES && !(back && pendres_attractor_closes(&old->attractor))) {
    status = pendres_chaos_end(w->ctx, w->parameter, old, last_before(w, step, old), &w->state, &j);
  } else { /* chaos and windows of orbits in turn, or one orbit and another: somewhere between */
    j.from = old->attractor.label;
    j.to = w->state.attractor.label;
    j.to_period = w->state.attractor.orbit.period;
    j.value = 0.5 * (w->at + to);
    j.value_error = 0.5 * fabs(to - w->at);
  }
  return status == PENDRES_OK ? pendres_path_note(w, &j) : status;
}

/* Chaos goes on at value number `step`; it may have become larger or smaller on the way there. */
static pendres_status go_on_in_chaos(path *w, size_t step, const pendres_arrival *old)
{
  pendres_jump j = {
    .step = step, .direction = pendres_path_direction(w, step), .kind = PENDRES_JUMP_OTHER};
  const pendres_status status = pendres_crisis_find(w, old, &j);
  if (status != PENDRES_OK || j.kind != PENDRES_JUMP_CRISIS) return status;
  const pendres_status noted = pendres_path_note(w, &j);
  pendres_path_leave(w);
  return noted;
}

/* A pendulum that has escaped does not return, whatever the parameter does. */
static void stay_away(path *w, size_t *i)
{
  const pendres_pendulum p = pendres_path_pendulum(w, w->value[*i]);
  w->state = pendres_arrival_at(&p, w->state.x, w->state.v);
  w->state.attractor.label = PENDRES_LABEL_ESCAPE;
  w->at = w->value[*i];
  pendres_path_put(w, (*i)++, &w->state.attractor);
}

/* The path begins on the state that has been found. Whether averages alone are certain is known
   only where errors stay small; where they grow, copies tell. */
static pendres_status begin_path(path *w, double x, double v)
{
  const pendres_arrival *s = &w->state;
  const int closed = pendres_attractor_closes(&s->attractor);
  pendres_settled l;
  if (w->known || s->attractor.label == PENDRES_LABEL_UNRESOLVED) return PENDRES_OK;
  w->known = 1;
  w->certain = s->certain;
  if (w->certain || !pendres_lyapunov_may_rotate(&s->pendulum)) return PENDRES_OK;
  const pendres_status status =
    pendres_lyapunov_find(w->ctx, 1, &s->pendulum, &x, &v, NULL, &l);
  w->certain = status == PENDRES_OK && l.certain && l.label == s->attractor.label &&
               (!closed || (l.period == s->attractor.orbit.period &&
                            l.winding == s->attractor.orbit.winding));
  return status;
}

/* Settle the pendulum at value number i, from its present state. The mean of a rotation is found
   with those at the values that follow. */
static pendres_status settle_alone(path *w, size_t i)
{
  const pendres_pendulum p = pendres_path_pendulum(w, w->value[i]);
  const pendres_arrival from = pendres_arrival_at(&p, w->state.x, w->state.v);
  const pendres_lyapunov_care care = w->settled ? PENDRES_CARE_LABEL : PENDRES_CARE_FULL;
  int found = 0;
  pendres_status status = pendres_arrival_find(w->ctx, &p, from.x, from.v, care, &w->state);
  if (status != PENDRES_OK || !w->settled ||
      w->state.attractor.label != PENDRES_LABEL_QUASI_PERIODIC)
    return status;
  const int certain = w->state.certain;
  status = pendres_path_unlocked_at(w, i, &found);
  if (found) w->state.certain = certain;
  if (found || status != PENDRES_OK) return status;
  return pendres_arrival_find(w->ctx, &p, from.x, from.v, PENDRES_CARE_FULL, &w->state);
}

/* What the pendulum has done between the last value and number i, which it has come to from a state
   that is not followed. */
static pendres_status tell_way(path *w, size_t i, const pendres_arrival *old)
{
  const pendres_attractor *from = &old->attractor, *to = &w->state.attractor;
  const int ends = pendres_chaos_ends(from, to);
  pendres_status status = PENDRES_OK;
  if (!w->settled) return status;
  if (ends && !w->states_only) {
    const pendres_arrival settled = w->state;
    const size_t jumps = w->h->jumps;
    if (w->tried != i) w->tries = 0;
    w->tried = i;
    w->tries++;
    pendres_path_allow(w); /* where it ended is a question of its own, */
    status = end_chaos(w, i, old, 1);
    if (pendres_path_spent(w, status)) { /* and what it has ended in is known without the answer */
      w->h->jumps = jumps;
      w->state = settled;
      pendres_path_allow(w);
      status = end_chaos(w, i, old, 0);
    }
  } else if (from->label == PENDRES_LABEL_CHAOTIC && to->label == PENDRES_LABEL_CHAOTIC &&
             !w->states_only) {
    status = go_on_in_chaos(w, i, old);
  }
  if (ends) pendres_path_leave(w);
  return status;
}

/* Find what the pendulum settles on at value number *i, from its present state, unless it is known,
   or the orbit that it goes to on the way there, which is to be followed first. */
static pendres_status settle_at(path *w, size_t *i, const pendres_arrival *known)
{
  const pendres_arrival old = w->state;
  pendres_status status = PENDRES_OK;
  if (known->attractor.label != PENDRES_LABEL_UNRESOLVED) w->state = *known;
  else status = settle_alone(w, *i);
  /* An orbit that could not be followed any further has not ended: the value is left out. */
  if (status == PENDRES_OK && pendres_path_short(w, &old.attractor) &&
      w->state.attractor.label == PENDRES_LABEL_UNRESOLVED)
    return PENDRES_UNRESOLVED;
  if (status == PENDRES_OK) status = begin_path(w, old.x, old.v);
  if (status == PENDRES_OK) status = tell_way(w, *i, &old);
  w->at = pendres_parameter_get(w->parameter, &w->state.pendulum);
  if (status == PENDRES_OK && w->at == w->value[*i])
    pendres_path_put(w, (*i)++, &w->state.attractor);
  return status;
}

/* One step of the path: to value number *i, beyond it, or nearer to it. */
static pendres_status go_on(path *w, size_t *i)
{
  const size_t before = *i;
  pendres_arrival known = {.attractor = {.label = PENDRES_LABEL_UNRESOLVED}};
  pendres_status status = pendres_context_poll(w->ctx);
  if (status != PENDRES_OK || !w->settled)
    return status == PENDRES_OK ? settle_at(w, i, &known) : status;
  if (w->value[*i] == w->value[*i - 1]) {
    pendres_path_put(w, *i, &w->h->point[*i - 1].attractor);
    ++*i;
    return PENDRES_OK;
  }
  if (rotates_freely(&w->state.attractor)) return pendres_path_rotation(w, i);
  if (w->state.attractor.label == PENDRES_LABEL_ESCAPE) {
    stay_away(w, i);
    return PENDRES_OK;
  }
  if (pendres_path_short(w, &w->state.attractor)) status = pendres_path_orbit(w, i);
  /* What it has jumped to right before a value it is on there, too. */
  if (status == PENDRES_OK && *i == before &&
      w->state.attractor.label == PENDRES_LABEL_QUASI_PERIODIC)
    status = pendres_path_unlocked(w, i, &known);
  /* Nothing is left to settle if the pendulum has gone to a free rotation, or to infinity. */
  if (status != PENDRES_OK || *i > before || rotates_freely(&w->state.attractor) ||
      w->state.attractor.label == PENDRES_LABEL_ESCAPE)
    return status;
  return settle_at(w, i, &known);
}

/* Put the state in which the path is at value number `at`, if it is wanted. */
static void keep_state(path *w, pendres_path_left *left, size_t at, pendres_keeping *keep)
{
  int follows;
  if (at == 0 || at == w->n || !pendres_keeping_due(keep, (double)at / (double)w->n) ||
      !pendres_path_keeps(w))
    return;
  pendres_path_pass(pendres_keeping_write(keep), w, left, &at, &follows);
  pendres_keeping_put(keep);
}

static pendres_status follow_path(path *w, pendres_path_left *left, size_t at,
                                  pendres_keeping *keep)
{
  pendres_status status = PENDRES_OK;
  pendres_path_mark mark = pendres_path_mark_here(w);
  pendres_path_allow(w);
  for (size_t i = at; i < w->n && status == PENDRES_OK;) {
    status = go_on(w, &i);
    const int came = pendres_path_came(w, left, &mark, at, &status);
    if (!came) i = at;
    if (came && i == at) continue;
    w->settled = i > 0;
    at = i;
    if (status == PENDRES_OK) keep_state(w, left, at, keep);
    mark = pendres_path_mark_here(w);
    pendres_path_allow(w);
  }
  pendres_path_allow_all(w);
  return status;
}

/* ---- the call ---- */

static pendres_hysteresis *create(size_t n)
{
  pendres_hysteresis *h = calloc(1, sizeof *h);
  if (h == NULL) return NULL;
  h->count = n;
  h->point = calloc(n + 1, sizeof *h->point);
  h->part = calloc(n + 1, sizeof *h->part);
  for (size_t i = 0; i < n && h->point != NULL; i++) h->point[i].value = NAN; /* not reached */
  if (h->point != NULL && h->part != NULL) return h;
  pendres_hysteresis_free(h);
  return NULL;
}

static pendres_status open_path(path *w, pendres_path_left *left)
{
  *left = (pendres_path_left){.value = NULL};
  w->h = create(w->n);
  if (w->h == NULL)
    return pendres_context_fail(w->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu values",
                                w->n);
  return pendres_path_left_open(w, left);
}

/* All but the results. */
static void close_path(path *w, pendres_path_left *left)
{
  pendres_part_free(&w->part);
  pendres_path_unlocked_free(w);
  free(w->seen);
  pendres_path_left_close(left);
}

/* Go on from the state of an earlier process; begin anew where there is none of use. */
static pendres_status take_up(path *w, pendres_path_left *left, pendres_keeping *keep, size_t *at)
{
  const path fresh = *w;
  int follows = 0;
  pendres_status status = open_path(w, left);
  if (status != PENDRES_OK || !pendres_keeping_found(keep)) return status;
  pendres_path_pass(&keep->state, w, left, at, &follows);
  status = keep->state.status;
  if (status == PENDRES_OK && follows) status = pendres_part_again(w->ctx, w->parameter, &w->part);
  if (status == PENDRES_OK) pendres_keeping_taken(keep);
  if (status == PENDRES_OK || status == PENDRES_INTERRUPTED) return status;
  close_path(w, left);
  pendres_hysteresis_free(w->h);
  *w = fresh;
  *at = 0;
  return open_path(w, left);
}

pendres_status pendres_path_run(pendres_path *w, double x, double v, pendres_hysteresis **out)
{
  pendres_path_left left;
  size_t at = 0;
  w->state = (pendres_arrival){.x = x, .v = v};
  for (size_t i = 0; i < w->n; i++) {
    const char *why = NULL;
    const pendres_pendulum p = pendres_path_pendulum(w, w->value[i]);
    if (pendres_pendulum_check(&p, &why) == PENDRES_OK) why = pendres_equation_undamped(&p);
    if (why != NULL)
      return pendres_context_fail(w->ctx, PENDRES_INVALID_ARGUMENT, "value %zu of the path: %s", i,
                                  why);
  }
  pendres_keeping keep =
    pendres_keeping_begin(w->ctx, "hysteresis", pendres_path_question(w, x, v));
  pendres_status status = take_up(w, &left, &keep, &at);
  if (status == PENDRES_OK) status = follow_path(w, &left, at, &keep);
  pendres_keeping_end(&keep);
  if (status == PENDRES_OK || status == PENDRES_INTERRUPTED) {
    pendres_path_number(w, &left);
    pendres_status named = pendres_hysteresis_name(w->ctx, w->h);
    if (named == PENDRES_OK && pendres_model_of(w->pendulum.force)->period > 0.0)
      named = pendres_hysteresis_find_steps(w->ctx, w->h);
    if (named != PENDRES_OK) status = named;
  }
  if (status == PENDRES_OK || status == PENDRES_INTERRUPTED) *out = w->h;
  else pendres_hysteresis_free(w->h);
  close_path(w, &left);
  return status;
}

static pendres_status checked(pendres_context *ctx, const pendres_pendulum *p,
                              const pendres_state *start, const pendres_hysteresis_path *along,
                              int states_only, pendres_hysteresis **out)
{
  if (p == NULL || start == NULL || along == NULL || out == NULL ||
      (along->n > 0 && along->value == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "pendulum, start, path, its values and out");
  *out = NULL;
  const char *why = pendres_parameter_refuses(along->parameter, p->force);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
  path w = {.ctx = ctx, .pendulum = *p, .parameter = along->parameter, .all = along->value,
            .n = along->n, .value = along->value, .states_only = states_only};
  return pendres_path_run(&w, start->x, start->v, out);
}

static pendres_status find(pendres_context *ctx, const pendres_pendulum *p,
                           const pendres_state *start, const pendres_hysteresis_path *along,
                           int states_only, pendres_hysteresis **out)
{
  pendres_hysteresis_path inside = {.n = 0};
  if (along != NULL) inside = *along;
  pendres_door d = pendres_door_open_along(ctx, p, inside.parameter, inside.n, inside.value);
  PENDRES_DOOR_IN(&d, pendulum, 1, p);
  PENDRES_DOOR_IN(&d, state, 1, start);
  inside.value = pendres_door_in(&d, &pendres_dim_first, inside.n, inside.value);
  PENDRES_DOOR_CALL(&d, checked(ctx, p, start, along != NULL ? &inside : NULL, states_only,
                               out));
  if ((d.status == PENDRES_OK || d.status == PENDRES_INTERRUPTED) && *out != NULL) {
    pendres_units_out(&d.scales, &pendres_dim_hysteresis_point, (*out)->count, (*out)->point);
    pendres_units_out(&d.scales, &pendres_dim_jump, (*out)->jumps, (*out)->jump);
    pendres_units_out(&d.scales, &pendres_dim_step, (*out)->steps, (*out)->step);
  }
  return pendres_door_close(&d);
}

pendres_status pendres_hysteresis_find(pendres_context *ctx, const pendres_pendulum *p,
                                       const pendres_state *start,
                                       const pendres_hysteresis_path *along,
                                       pendres_hysteresis **out)
{
  return find(ctx, p, start, along, 0, out);
}

pendres_status pendres_hysteresis_states_find(pendres_context *ctx, const pendres_pendulum *p,
                                              const pendres_state *start,
                                              const pendres_hysteresis_path *along,
                                              pendres_hysteresis **out)
{
  return find(ctx, p, start, along, 1, out);
}
