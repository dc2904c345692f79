/* zeros.c -- zeros of functions along a curve; see curve.h. */
#include "continuation/curve/curve.h"

#include <math.h>
#include <string.h>

#include "base/grow.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "continuation/curve/crossing.h"
#include "continuation/curve/numbers.h"

double pendres_curve_between(const pendres_curve *t, const pendres_curve_zero *z, pendres_u u)
{
  const pendres_curve_node *a = &t->node[z->i], *b = &t->node[(z->i + 1) % t->nodes];
  pendres_u end;
  memcpy(end, b->u, sizeof end);
  if (z->i + 1 == t->nodes) end[PENDRES_U_Y] += t->round;
  for (int i = 0; i < PENDRES_U_COUNT; i++) u[i] = a->u[i] + z->part * (end[i] - a->u[i]);
  return pendres_arc_distance(&t->kind.system.map, a->u, end);
}

/* ---- parabolas through three points ---- */

/* Newton's form: g0 + (s - s0) (slope + bend (s - s1)). */
typedef struct parabola {
  double s0, s1, g0, slope, bend;
} parabola;

static parabola parabola_of(const double s[3], const double g[3])
{
  const double first = (g[1] - g[0]) / (s[1] - s[0]), second = (g[2] - g[1]) / (s[2] - s[1]);
  return (parabola){
    .s0 = s[0], .s1 = s[1], .g0 = g[0], .slope = first, .bend = (second - first) / (s[2] - s[0])};
}

static double vertex_of(const parabola *p)
{
  return 0.5 * (p->s0 + p->s1) - 0.5 * p->slope / p->bend;
}

static double value_of(const parabola *p, double s)
{
  return p->g0 + (s - p->s0) * (p->slope + p->bend * (s - p->s1));
}

/* The zero within [a, b], NaN if there is none or two. */
static double zero_within(const parabola *p, double a, double b)
{
  const double vertex = vertex_of(p), half = sqrt(-value_of(p, vertex) / p->bend);
  const double low = vertex - half, high = vertex + half;
  const int first = low >= a && low <= b, second = high >= a && high <= b;
  if (first == second) return NAN;
  return first ? low : high;
}

/* ---- zeros between points ---- */

/* Three points in a row from number i on. */
static void three(const pendres_curve *t, pendres_curve_function *test, size_t i, double s[3],
                  double g[3])
{
  for (size_t m = 0; m < 3; m++) {
    s[m] = t->node[i + m].arclength;
    g[m] = test(&t->node[i + m]);
  }
}

/* Share of the way from point i to the next at which the function vanishes. */
static double part_of(const pendres_curve *t, pendres_curve_function *test, size_t i, double a,
                      double b)
{
  if (i + 1 < t->nodes) {
    const double from = t->node[i].arclength, to = t->node[i + 1].arclength;
    for (int side = 0; side < 2; side++) {
      double s[3], g[3];
      if (side == 0 ? i == 0 : i + 2 >= t->nodes) continue;
      three(t, test, side == 0 ? i - 1 : i, s, g);
      const parabola p = parabola_of(s, g);
      const double zero = zero_within(&p, from, to);
      if (!isnan(zero)) return (zero - from) / (to - from);
    }
  }
  return a / (a - b);
}

/* Whether three values have one sign, the middle one being the least. */
static int dips(const double g[3])
{
  return g[0] * g[1] > 0.0 && g[1] * g[2] > 0.0 && fabs(g[1]) <= fabs(g[0]) &&
         fabs(g[1]) <= fabs(g[2]);
}

/* Whether the function has a least value of about 0 at point i, or before or behind it: where. */
static int touches(const pendres_curve *t, pendres_curve_function *test, size_t i,
                   pendres_curve_zero *at)
{
  double s[3], g[3];
  if (i == 0 || i + 1 >= t->nodes) return 0;
  three(t, test, i - 1, s, g);
  if (!dips(g)) return 0;
  const parabola p = parabola_of(s, g);
  const double vertex = vertex_of(&p);
  const int behind = vertex >= s[1];
  *at = (pendres_curve_zero){
    .i = behind ? i : i - 1, .part = (vertex - s[behind]) / (s[behind + 1] - s[behind])};
  return fabs(value_of(&p, vertex)) < zero_touching * fmin(fabs(g[0]), fabs(g[2]));
}

/* How many chords a curve has. */
static size_t chords_of(const pendres_curve *t)
{
  return t->nodes < 2 ? 0 : pendres_curve_closed(t) ? t->nodes : t->nodes - 1;
}

