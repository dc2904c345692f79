/* curve.c -- whole curves within bounds; see curve.h. */
#include "continuation/curve/curve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "continuation/curve/numbers.h"
#include "engine/context_internal.h"
#include "model/model.h"

static pendres_status no_memory(pendres_context *ctx)
{
  return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
}

/* Free the working arrays except the two ways. */
static void forget_nodes(pendres_curve *c)
{
  void *const arrays[] = {c->node, c->special, c->place, c->pair, c->orbit, c->error};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
  c->node = NULL;
  c->special = NULL;
  c->place = NULL;
  c->pair = NULL;
  c->orbit = NULL;
  c->error = NULL;
  c->nodes = c->capacity = c->room = 0;
}

/* Free all working arrays. */
static void forget(pendres_curve *c)
{
  forget_nodes(c);
  for (int k = 0; k < 2 && c->way != NULL; k++) free(c->way[k].node);
  free(c->way);
  c->way = NULL;
}

void pendres_curve_free(pendres_curve *c)
{
  if (c == NULL) return;
  forget(c);
  free(c->branch_point);
  free(c->bifurcation);
  free(c->point);
  free(c->cusp);
  free(c->u);
  free(c);
}

static void free_curve(pendres_curve **c)
{
  pendres_curve_free(*c);
  *c = NULL;
}

/* ---- one way of a start ---- */

static int add(pendres_curve_way *w, const pendres_curve_node *node)
{
  pendres_curve_node *grown = pendres_grow(w->node, w->count, &w->capacity, sizeof *grown);
  if (grown == NULL) return -1;
  w->node = grown;
  w->node[w->count++] = *node;
  return 0;
}

/* The bound of a parameter that a curve meets, and the node on it. */
typedef struct landing {
  int unknown; /* number of the parameter among the unknowns */
  double bound;
  int landed; /* 0: there is no such node */
  pendres_curve_node node;
} landing;

/* Find a parameter among the unknowns that is out of its bounds, and which bound it has passed;
   0: all are within. */
static int out_of_bounds(const pendres_system *s, const pendres_curve_bounds *b,
                         const pendres_u u, landing *out)
{
  for (int k = 2; k < s->unknowns; k++) {
    const double value = u[s->unknown[k]];
    if (value < b->low[k - 2] || value > b->high[k - 2]) {
      out->unknown = k;
      out->bound = value < b->low[k - 2] ? b->low[k - 2] : b->high[k - 2];
      return 1;
    }
  }
  return 0;
}

/* Find the node on a bound, between the last one inside and the first outside. */
static pendres_status land(pendres_context *ctx, const pendres_followed *kind,
                           const pendres_curve_node *inside, const pendres_curve_node *outside,
                           landing *out)
{
  pendres_system system = kind->system;
  const int k = out->unknown, place = system.unknown[k];
  const pendres_map *map = &kind->system.map;
  const double bound = out->bound, way_out = outside->u[place] - inside->u[place];
  const double part = (bound - inside->u[place]) / way_out;
  pendres_curve_node *node = &out->node;
  pendres_correction c = {.kind = kind};
  out->landed = 0;
  if (!(part > 0.0 && part < 1.0)) return PENDRES_OK;
  *node = *inside;
  for (int i = 0; i < PENDRES_U_COUNT; i++)
    c.u[i] = inside->u[i] + part * (outside->u[i] - inside->u[i]);
  c.u[place] = bound;
  c.tangent[k] = way_out > 0.0 ? 1.0 : -1.0;
  int found = 0;
  pendres_status status = pendres_follow_place(ctx, kind->tolerance, &c, &found);
  const double chord = pendres_arc_distance(map, inside->u, outside->u);
  if (!found || pendres_arc_distance(map, inside->u, c.u) > chord ||
      fabs(c.u[place] - bound) > curve_on_bound)
    return status;
  memcpy(node->u, c.u, sizeof node->u);
  node->u[place] = bound;
  node->held = k + 1;
  node->arclength = inside->arclength + pendres_arc_distance(map, inside->u, c.u);
  node->bending = inside->bending + part * (outside->bending - inside->bending);
  /* The tangent of the curve is interpolated; that of the correction is the plane of the bound. */
  for (int i = 0; i < system.unknowns; i++)
    node->tangent[i] = inside->tangent[i] + part * (outside->tangent[i] - inside->tangent[i]);
  system.steps = c.steps;
  status = pendres_map_images(ctx, &system, 1, (const pendres_u *)&c.u, &node->image);
  out->landed = status == PENDRES_OK;
  return status;
}

