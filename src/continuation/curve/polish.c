/* polish.c -- the nodes of a curve to the tolerance, and its points in order; see curve.h. */
#include "continuation/curve/curve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "continuation/curve/numbers.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/kernels/coordinates.h"
#include "engine/steps.h"
#include "model/equation.h"
#include "orbits/orbit_measure.h"
#include "orbits/orbit_table.h"

/* The share of a branch's way that goes along its parameter, where the state counts as it is, or
   far out by its ratio: errors are such lengths. */
static double along_parameter(const pendres_system *s, const pendres_curve_node *at)
{
  const double size = pendres_arc_scale(&s->map, s->unknown[0], at->u);
  if (size >= 1.0) return at->tangent[2];
  const double state = size * hypot(at->tangent[0], at->tangent[1]);
  return at->tangent[2] / hypot(state, at->tangent[2]);
}

/*
 * The two computations of a point of a branch differ in the parameter as well. What an orbit at one
 * value of it is known to is their distance there: the coarser is moved along the branch. Next to a
 * fold that would lead around it: there a parameter that is off by so much moves the orbit by the
 * root of it.
 */
static void to_one_parameter(const pendres_system *s, const pendres_curve_node *at,
                             pendres_solution *pair)
{
  const int place = s->unknown[2];
  const double along = along_parameter(s, at);
  const double scale = pendres_arc_scale(&s->map, place, pair->fine);
  const double off = (pair->fine[place] - pair->coarse[place]) / scale;
  const double large = pendres_arc_large(&s->map, pair->fine);
  if (!(fabs(off) < polish_before_fold * along * along)) {
    pair->rounding += large * fabs(off) / fmax(fabs(along), sqrt(fabs(off)));
    return;
  }
  for (int k = 0; k < s->unknowns; k++)
    pair->coarse[s->unknown[k]] += pendres_arc_scale(&s->map, s->unknown[k], pair->fine) *
                                   at->tangent[k] * off / at->tangent[2];
  pair->coarse[place] = pair->fine[place];
  if (large == 1.0) pair->rounding /= fmax(fabs(along), polish_flattest);
}

/* Nodes that are still to be made more exact: their numbers, and what their correction needs. */
typedef struct polish {
  size_t left, *index;
  pendres_correction *point;
} polish;

static pendres_status begin(pendres_context *ctx, pendres_curve *c, const size_t *index, polish *p)
{
  const pendres_followed *kind = &c->kind;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < p->left && status == PENDRES_OK; k++) {
    const size_t i = p->index[k] = index != NULL ? index[k] : k;
    c->pair[i] = (pendres_solution){
      .map = kind->system.map,
      .critical = pendres_condition_rules_of(kind->system.condition)->critical};
    memcpy(c->pair[i].coarse, c->node[i].u, sizeof c->pair[i].coarse);
    status = pendres_map_steps(ctx, kind->system.map.force, c->node[i].u,
                               pendres_accuracy_first(ctx), &c->pair[i].coarse_steps);
  }
  return status;
}

/* The size that rounding sees: a radian or the unit of length, less on branches of what swings
   less. What swings by a fifth of a radian counts as if it swung by a whole one; equations of a
   bifurcation round entries of a matrix, which have a size of their own. */
static double rounded_size(const pendres_correction *c)
{
  static const double least = 1e-9, angle = 0.2;
  const pendres_system *s = &c->kind->system;
  const double whole = pendres_model_of(s->map.force)->angle ? angle : 1.0;
  const double far = hypot(c->u[PENDRES_U_Y], c->u[PENDRES_U_W]);
  const double large = pendres_arc_large(&s->map, c->u);
  const int critical = pendres_condition_rules_of(s->condition)->critical;
  return critical || large > 1.0 ? large : fmax(least, fmin(1.0, far / whole));
}

/* What rounding makes of a corrected point, across its tangent. Far out it is far more than of the
   parameter, and what a branch has at the parameter is meant: next to a fold it is bounded. */
static double rounding_of(const pendres_correction *c)
{
  const pendres_system *s = &c->kind->system;
  const double large = pendres_arc_large(&s->map, c->u);
  const double rounding = pendres_correction_rounding(c) * rounded_size(c);
  pendres_correction at = *c;
  if (large == 1.0 || s->unknowns > 3) return rounding;
  memset(at.tangent, 0, sizeof at.tangent);
  at.tangent[2] = 1.0;
  return fmin(pendres_correction_rounding(&at) * large, rounding / polish_flattest);
}

