/* trapping.c -- trapping ellipses around attracting periodic orbits; see trapping_ellipse.h. */
#include "settling/trapping/trapping_ellipse.h"

#include <math.h>
#include <stdlib.h>

#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/kernels/coordinates.h"
#include "engine/steps.h"
#include "model/model.h"
#include "settling/trapping/numbers.h"
#include "orbits/strobe_noise.h"
#include "settling/trapping/trapping_ring.h"

/* ---- the linear map ---- */

/* The monodromy matrix, from (x, v) to (y, w = v/omega). */
static void map_of(const pendres_orbit *o, double m[2][2])
{
  const double omega = o->pendulum.drive_frequency;
  m[0][0] = o->monodromy[0][0];
  m[0][1] = o->monodromy[0][1] * omega;
  m[1][0] = o->monodromy[1][0] / omega;
  m[1][1] = o->monodromy[1][1];
}

int pendres_trapping_is_weak(const pendres_orbit *o)
{
  const double (*m)[2] = o->monodromy, skew = 0.5 * (m[1][1] - m[0][0]);
  return skew * skew < -m[0][1] * m[1][0] && /* complex multipliers */
         hypot(o->multiplier_re[0], o->multiplier_im[0]) > level_weak;
}

/* The metric that the map shrinks evenly: with complex multipliers (c, (d - a)/2, -b) of the matrix
   (a, b; c, d), by its invariant quadratic form. Scaled as trapping_ellipse.h says. */
static void even_metric(const pendres_orbit *o, double p[3])
{
  const double omega = o->pendulum.drive_frequency;
  const double b = o->monodromy[0][1] * omega, c = o->monodromy[1][0] / omega;
  const double sign = c > 0.0 ? 1.0 : -1.0;
  p[0] = sign * c;
  p[1] = sign * 0.5 * (o->monodromy[1][1] - o->monodromy[0][0]);
  p[2] = -sign * b;
  const double mean = 0.5 * (p[0] + p[2]), spread = hypot(0.5 * (p[0] - p[2]), p[1]);
  const double least = (p[0] * p[2] - p[1] * p[1]) / (mean + spread);
  for (int i = 0; i < 3; i++) p[i] /= least;
}

/*
 * Close to a fold one direction is slow, and the metric below would make the ellipse short just
 * along it. There the distance is measured by components along the unit eigenvectors instead.
 * Returns 0 where that does not apply: the multipliers are not real, or none is slow, or the two
 * directions are too close.
 */