/* By how many whole turns, as an angle, y of a point is larger than that of another. It is 0 for a
   half map, whose mirror stands in one place, and where the coordinate has no period. */
static double turns_between(const pendres_map *map, const pendres_u from, const pendres_u to)
{
  const double turn = pendres_model_of(map->force)->period;
  if (turn == 0.0 || map->mirror) return 0.0;
  return turn * rint((to[PENDRES_U_Y] - from[PENDRES_U_Y]) / turn);
}

/* Whether the chord from a to b passes the start in the direction of the start's tangent. The start
   may be whole turns away. */
static int passes(const pendres_system *s, const pendres_curve_node *start,
                  const pendres_curve_node *a, const pendres_curve_node *b)
{
  double before = 0.0, behind = 0.0, along = 0.0, here[PENDRES_U_COUNT];
  memcpy(here, start->u, sizeof here);
  here[PENDRES_U_Y] += turns_between(&s->map, start->u, a->u);
  for (int k = 0; k < s->unknowns; k++) {
    const int i = s->unknown[k];
    const double t = start->tangent[k];
    before += t * (a->u[i] - here[i]) / pendres_arc_scale(&s->map, i, here);
    behind += t * (b->u[i] - here[i]) / pendres_arc_scale(&s->map, i, here);
    along += t * b->tangent[k];
  }
  const double chord = pendres_arc_distance(&s->map, a->u, b->u);
  return before < 0.0 && behind >= 0.0 && along > curve_back_along &&
         pendres_arc_distance(&s->map, a->u, here) <= chord &&
         pendres_arc_distance(&s->map, b->u, here) <= chord;
}

static void end_way(pendres_curve_way *w, pendres_branch_end end)
{
  w->going = 0;
  w->end = end;
}

/* Whether both multipliers of a node are less than 1: their product is, by the damping. */
static int attracts(const pendres_curve_node *node)
{
  return pendres_map_fold(&node->image) > 0.0 && pendres_map_flip(&node->image) > 0.0;
}

/* Whether a way has as many points as it may. What goes on and on in one direction comes to the end
   of its range, however long it is: only curves that turn again and again are endless. */
static int is_full(const pendres_curve_bounds *b, const pendres_curve_way *w)
{
  if (b->most_points > 0) return w->count >= b->most_points;
  return w->counted >= PENDRES_CURVE_POINTS || w->count >= CURVE_LONGEST;
}

/* Take over what the follower has found ahead of it. */
static pendres_status take(pendres_context *ctx, const pendres_curve_bounds *b,
                           pendres_curve_way *w)
{
  const pendres_follower *f = &w->at;
  const pendres_system *s = &f->kind.system;
  if (f->stuck) end_way(w, PENDRES_END_STUCK);
  while (w->taken < f->found && w->going) {
    const pendres_curve_node *p = &f->ahead[w->taken++];
    const pendres_curve_node *last = w->count > 0 ? &w->node[w->count - 1] : &w->start;
    landing at;
    if (out_of_bounds(s, b, p->u, &at)) {
      end_way(w, PENDRES_END_RANGE);
      const pendres_status status = land(ctx, &f->kind, last, p, &at);
      if (status != PENDRES_OK) return status;
      if (at.landed && add(w, &at.node) != 0) return no_memory(ctx);
    } else if (p->arclength > curve_another_pass * pendres_arc_distance(&s->map, last->u, p->u) &&
               passes(s, &w->start, last, p)) {
      end_way(w, PENDRES_END_CLOSED);
    } else {
      w->stretch = last->tangent[2] * p->tangent[2] > 0.0 ? w->stretch + 1 : 0;
      w->counted += w->stretch < CURVE_STRETCH;
      if (add(w, p) != 0) return no_memory(ctx);
      w->unstable = attracts(p) ? 0 : w->unstable + 1;
      if (p->growth > b->wildest) end_way(w, PENDRES_END_WILD);
      else if (is_full(b, w)) end_way(w, PENDRES_END_POINTS);
      else if (b->most_unstable > 0 && w->unstable >= b->most_unstable)
        end_way(w, PENDRES_END_POINTS);
    }
  }
  return PENDRES_OK;
}

