/* ramp_watch.c -- when trajectories leave states; see ramp_watch.h. */
#include "analysis/sweeps/ramp_watch.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "continuation/parameter.h"
#include "engine/context_internal.h"
#include "analysis/sweeps/hysteresis_jump.h"
#include "analysis/sweeps/numbers.h"
#include "model/equation.h"
#include "model/model.h"

/* ---- what states look like ---- */

/* Whether anything follows the drive; else its frequency concerns the pendulum in nothing. */
static int driven(const pendres_ramp *r)
{
  return pendres_model_driven(&r->pendulum) || r->parameter == PENDRES_DRIVE_AMPLITUDE ||
         r->parameter == PENDRES_DRIVE_FREQUENCY ||
         r->parameter == PENDRES_PARAMETRIC_AMPLITUDE;
}

static pendres_ramp_reading reading_of(const pendres_ramp *r, const pendres_hysteresis_point *p)
{
  const pendres_orbit *o = &p->attractor.orbit;
  const int closed = pendres_attractor_closes(&p->attractor), locked = closed && driven(r);
  return (pendres_ramp_reading){
    .cosine = locked ? o->cosine[0] : closed ? o->x : NAN,
    .sine = locked ? o->sine[0] : closed ? 0.0 : NAN,
    .advance = closed ? two_pi * o->winding / o->period
                      : two_pi * p->mean_velocity / o->pendulum.drive_frequency};
}

/* The drive periods in which a state shows what it is: one of its own periods; at rest the time in
   which motions about it decay. */
static double own_time(const pendres_ramp *r, const pendres_hysteresis_point *p)
{
  const pendres_orbit *o = &p->attractor.orbit;
  const double turn = fabs(two_pi / reading_of(r, p).advance);
  if (pendres_attractor_closes(&p->attractor) && driven(r)) return o->period;
  if (isfinite(turn)) return driven(r) ? fmax(1.0, turn) : turn;
  const double decay = -o->period / log(hypot(o->multiplier_re[0], o->multiplier_im[0]));
  const double free = 1.0 / pendres_equation_shrinking(&o->pendulum);
  return driven(r) ? 1.0 : decay > 0.0 && isfinite(decay) ? decay : free;
}

/* How far a reading is on the way from the old state to the new one; 1 is half way. A first
   harmonic that is farther from the old state than the new one is has left it for a third. */
static double way_of(const pendres_ramp_gate *g, const pendres_ramp_reading *now)
{
  const pendres_ramp_reading *a = &g->before, *b = &g->after;
  if (g->by_advance)
    return 2.0 * (now->advance - a->advance) / (b->advance - a->advance);
  const double c = b->cosine - a->cosine, s = b->sine - a->sine, square = c * c + s * s;
  const double dc = now->cosine - a->cosine, ds = now->sine - a->sine;
  return fmax(2.0 * (dc * c + ds * s) / square, sqrt((dc * dc + ds * ds) / square));
}

/* Whether anything tells the two states of a gate apart, and over which time. */
static void measure(pendres_ramp_gate *g, const pendres_ramp *r)
{
  const pendres_hysteresis_point *old = &r->point[g->old.last], *new = &r->point[g->new.first];
  const pendres_ramp_reading a = reading_of(r, old), b = reading_of(r, new);
  const double apart = hypot(b.cosine - a.cosine, b.sine - a.sine);
  g->own = fmax(own_time(r, old), own_time(r, new));
  g->by_advance = fabs(b.advance - a.advance) * g->own > ramp_advance_apart;
  g->usable = g->by_advance || apart > ramp_harmonic_apart * fmax(hypot(a.cosine, a.sine),
                                                             hypot(b.cosine, b.sine));
}

