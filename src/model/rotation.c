/*
 * rotation.c -- rotations without a drive; see rotation.h.
 *
 * The torque is sin a. s is the angle from an upper equilibrium, y = -pi - a + s, where the force
 * is sin a - sin(a - s): the same function of s from each of them, as they are whole turns apart. A
 * torque above 1 has no equilibrium; s is then y.
 */
#include <pendres/rotation.h>

#include <float.h>
#include <math.h>
#include <stddef.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>

#include "base/angles.h"
#include "model/equation.h"
#include "model/model.h"
#include "model/numbers.h"
#include "model/rotation_slope.h"
#include "model/rotation_stiff.h"

enum { ORDER = 28 /* of series */ };

/* The order of series, and how small their last terms are relative to the velocity; of what panels
   collocation makes where friction is strong. */
typedef struct finesse {
  int order;
  double rest, panel;
} finesse;

static const finesse fine = {ORDER, 1e-17, 0.35}, coarser = {ORDER - 6, rotation_finest, 0.5};

typedef struct motion {
  double damping, torque;
  double angle; /* a; without an equilibrium 0 */
  finesse how;
} motion;

/* Series of the force at s: torque - sin(a - s), with no difference of near numbers where it is
   small: at s = 0, or without an equilibrium at the slowest place, s = pi/2. */
static void force_series(const motion *m, double s, double f[ORDER + 1])
{
  const double half = sin(0.5 * (m->torque > 1.0 ? s - half_pi : s));
  /* Of what is added to the torque, and its derivatives in turn: sin(s - a), or -sin s. */
  const double from = m->torque > 1.0 ? s + pi : s - m->angle;
  const double derivative[4] = {sin(from), cos(from), -sin(from), -cos(from)};
  double factor = 1.0;
  f[0] = m->torque > 1.0 ? (m->torque - 1.0) + 2.0 * half * half
                         : 2.0 * half * half * m->torque + cos(m->angle) * sin(s);
  for (int k = 1; k <= ORDER; k++) {
    factor /= k;
    f[k] = factor * derivative[k % 4];
  }
}

/* ---- along the velocity's graph ---- */

/* Series of the velocity from v[0] > 0 on. */
static void velocity_series(const motion *m, const double f[ORDER + 1], double v[ORDER + 1])
{
  for (int k = 0; k < m->how.order; k++) {
    double sum = f[k] - m->damping * v[k];
    for (int j = 1; j <= k; j++) sum -= j * v[j] * v[k + 1 - j];
    v[k + 1] = sum / ((k + 1) * v[0]);
  }
}

/* Series of 1/v. */
static void inverse_series(const motion *m, const double v[ORDER + 1], double r[ORDER + 1])
{
  r[0] = 1.0 / v[0];
  for (int k = 1; k <= m->how.order; k++) {
    double rest = 0.0;
    for (int j = 1; j <= k; j++) rest -= v[j] * r[k - j];
    r[k] = rest / v[0];
  }
}

/* The longest step within which the last two terms of a series are small against the first. */
static double longest(const motion *m, const double c[ORDER + 1])
{
  const int n = m->how.order;
  const double most = m->how.rest * c[0];
  const double last = pow(most / fmax(fabs(c[n]), DBL_MIN), 1.0 / n);
  return fmin(last, pow(most / fmax(fabs(c[n - 1]), DBL_MIN), 1.0 / (n - 1)));
}

/* The integral of a series over a step. */
static double integral_over(const motion *m, const double c[ORDER + 1], double h)
{
  double power = h, sum = c[0] * h;
  for (int k = 1; k <= m->how.order; k++) {
    power *= h;
    sum += c[k] * power / (k + 1);
  }
  return sum;
}

/* The velocity at the angle `to` of the motion that has v > 0 at `from`; *time takes what passes.
   NaN if it comes to rest before. */
