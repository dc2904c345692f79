/*
 * hard_boundary.c -- starts next to the boundary between basins of attraction.
 *
 * Boundary points are found by bisection in extended precision, and starts set at distances from
 * them; where each goes is decided in extended precision, too: it is followed until it is inside a
 * trapping ellipse of an attractor (attractor.h). Two systems: the paper's figure 7, where a curve
 * of endless strands, but no fractal, separates two basins, and the forced pendulum in which the
 * boundary of every basin is that of all others (Kennedy and Yorke, Physica D 51 (1991) 213; Nusse,
 * Ott and Yorke, Phys. Rev. Lett. 75 (1995) 2482), where starts wander for long.
 */
#include <math.h>
#include <stdio.h>

#include "oracle/reference.h"

#include "validation/exact.h"
#include "validation/hard_cases.h"

static const double half_pi = 1.57079632679489661923;
static const double tolerances[] = { 1e-13, 1e-8 }; /* the tightest, the standard one */

enum {
  SYSTEMS = 2,
  POINTS = 4,         /* of the boundary, in each system */
  DISTANCES = 10,     /* 1e-3 ... 1e-12 */
  SIDES = 2,
  MOST = POINTS * DISTANCES * SIDES,
  MOST_PERIODS = 2000, /* of the truth */
  NAIVE_PERIODS = 60
};

static const pendres_pendulum systems[SYSTEMS] = {
  { .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.78539816339744830962 },
  { .damping = 0.2, .drive_amplitude = 1.66, .drive_frequency = 1.0 },
};

/* The attractor whose trapping ellipse a state is in; -1: none. */
static int ellipse_of(const pendres_attractors *set, long double y, long double v)
{
  for (size_t i = 0; i < pendres_attractors_count(set); i++) {
    const pendres_attractor *a = pendres_attractors_get(set, i);
    const double dy = remainder((double)y - (a->orbit.x - half_pi), 4.0 * half_pi);
    const double dw = (double)(v - a->orbit.v) / a->orbit.pendulum.drive_frequency;
    const double *m = a->trap_metric, r = a->trap_radius;
    if (m[0] * dy * dy + 2.0 * m[1] * dy * dw + m[2] * dw * dw <= r * r) return (int)i;
  }
  return -1;
}

/* Where a start goes, in extended precision. */
static pendres_status go(const pendres_attractors *set, const pendres_pendulum *p, long double y,
                         long double v, int *attractor)
{
  pendres_status status = PENDRES_OK;
  *attractor = ellipse_of(set, y, v);
  for (int k = 0; k < MOST_PERIODS && *attractor < 0 && status == PENDRES_OK; k++) {
    status = reference_advance(p, &y, &v, NULL, 1);
    *attractor = ellipse_of(set, y, v);
  }
  return status;
}

/*
 * Point number i of the boundary: on the line v = constant between two starts that go different
 * ways. *found: 0 if all of the line's starts go the same way.
 */
static pendres_status bisect(const pendres_attractors *set, const pendres_pendulum *p, int i,
                             long double *y, long double *v, int *found)
{
  enum { TRIES = 12 };
  long double low = -2.9L, high;
  int left, right, middle;
  *v = 0.35L * i - 0.8L;
  pendres_status status = go(set, p, low, *v, &left);
  *found = 0;
  for (int k = 1; k <= TRIES && !*found && status == PENDRES_OK; k++) {
    high = -2.9L + 5.5L * k / TRIES;
    status = go(set, p, high, *v, &right);
    *found = left >= 0 && right >= 0 && left != right;
    if (!*found) low = high, left = right;
  }
  while (*found && high - low > 1e-17L && status == PENDRES_OK) {
    const long double half = 0.5L * (low + high);
    if (!(low < half && half < high)) break;
    status = go(set, p, half, *v, &middle);
    if (middle == left) low = half;
    else high = half, right = middle;
  }
  *y = low;
  return status;
}