/* Set up the gates, and count the legs of the path on the way. */
static void build(const pendres_ramp *r, pendres_ramp_gate *gate)
{
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
    pendres_ramp_gate *g = &gate[k];
    *g = (pendres_ramp_gate){.leg = leg, .direction = j->direction, .time = NAN, .parts = 1,
                             .old = {first, j->step - 1, first},
                             .new = {j->step, j->step, j->step}};
    const size_t end = k + 1 < r->jumps ? r->jump[k + 1].step : r->points;
    while (g->new.last + 1 < end && (r->point[g->new.last + 1].value -
                                     r->point[g->new.last].value) * j->direction >= 0.0)
      g->new.last++;
    /* Between two values of the path a state is not seen at all. */
    const int alone = first <= g->old.last && end > j->step;
    if (alone && !j->gradual) measure(g, r);
    first = j->step;
  }
}

/* What a state looks like at a value: between two points of the path or, beyond those on which it
   is seen, as at the last. */
static pendres_ramp_reading look(pendres_ramp_sight *s, const pendres_ramp *r, double value,
                                 int direction)
{
  const pendres_hysteresis_point *p = r->point;
  while (s->cursor + 1 < s->last && (p[s->cursor + 1].value - value) * direction < 0.0)
    s->cursor++;
  while (s->cursor > s->first && (p[s->cursor].value - value) * direction > 0.0) s->cursor--;
  const size_t next = s->cursor < s->last ? s->cursor + 1 : s->last;
  const pendres_ramp_reading a = reading_of(r, &p[s->cursor]), b = reading_of(r, &p[next]);
  const double length = p[next].value - p[s->cursor].value;
  double part = length != 0.0 ? (value - p[s->cursor].value) / length : 0.0;
  part = fmin(1.0, fmax(0.0, part));
  return (pendres_ramp_reading){.cosine = a.cosine + part * (b.cosine - a.cosine),
                                .sine = a.sine + part * (b.sine - a.sine),
                                .advance = a.advance + part * (b.advance - a.advance)};
}

static void look_up(pendres_ramp_gate *g, const pendres_ramp *r, double middle)
{
  const double value = pendres_ramp_value(r, middle);
  g->time = middle;
  g->before = look(&g->old, r, value, g->direction);
  g->after = look(&g->new, r, value, g->direction);
}

/* ---- trajectories ---- */

/* The windows in which a motion dies away. */
static long patience(const pendres_ramp_watch *w, const pendres_ramp_gate *g, double time)
{
  const pendres_ramp *r = w->ramp;
  const pendres_pendulum p =
    pendres_parameter_with(&r->pendulum, r->parameter, pendres_ramp_value(r, time));
  const double fading = 1.0 / pendres_equation_fading(&p);
  const double own = driven(r) ? 0.0 : ramp_own_times * g->own;
  return (long)fmin(1e6, ceil((fading + own) * (double)w->clock / (double)g->parts));
}

