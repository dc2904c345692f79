/* branch.c -- branches of periodic orbits in one parameter; see continuation.h. */
#include "continuation/branch.h"

#include <math.h>
#include <string.h>

#include "base/grow.h"
#include "base/sized.h"
#include "continuation/curve/crossing.h"
#include "continuation/curve/curve.h"
#include "continuation/numbers.h"
#include "continuation/parameter.h"
#include "continuation/units.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"

void pendres_branch_free(pendres_branch *b)
{
  if (b != NULL) pendres_curve_free(&b->curve);
}

size_t pendres_branch_count(const pendres_branch *b)
{
  return b != NULL ? b->curve.count : 0;
}

const pendres_branch_point *pendres_branch_get(const pendres_branch *b, size_t i)
{
  return b != NULL && i < b->curve.count ? &b->curve.branch_point[i] : NULL;
}

size_t pendres_branch_bifurcation_count(const pendres_branch *b)
{
  return b != NULL ? b->curve.specials : 0;
}

const pendres_bifurcation *pendres_branch_bifurcation_get(const pendres_branch *b, size_t i)
{
  return b != NULL && i < b->curve.specials ? &b->curve.bifurcation[i] : NULL;
}

pendres_branch_end pendres_branch_end_get(const pendres_branch *b, int which)
{
  return b != NULL ? b->curve.end[which != 0] : PENDRES_END_STUCK;
}

/* ---- bifurcations on the way ---- */

static double test_flip(const pendres_curve_node *p)
{
  return pendres_map_flip(&p->image);
}

/* Half map number `which` of a branch's, about the place that an orbit at u is about, and by how
   far that misses closing by it. PENDRES_NOT_CONVERGED: there is none. */
static pendres_status half_at(pendres_context *ctx, const pendres_curve *t, int which,
                              const pendres_u u, pendres_map *half, double *off)
{
  int steps = 0;
  pendres_map_miss miss = {.off = {NAN, NAN}};
  if (!pendres_map_half(&t->kind.system.map, which, half))
    return PENDRES_NOT_CONVERGED;
  pendres_status status =
    pendres_map_steps(ctx, t->kind.system.map.force, u, pendres_accuracy_first(ctx), &steps);
  if (status == PENDRES_OK)
    status = pendres_map_closes(ctx, half, steps, 1, (const pendres_u *)u, &miss);
  half->winding = miss.winding;
  *off = hypot(miss.off[0], miss.off[1]);
  return status;
}

/* Find the number of the half map by which an orbit at a place nearly closes; -1: by none. */
static pendres_status closing_half(pendres_context *ctx, const pendres_curve *t,
                                   const pendres_u u, int *which)
{
  for (*which = 0; *which < PENDRES_MAP_HALVES; ++*which) {
    pendres_map half;
    double off = NAN;
    const pendres_status status = half_at(ctx, t, *which, u, &half, &off);
    if (status == PENDRES_NOT_CONVERGED) break;
    if (status != PENDRES_OK || off < curve_near_birth) return status;
  }
  *which = -1;
  return PENDRES_OK;
}

/* Locate where the branch was born from orbits of the half map that the zero tells: a flip of
   that. */
static pendres_status locate_birth(pendres_context *ctx, const pendres_curve *t, const pendres_u u,
                                   double reach, pendres_curve_special *m)
{
  pendres_map half;
  pendres_located flip;
  double off = NAN;
  pendres_status status = half_at(ctx, t, m->at.half, u, &half, &off);
  const pendres_system flips =
    pendres_system_of(&half, PENDRES_CONDITION_FLIP, t->kind.system.unknown);
  if (status == PENDRES_OK) status = pendres_locate(ctx, &flips, u, reach, &flip);
  if (!pendres_located_found(status)) return status;
  m->condition = PENDRES_CONDITION_FLIP;
  m->located = flip;
  return status;
}

/* Whether a branch is of rest, or of orbits that share its map. */
static int is_of_rest(const pendres_curve *t)
{
  const pendres_map *map = &t->kind.system.map;
  return map->mirror == PENDRES_MIRROR_WHOLE && map->period <= 2;
}

