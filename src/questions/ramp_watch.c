/* ramp_watch.c -- when trajectories leave states; see ramp_watch.h. */
#include "questions/ramp_watch.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "continuation/continuation_parameter.h"
#include "engine/context_internal.h"
#include "questions/hysteresis_jump.h"

/* States whose mean velocities differ by more, in radians a period, are told apart by these. */
static const double advance_apart = 0.5;
/* States whose first harmonics are closer are not told apart by these. */
static const double harmonic_apart = 1e-3;

/* ---- what states look like ---- */

static pendres_ramp_reading reading_of(const pendres_hysteresis_point *p)
{
  const pendres_orbit *o = &p->attractor.orbit;
  const int closed = pendres_settled_closed(&p->attractor);
  return (pendres_ramp_reading){
    .cosine = closed ? o->cosine[0] : NAN, .sine = closed ? o->sine[0] : NAN,
    .advance = closed ? two_pi * o->winding / o->period
                      : two_pi * p->mean_velocity / o->pendulum.drive_frequency};
}

static double apart(const pendres_ramp_gate *g, const pendres_ramp_reading *a,
                    const pendres_ramp_reading *b)
{
  return g->by_advance ? fabs(a->advance - b->advance)
                       : hypot(a->cosine - b->cosine, a->sine - b->sine);
}

/* How far the two states of a gate are apart, if anything tells them apart. */
static void measure(pendres_ramp_gate *g, const pendres_ramp *r)
{
  const pendres_ramp_reading old = reading_of(&r->point[g->last]);
  const pendres_ramp_reading new = reading_of(&r->point[g->last + 1]);
  g->by_advance = fabs(new.advance - old.advance) > advance_apart;
  g->half = 0.5 * apart(g, &old, &new);
  g->usable = g->half > (g->by_advance ? 0.0 : 0.5 * harmonic_apart);
}

/* Set up the gates, and count the legs of the path on the way. */
static void build(pendres_ramp_watch *w)
{
  const pendres_ramp *r = w->ramp;
  size_t leg = 0, step = 1, first = 0;
  int direction = 0;
  for (size_t k = 0; k < r->jumps; k++) {
    const pendres_jump *j = &r->jump[k];
    for (; step <= j->step && step < r->points; step++) {
      const double moved = r->point[step].value - r->point[step - 1].value;
      const int way = (moved > 0.0) - (moved < 0.0);
      if (way * direction < 0) {
        leg++;
        first = step - 1;
      }
      if (way != 0) direction = way;
    }
    pendres_ramp_gate *g = &w->gate[k];
    *g = (pendres_ramp_gate){.leg = leg, .direction = j->direction, .first = first,
                             .cursor = first, .last = j->step - 1, .period = NAN};
    /* Between two values of the path a state is not seen at all. */
    const int alone = first <= g->last && (k + 1 == r->jumps || r->jump[k + 1].step > j->step);
    if (alone && !j->gradual) measure(g, r);
    first = j->step;
  }
}

/* Find what the old state looks like in the middle of a period, between two points of the path. */
static void look_up(pendres_ramp_gate *g, const pendres_ramp *r, double middle)
{
  const double value = pendres_ramp_value(r, middle);
  const pendres_hysteresis_point *p = r->point;
  g->period = middle;
  while (g->cursor + 1 < g->last && (p[g->cursor + 1].value - value) * g->direction < 0.0)
    g->cursor++;
  while (g->cursor > g->first && (p[g->cursor].value - value) * g->direction > 0.0) g->cursor--;
  const size_t next = g->cursor < g->last ? g->cursor + 1 : g->last;
  const pendres_ramp_reading a = reading_of(&p[g->cursor]), b = reading_of(&p[next]);
  const double length = p[next].value - p[g->cursor].value;
  double part = length != 0.0 ? (value - p[g->cursor].value) / length : 0.0;
  part = fmin(1.0, fmax(0.0, part));
  g->old.cosine = a.cosine + part * (b.cosine - a.cosine);
  g->old.sine = a.sine + part * (b.sine - a.sine);
  g->old.advance = a.advance + part * (b.advance - a.advance);
}

/* ---- trajectories ---- */

