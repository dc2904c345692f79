/*
 * cross.c -- where branches take a value, and where they cross; see continuation.h.
 */
#include "continuation/branch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "base/turns.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "continuation/units.h"
#include "continuation/parameter.h"
#include "model/model.h"

/* ---- one value of the parameter ---- */

double pendres_branch_value(const pendres_branch *b, size_t i)
{
  return pendres_parameter_get(b->parameter, &b->point[i].orbit.pendulum);
}

/* The Poincaré point on a chord, between whose ends x may differ by whole turns. */
static pendres_orbit_guess between(const pendres_branch *b, size_t i, size_t k, double part,
                                   double value)
{
  const pendres_orbit *p = &b->point[i].orbit, *q = &b->point[k].orbit;
  const double dx = pendres_less_turns(q->x - p->x, pendres_model_turn(&p->pendulum));
  return (pendres_orbit_guess){
    .pendulum = pendres_parameter_with(&p->pendulum, b->parameter, value),
    .x = p->x + part * dx,
    .v = p->v + part * (q->v - p->v),
    .period = p->period,
    .winding = p->winding};
}

static pendres_status branch_cross(pendres_context *ctx, const pendres_branch *b, double value,
                                   size_t room, pendres_orbit *out, size_t *found)
{
  if (b == NULL || found == NULL || (room > 0 && out == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "branch, out and found");
  if (!isfinite(value))
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "the value must be finite");
  *found = 0;
  const int closed = b->end[0] == PENDRES_END_CLOSED;
  const size_t chords = b->count > 1 ? (closed ? b->count : b->count - 1) : 0;
  pendres_orbit_guess *guess = calloc(chords + 1, sizeof *guess);
  pendres_orbit *orbit = malloc((chords + 1) * sizeof *orbit);
  pendres_status *outcome = malloc((chords + 1) * sizeof *outcome);
  pendres_status status = PENDRES_OK;
  size_t n = 0;
  if (guess == NULL || orbit == NULL || outcome == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for orbits");
    goto done;
  }
  for (size_t i = 0; i < chords; i++) {
    const size_t k = (i + 1) % b->count;
    const double from = pendres_branch_value(b, i) - value, to = pendres_branch_value(b, k) - value;
    /* A value that a point has exactly belongs to the chord that begins there. */
    if (from == 0.0 || from * to < 0.0)
      guess[n++] = between(b, i, k, from == 0.0 ? 0.0 : from / (from - to), value);
    else if (to == 0.0 && k == b->count - 1 && !closed)
      guess[n++] = between(b, i, k, 1.0, value);
  }
  status = pendres_orbit_refine(ctx, n, guess, PENDRES_ORBIT_PLAIN, orbit, outcome);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    if (outcome[i] == PENDRES_NOT_CONVERGED) continue;
    if (*found < room) out[*found] = orbit[i];
    ++*found;
  }
done:
  free(guess);
  free(orbit);
  free(outcome);
  return status;
}

pendres_status pendres_branch_cross(pendres_context *ctx, const pendres_branch *b, double value,
                                    size_t room, pendres_orbit *out, size_t *found)
{
  pendres_door d;
  pendres_door_open(&d, ctx, b != NULL && b->count > 0 ? &b->point[0].orbit.pendulum : NULL);
  if (b != NULL) pendres_door_move(&d, b->parameter, b->parameter);
  const pendres_branch *inside = pendres_branch_inside(&d, b);
  pendres_orbit *orbit = pendres_door_out(&d, &pendres_dim_orbit, room, out);
  PENDRES_DOOR_CALL(&d, branch_cross(ctx, inside, value / d.scales.first, room, orbit, found));
  return pendres_door_close(&d);
}

/* ---- branches that cross ---- */

/* The orbit where a trail of one point meets the plane across its tangent; *good: 0 if there is
   none within `reach` of where it was, in the scale of arclength. */
static pendres_status meet_plane(pendres_context *ctx, const pendres_trail *one, double reach,
                                 pendres_orbit *out, int *good)
{
  pendres_continuation_pair pair;
  double error[1][2];
  const pendres_status status = pendres_trail_polish(ctx, one, &pair, error);
  *good = status == PENDRES_OK && error[0][0] < 1e-6 &&
          pendres_arc_distance(pair.fine, one->point->u) <= reach;
  return *good ? pendres_continuation_orbit_measure(ctx, 1, &pair, out)
         : status == PENDRES_NOT_CONVERGED ? PENDRES_OK : status;
}

/* The other branch at a branch point, a little along its direction, one way or the other. It leaves
   that direction with the square of the distance, the branch itself in proportion to it. */
