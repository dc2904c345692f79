/* stable_part.c -- the stable part of a branch from a place on; see stable_part.h. */
#include "analysis/sweeps/stable_part.h"

#include <math.h>
#include <stdlib.h>

#include "settling/exponents/lyapunov_move.h"
#include "analysis/sweeps/numbers.h"
#include "continuation/numbers.h"
#include "continuation/parameter.h"
#include "continuation/sets.h"
#include "engine/context_internal.h"

void pendres_part_free(pendres_part *s)
{
  pendres_branch_free(s->branch);
  *s = pendres_part_none;
}

/* The point of a branch that is nearest to an orbit; of bifurcations alone, or of all. */
static size_t nearest(const pendres_branch *b, const pendres_orbit *o, int bifurcations,
                      double *how_near)
{
  size_t best = 0;
  *how_near = INFINITY;
  for (size_t i = 0; i < pendres_branch_count(b); i++) {
    const pendres_branch_point *p = pendres_branch_get(b, i);
    const double d = pendres_part_distance(b, p, o);
    if ((bifurcations && p->bifurcation < 0) || !(d < *how_near)) continue;
    *how_near = d;
    best = i;
  }
  return best;
}

/* Whether the branch goes on for long enough beyond a point of it, or ends by itself. */
static int is_enough(const pendres_part *s, size_t k)
{
  return s->end == PENDRES_PART_LIMIT || pendres_part_branch_end(s) != PENDRES_END_POINTS ||
         pendres_part_point(s, k + STABLE_ENOUGH) != NULL;
}

/* ---- following ---- */

/* Go on with the branch to this many points each way. */
static pendres_status extend(pendres_context *ctx, pendres_part *s, double limit, size_t points)
{
  const pendres_curve *c = &s->branch->curve;
  const pendres_parameter parameter = pendres_curve_parameter(c, 0);
  const double from = pendres_parameter_get(parameter, &s->at.pendulum);
  /* Orbits are born at the place, and followed from a little aside. */
  const double here = s->born ? c->way->start.u[c->kind.system.unknown[2]] : from;
  const double room = pendres_part_margin(parameter);
  const double least = fmin(fmin(from, limit), here), most = fmax(fmax(from, limit), here);
  /* A birth is located between points on both sides of it. */
  const double behind = s->born ? room : stable_little * room;
  const double below = s->direction > 0 ? behind : room, above = s->direction > 0 ? room : behind;
  const pendres_curve_bounds bounds = {
    .low = {pendres_parameter_beyond(parameter, least, -below)}, .high = {most + above},
    .wildest = stable_wildest, .most_points = points, .most_unstable = STABLE_BEYOND};
  s->points_each_way = points;
  return pendres_branch_extend(ctx, s->branch, &bounds);
}

/* The number of points that are affordable: each costs as many drive periods as the orbit has.
   With half as many, folds of locks of some twenty periods were not reached. */
static size_t most_points(const pendres_orbit *orbit)
{
  const size_t share = 2 * PENDRES_CURVE_POINTS / (size_t)orbit->period;
  if (!pendres_lyapunov_may_rotate(&orbit->pendulum)) return PENDRES_CURVE_POINTS;
  return share > STABLE_FEW_POINTS ? share : STABLE_FEW_POINTS;
}

/* Follow the branch until that tells how the part ends, or has at most this many points each
   way. */
static pendres_status find_end(pendres_context *ctx, pendres_part *s, double limit, size_t first,
                               size_t most)
{
  for (size_t points = first;; points *= 4) {
    double off = INFINITY;
    if (points > most) points = most;
    const pendres_status status = extend(ctx, s, limit, points);
    if (status != PENDRES_OK) return status;
    s->first = nearest(s->branch, &s->at, s->born, &off);
    if (s->born && !(off < stable_near_birth)) return PENDRES_NOT_FOUND;
    if (!pendres_part_choose_way(s) || is_enough(s, pendres_part_take(s, limit)) ||
        points == most)
      return status;
  }
}

