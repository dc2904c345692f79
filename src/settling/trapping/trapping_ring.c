/* trapping_ring.c -- rings on the edge of ellipses, and arcs between their points; see
   trapping_ring.h. */
#include "settling/trapping/trapping_ring.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "settling/trapping/numbers.h"

/* ---- running ---- */

double pendres_trapping_tolerance(double margin)
{
  return margin >= 0.05 ? 1e-4 : margin >= 1e-3 ? 1e-6 : margin >= 1e-5 ? 1e-8 : 1e-12;
}

/* The directions of a ring's points, all turned by the same angle. */
typedef struct circle {
  int points;
  double angle[TRAPPING_MANY_POINTS];
  double way[TRAPPING_MANY_POINTS][2]; /* cosine and sine */
} circle;

/* Set it for rings of so many points, unless it is that already; ahead: a share of an arc. */
static void go_round(circle *c, int points, double ahead)
{
  if (c->points == points) return;
  c->points = points;
  for (int j = 0; j < points; j++) {
    c->angle[j] = two_pi * j / points + ahead * two_pi / points;
    c->way[j][0] = cos(c->angle[j]);
    c->way[j][1] = sin(c->angle[j]);
  }
}

static void start(pendres_trapping_point *q, pendres_trapping_ring *r, double angle,
                  const double way[2], pendres_strobe_lane *lane)
{
  q->of = r;
  q->angle = angle;
  q->looks = q->home = 0;
  pendres_trapping_state(r->ellipse, r->factor, r->radius * way[0], r->radius * way[1], &q->y[0],
                         &q->w[0]);
  *lane = r->lane;
  lane->y = q->y[0];
  lane->w = q->w[0];
}

static int look(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  pendres_trapping_point *p = (pendres_trapping_point *)arg + index;
  pendres_trapping_ring *r = p->of;
  if (lane->period % r->ellipse->period != 0) return 0;
  p->looks++;
  p->y[p->looks] = lane->y;
  p->w[p->looks] = lane->w;
  if (r->home == 0.0) return p->looks >= r->looks;
  if (p->home > 0) return r->failed || p->looks >= p->home + PENDRES_TRAPPING_AFTER;
  const double norm2 = pendres_trapping_norm2(r->ellipse, lane->y, lane->w);
  if (norm2 <= r->home * r->home) {
    p->home = p->looks;
    return PENDRES_TRAPPING_AFTER == 0;
  }
  if (p->looks >= r->looks || !(norm2 < trapping_lost * trapping_lost * r->radius * r->radius))
    r->failed = 1;
  return r->failed;
}

/* ---- tangents ---- */

/* The vector from a to b at look k, its angle without whole turns. */
static void chord_of(const pendres_trapping_point *a, const pendres_trapping_point *b, int k,
                     double chord[2])
{
  chord[0] = pendres_less_turns(b->y[k] - a->y[k], a->of->ellipse->turn);
  chord[1] = b->w[k] - a->w[k];
}

/* The square of a vector's length. */
static double length2_of(const pendres_trapping_ellipse *t, double y, double w)
{
  return t->metric[0] * y * y + 2.0 * t->metric[1] * y * w + t->metric[2] * w * w;
}

/* The angle from a to b, round the ring. */
static double width_of(const pendres_trapping_point *a, const pendres_trapping_point *b)
{
  const double width = b->angle - a->angle;
  return width > 0.0 ? width : width + two_pi;
}

/* The derivative by the angle at look k, times a width, from the point further on; NaN where that
   one was not followed. */
static void tangent_of(const pendres_trapping_point *p, int k, double width, double d[2])
{
  d[0] = d[1] = NAN;
  if (k > p->further->looks) return;
  chord_of(p, p->further, k, d);
  const double apart = width_of(p, p->further);
  for (int i = 0; i < 2; i++) d[i] = width * (d[i] / apart);
}

pendres_status pendres_trapping_rings_run(pendres_context *ctx, size_t n,
                                          pendres_trapping_ring **rings,
                                          pendres_trapping_point *points,
                                          pendres_strobe_lane *lanes)
{
  size_t count = 0;
  circle c = {.points = 0};
  for (size_t i = 0; i < n; i++) {
    pendres_trapping_ring *r = rings[i];
    r->point = points + count;
    go_round(&c, r->points, 0.0);
    for (int j = 0; j < r->points; j++, count++)
      start(&points[count], r, c.angle[j], c.way[j], &lanes[count]);
  }
  const pendres_status status = pendres_strobe_run(ctx, count, lanes, look, points);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    if (rings[i]->home > 0.0 && !pendres_trapping_ring_holds(rings[i])) rings[i]->failed = 1;
  return status;
}

/* ---- points ---- */

int pendres_trapping_ring_holds(const pendres_trapping_ring *r)
{
  const pendres_trapping_point *points = r->point;
  const double widest = trapping_widest_gap * r->radius;
  if (r->failed) return 0;
  for (int i = 0; i < r->points; i++) {
    const pendres_trapping_point *a = &points[i], *b = &points[(i + 1) % r->points];
    if (a->home == 0) return 0;
    const int both = a->home < b->home ? a->home : b->home;
    for (int k = 1; k <= both; k++) {
      double d[2];
      chord_of(a, b, k, d);
      if (!(length2_of(r->ellipse, d[0], d[1]) < widest * widest)) return 0;
    }
  }
  return 1;
}

/* ---- arcs ---- */

double pendres_trapping_departure(const pendres_trapping_ellipse *t, const double chord[2],
                                  const double first[2], const double last[2])
{
  return 0.25 * (sqrt(length2_of(t, first[0] - chord[0], first[1] - chord[1])) +
                 sqrt(length2_of(t, last[0] - chord[0], last[1] - chord[1])));
}

