/*
 * hysteresis_steps.c -- steps, on which rotations are locked to the drive; see hysteresis_steps.h.
 *
 * The path is gone along once. While the pendulum stays on locks of one mean velocity, the interval
 * grows that it has met them on; an end of it is one of the step if the pendulum leaves the step
 * there. Intervals that overlap, such as those of the way up and of the way down, are one step.
 */
#include "analysis/sweeps/hysteresis_steps.h"

#include <math.h>
#include <stdlib.h>

#include "base/grow.h"
#include "engine/context_internal.h"

/* The path on its way. */
typedef struct walk {
  pendres_context *ctx;
  pendres_hysteresis *h;
  int on; /* whether it is on the last of the steps */
} walk;

static int greatest_factor(int a, int b)
{
  while (b != 0) {
    const int rest = a % b;
    a = b;
    b = rest;
  }
  return abs(a);
}

/* Whether the present step is that of an orbit with these numbers. */
static int is_on(const walk *w, int period, int winding)
{
  if (!w->on || period == 0) return 0;
  const pendres_step *s = &w->h->step[w->h->steps - 1];
  return (long)winding * s->period == (long)s->winding * period;
}

/* Come to an orbit, or to none that is locked (period 0), at a value of the parameter. */
static pendres_status arrive(walk *w, int period, int winding, double value, double error)
{
  pendres_hysteresis *h = w->h;
  if (is_on(w, period, winding)) return PENDRES_OK;
  w->on = period > 0;
  if (!w->on) return PENDRES_OK;
  pendres_step *grown = pendres_grow(h->step, h->steps, &h->step_room, sizeof *h->step);
  if (grown == NULL)
    return pendres_context_fail(w->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for steps");
  h->step = grown;
  const int factor = greatest_factor(winding, period);
  h->step[h->steps++] = (pendres_step){
    .winding = winding / factor, .period = period / factor, .lower_end = PENDRES_STEP_END_SEEN,
    .upper_end = PENDRES_STEP_END_SEEN, .lower = value, .lower_error = error, .upper = value,
    .upper_error = error};
  return PENDRES_OK;
}

/* The present step reaches as far as this value, at least. */
static void reach(pendres_step *s, double value, double error)
{
  if (value < s->lower) {
    s->lower = value;
    s->lower_error = error;
  }
  if (value > s->upper) {
    s->upper = value;
    s->upper_error = error;
  }
}

static pendres_status jump_over(walk *w, const pendres_jump *j)
{
  const double value = j->value, error = j->value_error;
  /* What ends may be what a lock has given way to between two jumps. */
  const int held = j->from != PENDRES_LABEL_CHAOTIC && j->from != PENDRES_LABEL_QUASI_PERIODIC &&
                   j->from != PENDRES_LABEL_UNRESOLVED;
  if (w->on && held) {
    const int leaves = !is_on(w, j->to_period, j->to_winding);
    pendres_step *s = &w->h->step[w->h->steps - 1];
    reach(s, value, error);
    if (leaves && j->direction > 0 && value >= s->upper) s->upper_end = PENDRES_STEP_END_LEFT;
    if (leaves && j->direction < 0 && value <= s->lower) s->lower_end = PENDRES_STEP_END_LEFT;
  }
  return arrive(w, j->to_period, j->to_winding, value, error);
}

static pendres_status pass(walk *w, const pendres_hysteresis_point *p)
{
  const pendres_orbit *o = &p->attractor.orbit;
  if (p->attractor.label == PENDRES_LABEL_UNRESOLVED) return PENDRES_OK; /* left out */
  const pendres_status status = arrive(w, o->period, o->winding, p->value, 0.0);
  if (status == PENDRES_OK && w->on) reach(&w->h->step[w->h->steps - 1], p->value, 0.0);
  return status;
}

/* ---- steps that were met more than once ---- */

/* By mean velocity, then by value. */
static int in_order(const void *a, const void *b)
{
  const pendres_step *s = a, *t = b;
  const long left = (long)s->winding * t->period, right = (long)t->winding * s->period;
  if (left != right) return left < right ? -1 : 1;
  return (s->lower > t->lower) - (s->lower < t->lower);
}

/* Whether one end is beyond another one, or is the same with more known of it. `side` is 1 of upper
   ends and -1 of lower ones. */
static int further(double value, double error, pendres_step_end end, const double other[2],
                   pendres_step_end of_other, int side)
{
  const double beyond = (value - other[0]) * side;
  if (fabs(beyond) > error + other[1]) return beyond > 0.0;
  return end == PENDRES_STEP_END_LEFT &&
         (of_other != PENDRES_STEP_END_LEFT || error < other[1]);
}

static void unite(pendres_step *s, const pendres_step *with)
{
  const double lower[2] = {s->lower, s->lower_error}, upper[2] = {s->upper, s->upper_error};
  if (further(with->lower, with->lower_error, with->lower_end, lower, s->lower_end, -1)) {
    s->lower = with->lower;
    s->lower_error = with->lower_error;
    s->lower_end = with->lower_end;
  }
  if (further(with->upper, with->upper_error, with->upper_end, upper, s->upper_end, 1)) {
    s->upper = with->upper;
    s->upper_error = with->upper_error;
    s->upper_end = with->upper_end;
  }
}

static void unite_all(pendres_hysteresis *h)
{
  size_t n = 0;
  if (h->steps > 0) qsort(h->step, h->steps, sizeof *h->step, in_order);
  for (size_t i = 0; i < h->steps; i++) {
    const pendres_step *next = &h->step[i];
    pendres_step *s = n > 0 ? &h->step[n - 1] : NULL;
    if (s != NULL && s->winding == next->winding && s->period == next->period &&
        next->lower - s->upper <= next->lower_error + s->upper_error)
      unite(s, next);
    else
      h->step[n++] = *next;
  }
  h->steps = n;
}

/* What ends at the path's first or last value is cut there; what has both ends has a width. */
static void finish(pendres_step *s, double least, double most)
{
  const int whole =
    s->lower_end == PENDRES_STEP_END_LEFT && s->upper_end == PENDRES_STEP_END_LEFT;
  if (s->lower_end != PENDRES_STEP_END_LEFT && s->lower <= least)
    s->lower_end = PENDRES_STEP_END_RANGE;
  if (s->upper_end != PENDRES_STEP_END_LEFT && s->upper >= most)
    s->upper_end = PENDRES_STEP_END_RANGE;
  s->width = whole ? s->upper - s->lower : NAN;
  s->width_error = whole ? s->upper_error + s->lower_error : NAN;
}

pendres_status pendres_hysteresis_find_steps(pendres_context *ctx, pendres_hysteresis *h)
{
  walk w = {.ctx = ctx, .h = h};
  double least = INFINITY, most = -INFINITY;
  size_t k = 0;
  for (size_t i = 0; i < h->count; i++) {
    for (; k < h->jumps && h->jump[k].step <= i; k++) {
      const pendres_status status = jump_over(&w, &h->jump[k]);
      if (status != PENDRES_OK) return status;
    }
    const pendres_status status = pass(&w, &h->point[i]);
    if (status != PENDRES_OK) return status;
    least = fmin(least, h->point[i].value);
    most = fmax(most, h->point[i].value);
  }
  unite_all(h);
  for (size_t i = 0; i < h->steps; i++) finish(&h->step[i], least, most);
  return PENDRES_OK;
}
