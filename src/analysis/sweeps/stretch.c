/* stretch.c -- the stable part of a branch, from a place on it; see stretch.h. */
#include "analysis/sweeps/stretch.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "continuation/branch.h"
#include "continuation/parameter.h"
#include "engine/context_internal.h"
#include "model/model.h"
#include "analysis/chaos/lyapunov_move.h"
#include "continuation/sets.h"

/* A branch is not followed where errors grow by more than this in a map: it has long been
   unstable. */
static const double wildest = 3000.0;
/* The branch is followed beyond both ends by this share of the parameter's scale. */
static const double margin = 0.003;
/* The spacing of points for orbits of period one; each doubling of a cascade reaches less far. */
static const double spacing = 0.05;

/* Points each way. For pendulums whose rotations lock to the drive there are few at first, then
   four times as many until they are enough: a lock of q periods lies on a closed branch that passes
   all of its q points, and the stretch is one stable part of it. */
enum { FEW_POINTS = 48, MOST_POINTS = 2000, ENOUGH = 8 };

/* Values that differ by less, in the parameter's scale, are those of one place. */
static const double same_value = 1e-8;
/* A point this close to a bifurcation does not tell what there is before or behind that: it may be
   on either of two branches that meet there. For orbits of period one; all of a late branch of a
   cascade may be as close. */
static const double next_to = 1e-4;

/* How close to a bifurcation the branch that is born there has that, too. */
static const double near_birth = 1e-5;

void pendres_stretch_free(pendres_stretch *s)
{
  pendres_branch_free(s->branch);
  *s = pendres_stretch_none;
}

/* The distance from the position of an orbit to that of another, without whole turns. */
static double angle_between(const pendres_orbit *to, const pendres_orbit *from)
{
  return pendres_less_turns(to->x - from->x, pendres_model_turn(&from->pendulum));
}

/* Distance of a point of the branch from an orbit with a value of the parameter. */
static double distance(const pendres_branch_point *p, pendres_parameter parameter, double value,
                       const pendres_orbit *o)
{
  const double dp = (pendres_parameter_get(parameter, &p->orbit.pendulum) - value) /
                    pendres_parameter_scale(parameter);
  return hypot(hypot(angle_between(&p->orbit, o), p->orbit.v - o->v), dp);
}

/* The point of a branch that is nearest to an orbit; of bifurcations alone, or of all. */
static size_t nearest(const pendres_branch *b, pendres_parameter parameter, double value,
                      const pendres_orbit *o, int bifurcations, double *how_near)
{
  size_t best = 0;
  *how_near = INFINITY;
  for (size_t i = 0; i < pendres_branch_count(b); i++) {
    const pendres_branch_point *p = pendres_branch_get(b, i);
    const double d = distance(p, parameter, value, o);
    if ((bifurcations && p->bifurcation < 0) || !(d < *how_near)) continue;
    *how_near = d;
    best = i;
  }
  return best;
}

/* Point number k of the stretch; NULL where the branch ends before. */
static const pendres_branch_point *point_of(const pendres_stretch *s, size_t k)
{
  const size_t count = pendres_branch_count(s->branch);
  if (k >= count) return NULL;
  if (pendres_branch_end_get(s->branch, 0) == PENDRES_END_CLOSED)
    return pendres_branch_get(s->branch, (s->first + (s->step > 0 ? k : count - k)) % count);
  if (s->step < 0) return k <= s->first ? pendres_branch_get(s->branch, s->first - k) : NULL;
  return pendres_branch_get(s->branch, s->first + k);
}

static double value_of(const pendres_stretch *s, size_t k)
{
  return pendres_parameter_get(s->parameter, &point_of(s, k)->orbit.pendulum);
}

/* How far a value is ahead of another in the direction of the stretch. */
static double ahead(const pendres_stretch *s, double value, double of)
{
  return (double)s->direction * (value - of);
}