static double velocity_at(const motion *m, double from, double v, double to, double *time)
{
  const double way = to > from ? 1.0 : -1.0;
  for (double s = from; (to - s) * way > 0.0;) {
    double f[ORDER + 1], c[ORDER + 1] = {v}, inverse[ORDER + 1];
    force_series(m, s, f);
    velocity_series(m, f, c);
    if (time != NULL) inverse_series(m, c, inverse);
    const double left = fabs(to - s), reach = longest(m, c);
    const double step = time != NULL ? fmin(reach, longest(m, inverse)) : reach;
    const double h = way * fmin(step, left);
    if (!(step > rotation_shortest)) return NAN;
    if (time != NULL) *time += integral_over(m, inverse, h);
    v = c[m->how.order];
    for (int k = m->how.order - 1; k >= 0; k--) v = fma(v, h, c[k]);
    s = step >= left ? to : s + h;
  }
  return v;
}

/* ---- along the manifolds of the upper equilibrium ---- */

/* The sum of a series without c[0] at s, up to where two terms in a row are small; NaN if none
   are. */
static double sum_at(const motion *m, const double c[ORDER + 1], double s)
{
  const double most = m->how.rest * fmax(fabs(c[1] * s), fabs(c[2] * s * s));
  double power = s, sum = c[1] * s;
  for (int k = 2; k < m->how.order; k++) {
    power *= s;
    sum += c[k] * power;
    if (fmax(fabs(c[k] * power), fabs(c[k + 1] * power * s)) <= most) return sum;
  }
  return NAN;
}

/*
 * The velocity on a manifold, on the side `way` of the equilibrium, as far from it as its series
 * reaches: at *s. Where the slope is 0 it is the centre manifold, whose series is asymptotic.
 */
static double leave(const motion *m, double slope, double way, double *s)
{
  double f[ORDER + 1], c[ORDER + 1] = {0.0, slope}, v = NAN;
  force_series(m, 0.0, f);
  for (int k = 2; k <= m->how.order; k++) {
    double sum = f[k];
    for (int j = 2; j < k; j++) sum -= j * c[j] * c[k + 1 - j];
    c[k] = sum / ((k + 1) * slope + m->damping);
  }
  for (*s = way; !(v > 0.0) && fabs(*s) > 1e-9; *s *= 0.8) v = sum_at(m, c, *s);
  *s /= 0.8;
  return v;
}

/* Slopes of the manifolds: of v' = lambda v, lambda^2 + gamma lambda = cos a. */
static double unstable_at(const motion *m, double to)
{
  const double stiffness = cos(m->angle), root = hypot(m->damping, 2.0 * sqrt(stiffness));
  double from;
  const double v = leave(m, 2.0 * stiffness / (m->damping + root), 1.0, &from);
  return velocity_at(m, from, v, to, NULL);
}

/*
 * The gap by which the unstable manifold passes above the stable one: at the lower equilibrium, up
 * to which the force accelerates, so that neither has come to rest on the way; or before it, where
 * the equilibria are so close that the series of the stable one reaches farther.
 */
static double gap(const motion *m)
{
  const double root = hypot(m->damping, 2.0 * sqrt(cos(m->angle))), lower = 2.0 * m->angle - pi;
  double at;
  double v = leave(m, -0.5 * (m->damping + root), -1.0, &at);
  if (lower < at) {
    v = velocity_at(m, at, v, lower, NULL);
    at = lower;
  }
  return unstable_at(m, at + two_pi) - v;
}

static motion at_torque(double damping, double torque, finesse how)
{
  return (motion){.damping = damping, .torque = torque, .how = how,
                  .angle = torque <= 1.0 ? asin(torque) : 0.0};
}

/* ---- zeros ---- */

typedef double function(double x, void *params);

/* The zero of a function between two places where its signs differ, by Brent's method in memory of
   our own: GSL's would end the program where there is none. */
static double zero_of(function *f, void *params, double low, double high)
{
  union {
    max_align_t align;
    unsigned char bytes[256];
  } state;
  gsl_function g = {f, params};
  gsl_root_fsolver s = {.type = gsl_root_fsolver_brent, .state = &state};
  if (s.type->size > sizeof state || !(f(low, params) * f(high, params) < 0.0)) return NAN;
  if (gsl_root_fsolver_set(&s, &g, low, high) != GSL_SUCCESS) return NAN;
  for (int i = 0; i < ITERATIONS; i++) {
    if (gsl_root_fsolver_iterate(&s) != GSL_SUCCESS) return NAN;
    const double from = gsl_root_fsolver_x_lower(&s), to = gsl_root_fsolver_x_upper(&s);
    if (fabs(to - from) <= 2.0 * DBL_EPSILON * fabs(to)) break;
  }
  return gsl_root_fsolver_root(&s);
}