static int slow_metric(const double m[2][2], double p[3])
{
  const double half = 0.5 * (m[0][0] + m[1][1]);
  const double root2 = half * half - (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
  if (!(root2 > 0.0) || fabs(half) + sqrt(root2) < trapping_slow) return 0;
  double a[2], b[2]; /* unit eigenvectors (a[k], b[k]) */
  for (int k = 0; k < 2; k++) {
    const double mu = half + (k == 0 ? sqrt(root2) : -sqrt(root2));
    const double row[2][2] = {{m[0][1], mu - m[0][0]}, {mu - m[1][1], m[1][0]}};
    const int r = hypot(row[1][0], row[1][1]) > hypot(row[0][0], row[0][1]);
    const double length = hypot(row[r][0], row[r][1]);
    a[k] = row[r][0] / length;
    b[k] = row[r][1] / length;
  }
  const double d = a[0] * b[1] - a[1] * b[0];
  if (!(fabs(d) > 0.1)) return 0;
  p[0] = (b[1] * b[1] + b[0] * b[0]) / (d * d);
  p[1] = -(a[1] * b[1] + a[0] * b[0]) / (d * d);
  p[2] = (a[1] * a[1] + a[0] * a[0]) / (d * d);
  return 1;
}

/*
 * Metric of a contracting 2x2 matrix: P = sum (M')^k M^k, summed by squaring:
 * P_{2m} = P_m + (M^m)' P_m M^m. Returns 0 if M does not contract.
 */
static int metric_of(const pendres_orbit *o, double p[3])
{
  double m[2][2];
  map_of(o, m);
  const double once[2][2] = {{m[0][0], m[0][1]}, {m[1][0], m[1][1]}};
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
  (void)slow_metric(once, p);
  const double mean = 0.5 * (p[0] + p[2]), spread = hypot(0.5 * (p[0] - p[2]), p[1]);
  const double least = mean - spread;
  if (!(least > 0.0)) return 0;
  for (int i = 0; i < 3; i++) p[i] /= least;
  return 1;
}

/*
 * The largest length that the linear map, `looks` times, makes of a unit length, in the metric: the
 * root of the larger eigenvalue of P^-1 Q with Q = (M^looks)' P M^looks.
 */
static double linear_share(const pendres_trapping_ellipse *t, const pendres_orbit *o, int looks)
{
  const double *p = t->metric;
  double m[2][2];
  map_of(o, m);
  double a = 1.0, b = 0.0, c = 0.0, d = 1.0;
  for (int k = 0; k < looks; k++) {
    const double top[2] = {a, b};
    a = m[0][0] * top[0] + m[0][1] * c;
    b = m[0][0] * top[1] + m[0][1] * d;
    c = m[1][0] * top[0] + m[1][1] * c;
    d = m[1][0] * top[1] + m[1][1] * d;
  }
  const double q[3] = {p[0] * a * a + 2.0 * p[1] * a * c + p[2] * c * c,
                       p[0] * a * b + p[1] * (a * d + b * c) + p[2] * c * d,
                       p[0] * b * b + 2.0 * p[1] * b * d + p[2] * d * d};
  const double half =
    0.5 * (p[2] * q[0] - 2.0 * p[1] * q[1] + p[0] * q[2]) / (p[0] * p[2] - p[1] * p[1]);
  const double det = a * d - b * c;
  return sqrt(half + sqrt(fmax(0.0, half * half - det * det)));
}

/* What the linear map makes of a difference from the centre, `looks` times. */
static void linear_image(const pendres_orbit *o, int looks, double d[2])
{
  double m[2][2];
  map_of(o, m);
  for (int k = 0; k < looks; k++) {
    const double y = m[0][0] * d[0] + m[0][1] * d[1];
    d[1] = m[1][0] * d[0] + m[1][1] * d[1];
    d[0] = y;
  }
}

/* The difference of the image of point i, counted round the ring, from its linear image. */
static void point_departure(const pendres_trapping_ring *r, int i, const pendres_orbit *o,
                            double d[2])
{
  const pendres_trapping_ellipse *t = r->ellipse;
  const pendres_trapping_point *p = &r->point[(i + r->points) % r->points];
  double at[2] = {p->y[0] - t->y, p->w[0] - t->w};
  linear_image(o, r->looks, at);
  const double y = p->y[r->looks] - t->y - at[0];
  d[0] = y - t->turn * rint(y / t->turn);
  d[1] = p->w[r->looks] - t->w - at[1];
}

/*
 * The departure of the map from its linear part, as a share of the space that the linear
 * contraction leaves between the ring and its image. Below one the image lies inside the ring; as
 * the departure falls with the square of the radius, all smaller ellipses are then mapped inside
 * themselves, too. The departure between two points is bounded as that of arcs is
 * (trapping_ring.h) and may take up all of the space; at the points it may take up base_departure.
 * Its tangents are taken from the neighbouring points: it changes like the double and threefold
 * angle, which 12 points resolve.
 */
static double ring_departure(const pendres_trapping_ring *r, const pendres_orbit *o)
{
  pendres_trapping_ellipse origin = *r->ellipse;
  origin.y = origin.w = 0.0;
  double worst = 0.0, d[4][2];
  for (int i = 0; i < r->points; i++) {
    double chord[2], first[2], last[2];
    for (int k = 0; k < 4; k++) point_departure(r, i - 1 + k, o, d[k]);
    for (int j = 0; j < 2; j++) {
      chord[j] = d[2][j] - d[1][j];
      first[j] = 0.5 * (d[2][j] - d[0][j]);
      last[j] = 0.5 * (d[3][j] - d[1][j]);
    }
    const double at = sqrt(fmax(pendres_trapping_norm2(&origin, d[1][0], d[1][1]),
                                pendres_trapping_norm2(&origin, d[2][0], d[2][1])));
    const double between = pendres_trapping_departure(r->ellipse, chord, first, last);
    /* NaN at any of the points makes `between` one. */
    if (isnan(between)) return INFINITY;
    worst = fmax(worst, fmax(at, trapping_base_departure * (at + between)));
  }
  return r->margin > 0.0 ? worst / r->margin : INFINITY;
}

/* ---- the search for the largest ring ---- */

typedef enum stage {
  STAGE_BASE,  /* look for a ring where the map is nearly linear */
  STAGE_CLIMB, /* larger rings, each coming home into the one before */
  STAGE_FINE,  /* between the largest that holds and the smallest that does not */
  STAGE_DONE
} stage;

typedef struct search {
  size_t orbit;
  stage stage;
  int pass;
  int base_looks;        /* iterates of a base ring */
  double base_share;     /* of a length that the linear map leaves then */
  int looks;             /* of the others */
  double base;           /* radius of the next base ring */
  double proven, failed; /* largest radius that holds (checked: trapping_ellipse.h), smallest that
                            does not */
  int rings;             /* of this pass */
  pendres_trapping_ring ring[TRAPPING_RINGS];
} search;

/* Iterates until the linear map contracts well in the ellipse's metric. */
static int contraction_looks(const pendres_trapping_ellipse *t, const pendres_orbit *o)
{
  int looks = 1;
  while (looks < TRAPPING_BASE_LOOKS &&
         linear_share(t, o, looks) >= trapping_base_contraction)
    looks++;
  return looks;
}

/* After how many iterates a ring is given up: with few pendulums to come, a larger ellipse does not
   repay the time that its slowest points take. */
static int patience(const pendres_orbit *o, pendres_trapping_effort effort)
{
  if (effort == PENDRES_TRAPPING_MANY) return PENDRES_TRAPPING_LOOKS;
  const double rate = -log(hypot(o->multiplier_re[0], o->multiplier_im[0]));
  const double way = log(trapping_climb / trapping_home);
  return (int)fmin((PENDRES_TRAPPING_LOOKS / 2), 2.0 + ceil(way / rate));
}

static void choose_ring(search *s, const pendres_trapping_ellipse *t, double radius, double home,
                        int points, int looks)
{
  pendres_trapping_ring *r = &s->ring[s->rings++];
  *r = (pendres_trapping_ring){
    .ellipse = t,
    .radius = radius,
    .home = home,
    .room = home > 0.0 ? s->proven : 0.0,
    .margin = home == 0.0 ? radius * (1.0 - s->base_share) : radius,
    .points = points,
    .looks = looks};
  pendres_trapping_factor(t, r->factor);
}

static void choose_rings(search *s, const pendres_trapping_ellipse *t)
{
  s->rings = 0;
  if (s->stage == STAGE_BASE) {
    choose_ring(s, t, s->base, 0.0, TRAPPING_BASE_POINTS, s->base_looks);
  } else if (s->stage == STAGE_CLIMB) {
    const double radius =
      s->failed > 0.0 ? sqrt(s->proven * s->failed)
                      : fmin(s->proven * trapping_climb, trapping_widest);
    choose_ring(s, t, radius, trapping_home * s->proven, TRAPPING_FEW_POINTS, s->looks);
  } else {
    for (int k = 1; k <= TRAPPING_RINGS; k++)
      choose_ring(s, t, s->proven * pow(s->failed / s->proven, k / (TRAPPING_RINGS + 1.0)),
                  trapping_home * s->proven, TRAPPING_MANY_POINTS, PENDRES_TRAPPING_LOOKS);
  }
}

/* Judge a base ring: the next one has a better radius, or the climb begins. */
static void judge_base(search *s, const pendres_orbit *o)
{
  const double departure = ring_departure(&s->ring[0], o);
  s->pass++;
  if (departure <= trapping_base_departure) {
    /* As the departure grows with the square of the radius, a larger one may do: try that once. */
    const int last = s->proven > 0.0 || departure > 0.5 * trapping_base_departure ||
                     s->base >= trapping_widest;
    s->proven = s->base;
    if (last || s->pass >= TRAPPING_BASE_PASSES) s->stage = STAGE_CLIMB;
    s->base = fmin(trapping_widest,
                   s->base * fmin(0.85 * trapping_base_departure / departure, 6.0));
  } else if (s->proven > 0.0) {
    s->stage = STAGE_CLIMB;
  } else {
    s->base *= fmax(0.85 * trapping_base_departure / departure, 1e-2);
    if (s->pass >= TRAPPING_BASE_PASSES) s->stage = STAGE_DONE;
  }
}

/* Judge the rings of this pass, and set the next stage. */
static void judge(search *s, const pendres_orbit *o, pendres_trapping_effort effort)
{
  const int many = effort == PENDRES_TRAPPING_MANY;
  if (s->stage == STAGE_BASE) {
    judge_base(s, o);
    return;
  }
  for (int k = 0; k < s->rings; k++) {
    if (s->ring[k].failed) {
      s->failed = s->ring[k].radius;
      break;
    }
    s->proven = s->ring[k].radius;
  }
  if (s->proven >= trapping_widest) {
    s->stage = STAGE_DONE;
  } else if (s->stage == STAGE_FINE) {
    if (s->failed < trapping_many_ratio * s->proven) s->stage = STAGE_DONE;
  } else if (s->failed > 0.0 && s->failed < trapping_few_ratio * s->proven) {
    /* A ring that failed since its points were too far apart may hold with more of them. */
    s->stage = many ? STAGE_FINE : STAGE_DONE;
    if (many) s->failed *= trapping_few_ratio;
  }
}

/* All rings of a pass, their points, those that arcs get, and the lanes that they are integrated
   in: all passes share this room, which would be large and cleared anew in each. */
typedef struct pass {
  int many;
  pendres_trapping_ring **rings;
  pendres_trapping_point *points, *between;
  pendres_strobe_lane *lanes;
} pass;

/* Rings of a search at a time, their points, and points that the arcs of one may get, at most. */
static int most_rings(int many)
{
  return many ? TRAPPING_RINGS : 1;
}

static int most_points(int many)
{
  return many ? TRAPPING_MANY_POINTS : TRAPPING_FEW_POINTS;
}

static int most_between(int many)
{
  return many ? 2 * TRAPPING_MANY_POINTS : TRAPPING_FEW_POINTS;
}

/*
 * Choose the steps of a ring. Those of ensembles are in single precision where the difference of
 * two points from which a tangent is taken is known as well as their places have to be.
 */
static pendres_status choose_steps(pendres_context *ctx, const pendres_pendulum *p, int many,
                                   pendres_trapping_ring *r)
{
  const pendres_trapping_ellipse *t = r->ellipse;
  const double accuracy = pendres_trapping_tolerance(r->margin);
  const double speed = pendres_steps_speed(p, t->y, t->w * p->drive_frequency);
  const int turns = pendres_model_of(p->force)->period > 0.0;
  r->lane = (pendres_strobe_lane){.pendulum = p};
  const pendres_status status =
    pendres_strobe_choose(ctx, turns ? 0.0 : speed, accuracy, &r->lane);
  if (!many)
    pendres_strobe_noise_choose(speed, pendres_strobe_noise_fastest(ctx, p),
                                trapping_beside * accuracy, &r->lane);
  return status;
}

/* Integrate the rings of all searches at once, and close the arcs of those that come home. */
static pendres_status run_rings(pendres_context *ctx, size_t n, search *s,
                                const pendres_orbit *orbits, const pass *of)
{
  size_t count = 0;
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < s[i].rings && status == PENDRES_OK; k++) {
      pendres_trapping_ring *r = of->rings[count++] = &s[i].ring[k];
      status = choose_steps(ctx, &orbits[s[i].orbit].pendulum, of->many, r);
    }
  if (status == PENDRES_OK)
    status = pendres_trapping_rings_run(ctx, count, of->rings, of->points, of->lanes);
  if (status == PENDRES_OK)
    status = pendres_trapping_rings_close(ctx, count, of->rings, most_between(of->many),
                                          of->between, of->lanes);
  return status;
}