/* How the branch ends in the direction of the stretch. */
static pendres_branch_end branch_end(const pendres_stretch *s)
{
  return pendres_branch_end_get(s->branch, s->step > 0);
}

/* Whether a point is so close to a bifurcation that its stability is a matter of rounding. */
static int beside(const pendres_stretch *s, const pendres_branch_point *p,
                  const pendres_bifurcation *at)
{
  return at != NULL && distance(p, s->parameter, at->value, &at->orbit) < next_to / p->orbit.period;
}

/* Whether a point has such a bifurcation before it, with nothing in between but points as close. */
static int before_bifurcation(const pendres_stretch *s, size_t k)
{
  const pendres_branch_point *p = point_of(s, k), *q;
  const double value = pendres_parameter_get(s->parameter, &p->orbit.pendulum);
  const double near = next_to / p->orbit.period;
  while ((q = point_of(s, ++k)) != NULL && q->bifurcation < 0)
    if (distance(q, s->parameter, value, &p->orbit) >= near) return 0;
  return q != NULL &&
         beside(s, p, pendres_branch_bifurcation_get(s->branch, (size_t)q->bifurcation));
}

/* How far a stretch that ends before point number k may reach beyond its last point: as far as the
   points before and behind that. */
static double unlocated(const pendres_stretch *s, size_t k)
{
  const size_t last = s->points - 1;
  const double behind = fabs(value_of(s, k) - value_of(s, last));
  return last > 0 ? fmax(behind, fabs(value_of(s, last) - value_of(s, last - 1))) : behind;
}

/* Take points from the place on as long as orbits are stable; sets points and the end, and returns
   the number of the point that told the end. */
static size_t take_stable(pendres_stretch *s, double limit)
{
  const pendres_branch_point *p = NULL;
  const pendres_bifurcation *met = NULL; /* the latest, where it is not known yet what follows */
  const double same = same_value * pendres_parameter_scale(s->parameter);
  size_t met_at = 0, k = 1;
  int turned = 0;
  s->points = 1;
  for (; (p = point_of(s, k)) != NULL; k++) {
    if (p->bifurcation >= 0) {
      met = pendres_branch_bifurcation_get(s->branch, (size_t)p->bifurcation);
      met_at = k;
      if (met->kind == PENDRES_FOLD) break;
      continue;
    }
    /* Next to a bifurcation, at the beginning or on the way, stability is a matter of rounding. */
    const double before = met != NULL ? met->value : value_of(s, s->points - 1);
    if ((s->points == 1 || met != NULL) && fabs(value_of(s, k) - before) <= same) continue;
    if (beside(s, p, met) || before_bifurcation(s, k)) continue;
    turned = ahead(s, value_of(s, k), before) < -same;
    if (!p->orbit.stable || turned) break;
    met = NULL;
    s->points = k + 1;
    s->period = p->orbit.period;
    s->winding = p->orbit.winding;
    if (ahead(s, value_of(s, k), limit) >= 0.0) {
      s->end = PENDRES_STRETCH_LIMIT;
      s->end_value = limit;
      s->end_error = 0.0;
      return k;
    }
  }
  s->end_value = value_of(s, s->points - 1);
  s->end_error = margin * pendres_parameter_scale(s->parameter);
  s->end = p != NULL                            ? PENDRES_STRETCH_UNLOCATED
           : branch_end(s) == PENDRES_END_RANGE ? PENDRES_STRETCH_LIMIT
                                                : PENDRES_STRETCH_STOPPED;
  if (p != NULL) s->end_error = unlocated(s, k);
  /* What happens at a bifurcation right before the computation stopped is told by what follows. */
  if (met == NULL || (p == NULL && branch_end(s) == PENDRES_END_POINTS)) return k;
  s->end = turned ? PENDRES_STRETCH_BIRTH : PENDRES_STRETCH_BIFURCATION;
  s->bifurcation = *met;
  s->end_value = met->value;
  s->end_error = met->value_error;
  s->points = met_at + 1;
  return k;
}

