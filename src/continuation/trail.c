/* trail.c -- whole curves within bounds; see trail.h. */
#include "continuation/trail.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/steps.h"

/* ---- one way of a start ---- */

/* The arcs under way: two for each start, and what they have found. */
typedef struct way {
  size_t count, capacity;
  pendres_arc_point *point; /* without the start */
  pendres_branch_end end;
  int going;
} way;

static int add(way *w, const pendres_arc_point *point)
{
  pendres_arc_point *grown = pendres_grow(w->point, w->count, &w->capacity, sizeof *grown);
  if (grown == NULL) return -1;
  w->point = grown;
  w->point[w->count++] = *point;
  return 0;
}

/* The bound of a parameter that a curve meets, and the point of the curve there. */
typedef struct landing {
  int unknown; /* number of the parameter among the unknowns */
  double bound;
  int landed; /* 0: there is no such point */
  pendres_arc_point point;
} landing;

/* Find the parameter among the unknowns that is out of its bounds, and that bound; 0: none is. */
static int out_of_bounds(const pendres_arc *w, const pendres_trail_bounds *b,
                         const double u[PENDRES_U_COUNT], landing *out)
{
  for (int k = 2; k < w->unknowns; k++) {
    const double value = u[w->unknown[k]];
    if (value < b->low[k - 2] || value > b->high[k - 2]) {
      out->unknown = k;
      out->bound = value < b->low[k - 2] ? b->low[k - 2] : b->high[k - 2];
      return 1;
    }
  }
  return 0;
}

/* Find the point of the curve on a bound, between the last point inside and the first outside. */
static pendres_status land(pendres_context *ctx, const pendres_arc *w,
                           const pendres_arc_point *inside, const pendres_arc_point *outside,
                           landing *out)
{
  const int k = out->unknown, place = w->unknown[k];
  const double bound = out->bound, way_out = outside->u[place] - inside->u[place];
  const double part = (bound - inside->u[place]) / way_out;
  pendres_arc_point *point = &out->point;
  pendres_arc_correction c = {.rounding = NAN};
  out->landed = 0;
  if (!(part > 0.0 && part < 1.0)) return PENDRES_OK;
  *point = *inside;
  for (int i = 0; i < PENDRES_U_COUNT; i++)
    c.u[i] = inside->u[i] + part * (outside->u[i] - inside->u[i]);
  c.u[place] = bound;
  c.tangent[k] = way_out > 0.0 ? 1.0 : -1.0;
  pendres_status status =
    pendres_continuation_map_steps(ctx, w->map.force, c.u, w->tolerance, &c.steps);
  if (status == PENDRES_OK) status = pendres_arc_correct(ctx, w, 1, &c);
  const double chord = pendres_arc_distance(inside->u, outside->u);
  if (status != PENDRES_OK || isnan(c.rounding) ||
      pendres_arc_distance(inside->u, c.u) > chord || fabs(c.u[place] - bound) > 1e-12)
    return status;
  memcpy(point->u, c.u, sizeof point->u);
  point->u[place] = bound;
  point->held = k + 1;
  point->arclength = inside->arclength + pendres_arc_distance(inside->u, c.u);
  point->bending = inside->bending + part * (outside->bending - inside->bending);
  /* What belongs to the place and not to the plane is taken from the way there. */
  for (int i = 0; i < w->unknowns; i++)
    point->tangent[i] = inside->tangent[i] + part * (outside->tangent[i] - inside->tangent[i]);
  const pendres_continuation_system system = pendres_arc_system(w, c.steps);
  status = pendres_continuation_map_images(ctx, &system, 1,
                                           (const double (*)[PENDRES_U_COUNT])&c.u, &point->image);
  out->landed = status == PENDRES_OK;
  return status;
}

/* By how many whole turns, as an angle, y of a point is larger than that of another. It is 0 for a
   half map, whose mirror stands in one place, and where the coordinate has no period. */
static double turns_between(const pendres_arc *w, const double from[PENDRES_U_COUNT],
                            const double to[PENDRES_U_COUNT])
{
  const double turn = pendres_model_of(w->map.force)->period;
  if (turn == 0.0 || w->map.mirror) return 0.0;
  return turn * rint((to[PENDRES_U_Y] - from[PENDRES_U_Y]) / turn);
}

/* Whether the chord from a to b passes the start in the start's own direction, whole turns away
   perhaps. */
