/* lyapunov_caught.c -- orbits that pendulums have come close to; see lyapunov_caught.h. */
#include "settling/exponents/lyapunov_caught.h"

#include <math.h>
#include <stdint.h>

#include "settling/exponents/numbers.h"
#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/kernels/coordinates.h"
#include "engine/room.h"
#include "model/model.h"
#include "orbits/orbit_pair.h"
#include "orbits/orbit_prime.h"

typedef pendres_lyapunov_job job;

/* A caught runner, or an orbit that is known. */
typedef struct caught {
  pendres_runner *runner; /* NULL: of the orbit that pendulums are on which have copies */
  size_t index;           /* in the job; of known orbits that of the first copy */
  int period, winding;
  long began;              /* the period at which it was caught */
  pendres_strobe_lane at;  /* where it was caught; of copies at their orbit's largest velocity */
  size_t like;             /* which of the caught ones stands for its orbit: itself, or another */
  const pendres_orbit *on; /* NULL: there is none that attracts it */
} caught;

/* All of them, and room for their orbits. */
typedef struct caught_list {
  size_t n;
  caught *at; /* twice as many as are caught */
  pendres_orbit_guess *guess;
  pendres_orbit *orbit;
  pendres_status *outcome;
} caught_list;

void pendres_lyapunov_take_orbit(const pendres_orbit *o, pendres_settled *out)
{
  const double modulus = hypot(o->multiplier_re[0], o->multiplier_im[0]);
  const double time = two_pi * o->period / o->pendulum.drive_frequency;
  *out = (pendres_settled){
    .label = o->winding != 0 ? PENDRES_LABEL_RUNNING : PENDRES_LABEL_PERIODIC,
    .exponent = log(modulus) / time,
    .exponent_error = o->multiplier_error / (modulus * time),
    .rotation = (double)o->winding / o->period,
    .rotation_error = last_place_of_one * fabs((double)o->winding / o->period),
    .period = o->period,
    .winding = o->winding};
}

/* The distance from a lane's state, whole turns aside. */
static double apart(const pendres_strobe_lane *l, double y, double w)
{
  return hypot(pendres_less_turns(y - l->y, pendres_model_turn(l->pendulum)), w - l->w);
}

static int is_near(const pendres_orbit *o, const pendres_strobe_lane *l)
{
  return apart(l, o->x - pendres_model_origin(l->pendulum),
               o->v / o->pendulum.drive_frequency) < orbit_another;
}

/* Among the bands of chaos points come back next to orbits of many periods whose multipliers may
   not be known well enough to say that they attract. */
static int is_surely_stable(const pendres_orbit *o)
{
  return hypot(o->multiplier_re[0], o->multiplier_im[0]) + o->multiplier_error < 1.0;
}

/* ---- copies of a pendulum ---- */

static int visit(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  caught *c = (caught *)arg + index;
  if (lane->w > c->at.w) c->at = *lane;
  return lane->period - c->began >= c->period - 1;
}

/* Take copies to one phase of their orbits, that of the largest velocity. */
static pendres_status to_one_phase(pendres_context *ctx, const caught_list *l)
{
  const size_t n = l->n;
  size_t count = 0;
  pendres_room room = pendres_room_open(ctx, "lanes");
  pendres_strobe_lane *lanes = pendres_room_take(&room, n, sizeof *lanes);
  size_t *which = pendres_room_take(&room, n, sizeof *which);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t k = 0; k < n; k++) {
    lanes[k] = l->at[k].at;
    if (l->at[k].period > 1) which[count++] = k;
  }
  return pendres_room_close(&room,
                            pendres_strobe_run_some(ctx, count, which, lanes, visit, l->at));
}

/* Find which copies are next to the same orbits, or to a known one. */
static void find_like(const job *j, const caught_list *l)
{
  for (size_t k = 0; k < l->n; k++) {
    caught *c = &l->at[k];
    for (size_t i = k; i-- > 0 && l->at[i].index / j->copies == c->index / j->copies;) {
      const caught *other = &l->at[i];
      if (other->like == i && other->period == c->period && other->winding == c->winding &&
          apart(&other->at, c->at.y, c->at.w) < caught_same_place)
        c->like = i;
    }
  }
}

/* ---- orbits ---- */