/* Whether a branch point lies behind node i: the folds' test function has a zero there as well. */
static int is_crossed(const pendres_curve *t, size_t i)
{
  for (size_t k = 0; k < t->specials; k++)
    if (t->special[k].condition == PENDRES_CONDITION_CROSSING && t->special[k].at.i == i) return 1;
  return 0;
}

/* Whether the branch was born behind node i: other tests have zeros there as well. Its own flips
   are looked for last. */
static int is_born(const pendres_curve *t, size_t i)
{
  for (size_t k = 0; k < t->specials; k++)
    if (t->special[k].condition == PENDRES_CONDITION_FLIP && t->special[k].at.i == i) return 1;
  return 0;
}

/*
 * Locate a zero of the fold's test function. Where a branch was born from another it turns back.
 * That looks like a fold of its own map, but is a flip of a half map, the one by which the orbits
 * close there. An orbit that closes by half where the half map has no flip is at a fold.
 */
static pendres_status locate_fold(pendres_context *ctx, const pendres_curve *t, const pendres_u u,
                                  double reach, pendres_curve_special *m)
{
  int which = -1;
  m->condition = PENDRES_CONDITION_FOLD;
  if (is_crossed(t, m->at.i) || is_born(t, m->at.i)) return PENDRES_NOT_CONVERGED;
  /* Rest has no folds: there the other map has a flip. */
  if (is_of_rest(t) && !t->kind.apart) return locate_birth(ctx, t, u, reach, m);
  const pendres_status fold =
    pendres_curve_locate(ctx, &t->kind, m->condition, u, reach, &m->located);
  const int found = pendres_located_found(fold);
  if (!found && fold != PENDRES_NOT_CONVERGED) return fold;
  const pendres_status asked = closing_half(ctx, t, found ? m->located.pair.coarse : u, &which);
  if (asked != PENDRES_OK) return asked;
  if (found && which < 0) return fold;
  /* So close to a birth that the fold is known less well than the zero, the birth is the same. */
  const double *error = m->located.error;
  const double near = found ? fmax(reach, hypot(error[0], error[1])) : reach;
  m->at.half = which > 0 ? which : 0;
  const pendres_status born = locate_birth(ctx, t, u, near, m);
  return born == PENDRES_NOT_CONVERGED ? fold : born;
}

/* Locate where another branch crosses. Where this one was born from orbits that close by half it
   meets itself, and of rest the other map has a flip. */
static pendres_status locate_crossing(pendres_context *ctx, const pendres_curve *t,
                                      const pendres_u u, double reach, pendres_curve_special *m)
{
  int which = -1;
  m->condition = PENDRES_CONDITION_CROSSING;
  if (is_of_rest(t) || is_born(t, m->at.i)) return PENDRES_NOT_CONVERGED;
  const pendres_status status =
    pendres_curve_locate(ctx, &t->kind, m->condition, u, reach, &m->located);
  if (!pendres_located_found(status) || t->kind.apart == 0) return status;
  const pendres_status asked = closing_half(ctx, t, m->located.pair.coarse, &which);
  return asked != PENDRES_OK ? asked : which >= 0 ? PENDRES_NOT_CONVERGED : status;
}

static pendres_status locate_flip(pendres_context *ctx, const pendres_curve *t, const pendres_u u,
                                  double reach, pendres_curve_special *m)
{
  m->condition = PENDRES_CONDITION_FLIP;
  return pendres_curve_locate(ctx, &t->kind, m->condition, u, reach, &m->located);
}

/* Births and branch points come first, since the test function of folds may have a zero or two
   there. */
static const pendres_curve_test tests[] = {
  {.find = pendres_curve_find_births, .locate = locate_birth},
  {.find = pendres_curve_find_crossings, .locate = locate_crossing},
  {.function = pendres_curve_fold, .refine = 1, .touch = 1, .locate = locate_fold},
  {.function = test_flip, .refine = 1, .locate = locate_flip}};

/* ---- points ---- */

