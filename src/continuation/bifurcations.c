/* bifurcations.c -- curves of bifurcations in two parameters; see continuation.h. */
#include "continuation/curve/curve.h"

#include <math.h>
#include <string.h>

#include "base/grow.h"
#include "base/sized.h"
#include "continuation/numbers.h"
#include "continuation/parameter.h"
#include "continuation/units.h"
#include "engine/context_internal.h"

pendres_special pendres_curve_kind_get(const pendres_curve *c)
{
  return c != NULL ? pendres_special_of(c->kind.system.condition, &c->kind.system.map)
                   : PENDRES_REGULAR;
}

size_t pendres_curve_count(const pendres_curve *c)
{
  return c != NULL ? c->count : 0;
}

const pendres_curve_point *pendres_curve_get(const pendres_curve *c, size_t i)
{
  return c != NULL && i < c->count ? &c->point[i] : NULL;
}

size_t pendres_curve_cusp_count(const pendres_curve *c)
{
  return c != NULL ? c->specials : 0;
}

const pendres_cusp *pendres_curve_cusp_get(const pendres_curve *c, size_t i)
{
  return c != NULL && i < c->specials ? &c->cusp[i] : NULL;
}

pendres_parameter pendres_curve_parameter(const pendres_curve *c, int which)
{
  return c != NULL ? (pendres_parameter)(c->kind.system.unknown[2 + (which != 0)] - PENDRES_U_OMEGA)
                   : PENDRES_PARAMETER_COUNT;
}

pendres_followed pendres_followed_at(const pendres_bifurcation *b, pendres_parameter second,
                                     double spacing, pendres_u u)
{
  const pendres_parameter parameter[2] = {b->parameter, second};
  const pendres_condition condition =
    b->kind == PENDRES_FOLD           ? PENDRES_CONDITION_FOLD
    : b->kind == PENDRES_BRANCH_POINT ? PENDRES_CONDITION_CROSSING
                                      : PENDRES_CONDITION_FLIP;
  pendres_followed curve = pendres_followed_of(&b->orbit, condition, parameter, spacing, u);
  if (b->kind == PENDRES_PERIOD_DOUBLING) pendres_map_unfold(&curve.system.map);
  return curve;
}

/* ---- cusps ---- */

static pendres_status locate_cusp(pendres_context *ctx, const pendres_curve *c, const pendres_u u,
                                  double reach, pendres_curve_special *out)
{
  out->condition = PENDRES_CONDITION_CUSP;
  return pendres_curve_locate(ctx, &c->kind, out->condition, u, reach, &out->located);
}

static const pendres_curve_test cusps = {
  .function = pendres_curve_bending, .touch = 1, .locate = locate_cusp};

/* ---- points ---- */

/*
 * Second derivative of the first parameter by arclength in (x, v), see pendres_bifurcation, from
 * what the node knows: with A = N - I and its null vectors l and v,
 * d det A (v) = trace A / (l . v) * l . D2F(v, v).
 */
static double curvature_of(const pendres_system *s, const pendres_curve_node *p)
{
  if (s->condition != PENDRES_CONDITION_FOLD) return NAN;
  const pendres_u *j = (const pendres_u *)p->image.j;
  const double *v = p->null, omega = p->u[PENDRES_U_OMEGA];
  const int left = hypot(j[0][0], j[1][0]) > hypot(j[0][1], j[1][1]);
  const double l[2] = {left ? -j[1][0] : -j[1][1], left ? j[0][0] : j[0][1]};
  const double second = p->bending * (l[0] * v[0] + l[1] * v[1]) / (j[0][0] + j[1][1]);
  const int place = s->unknown[2];
  return -second / (l[0] * j[0][place] + l[1] * j[1][place]) /
         (v[0] * v[0] + omega * omega * v[1] * v[1]);
}