/* Whether the image of an arc, at some look, is inside the ellipse that is known already. */
static int arc_home(const pendres_trapping_ring *r, const pendres_trapping_point *a,
                    const pendres_trapping_point *b)
{
  const double width = width_of(a, b);
  const int both = a->looks < b->looks ? a->looks : b->looks;
  for (int k = a->home < b->home ? a->home : b->home; k >= 1 && k <= both; k++) {
    double d[2], first[2], last[2];
    chord_of(a, b, k, d);
    tangent_of(a, k, width, first);
    tangent_of(b, k, width, last);
    const double at[2] = {sqrt(pendres_trapping_norm2(r->ellipse, a->y[k], a->w[k])),
                          sqrt(pendres_trapping_norm2(r->ellipse, b->y[k], b->w[k]))};
    const double departure = pendres_trapping_departure(r->ellipse, d, first, last);
    if (at[0] + departure <= r->room && at[1] + departure <= r->room) return 1;
  }
  return 0;
}

size_t pendres_trapping_ring_open(const pendres_trapping_ring *r, pendres_trapping_arc *arcs)
{
  size_t open = 0;
  for (int i = 0; i < r->points; i++) {
    const pendres_trapping_arc arc = {&r->point[i], &r->point[(i + 1) % r->points]};
    if (!arc_home(r, arc.a, arc.b)) arcs[open++] = arc;
  }
  return open;
}

/* Whether a ring's points have come home, side by side; base rings have no home. */
static int may_hold(const pendres_trapping_ring *r)
{
  return r->home > 0.0 && !r->failed;
}

/* Arcs that are not home: those of now, those of the next pass, and the points put into them. */
typedef struct closing {
  int most;
  size_t open, used;
  pendres_trapping_arc *arcs, *next;
  pendres_trapping_point *points;
  pendres_strobe_lane *lanes;
} closing;

/* Put a point into the middle of every open arc, unless its ring has had its share of points. */
static pendres_status bisect(pendres_context *ctx, closing *c)
{
  size_t n = 0, again = 0;
  for (size_t i = 0; i < c->open; i++) {
    pendres_trapping_ring *r = c->arcs[i].a->of;
    if (++r->more > c->most) r->failed = 1;
  }
  pendres_trapping_point *middle = c->points + c->used;
  for (size_t i = 0; i < c->open; i++) {
    const pendres_trapping_arc arc = c->arcs[i];
    if (arc.a->of->failed) continue;
    const double half = 0.5 * width_of(arc.a, arc.b);
    for (size_t k = 2 * n; k < 2 * n + 2; k++) {
      const double angle = arc.a->angle + half + (k == 2 * n ? 0.0 : trapping_beside * half);
      start(&middle[k], arc.a->of, angle, (const double[2]){cos(angle), sin(angle)}, &c->lanes[k]);
    }
    c->arcs[n++] = arc;
  }
  const pendres_status status = pendres_strobe_run(ctx, 2 * n, c->lanes, look, middle);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    const pendres_trapping_arc arc = c->arcs[i];
    const pendres_trapping_ring *r = arc.a->of;
    pendres_trapping_point *m = &middle[2 * i];
    if (r->failed) continue;
    m->further = m + 1;
    if (!arc_home(r, arc.a, m)) c->next[again++] = (pendres_trapping_arc){arc.a, m};
    if (!arc_home(r, m, arc.b)) c->next[again++] = (pendres_trapping_arc){m, arc.b};
  }
  c->used += 2 * n;
  c->open = again;
  pendres_trapping_arc *const swap = c->arcs;
  c->arcs = c->next;
  c->next = swap;
  return status;
}

/* Give the points of the rings that hold others further on, and list the open arcs. */
static pendres_status first_arcs(pendres_context *ctx, size_t n, pendres_trapping_ring **rings,
                                 closing *c)
{
  size_t count = 0;
  circle ahead = {.points = 0};
  for (size_t i = 0; i < n; i++) {
    pendres_trapping_ring *r = rings[i];
    if (!may_hold(r)) continue;
    go_round(&ahead, r->points, trapping_beside);
    for (int j = 0; j < r->points; j++, count++)
      start(&c->points[count], r, ahead.angle[j], ahead.way[j], &c->lanes[count]);
  }
  const pendres_status status = pendres_strobe_run(ctx, count, c->lanes, look, c->points);
  for (size_t k = 0; k < count && status == PENDRES_OK;) {
    const pendres_trapping_ring *r = c->points[k].of;
    for (int j = 0; j < r->points; j++, k++)
      r->point[j].further = &c->points[k];
    if (!r->failed) c->open += pendres_trapping_ring_open(r, c->arcs + c->open);
  }
  return status;
}

pendres_status pendres_trapping_rings_close(pendres_context *ctx, size_t n,
                                            pendres_trapping_ring **rings, int most,
                                            pendres_trapping_point *points,
                                            pendres_strobe_lane *lanes)
{
  size_t arcs = 0, hold = 0;
  for (size_t i = 0; i < n; i++) {
    if (!may_hold(rings[i])) continue;
    arcs += (size_t)rings[i]->points;
    hold++;
  }
  if (hold == 0) return PENDRES_OK;
  const size_t all = arcs + 2 * hold * (size_t)most;
  pendres_room room = pendres_room_open(ctx, "trapping arcs");
  closing c = {.most = most, .points = points, .lanes = lanes,
               .arcs = pendres_room_take(&room, all, sizeof *c.arcs),
               .next = pendres_room_take(&room, all, sizeof *c.next)};
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  pendres_status status = first_arcs(ctx, n, rings, &c);
  c.used = arcs;
  while (c.open > 0 && status == PENDRES_OK) status = bisect(ctx, &c);
  return pendres_room_close(&room, status);
}