/* Refine the orbits that caught runners are near, with their shortest periods. */
static pendres_status find_orbits(pendres_context *ctx, const job *j, const caught_list *l)
{
  size_t count = 0, good = 0;
  caught *c = l->at;
  for (size_t k = 0; k < l->n; k++) {
    if (c[k].like != k || c[k].on != NULL) continue;
    pendres_orbit_guess *g = &l->guess[count++];
    *g = (pendres_orbit_guess){
      .pendulum = *c[k].at.pendulum, .period = c[k].period, .winding = c[k].winding};
    const pendres_coordinates at = {.y = c[k].at.y, .w = c[k].at.w};
    pendres_coordinates_out(c[k].at.pendulum, &at, &g->x, &g->v);
  }
  const pendres_status status =
    j->points
      ? pendres_orbit_find_points(ctx, count, l->guess, l->orbit, l->outcome)
      : pendres_orbit_find(ctx, count, l->guess, PENDRES_ORBIT_PLAIN, l->orbit, l->outcome);
  if (status != PENDRES_OK) return status;
  count = 0;
  for (size_t k = 0; k < l->n; k++) {
    if (c[k].like == k && c[k].on == NULL) {
      const pendres_orbit *o = &l->orbit[count];
      if (l->outcome[count++] != PENDRES_NOT_CONVERGED && o->stable && is_near(o, &c[k].at)) {
        c[k].on = &l->orbit[good];
        l->orbit[good++] = *o;
      }
    }
    c[k].on = c[c[k].like].on;
  }
  return pendres_orbits_to_prime(ctx, good, l->orbit);
}

static void take(const job *j, const caught *c)
{
  if (c->runner == NULL) return;
  c->runner->state = c->on != NULL ? PENDRES_RUNNER_DONE : PENDRES_RUNNER_MOVING;
  if (c->on == NULL) {
    c->runner->near *= caught_closer;
    return;
  }
  c->runner->came = c->runner->lane.period;
  if (!is_surely_stable(c->on)) c->runner->doubt = INFINITY;
  pendres_lyapunov_take_orbit(c->on, &j->out[c->index]);
  if (j->orbit != NULL) j->orbit[c->index] = *c->on;
}

/* The caught ones; before copies the orbit that is known of them. Returns how many there are. */
static size_t list(const job *j, caught *c)
{
  size_t n = 0, family = SIZE_MAX;
  for (size_t i = 0; i < j->n; i++) {
    pendres_runner *r = &j->runner[i];
    if (r->state != PENDRES_RUNNER_CAUGHT) continue;
    if (j->copies > 0 && i / j->copies != family) {
      family = i / j->copies;
      const pendres_orbit *o = &j->known[family];
      if (o->period > 0) {
        c[n] = (caught){.index = i, .period = o->period, .winding = o->winding,
                        .at = pendres_strobe_lane_at(&j->pendulum[i], o->x, o->v), .like = n,
                        .on = o};
        c[n++].at.steps = r->steps;
      }
    }
    c[n] = (caught){.runner = r, .index = i, .period = r->period, .winding = r->winding,
                    .began = r->lane.period, .at = r->lane, .like = n};
    n++;
  }
  return n;
}

pendres_status pendres_lyapunov_settle_caught(pendres_context *ctx, const job *j)
{
  size_t n = 0;
  for (size_t i = 0; i < j->n; i++) n += j->runner[i].state == PENDRES_RUNNER_CAUGHT;
  if (n == 0) return PENDRES_OK;
  pendres_room room = pendres_room_open(ctx, "orbits");
  caught_list l = {.at = pendres_room_take(&room, 2 * n, sizeof *l.at),
                   .guess = pendres_room_take(&room, n, sizeof *l.guess),
                   .orbit = pendres_room_take(&room, n, sizeof *l.orbit),
                   .outcome = pendres_room_take(&room, n, sizeof *l.outcome)};
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  l.n = list(j, l.at);
  pendres_status status = j->copies > 0 ? to_one_phase(ctx, &l) : PENDRES_OK;
  if (status == PENDRES_OK && j->copies > 0) find_like(j, &l);
  if (status == PENDRES_OK) status = find_orbits(ctx, j, &l);
  for (size_t k = 0; k < l.n && status == PENDRES_OK; k++) take(j, &l.at[k]);
  return pendres_room_close(&room, status);
}
