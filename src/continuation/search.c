/* search.c -- the fold or the cusp that a curve leads to; see continuation.h and follow.h. */
#include "continuation/curve/curve.h"

#include <math.h>

#include "continuation/curve/crossing.h"
#include "continuation/numbers.h"
#include "continuation/parameter.h"
#include "continuation/units.h"
#include "engine/context_internal.h"

/* Whether the parameter of a branch has left the range that is searched. */
static int is_far(const pendres_system *s, const pendres_curve_node *start,
                  const pendres_curve_node *here)
{
  const int place = s->unknown[2];
  const double from = start->u[place], value = here->u[place];
  if (s->condition != PENDRES_CONDITION_NONE) return 0;
  if (pendres_parameter_of((pendres_parameter)(place - PENDRES_U_OMEGA))->plain)
    return value > search_widest_range * from || value * search_widest_range < from;
  /* What may be negative, or 0, has no ratio. */
  return fabs(value - from) > (search_widest_range - 1.0) * fabs(from) + 1.0;
}

static double value_at(const pendres_goal *goal, const pendres_curve_node *start,
                       const pendres_curve_node *node)
{
  return goal->comes_back ? goal->value(node) - goal->value(start) : goal->value(node);
}

/* Go along a curve until the function changes its sign. */
static pendres_status search_one_way(pendres_context *ctx, pendres_follower *w,
                                     const pendres_goal *goal, void *out)
{
  const pendres_curve_node start = w->here;
  pendres_curve_node nodes[2] = {start};
  for (int i = 0; i < PENDRES_SEARCH_ADVANCES; i++) {
    pendres_status status = pendres_follow_advance(ctx, 1, &w);
    if (status != PENDRES_OK) return status;
    if (w->stuck) return PENDRES_NOT_FOUND;
    for (int k = 0; k < w->found; k++, nodes[0] = nodes[1]) {
      nodes[1] = w->ahead[k];
      const double before = value_at(goal, &start, &nodes[0]);
      const double now = value_at(goal, &start, &nodes[1]);
      pendres_u u;
      if (before == 0.0 || !(before * now <= 0.0)) continue;
      for (int m = 0; m < PENDRES_U_COUNT; m++)
        u[m] = nodes[0].u[m] + before / (before - now) * (nodes[1].u[m] - nodes[0].u[m]);
      status = goal->locate(ctx, &w->kind, nodes, u, out);
      if (status != PENDRES_NOT_CONVERGED) return status;
    }
    if (is_far(&w->kind.system, &start, &w->here) || w->here.growth > pendres_curve_wildest) break;
  }
  return PENDRES_NOT_FOUND;
}

/* By how much closer the function comes to 0 in a first step. */
static pendres_status approach_of(pendres_context *ctx, const pendres_follower *from,
                                  const pendres_goal *goal, double *approach)
{
  pendres_follower ahead = *from, *w = &ahead;
  const pendres_status status = pendres_follow_advance(ctx, 1, &w);
  *approach = ahead.found > 0 ? fabs(value_at(goal, &from->here, &from->here)) -
                                  fabs(value_at(goal, &from->here, &ahead.ahead[0]))
                              : -INFINITY;
  return status;
}

pendres_status pendres_follow_search(pendres_context *ctx, const pendres_followed *kind,
                                     const pendres_u u, const pendres_goal *goal,
                                     double first, void *out)
{
  pendres_follower way[2];
  double approach[2] = {first, -first};
  const int place = kind->system.unknown[2];
  for (int k = 0; k < 2; k++) {
    pendres_status status = pendres_follow_begin(ctx, kind, u, k == 0 ? 1.0 : -1.0, &way[k]);
    if (status == PENDRES_NOT_CONVERGED)
      return pendres_context_fail(
        ctx, status, "no %s to start from at %s %g", goal->start,
        pendres_name_get(PENDRES_NAMES_PARAMETER, place - PENDRES_U_OMEGA), u[place]);
    if (status == PENDRES_OK && first == 0.0)
      status = approach_of(ctx, &way[k], goal, &approach[k]);
    if (status != PENDRES_OK) return status;
  }
  const int k = approach[0] >= approach[1] ? 0 : 1;
  const pendres_status status = search_one_way(ctx, &way[k], goal, out);
  return status == PENDRES_NOT_FOUND ? search_one_way(ctx, &way[1 - k], goal, out) : status;
}

/* ---- the fold at the end of a branch ---- */

double pendres_curve_fold(const pendres_curve_node *node)
{
  return pendres_map_fold(&node->image);
}

/* Where branches cross the determinant changes its sign, too. */
static pendres_status locate_fold(pendres_context *ctx, const pendres_followed *kind,
                                  const pendres_curve_node nodes[2], const pendres_u u, void *out)
{
  const int place = kind->system.unknown[2];
  if (pendres_crossing_bordered(&nodes[0].image, place, nodes[0].tangent) *
        pendres_crossing_bordered(&nodes[1].image, place, nodes[1].tangent) < 0.0)
    return PENDRES_NOT_CONVERGED;
  return pendres_curve_locate(ctx, kind, PENDRES_CONDITION_FOLD, u,
                              2.0 * (nodes[1].arclength - nodes[0].arclength), out);
}