static double gap_at_angle(double angle, void *params)
{
  motion *m = params;
  m->angle = angle;
  m->torque = sin(angle);
  return gap(m);
}

/* The angle of the least torque between 0 and pi/2, and what its rounding is: the gap's over its
   slope. */
static double least_angle(double damping, finesse how, double *rounding)
{
  motion m = {.damping = damping, .how = how};
  /* The least torque is below Melnikov's, by a share of about damping^2 / 4. */
  const double high = asin(fmin(1.0, 1.01 * 4.0 * damping / pi));
  const double angle = zero_of(gap_at_angle, &m, 0.0, high), h = 1e-4 * angle;
  const double slope = (gap_at_angle(angle, &m) - gap_at_angle(angle - h, &m)) / h;
  /* Compared with a computation in extended precision, it was up to 7 at 420 random dampings. */
  *rounding = 12.0 * DBL_EPSILON / fabs(slope);
  return angle;
}

static int sound_damping(double damping)
{
  return damping >= rotation_least_damping && damping <= rotation_most_damping;
}

/* Whether there is no rotation at a torque of 1, and then at no smaller one. There manifolds come
   to rest on their way, and the gap is not defined. */
static int none_at_one(double damping, finesse how)
{
  const motion at_one = at_torque(damping, 1.0, how);
  return damping > 1.0 && !(gap(&at_one) > 0.0);
}

pendres_status pendres_rotation_onset_find(double damping, pendres_rotation_onset *out)
{
  if (!sound_damping(damping) || out == NULL) return PENDRES_INVALID_ARGUMENT;
  *out = (pendres_rotation_onset){.torque = 1.0, .end = PENDRES_ROTATION_SADDLE_NODE};
  if (none_at_one(damping, fine)) return PENDRES_OK;
  double rounding, other;
  const double angle = least_angle(damping, fine, &rounding);
  const double check = least_angle(damping, coarser, &other);
  out->torque = sin(angle);
  out->torque_error = cos(angle) * (2.0 * fabs(angle - check) + rounding) +
                      DBL_EPSILON * out->torque;
  out->end = PENDRES_ROTATION_HOMOCLINIC;
  return PENDRES_OK;
}

/* ---- rotations ---- */

/* Where a turn begins, at y = 0. The upper equilibrium that it passes is at s = 0, so that no
   rounding of s matters close to it. */
static double start_of(const motion *m)
{
  return m->torque > 1.0 ? 0.0 : m->angle - pi;
}

/* By how much a turn changes the velocity at y = 0. */
static double gain(double v, void *params)
{
  const motion *m = params;
  const double from = start_of(m);
  return velocity_at(m, from, v, from + two_pi, NULL) - v;
}

static int by_collocation(const motion *m)
{
  const double passage = sqrt((m->torque - 1.0) * (m->torque + 1.0));
  return m->torque > 1.0 && m->damping >= rotation_strong &&
         m->damping * m->damping > rotation_much * passage;
}

/* The velocity at y = 0 and the period; NaN if there is no rotation. */
static double rotation_at(const motion *m, double *period)
{
  if (by_collocation(m))
    return pendres_rotation_stiff(m->damping, m->torque, m->how.panel, period);
  const double from = start_of(m);
  motion copy = *m;
  *period = NAN;
  /* Friction balances the greatest force at `high`, and the least one at `low`. */
  double low = (m->torque - 1.0) / m->damping;
  const double high = (m->torque + 1.0) / m->damping;
  if (m->torque <= 1.0) {
    if (none_at_one(m->damping, m->how) || !(gap(m) > 0.0)) return NAN;
    low = unstable_at(m, from + two_pi);
  } else if (low < rotation_slow) {
    /* For a series. What leaves the equilibrium at a torque of 1 is slower than the rotations
       above, too. */
    const motion at_one = at_torque(m->damping, 1.0, m->how);
    low = fmax(low, unstable_at(&at_one, pi + at_one.angle));
  }
  double v = low;
  if (gain(low, &copy) > 0.0) v = gain(high, &copy) < 0.0 ? zero_of(gain, &copy, low, high) : high;
  *period = 0.0;
  (void)velocity_at(m, from, v, from + two_pi, period);
  return v;
}

