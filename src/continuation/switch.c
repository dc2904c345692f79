/* switch.c -- from a bifurcation onto the branch that crosses there; see continuation.h. */
#include "continuation/branch.h"

#include <math.h>
#include <string.h>

#include <pendres/strobe.h>

#include "continuation/numbers.h"
#include "continuation/parameter.h"
#include "continuation/units.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/kernels/coordinates.h"

/* Correct a node of a kind of orbits to where they meet the plane across its tangent; *error
   becomes that of the parameter. */
static pendres_status meet_plane(pendres_context *ctx, const pendres_followed *kind,
                                 pendres_curve_node *node, pendres_solution *pair, double *error)
{
  double errors[1][2] = {{NAN, NAN}};
  pendres_curve one = {.kind = *kind, .nodes = 1, .node = node, .pair = pair, .error = errors};
  const pendres_status status = pendres_curve_polish(ctx, &one, 1, NULL);
  *error = errors[0][0];
  return status;
}

/* The other branch at a branch point, a little along its direction, one way or the other. It leaves
   that direction with the square of the distance, the branch itself in proportion to it. */
static pendres_status switch_crossing(pendres_context *ctx, const pendres_bifurcation *at,
                                      pendres_orbit *out)
{
  pendres_u u;
  double way[PENDRES_UNKNOWNS] = {0.0}, scale[3], length = 0.0;
  const pendres_followed orbits =
    pendres_followed_of(&at->orbit, PENDRES_CONDITION_NONE, &at->parameter,
                        pendres_curve_spacing, u);
  const int *unknown = orbits.system.unknown;
  memcpy(way, at->crossing, sizeof at->crossing);
  if (unknown[2] == PENDRES_U_OMEGA) way[1] -= u[PENDRES_U_W] * way[2];
  way[1] /= u[PENDRES_U_OMEGA];
  for (int k = 0; k < 3; k++) {
    scale[k] = pendres_arc_scale(&orbits.system.map, unknown[k], u);
    way[k] /= scale[k];
  }
  for (int k = 0; k < 3; k++) length = hypot(length, way[k]);
  for (int k = 0; k < 3; k++) way[k] /= length;
  for (int halving = 0; halving < SWITCH_HALVINGS; halving++) {
    const double away = ldexp(switch_away, -halving);
    int found = 0;
    for (int side = 1; side >= -1; side -= 2) {
      pendres_orbit here;
      pendres_curve_node node = {.arclength = 0.0};
      pendres_solution pair;
      double error;
      memcpy(node.tangent, way, sizeof way);
      memcpy(node.u, u, sizeof u);
      for (int k = 0; k < 3; k++) node.u[unknown[k]] += side * away * way[k] * scale[k];
      pendres_status status = meet_plane(ctx, &orbits, &node, &pair, &error);
      if (status == PENDRES_NOT_CONVERGED) continue;
      const int good = status == PENDRES_OK && error < curve_untold &&
                       pendres_arc_distance(&pair.map, pair.fine, node.u) <=
                         switch_straight * away;
      if (good) status = pendres_solution_measure(ctx, 1, &pair, &here);
      if (status != PENDRES_OK) return status;
      if (good && (!found || here.stable)) *out = here;
      found += good;
    }
    if (found == 2) return PENDRES_OK;
  }
  return pendres_context_fail(ctx, PENDRES_NOT_FOUND, "no crossing branch could be entered");
}

/* The way in which orbits leave that close after two maps: the null vector of N + I. */
static pendres_status way_of_doubling(pendres_context *ctx, const pendres_map *once,
                                      const pendres_u u, int *steps, double v[2])
{
  pendres_image image;
  pendres_status status =
    pendres_map_steps(ctx, once->force, u, pendres_accuracy_first(ctx), steps);
  if (status == PENDRES_OK)
    status = pendres_map_states(ctx, once, *steps, 1, (const pendres_u *)u, &image);
  if (status != PENDRES_OK) return status;
  const double a = image.n[0][0] + 1.0, b = image.n[0][1], c = image.n[1][0],
               d = image.n[1][1] + 1.0;
  const int upper = hypot(a, b) > hypot(c, d);
  const double length = upper ? hypot(a, b) : hypot(c, d);
  v[0] = (upper ? -b : -d) / length;
  v[1] = (upper ? a : c) / length;
  return status;
}

