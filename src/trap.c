/* trap.c -- trapping ellipses around attracting periodic orbits; see trap.h. */
#include "trap.h"

#include <math.h>
#include <stdlib.h>

#include "context_internal.h"
#include "steps.h"
#include "strobe_run.h"

static const double two_pi = 6.28318530717958647693;
static const double half_pi = 1.57079632679489661923;

enum {
  POINTS = 24,     /* of a ring */
  RINGS = 10,      /* tried at once */
  MOST_PASSES = 6, /* of rings, each set inside the former one */
  MOST_LOOKS = 24  /* strobes of the q-th iterate before a ring is given up */
};

/* Longest semi-axis of the outermost ring: well inside one turn, so that angles stay unique. */
static const double widest = 1.6;
static const double ring_ratio = 1.5;
/* A point of a ring has come home when it is this much further in: inside the next smaller ring,
   with a tenth to spare. */
static const double home = 0.9 / 1.5;
/* Neighbours on a ring may drift apart by this many radii; further apart the ring is too coarse
   to say what happens between them. They start at 0.26 radii. */
static const double widest_gap = 1.0;
/* A ring shown to lie in the basin counts with this share of its radius. */
static const double margin = 0.95;

double pendres_trap_norm2(const pendres_trap *t, double y, double w)
{
  double dy = y - t->y;
  const double dw = w - t->w;
  dy -= two_pi * rint(dy / two_pi);
  return t->metric[0] * dy * dy + 2.0 * t->metric[1] * dy * dw + t->metric[2] * dw * dw;
}

/*
 * Metric of a contracting 2x2 matrix: P = sum (M')^k M^k, summed by squaring:
 * P_{2m} = P_m + (M^m)' P_m M^m. Returns 0 if M does not contract.
 */
static int metric_of(const double monodromy[2][2], double omega, double p[3])
{
  /* From (x, v) to (y, w = v/omega). */
  double m[2][2] = {{monodromy[0][0], monodromy[0][1] * omega},
                    {monodromy[1][0] / omega, monodromy[1][1]}};
  p[0] = p[2] = 1.0;
  p[1] = 0.0;
  for (int k = 0; k < 60; k++) {
    const double a = m[0][0], b = m[0][1], c = m[1][0], d = m[1][1];
    const double more[3] = {
      a * (p[0] * a + p[1] * c) + c * (p[1] * a + p[2] * c),
      a * (p[0] * b + p[1] * d) + c * (p[1] * b + p[2] * d),
      b * (p[0] * b + p[1] * d) + d * (p[1] * b + p[2] * d)};
    for (int i = 0; i < 3; i++) p[i] += more[i];
    m[0][0] = a * a + b * c;
    m[0][1] = b * (a + d);
    m[1][0] = c * (a + d);
    m[1][1] = b * c + d * d;
    if (!(p[0] < 1e12 && p[2] < 1e12)) return 0;
    if (fabs(more[0]) + fabs(more[2]) < 1e-14 * (p[0] + p[2])) break;
  }
  const double mean = 0.5 * (p[0] + p[2]), spread = hypot(0.5 * (p[0] - p[2]), p[1]);
  const double least = mean - spread;
  if (!(least > 0.0)) return 0;
  for (int i = 0; i < 3; i++) p[i] /= least;
  return 1;
}

/* A point of the ellipse of the given radius, by the Cholesky factor of its metric. */
static void ring_point(const pendres_trap *t, double radius, int k, double *y, double *w)
{
  const double angle = two_pi * k / POINTS;
  const double l11 = sqrt(t->metric[0]), l21 = t->metric[1] / l11;
  const double l22 = sqrt(t->metric[2] - l21 * l21);
  const double dw = radius * sin(angle) / l22;
  *w = t->w + dw;
  *y = t->y + (radius * cos(angle) - l21 * dw) / l11;
}

/* A lane of a ring and where it has been. */
typedef struct point {
  const pendres_trap *trap;
  double radius;
  int looks, home;             /* looks taken; whether it came home */
  double y[MOST_LOOKS + 1], w[MOST_LOOKS + 1];
} point;

static int look(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  point *p = (point *)arg + index;
  if (lane->period % p->trap->period != 0) return 0;
  p->looks++;
  p->y[p->looks] = lane->y;
  p->w[p->looks] = lane->w;
  const double norm2 = pendres_trap_norm2(p->trap, lane->y, lane->w);
  if (norm2 <= home * home * p->radius * p->radius) {
    p->home = 1;
    return 1;
  }
  return p->looks >= MOST_LOOKS || !(norm2 < 16.0 * p->radius * p->radius);
}

static double gap2(const pendres_trap *t, const point *a, const point *b, int k)
{
  pendres_trap around = *t;
  around.y = a->y[k];
  around.w = a->w[k];
  return pendres_trap_norm2(&around, b->y[k], b->w[k]);
}

/* Whether all points came home, side by side. */
static int ring_holds(const point *ring)
{
  for (int i = 0; i < POINTS; i++) {
    const point *a = &ring[i], *b = &ring[(i + 1) % POINTS];
    if (!a->home) return 0;
    const int both = a->looks < b->looks ? a->looks : b->looks;
    for (int k = 1; k <= both; k++)
      if (!(gap2(a->trap, a, b, k) < widest_gap * widest_gap * a->radius * a->radius)) return 0;
  }
  return 1;
}