pendres_status pendres_trapping_find(pendres_context *ctx, size_t n, const pendres_orbit *orbits,
                                     pendres_trapping_effort effort,
                                     pendres_trapping_ellipse *ellipses)
{
  pendres_room room = pendres_room_open(ctx, "trapping rings");
  search *s = pendres_room_take(&room, n, sizeof *s);
  size_t left = 0;
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++) {
    const pendres_orbit *o = &orbits[i];
    const pendres_coordinates at = pendres_coordinates_in_whole(&o->pendulum, o->x, o->v);
    ellipses[i] = (pendres_trapping_ellipse){
      .y = at.y, .w = at.w, .period = o->period, .winding = o->winding,
      .error = o->x_error + o->v_error, .turn = pendres_model_turn(&o->pendulum)};
    if (!o->stable) continue;
    if (pendres_trapping_is_weak(o)) even_metric(o, ellipses[i].metric);
    else if (!metric_of(o, ellipses[i].metric)) continue;
    const int looks = contraction_looks(&ellipses[i], o);
    s[left++] = (search){.orbit = i,
                         .stage = STAGE_BASE,
                         .base = trapping_base_first,
                         .base_looks = looks,
                         .base_share = linear_share(&ellipses[i], o, looks),
                         .looks = patience(o, effort)};
  }
  const int many = effort == PENDRES_TRAPPING_MANY;
  const size_t rings = left * (size_t)most_rings(many), points = rings * (size_t)most_points(many);
  const size_t between = points + 2 * rings * (size_t)most_between(many);
  const pass all = {.many = many,
                    .rings = pendres_room_take(&room, rings, sizeof *all.rings),
                    .points = pendres_room_take(&room, points, sizeof *all.points),
                    .between = pendres_room_take(&room, between, sizeof *all.between),
                    .lanes = pendres_room_take(&room, between, sizeof *all.lanes)};
  pendres_status status = room.status;
  while (left > 0 && status == PENDRES_OK) {
    for (size_t i = 0; i < left; i++) choose_rings(&s[i], &ellipses[s[i].orbit]);
    status = run_rings(ctx, left, s, orbits, &all);
    size_t again = 0;
    for (size_t i = 0; i < left && status == PENDRES_OK; i++) {
      judge(&s[i], &orbits[s[i].orbit], effort);
      ellipses[s[i].orbit].radius = (1.0 - trapping_margin) * s[i].proven;
      ellipses[s[i].orbit].room = trapping_margin * ellipses[s[i].orbit].radius;
      if (s[i].stage != STAGE_DONE) s[again++] = s[i];
    }
    left = again;
  }
  if (status == PENDRES_OK) status = pendres_trapping_levels_find(ctx, n, orbits, ellipses);
  return pendres_room_close(&room, status);
}
