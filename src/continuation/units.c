/* units.c -- branches and curves behind the door; see units.h. */
#include "continuation/units.h"

#include <string.h>

#include "continuation/curve/curve.h"

typedef void convert(const pendres_scales *scales, const pendres_dimensions *d, size_t n,
                     void *records);

/* The scales of the door, with those of these parameters. */
static pendres_scales scales_of(const pendres_door *d, pendres_parameter first,
                                pendres_parameter second)
{
  pendres_door moved = *d;
  pendres_door_move(&moved, first, second);
  return moved.scales;
}

static void convert_bifurcations(const pendres_door *d, convert *way, size_t n,
                                 pendres_bifurcation *b)
{
  for (size_t i = 0; i < n; i++) {
    const pendres_scales s = scales_of(d, b[i].parameter, b[i].parameter);
    way(&s, &pendres_dim_bifurcation, 1, &b[i]);
  }
}

/* Points of map.h are y, w = dy/dtheta and the parameters. */
static void convert_points(const pendres_door *d, convert *way, size_t n, pendres_u *u)
{
  for (size_t i = 0; i < n; i++) {
    way(&d->scales, &pendres_dim_length, 2, &u[i][PENDRES_U_Y]);
    for (int k = PENDRES_U_OMEGA; k < PENDRES_U_COUNT; k++) {
      const pendres_parameter parameter = (pendres_parameter)(k - PENDRES_U_OMEGA);
      const pendres_scales s = scales_of(d, parameter, parameter);
      way(&s, &pendres_dim_first, 1, &u[i][k]);
    }
  }
}

static void convert_curve(const pendres_door *d, convert *way, pendres_curve *c)
{
  const int branch = pendres_curve_is_branch(c);
  const pendres_scales s = scales_of(d, pendres_curve_parameter(c, 0),
                                     pendres_curve_parameter(c, !branch));
  way(&s, &pendres_dim_length, 1, &c->kind.system.map.centre);
  if (branch) {
    way(&s, &pendres_dim_branch_point, c->count, c->branch_point);
    way(&s, &pendres_dim_bifurcation, c->specials, c->bifurcation);
  } else {
    way(&s, &pendres_dim_curve_point, c->count, c->point);
    way(&s, &pendres_dim_cusp, c->specials, c->cusp);
    convert_points(d, way, c->count, c->u);
  }
}

/* ---- copies ---- */

pendres_door pendres_branch_open(pendres_context *ctx, const pendres_pendulum *p,
                                 const pendres_branch_options *options)
{
  if (options == NULL || p == NULL) return pendres_door_open(ctx, p);
  const double ends[2] = {options->low, options->high};
  return pendres_door_open_along(ctx, p, options->parameter, 2, ends);
}

const pendres_bifurcation *pendres_bifurcations_inside(pendres_door *d, size_t n,
                                                       const pendres_bifurcation *b)
{
  if (b == NULL || !pendres_door_changes(d)) return b;
  pendres_bifurcation *inside = pendres_door_copy(d, b, n * sizeof *b);
  if (inside != NULL) convert_bifurcations(d, pendres_units_in, n, inside);
  return inside;
}

const pendres_curve_options *pendres_curve_options_inside(pendres_door *d, size_t n,
                                                          const pendres_bifurcation *b,
                                                          const pendres_curve_options *o)
{
  if (o != NULL && b != NULL && n > 0) pendres_door_move(d, b[0].parameter, o->second);
  return pendres_door_in(d, &pendres_dim_curve_options, 1, o);
}

static const pendres_curve *curve_inside(pendres_door *d, const pendres_curve *c)
{
  if (c == NULL || !pendres_door_changes(d)) return c;
  pendres_curve *inside = pendres_door_copy(d, c, sizeof *c);
  if (inside == NULL) return NULL;
  inside->branch_point = pendres_door_copy(d, c->branch_point, c->count * sizeof *c->branch_point);
  inside->bifurcation = pendres_door_copy(d, c->bifurcation, c->specials * sizeof *c->bifurcation);
  inside->point = pendres_door_copy(d, c->point, c->count * sizeof *c->point);
  inside->cusp = pendres_door_copy(d, c->cusp, c->specials * sizeof *c->cusp);
  inside->u = pendres_door_copy(d, c->u, c->count * sizeof *c->u);
  if (d->status == PENDRES_OK) convert_curve(d, pendres_units_in, inside);
  return inside;
}

const pendres_curve *pendres_curve_open(pendres_door *d, pendres_context *ctx,
                                        const pendres_curve *c)
{
  const int branch = c != NULL && pendres_curve_is_branch(c);
  const pendres_orbit *first = NULL;
  if (c != NULL && c->count > 0) first = branch ? &c->branch_point->orbit : &c->point->orbit;
  *d = pendres_door_open(ctx, first != NULL ? &first->pendulum : NULL);
  if (c != NULL)
    pendres_door_move(d, pendres_curve_parameter(c, 0), pendres_curve_parameter(c, !branch));
  return curve_inside(d, c);
}

const pendres_curves *pendres_curves_inside(pendres_door *d, const pendres_curves *set)
{
  if (set == NULL || !pendres_door_changes(d)) return set;
  pendres_curves *inside = pendres_door_copy(d, set, sizeof *set);
  pendres_curve **list = pendres_door_memory(d, (set->count + 1) * sizeof *list);
  for (size_t i = 0; i < set->count && list != NULL; i++) {
    const pendres_curve *c = curve_inside(d, set->curve[i]);
    memcpy(&list[i], &c, sizeof c);
  }
  if (inside != NULL) inside->curve = list;
  return inside;
}

/* ---- in place ---- */

void pendres_curve_leave(const pendres_door *d, pendres_curve *c)
{
  if (c != NULL && pendres_door_changes(d)) convert_curve(d, pendres_units_out, c);
}

void pendres_curves_enter(const pendres_door *d, pendres_curves *set)
{
  for (size_t i = 0; set != NULL && i < set->count && pendres_door_changes(d); i++)
    convert_curve(d, pendres_units_in, set->curve[i]);
}

void pendres_curves_leave(const pendres_door *d, pendres_curves *set)
{
  for (size_t i = 0; set != NULL && i < set->count; i++) pendres_curve_leave(d, set->curve[i]);
}
