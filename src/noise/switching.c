/* switching.c -- transitions between attractors and wells, and their rates; see switching.h. */
#include <pendres/rotation.h>
#include <pendres/switching.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/door.h"
#include "settling/attractor_internal.h"
#include "model/equation.h"
#include "model/model.h"
#include "noise/cores.h"
#include "noise/noise_common.h"

enum { STATES = PENDRES_SWITCHING_STATES, WELL = PENDRES_SWITCHING_WELL };

/* The state of a trajectory that has gone to infinity. */
enum { GONE = -1 };

/* ---- Counting ------------------------------------------------------------------------------ */

/* Where a trajectory belongs. */
typedef struct track {
  int state;
  long well;
  long since; /* periods since it was seen in the core of that */
} track;

typedef struct counting {
  pendres_cores cores;
  size_t states;
  size_t row;        /* numbers of a trajectory for each state: destinations, well, exposure */
  track *tracks;     /* [trajectory] */
  uint32_t *numbers; /* [trajectory][state][row] */
  double *x;         /* [2 trajectories] positions, velocities */
  uint64_t *ids;
  pendres_pendulum *pendulums;
  double passage[STATES][STATES + 1], absence2[STATES]; /* of the tally, */
  double forward[STATES], passed[STATES];               /* too */
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
         !(pendres_model_potential(p, x) > c->bottom);
}