/* The time of a turn that begins with the velocity v at y = 0; NaN if it comes to rest. */
static double turn_from(const motion *m, double v)
{
  const double from = start_of(m);
  double time = 0.0;
  if (by_collocation(m))
    return pendres_rotation_stiff_period(m->damping, m->torque, m->how.panel, v);
  return isnan(velocity_at(m, from, v, from + two_pi, &time)) ? NAN : time;
}

/* The change of the period of a turn with the velocity at its start: it is large where the motion
   comes close to rest, since a slightly smaller velocity may then halve what is left of it. */
static double longer_by(const motion *m, double v, double change, double period)
{
  const double more = turn_from(m, v + change), less = turn_from(m, v - change);
  if (isnan(more) || isnan(less)) return period;
  return fmax(fabs(more - period), fabs(less - period));
}

/* ---- derivatives by torque and damping, at fixed angles ---- */

/* Series of the velocity's derivative: (v d)' = what is added to the force - damping d. */
static void derivative_series(const motion *m, const double v[ORDER + 1], int by,
                              double d[ORDER + 1])
{
  for (int k = 0; k < m->how.order; k++) {
    const double added = (by == ROTATION_BY_TORQUE && k == 0) - (by == ROTATION_BY_DAMPING) * v[k];
    double rest = (added - m->damping * d[k]) / (k + 1);
    for (int j = 1; j <= k + 1; j++) rest -= v[j] * d[k + 1 - j];
    d[k + 1] = rest / v[0];
  }
}

/* The integral of d / v^2 over a step. */
static double slower(const motion *m, const double d[ORDER + 1], const double inverse[ORDER + 1],
                     double h)
{
  double square[ORDER + 1] = {0.0}, sum[ORDER + 1] = {0.0};
  for (int k = 0; k <= m->how.order; k++)
    for (int j = 0; j <= k; j++) square[k] += inverse[j] * inverse[k - j];
  for (int k = 0; k <= m->how.order; k++)
    for (int j = 0; j <= k; j++) sum[k] += d[j] * square[k - j];
  return integral_over(m, sum, h);
}

static double value_at(const motion *m, const double c[ORDER + 1], double h)
{
  double v = c[m->how.order];
  for (int k = m->how.order - 1; k >= 0; k--) v = fma(v, h, c[k]);
  return v;
}

/* Those of a turn that begins with the velocity v at y = 0. */
static void turn_slopes(const motion *m, double v, rotation_slopes *out)
{
  const double to = start_of(m) + two_pi;
  *out = (rotation_slopes){.velocity[ROTATION_BY_START] = 1.0};
  for (double s = start_of(m); s < to;) {
    double f[ORDER + 1], c[ORDER + 1] = {v}, inverse[ORDER + 1];
    force_series(m, s, f);
    velocity_series(m, f, c);
    inverse_series(m, c, inverse);
    const double step = fmin(longest(m, c), longest(m, inverse)), h = fmin(step, to - s);
    for (int k = 0; k < ROTATION_SLOPES; k++) {
      double d[ORDER + 1] = {out->velocity[k]};
      derivative_series(m, c, k, d);
      out->time[k] -= slower(m, d, inverse, h);
      out->velocity[k] = value_at(m, d, h);
    }
    v = value_at(m, c, h);
    s = step >= to - s ? to : s + h;
    if (!(step > rotation_shortest)) out->time[0] = s = NAN;
  }
}

