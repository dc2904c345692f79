/*
 * rotation_stiff.c -- rotations where friction is strong; see rotation_stiff.h.
 *
 * A turn is cut into panels. In each the slope of the velocity is a polynomial which fulfils
 * v dv/dy = I - sin y - gamma v at some nodes, the end of the panel among them. Deviations
 * from the rotation are therefore damped even where the panel is far longer than the angle within
 * which friction damps them (Hairer and Wanner, Solving Ordinary Differential Equations II, chapter
 * IV.3).
 */
#include "model/rotation_stiff.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "base/angles.h"
#include "model/numbers.h"

enum {
  NODES = 16,
  LAST = 3 /* coefficients from which the error of the polynomial is estimated */
};

/* Nodes between 0 and 1, and what does not depend on the panel. */
typedef struct rule {
  double node[NODES];
  double integral[NODES][NODES];    /* of a function with values at the nodes, up to each node */
  double coefficient[NODES][NODES]; /* Chebyshev's, of such a function */
} rule;

typedef struct stiff {
  double damping, torque;
  rule rule;
  rotation_slopes *slopes; /* carried along; NULL: not wanted */
} stiff;

static void swap(double *a, double *b)
{
  const double kept = *a;
  *a = *b;
  *b = kept;
}

/* Solve a x = b for some right-hand sides, the rows of b, by elimination; a is overwritten. NaN
   where it is singular. GSL's function would end the program there, and without memory. */
static void solve(double a[NODES][NODES], int n, double (*b)[NODES])
{
  for (int k = 0; k < NODES; k++) {
    int pivot = k;
    for (int i = k + 1; i < NODES; i++)
      if (fabs(a[i][k]) > fabs(a[pivot][k])) pivot = i;
    for (int j = 0; j < NODES; j++) swap(&a[k][j], &a[pivot][j]);
    for (int r = 0; r < n; r++) swap(&b[r][k], &b[r][pivot]);
    for (int i = k + 1; i < NODES; i++) {
      const double part = a[k][k] != 0.0 ? a[i][k] / a[k][k] : NAN;
      for (int j = k + 1; j < NODES; j++) a[i][j] -= part * a[k][j];
      for (int r = 0; r < n; r++) b[r][i] -= part * b[r][k];
    }
  }
  for (int r = 0; r < n; r++)
    for (int i = NODES; i-- > 0;) {
      for (int j = i + 1; j < NODES; j++) b[r][i] -= a[i][j] * b[r][j];
      b[r][i] = a[i][i] != 0.0 ? b[r][i] / a[i][i] : NAN;
    }
}

/* The integral of Chebyshev's polynomial number k, of 2 c - 1, from c = 0 on. */
static double chebyshev_integral(int k, double c)
{
  const double angle = acos(2.0 * c - 1.0);
  if (k == 0) return c;
  if (k == 1) return c * (c - 1.0);
  const double here = cos((k + 1) * angle) / (k + 1) - cos((k - 1) * angle) / (k - 1);
  const double there = (k % 2 == 0 ? -1.0 : 1.0) * (1.0 / (k + 1) - 1.0 / (k - 1));
  return 0.25 * (here - there);
}

static void make_rule(rule *r)
{
  double value[NODES][NODES], unit[NODES][NODES];
  for (int i = 0; i < NODES; i++) {
    const double angle = pi * (i + 1) / NODES;
    r->node[i] = i == NODES - 1 ? 1.0 : 0.5 - 0.5 * cos(angle);
    for (int k = 0; k < NODES; k++) {
      value[i][k] = cos(k * (pi - angle));
      unit[i][k] = i == k;
    }
  }
  solve(value, NODES, unit); /* unit[j]: the coefficients of what is 1 at node j alone */
  for (int i = 0; i < NODES; i++) {
    double up_to[NODES];
    for (int k = 0; k < NODES; k++) up_to[k] = chebyshev_integral(k, r->node[i]);
    for (int j = 0; j < NODES; j++) {
      r->coefficient[i][j] = unit[j][i];
      r->integral[i][j] = 0.0;
      for (int k = 0; k < NODES; k++) r->integral[i][j] += unit[j][k] * up_to[k];
    }
  }
}