/*
 * Labels may go either way where the boundary is closer than about the tolerance: ten times that
 * is allowed to each period by the standard tolerance, three times by the tightest. A fractal
 * boundary has folds within folds: next to one point of it there are others. So all starts are
 * asked about their neighbourhood of that size: *clear, 1 if it goes the same way as a whole.
 */
static const double allowed[] = { 3.0, 10.0 };

/* The starts of one system, where they go, how far from a boundary point they are. */
typedef struct starts {
  int n;
  double x[MOST], v[MOST];
  int goes[MOST], distance[MOST];
  int clear[2][MOST]; /* of the boundary, by the tightest tolerance and the standard one */
} starts;

/* Whether start number n goes the same way as all of its neighbourhood, by tolerance number t. */
static pendres_status look_around(const pendres_attractors *set, const pendres_pendulum *p,
                                  starts *s, int n, int t)
{
  const long double y = s->x[n] - half_pi_exact, v = s->v[n];
  pendres_status status = PENDRES_OK;
  int *clear = &s->clear[t][n];
  *clear = s->goes[n] >= 0;
  for (int i = 0; i < 8 && *clear && status == PENDRES_OK; i++) {
    const long double size = (i < 4 ? 1.0L : 0.3L) * (long double)(allowed[t] * tolerances[t]);
    int other;
    status = go(set, p, y + (i % 4 < 2 ? size : 0.0L) * (i % 2 == 0 ? 1.0L : -1.0L),
                v + (i % 4 < 2 ? 0.0L : size) * (i % 2 == 0 ? 1.0L : -1.0L), &other);
    *clear = other == s->goes[n];
  }
  return status;
}

static pendres_status place_starts(const hard_sheet *sheet, const pendres_attractors *set,
                                   const pendres_pendulum *p, starts *s)
{
  const int points = sheet->scale >= 1.0 ? POINTS : sheet->scale >= 0.1 ? 2 : 1;
  pendres_status status = PENDRES_OK;
  s->n = 0;
  for (int i = 0; i < points && status == PENDRES_OK; i++) {
    long double y, v;
    int found;
    status = bisect(set, p, i, &y, &v, &found);
    for (int k = 0; found && k < DISTANCES * SIDES && status == PENDRES_OK; k++) {
      const long double off = powl(10.0L, -3 - k / SIDES) * (k % SIDES == 0 ? -1.0L : 1.0L);
      const int n = s->n;
      s->x[n] = (double)(y + off + half_pi_exact);
      s->v[n] = (double)v;
      s->distance[n] = k / SIDES;
      status = go(set, p, s->x[n] - half_pi_exact, s->v[n], &s->goes[n]);
      for (int t = 0; t < 2 && status == PENDRES_OK; t++)
        status = look_around(set, p, s, n, t);
      s->n += s->goes[n] >= 0;
    }
  }
  return status;
}

typedef struct count {
  int starts[DISTANCES], close[DISTANCES]; /* close: to a boundary, left out of what follows */
  int wrong[DISTANCES], naive[DISTANCES];
  int standard_starts, standard_wrong;
  int all, unresolved;
} count;

/* By tolerance number t. */
static pendres_status count_labels(hard_sheet *sheet, const pendres_attractors *set,
                                   const starts *s, int t, count *c)
{
  const pendres_options o = { .tolerance = tolerances[t] };
  pendres_settled outcome[MOST];
  pendres_context *ctx = NULL;
  pendres_status status = hard_context(sheet, &o, &ctx);
  if (status != PENDRES_OK) return status;
  status = pendres_attractors_settle(ctx, set, (size_t)s->n, s->x, s->v, outcome);
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  for (int i = 0; i < s->n && status == PENDRES_OK; i++) {
    const int wrong = outcome[i].attractor >= 0 && outcome[i].attractor != s->goes[i];
    c->all++;
    c->unresolved += outcome[i].attractor < 0;
    if (!s->clear[t][i]) continue;
    if (t == 0) c->wrong[s->distance[i]] += wrong;
    else c->standard_wrong += wrong, c->standard_starts++;
  }
  pendres_context_free(ctx);
  return status;
}

