/* hysteresis_circle.c -- a pendulum on invariant circles; see hysteresis_circle.h. */
#include "analysis/sweeps/hysteresis_circle.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "continuation/parameter.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "analysis/chaos/lyapunov_move.h"

enum {
  MOST = 64,  /* values at a time */
  FURTHER = 3 /* how often to try ten times as far beyond a fold */
};

/* Distances beyond a fold, in the parameter's scale: where a pendulum counts as having left, and
   where it moves so fast that its points show the circle. */
static const double beyond = 1e-4, well_beyond = 0.03;
/* An orbit this close to a circle is taken to lie on it. */
static const double on_it = 1e-6;

static pendres_status open_circles(pendres_path *w)
{
  pendres_circle_family family = {.pendulum = w->pendulum, .parameter = w->parameter,
                                  .tolerance = pendres_accuracy_of_circles(w->ctx)};
  double low = INFINITY, high = -INFINITY;
  if (w->circles != NULL) return PENDRES_OK;
  for (size_t i = 0; i < w->n; i++) {
    low = fmin(low, w->value[i]);
    high = fmax(high, w->value[i]);
  }
  return pendres_circles_create(w->ctx, &family, low, high, &w->circles);
}

/* The attractor of a pendulum on a circle without a lock. */
static void take_unlocked(const pendres_path *w, const pendres_circles_verdict *v,
                          pendres_settled *out)
{
  const pendres_pendulum p = pendres_path_pendulum(w, v->value);
  *out = pendres_settled_nothing_at(&p, v->x, v->v);
  if (v->turn.motion != PENDRES_CIRCLE_UNLOCKED) return;
  out->attractor.label = PENDRES_LABEL_QUASI_PERIODIC;
  out->attractor.lyapunov = 0.0;
  out->attractor.lyapunov_error = fabs(v->turn.growth) * p.drive_frequency / two_pi;
  out->attractor.drift = v->turn.turns;
  out->attractor.drift_error = v->turn.turns_error;
}

/* The orbits of those of n verdicts that are locked; found is 0 where there is none. */
static pendres_status find_locks(const pendres_path *w, size_t n,
                                 const pendres_circles_verdict *v, pendres_orbit *orbit, int *found)
{
  pendres_orbit_guess guess[MOST];
  pendres_orbit got[MOST];
  pendres_status outcome[MOST];
  size_t count = 0, k = 0;
  for (size_t i = 0; i < n; i++)
    if (v[i].turn.motion == PENDRES_CIRCLE_LOCKED)
      guess[count++] = (pendres_orbit_guess){
        .pendulum = pendres_path_pendulum(w, v[i].value), .x = v[i].x, .v = v[i].v,
        .period = v[i].turn.period, .winding = v[i].turn.winding};
  if (count == 0) return PENDRES_OK;
  const pendres_status status =
    pendres_orbit_find(w->ctx, count, guess, PENDRES_ORBIT_PLAIN, got, outcome);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    if (v[i].turn.motion != PENDRES_CIRCLE_LOCKED) continue;
    orbit[i] = got[k];
    found[i] = outcome[k] != PENDRES_NOT_CONVERGED && got[k].stable &&
               got[k].period == guess[k].period && got[k].winding == guess[k].winding;
    k++;
  }
  return status;
}

/* The motion on the circle differs from that at the last value: find where it changes. As long as
   the circle lasts, locks are born and end by folds. */
static pendres_status note_change(pendres_path *w, size_t step, const pendres_circles_verdict *v,
                                  const pendres_attractor *a)
{
  const pendres_circles_verdict last = w->last;
  const int was = last.turn.motion == PENDRES_CIRCLE_LOCKED;
  const int is = v->turn.motion == PENDRES_CIRCLE_LOCKED;
  if (v->turn.motion == PENDRES_CIRCLE_UNKNOWN) return PENDRES_OK;
  w->last = *v;
  if (!was && !is) return PENDRES_OK;
  if (was && is && last.turn.period == v->turn.period && last.turn.winding == v->turn.winding)
    return PENDRES_OK;
  pendres_jump j = {.step = step, .direction = v->value > last.value ? 1 : -1,
                    .kind = PENDRES_JUMP_FOLD,
                    .from = was ? PENDRES_LABEL_RUNNING : PENDRES_LABEL_QUASI_PERIODIC,
                    .to = a->label, .to_period = is ? v->turn.period : 0,
                    .share = 1.0, .certain = 1};
  pendres_circles_end end;
  const pendres_circles_verdict *in = was ? &last : v, *out = was ? v : &last;
  pendres_status status = pendres_circles_edge(w->circles, &in->turn, in->value, out->value,
                                               &end);
  j.value = end.value;
  j.value_error = end.error;
  if (!end.found) {
    j.value = 0.5 * (v->value + last.value);
    j.value_error = 0.5 * fabs(v->value - last.value);
  }
  if (status == PENDRES_OK) status = pendres_path_note(w, &j);
  pendres_path_leave(w);
  return status;
}