/* What callers see of point number k. */
static void fill_point(pendres_curve *c, size_t k)
{
  const pendres_curve_place *p = &c->place[k];
  const pendres_parameter parameter[2] = {pendres_curve_parameter(c, 0),
                                          pendres_curve_parameter(c, 1)};
  const pendres_cusp *s = p->special >= 0 ? &c->cusp[p->special] : NULL;
  const pendres_solution *pair = s != NULL ? &c->special[p->special].located.pair : &c->pair[p->i];
  memcpy(c->u[k], pair->fine, sizeof c->u[k]);
  c->point[k] = (pendres_curve_point){
    .cusp = p->special,
    .arclength = p->arclength,
    .curvature = s != NULL ? 0.0 : curvature_of(&c->kind.system, &c->node[p->i]),
    .orbit = s != NULL ? s->orbit : c->orbit[p->i]};
  for (int i = 0; i < 2; i++) {
    c->point[k].value[i] = pair->fine[c->kind.system.unknown[2 + i]];
    c->point[k].value_error[i] = s != NULL ? s->value_error[i] : c->error[p->i][i];
  }
  pendres_orbit_set_critical(pendres_curve_kind_get(c), 2, parameter, c->point[k].value_error,
                             &c->point[k].orbit);
}

static pendres_status finish(pendres_context *ctx, pendres_curve *c)
{
  pendres_status status = PENDRES_OK;
  if (c->kind.system.condition == PENDRES_CONDITION_FOLD)
    status = pendres_curve_find_specials(ctx, c, 1, &cusps);
  if (status == PENDRES_OK) status = pendres_curve_measure(ctx, c);
  if (status != PENDRES_OK) return status;
  if (!pendres_regrow(&c->cusp, c->specials + 1, sizeof *c->cusp) ||
      !pendres_regrow(&c->point, c->count + 1, sizeof *c->point) ||
      !pendres_regrow(&c->u, c->count + 1, sizeof *c->u))
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a curve");
  for (size_t k = 0; k < c->specials && status == PENDRES_OK; k++)
    status = pendres_locate_cusp(ctx, c->kind.system.unknown, &c->special[k].located, &c->cusp[k]);
  for (size_t k = 0; k < c->count && status == PENDRES_OK; k++) fill_point(c, k);
  return status;
}

/* ---- following ---- */

static const char *check(const pendres_bifurcation *start, const pendres_curve_options *o)
{
  if (PENDRES_SIZED_REFUSES(o) != NULL) return PENDRES_SIZED_REFUSES(o);
  for (int i = 0; i < 2; i++)
    if (!(o->low[i] < o->high[i] && isfinite(o->low[i]) && isfinite(o->high[i])))
      return "a parameter's range is empty";
  if (!(o->spacing >= 0.0 && o->wildest >= 0.0)) return "spacing and wildest must not be negative";
  if (start->kind == PENDRES_REGULAR || (unsigned)start->kind >= PENDRES_SPECIAL_COUNT)
    return "the start is no bifurcation";
  const char *why = pendres_follow_refuses(&start->orbit, start->parameter);
  if (why == NULL) why = pendres_follow_refuses(&start->orbit, o->second);
  if (why == NULL && start->parameter == o->second)
    why = "the second parameter is the first once more";
  return why;
}

static pendres_status curve_follow(pendres_context *ctx, const pendres_bifurcation *b,
                                   const pendres_curve_options *o, pendres_curve **out)
{
  if (o == NULL || b == NULL || out == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "start, options and out");
  *out = NULL;
  const char *why = check(b, o);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "curve: %s", why);
  const pendres_curve_bounds bounds = {.low = {o->low[0], o->low[1]},
                                       .high = {o->high[0], o->high[1]},
                                       .wildest =
                                         o->wildest > 0.0 ? o->wildest : bifurcations_wildest,
                                       .most_points = o->most_points};
  pendres_curve_start start;
  start.kind = pendres_followed_at(
    b, o->second, o->spacing > 0.0 ? o->spacing : pendres_curve_spacing, start.u);
  return pendres_curve_make(ctx, &start, &bounds, finish, out);
}

pendres_status pendres_curve_follow(pendres_context *ctx, const pendres_bifurcation *start,
                                    const pendres_curve_options *options, pendres_curve **out)
{
  pendres_door d = pendres_door_open(ctx, start != NULL ? &start->orbit.pendulum : NULL);
  const pendres_bifurcation *from = pendres_bifurcations_inside(&d, 1, start);
  const pendres_curve_options *o = pendres_curve_options_inside(&d, 1, start, options);
  PENDRES_DOOR_CALL(&d, curve_follow(ctx, from, o, out));
  if (d.status == PENDRES_OK) pendres_curve_leave(&d, *out);
  return pendres_door_close(&d);
}
