/* switching.c -- transitions between attractors and wells, and their rates; see switching.h. */
#include <pendres/rotation.h>
#include <pendres/switching.h>

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/door.h"
#include "orbits/attractor_internal.h"
#include "model/model.h"
#include "noise/noise_common.h"

enum { STATES = PENDRES_SWITCHING_STATES, WELL = PENDRES_SWITCHING_WELL };

/* A running trajectory has no well. */
static const long NO_WELL = LONG_MIN;

/* The state of a trajectory that has gone to infinity. */
enum { GONE = -1 };

/* So many temperatures below its attractor's potential, and where the force leads away, a
   trajectory counts as escaped: one of exp(30) would return. */
static const double no_return = 30.0;

/* With fewer events or fewer trajectories nothing is known of their scatter. */
static const double FEWEST = 10.0;

static const double DEFAULT_CORE = 0.5;

/* Positions beyond this are in no ellipse: double precision does not know where in a turn. */
static const double farthest = 1e15;

/* The shrunken ellipse around the strobe point of an attractor. */
typedef struct core_set {
  int attractor;
  int running;
  double x, v;
  double turn;       /* the period of the coordinate, which leads to the next well */
  double xx, xv, vv; /* P: inside, (z - z0)' P (z - z0) <= 1 with z = (x, v) */
} core_set;

typedef struct cores {
  size_t count;
  core_set core[STATES];
} cores;

static int make_core(const pendres_attractor *a, int number, double shrink, core_set *out)
{
  const double w = a->orbit.pendulum.drive_frequency, r = shrink * a->trap_radius;
  /* A chaotic attractor has no ellipse, and an orbit that is about to vanish one of size zero. */
  if (!(r > 0.0)) return 0;
  *out = (core_set){.attractor = number, .running = a->orbit.winding != 0, .x = a->orbit.x,
                    .v = a->orbit.v, .turn = pendres_model_turn(&a->orbit.pendulum),
                    .xx = a->trap_metric[0] / (r * r),
                    .xv = a->trap_metric[1] / (r * r * w),
                    .vv = a->trap_metric[2] / (r * r * w * w)};
  return 1;
}

static void make_cores(const pendres_attractors *set, double shrink, cores *out)
{
  const size_t n = pendres_attractors_count(set);
  out->count = 0;
  for (size_t i = 0; i < n && out->count < STATES; i++)
    out->count += (size_t)make_core(pendres_attractors_get(set, i), (int)i,
                                    shrink > 0.0 ? shrink : DEFAULT_CORE,
                                    &out->core[out->count]);
}

/* The core that holds a state, and the well that it is in; NULL if no core does. */
static inline const core_set *locate(const cores *c, double x, double v, long *well)
{
  if (!(fabs(x) <= farthest)) return NULL;
  for (size_t i = 0; i < c->count; i++) {
    const core_set *s = &c->core[i];
    const double turns = rint((x - s->x) / s->turn);
    const double dx = x - s->x - s->turn * turns, dv = v - s->v;
    if (!(s->xx * dx * dx + 2.0 * s->xv * dx * dv + s->vv * dv * dv <= 1.0)) continue;
    *well = s->running ? NO_WELL : (long)turns;
    return s;
  }
  return NULL;
}

void pendres_switching_locate(const pendres_attractors *set, double core, double x, double v,
                              int *attractor, long *well)
{
  cores c;
  long at = NO_WELL;
  make_cores(set, core, &c);
  const core_set *s = locate(&c, x, v, &at);
  if (attractor != NULL) *attractor = s != NULL ? s->attractor : -1;
  if (well != NULL) *well = at == NO_WELL ? 0 : at;
}

/* ---- Counting ------------------------------------------------------------------------------ */

/* Where a trajectory belongs. */
typedef struct track {
  int state;
  long well;
} track;