/* Whether the branch goes on for long enough beyond a point of it, or ends by itself. */
static int is_enough(const pendres_stretch *s, size_t k)
{
  return s->end == PENDRES_STRETCH_LIMIT || branch_end(s) != PENDRES_END_POINTS ||
         point_of(s, k + ENOUGH) != NULL;
}

/* Find which way along the branch the parameter goes in the direction of the stretch, from the
   first point to the next that is not at the same place: sets the step. Where neither way does,
   sets the end, and returns 0: where both ways lead back the place is right at the end of the
   state, else nothing could be followed. */
static int choose_way(pendres_stretch *s)
{
  const double same = same_value * pendres_parameter_scale(s->parameter);
  int back = 0;
  for (s->step = 1; s->step >= -1; s->step -= 2)
    for (size_t k = 1; point_of(s, k) != NULL; k++) {
      const double beyond = ahead(s, value_of(s, k), value_of(s, 0));
      if (fabs(beyond) <= same) continue;
      if (beyond > 0.0) return 1;
      back++;
      break;
    }
  s->points = 1;
  s->end = back == 2 ? PENDRES_STRETCH_UNLOCATED : PENDRES_STRETCH_STOPPED;
  s->end_value = value_of(s, 0);
  s->end_error = margin * pendres_parameter_scale(s->parameter);
  return 0;
}

/* ---- following ---- */

/* Go on with the branch to this many points each way. */
static pendres_status extend(pendres_context *ctx, pendres_stretch *s, double limit, size_t points)
{
  const double here = pendres_parameter_get(s->parameter, &s->start.pendulum);
  const double room = margin * pendres_parameter_scale(s->parameter);
  const double least = fmin(fmin(s->from, limit), here), most = fmax(fmax(s->from, limit), here);
  const pendres_curve_bounds bounds = {
    .low = {pendres_parameter_beyond(s->parameter, least, -room)}, .high = {most + room},
    .wildest = wildest, .most_points = points};
  s->points_each_way = points;
  return pendres_branch_extend(ctx, s->branch, &bounds);
}

/* The number of points that are affordable: each costs as many drive periods as the orbit has.
   With half as many, folds of locks of some twenty periods were not reached. */
static size_t most_points(const pendres_orbit *orbit)
{
  const size_t share = 2 * MOST_POINTS / (size_t)orbit->period;
  if (!pendres_lyapunov_may_rotate(&orbit->pendulum)) return MOST_POINTS;
  return share > FEW_POINTS ? share : FEW_POINTS;
}

/* Follow the branch until that tells how the stretch ends, or has at most this many points each
   way. */
static pendres_status find_end(pendres_context *ctx, pendres_stretch *s, double limit, size_t first,
                               size_t most)
{
  for (size_t points = first;; points *= 4) {
    double off = INFINITY;
    if (points > most) points = most;
    s->period = s->start.period;
    s->winding = s->start.winding;
    const pendres_status status = extend(ctx, s, limit, points);
    if (status != PENDRES_OK) return status;
    s->first = nearest(s->branch, s->parameter, s->from, &s->at, s->born, &off);
    if (s->born && !(off < near_birth)) return PENDRES_NOT_FOUND;
    if (!choose_way(s) || is_enough(s, take_stable(s, limit)) || points == most) return status;
  }
}

/* Begin the branch of the start, and follow it. */
static pendres_status follow(pendres_context *ctx, pendres_stretch *s, double limit)
{
  const size_t few = pendres_lyapunov_may_rotate(&s->start.pendulum) ? FEW_POINTS : MOST_POINTS;
  s->direction = limit >= s->from ? 1 : -1;
  pendres_status status = pendres_branch_begin(ctx, &s->start, s->parameter,
                                               spacing / s->start.period, &s->branch);
  if (status == PENDRES_OK) status = find_end(ctx, s, limit, few, most_points(&s->start));
  if (status != PENDRES_OK) pendres_stretch_free(s);
  return status;
}

