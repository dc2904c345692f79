/*
 * trapping_level.c -- regions around weakly damped orbits, bounded by level lines of a polynomial.
 *
 * Where damping is weak, an ellipse of the linear metric comes home only if it is so small that the
 * nonlinearity moves its points by less than a period's damping does. A polynomial V can be found
 * that follows the nonlinearity: with z the distance from the Poincaré point in the metric that the
 * linear map M shrinks evenly, V = |z|^2 + terms of the third to the sixth degree, such that
 * V(image of z) = |det M| V(z) up to terms of the seventh degree. It is the square of the distance
 * from the orbit in coordinates in which the map is M itself (a Birkhoff normal form). Where V
 * falls from each strobe to the next in all of a region V <= level, states in it come to the orbit.
 *
 * V is found by least squares on a disk of states that are followed over the orbit's period, and so
 * is the region in which it is seen to fall. On every second ray of the disk V is fitted, on the
 * others it is only looked at. It has to fall by at least half of what damping gives on all rays:
 * checked, not proved, as with ellipses.
 */
#include "settling/trapping/trapping_ellipse.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/steps.h"
#include "engine/strobe_run.h"
#include "model/equation.h"
#include "model/model.h"
#include "orbits/orbit_measure.h"
#include "settling/trapping/numbers.h"
#include "settling/trapping/trapping_ring.h"

enum {
  POINTS = LEVEL_CIRCLES * LEVEL_RAYS,
  FITTED = POINTS / 2,
  TERMS = PENDRES_TRAPPING_TERMS
};

/* ---- the polynomial ---- */

/* Its terms at a point: p^6, p^5 q, ... q^6 follow those of lower degree. */
static void terms_at(double p, double q, double out[TERMS])
{
  double of_p[PENDRES_TRAPPING_DEGREE + 1] = {1.0}, of_q[PENDRES_TRAPPING_DEGREE + 1] = {1.0};
  for (int k = 1; k <= PENDRES_TRAPPING_DEGREE; k++) {
    of_p[k] = p * of_p[k - 1];
    of_q[k] = q * of_q[k - 1];
  }
  for (int degree = 3, k = 0; degree <= PENDRES_TRAPPING_DEGREE; degree++)
    for (int b = 0; b <= degree; b++) out[k++] = of_p[degree - b] * of_q[b];
}

static double value_at(const double term[TERMS], const double z[2])
{
  double at[TERMS], sum = z[0] * z[0] + z[1] * z[1];
  terms_at(z[0], z[1], at);
  for (int k = 0; k < TERMS; k++) sum += term[k] * at[k];
  return sum;
}

/* Coordinates in the metric, in units of `length`. */
static void coordinates(const pendres_trapping_ellipse *t, double length, double y, double w,
                        double z[2])
{
  pendres_trapping_coordinates(t, y, w, z);
  z[0] /= length;
  z[1] /= length;
}

double pendres_trapping_polynomial(const pendres_trapping_ellipse *t, double y, double w)
{
  double z[2];
  coordinates(t, t->unit, y, w, z);
  return value_at(t->term, z);
}

/* ---- a disk of states ---- */

typedef struct disk {
  size_t orbit;
  double kept;        /* |det M|: of V, by the linear map */
  double radius;
  double pace;        /* radius of the next disk, as a multiple */
  double best;        /* mean square radius of the best region so far */
  int passes, steps, done;
  double from[POINTS][2], to[POINTS][2]; /* states and their images, in units of radius */
  pendres_trapping_ellipse ellipse;      /* with the metric of the linear map */
} disk;

/* Lay the points of a disk. */
static void lay(disk *d, pendres_strobe_lane *lanes, const pendres_pendulum *p,
                pendres_flow_way way)
{
  double factor[3];
  pendres_trapping_factor(&d->ellipse, factor);
  for (int i = 0; i < POINTS; i++) {
    const double r = (i / LEVEL_RAYS + 1.0) / LEVEL_CIRCLES;
    const double angle = two_pi * (i % LEVEL_RAYS) / LEVEL_RAYS;
    d->from[i][0] = r * cos(angle);
    d->from[i][1] = r * sin(angle);
    lanes[i] = (pendres_strobe_lane){.pendulum = p, .steps = d->steps, .way = way};
    pendres_trapping_state(&d->ellipse, factor, d->radius * d->from[i][0],
                           d->radius * d->from[i][1], &lanes[i].y, &lanes[i].w);
  }
}

