/* unstable.c -- pendulums that rest where nothing attracts; see unstable.h. */
#include "settling/exponents/unstable.h"

#include <math.h>

#include "engine/context_internal.h"
#include "engine/room.h"
#include "model/model.h"
#include "settling/exponents/numbers.h"
#include "orbits/orbit_same.h"
#include "orbits/orbit_table.h"

/* Pendulums that hardly move, and the states of rest that they are at. */
typedef struct resting {
  size_t n;
  size_t *lane; /* number of each one's lane */
  pendres_orbit_guess *guess;
  pendres_orbit *orbit;
  pendres_status *outcome;
  pendres_strobe_lane *copy; /* of lanes, to be watched */
  long *until;               /* the period to which they are */
} resting;

/* Only without a drive is there rest: along any other orbit rounding leads a pendulum away. */
static int rests(const pendres_strobe_lane *lane)
{
  const pendres_pendulum *p = lane->pendulum;
  return p->drive_amplitude == 0.0 && fabs(p->drive_frequency * lane->w) < orbit_same_point;
}

static int is_there(const pendres_orbit *o, const pendres_strobe_lane *lane)
{
  double x, v;
  pendres_strobe_lane_out(lane, &x, &v);
  return pendres_orbit_is_at(o, x, v, 0.0);
}

/* Whether a pendulum that does not move at all has a lower potential beside it: at a bifurcation of
   rest, where multipliers tell nothing and nothing grows by factors. */
static int tips_over(const pendres_strobe_lane *lane)
{
  const pendres_pendulum *p = lane->pendulum;
  double x, v;
  pendres_strobe_lane_out(lane, &x, &v);
  const double here = pendres_model_potential(p, x);
  return p->parametric_amplitude == 0.0 && v == 0.0 &&
         fmin(pendres_model_potential(p, x - well_near),
              pendres_model_potential(p, x + well_near)) < here;
}

/* Keep those that are at a state of rest which is unstable for certain, with the time in which
   rounding would grow there until it is seen, but for those where that takes too long. */
static void keep_unstable(const pendres_strobe_lane *lanes, resting *r)
{
  size_t n = 0;
  for (size_t k = 0; k < r->n; k++) {
    pendres_orbit *o = &r->orbit[k];
    const size_t i = r->lane[k];
    double periods = 1.0;
    if (r->outcome[k] != PENDRES_NOT_CONVERGED) {
      const double size = fmax(hypot(o->multiplier_re[0], o->multiplier_im[0]),
                               hypot(o->multiplier_re[1], o->multiplier_im[1]));
      periods = ceil(growth_passing / log(size));
      if (!(size - o->multiplier_error > 1.0 && periods <= settle_slowest)) continue;
    } else {
      if (!tips_over(&lanes[i])) continue;
      *o = pendres_orbit_none(lanes[i].pendulum);
      pendres_strobe_lane_out(&lanes[i], &o->x, &o->v);
      o->x_error = o->v_error = 0.0;
      o->period = 1;
    }
    if (!is_there(o, &lanes[i])) continue;
    r->lane[n] = i;
    r->orbit[n] = *o;
    r->copy[n] = lanes[i];
    r->until[n++] = lanes[i].period + (long)periods;
  }
  r->n = n;
}

static int watch(void *arg, size_t k, const pendres_strobe_lane *lane)
{
  const resting *r = arg;
  return lane->period >= r->until[k] || !is_there(&r->orbit[k], lane);
}

pendres_status pendres_settle_unstable(pendres_context *ctx, size_t n,
                                       const pendres_strobe_lane *lanes, pendres_settled *outcome,
                                       pendres_orbit *state)
{
  resting r = {0};
  for (size_t i = 0; i < n; i++) r.n += !pendres_settle_ended(&outcome[i]) && rests(&lanes[i]);
  if (r.n == 0) return PENDRES_OK;
  pendres_room room = pendres_room_open(ctx, "pendulums at rest");
  r.lane = pendres_room_take(&room, r.n, sizeof *r.lane);
  r.guess = pendres_room_take(&room, r.n, sizeof *r.guess);
  r.orbit = pendres_room_take(&room, r.n, sizeof *r.orbit);
  r.outcome = pendres_room_take(&room, r.n, sizeof *r.outcome);
  r.copy = pendres_room_take(&room, r.n, sizeof *r.copy);
  r.until = pendres_room_take(&room, r.n, sizeof *r.until);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0, k = 0; i < n; i++) {
    if (pendres_settle_ended(&outcome[i]) || !rests(&lanes[i])) continue;
    r.lane[k] = i;
    r.guess[k] = (pendres_orbit_guess){.pendulum = *lanes[i].pendulum, .period = 1};
    pendres_strobe_lane_out(&lanes[i], &r.guess[k].x, &r.guess[k].v);
    k++;
  }
  pendres_status status =
    pendres_orbit_find(ctx, r.n, r.guess, PENDRES_ORBIT_PLAIN, r.orbit, r.outcome);
  if (status == PENDRES_OK) keep_unstable(lanes, &r);
  if (status == PENDRES_OK) status = pendres_strobe_run(ctx, r.n, r.copy, watch, &r);
  for (size_t k = 0; k < r.n && status == PENDRES_OK; k++) {
    if (!is_there(&r.orbit[k], &r.copy[k])) continue;
    outcome[r.lane[k]] = (pendres_settled){.label = PENDRES_LABEL_UNSTABLE,
                                           .attractor = PENDRES_ATTRACTOR_UNSTABLE,
                                           .settling_periods = -1,
                                           .certain = 1};
    if (state != NULL) state[r.lane[k]] = r.orbit[k];
  }
  return pendres_room_close(&room, status);
}