/* The torque less sin y at s = y - pi/2, the angle from the slowest place on, around which neither
   angles nor forces are differences of near numbers. */
static double force_at(const stiff *m, double s)
{
  const double half = sin(0.5 * s);
  return (m->torque - 1.0) + 2.0 * half * half;
}

/* The largest of the last coefficients of values at the nodes. */
static double missing(const rule *r, const double value[NODES])
{
  double largest = 0.0;
  for (int k = NODES - LAST; k < NODES; k++) {
    double sum = 0.0;
    for (int j = 0; j < NODES; j++) sum += r->coefficient[k][j] * value[j];
    largest = fmax(largest, fabs(sum));
  }
  return largest;
}

/* Velocities at the nodes from v at the start and slopes; the least of them. */
static double velocities(const rule *r, double v, double h, const double slope[NODES],
                         double velocity[NODES])
{
  double least = INFINITY;
  for (int i = 0; i < NODES; i++) {
    double sum = 0.0;
    for (int j = 0; j < NODES; j++) sum += r->integral[i][j] * slope[j];
    velocity[i] = v + h * sum;
    least = fmin(least, velocity[i]);
  }
  return least;
}

/* Initial slopes at the nodes: with friction alone the velocity would decay to that at which it
   balances the force. */
static void guess(const stiff *m, double v, double h, const double force[NODES],
                  double slope[NODES])
{
  for (int i = 0; i < NODES; i++) {
    const double rest = force[i] / m->damping;
    const double forgets = m->damping * h * m->rule.node[i] / fmax(v, rest);
    const double velocity = rest + (v - rest) * exp(-forgets);
    slope[i] = (force[i] - m->damping * velocity) / velocity;
  }
}

/* The matrix of the panel's equations, derived by the slopes at the nodes. */
static void matrix(const rule *r, double damping, double h, const double slope[NODES],
                   const double velocity[NODES], double a[NODES][NODES])
{
  for (int i = 0; i < NODES; i++)
    for (int j = 0; j < NODES; j++)
      a[i][j] = (slope[i] + damping) * h * r->integral[i][j] + (i == j ? velocity[i] : 0.0);
}

/* Newton's method for the slopes at the nodes; whether it has converged. */
static int improve(const stiff *m, double v, double h, const double force[NODES],
                   double slope[NODES], double velocity[NODES])
{
  const rule *r = &m->rule;
  double change = INFINITY, before = INFINITY;
  for (int k = 0; k < NEWTON_STEPS; k++) {
    double a[NODES][NODES], b[1][NODES];
    if (!(velocities(r, v, h, slope, velocity) > 0.0)) return 0;
    matrix(r, m->damping, h, slope, velocity, a);
    for (int i = 0; i < NODES; i++)
      b[0][i] = force[i] - velocity[i] * (slope[i] + m->damping);
    solve(a, 1, b);
    before = change;
    change = 0.0;
    for (int i = 0; i < NODES; i++) {
      slope[i] += b[0][i];
      change = fmax(change, fabs(b[0][i]) * h / v);
    }
    /* Down to where rounding keeps it from falling further. */
    if (change < 1e-11 || (change < 1e-8 && change > 0.1 * before)) break;
  }
  return change < 1e-8 && velocities(r, v, h, slope, velocity) > 0.0;
}