static int back(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  disk *const *of = arg;
  return lane->period >= of[index / POINTS]->ellipse.period;
}

/* ---- the fit ---- */

/* Whether a point is fitted, or looked at. */
static int fitted(int i)
{
  return i % 2 == 0;
}

/* V by least squares of V(image) - kept V, as a share of |z|^2. */
static pendres_status fit(pendres_context *ctx, const disk *d, double term[TERMS])
{
  enum { ROWS = FITTED + TERMS };
  gsl_matrix *a = gsl_matrix_calloc(ROWS, TERMS);
  gsl_vector *b = gsl_vector_calloc(ROWS), *tau = gsl_vector_alloc(TERMS);
  gsl_vector *left = gsl_vector_alloc(ROWS);
  gsl_vector_view x = gsl_vector_view_array(term, TERMS);
  pendres_status status = PENDRES_OK;
  if (a == NULL || b == NULL || tau == NULL || left == NULL)
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for trapping levels");
  for (int i = 0, row = 0; i < POINTS && status == PENDRES_OK; i++) {
    double here[TERMS], there[TERMS];
    const double *from = d->from[i], *to = d->to[i];
    const double square = from[0] * from[0] + from[1] * from[1];
    if (!fitted(i)) continue;
    terms_at(from[0], from[1], here);
    terms_at(to[0], to[1], there);
    for (size_t k = 0; k < TERMS; k++)
      gsl_matrix_set(a, (size_t)row, k, (there[k] - d->kept * here[k]) / square);
    gsl_vector_set(b, (size_t)row++, d->kept - (to[0] * to[0] + to[1] * to[1]) / square);
  }
  for (size_t k = 0; k < TERMS && status == PENDRES_OK; k++)
    gsl_matrix_set(a, FITTED + k, k, level_indifferent * (1.0 - d->kept));
  if (status == PENDRES_OK &&
      (gsl_linalg_QR_decomp(a, tau) != 0 ||
       gsl_linalg_QR_lssolve(a, tau, b, &x.vector, left) != 0))
    for (int k = 0; k < TERMS; k++) term[k] = NAN; /* which has no region */
  gsl_matrix_free(a);
  gsl_vector_free(b);
  gsl_vector_free(tau);
  gsl_vector_free(left);
  return status;
}

/* ---- the region ---- */

/* Values of V on the disk, and the power with which it grows from the circle before. */
typedef struct landscape {
  double value[POINTS], growth[POINTS];
  unsigned char falls[POINTS]; /* from a strobe to the next, and grows along the ray */
} landscape;

static double radius_of(int circle)
{
  return (circle + 1.0) / LEVEL_CIRCLES;
}

static void survey(const disk *d, const double term[TERMS], landscape *l)
{
  for (int i = 0; i < POINTS; i++) {
    const double here = value_at(term, d->from[i]), there = value_at(term, d->to[i]);
    const int circle = i / LEVEL_RAYS;
    l->value[i] = here;
    /* Before the first circle it is |z|^2, taken at half of that circle's radius. */
    const double inner = circle > 0 ? radius_of(circle - 1) : 0.5 * radius_of(0);
    const double before = circle > 0 ? l->value[i - LEVEL_RAYS] : inner * inner;
    l->growth[i] = log(here / before) / log(radius_of(circle) / inner);
    l->falls[i] = there >= 0.0 && there - here <= -level_least_fall * (1.0 - d->kept) * here &&
                  l->growth[i] >= 1.0 / level_growth && l->growth[i] <= level_growth;
  }
}

/* The level up to which V falls everywhere: below what it is next to points where it does not, one
   circle further in, and on the disk's edge. 0 if there is none. */