size_t pendres_curve_zeros(const pendres_curve *t, const pendres_curve_test *of,
                           pendres_curve_zero zeros[PENDRES_CURVE_ZEROS])
{
  pendres_curve_function *const test = of->function;
  size_t count = 0;
  for (size_t i = 0; i < chords_of(t) && count < PENDRES_CURVE_ZEROS; i++) {
    const double a = test(&t->node[i]), b = test(&t->node[(i + 1) % t->nodes]);
    if (a == 0.0 || a * b < 0.0)
      zeros[count++] = (pendres_curve_zero){.i = i, .part = part_of(t, test, i, a, b)};
    else if (of->touch && touches(t, test, i, &zeros[count])) count++;
  }
  return count;
}

pendres_status pendres_curve_find_crossings(pendres_context *ctx, const pendres_curve *t,
                                            pendres_curve_zero zeros[PENDRES_CURVE_ZEROS],
                                            size_t *count)
{
  const int parameter = t->kind.system.unknown[2];
  (void)ctx;
  *count = 0;
  for (size_t i = 0; i < chords_of(t) && *count < PENDRES_CURVE_ZEROS; i++) {
    const pendres_curve_node *p = &t->node[i], *q = &t->node[(i + 1) % t->nodes];
    const double a = pendres_crossing_bordered(&p->image, parameter, p->tangent);
    const double b = pendres_crossing_bordered(&q->image, parameter, q->tangent);
    if (a * b < 0.0) zeros[(*count)++] = (pendres_curve_zero){.i = i, .part = a / (a - b)};
  }
  return PENDRES_OK;
}

/* ---- births ---- */

/*
 * An orbit and its image by a half map lie on either side of the orbit that both were born from,
 * and change places there: the way from one to the other turns round.
 */
static void turns_round(const pendres_curve *t, int half, const pendres_map_miss *miss,
                        pendres_curve_zero zeros[PENDRES_CURVE_ZEROS], size_t *count)
{
  for (size_t i = 0; i < chords_of(t) && *count < PENDRES_CURVE_ZEROS; i++) {
    const double *a = miss[i].off, *b = miss[(i + 1) % t->nodes].off;
    const double from = hypot(a[0], a[1]), to = hypot(b[0], b[1]);
    if (a[0] * b[0] + a[1] * b[1] < 0.0)
      zeros[(*count)++] = (pendres_curve_zero){.i = i, .part = from / (from + to), .half = half};
  }
}

pendres_status pendres_curve_find_births(pendres_context *ctx, const pendres_curve *t,
                                         pendres_curve_zero zeros[PENDRES_CURVE_ZEROS],
                                         size_t *count)
{
  const size_t n = t->nodes;
  const pendres_map *map = &t->kind.system.map;
  int steps = 0;
  *count = 0;
  if (!t->kind.apart || n < 2) return PENDRES_OK;
  pendres_room room = pendres_room_open(ctx, "points of a curve");
  pendres_u *u = pendres_room_take(&room, n, sizeof *u);
  pendres_map_miss *miss = pendres_room_take(&room, n, sizeof *miss);
  pendres_status status = room.status;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    int here = 0;
    memcpy(u[i], t->node[i].u, sizeof u[i]);
    status = pendres_map_steps(ctx, map->force, u[i], t->kind.tolerance, &here);
    if (here > steps) steps = here;
  }
  for (int which = 0; which < PENDRES_MAP_HALVES && status == PENDRES_OK; which++) {
    pendres_map half;
    if ((t->kind.apart >> which & 1) == 0 || !pendres_map_half(map, which, &half))
      continue;
    status = pendres_map_closes(ctx, &half, steps, n, (const pendres_u *)u, miss);
    if (status == PENDRES_OK) turns_round(t, which, miss, zeros, count);
  }
  return pendres_room_close(&room, status);
}

/* ---- zeros that the points missed ---- */

/* The point of the curve near the place s between two points: linear, then corrected. */
static pendres_status point_at(pendres_context *ctx, const pendres_curve *t,
                               const pendres_curve_node between[2], double s,
                               pendres_curve_node *out, int *good)
{
  const pendres_curve_node *a = &between[0], *b = &between[1];
  const double part = (s - a->arclength) / (b->arclength - a->arclength);
  pendres_correction c = {.kind = &t->kind};
  *out = part < 0.5 ? *a : *b;
  memcpy(c.tangent, out->tangent, sizeof c.tangent);
  for (int i = 0; i < PENDRES_U_COUNT; i++) c.u[i] = a->u[i] + part * (b->u[i] - a->u[i]);
  const pendres_status status = pendres_follow_place(ctx, pendres_accuracy_first(ctx), &c, good);
  if (!*good) return status;
  memcpy(out->u, c.u, sizeof out->u);
  out->held = 0;
  out->arclength = s;
  return pendres_follow_describe(ctx, &t->kind, c.steps, out);
}