/* Some periods by plain ARKODE, then the nearest attractor. */
static pendres_status count_naive(hard_sheet *sheet, const pendres_attractors *set,
                                  const pendres_pendulum *p, const starts *s, count *c)
{
  pendres_context *ctx = NULL;
  pendres_status status = hard_naive_context(sheet, 1e-6, &ctx);
  if (status != PENDRES_OK) return status;
  for (int i = 0; i < s->n && status == PENDRES_OK; i++) {
    double x = s->x[i], v = s->v[i], least = INFINITY;
    int nearest = -1;
    status = pendres_strobe_advance(ctx, 1, p, &x, &v, NAIVE_PERIODS, NULL);
    for (size_t k = 0; k < pendres_attractors_count(set); k++) {
      const pendres_orbit *o = &pendres_attractors_get(set, k)->orbit;
      const double distance = hypot(remainder(x - o->x, 4.0 * half_pi), v - o->v);
      if (distance < least) least = distance, nearest = (int)k;
    }
    c->naive[s->distance[i]] += s->clear[0][i] && nearest != s->goes[i];
  }
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  pendres_context_free(ctx);
  return status;
}

static pendres_status count_system(hard_sheet *sheet, const pendres_pendulum *p, count *c)
{
  starts s;
  pendres_attractors *set = NULL;
  pendres_context *ctx = NULL;
  pendres_status status =
    hard_context(sheet, &(pendres_options){ .tolerance = tolerances[0] }, &ctx);
  if (status != PENDRES_OK) return status;
  status = pendres_attractors_find(ctx, p, 0, NULL, NULL, &set);
  if (status == PENDRES_OK) status = place_starts(sheet, set, p, &s);
  if (status != PENDRES_OK) {
    (void)hard_failed(sheet, status, ctx);
    goto done;
  }
  for (int i = 0; i < s.n; i++) {
    c->starts[s.distance[i]]++;
    c->close[s.distance[i]] += !s.clear[0][i];
  }
  status = count_labels(sheet, set, &s, 0, c);
  if (status == PENDRES_OK) status = count_labels(sheet, set, &s, 1, c);
  if (status == PENDRES_OK) status = count_naive(sheet, set, p, &s, c);
done:
  pendres_attractors_free(set);
  pendres_context_free(ctx);
  return status;
}

/*
 * Bound: no wrong label at the tightest tolerance, nor at the standard one, of starts further from
 * all boundaries than is allowed; and none without a label: distances grow to order one within
 * ln(1e12) over the logarithm of the saddle's multiplier, some dozens of periods, while the budget
 * is two thousand at least.
 */
pendres_status hard_boundary(hard_sheet *sheet)
{
  char quantity[96];
  count c = { 0 };
  pendres_status status = PENDRES_OK;
  for (int i = 0; i < SYSTEMS && status == PENDRES_OK; i++)
    status = count_system(sheet, &systems[i], &c);
  for (int k = 0; k < DISTANCES && status == PENDRES_OK; k++) {
    (void)snprintf(quantity, sizeof quantity, "wrong labels of %d starts (%d too close left out)",
                   c.starts[k] - c.close[k], c.close[k]);
    status = hard_sheet_add(sheet, hard_at("boundary", pow(10.0, -3 - k)).text, quantity,
                            c.wrong[k], 0.0, c.naive[k]);
  }
  (void)snprintf(quantity, sizeof quantity, "wrong labels of %d starts by tolerance 1e-8",
                 c.standard_starts);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "boundary_default", quantity, c.standard_wrong, 0.0, NAN);
  return status == PENDRES_OK
           ? hard_sheet_add(sheet, "boundary_unresolved", "share of starts without a label",
                            (double)c.unresolved / c.all, 0.0, NAN)
           : status;
}