/* Tell a branch point which way the other branch goes. */
static pendres_status set_crossing(pendres_context *ctx, const pendres_curve *t,
                                   const pendres_curve_special *s, pendres_bifurcation *b)
{
  const pendres_solution *p = &s->located.pair;
  const int *unknown = t->kind.system.unknown;
  pendres_system system = pendres_system_of(&p->map, s->condition, unknown);
  double way[3];
  system.steps = p->fine_steps;
  const pendres_status status =
    pendres_crossing_direction(ctx, &system, p->fine, t->node[s->at.i].tangent, way);
  if (status != PENDRES_OK) return status == PENDRES_NOT_CONVERGED ? PENDRES_OK : status;
  for (int k = 0; k < 3; k++) way[k] *= pendres_arc_scale(&p->map, unknown[k], p->fine);
  way[1] *= p->fine[PENDRES_U_OMEGA]; /* of w = v / omega */
  if (unknown[2] == PENDRES_U_OMEGA) way[1] += p->fine[PENDRES_U_W] * way[2];
  memcpy(b->crossing, way, sizeof way);
  return PENDRES_OK;
}

/* What callers see of a branch. */
static pendres_status fill(pendres_context *ctx, pendres_curve *c)
{
  if (!pendres_regrow(&c->bifurcation, c->specials + 1, sizeof *c->bifurcation) ||
      !pendres_regrow(&c->branch_point, c->count + 1, sizeof *c->branch_point))
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
  for (size_t k = 0; k < c->specials; k++) {
    const pendres_curve_special *s = &c->special[k];
    pendres_status status = pendres_locate_bifurcation(
      ctx, s->condition, pendres_curve_parameter(c, 0), &s->located, &c->bifurcation[k]);
    if (status == PENDRES_OK && s->condition == PENDRES_CONDITION_CROSSING)
      status = set_crossing(ctx, c, s, &c->bifurcation[k]);
    if (s->flat) {
      c->bifurcation[k].curvature_error += fabs(c->bifurcation[k].curvature);
      c->bifurcation[k].curvature = 0.0;
    }
    if (status != PENDRES_OK) return status;
  }
  for (size_t k = 0; k < c->count; k++) {
    const pendres_curve_place *p = &c->place[k];
    const pendres_bifurcation *f = p->special >= 0 ? &c->bifurcation[p->special] : NULL;
    c->branch_point[k] =
      (pendres_branch_point){.kind = f != NULL ? f->kind : PENDRES_REGULAR,
                             .bifurcation = p->special,
                             .arclength = p->arclength,
                             .parameter_error = f != NULL ? f->value_error : c->error[p->i][0],
                             .orbit = f != NULL ? f->orbit : c->orbit[p->i]};
  }
  return PENDRES_OK;
}

/* Sign of (1 - m1)(1 - m2) at a node; 0 where rounding decides it. */
static int sign_at(const pendres_curve_node *p)
{
  const double half = 0.5 * p->image.trace, square = half * half - p->image.determinant;
  const double leading = square > 0.0 ? half + sqrt(square) : 0.0;
  if (square > 0.0 && fabs(1.0 - leading) < curve_untold) return 0;
  return pendres_curve_fold(p) > 0.0 ? 1 : -1;
}

/*
 * Next to a cusp two folds may be so close that orbits between them cannot be told from folds, and
 * one is found. Of an odd number of folds between nodes that tell the same sign one is flat.
 */
static void find_flat(pendres_curve *c)
{
  size_t first = 0, last = 0;
  int sign = 0;
  for (size_t i = 0; i < c->nodes; i++) {
    const int here = sign_at(&c->node[i]);
    size_t folds = 0, fold = 0;
    if (here == 0) continue;
    while (last < c->specials && c->special[last].at.i < i) last++;
    for (; first < last; first++) {
      const pendres_condition condition = c->special[first].condition;
      if (condition != PENDRES_CONDITION_FOLD && condition != PENDRES_CONDITION_CROSSING) continue;
      if (folds++ < 2) fold = first; /* of three the one in the middle */
    }
    if (sign == here && folds % 2 != 0)
      c->special[fold].flat = c->special[fold].condition == PENDRES_CONDITION_FOLD;
    sign = here;
  }
}

static pendres_status find_bifurcations(pendres_context *ctx, pendres_curve *c)
{
  const pendres_status status =
    pendres_curve_find_specials(ctx, c, sizeof tests / sizeof *tests, tests);
  if (status == PENDRES_OK && c->specials > 0) find_flat(c);
  return status;
}