static double highest_level(const landscape *l)
{
  double level = INFINITY;
  for (int i = 0; i < POINTS; i++) {
    const int circle = i / LEVEL_RAYS, ray = i % LEVEL_RAYS;
    if (circle == LEVEL_CIRCLES - 1) level = fmin(level, l->value[i]);
    if (l->falls[i]) continue;
    if (circle == 0) return 0.0;
    for (int k = LEVEL_RAYS - 1; k <= LEVEL_RAYS + 1; k++)
      level = fmin(level, l->value[(circle - 1) * LEVEL_RAYS + (ray + k) % LEVEL_RAYS]);
  }
  return level;
}

/* Whether V comes back near a level on a ray that has left it further in; *least: what it comes
   back to. */
static int comes_back(const landscape *l, int circle, double level, double *least)
{
  *least = INFINITY;
  for (int i = circle * LEVEL_RAYS; i < (circle + 1) * LEVEL_RAYS && circle > 0; i++)
    if (l->value[i - LEVEL_RAYS] > level && l->value[i] < l->value[i - LEVEL_RAYS])
      *least = fmin(*least, l->value[i]);
  return *least < level_beyond * level;
}

/* The first circle that is outside of the level on all rays; -1 if none is. Where a ray comes back
   before that, the level is lowered. */
static int outside(const landscape *l, double *level)
{
  double least, lowest;
  for (int circle = 0; circle < LEVEL_CIRCLES && *level > 0.0; circle++) {
    if (comes_back(l, circle, *level, &least)) {
      *level = fmin(0.99 * least / level_beyond, 0.99 * *level);
      circle = -1;
      continue;
    }
    lowest = INFINITY;
    for (int i = circle * LEVEL_RAYS; i < (circle + 1) * LEVEL_RAYS; i++)
      lowest = fmin(lowest, l->value[i]);
    if (lowest > *level) return circle;
  }
  return -1;
}

/* Where V has a value on a ray, taken for a power between circles. */
static double radius_at(const landscape *l, int ray, double value)
{
  int circle = 0;
  while (circle < LEVEL_CIRCLES - 1 && l->value[circle * LEVEL_RAYS + ray] < value) circle++;
  const int i = circle * LEVEL_RAYS + ray;
  return radius_of(circle) * pow(value / l->value[i], 1.0 / l->growth[i]);
}

/* The region of the fitted polynomial, into the ellipse; returns its mean square radius, 0 if there
   is none. *whole: whether V falls on all of the disk. */
static double take_region(const disk *d, pendres_trapping_ellipse *t, int *whole)
{
  landscape l;
  double least = INFINITY, squares = 0.0;
  survey(d, t->term, &l);
  *whole = memchr(l.falls, 0, POINTS) == NULL;
  double level = highest_level(&l);
  if (!(level > 0.0)) return 0.0;
  level *= 1.0 - trapping_margin; /* between rays */
  const int circle = outside(&l, &level);
  if (circle < 0) return 0.0;
  const double inner = (1.0 - trapping_margin) * (1.0 - trapping_margin) * level;
  for (int ray = 0; ray < LEVEL_RAYS; ray++) {
    const double r = d->radius * radius_at(&l, ray, inner);
    least = fmin(least, r);
    squares += r * r / LEVEL_RAYS;
  }
  t->radius = (1.0 - trapping_margin) * least; /* between rays */
  t->room = level_room_share * trapping_margin * t->radius;
  t->unit = d->radius;
  t->reach = radius_of(circle) * d->radius;
  t->level = inner;
  return squares;
}

/* ---- the search for the best disk ---- */

/* Judge a disk that has been followed, and choose the next one. `found` gets what is better. */
static pendres_status judge(pendres_context *ctx, disk *d, pendres_trapping_ellipse *found)
{
  pendres_trapping_ellipse t = d->ellipse;
  int whole = 0;
  const pendres_status status = fit(ctx, d, t.term);
  if (status != PENDRES_OK) return status;
  const double squares = take_region(d, &t, &whole);
  if (squares > d->best) {
    if (squares > found->radius * found->radius) *found = t;
    d->best = squares;
  } else if (d->best > 0.0) {
    d->done = 1; /* the one before was the best */
  }
  if (d->passes++ == 0) d->pace = whole ? level_pace : 1.0 / level_pace;
  const double next = fmin(trapping_widest, d->radius * d->pace);
  if (d->passes >= LEVEL_PASSES || next == d->radius || next < d->ellipse.radius) d->done = 1;
  d->radius = next;
  return status;
}