int pendres_rotation_slope_at(double damping, double torque, pendres_rotation_slope *out)
{
  const motion m = at_torque(damping, torque, coarser);
  rotation_slopes turn;
  double period;
  const double v = sound_damping(damping) && torque > 0.0 ? rotation_at(&m, &period) : NAN;
  if (isnan(v) || !isfinite(period)) return 0;
  if (by_collocation(&m))
    (void)pendres_rotation_stiff_slopes(damping, torque, m.how.panel, v, &turn);
  else turn_slopes(&m, v, &turn);
  double by[ROTATION_SLOPES];
  for (int k = 0; k < ROTATION_SLOPES; k++) {
    /* The velocity at the start is the same after a turn; a deviation is less by the multiplier. */
    const double start = turn.velocity[k] / -expm1(-damping * period);
    by[k] = turn.time[k] + (k != ROTATION_BY_START ? start * turn.time[ROTATION_BY_START] : 0.0);
  }
  out->mean_velocity = two_pi / period;
  out->by_torque = -out->mean_velocity / period * by[ROTATION_BY_TORQUE];
  out->by_damping = -out->mean_velocity / period * by[ROTATION_BY_DAMPING];
  return isfinite(out->by_torque) && isfinite(out->by_damping);
}

int pendres_rotation_onset_slope(double damping, double *torque, double *by_damping)
{
  pendres_rotation_onset onset;
  pendres_rotation_slope at;
  *by_damping = 0.0;
  if (pendres_rotation_onset_find(damping, &onset) != PENDRES_OK) return 0;
  *torque = onset.torque;
  if (onset.end == PENDRES_ROTATION_SADDLE_NODE) return 1;
  /* Along the rotations of a period; this one is so long that they are as far from the onset. */
  const double near = onset.torque * (1.0 + rotation_near_onset);
  if (!pendres_rotation_slope_at(damping, near, &at)) return 0;
  *by_damping = -at.by_damping / at.by_torque;
  return 1;
}

static const char *refuses(const pendres_pendulum *p)
{
  const char *why = NULL;
  if (pendres_pendulum_check(p, &why) != PENDRES_OK) return why;
  if (p->force != PENDRES_FORCE_PENDULUM)
    return "only the pendulum's force has rotations: other coordinates have no period";
  if (pendres_model_driven(p))
    return "under a drive a rotation has no period of its own: it is locked to the drive, an "
           "orbit, or quasi-periodic";
  if (pendres_equation_drags(p)) return pendres_equation_refuses_drag(p);
  if (!sound_damping(p->damping)) return "the damping of a rotation must lie between 1e-9 and 100";
  return NULL;
}

pendres_status pendres_rotation_find(const pendres_pendulum *p, pendres_rotation *out,
                                     const char **why)
{
  const char *wrong = refuses(p);
  if (wrong == NULL && out == NULL) wrong = "no place for the rotation was given";
  if (wrong != NULL) {
    if (why != NULL) *why = wrong;
    return PENDRES_INVALID_ARGUMENT;
  }
  double period, other;
  const double torque = fabs(p->torque), sign = p->torque < 0.0 ? -1.0 : 1.0;
  const motion m = at_torque(p->damping, torque, fine), n = at_torque(p->damping, torque, coarser);
  const double v = torque > 0.0 ? rotation_at(&m, &period) : NAN;
  const double check = torque > 0.0 ? rotation_at(&n, &other) : NAN;
  if (isnan(v) || isnan(check) || !isfinite(period)) {
    if (why != NULL) *why = "the torque is too small to keep a rotation up";
    return PENDRES_NOT_FOUND;
  }
  /* What rounding adds in a turn shrinks by the multiplier from turn to turn. */
  const double rounding = rotation_rounded_velocity * DBL_EPSILON / -expm1(-p->damping * period);
  out->period = period;
  out->period_error = 2.0 * fabs(period - other) + rotation_rounded_period * DBL_EPSILON * period +
                      longer_by(&m, v, rounding * v, period);
  out->mean_velocity = sign * two_pi / period;
  out->mean_velocity_error = fabs(out->mean_velocity) * (out->period_error / period + DBL_EPSILON);
  out->v = sign * v;
  out->v_error = 2.0 * fabs(v - check) + rounding * v;
  out->multiplier = exp(-p->damping * period);
  out->multiplier_error = out->multiplier * (p->damping * out->period_error + DBL_EPSILON);
  return PENDRES_OK;
}