/* Derivatives of velocity and time over a panel that has been found. */
static void carry(const stiff *m, double h, const double slope[NODES],
                  const double velocity[NODES])
{
  const rule *r = &m->rule;
  double a[NODES][NODES], b[ROTATION_SLOPES][NODES];
  matrix(r, m->damping, h, slope, velocity, a);
  for (int k = 0; k < ROTATION_SLOPES; k++)
    for (int i = 0; i < NODES; i++)
      b[k][i] = (k == ROTATION_BY_TORQUE) - (k == ROTATION_BY_DAMPING) * velocity[i] -
                (slope[i] + m->damping) * m->slopes->velocity[k];
  solve(a, ROTATION_SLOPES, b);
  for (int k = 0; k < ROTATION_SLOPES; k++) {
    double by[NODES], passed = 0.0;
    (void)velocities(r, m->slopes->velocity[k], h, b[k], by);
    for (int i = 0; i < NODES; i++)
      passed += r->integral[NODES - 1][i] * by[i] / (velocity[i] * velocity[i]);
    m->slopes->velocity[k] = by[NODES - 1];
    m->slopes->time[k] -= h * passed;
  }
}

/*
 * The velocity at the end of a panel from s on, of width h; its time is added. NaN where Newton's
 * method does not converge, or the polynomial misses too much.
 */
static double panel(const stiff *m, double s, double v, double h, double *time)
{
  const rule *r = &m->rule;
  double force[NODES], slope[NODES], velocity[NODES], inverse[NODES];
  double least = INFINITY, largest = 0.0, passed = 0.0;
  for (int i = 0; i < NODES; i++) force[i] = force_at(m, s + h * r->node[i]);
  guess(m, v, h, force, slope);
  if (!improve(m, v, h, force, slope, velocity)) return NAN;
  for (int i = 0; i < NODES; i++) {
    inverse[i] = 1.0 / velocity[i];
    least = fmin(least, velocity[i]);
    largest = fmax(largest, inverse[i]);
    passed += r->integral[NODES - 1][i] * inverse[i];
  }
  if (missing(r, velocity) > rotation_finest * least ||
      missing(r, inverse) > rotation_finest * largest) return NAN;
  *time += h * passed;
  if (m->slopes != NULL) carry(m, h, slope, velocity);
  return velocity[NODES - 1];
}

/* The velocity after a turn from y = 0 on, and the time that it takes. */
static double turn(const stiff *m, double v, double widest, double *time)
{
  const double end = 1.5 * pi;
  double h = widest, s = -half_pi;
  *time = 0.0;
  while (s < end) {
    const double to = fmin(end, s + h), next = panel(m, s, v, to - s, time);
    if (isnan(next)) h = 0.6 * (to - s);
    if (isnan(next) && !(h > rotation_shortest)) return NAN;
    if (isnan(next)) continue;
    v = next;
    s = to;
    h = fmin(widest, 1.5 * h);
  }
  return v;
}

double pendres_rotation_stiff(double damping, double torque, double widest, double *period)
{
  stiff m = {.damping = damping, .torque = torque};
  double v = torque / damping;
  make_rule(&m.rule);
  *period = NAN;
  for (int i = 0; i < NEWTON_STEPS; i++) {
    const double next = turn(&m, v, widest, period);
    if (isnan(next)) return NAN;
    /* By how much a turn changes what is added to the velocity: Liouville's formula. */
    const double change = (next - v) / (1.0 - v / next * exp(-damping * *period));
    v += change;
    if (fabs(change) <= 4.0 * DBL_EPSILON * v) break;
  }
  return v;
}

double pendres_rotation_stiff_period(double damping, double torque, double widest, double v)
{
  stiff m = {.damping = damping, .torque = torque};
  double period = NAN;
  make_rule(&m.rule);
  return isnan(turn(&m, v, widest, &period)) ? NAN : period;
}

double pendres_rotation_stiff_slopes(double damping, double torque, double widest, double v,
                                     rotation_slopes *out)
{
  stiff m = {.damping = damping, .torque = torque, .slopes = out};
  double period = NAN;
  *out = (rotation_slopes){.velocity[ROTATION_BY_START] = 1.0};
  make_rule(&m.rule);
  return isnan(turn(&m, v, widest, &period)) ? NAN : period;
}