/* Begin the branch of an orbit, and follow it. */
static pendres_status follow(pendres_context *ctx, const pendres_orbit *start,
                             pendres_parameter parameter, double limit, pendres_part *s)
{
  const size_t few =
    pendres_lyapunov_may_rotate(&start->pendulum) ? STABLE_FEW_POINTS : PENDRES_CURVE_POINTS;
  s->direction = limit >= pendres_parameter_get(parameter, &s->at.pendulum) ? 1 : -1;
  /* Each doubling of a cascade reaches less far. */
  pendres_status status =
    pendres_branch_begin(ctx, start, parameter, pendres_curve_spacing / start->period, &s->branch);
  if (status == PENDRES_OK) status = find_end(ctx, s, limit, few, most_points(start));
  if (status != PENDRES_OK) pendres_part_free(s);
  return status;
}

pendres_status pendres_part_from(pendres_context *ctx, const pendres_orbit *orbit,
                                 pendres_parameter parameter, double limit, pendres_part *out)
{
  *out = (pendres_part){.at = *orbit, .way.limit = limit};
  return follow(ctx, orbit, parameter, limit, out);
}

/* The part of what is born at a bifurcation. *lost: there may be one, but it cannot be followed
   from this point of the bifurcation's orbit. */
static pendres_status born(pendres_context *ctx, const pendres_bifurcation *at, double limit,
                           pendres_part *out, int *lost)
{
  pendres_orbit start;
  *out = (pendres_part){.at = at->orbit, .born = 1};
  *lost = 1;
  pendres_status status = pendres_branch_switch(ctx, at, &start);
  if (status == PENDRES_OK) {
    const double there = pendres_parameter_get(at->parameter, &start.pendulum);
    const int towards = limit >= at->value ? there > at->value : there < at->value;
    status = towards ? follow(ctx, &start, at->parameter, limit, out) : PENDRES_NOT_FOUND;
    *lost = towards;
  }
  if (status == PENDRES_OK && pendres_part_last(out) == NULL) status = PENDRES_NOT_FOUND;
  if (status != PENDRES_OK) pendres_part_free(out);
  return status == PENDRES_NOT_CONVERGED ? PENDRES_NOT_FOUND : status;
}

/* The same, from whichever point of it that is possible. */
static pendres_status born_somewhere(pendres_context *ctx, const pendres_bifurcation *at,
                                     double limit, pendres_part *out)
{
  pendres_bifurcation wide;
  int lost = 0;
  pendres_status status = born(ctx, at, limit, out, &lost);
  if (status != PENDRES_NOT_FOUND || !lost) return status;
  status = pendres_bifurcation_widest(ctx, at, &wide);
  if (status == PENDRES_OK && wide.orbit.x == at->orbit.x && wide.orbit.v == at->orbit.v)
    return PENDRES_NOT_FOUND;
  return status == PENDRES_OK ? born(ctx, &wide, limit, out, &lost) : status;
}

pendres_status pendres_part_born(pendres_context *ctx, const pendres_bifurcation *at, double limit,
                                 pendres_part *out)
{
  const pendres_status status = born_somewhere(ctx, at, limit, out);
  if (status != PENDRES_OK) return status;
  out->way.birth = *at;
  out->way.limit = limit;
  return status;
}

pendres_status pendres_part_extend(pendres_context *ctx, pendres_part *s, double limit)
{
  const double same = pendres_part_same(s), end = s->end_value;
  if (pendres_part_branch_end(s) != PENDRES_END_POINTS) return PENDRES_NOT_FOUND;
  const size_t most = 2 * s->points_each_way;
  struct pendres_part_way *way = &s->way;
  if ((size_t)way->extended >= sizeof way->to / sizeof *way->to) way->extended = -1;
  else way->to[way->extended++] = limit;
  const pendres_status status = find_end(ctx, s, limit, most, most);
  if (status != PENDRES_OK || s->end != PENDRES_PART_STOPPED) return status;
  return pendres_part_ahead(s, s->end_value, end) > same ? PENDRES_OK : PENDRES_NOT_FOUND;
}