/* Correct all nodes that are left, with the coarser number of steps or with the finer one. */
static pendres_status correct(pendres_context *ctx, pendres_curve *curve, polish *w, int fine)
{
  enum { CHUNK = 1024 };
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < w->left; i++) {
    pendres_solution *p = &curve->pair[w->index[i]];
    const pendres_curve_node *at = &curve->node[w->index[i]];
    pendres_correction *c = &w->point[i];
    c->kind = &curve->kind;
    memcpy(c->tangent, at->tangent, sizeof c->tangent);
    if (at->held > 0) {
      memset(c->tangent, 0, sizeof c->tangent);
      c->tangent[at->held - 1] = 1.0;
    }
    if (fine) {
      const pendres_pendulum of = pendres_map_pendulum(p->map.force, p->coarse);
      p->fine_steps = pendres_steps_finer(&of, p->coarse_steps);
      p->fine_steps += p->fine_steps % 2;
    }
    c->steps = fine ? p->fine_steps : p->coarse_steps;
    memcpy(c->u, p->coarse, sizeof c->u);
  }
  for (size_t first = 0; first < w->left && status == PENDRES_OK; first += CHUNK)
    status = pendres_follow_correct(ctx, w->left - first < CHUNK ? w->left - first : CHUNK,
                                    w->point + first);
  for (size_t i = 0; i < w->left && status == PENDRES_OK; i++) {
    pendres_solution *p = &curve->pair[w->index[i]];
    /* A node that cannot be corrected stays where the follower left it, with an error that says
       so. */
    const pendres_correction *c = &w->point[i];
    const double rounding = rounding_of(c);
    memcpy(fine ? p->fine : p->coarse, w->point[i].u, sizeof p->fine);
    p->rounding = isnan(rounding) ? curve->kind.tolerance : rounding;
  }
  return status;
}

/* Whether node i of a branch is in the plane across the branch, and not at a given parameter. */
static int across(const pendres_curve *c, size_t i)
{
  return c->nodes > 1 && c->node[i].held == 0;
}

/* Errors of the parameters of node i; returns the largest error of all, as tolerances have it. */
static double errors_at(const pendres_curve *c, size_t i, double error[2])
{
  const pendres_system *s = &c->kind.system;
  const pendres_solution *p = &c->pair[i];
  const double point = hypot(p->fine[PENDRES_U_Y] - p->coarse[PENDRES_U_Y],
                             p->fine[PENDRES_U_W] - p->coarse[PENDRES_U_W]);
  /* Next to a fold the orbit at the parameter moves the more for it, see to_one_parameter(). */
  const double along = along_parameter(s, &c->node[i]);
  const double turning = across(c, i) ? fmax(fabs(along), polish_flattest) : 1.0;
  const double large = pendres_arc_large(&s->map, p->fine);
  const double less = large > 1.0 ? turning / large : 1.0; /* what the parameter has of it */
  const double chance = s->condition == PENDRES_CONDITION_LAG ? polish_agree_in_lag : polish_agree;
  double worst = 0.0;
  for (int k = 0; k < s->unknowns; k++) {
    const int place = s->unknown[k];
    const double scale = k >= 2 ? less * pendres_arc_scale(&s->map, place, p->fine) : 1.0;
    const double e =
      pendres_solution_error(p->coarse[place], p->fine[place],
                             scale * p->rounding + (k >= 2 ? less * chance * point : 0.0));
    if (k >= 2) error[k - 2] = e;
    worst = fmax(worst, k != 2                               ? e
                        : s->unknowns == 3 && turning < 1.0 ? 10.0 * large * e / turning
                                                             : large * e);
  }
  return worst;
}

/* Keep the nodes whose errors exceed the tolerance for another try, if there is to be one. */
static void keep_inexact(const pendres_options *options, int last, pendres_curve *c, polish *w)
{
  size_t again = 0;
  for (size_t k = 0; k < w->left; k++) {
    const size_t i = w->index[k];
    const double worst = errors_at(c, i, c->error[i]);
    if (!(worst > options->tolerance) || last || options->steps_per_period != 0) continue;
    c->pair[i].coarse_steps = c->pair[i].fine_steps;
    memcpy(c->pair[i].coarse, c->pair[i].fine, sizeof c->pair[i].coarse);
    w->index[again++] = i;
  }
  w->left = again;
}

pendres_status pendres_curve_polish(pendres_context *ctx, pendres_curve *c, size_t n,
                                    const size_t *index)
{
  pendres_room room = pendres_room_open(ctx, "points");
  polish w = {.left = n, .index = pendres_room_take(&room, n, sizeof *w.index),
              .point = pendres_room_take(&room, n, sizeof *w.point)};
  pendres_status status = room.status;
  if (status == PENDRES_OK) status = begin(ctx, c, index, &w);
  for (int attempt = 0; attempt < TRIES && w.left > 0 && status == PENDRES_OK; attempt++) {
    status = correct(ctx, c, &w, 0);
    if (status == PENDRES_OK) status = correct(ctx, c, &w, 1);
    if (status == PENDRES_OK) keep_inexact(&ctx->options, attempt + 1 == TRIES, c, &w);
  }
  for (size_t k = 0; k < n && status == PENDRES_OK && c->kind.system.unknowns == 3; k++) {
    const size_t i = index != NULL ? index[k] : k;
    if (across(c, i)) to_one_parameter(&c->kind.system, &c->node[i], &c->pair[i]);
  }
  return pendres_room_close(&room, status);
}