pendres_status pendres_stretch_from(pendres_context *ctx, const pendres_orbit *orbit,
                                    pendres_parameter parameter, double limit,
                                    pendres_stretch *out)
{
  *out = (pendres_stretch){.parameter = parameter, .start = *orbit, .at = *orbit,
                           .from = pendres_parameter_get(parameter, &orbit->pendulum)};
  return follow(ctx, out, limit);
}

pendres_status pendres_stretch_born(pendres_context *ctx, const pendres_bifurcation *at,
                                    double limit, pendres_stretch *out)
{
  *out = (pendres_stretch){.parameter = at->parameter, .at = at->orbit, .from = at->value,
                           .born = 1};
  pendres_status status = pendres_branch_switch(ctx, at, &out->start);
  if (status == PENDRES_OK) {
    const double there = pendres_parameter_get(at->parameter, &out->start.pendulum);
    const int towards = limit >= at->value ? there > at->value : there < at->value;
    status = towards ? follow(ctx, out, limit) : PENDRES_NOT_FOUND;
  }
  if (status == PENDRES_OK && pendres_stretch_last(out) == NULL) status = PENDRES_NOT_FOUND;
  if (status != PENDRES_OK) pendres_stretch_free(out);
  return status == PENDRES_NOT_CONVERGED ? PENDRES_NOT_FOUND : status;
}

pendres_status pendres_stretch_extend(pendres_context *ctx, pendres_stretch *s, double limit)
{
  const double same = same_value * pendres_parameter_scale(s->parameter), end = s->end_value;
  if (branch_end(s) != PENDRES_END_POINTS) return PENDRES_NOT_FOUND;
  const size_t most = 2 * s->points_each_way;
  const pendres_status status = find_end(ctx, s, limit, most, most);
  if (status != PENDRES_OK || s->end != PENDRES_STRETCH_STOPPED) return status;
  return ahead(s, s->end_value, end) > same ? PENDRES_OK : PENDRES_NOT_FOUND;
}

const pendres_branch_point *pendres_stretch_last(const pendres_stretch *s)
{
  for (size_t k = s->points; k-- > 0;)
    if (point_of(s, k)->bifurcation < 0) return point_of(s, k);
  return NULL;
}

pendres_status pendres_stretch_arrive(pendres_context *ctx, const pendres_stretch *s,
                                      pendres_orbit *out)
{
  pendres_status outcome = PENDRES_OK;
  const pendres_orbit *last = &pendres_stretch_last(s)->orbit;
  const pendres_orbit_guess guess = {.pendulum = last->pendulum, .x = last->x, .v = last->v,
                                     .period = last->period, .winding = last->winding};
  const pendres_status status =
    pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, out, &outcome);
  if (status == PENDRES_OK && outcome == PENDRES_NOT_CONVERGED) *out = *last;
  return status;
}

int pendres_stretch_holds(const pendres_stretch *s, double value)
{
  return s->branch != NULL &&
         (s->end == PENDRES_STRETCH_LIMIT || ahead(s, value, s->end_value) < 0.0);
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

pendres_status pendres_stretch_orbits(pendres_context *ctx, const pendres_stretch *s, size_t n,
                                      const double *value, pendres_orbit *out, int *found)
{
  if (n == 0) return PENDRES_OK;
  pendres_orbit_guess *guess = calloc(n, sizeof *guess);
  pendres_status *outcome = calloc(n, sizeof *outcome);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (guess == NULL || outcome == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for %zu orbits", n);
    goto done;
  }
  for (size_t i = 0, k = 0; i < n; i++) {
    while (k + 2 < s->points && ahead(s, value[i], value_of(s, k + 1)) > 0.0) k++;
    const pendres_branch_point *p = point_of(s, k);
    guess[i] = between(p, s->points > 1 ? point_of(s, k + 1) : p, s->parameter, value[i]);
    /* At its birth the orbit is still the one that it is born from, with that period and
       winding. */
    guess[i].period = s->period;
    guess[i].winding = s->winding;
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