pendres_status pendres_part_again(pendres_context *ctx, pendres_parameter parameter,
                                  pendres_part *s)
{
  const pendres_part old = *s;
  const pendres_uncounted work = pendres_uncounted_begin(ctx);
  pendres_status status =
    old.born ? pendres_part_born(ctx, &old.way.birth, old.way.limit, s)
             : pendres_part_from(ctx, &old.at, parameter, old.way.limit, s);
  for (int k = 0; k < old.way.extended && status == PENDRES_OK; k++)
    status = pendres_part_extend(ctx, s, old.way.to[k]);
  pendres_uncounted_end(ctx, &work);
  return status;
}

int pendres_part_period(const pendres_part *s)
{
  return s->branch->curve.kind.system.map.period;
}

const pendres_branch_point *pendres_part_last(const pendres_part *s)
{
  for (size_t k = s->points; k-- > 0;)
    if (pendres_part_point(s, k)->bifurcation < 0) return pendres_part_point(s, k);
  return NULL;
}

pendres_status pendres_part_arrive(pendres_context *ctx, const pendres_part *s, pendres_orbit *out)
{
  pendres_status outcome = PENDRES_OK;
  const pendres_orbit *last = &pendres_part_last(s)->orbit;
  const pendres_orbit_guess guess = {.pendulum = last->pendulum, .x = last->x, .v = last->v,
                                     .period = last->period, .winding = last->winding};
  const pendres_status status =
    pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, out, &outcome);
  if (status == PENDRES_OK && outcome == PENDRES_NOT_CONVERGED) *out = *last;
  return status;
}

int pendres_part_holds(const pendres_part *s, double value)
{
  if (s->branch == NULL) return 0;
  const double ahead = pendres_part_ahead(s, value, s->end_value);
  return ahead < 0.0 || (s->end == PENDRES_PART_LIMIT && ahead == 0.0);
}

/* ---- orbits at values ---- */

/*
 * Where to look for the orbit at a value between two points. Next to a fold the Poincaré point
 * moves with the square root of the distance from it, elsewhere nearly in proportion to the
 * distance.
 */
static pendres_orbit_guess between(const pendres_branch_point *p, const pendres_branch_point *q,
                                   pendres_parameter parameter, double value)
{
  const double from = pendres_parameter_get(parameter, &p->orbit.pendulum);
  const double to = pendres_parameter_get(parameter, &q->orbit.pendulum);
  double part = to != from ? (value - from) / (to - from) : 0.0;
  /* Not far beyond the first point, where a value may lie next to the place of a jump. */
  part = fmin(fmax(part, -1.0), 1.0);
  if (q->kind == PENDRES_FOLD) part = 1.0 - sqrt(1.0 - part);
  return pendres_branch_between(&p->orbit, &q->orbit, part, parameter, value);
}

pendres_status pendres_part_orbits(pendres_context *ctx, const pendres_part *s, size_t n,
                                   const double *value, pendres_orbit *out, int *found)
{
  if (n == 0) return PENDRES_OK;
  const pendres_map *map = &s->branch->curve.kind.system.map;
  const pendres_parameter parameter = pendres_curve_parameter(&s->branch->curve, 0);
  pendres_orbit_guess *guess = calloc(n, sizeof *guess);
  pendres_status *outcome = calloc(n, sizeof *outcome);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (guess == NULL || outcome == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for %zu orbits", n);
    goto done;
  }
  for (size_t i = 0, k = 0; i < n; i++) {
    while (k + 2 < s->points &&
           pendres_part_ahead(s, value[i], pendres_part_value(s, k + 1)) > 0.0)
      k++;
    const pendres_branch_point *p = pendres_part_point(s, k);
    const pendres_branch_point *q = s->points > 1 ? pendres_part_point(s, k + 1) : p;
    guess[i] = between(p, q, parameter, value[i]);
    /* At its birth the orbit is still the one that it is born from, with that period and
       winding. */
    guess[i].period = map->period;
    guess[i].winding = map->mirror ? 0 : map->winding;
  }
  status = pendres_orbit_find(ctx, n, guess, PENDRES_ORBIT_PLAIN, out, outcome);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    found[i] = outcome[i] != PENDRES_NOT_CONVERGED && out[i].stable &&
               out[i].period == guess[i].period && out[i].winding == guess[i].winding;
done:
  free(guess);
  free(outcome);
  return status;
}