pendres_status pendres_curve_close_in(pendres_context *ctx, const pendres_curve *t,
                                      pendres_curve_function *test, const pendres_curve_zero *z,
                                      pendres_u u)
{
  if (z->i + 1 >= t->nodes) return PENDRES_OK;
  pendres_curve_node ends[2] = {t->node[z->i], t->node[z->i + 1]};
  double value[2] = {test(&ends[0]), test(&ends[1])};
  const double narrow = zero_closed_in * (ends[1].arclength - ends[0].arclength);
  if (!(value[0] * value[1] < 0.0)) return PENDRES_OK;
  for (int trial = 0; trial < ZERO_TRIALS; trial++) {
    const double width = ends[1].arclength - ends[0].arclength;
    const double at = ends[0].arclength + width * value[0] / (value[0] - value[1]);
    pendres_curve_node here;
    int good = 0;
    const pendres_status status = point_at(ctx, t, ends, at, &here, &good);
    if (status != PENDRES_OK || !good) return status;
    memcpy(u, here.u, sizeof here.u);
    const double now = test(&here);
    const int side = now * value[0] > 0.0 ? 0 : 1;
    if (now == 0.0 || fabs(at - ends[side].arclength) < narrow) break;
    ends[side] = here;
    value[side] = now;
    value[1 - side] *= 0.5; /* or this end would stay where it is */
  }
  return PENDRES_OK;
}

static int insert(pendres_curve *t, size_t at, const pendres_curve_node *p)
{
  pendres_curve_node *grown = pendres_grow(t->node, t->nodes, &t->capacity, sizeof *grown);
  if (grown == NULL) return -1;
  t->node = grown;
  memmove(t->node + at + 1, t->node + at, (t->nodes - at) * sizeof *t->node);
  t->node[at] = *p;
  t->nodes++;
  return 0;
}

/*
 * Look for the least |value| between points[0] and [2], [1] being less than both, by parabolas.
 * *found: a point of the other sign was met; it is then *beyond, and points are its neighbours.
 */
static pendres_status descend(pendres_context *ctx, const pendres_curve *t,
                              pendres_curve_function *test, pendres_curve_node points[3],
                              pendres_curve_node *beyond, int *found)
{
  *found = 0;
  for (int trial = 0; trial < ZERO_TRIALS; trial++) {
    double s[3], g[3];
    int good = 0;
    for (int m = 0; m < 3; m++) {
      s[m] = points[m].arclength;
      g[m] = test(&points[m]);
    }
    const parabola p = parabola_of(s, g);
    double next = vertex_of(&p);
    const double least = value_of(&p, next), width = s[2] - s[0];
    if (width < zero_narrowest) break;
    if (least * g[1] > 0.0 && fabs(least) > zero_suspicious * fmin(fabs(g[0]), fabs(g[2]))) break;
    /* Where the vertex is known already, or would be next to an end, halve the longer side. */
    if (!(next > s[0] && next < s[2]) || fabs(next - s[1]) < zero_known * width ||
        trial % ZERO_HALVE_EVERY == ZERO_HALVE_EVERY - 1)
      next = s[2] - s[1] > s[1] - s[0] ? 0.5 * (s[1] + s[2]) : 0.5 * (s[0] + s[1]);
    const int side = next < s[1] ? 0 : 1;
    pendres_curve_node here;
    const pendres_status status = point_at(ctx, t, &points[side], next, &here, &good);
    if (status != PENDRES_OK) return status;
    if (!good) break;
    const double value = test(&here);
    if (value * g[1] <= 0.0) {
      *beyond = here;
      *found = side == 0 ? 1 : 2;
      return status;
    }
    if (fabs(value) < fabs(g[1])) {
      points[side == 0 ? 2 : 0] = points[1];
      points[1] = here;
    } else {
      points[side == 0 ? 0 : 2] = here;
    }
  }
  return PENDRES_OK;
}

pendres_status pendres_curve_refine(pendres_context *ctx, pendres_curve *t,
                                    pendres_curve_function *test)
{
  for (size_t i = 1; i + 1 < t->nodes; i++) {
    pendres_curve_node points[3], beyond;
    int found = 0;
    double g[3];
    for (size_t m = 0; m < 3; m++) {
      points[m] = t->node[i + m - 1];
      g[m] = test(&points[m]);
    }
    if (!dips(g)) continue;
    const pendres_status status = descend(ctx, t, test, points, &beyond, &found);
    if (status != PENDRES_OK) return status;
    if (!found) continue;
    /* Insert the point of the minimum and the one of the other sign in order; the points that were
       there stay. */
    pendres_curve_node more[2] = {found == 1 ? beyond : points[1], found == 1 ? points[1] : beyond};
    for (int m = 0; m < 2; m++) {
      size_t at = i - 1;
      while (at < t->nodes && t->node[at].arclength < more[m].arclength) at++;
      if (at < t->nodes && t->node[at].arclength == more[m].arclength) continue;
      if (insert(t, at, &more[m]) != 0)
        return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for a branch");
    }
    i += 2;
  }
  return PENDRES_OK;
}