/* Follow the points of *n disks over their orbits' periods; *n becomes how many could be. */
static pendres_status follow(pendres_context *ctx, size_t *n, disk **disks,
                             const pendres_orbit *orbits, pendres_strobe_lane *lanes)
{
  pendres_status status = PENDRES_OK;
  size_t count = 0;
  for (size_t i = 0; i < *n; i++) {
    disk *d = disks[i];
    const pendres_pendulum *p = &orbits[d->orbit].pendulum;
    const pendres_trapping_ellipse *t = &d->ellipse;
    const double speed = pendres_steps_speed(p, t->y + pendres_model_origin(p),
                                             (fabs(t->w) + d->radius) * p->drive_frequency);
    const double margin = (1.0 - d->kept) * radius_of(0) * d->radius;
    status = pendres_steps_choose(ctx, p, speed, pendres_trapping_tolerance(margin), &d->steps);
    if (status == PENDRES_TOLERANCE_UNREACHABLE) continue; /* its ellipse has to do */
    if (status != PENDRES_OK) return status;
    lay(d, lanes + count * POINTS, p, pendres_strobe_way(ctx, p));
    disks[count++] = d;
  }
  *n = count;
  status = pendres_strobe_run(ctx, count * POINTS, lanes, back, disks);
  for (size_t k = 0; k < count * POINTS && status == PENDRES_OK; k++) {
    disk *d = disks[k / POINTS];
    coordinates(&d->ellipse, d->radius, lanes[k].y, lanes[k].w, d->to[k % POINTS]);
  }
  return status;
}

/* A disk for an orbit. The ellipse tells how far the nonlinearity lets linear rings come, which is
   in proportion to the damping: divided by that, it is the distance at which the nonlinearity
   counts. */
static void begin(disk *d, size_t orbit, const pendres_orbit *o, const pendres_trapping_ellipse *t)
{
  const double kept =
    exp(-two_pi * o->period * pendres_orbit_contraction(o) / o->pendulum.drive_frequency);
  *d = (disk){.orbit = orbit, .kept = kept, .ellipse = *t};
  d->radius = fmin(trapping_widest, 0.5 * t->radius / (1.0 - kept));
}

static int has_room(const pendres_orbit *o, const pendres_trapping_ellipse *t)
{
  return t->radius > 0.0 && pendres_trapping_is_weak(o);
}

pendres_status pendres_trapping_levels_find(pendres_context *ctx, size_t n,
                                            const pendres_orbit *orbits,
                                            pendres_trapping_ellipse *ellipses)
{
  size_t left = 0;
  for (size_t i = 0; i < n; i++) left += (size_t)has_room(&orbits[i], &ellipses[i]);
  if (left == 0) return PENDRES_OK;
  pendres_room room = pendres_room_open(ctx, "trapping levels");
  disk *disks = pendres_room_take(&room, left, sizeof *disks);
  disk **at = pendres_room_take(&room, left, sizeof *at);
  pendres_strobe_lane *lanes = pendres_room_take(&room, left * POINTS, sizeof *lanes);
  pendres_status status = room.status;
  if (status != PENDRES_OK) return pendres_room_close(&room, status);
  for (size_t i = 0, k = 0; i < n && k < left; i++) {
    if (!has_room(&orbits[i], &ellipses[i])) continue;
    at[k] = &disks[k];
    begin(&disks[k++], i, &orbits[i], &ellipses[i]);
  }
  while (left > 0 && status == PENDRES_OK) {
    status = follow(ctx, &left, at, orbits, lanes);
    size_t again = 0;
    for (size_t k = 0; k < left && status == PENDRES_OK; k++) {
      status = judge(ctx, at[k], &ellipses[at[k]->orbit]);
      if (!at[k]->done) at[again++] = at[k];
    }
    left = again;
  }
  return pendres_room_close(&room, status);
}