/* ---- both ways ---- */

/* One curve of the way back, the start, and the way forth. */
static pendres_status join(pendres_context *ctx, pendres_curve *c)
{
  const pendres_system *s = &c->kind.system;
  const int closed = c->way[0].end == PENDRES_END_CLOSED;
  size_t count[2] = {c->way[0].count, c->way[1].count}, n = 0;
  if (closed) count[1] = 0; /* it is the same curve in the other direction */
  forget_nodes(c);
  c->nodes = c->capacity = count[0] + count[1] + 1;
  c->node = malloc(c->nodes * sizeof *c->node);
  if (c->node == NULL) return no_memory(ctx);
  /* The end with the lower first parameter comes first. */
  const int place = s->unknown[2];
  double end[2];
  for (int i = 0; i < 2; i++)
    end[i] = count[i] > 0 ? c->way[i].node[count[i] - 1].u[place] : c->way[0].start.u[place];
  const int back = !closed && end[0] < end[1] ? 0 : 1, forth = 1 - back;
  for (size_t i = count[back]; i-- > 0;) {
    c->node[n] = c->way[back].node[i];
    c->node[n].arclength = -c->node[n].arclength;
    for (int k = 0; k < s->unknowns; k++) c->node[n].tangent[k] = -c->node[n].tangent[k];
    n++;
  }
  c->node[n] = c->way[0].start;
  if (forth == 1)
    for (int k = 0; k < s->unknowns; k++) c->node[n].tangent[k] = -c->node[n].tangent[k];
  n++;
  for (size_t i = 0; i < count[forth]; i++) c->node[n++] = c->way[forth].node[i];
  c->round = closed ? turns_between(&s->map, c->node[0].u, c->node[n - 1].u) : 0.0;
  const double shift = c->node[0].arclength;
  for (size_t i = 0; i < n; i++) c->node[i].arclength -= shift;
  c->end[0] = closed ? PENDRES_END_CLOSED : c->way[back].end;
  c->end[1] = closed ? PENDRES_END_CLOSED : c->way[forth].end;
  return PENDRES_OK;
}

pendres_status pendres_curve_begin(pendres_context *ctx, const pendres_curve_start *start,
                                   pendres_curve **out)
{
  pendres_status status = PENDRES_OK;
  pendres_curve *c = *out = calloc(1, sizeof(pendres_branch));
  if (c == NULL) return no_memory(ctx);
  c->way = calloc(2, sizeof *c->way);
  if (c->way == NULL) status = no_memory(ctx);
  for (int k = 0; k < 2 && status == PENDRES_OK; k++) {
    pendres_curve_way *w = &c->way[k];
    status = pendres_follow_begin(ctx, &start->kind, start->u, k == 0 ? 1.0 : -1.0, &w->at);
    w->start = w->at.here;
    w->end = PENDRES_END_POINTS; /* none so far */
  }
  if (status == PENDRES_NOT_CONVERGED)
    (void)pendres_context_fail(ctx, status, "the start lies on no curve");
  if (status == PENDRES_OK) c->kind = c->way[0].at.kind;
  else free_curve(out);
  return status;
}

pendres_status pendres_curve_extend(pendres_context *ctx, pendres_curve *c,
                                    const pendres_curve_bounds *bounds)
{
  pendres_status status = PENDRES_OK;
  for (int k = 0; k < 2 && status == PENDRES_OK; k++) {
    pendres_curve_way *w = &c->way[k];
    w->going |= w->end == PENDRES_END_POINTS && !is_full(bounds, w);
    status = take(ctx, bounds, w);
  }
  while (status == PENDRES_OK) {
    pendres_follower *followers[2];
    size_t n = 0;
    /* The other way of a closed curve is the same curve. */
    if (c->way[0].end == PENDRES_END_CLOSED) c->way[1].going = 0;
    for (int k = 0; k < 2; k++)
      if (c->way[k].going) followers[n++] = &c->way[k].at;
    if (n == 0) return join(ctx, c);
    status = pendres_follow_advance(ctx, n, followers);
    for (int k = 0; k < 2 && status == PENDRES_OK; k++) {
      if (!c->way[k].going) continue;
      c->way[k].taken = 0;
      status = take(ctx, bounds, &c->way[k]);
    }
  }
  return status;
}