/* A circle is known at a value, or can be found. */
static pendres_status is_known(pendres_path *w, double value, pendres_circles_verdict *out)
{
  pendres_status status = open_circles(w);
  if (status == PENDRES_OK) status = pendres_circles_tell(w->circles, value, out);
  if (status != PENDRES_OK || out->found || w->on_circle) return status;
  if (w->state.attractor.label != PENDRES_LABEL_QUASI_PERIODIC) return status;
  status = pendres_circles_begin(w->circles, w->at, w->state.x, w->state.v);
  return status == PENDRES_OK ? pendres_circles_tell(w->circles, value, out) : status;
}

pendres_status pendres_path_circle(pendres_path *w, size_t *i)
{
  pendres_circles_verdict v[MOST];
  pendres_orbit orbit[MOST];
  int found[MOST] = {0};
  size_t n = 0;
  pendres_status status = is_known(w, w->value[*i], &v[0]);
  if (status != PENDRES_OK || !v[0].found) {
    w->on_circle = 0;
    return status;
  }
  if (!w->on_circle) {
    w->last = v[0];
    w->last.value = w->at;
    w->last.turn.motion = PENDRES_CIRCLE_UNLOCKED;
  }
  w->on_circle = 1;
  for (n = 1; n < MOST && *i + n < w->n && status == PENDRES_OK; n++) {
    status = pendres_circles_tell(w->circles, w->value[*i + n], &v[n]);
    if (!v[n].found) break;
  }
  if (status == PENDRES_OK) status = find_locks(w, n, v, orbit, found);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++, (*i)++) {
    const int locked = v[k].turn.motion == PENDRES_CIRCLE_LOCKED;
    if (locked && !found[k]) {
      w->on_circle = 0;
      break;
    }
    pendres_settled next;
    take_unlocked(w, &v[k], &next);
    if (locked) {
      next.attractor = pendres_settled_orbit(&orbit[k]);
      next.x = orbit[k].x;
      next.v = orbit[k].v;
    }
    status = note_change(w, *i, &v[k], &next.attractor);
    w->state = next;
    w->at = v[k].value;
    pendres_path_put(w, *i, &next.attractor);
  }
  return status;
}

pendres_status pendres_path_onto_circle(pendres_path *w, const pendres_bifurcation *end,
                                        int direction, pendres_jump *jump, int *done)
{
  const double scale = pendres_parameter_scale(w->parameter);
  const pendres_orbit *o = &end->orbit;
  pendres_circles_verdict v = {0};
  double distance = beyond * scale, off = INFINITY;
  *done = 0;
  if (end->kind != PENDRES_FOLD || !pendres_lyapunov_may_rotate(&o->pendulum)) return PENDRES_OK;
  pendres_status status = open_circles(w);
  if (status != PENDRES_OK) return status;
  status = pendres_circles_tell(
    w->circles, pendres_parameter_beyond(w->parameter, end->value, direction * distance), &v);
  if (status == PENDRES_OK && !v.found) {
    const double there =
      pendres_parameter_beyond(w->parameter, end->value, direction * well_beyond * scale);
    status = pendres_circles_begin(w->circles, there, o->x, o->v);
  }
  if (status == PENDRES_OK)
    status = pendres_circles_distance(w->circles, end->value, o->x, o->v, &off);
  if (status != PENDRES_OK || !(off < on_it)) return status;
  for (int k = 0; k < FURTHER && status == PENDRES_OK; k++, distance *= 10.0) {
    status = pendres_circles_tell(
      w->circles, pendres_parameter_beyond(w->parameter, end->value, direction * distance), &v);
    if (v.found && v.turn.motion == PENDRES_CIRCLE_UNLOCKED) break;
  }
  if (status != PENDRES_OK || !v.found || v.turn.motion != PENDRES_CIRCLE_UNLOCKED) return status;
  take_unlocked(w, &v, &w->state);
  w->at = v.value;
  w->last = v;
  w->on_circle = *done = 1;
  jump->to = w->state.attractor.label;
  jump->to_period = 0;
  jump->share = 1.0;
  jump->certain = 1;
  return status;
}