static int passes(const pendres_arc *w, const pendres_arc_point *start,
                  const pendres_arc_point *a, const pendres_arc_point *b)
{
  double before = 0.0, behind = 0.0, along = 0.0, here[PENDRES_U_COUNT];
  memcpy(here, start->u, sizeof here);
  here[PENDRES_U_Y] += turns_between(w, start->u, a->u);
  for (int k = 0; k < w->unknowns; k++) {
    const int i = w->unknown[k];
    const double t = start->tangent[k];
    before += t * (a->u[i] - here[i]) / pendres_arc_scale(i, here[i]);
    behind += t * (b->u[i] - here[i]) / pendres_arc_scale(i, here[i]);
    along += t * b->tangent[k];
  }
  const double chord = pendres_arc_distance(a->u, b->u);
  return before < 0.0 && behind >= 0.0 && along > 0.9 &&
         pendres_arc_distance(a->u, here) <= chord &&
         pendres_arc_distance(b->u, here) <= chord;
}

/* Take over what an arc has found ahead of it. */
static pendres_status take(pendres_context *ctx, const pendres_arc *w,
                           const pendres_trail_bounds *b, const pendres_arc_point *start, way *to)
{
  pendres_status status = PENDRES_OK;
  if (w->stuck) {
    to->going = 0;
    to->end = PENDRES_END_STUCK;
  }
  for (int i = 0; i < w->found && to->going; i++) {
    const pendres_arc_point *p = &w->ahead[i];
    const pendres_arc_point *last = to->count > 0 ? &to->point[to->count - 1] : start;
    landing at;
    if (out_of_bounds(w, b, p->u, &at)) {
      to->going = 0;
      to->end = PENDRES_END_RANGE;
      status = land(ctx, w, last, p, &at);
      if (status != PENDRES_OK) return status;
      if (at.landed && add(to, &at.point) != 0) goto no_memory;
      break;
    }
    if (p->arclength > 4.0 * pendres_arc_distance(last->u, p->u) &&
        passes(w, start, last, p)) {
      to->going = 0;
      to->end = PENDRES_END_CLOSED;
      break;
    }
    if (add(to, p) != 0) goto no_memory;
    if (p->growth > b->wildest) {
      to->going = 0;
      to->end = PENDRES_END_WILD;
    } else if (to->count >= b->most_points) {
      to->going = 0;
      to->end = PENDRES_END_POINTS;
    }
  }
  return status;
no_memory:
  return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
}

/* ---- both ways ---- */

void pendres_trail_free(pendres_trail *trail)
{
  free(trail->point);
  *trail = (pendres_trail){0};
}

/* One curve of the way back, the start, and the way forth. */
static pendres_status join(pendres_context *ctx, const pendres_arc *kind,
                           const pendres_arc_point *start, way ways[2], pendres_trail *t)
{
  *t = (pendres_trail){.kind = *kind, .closed = ways[0].end == PENDRES_END_CLOSED};
  if (t->closed) ways[1].count = 0; /* it is the same curve in the other direction */
  t->count = ways[0].count + ways[1].count + 1;
  t->point = malloc(t->count * sizeof *t->point);
  if (t->point == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
  t->capacity = t->count;
  /* The end with the lower first parameter comes first. */
  const int place = kind->unknown[2];
  double end[2];
  for (int i = 0; i < 2; i++)
    end[i] = ways[i].count > 0 ? ways[i].point[ways[i].count - 1].u[place] : start->u[place];
  const int back = !t->closed && end[0] < end[1] ? 0 : 1, forth = 1 - back;
  size_t n = 0;
  for (size_t i = ways[back].count; i-- > 0;) {
    t->point[n] = ways[back].point[i];
    t->point[n].arclength = -t->point[n].arclength;
    for (int k = 0; k < kind->unknowns; k++) t->point[n].tangent[k] = -t->point[n].tangent[k];
    n++;
  }
  t->point[n] = *start;
  if (forth == 1)
    for (int k = 0; k < kind->unknowns; k++) t->point[n].tangent[k] = -t->point[n].tangent[k];
  n++;
  for (size_t i = 0; i < ways[forth].count; i++) t->point[n++] = ways[forth].point[i];
  if (t->closed) t->round = turns_between(kind, t->point[0].u, t->point[t->count - 1].u);
  const double shift = t->point[0].arclength;
  for (size_t i = 0; i < t->count; i++) t->point[i].arclength -= shift;
  t->end[0] = ways[back].end;
  t->end[1] = ways[forth].end;
  if (t->closed) t->end[0] = t->end[1] = PENDRES_END_CLOSED;
  return PENDRES_OK;
}

/* Advance the arcs that still go until none does. */
static pendres_status run(pendres_context *ctx, size_t n, pendres_arc *arcs,
                          const pendres_arc_point *starts, const pendres_trail_bounds *bounds,
                          way *ways)
{
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  size_t *index = malloc((n + 1) * sizeof *index);
  pendres_arc *some = malloc((n + 1) * sizeof *some);
  if (index == NULL || some == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for a branch");
    goto done;
  }
  status = PENDRES_OK;
  for (;;) {
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
      if (ways[i].going) {
        index[count] = i;
        some[count++] = arcs[i];
      }
    if (count == 0) break;
    status = pendres_arc_advance(ctx, count, some);
    for (size_t i = 0; i < count && status == PENDRES_OK; i++) {
      const size_t k = index[i];
      arcs[k] = some[i];
      status = take(ctx, &arcs[k], bounds, &starts[k], &ways[k]);
      /* The other way of a closed curve is the same curve. */
      if (ways[k].end == PENDRES_END_CLOSED && !ways[k].going && k % 2 == 0) ways[k + 1].going = 0;
    }
    if (status != PENDRES_OK) break;
  }
done:
  free(index);
  free(some);
  return status;
}

pendres_status pendres_trail_follow(pendres_context *ctx, size_t n,
                                    const pendres_trail_start *starts,
                                    const pendres_trail_bounds *bounds, pendres_trail *trails,
                                    size_t *which)
{
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  pendres_arc *arcs = calloc(2 * n + 1, sizeof *arcs);
  pendres_arc_point *begin = calloc(2 * n + 1, sizeof *begin);
  way *ways = calloc(2 * n + 1, sizeof *ways);
  memset(trails, 0, n * sizeof *trails);
  if (arcs == NULL || begin == NULL || ways == NULL) {
    (void)pendres_context_fail(ctx, status, "out of memory for a branch");
    goto done;
  }
  status = PENDRES_OK;
  for (size_t i = 0; i < 2 * n && status == PENDRES_OK; i++) {
    arcs[i] = starts[i / 2].kind;
    if (which != NULL) *which = i / 2;
    status = pendres_arc_begin(ctx, &arcs[i], starts[i / 2].u, i % 2 == 0 ? 1.0 : -1.0);
    begin[i] = arcs[i].here;
    ways[i].going = 1;
  }
  if (status == PENDRES_OK) status = run(ctx, 2 * n, arcs, begin, bounds, ways);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    begin[2 * i + 1].arclength = 0.0;
    status = join(ctx, &arcs[2 * i], &begin[2 * i], &ways[2 * i], &trails[i]);
  }
done:
  for (size_t i = 0; i < 2 * n && ways != NULL; i++) free(ways[i].point);
  free(arcs);
  free(begin);
  free(ways);
  if (status != PENDRES_OK)
    for (size_t i = 0; i < n; i++) pendres_trail_free(&trails[i]);
  return status;
}