static pendres_langevin_answer see(void *arg, const pendres_langevin_strobe *strobe)
{
  counting *c = arg;
  size_t left = strobe->count;
  for (size_t i = 0; i < strobe->count; i++) {
    track *t = &c->tracks[strobe->first + i];
    const size_t trajectory = strobe->first + i, from = (size_t)t->state;
    long well = PENDRES_NO_WELL;
    if (t->state == GONE) {
      left--;
      continue;
    }
    ++*number(c, trajectory, from, c->states + 1);
    t->since++;
    if (gone(c, strobe->x[i], strobe->v[i])) {
      ++*number(c, trajectory, from, c->states);
      c->passage[from][WELL] += (double)t->since;
      t->state = GONE;
      continue;
    }
    const pendres_core *s = pendres_cores_locate(&c->cores, strobe->x[i], strobe->v[i], &well);
    if (s == NULL) continue;
    const size_t to = (size_t)s->attractor;
    if (s->attractor != t->state || well != t->well) {
      ++*number(c, trajectory, from, to);
      c->passage[from][to] += (double)t->since;
    } else {
      c->absence2[from] += (double)t->since * (double)t->since;
    }
    if (well != t->well && well != PENDRES_NO_WELL && t->well != PENDRES_NO_WELL) {
      ++*number(c, trajectory, from, c->states);
      c->passage[from][WELL] += (double)t->since;
      c->forward[from] += well > t->well;
      c->passed[from] += (double)(labs(well - t->well) - 1);
    }
    *t = (track){.state = s->attractor, .well = well};
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
 * Whether pendulums may rotate on no closed orbit: as one of the set does, or as they would without
 * the drive where no rotation of the set is locked to it.
 */
static int rotates_elsewhere(const pendres_switching_request *q)
{
  pendres_pendulum p = q->pendulum;
  pendres_rotation rotation;
  int locked = 0;
  for (size_t i = 0; i < pendres_attractors_count(q->set); i++) {
    const pendres_attractor *a = pendres_attractors_get(q->set, i);
    if (a->orbit.period == 0 && a->label != PENDRES_LABEL_CHAOTIC) return 1;
    locked |= a->orbit.winding != 0;
  }
  if (locked || p.force != PENDRES_FORCE_PENDULUM || p.torque == 0.0) return 0;
  p.drive_amplitude = p.parametric_amplitude = p.temperature = 0.0;
  return pendres_rotation_find(&p, &rotation, NULL) == PENDRES_OK;
}

/* What is wrong with a request; NULL if nothing is. */
static const char *refuse(const pendres_switching_request *q)
{
  const pendres_attractor *a = pendres_attractors_get(q->set, q->from);
  if (a == NULL) return "there is no such attractor to start from";
  if (pendres_attractors_count(q->set) > STATES) return "there are too many attractors";
  if (!(q->core >= 0.0 && q->core <= 2.0)) return "core must be from 0 to 2";
  if (q->periods < 0) return "the number of periods must not be negative";
  if (a->orbit.period == 0)
    return "chaos, and a rotation without a lock, have no point to start from";
  if (!pendres_model_same(&a->orbit.pendulum, &q->pendulum))
    return "these are attractors of another pendulum";
  if (rotates_elsewhere(q))
    return "under this torque a pendulum may also rotate, on no closed orbit: one that leaves for "
           "such a rotation would not be counted as having left";
  const char *why = pendres_equation_refuses_drag(&q->pendulum);
  if (why != NULL || pendres_pendulum_leaves(&q->pendulum)) return why;
  return pendres_noise_refuses(&q->pendulum);
}

/* Take what n trajectories need. */
static void take_room(pendres_room *room, size_t n, counting *c)
{
  c->tracks = pendres_room_take(room, n, sizeof *c->tracks);
  c->numbers = pendres_room_take(room, n * c->states * c->row, sizeof *c->numbers);
  c->x = pendres_room_take(room, 2 * n, sizeof *c->x);
  c->ids = pendres_room_take(room, n, sizeof *c->ids);
  c->pendulums = pendres_room_take(room, n, sizeof *c->pendulums);
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
    c->tracks[i] = (track){(int)q->from, home->winding != 0 ? PENDRES_NO_WELL : 0, 0};
  }
  c->bottom = !pendres_pendulum_leaves(&q->pendulum)
                ? NAN
                : pendres_model_potential(&q->pendulum, home->x) -
                    switching_no_return * q->pendulum.temperature;
}

/* In which basins the trajectories end. */
static pendres_status look_at_ends(pendres_context *ctx, const pendres_switching_request *q,
                                   const counting *c, pendres_switching_tally *tally)
{
  const size_t all = q->trajectories;
  size_t n = 0;
  pendres_room room = pendres_room_open(ctx, "trajectories");
  pendres_settled *outcome = pendres_room_take(&room, all, sizeof *outcome);
  double *x = pendres_room_take(&room, all, sizeof *x);
  double *v = pendres_room_take(&room, all, sizeof *v);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < all; i++) {
    if (c->tracks[i].state == GONE || !(fabs(c->x[i]) <= pendres_farthest)) continue;
    x[n] = c->x[i];
    v[n++] = c->x[all + i];
  }
  const pendres_status status = pendres_attractors_settle(ctx, q->set, n, x, v, outcome);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    if (outcome[i].attractor >= 0) tally->ends[outcome[i].attractor] += 1.0;
  return pendres_room_close(&room, status);
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
  pendres_status status = pendres_cores_make(ctx, request->set, request->pendulum.temperature,
                                             request->core, &c.cores);
  if (status != PENDRES_OK) return status;
  pendres_room room = pendres_room_open(ctx, "trajectories");
  take_room(&room, n, &c);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  start(request, &c);
  const pendres_langevin_observer observer = {.see = see, .arg = &c};
  const pendres_langevin_run run = {.n = n, .pendulums = c.pendulums, .ids = c.ids,
                                    .periods = request->periods, .observer = &observer,
                                    .steps_per_period = request->steps_per_period,
                                    .unbounded = !isnan(c.bottom)};
  status = pendres_langevin_advance(ctx, &run, c.x, c.x + n);
  if (status != PENDRES_OK) return pendres_room_close(&room, status);
  tally->states = c.states;
  tally->period = two_pi / request->pendulum.drive_frequency;
  tally->trajectories = (double)n;
  sum_up(&c, n, tally);
  memcpy(tally->passage, c.passage, sizeof c.passage);
  memcpy(tally->absence2, c.absence2, sizeof c.absence2);
  memcpy(tally->forward, c.forward, sizeof c.forward);
  memcpy(tally->passed, c.passed, sizeof c.passed);
  return pendres_room_close(&room, look_at_ends(ctx, request, &c, tally));
}

pendres_status pendres_switching_count(pendres_context *ctx,
                                       const pendres_switching_request *request,
                                       pendres_switching_tally *tally)
{
  pendres_switching_request inside;
  pendres_door d = pendres_attractors_open(ctx, request != NULL ? request->set : NULL);
  if (request != NULL && pendres_door_changes(&d)) {
    inside = *request;
    inside.set = pendres_attractors_inside(&d, request->set);
    pendres_units_in(&d.scales, &pendres_dim_pendulum, 1, &inside.pendulum);
    request = &inside;
  }
  PENDRES_DOOR_OUT(&d, tally, 1, tally);
  return PENDRES_DOOR_END(&d, count(ctx, request, tally));
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
    into->ends[s] += other->ends[s];
    into->absence2[s] += other->absence2[s];
    into->forward[s] += other->forward[s];
    into->passed[s] += other->passed[s];
    for (size_t t = 0; t <= STATES; t++) {
      into->events[s][t] += other->events[s][t];
      into->events2[s][t] += other->events2[s][t];
      into->mixed[s][t] += other->mixed[s][t];
      into->passage[s][t] += other->passage[s][t];
    }
  }
}

