/* fold.c -- the fold at the end of an orbit's branch; see continuation.h. */
#include <pendres/continuation.h>

#include <math.h>

#include "engine/context_internal.h"
#include "continuation/crossing.h"
#include "continuation/locate.h"
#include "continuation/parameter.h"
#include "continuation/units.h"
#include "continuation/arc.h"

enum { MOST_ADVANCES = 200 };
static const double widest_range = 3.0; /* of the parameter, as a ratio */
static const double wildest = 1e3; /* growth of errors in a map: such orbits do not come back */

/* Locate the fold between two points of opposite determinants. */
static pendres_status between(pendres_context *ctx, const pendres_arc *w,
                              const pendres_arc_point *a, const pendres_arc_point *b,
                              pendres_located *out)
{
  const double ga = pendres_continuation_map_fold(&a->image);
  const double gb = pendres_continuation_map_fold(&b->image);
  const double part = ga / (ga - gb);
  double u[PENDRES_U_COUNT];
  for (int i = 0; i < PENDRES_U_COUNT; i++) u[i] = a->u[i] + part * (b->u[i] - a->u[i]);
  const pendres_continuation_system folds =
    pendres_continuation_system_of(&w->map, PENDRES_CONDITION_FOLD, w->unknown);
  return pendres_continuation_locate(ctx, &folds, u, 2.0 * (b->arclength - a->arclength), out);
}

/* Whether the parameter at `place` has left the range in which folds are looked for. */
static int is_far(int place, double start, double value)
{
  if (place <= PENDRES_U_DRIVE) return value > widest_range * start || value * widest_range < start;
  /* What may be negative, or 0, has no ratio. */
  return fabs(value - start) > (widest_range - 1.0) * fabs(start) + 1.0;
}

/* Go along it until the determinant changes its sign. */
static pendres_status follow_to_fold(pendres_context *ctx, pendres_arc *w, pendres_located *out)
{
  const int place = w->unknown[2];
  const double start = w->here.u[place];
  pendres_arc_point last = w->here;
  for (int i = 0; i < MOST_ADVANCES; i++) {
    pendres_status status = pendres_arc_advance(ctx, 1, w);
    if (status != PENDRES_OK) return status;
    if (w->stuck) return PENDRES_NOT_FOUND;
    for (int k = 0; k < w->found; k++) {
      const pendres_arc_point *p = &w->ahead[k];
      const double before = pendres_continuation_map_fold(&last.image);
      /* Where branches cross it changes its sign, too. */
      const int crossed = pendres_crossing_bordered(&last.image, place, last.tangent) *
                            pendres_crossing_bordered(&p->image, place, p->tangent) < 0.0;
      if (!crossed && before != 0.0 && before * pendres_continuation_map_fold(&p->image) <= 0.0) {
        status = between(ctx, w, &last, p, out);
        if (status != PENDRES_NOT_CONVERGED) return status;
      }
      last = *p;
    }
    if (is_far(place, start, w->here.u[place])) break;
    if (w->here.growth > wildest) break;
  }
  return PENDRES_NOT_FOUND;
}

static pendres_status fold_find(pendres_context *ctx, const pendres_orbit *near,
                                pendres_parameter parameter, pendres_fold *out)
{
  if (near == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "orbit and out");
  const char *why = pendres_continuation_refuses(near, parameter);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "fold: %s", why);
  const double from = pendres_parameter_get(parameter, &near->pendulum);
  double u[PENDRES_U_COUNT], approach[2];
  pendres_located located;
  pendres_arc arc[2], ahead[2];
  pendres_status status = PENDRES_OK;
  for (int i = 0; i < 2; i++) {
    arc[i] = pendres_arc_of(near, PENDRES_CONDITION_NONE, &parameter, 0.1, u);
    status = pendres_arc_begin(ctx, &arc[i], u, i == 0 ? 1.0 : -1.0);
    if (status == PENDRES_NOT_CONVERGED)
      return pendres_context_fail(ctx, status, "no orbit to start from at %s %g",
                                  pendres_name_get(PENDRES_NAMES_PARAMETER, parameter), from);
    if (status != PENDRES_OK) return status;
    ahead[i] = arc[i];
  }
  /* Choose the direction in which the leading multiplier goes to +1. */
  status = pendres_arc_advance(ctx, 2, ahead);
  if (status != PENDRES_OK) return status;
  for (int i = 0; i < 2; i++) {
    const double here = fabs(pendres_continuation_map_fold(&arc[i].here.image));
    approach[i] = ahead[i].found > 0
                    ? here - fabs(pendres_continuation_map_fold(&ahead[i].ahead[0].image))
                    : -INFINITY;
  }
  const int first = approach[0] >= approach[1] ? 0 : 1;
  status = follow_to_fold(ctx, &arc[first], &located);
  if (status == PENDRES_NOT_FOUND) status = follow_to_fold(ctx, &arc[1 - first], &located);
  if (status == PENDRES_NOT_FOUND)
    return pendres_context_fail(ctx, status,
                                "the branch through %s %g has no fold near",
                                pendres_name_get(PENDRES_NAMES_PARAMETER, parameter), from);
  if (!pendres_located_found(status)) return status;
  const pendres_status measured = pendres_continuation_locate_finish(
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
  pendres_door d;
  pendres_door_open(&d, ctx, near != NULL ? &near->pendulum : NULL);
  pendres_door_move(&d, parameter, parameter);
  const pendres_orbit *o = pendres_door_in(&d, &pendres_dim_orbit, 1, near);
  pendres_fold *fold = pendres_door_out(&d, &pendres_dim_bifurcation, 1, out);
  PENDRES_DOOR_CALL(&d, fold_find(ctx, o, parameter, fold));
  return pendres_door_close(&d);
}