typedef struct counting {
  cores cores;
  size_t states;
  size_t row;        /* numbers of a trajectory for each state: destinations, well, exposure */
  track *tracks;     /* [trajectory] */
  uint32_t *numbers; /* [trajectory][state][row] */
  double *x;         /* [2 trajectories] positions, velocities */
  uint64_t *ids;
  pendres_pendulum *pendulums;
  double bottom;     /* outside, none returns from below this potential; NaN: none escapes */
} counting;

static uint32_t *number(const counting *c, size_t trajectory, size_t s, size_t column)
{
  return &c->numbers[(trajectory * c->states + s) * c->row + column];
}

/* Whether a trajectory has escaped for good; x and v may be infinite or NaN. */
static int gone(const counting *c, double x, double v)
{
  const pendres_pendulum *p = &c->pendulums[0];
  if (isnan(c->bottom)) return 0;
  if (!isfinite(x) || !isfinite(v)) return 1;
  return pendres_model_escapes(p, x - pendres_model_origin(p), v) &&
         !(pendres_pendulum_potential(p, x) > c->bottom);
}

static pendres_langevin_answer see(void *arg, const pendres_langevin_strobe *strobe)
{
  counting *c = arg;
  size_t left = strobe->count;
  for (size_t i = 0; i < strobe->count; i++) {
    track *t = &c->tracks[strobe->first + i];
    const size_t trajectory = strobe->first + i, from = (size_t)t->state;
    long well = NO_WELL;
    if (t->state == GONE) {
      left--;
      continue;
    }
    ++*number(c, trajectory, from, c->states + 1);
    if (gone(c, strobe->x[i], strobe->v[i])) {
      ++*number(c, trajectory, from, c->states);
      t->state = GONE;
      continue;
    }
    const core_set *s = locate(&c->cores, strobe->x[i], strobe->v[i], &well);
    if (s == NULL || (s->attractor == t->state && well == t->well)) continue;
    ++*number(c, trajectory, from, (size_t)s->attractor);
    if (well != t->well && well != NO_WELL && t->well != NO_WELL)
      ++*number(c, trajectory, from, c->states);
    *t = (track){s->attractor, well};
  }
  return left > 0 ? PENDRES_LANGEVIN_GO_ON : PENDRES_LANGEVIN_ENOUGH;
}

/* Sum up over trajectories. The numbers are whole, so that doubles are exact. */
static void sum_up(const counting *c, size_t trajectories, pendres_switching_tally *tally)
{
  for (size_t i = 0; i < trajectories; i++)
    for (size_t s = 0; s < c->states; s++) {
      const double time = *number(c, i, s, c->states + 1);
      tally->exposure[s] += time;
      tally->exposure2[s] += time * time;
      for (size_t t = 0; t <= c->states; t++) {
        const size_t column = t == c->states ? WELL : t;
        const double events = *number(c, i, s, t);
        tally->events[s][column] += events;
        tally->events2[s][column] += events * events;
        tally->mixed[s][column] += events * time;
      }
    }
}

/*
 * Whether pendulums may rotate, as they would without the drive, although the set has no rotation:
 * one that does not lock to the drive has no strobe point.
 */
static int rotates_elsewhere(const pendres_switching_request *q)
{
  pendres_pendulum p = q->pendulum;
  pendres_rotation rotation;
  if (p.force != PENDRES_FORCE_PENDULUM || p.torque == 0.0) return 0;
  for (size_t i = 0; i < pendres_attractors_count(q->set); i++)
    if (pendres_attractors_get(q->set, i)->orbit.winding != 0) return 0;
  p.drive_amplitude = p.parametric_amplitude = p.temperature = 0.0;
  return pendres_rotation_find(&p, &rotation, NULL) == PENDRES_OK;
}