/* ---- Rates --------------------------------------------------------------------------------- */

/* The variance of events - rate x exposure over trajectories, divided by what independent events
 * would have. */
static double dispersion(const pendres_switching_tally *y, size_t s, size_t t)
{
  const double events = y->events[s][t], n = y->trajectories;
  if (events < pendres_noise_fewest || n < pendres_noise_fewest) return NAN;
  const double rate = events / y->exposure[s];
  const double square =
    y->events2[s][t] - 2.0 * rate * y->mixed[s][t] + rate * rate * y->exposure2[s];
  return square * n / (n - 1.0) / events;
}

/* The share of transitions that is missed, and how much that may be off. */
typedef struct share {
  double value, error;
} share;

/*
 * A trajectory is seen on its new state only when it has come to the core, and may be back by then,
 * which for the exact rates are two transitions.
 *
 * Between two states with rates a and b the slowest decay of the shares, which is what a + b stands
 * for, is a root of F G = 1, F and G the Laplace transforms of the times until transitions there
 * and back. Such a time is a sum of absences u from the core, in each of which the same share of
 * trajectories leaves finally, and of a last one, the passage t. To first order a becomes
 * a / (1 - (a + b) late) with late = <t> - <u^2> / (2 <u>), the time since the transition.
 *
 * In a row of wells trajectories go on from where they were not seen, or back: by the directions of
 * those that are seen, a share of 2 p (1 - p) goes back, half of them without a tilt, and none
 * returns from infinity. Those that went on passed over a well, which shows how many there were:
 * each was one transition more, and two more were missed for each that went back. That is exact
 * where none passes over a well in one flight, as with much friction, although a trajectory needs
 * time to come down from the barrier, which `late` takes for time in which it can leave. With
 * little friction many do fly over wells, and `late` is the smaller account.
 */
static share missed(const pendres_switching_tally *y, size_t s, size_t t)
{
  const double events = y->events[s][t], rate = events / y->exposure[s];
  const double wells = y->events[s][WELL];
  double back = 0.0, again = NAN, chance = 0.0;
  if (!(events > 0.0)) return (share){0.0, 0.0};
  if (t != s && t != WELL) {
    back = y->exposure[t] > 0.0 ? y->events[t][s] / y->exposure[t] : 0.0;
  } else if (wells > 0.0) {
    const double p = y->forward[s] / wells, returns = 2.0 * p * (1.0 - p);
    const double each = (1.0 + 2.0 * returns / (1.0 - returns)) / wells;
    back = returns * rate;
    again = each * y->passed[s] / (1.0 + each * y->passed[s]);
    chance = each * sqrt(y->passed[s] + 1.0); /* none seen does not say that there are none */
  }
  const double late = y->passage[s][t] / events - 0.5 * y->absence2[s] / y->exposure[s];
  const double lost = fmin(fmax(0.0, late) * (rate + back), switching_most_missed);
  if (again < lost)
    return (share){again, hypot(again * fmax(switching_first_order, 0.5 * again),
                                fmin(chance, lost))};
  return (share){lost, lost * (lost < switching_most_missed
                                 ? fmax(switching_first_order, 0.5 * lost) : 1.0)};
}

pendres_status pendres_switching_rate_of(const pendres_switching_tally *tally, size_t s, size_t t,
                                         double level, pendres_switching_rate *rate)
{
  if (tally == NULL || rate == NULL || s >= STATES || t > STATES || !(level > 0.0 && level < 1.0))
    return PENDRES_INVALID_ARGUMENT;
  *rate = (pendres_switching_rate){.value = NAN, .error = NAN, .lower = NAN, .upper = NAN,
                                   .dispersion = NAN, .mean_time = NAN, .mean_time_error = NAN,
                                   .missed = NAN, .missed_error = NAN,
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
  const share lost = missed(tally, s, t);
  rate->value = i.value / (1.0 - lost.value);
  rate->lower = i.lower / (1.0 - lost.value) * (1.0 - lost.error);
  rate->upper = i.upper / (1.0 - lost.value) * (1.0 + lost.error);
  rate->error = i.error;
  rate->missed = lost.value;
  rate->missed_error = lost.error;
  if (rate->events > 0.0) {
    const double share = hypot(sqrt(d / rate->events), lost.error);
    rate->error = rate->value * share;
    rate->mean_time = 1.0 / rate->value;
    rate->mean_time_error = rate->mean_time * share;
  }
  return PENDRES_OK;
}
