/* orbit_prime.c -- the prime period of orbits; see orbit_prime.h. */
#include "base/angles.h"
#include "orbits/orbit_prime.h"

#include <math.h>

#include "engine/room.h"
#include "engine/strobe_run.h"
#include "model/model.h"
#include "orbits/orbit_same.h"

/* The tolerance of a run around the closed orbit, for methods that choose their own steps. */
static const double run_within = 1e-10;

/* An orbit of more than one period, and a shorter period after which it closes. */
typedef struct closing {
  size_t which; /* of the orbits */
  int tried;    /* shorter ones than this are not its period */
  int period;   /* 0: it closes after no divisor of its own period */
  int winding;
} closing;

typedef struct job {
  pendres_orbit *orbit;
  closing *found; /* one a lane */
} job;

/* At each period that divides the orbit's: whether the lane is back where it began. */
static int visit(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  const job *j = arg;
  closing *c = &j->found[index];
  const pendres_orbit *o = &j->orbit[c->which];
  const int d = (int)lane->period;
  if (d > o->period / 2 || !(isfinite(lane->y) && isfinite(lane->w))) return 1;
  if (d <= c->tried || o->period % d != 0 || o->winding % (o->period / d) != 0) return 0;
  double x, v;
  pendres_strobe_lane_out(lane, &x, &v);
  if (!pendres_orbit_is_at(o, x, v, o->x_error + o->v_error)) return 0;
  c->period = d;
  c->winding = o->winding / (o->period / d);
  return 1;
}

/* Find which of n orbits close after a shorter period that has not been tried; they are put in
   front. */
static pendres_status close_early(pendres_context *ctx, job *j, size_t *n)
{
  pendres_room room = pendres_room_open(ctx, "orbits");
  pendres_strobe_lane *lanes = pendres_room_take(&room, *n, sizeof *lanes);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < *n; i++) {
    const pendres_orbit *o = &j->orbit[j->found[i].which];
    lanes[i] = pendres_strobe_lane_at(&o->pendulum, o->x, o->v);
    lanes[i].steps = o->steps;
    j->found[i].period = 0;
  }
  const pendres_status status =
    pendres_strobe_run_within(ctx, run_within, *n, lanes, visit, j);
  size_t kept = 0;
  for (size_t i = 0; i < *n; i++)
    if (j->found[i].period > 0) j->found[kept++] = j->found[i];
  *n = kept;
  return pendres_room_close(&room, status);
}

/* Refine them with the shorter periods. An orbit that is found takes the old one's place; the
   others stay in the list, to be tried with longer periods. */
static pendres_status refine(pendres_context *ctx, job *j, size_t *n)
{
  pendres_room room = pendres_room_open(ctx, "orbits");
  pendres_orbit_guess *guess = pendres_room_take(&room, *n, sizeof *guess);
  pendres_orbit *shorter = pendres_room_take(&room, *n, sizeof *shorter);
  pendres_status *outcome = pendres_room_take(&room, *n, sizeof *outcome);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < *n; i++) {
    const closing *c = &j->found[i];
    const pendres_orbit *o = &j->orbit[c->which];
    guess[i] = (pendres_orbit_guess){.pendulum = o->pendulum, .x = o->x, .v = o->v,
                                     .period = c->period, .winding = c->winding};
  }
  pendres_status status = pendres_orbit_find(ctx, *n, guess, PENDRES_ORBIT_PLAIN, shorter, outcome);
  size_t kept = 0;
  for (size_t i = 0; i < *n && status == PENDRES_OK; i++) {
    closing c = j->found[i];
    pendres_orbit *o = &j->orbit[c.which];
    if (outcome[i] != PENDRES_NOT_CONVERGED && shorter[i].stable &&
        pendres_orbit_is_at(o, shorter[i].x, shorter[i].v, shorter[i].x_error +
                                                           shorter[i].v_error)) {
      *o = shorter[i];
    } else {
      c.tried = c.period;
      j->found[kept++] = c;
    }
  }
  *n = kept;
  return pendres_room_close(&room, status);
}

pendres_status pendres_orbits_to_prime(pendres_context *ctx, size_t n, pendres_orbit *orbit)
{
  pendres_room room = pendres_room_open(ctx, "orbits");
  job j = {.orbit = orbit, .found = pendres_room_take(&room, n, sizeof *j.found)};
  pendres_status status = room.status;
  size_t left = 0;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    if (orbit[i].period > 1) j.found[left++] = (closing){.which = i};
  while (left > 0 && status == PENDRES_OK) {
    status = close_early(ctx, &j, &left);
    if (left > 0 && status == PENDRES_OK) status = refine(ctx, &j, &left);
  }
  return pendres_room_close(&room, status);
}