static pendres_status fold_find(pendres_context *ctx, const pendres_orbit *near,
                                pendres_parameter parameter, pendres_fold *out)
{
  static const pendres_goal goal = {
    .start = "orbit", .value = pendres_curve_fold, .locate = locate_fold};
  if (near == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "orbit and out");
  const char *why = pendres_follow_refuses(near, parameter);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "fold: %s", why);
  pendres_u u;
  pendres_located located;
  const pendres_followed kind =
    pendres_followed_of(near, PENDRES_CONDITION_NONE, &parameter, pendres_search_spacing, u);
  const pendres_status status = pendres_follow_search(ctx, &kind, u, &goal, 0.0, &located);
  if (status == PENDRES_NOT_FOUND)
    return pendres_context_fail(ctx, status, "the branch through %s %g has no fold near",
                                pendres_name_get(PENDRES_NAMES_PARAMETER, parameter),
                                pendres_parameter_get(parameter, &near->pendulum));
  if (!pendres_located_found(status)) return status;
  const pendres_status measured = pendres_locate_bifurcation(
    ctx, PENDRES_CONDITION_FOLD, parameter, &located, out);
  if (measured != PENDRES_OK) return measured;
  if (status == PENDRES_TOLERANCE_UNREACHABLE)
    return pendres_context_fail(ctx, status, "the fold at %.12g is known to %.1e only", out->value,
                                out->value_error);
  return status;
}

pendres_status pendres_fold_find(pendres_context *ctx, const pendres_orbit *near,
                                 pendres_parameter parameter, pendres_fold *out)
{
  pendres_door d = pendres_door_open(ctx, near != NULL ? &near->pendulum : NULL);
  pendres_door_move(&d, parameter, parameter);
  PENDRES_DOOR_IN(&d, orbit, 1, near);
  PENDRES_DOOR_OUT(&d, bifurcation, 1, out);
  return PENDRES_DOOR_END(&d, fold_find(ctx, near, parameter, out));
}

/* ---- the cusp next to a fold ---- */

double pendres_curve_bending(const pendres_curve_node *node)
{
  return node->bending;
}

static pendres_status locate_cusp(pendres_context *ctx, const pendres_followed *kind,
                                  const pendres_curve_node nodes[2], const pendres_u u, void *out)
{
  return pendres_curve_locate(ctx, kind, PENDRES_CONDITION_CUSP, u,
                              2.0 * (nodes[1].arclength - nodes[0].arclength), out);
}

static pendres_status cusp_find(pendres_context *ctx, const pendres_fold *near,
                                pendres_parameter second, pendres_cusp *out)
{
  static const pendres_goal goal = {
    .start = "fold", .value = pendres_curve_bending, .locate = locate_cusp};
  if (near == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "fold and out");
  if (near->kind != PENDRES_FOLD)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "cusp: this is no fold");
  const char *why = pendres_follow_refuses(&near->orbit, near->parameter);
  if (why == NULL) why = pendres_follow_refuses(&near->orbit, second);
  if (why == NULL && second == near->parameter)
    why = "the second parameter must be another one than the fold's";
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "cusp: %s", why);
  pendres_u u;
  pendres_located located;
  const pendres_followed kind = pendres_followed_at(near, second, pendres_curve_spacing, u);
  const pendres_status status = pendres_follow_search(ctx, &kind, u, &goal, 0.0, &located);
  if (status == PENDRES_NOT_FOUND)
    return pendres_context_fail(ctx, status, "the curve of folds through %g leads to no cusp",
                                near->value);
  if (!pendres_located_found(status)) return status;
  const pendres_status measured = pendres_locate_cusp(ctx, kind.system.unknown, &located, out);
  if (measured != PENDRES_OK) return measured;
  if (status == PENDRES_TOLERANCE_UNREACHABLE)
    return pendres_context_fail(ctx, status, "the cusp is known to %.1e and %.1e only",
                                out->value_error[0], out->value_error[1]);
  return status;
}

pendres_status pendres_cusp_find(pendres_context *ctx, const pendres_fold *near,
                                 pendres_parameter second, pendres_cusp *out)
{
  pendres_door d = pendres_door_open(ctx, near != NULL ? &near->orbit.pendulum : NULL);
  const pendres_fold *inside = pendres_bifurcations_inside(&d, 1, near);
  if (near != NULL) pendres_door_move(&d, near->parameter, second);
  PENDRES_DOOR_OUT(&d, cusp, 1, out);
  return PENDRES_DOOR_END(&d, cusp_find(ctx, inside, second, out));
}