/* ---- to the tolerance ---- */

/*
 * The two computations of a point of a branch differ in the parameter as well. What an orbit at one
 * value of it is known to is their distance there: the coarser is moved along the branch. Next to a
 * fold that would lead around it: there a parameter that is off by so much moves the orbit by the
 * root of it.
 */
static void to_one_parameter(const pendres_arc *w, const pendres_arc_point *at,
                             pendres_continuation_pair *pair)
{
  const int place = w->unknown[2];
  const double along = at->tangent[2];
  const double scale = pendres_arc_scale(place, pair->fine[place]);
  const double off = (pair->fine[place] - pair->coarse[place]) / scale;
  if (!(fabs(off) < 0.05 * along * along)) {
    pair->rounding += fabs(off) / fmax(fabs(along), sqrt(fabs(off)));
    return;
  }
  for (int k = 0; k < w->unknowns; k++)
    pair->coarse[w->unknown[k]] +=
      pendres_arc_scale(w->unknown[k], pair->fine[w->unknown[k]]) * at->tangent[k] * off / along;
  pair->coarse[place] = pair->fine[place];
  pair->rounding /= fmax(fabs(along), 1e-3);
}

/* The points of a trail that are still to be made more exact, and what their correction needs. */
typedef struct polish {
  const pendres_trail *trail;
  pendres_continuation_pair *pairs;
  size_t left, *index; /* of the points left */
  pendres_arc_correction *point;
} polish;

static void free_polish(polish *p)
{
  free(p->point);
  free(p->index);
}

static pendres_status begin_polish(pendres_context *ctx, const pendres_trail *t,
                                   pendres_continuation_pair *pairs, polish *p)
{
  const size_t n = t->count + 1;
  *p = (polish){.trail = t, .pairs = pairs, .left = t->count, .index = malloc(n * sizeof *p->index),
                .point = malloc(n * sizeof *p->point)};
  if (p->index == NULL || p->point == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < t->count && status == PENDRES_OK; i++) {
    p->index[i] = i;
    pairs[i] = (pendres_continuation_pair){
      .map = t->kind.map, .critical = t->kind.condition != PENDRES_CONDITION_NONE};
    memcpy(pairs[i].coarse, t->point[i].u, sizeof pairs[i].coarse);
    status =
      pendres_continuation_map_steps(ctx, t->kind.map.force, t->point[i].u,
                                     pendres_accuracy_first(ctx), &pairs[i].coarse_steps);
  }
  return status;
}