/*
 * Whether the ring is so small that the linear map rules inside it: the largest departure of its
 * points' first image from the linear prediction is a small part of the linear contraction. The
 * departure falls with the square of the radius, so it holds for all smaller rings.
 */
static int ring_linear(const point *ring, const pendres_orbit *o)
{
  const double omega = o->pendulum.drive_frequency;
  const pendres_trap *t = ring[0].trap;
  double worst = 0.0, image = 0.0;
  for (int i = 0; i < POINTS; i++) {
    const double dy = ring[i].y[0] - t->y, dw = ring[i].w[0] - t->w;
    pendres_trap predicted = *t;
    predicted.y = t->y + o->monodromy[0][0] * dy + o->monodromy[0][1] * omega * dw;
    predicted.w = t->w + o->monodromy[1][0] / omega * dy + o->monodromy[1][1] * dw;
    worst = fmax(worst, sqrt(pendres_trap_norm2(&predicted, ring[i].y[1], ring[i].w[1])));
    image = fmax(image, sqrt(pendres_trap_norm2(t, predicted.y, predicted.w)));
  }
  return worst < 0.3 * (ring[0].radius - image);
}

static double ring_radius(int pass, int ring)
{
  return widest * pow(ring_ratio, -(double)(pass * RINGS + ring));
}

/* The traps still looked for. */
typedef struct search {
  size_t orbit;
  int pass;
  double proven;               /* largest radius shown */
  unsigned holds[MOST_PASSES]; /* bit r: ring r of that pass came home */
} search;

/* Integrate the rings of all searches at once. */
static pendres_status run_rings(pendres_context *ctx, size_t n, const search *s,
                                const pendres_orbit *orbits, const pendres_trap *traps,
                                point *points, pendres_strobe_lane *lanes)
{
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    const pendres_trap *t = &traps[s[i].orbit];
    int steps = 0;
    const pendres_pendulum *p = &orbits[s[i].orbit].pendulum;
    const pendres_status status = pendres_steps_choose(
      ctx, p, 0.0, fmax(1e-7, 10.0 * ctx->options.tolerance), &steps);
    if (status != PENDRES_OK) return status;
    for (int r = 0; r < RINGS; r++)
      for (int k = 0; k < POINTS; k++, count++) {
        point *q = &points[count];
        q->trap = t;
        q->radius = ring_radius(s[i].pass, r);
        q->looks = q->home = 0;
        ring_point(t, q->radius, k, &q->y[0], &q->w[0]);
        lanes[count] = (pendres_strobe_lane){
          .pendulum = p, .y = q->y[0], .w = q->w[0], .steps = steps};
      }
  }
  return pendres_strobe_run(ctx, count, lanes, look, points);
}

/* What a search's rings have shown: inwards first, each ring standing on the next smaller one. */
static int judge(search *s, const point *rings, const pendres_orbit *o)
{
  int base = -1;
  s->holds[s->pass] = 0;
  for (int r = 0; r < RINGS && base < 0; r++) {
    if (ring_linear(&rings[r * POINTS], o)) base = r;
    if (ring_holds(&rings[r * POINTS])) s->holds[s->pass] |= 1u << r;
  }
  if (base < 0) {
    s->pass++;
    return s->pass < MOST_PASSES; /* look again, further in */
  }
  /* Every ring inside a linear one is linear; climb outwards from it, over all passes. */
  int rung = s->pass * RINGS + base;
  while (rung > 0 && (s->holds[(rung - 1) / RINGS] >> ((rung - 1) % RINGS) & 1u)) rung--;
  s->proven = ring_radius(rung / RINGS, rung % RINGS);
  return 0;
}

pendres_status pendres_trap_find(pendres_context *ctx, size_t n, const pendres_orbit *orbits,
                                 int effort, pendres_trap *traps)
{
  pendres_status status = PENDRES_OK;
  search *s = malloc((n + 1) * sizeof *s);
  point *points = NULL;
  pendres_strobe_lane *lanes = NULL;
  size_t left = 0;
  (void)effort;
  if (s == NULL) goto no_memory;
  for (size_t i = 0; i < n; i++) {
    const pendres_orbit *o = &orbits[i];
    traps[i] = (pendres_trap){.y = o->x - half_pi,
                              .w = o->v / o->pendulum.drive_frequency,
                              .period = o->period,
                              .winding = o->winding};
    if (o->stable && metric_of(o->monodromy, o->pendulum.drive_frequency, traps[i].metric))
      s[left++] = (search){.orbit = i};
  }
  points = malloc((left * RINGS * POINTS + 1) * sizeof *points);
  lanes = malloc((left * RINGS * POINTS + 1) * sizeof *lanes);
  if (points == NULL || lanes == NULL) goto no_memory;

  while (left > 0 && status == PENDRES_OK) {
    status = run_rings(ctx, left, s, orbits, traps, points, lanes);
    size_t again = 0;
    for (size_t i = 0; i < left && status == PENDRES_OK; i++) {
      search one = s[i];
      if (judge(&one, points + i * RINGS * POINTS, &orbits[one.orbit]))
        s[again++] = one;
      else
        traps[one.orbit].radius = margin * one.proven;
    }
    left = again;
  }
  goto done;
no_memory:
  status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for trapping rings");
done:
  free(s);
  free(points);
  free(lanes);
  return status;
}
