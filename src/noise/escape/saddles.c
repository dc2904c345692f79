/* saddles.c -- saddle orbits on the boundary of a basin; see saddles.h. */
#include <math.h>

#include "base/numbers.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "model/equation.h"
#include "model/model.h"
#include "noise/escape/numbers.h"
#include "noise/escape/path.h"
#include "noise/escape/saddles.h"
#include "orbits/orbit_same.h"
#include "settling/attractor_internal.h"
#include "settling/settle.h"

typedef struct search {
  pendres_context *ctx;
  const pendres_attractors *set;
  size_t from;
  const pendres_attractor *home;
  double *x, *v; /* of the boundary's motion */
  long after;
} search;

/* Whether a pendulum has settled on the state, in its own well. */
static int stays(const search *s, const pendres_settled *o)
{
  return o->attractor == (int)s->from && o->well == 0;
}

/* The part of the line to a point in which it first leaves the basin; 0 if it does not. */
static pendres_status cross(const search *s, const double to[2], double bracket[2], int *crosses)
{
  const pendres_orbit *o = &s->home->orbit;
  bracket[0] = 0.0;
  bracket[1] = 1.0;
  *crosses = 1;
  for (int round = 0; round < SADDLE_ROUNDS && *crosses; round++) {
    double x[SADDLE_CUTS], v[SADDLE_CUTS];
    pendres_settled outcome[SADDLE_CUTS];
    const double low = bracket[0], width = bracket[1] - bracket[0];
    for (int k = 0; k < SADDLE_CUTS; k++) {
      const double share = low + width * (k + 1) / SADDLE_CUTS;
      x[k] = o->x + share * (to[0] - o->x);
      v[k] = o->v + share * (to[1] - o->v);
    }
    /* Labels need not be certain: what is found is a saddle, or it is not. */
    const pendres_settle_starts starts = {.n = SADDLE_CUTS, .x = x, .v = v};
    const pendres_status status =
      pendres_settle_known(s->ctx, s->set->attractor_sets, &starts,
                           pendres_accuracy_to_settle(s->ctx), PENDRES_SETTLE_SHORT, outcome);
    if (status != PENDRES_OK) return status;
    int first = 0;
    while (first < SADDLE_CUTS && stays(s, &outcome[first])) first++;
    *crosses = first < SADDLE_CUTS;
    bracket[0] = low + width * first / SADDLE_CUTS;
    bracket[1] = low + width * (first + 1) / SADDLE_CUTS;
  }
  return PENDRES_OK;
}

/* Whether an orbit has one multiplier outside the unit circle, and one inside. */
static int is_saddle(const pendres_orbit *o)
{
  return o->multiplier_im[0] == 0.0 && fabs(o->multiplier_re[0]) > 1.0 + o->multiplier_error &&
         fabs(o->multiplier_re[1]) < 1.0;
}

/* The orbit to which a point on the boundary comes: from where it comes back most closely. */
static pendres_status arrive(const search *s, double x, double v, pendres_saddle *out, int *found)
{
  const pendres_pendulum *p = &s->home->orbit.pendulum;
  const double turn = pendres_model_turn(p);
  long n = 0;
  *found = 0;
  s->x[0] = x;
  s->v[0] = v;
  for (n = 1; n <= s->after; n++) {
    pendres_status status = pendres_strobe_advance(s->ctx, 1, p, &x, &v, 1, NULL);
    if (status == PENDRES_INTERRUPTED || status == PENDRES_OUT_OF_MEMORY) return status;
    if (status != PENDRES_OK || !(fabs(x) < pendres_farthest)) break;
    s->x[n] = x;
    s->v[n] = v;
  }
  for (int cycle = 1; cycle <= SADDLE_CYCLES && !*found; cycle++) {
    long best = -1;
    double least = INFINITY;
    for (long k = 0; k + cycle < n; k++) {
      const double d = pendres_model_distance(p, remainder(s->x[k + cycle] - s->x[k], turn),
                                              s->v[k + cycle] - s->v[k]);
      if (d > saddle_leaves * least) break; /* for one side or the other */
      if (d >= least) continue;
      least = d;
      best = k;
    }
    if (best < 0) break;
    const double across = s->x[best + cycle] - s->x[best];
    const pendres_orbit_guess guess = {*p, s->x[best], s->v[best], cycle,
                                       (int)rint(across / turn)};
    pendres_status outcome;
    const pendres_status status =
      pendres_orbit_find(s->ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &out->orbit, &outcome);
    if (status != PENDRES_OK) return status;
    if ((outcome != PENDRES_OK && outcome != PENDRES_TOLERANCE_UNREACHABLE) ||
        !is_saddle(&out->orbit))
      continue;
    out->x = out->orbit.x + turn * rint((s->x[best] - out->orbit.x) / turn);
    *found = pendres_model_distance(p, out->x - s->x[best], out->orbit.v - s->v[best]) <=
             saddle_near * pendres_model_distance(p, out->x - s->home->orbit.x,
                                          out->orbit.v - s->home->orbit.v);
  }
  return PENDRES_OK;
}