/* What is wrong with a request; NULL if nothing is. */
static const char *refuse(const pendres_switching_request *q)
{
  const pendres_attractor *a = pendres_attractors_get(q->set, q->from);
  if (a == NULL) return "there is no such attractor to start from";
  if (pendres_attractors_count(q->set) > STATES) return "there are too many attractors";
  if (!(q->core >= 0.0 && q->core <= 1.0)) return "core must be from 0 to 1";
  if (q->periods < 0) return "the number of periods must not be negative";
  if (!isfinite(a->orbit.x) || !isfinite(a->orbit.v))
    return "a chaotic attractor has no point to start from";
  if (!pendres_model_same(&a->orbit.pendulum, &q->pendulum))
    return "these are attractors of another pendulum";
  if (rotates_elsewhere(q))
    return "under this torque a pendulum may also rotate, which is none of the attractors: what "
           "leaves them for good would count as staying";
  return pendres_pendulum_leaves(&q->pendulum) ? NULL : pendres_noise_refuses(&q->pendulum);
}

/* Memory for n trajectories; clear it in any case. */
static pendres_status make_counting(counting *c, size_t n)
{
  c->tracks = malloc((n + 1) * sizeof *c->tracks);
  c->numbers = calloc(n * c->states * c->row + 1, sizeof *c->numbers);
  c->x = malloc((2 * n + 1) * sizeof *c->x);
  c->ids = malloc((n + 1) * sizeof *c->ids);
  c->pendulums = malloc((n + 1) * sizeof *c->pendulums);
  if (c->tracks == NULL || c->numbers == NULL || c->x == NULL || c->ids == NULL ||
      c->pendulums == NULL)
    return PENDRES_OUT_OF_MEMORY;
  return PENDRES_OK;
}

static void clear_counting(counting *c)
{
  free(c->tracks);
  free(c->numbers);
  free(c->x);
  free(c->ids);
  free(c->pendulums);
}

/* Put every trajectory of a request at its attractor's strobe point. */
static void start(const pendres_switching_request *q, counting *c)
{
  const pendres_orbit *home = &pendres_attractors_get(q->set, q->from)->orbit;
  for (size_t i = 0; i < q->trajectories; i++) {
    c->x[i] = home->x;
    c->x[q->trajectories + i] = home->v;
    c->ids[i] = q->first_id + i;
    c->pendulums[i] = q->pendulum;
    c->tracks[i] = (track){(int)q->from, home->winding != 0 ? NO_WELL : 0};
  }
  c->bottom = !pendres_pendulum_leaves(&q->pendulum)
                ? NAN
                : pendres_pendulum_potential(&q->pendulum, home->x) -
                    no_return * q->pendulum.temperature;
}