static void leave(pendres_ramp_watch *w, size_t i)
{
  pendres_ramp_watcher *o = &w->watcher[i];
  if (o->out > 0) w->time[o->gate * w->watchers + i] = o->left;
  o->gate++;
  o->armed = 0;
  o->out = 0;
  o->parts = 0;
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

/* Look at a window around a time. */
static void watch(pendres_ramp_watch *w, size_t i, pendres_ramp_gate *g, double middle,
                  const pendres_ramp_reading *now)
{
  pendres_ramp_watcher *o = &w->watcher[i];
  const double length = (double)g->parts / (double)w->clock;
  if (g->time != middle) look_up(g, w->ramp, middle);
  const double distance = way_of(g, now);
  if (distance < 1.0) {
    o->armed = 1;
    o->out = 0;
  } else if (o->armed) {
    if (o->out++ == 0)
      o->left = middle - length + length * (1.0 - o->distance) / (distance - o->distance);
    if (o->out > patience(w, g, middle)) leave(w, i);
  }
  o->distance = distance;
}

/* Add a part to a trajectory's window, and look at it when that is over. */
static void add(pendres_ramp_watch *w, size_t i, double end, const pendres_ramp_reading *part)
{
  pendres_ramp_watcher *o = &w->watcher[i];
  pendres_ramp_gate *g = next_gate(w, i);
  if (g == NULL || g->direction != w->direction) {
    o->parts = 0;
    return;
  }
  if (o->parts == 0) o->sum = (pendres_ramp_reading){0.0, 0.0, 0.0};
  o->sum.cosine += part->cosine;
  o->sum.sine += part->sine;
  o->sum.advance += part->advance;
  if (++o->parts < g->parts) return;
  const double n = (double)g->parts;
  const pendres_ramp_reading now = {o->sum.cosine / n, o->sum.sine / n,
                                    o->sum.advance / n * (double)w->clock};
  o->parts = 0;
  watch(w, i, g, end - 0.5 * n / (double)w->clock, &now);
}

/* The leg that a part belongs to. */
static void find_leg(pendres_ramp_watch *w, double middle)
{
  const pendres_ramp *r = w->ramp;
  if (middle * (double)w->clock < 1.0) { /* a block starts */
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
  const double end = (double)s->period / (double)w->clock;
  const int by_harmonic = driven(w->ramp);
  find_leg(w, end - 0.5 / (double)w->clock);
  for (size_t k = 0; k < s->count; k++) {
    pendres_ramp_watcher *o = &w->watcher[s->first + k];
    const pendres_ramp_reading part = {.cosine = by_harmonic ? s->cosine[k] : s->x[k],
                                       .sine = by_harmonic ? s->sine[k] : 0.0,
                                       .advance = s->x[k] - o->x};
    o->x = s->x[k];
    add(w, s->first + k, end, &part);
  }
}

void pendres_ramp_watch_end(pendres_ramp_watch *w)
{
  for (size_t i = 0; i < w->watchers; i++)
    while (w->watcher[i].gate < w->gates) leave(w, i);
}

/* ---- all of it ---- */

/* The parts of a drive period: the shortest window has one at least. */
static long clock_of(const pendres_ramp *r, const pendres_ramp_gate *gate)
{
  const double most = fmin(RAMP_MOST_STEPS, (double)UINT32_MAX / (double)pendres_ramp_periods(r));
  double shortest = 1.0;
  for (size_t k = 0; k < r->jumps && !driven(r); k++)
    if (gate[k].usable) shortest = fmin(shortest, gate[k].own);
  return (long)fmax(1.0, fmin(floor(most), ceil(1.0 / shortest)));
}

pendres_status pendres_ramp_watch_open(pendres_context *ctx, const pendres_ramp *ramp, size_t n,
                                       double *time, pendres_ramp_watch *out)
{
  *out = (pendres_ramp_watch){.ramp = ramp, .gates = ramp->jumps, .watchers = n, .time = time};
  for (size_t k = 0; k < ramp->jumps * n; k++) time[k] = NAN;
  out->gate = calloc(ramp->jumps + 1, sizeof *out->gate);
  out->watcher = calloc(n + 1, sizeof *out->watcher);
  if (out->gate == NULL || out->watcher == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory: %zu trajectories", n);
  build(ramp, out->gate);
  out->clock = clock_of(ramp, out->gate);
  for (size_t k = 0; k < ramp->jumps; k++)
    if (out->gate[k].usable)
      out->gate[k].parts = (long)fmax(1.0, ceil(out->gate[k].own * (double)out->clock - 1e-6));
  for (size_t i = 0; i < n; i++) out->watcher[i].x = ramp->point[0].x;
  return PENDRES_OK;
}

pendres_status pendres_ramp_watch_clock(pendres_context *ctx, const pendres_ramp *ramp,
                                        long *clock)
{
  pendres_ramp_watch w;
  const pendres_status status = pendres_ramp_watch_open(ctx, ramp, 0, NULL, &w);
  *clock = status == PENDRES_OK ? w.clock : 1;
  pendres_ramp_watch_close(&w);
  return status;
}

void pendres_ramp_watch_close(pendres_ramp_watch *w)
{
  free(w->gate);
  free(w->watcher);
}