/* The number of periods in which a motion dies away, at the end of a leg. */
static long patience(const pendres_ramp *r, double time)
{
  const pendres_pendulum p =
    pendres_parameter_with(&r->pendulum, r->parameter, pendres_ramp_value(r, time));
  return (long)fmin(1e6, ceil(2.0 * p.drive_frequency / (p.damping * two_pi)));
}

static void leave(pendres_ramp_watch *w, size_t i)
{
  pendres_ramp_watcher *o = &w->watcher[i];
  if (o->out > 0) w->time[o->gate * w->watchers + i] = o->left;
  o->gate++;
  o->armed = 0;
  o->out = 0;
}

/* The next gate of a trajectory: those of legs that are over are given up, and those that tell
   nothing are left out. */
static pendres_ramp_gate *next_gate(pendres_ramp_watch *w, size_t i)
{
  pendres_ramp_watcher *o = &w->watcher[i];
  while (o->gate < w->gates) {
    pendres_ramp_gate *g = &w->gate[o->gate];
    if (g->usable && g->leg >= w->leg) return g->leg == w->leg ? g : NULL;
    leave(w, i);
  }
  return NULL;
}

static void watch(pendres_ramp_watch *w, size_t i, double middle, long patient,
                  const pendres_ramp_reading *now)
{
  pendres_ramp_watcher *o = &w->watcher[i];
  pendres_ramp_gate *g = next_gate(w, i);
  if (g == NULL || g->direction != w->direction) return;
  if (g->period != middle) look_up(g, w->ramp, middle);
  const double distance = apart(g, now, &g->old) / g->half;
  if (distance < 1.0) {
    o->armed = 1;
    o->out = 0;
  } else if (o->armed) {
    if (o->out++ == 0)
      o->left = middle - 1.0 + (1.0 - o->distance) / (distance - o->distance);
    if (o->out > patient) leave(w, i);
  }
  o->distance = distance;
}

/* The leg that a period belongs to. */
static void find_leg(pendres_ramp_watch *w, double middle)
{
  const pendres_ramp *r = w->ramp;
  if (middle < 1.0) { /* a block starts */
    w->corner = 1;
    w->leg = 0;
    w->direction = 0;
  } else if (middle < (double)r->period[w->corner]) {
    return;
  } else if (w->corner + 1 < r->corners) {
    w->corner++;
  }
  const double moved = r->value[w->corner] - r->value[w->corner - 1];
  const int way = (moved > 0.0) - (moved < 0.0);
  if (way * w->direction < 0) w->leg++;
  if (way != 0) w->direction = way;
}

void pendres_ramp_watch_see(pendres_ramp_watch *w, const pendres_langevin_strobe *s)
{
  const double middle = (double)s->period - 0.5;
  const long patient = patience(w->ramp, middle);
  find_leg(w, middle);
  for (size_t k = 0; k < s->count; k++) {
    pendres_ramp_watcher *o = &w->watcher[s->first + k];
    const pendres_ramp_reading now = {
      .cosine = s->cosine[k], .sine = s->sine[k], .advance = s->x[k] - o->x};
    o->x = s->x[k];
    watch(w, s->first + k, middle, patient, &now);
  }
}

void pendres_ramp_watch_end(pendres_ramp_watch *w)
{
  for (size_t i = 0; i < w->watchers; i++)
    while (w->watcher[i].gate < w->gates) leave(w, i);
}

/* ---- all of it ---- */

pendres_status pendres_ramp_watch_open(pendres_context *ctx, const pendres_ramp *ramp, size_t n,
                                       double *time, pendres_ramp_watch *out)
{
  *out = (pendres_ramp_watch){.ramp = ramp, .gates = ramp->jumps, .watchers = n, .time = time};
  for (size_t k = 0; k < ramp->jumps * n; k++) time[k] = NAN;
  out->gate = calloc(ramp->jumps + 1, sizeof *out->gate);
  out->watcher = calloc(n + 1, sizeof *out->watcher);
  if (out->gate == NULL || out->watcher == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory: %zu trajectories", n);
  build(out);
  for (size_t i = 0; i < n; i++) out->watcher[i].x = ramp->point[0].x;
  return PENDRES_OK;
}

void pendres_ramp_watch_close(pendres_ramp_watch *w)
{
  free(w->gate);
  free(w->watcher);
}