static pendres_status count(pendres_context *ctx, const pendres_switching_request *request,
                            pendres_switching_tally *tally)
{
  if (request == NULL || tally == NULL) return PENDRES_CONTEXT_NULL(ctx, "request and tally");
  const size_t n = request->trajectories;
  const char *wrong = refuse(request);
  memset(tally, 0, sizeof *tally);
  if (wrong != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", wrong);
  counting c = {.states = pendres_attractors_count(request->set)};
  c.row = c.states + 2;
  make_cores(request->set, request->core, &c.cores);
  pendres_status status = make_counting(&c, n);
  if (status != PENDRES_OK) {
    status = pendres_context_fail(ctx, status, "out of memory for %zu trajectories", n);
    goto done;
  }
  start(request, &c);
  const pendres_langevin_observer observer = {.see = see, .arg = &c};
  const pendres_langevin_run run = {.n = n, .pendulums = c.pendulums, .ids = c.ids,
                                    .periods = request->periods, .observer = &observer,
                                    .steps_per_period = request->steps_per_period,
                                    .unbounded = !isnan(c.bottom)};
  status = pendres_langevin_advance(ctx, &run, c.x, c.x + n);
  if (status != PENDRES_OK) goto done;
  tally->states = c.states;
  tally->period = two_pi / request->pendulum.drive_frequency;
  tally->trajectories = (double)n;
  sum_up(&c, n, tally);
done:
  clear_counting(&c);
  return status;
}

pendres_status pendres_switching_count(pendres_context *ctx,
                                       const pendres_switching_request *request,
                                       pendres_switching_tally *tally)
{
  pendres_door d;
  pendres_switching_request inside;
  pendres_attractors_open(&d, ctx, request != NULL ? request->set : NULL);
  if (request != NULL && pendres_door_changes(&d)) {
    inside = *request;
    inside.set = pendres_attractors_inside(&d, request->set);
    pendres_units_in(&d.scales, &pendres_dim_pendulum, 1, &inside.pendulum);
    request = &inside;
  }
  tally = pendres_door_out(&d, &pendres_dim_tally, 1, tally);
  PENDRES_DOOR_CALL(&d, count(ctx, request, tally));
  return pendres_door_close(&d);
}

void pendres_switching_add(pendres_switching_tally *into, const pendres_switching_tally *other)
{
  if (into == NULL || other == NULL) return;
  into->states = other->states;
  into->period = other->period;
  into->trajectories += other->trajectories;
  for (size_t s = 0; s < STATES; s++) {
    into->exposure[s] += other->exposure[s];
    into->exposure2[s] += other->exposure2[s];
    for (size_t t = 0; t <= STATES; t++) {
      into->events[s][t] += other->events[s][t];
      into->events2[s][t] += other->events2[s][t];
      into->mixed[s][t] += other->mixed[s][t];
    }
  }
}

/* ---- Rates --------------------------------------------------------------------------------- */

/* The variance of events - rate x exposure over trajectories, divided by what independent events
 * would have. */
static double dispersion(const pendres_switching_tally *y, size_t s, size_t t)
{
  const double events = y->events[s][t], n = y->trajectories;
  if (events < FEWEST || n < FEWEST) return NAN;
  const double rate = events / y->exposure[s];
  const double square =
    y->events2[s][t] - 2.0 * rate * y->mixed[s][t] + rate * rate * y->exposure2[s];
  return square * n / (n - 1.0) / events;
}

pendres_status pendres_switching_rate_of(const pendres_switching_tally *tally, size_t s, size_t t,
                                         double level, pendres_switching_rate *rate)
{
  if (tally == NULL || rate == NULL || s >= STATES || t > STATES || !(level > 0.0 && level < 1.0))
    return PENDRES_INVALID_ARGUMENT;
  *rate = (pendres_switching_rate){.value = NAN, .error = NAN, .lower = NAN, .upper = NAN,
                                   .dispersion = NAN, .mean_time = NAN, .mean_time_error = NAN,
                                   .events = tally->events[s][t],
                                   .exposure = tally->exposure[s] * tally->period};
  if (!(rate->exposure > 0.0)) return PENDRES_OK;
  rate->dispersion = dispersion(tally, s, t);
  /* A burst of d events is one piece of information. */
  const double d = rate->dispersion > 1.0 ? rate->dispersion : 1.0;
  pendres_langevin_interval i;
  const pendres_status status =
    pendres_langevin_rate(rate->events / d, rate->exposure / d, level, &i);
  if (status != PENDRES_OK) return status;
  rate->value = i.value;
  rate->lower = i.lower;
  rate->upper = i.upper;
  if (rate->events > 0.0) {
    rate->mean_time = rate->exposure / rate->events;
    rate->mean_time_error = rate->mean_time * sqrt(d / rate->events);
  }
  rate->error = rate->events > 0.0 ? sqrt(rate->events * d) / rate->exposure : i.error;
  return PENDRES_OK;
}

/* ---- Leaving ------------------------------------------------------------------------------- */

void pendres_switching_leave(void *home, const pendres_langevin_strobe *strobe,
                             unsigned char *left)
{
  const pendres_switching_home *h = home;
  cores c;
  if (h == NULL || strobe == NULL || strobe->x == NULL || strobe->v == NULL ||
      left == NULL)
    return;
  make_cores(h->set, h->core, &c);
  for (size_t i = 0; i < strobe->count; i++) {
    long well = NO_WELL;
    const core_set *s = locate(&c, strobe->x[i], strobe->v[i], &well);
    if (s == NULL) continue;
    if (s->attractor != (int)h->attractor || (well != 0 && well != NO_WELL)) left[i] = 1;
  }
}