/* ---- all points ---- */

static pendres_status make_room(pendres_context *ctx, pendres_curve *c)
{
  const size_t n = c->nodes + 1;
  c->pair = malloc(n * sizeof *c->pair);
  c->orbit = malloc(n * sizeof *c->orbit);
  c->error = malloc(n * sizeof *c->error);
  c->place = malloc((n + c->specials) * sizeof *c->place);
  if (c->pair == NULL || c->orbit == NULL || c->error == NULL || c->place == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu points", n);
  return PENDRES_OK;
}

static void list_points(pendres_curve *c)
{
  size_t k = 0;
  c->count = 0;
  for (size_t i = 0; i < c->nodes; i++) {
    const double at = c->node[i].arclength;
    c->place[c->count++] = (pendres_curve_place){.i = i, .special = -1, .arclength = at};
    for (; k < c->specials && c->special[k].at.i == i; k++) {
      pendres_u u;
      const double chord = pendres_curve_between(c, &c->special[k].at, u);
      c->place[c->count++] = (pendres_curve_place){
        .i = i, .special = (int)k, .arclength = at + c->special[k].at.part * chord};
    }
  }
}

pendres_status pendres_curve_measure(pendres_context *ctx, pendres_curve *c)
{
  pendres_status status = make_room(ctx, c);
  if (status == PENDRES_OK) status = pendres_curve_polish(ctx, c, c->nodes, NULL);
  if (status == PENDRES_OK)
    status = pendres_solution_measure(ctx, c->nodes, c->pair, c->orbit);
  if (status == PENDRES_OK) list_points(c);
  return status;
}

/* ---- branches that only lead on ---- */

/* Make the nodes before and behind special points exact, so that these and the nodes are in the
   order of the parameter, too. */
static pendres_status polish_neighbours(pendres_context *ctx, pendres_curve *c)
{
  pendres_room room = pendres_room_open(ctx, "points");
  size_t *index = pendres_room_take(&room, 2 * c->specials, sizeof *index), n = 0;
  for (size_t k = 0; k < c->specials && room.status == PENDRES_OK; k++)
    for (size_t i = c->special[k].at.i; i <= c->special[k].at.i + 1 && i < c->nodes; i++)
      if (n == 0 || i > index[n - 1]) index[n++] = i;
  const pendres_status status = room.status;
  return pendres_room_close(
    &room, status == PENDRES_OK ? pendres_curve_polish(ctx, c, n, index) : status);
}

/* Of the derivative over all of the orbit's period, where Liouville's formula does not tell it. */
static double determinant_of(const pendres_map *map, const pendres_image *image)
{
  const int half = map->mirror == PENDRES_MIRROR_HALF ||
                   (map->mirror == PENDRES_MIRROR_WHOLE && map->period > 1);
  return half ? image->determinant * image->determinant : image->determinant;
}

/* The trace of the derivative over all of the orbit's period, from that of its map. */
static double trace_of(const pendres_map *map, const pendres_image *image)
{
  const double trace = image->trace;
  if (map->mirror == PENDRES_MIRROR_NONE) return trace;
  /* Of rest the map is the strobe map itself, followed by a reflection. */
  if (map->mirror == PENDRES_MIRROR_WHOLE && map->period == 1) return -trace;
  return trace * trace - 2.0 * image->determinant;
}

static pendres_orbit coarse_orbit(const pendres_solution *pair, const pendres_image *image)
{
  const double *u = pair->fine;
  const pendres_pendulum p = pendres_map_pendulum(pair->map.force, u);
  const pendres_coordinates place = {.y = u[PENDRES_U_Y], .w = u[PENDRES_U_W]};
  const double time = two_pi * pair->map.period / p.drive_frequency;
  pendres_orbit o = pendres_orbit_none(&p);
  pendres_coordinates_out(&p, &place, &o.x, &o.v);
  o.period = pair->map.period;
  o.winding = pair->map.mirror ? 0 : pair->map.winding;
  const double root = pendres_equation_left(0.5 * pendres_equation_contraction(&p) * time,
                                            sqrt(fabs(determinant_of(&pair->map, image))));
  pendres_orbit_set_multipliers(trace_of(&pair->map, image), root, &o);
  return o;
}

pendres_status pendres_curve_leave_coarse(pendres_context *ctx, pendres_curve *c)
{
  pendres_status status = make_room(ctx, c);
  for (size_t i = 0; i < c->nodes && status == PENDRES_OK; i++) {
    c->pair[i] = (pendres_solution){.map = c->kind.system.map};
    memcpy(c->pair[i].fine, c->node[i].u, sizeof c->pair[i].fine);
    c->error[i][0] = c->error[i][1] = c->kind.tolerance;
  }
  if (status == PENDRES_OK) status = polish_neighbours(ctx, c);
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < c->nodes; i++)
    c->orbit[i] = coarse_orbit(&c->pair[i], &c->node[i].image);
  list_points(c);
  return PENDRES_OK;
}