pendres_status pendres_bifurcation_widest(pendres_context *ctx, const pendres_bifurcation *at,
                                          pendres_bifurcation *out)
{
  const pendres_orbit *o = &at->orbit;
  const pendres_pendulum p[2] = {o->pendulum, o->pendulum};
  pendres_u u;
  double way[2], widest = 1.0;
  int steps = 0;
  *out = *at;
  if (at->kind != PENDRES_PERIOD_DOUBLING || o->period == 1) return PENDRES_OK;
  pendres_followed once = pendres_followed_of(o, PENDRES_CONDITION_NONE, &at->parameter,
                                              pendres_curve_spacing, u);
  pendres_map_unfold(&once.system.map);
  pendres_status status = way_of_doubling(ctx, &once.system.map, u, &steps, way);
  if (status != PENDRES_OK) return status;
  double x[2] = {o->x, o->x + switch_beside * way[0]};
  double v[2] = {o->v, o->v + switch_beside * o->pendulum.drive_frequency * way[1]};
  for (int k = 1; k < o->period && status == PENDRES_OK; k++) {
    status = pendres_strobe_advance(ctx, 2, p, x, v, 1, NULL);
    const double wide = hypot(x[1] - x[0], (v[1] - v[0]) / o->pendulum.drive_frequency);
    if (!(wide > widest * switch_beside)) continue;
    widest = wide / switch_beside;
    pendres_coordinates here = pendres_coordinates_in(&o->pendulum, x[0], v[0]);
    here.turns = 0;
    pendres_coordinates_out(&o->pendulum, &here, &out->orbit.x, &out->orbit.v);
  }
  return status;
}

static pendres_status branch_switch(pendres_context *ctx, const pendres_bifurcation *at,
                                    pendres_orbit *out)
{
  if (at == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "bifurcation and out");
  if (at->kind != PENDRES_PERIOD_DOUBLING && at->kind != PENDRES_SYMMETRY_BREAKING &&
      at->kind != PENDRES_BRANCH_POINT)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "no branch crosses at a bifurcation of this kind");
  const char *why = pendres_follow_refuses(&at->orbit, at->parameter);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "branch: %s", why);
  if (at->kind == PENDRES_BRANCH_POINT) return switch_crossing(ctx, at, out);
  pendres_u u;
  pendres_image image;
  int steps = 0;
  pendres_followed twice =
    pendres_followed_of(&at->orbit, PENDRES_CONDITION_NONE, &at->parameter,
                        pendres_curve_spacing, u);
  pendres_map *map = &twice.system.map;
  if (at->kind == PENDRES_PERIOD_DOUBLING) pendres_map_unfold(map);
  const pendres_map once = *map;
  double v[2];
  pendres_status status = way_of_doubling(ctx, &once, u, &steps, v);
  if (status != PENDRES_OK) return status;
  map->mirror = PENDRES_MIRROR_NONE;
  map->period = once.mirror ? once.period : 2 * once.period;
  map->winding = once.mirror ? 0 : 2 * once.winding;
  /* Orbits of a doubling cascade reach less and less far: by Feigenbaum's 2.5 each time, or by its
     square, 6.3, where the Poincare point is not the one of the orbit's that moves most. */
  const double reach = switch_away * pow(once.period, -1.3);
  static const double tries[] = {1.0, 0.25, 0.0625, 2.0, 4.0, 8.0, 16.0, 1.0 / 64, 1.0 / 256};
  for (size_t k = 0; k < sizeof tries / sizeof *tries && reach * tries[k] < 0.5; k++) {
    const double away = reach * tries[k];
    pendres_curve_node node = {.tangent = {v[0], v[1], 0.0, 0.0}};
    pendres_solution pair;
    double error;
    memcpy(node.u, u, sizeof node.u);
    node.u[PENDRES_U_Y] += away * v[0];
    node.u[PENDRES_U_W] += away * v[1];
    status = meet_plane(ctx, &twice, &node, &pair, &error);
    if (status != PENDRES_OK) return status;
    if (error > curve_untold || fabs(pair.fine[PENDRES_U_Y] - node.u[PENDRES_U_Y]) > away) continue;
    /* Keep away from the branch that it came from, which the plane meets as well, and from others.
       Orbits of the one that crosses are on the far side after one map, and so twice as far away,
       with the bifurcation in the middle. */
    status = pendres_map_states(ctx, &once, steps, 1, (const pendres_u *)pair.fine, &image);
    if (status != PENDRES_OK) return status;
    const double apart = hypot(image.f[0], image.f[1]);
    const double middle = hypot(pair.fine[PENDRES_U_Y] + 0.5 * image.f[0] - u[PENDRES_U_Y],
                                pair.fine[PENDRES_U_W] + 0.5 * image.f[1] - u[PENDRES_U_W]);
    if (!(apart > away && apart < 4.0 * away && middle < switch_middle * away)) continue;
    return pendres_solution_measure(ctx, 1, &pair, out);
  }
  return pendres_context_fail(ctx, PENDRES_NOT_FOUND, "no crossing branch could be entered");
}

pendres_status pendres_branch_switch(pendres_context *ctx, const pendres_bifurcation *at,
                                     pendres_orbit *out)
{
  pendres_door d = pendres_door_open(ctx, at != NULL ? &at->orbit.pendulum : NULL);
  const pendres_bifurcation *inside = pendres_bifurcations_inside(&d, 1, at);
  PENDRES_DOOR_OUT(&d, orbit, 1, out);
  return PENDRES_DOOR_END(&d, branch_switch(ctx, inside, out));
}