static pendres_status finish(pendres_context *ctx, pendres_curve *c)
{
  pendres_status status = find_bifurcations(ctx, c);
  if (status == PENDRES_OK) status = pendres_curve_measure(ctx, c);
  if (status == PENDRES_OK) status = fill(ctx, c);
  if (status == PENDRES_OK) pendres_branch_check(c);
  return status;
}

/* ---- following ---- */

const char *pendres_branch_refuses(const pendres_branch_options *o, size_t n,
                                   const pendres_orbit *starts)
{
  if (PENDRES_SIZED_REFUSES(o) != NULL) return PENDRES_SIZED_REFUSES(o);
  if ((unsigned)o->parameter >= PENDRES_PARAMETER_FOLLOWED) return "unknown parameter";
  if (!(o->low < o->high && isfinite(o->low) && isfinite(o->high)))
    return "the range of the parameter is empty";
  if (o->parameter == PENDRES_DRIVE_FREQUENCY && !(o->low > 0.0))
    return "drive frequencies must be positive";
  if (o->parameter == PENDRES_DAMPING && !(o->low >= 0.0)) return "damping must not be negative";
  if (!(o->spacing >= 0.0 && o->wildest >= 0.0)) return "spacing and wildest must not be negative";
  for (size_t i = 0; i < n; i++) {
    const char *why = pendres_follow_refuses(&starts[i], o->parameter);
    if (why != NULL) return why;
  }
  return NULL;
}

static pendres_status branch_follow(pendres_context *ctx, const pendres_orbit *orbit,
                                    const pendres_branch_options *o, pendres_branch **out)
{
  if (o == NULL || orbit == NULL || out == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "start, options and out");
  *out = NULL;
  const char *why = pendres_branch_refuses(o, 1, orbit);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "branch: %s", why);
  const pendres_curve_bounds bounds = {
    .low = {o->low},
    .high = {o->high},
    .wildest = o->wildest > 0.0 ? o->wildest : pendres_curve_wildest,
    .most_points = o->most_points};
  pendres_curve_start start;
  pendres_curve *curve = NULL;
  start.kind = pendres_followed_of(orbit, PENDRES_CONDITION_NONE, &o->parameter,
                                   o->spacing > 0.0 ? o->spacing : pendres_curve_spacing, start.u);
  const pendres_status status = pendres_curve_make(ctx, &start, &bounds, finish, &curve);
  *out = pendres_branch_of(curve);
  return status;
}

pendres_status pendres_branch_begin(pendres_context *ctx, const pendres_orbit *orbit,
                                    pendres_parameter parameter, double spacing,
                                    pendres_branch **out)
{
  pendres_curve_start start;
  pendres_curve *curve = NULL;
  *out = NULL;
  const char *why = pendres_follow_refuses(orbit, parameter);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "branch: %s", why);
  start.kind = pendres_followed_of(orbit, PENDRES_CONDITION_NONE, &parameter, spacing, start.u);
  const pendres_status status = pendres_curve_begin(ctx, &start, &curve);
  *out = pendres_branch_of(curve);
  return status;
}

pendres_status pendres_branch_extend(pendres_context *ctx, pendres_branch *branch,
                                     const pendres_curve_bounds *bounds)
{
  pendres_curve *c = &branch->curve;
  pendres_status status = pendres_curve_extend(ctx, c, bounds);
  if (status == PENDRES_OK) status = find_bifurcations(ctx, c);
  if (status == PENDRES_OK) status = pendres_curve_leave_coarse(ctx, c);
  return status == PENDRES_OK ? fill(ctx, c) : status;
}

pendres_status pendres_branch_follow(pendres_context *ctx, const pendres_orbit *start,
                                     const pendres_branch_options *options, pendres_branch **out)
{
  pendres_door d = pendres_branch_open(ctx, start != NULL ? &start->pendulum : NULL, options);
  PENDRES_DOOR_IN(&d, orbit, 1, start);
  PENDRES_DOOR_IN(&d, branch_options, 1, options);
  PENDRES_DOOR_CALL(&d, branch_follow(ctx, start, options, out));
  if (d.status == PENDRES_OK) pendres_curve_leave(&d, &(*out)->curve);
  return pendres_door_close(&d);
}