pendres_status pendres_curve_make(pendres_context *ctx, const pendres_curve_start *start,
                                  const pendres_curve_bounds *bounds,
                                  pendres_curve_finisher *finish, pendres_curve **out)
{
  pendres_status status = pendres_curve_begin(ctx, start, out);
  if (status != PENDRES_OK) return status;
  status = pendres_curve_extend(ctx, *out, bounds);
  if (status == PENDRES_OK) status = finish(ctx, *out);
  if (status == PENDRES_OK) forget(*out);
  else free_curve(out);
  return status;
}

/* ---- special points ---- */

/* Whether two special points of a curve are one. A curve that passes a place twice, as the two ways
   of a start on a closed one may, has a special point there each time. */
static int same_place(const pendres_curve *c, const pendres_curve_special *a,
                      const pendres_curve_special *b)
{
  const pendres_system *s = &c->kind.system;
  const double round = c->node[c->nodes - 1].arclength;
  double sum = 0.0, between = fabs(c->node[a->at.i].arclength - c->node[b->at.i].arclength);
  if (pendres_curve_closed(c)) between = fmin(between, round - between);
  if (a->condition != b->condition || between > curve_another_pass * c->kind.spacing) return 0;
  for (int k = 0; k < s->unknowns; k++)
    sum = hypot(sum, a->located.pair.fine[s->unknown[k]] - b->located.pair.fine[s->unknown[k]]);
  return sum < curve_same_place;
}

static int in_order(const void *a, const void *b)
{
  const pendres_curve_special *p = a, *q = b;
  if (p->at.i != q->at.i) return p->at.i < q->at.i ? -1 : 1;
  return p->at.part < q->at.part ? -1 : p->at.part > q->at.part;
}

/* Locate what is at a zero, and add it to the special points unless it is one already. */
static pendres_status add_special(pendres_context *ctx, const pendres_curve_test *test,
                                  const pendres_curve_zero *zero, pendres_curve *c)
{
  pendres_u u;
  pendres_curve_special s = {.at = *zero};
  const double chord = pendres_curve_between(c, zero, u);
  pendres_status status = test->locate(ctx, c, u, 2.0 * chord, &s);
  if (status == PENDRES_NOT_CONVERGED && test->function != NULL) {
    /* At weak damping the chord may be too far off the curve for Newton's method. */
    status = pendres_curve_close_in(ctx, c, test->function, zero, u);
    if (status == PENDRES_OK) status = test->locate(ctx, c, u, 2.0 * chord, &s);
    else if (status == PENDRES_TOLERANCE_UNREACHABLE) status = PENDRES_NOT_CONVERGED;
  }
  if (status == PENDRES_NOT_CONVERGED) return PENDRES_OK;
  if (!pendres_located_found(status)) return status;
  for (size_t k = 0; k < c->specials; k++)
    if (same_place(c, &c->special[k], &s)) return PENDRES_OK;
  pendres_curve_special *grown = pendres_grow(c->special, c->specials, &c->room, sizeof *grown);
  if (grown == NULL) return no_memory(ctx);
  c->special = grown;
  c->special[c->specials++] = s;
  return PENDRES_OK;
}

pendres_status pendres_curve_find_specials(pendres_context *ctx, pendres_curve *c, size_t n,
                                           const pendres_curve_test *tests)
{
  pendres_status status = PENDRES_OK;
  c->specials = 0;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    if (tests[i].refine) status = pendres_curve_refine(ctx, c, tests[i].function);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    pendres_curve_zero zeros[PENDRES_CURVE_ZEROS];
    size_t count = 0;
    if (tests[i].find != NULL) status = tests[i].find(ctx, c, zeros, &count);
    else count = pendres_curve_zeros(c, &tests[i], zeros);
    for (size_t k = 0; k < count && status == PENDRES_OK; k++)
      status = add_special(ctx, &tests[i], &zeros[k], c);
  }
  if (c->specials > 0) qsort(c->special, c->specials, sizeof *c->special, in_order);
  return status;
}

pendres_status pendres_curve_locate(pendres_context *ctx, const pendres_followed *kind,
                                    pendres_condition condition, const pendres_u u,
                                    double reach, pendres_located *out)
{
  const pendres_system system =
    pendres_system_of(&kind->system.map, condition, kind->system.unknown);
  return pendres_locate(ctx, &system, u, reach, out);
}