static pendres_status switch_crossing(pendres_context *ctx, const pendres_bifurcation *at,
                                      pendres_orbit *out)
{
  static const double longest = 0.02, straight = 0.05;
  enum { HALVINGS = 6 };
  double u[PENDRES_U_COUNT], way[PENDRES_ARC_UNKNOWNS] = {0.0}, scale[3], length = 0.0;
  const pendres_arc one =
    pendres_arc_of(&at->orbit, PENDRES_CONDITION_NONE, &at->parameter, 0.05, u);
  way[0] = at->crossing[0];
  way[1] = at->crossing[1];
  way[2] = at->crossing[2];
  if (one.unknown[2] == PENDRES_U_OMEGA) way[1] -= u[PENDRES_U_W] * way[2];
  way[1] /= u[PENDRES_U_OMEGA];
  for (int k = 0; k < 3; k++) scale[k] = pendres_arc_scale(one.unknown[k], u[one.unknown[k]]);
  for (int k = 0; k < 3; k++) way[k] /= scale[k];
  for (int k = 0; k < 3; k++) length = hypot(length, way[k]);
  for (int k = 0; k < 3; k++) way[k] /= length;
  for (int halving = 0; halving < HALVINGS; halving++) {
    const double away = ldexp(longest, -halving);
    int found = 0;
    for (int side = 1; side >= -1; side -= 2) {
      pendres_orbit here;
      pendres_arc_point point = {.arclength = 0.0};
      const pendres_trail trail = {.kind = one, .count = 1, .point = &point};
      int good = 0;
      memcpy(point.tangent, way, sizeof way);
      memcpy(point.u, u, sizeof u);
      for (int k = 0; k < 3; k++)
        point.u[one.unknown[k]] += side * away * way[k] * scale[k];
      const pendres_status status = meet_plane(ctx, &trail, straight * away, &here, &good);
      if (status != PENDRES_OK) return status;
      if (good && (!found || here.stable)) *out = here;
      found += good;
    }
    if (found == 2) return PENDRES_OK;
  }
  return pendres_context_fail(ctx, PENDRES_NOT_FOUND, "no crossing branch could be entered");
}

static pendres_status branch_switch(pendres_context *ctx, const pendres_bifurcation *at,
                                    pendres_orbit *out)
{
  if (at == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "bifurcation and out");
  if (at->kind != PENDRES_PERIOD_DOUBLING && at->kind != PENDRES_SYMMETRY_BREAKING &&
      at->kind != PENDRES_BRANCH_POINT)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "no branch crosses at a bifurcation of this kind");
  const char *why = pendres_continuation_refuses(&at->orbit, at->parameter);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "branch: %s", why);
  if (at->kind == PENDRES_BRANCH_POINT) return switch_crossing(ctx, at, out);
  double u[PENDRES_U_COUNT];
  pendres_continuation_image image;
  int steps = 0;
  pendres_arc one =
    pendres_arc_of(&at->orbit, PENDRES_CONDITION_NONE, &at->parameter, 0.05, u);
  if (at->kind == PENDRES_PERIOD_DOUBLING) pendres_continuation_map_unfold(&one.map);
  pendres_status status =
    pendres_continuation_map_steps(ctx, one.map.force, u, pendres_accuracy_first(ctx), &steps);
  if (status == PENDRES_OK)
    status = pendres_continuation_map_states(ctx, &one.map, steps, 1,
                                             (const double (*)[PENDRES_U_COUNT])u, &image);
  if (status != PENDRES_OK) return status;
  /* The null vector of N + I: the way in which the doubled map's orbits leave. */
  const double a = image.n[0][0] + 1.0, b = image.n[0][1], c = image.n[1][0],
               d = image.n[1][1] + 1.0;
  const int upper = hypot(a, b) > hypot(c, d);
  const double length = upper ? hypot(a, b) : hypot(c, d);
  const double v[2] = {(upper ? -b : -d) / length, (upper ? a : c) / length};

  pendres_trail twice = {.kind = one, .count = 1};
  pendres_continuation_map *map = &twice.kind.map;
  map->mirror = PENDRES_MIRROR_NONE;
  map->period = one.map.mirror ? one.map.period : 2 * one.map.period;
  map->winding = one.map.mirror ? 0 : 2 * one.map.winding;
  /* Orbits of a doubling cascade reach less and less far: by Feigenbaum's 2.5 each time. */
  const double reach = 0.02 * pow(one.map.period, -1.3);
  static const double tries[] = {1.0, 0.25, 0.0625, 2.0, 4.0, 8.0, 16.0};
  for (size_t k = 0; k < sizeof tries / sizeof *tries && reach * tries[k] < 0.5; k++) {
    const double away = reach * tries[k];
    pendres_arc_point point = {.tangent = {v[0], v[1], 0.0, 0.0}};
    pendres_continuation_pair pair;
    double error[1][2];
    memcpy(point.u, u, sizeof point.u);
    point.u[PENDRES_U_Y] += away * v[0];
    point.u[PENDRES_U_W] += away * v[1];
    twice.point = &point;
    status = pendres_trail_polish(ctx, &twice, &pair, error);
    if (status != PENDRES_OK) return status;
    if (error[0][0] > 1e-6 || fabs(pair.fine[PENDRES_U_Y] - point.u[PENDRES_U_Y]) > away) continue;
    /* Keep away from the branch that it came from, which the plane meets as well. Orbits of the
       other branch are on the far side after one map, and so twice as far away. */
    status = pendres_continuation_map_states(ctx, &one.map, steps, 1,
                                             (const double (*)[PENDRES_U_COUNT])pair.fine, &image);
    if (status != PENDRES_OK) return status;
    const double apart = hypot(image.f[0], image.f[1]);
    if (!(apart > away && apart < 4.0 * away)) continue;
    return pendres_continuation_orbit_measure(ctx, 1, &pair, out);
  }
  return pendres_context_fail(ctx, PENDRES_NOT_FOUND, "no crossing branch could be entered");
}

pendres_status pendres_branch_switch(pendres_context *ctx, const pendres_bifurcation *at,
                                     pendres_orbit *out)
{
  pendres_door d;
  pendres_door_open(&d, ctx, at != NULL ? &at->orbit.pendulum : NULL);
  const pendres_bifurcation *inside = pendres_bifurcations_inside(&d, 1, at);
  pendres_orbit *orbit = pendres_door_out(&d, &pendres_dim_orbit, 1, out);
  PENDRES_DOOR_CALL(&d, branch_switch(ctx, inside, orbit));
  return pendres_door_close(&d);
}