/* What lies on the other side. */
static pendres_status look_beyond(const search *s, pendres_saddle *a)
{
  const double apart = hypot(a->x - s->home->orbit.x, a->orbit.v - s->home->orbit.v);
  const double m[4] = {a->orbit.monodromy[0][0], a->orbit.monodromy[0][1],
                       a->orbit.monodromy[1][0], a->orbit.monodromy[1][1]};
  double e[2], x[2], v[2];
  pendres_settled outcome[2];
  pendres_way_direction(m, a->orbit.multiplier_re[0], e);
  for (int k = 0; k < 2; k++) {
    const double part = k == 0 ? saddle_beside * apart : -saddle_beside * apart;
    x[k] = a->x + part * e[0];
    v[k] = a->orbit.v + part * e[1];
  }
  const pendres_status status = pendres_attractors_settle(s->ctx, s->set, 2, x, v, outcome);
  if (status == PENDRES_OK) a->leads = outcome[stays(s, &outcome[0]) ? 1 : 0];
  return status;
}

/* Follow a line to the saddle that it leads to, and keep it if it is another one. */
static pendres_status add(const search *s, const double to[2], pendres_saddle *out, size_t *count)
{
  const pendres_orbit *o = &s->home->orbit;
  double bracket[2];
  int crosses, found = 0;
  pendres_status status = cross(s, to, bracket, &crosses);
  if (status != PENDRES_OK || !crosses) return status;
  const double share = 0.5 * (bracket[0] + bracket[1]);
  pendres_saddle *next = &out[*count];
  status = arrive(s, o->x + share * (to[0] - o->x), o->v + share * (to[1] - o->v), next, &found);
  if (status != PENDRES_OK || !found) return status;
  for (size_t i = 0; i < *count; i++) {
    const double shift = out[i].x - out[i].orbit.x - (next->x - next->orbit.x);
    if (pendres_orbit_same(&out[i].orbit, &next->orbit) &&
        fabs(shift) < 0.5 * pendres_model_turn(&o->pendulum))
      return PENDRES_OK;
  }
  status = look_beyond(s, next);
  if (status == PENDRES_OK) ++*count;
  return status;
}

pendres_status pendres_saddles_find(pendres_context *ctx, const pendres_attractors *set,
                                    size_t from, pendres_saddle out[PENDRES_SADDLES_MOST],
                                    size_t *count)
{
  const pendres_attractor *home = pendres_attractors_get(set, from);
  const pendres_orbit *o = &home->orbit;
  const double fading = pendres_equation_fading(&o->pendulum);
  search s = {.ctx = ctx, .set = set, .from = from, .home = home,
              .after = (long)fmin(SADDLE_MOST_AFTER, SADDLE_AFTER + saddle_fade / fading)};
  const double turn = pendres_model_of(o->pendulum.force)->period;
  const double far = turn > 0.0 ? turn : saddle_far * pendres_model_scale(&o->pendulum);
  static const double ray[SADDLE_RAYS][2] = {{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}};
  pendres_room room = pendres_room_open(ctx, "the boundary of a basin");
  s.x = pendres_room_take(&room, (size_t)s.after + 1, sizeof *s.x);
  s.v = pendres_room_take(&room, (size_t)s.after + 1, sizeof *s.v);
  pendres_status status = room.status;
  *count = 0;
  const size_t lines = SADDLE_RAYS + pendres_attractors_count(set);
  for (size_t i = 0; i < lines && status == PENDRES_OK && *count < PENDRES_SADDLES_MOST; i++) {
    double to[2];
    const size_t others = lines - SADDLE_RAYS;
    if (i >= others) {
      if (i - others >= 2 && *count > 0) break; /* a kick is for what no other line has found */
      to[0] = o->x + far * ray[i - others][0];
      to[1] = o->v + far * ray[i - others][1];
    } else {
      const pendres_attractor *other = pendres_attractors_get(set, i);
      if (other == home || !isfinite(other->orbit.x)) continue;
      to[0] = other->orbit.x;
      to[1] = other->orbit.v;
    }
    status = add(&s, to, out, count);
  }
  return pendres_room_close(&room, status);
}