/* Correct all points that are left, with the coarser number of steps or with the finer one. */
static pendres_status correct(pendres_context *ctx, polish *w, int fine)
{
  enum { CHUNK = 1024 };
  const pendres_arc *kind = &w->trail->kind;
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < w->left; i++) {
    pendres_continuation_pair *p = &w->pairs[w->index[i]];
    const pendres_arc_point *at = &w->trail->point[w->index[i]];
    pendres_arc_correction *c = &w->point[i];
    memcpy(c->tangent, at->tangent, sizeof c->tangent);
    if (at->held > 0) {
      memset(c->tangent, 0, sizeof c->tangent);
      c->tangent[at->held - 1] = 1.0;
    }
    if (fine) {
      p->fine_steps = pendres_steps_rung((int)ceil(1.4 * p->coarse_steps));
      p->fine_steps += p->fine_steps % 2;
    }
    c->steps = fine ? p->fine_steps : p->coarse_steps;
    memcpy(c->u, p->coarse, sizeof c->u);
  }
  for (size_t first = 0; first < w->left && status == PENDRES_OK; first += CHUNK)
    status = pendres_arc_correct(ctx, kind, w->left - first < CHUNK ? w->left - first : CHUNK,
                                 w->point + first);
  for (size_t i = 0; i < w->left && status == PENDRES_OK; i++) {
    pendres_continuation_pair *p = &w->pairs[w->index[i]];
    /* A point that cannot be corrected stays where the arc left it, with an error that says so. */
    const pendres_arc_correction *c = &w->point[i];
    memcpy(fine ? p->fine : p->coarse, c->u, sizeof c->u);
    p->rounding = isnan(c->rounding) ? kind->tolerance : c->rounding;
  }
  return status;
}

/* Errors of the parameters of point i; returns the largest error of all, as tolerances have it. */
static double errors_at(const pendres_trail *t, size_t i, const pendres_continuation_pair *p,
                        double error[2])
{
  const pendres_arc *w = &t->kind;
  const double point = hypot(p->fine[PENDRES_U_Y] - p->coarse[PENDRES_U_Y],
                             p->fine[PENDRES_U_W] - p->coarse[PENDRES_U_W]);
  /* Next to a fold the orbit at the parameter moves the more for it, see to_one_parameter(). */
  const double turning =
    t->count > 1 && t->point[i].held == 0 ? fmax(fabs(t->point[i].tangent[2]), 1e-3) : 1.0;
  double worst = 0.0;
  for (int k = 0; k < w->unknowns; k++) {
    const int place = w->unknown[k];
    /* Two values of a parameter may agree by chance: it is not known better than the point is. */
    const double e = pendres_continuation_orbit_error(
      p->coarse[place], p->fine[place],
      pendres_arc_scale(place, p->fine[place]) * p->rounding + (k >= 2 ? 0.005 * point : 0.0));
    if (k >= 2) error[k - 2] = e;
    worst = fmax(worst, k == 2 && w->unknowns == 3 && turning < 1.0 ? 10.0 * e / turning : e);
  }
  return worst;
}

/* Keep the points whose errors exceed the tolerance for another try, if there is to be one. */
static void keep_inexact(const pendres_options *options, int last, polish *w, double (*error)[2])
{
  size_t again = 0;
  for (size_t i = 0; i < w->left; i++) {
    const size_t k = w->index[i];
    pendres_continuation_pair *p = &w->pairs[k];
    const double worst = errors_at(w->trail, k, p, error[k]);
    if (!(worst > options->tolerance) || last || options->steps_per_period != 0) continue;
    p->coarse_steps = p->fine_steps;
    memcpy(p->coarse, p->fine, sizeof p->coarse);
    w->index[again++] = k;
  }
  w->left = again;
}

pendres_status pendres_trail_polish(pendres_context *ctx, const pendres_trail *t,
                                    pendres_continuation_pair *pairs, double (*error)[2])
{
  enum { MOST_TRIES = 4 };
  polish w;
  pendres_status status = begin_polish(ctx, t, pairs, &w);
  for (int attempt = 0; attempt < MOST_TRIES && w.left > 0 && status == PENDRES_OK; attempt++) {
    status = correct(ctx, &w, 0);
    if (status == PENDRES_OK) status = correct(ctx, &w, 1);
    if (status == PENDRES_OK)
      keep_inexact(&ctx->options, attempt + 1 == MOST_TRIES, &w, error);
  }
  for (size_t i = 0; i < t->count && status == PENDRES_OK; i++)
    if (t->kind.unknowns == 3 && t->count > 1 && t->point[i].held == 0)
      to_one_parameter(&t->kind, &t->point[i], &pairs[i]);
  free_polish(&w);
  return status;
}
