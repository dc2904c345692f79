/*
 * langevin_linear.c -- linear noise theory around a closed orbit; see langevin.h.
 *
 * Around an orbit (x, v) small deviations obey d' = J d + noise, with J = [0 1; -sin x, -gamma] for
 * a plain pendulum, else with the slope of its own force.
 * With M the fundamental matrix of one cycle and C the covariance that noise adds over it,
 * the cloud settles to sigma = M sigma M^T + C (van Kampen, Stochastic Processes in Physics
 * and Chemistry, chapter VIII.6, for periodic coefficients).
 */
#include <pendres/langevin.h>

#include <math.h>
#include <stddef.h>

#include "base/angles.h"
#include "engine/kernels/coordinates.h"
#include "model/equation.h"
#include "model/model.h"
#include "model/units.h"
#include "noise/noise_common.h"
#include "noise/numbers.h"

/* What is integrated: the orbit, its variation row by row, and the covariance. */
enum { X, V, MXX, MXV, MVX, MVV, CXX, CXV, CVV, SIZE };

static void slope(const pendres_pendulum *p, double t, const double s[SIZE], double d[SIZE])
{
  double jx, jv;
  pendres_model_jacobian(p, s[X], s[V], &jx, &jv);
  if (p->parametric_amplitude != 0.0)
    jx *= 1.0 + p->parametric_amplitude * cos(p->drive_frequency * t);
  d[X] = s[V];
  d[V] = pendres_pendulum_acceleration(p, s[X], s[V], t);
  d[MXX] = s[MVX];
  d[MXV] = s[MVV];
  d[MVX] = jx * s[MXX] + jv * s[MVX];
  d[MVV] = jx * s[MXV] + jv * s[MVV];
  d[CXX] = 2.0 * s[CXV];
  d[CXV] = s[CVV] + jx * s[CXX] + jv * s[CXV];
  d[CVV] = 2.0 * (jx * s[CXV] + jv * s[CVV]) + 2.0 * p->damping * p->temperature;
}

/* The classical Runge-Kutta method, `steps` a period; each period begins at time 0 again. */
static void integrate(const pendres_pendulum *p, int cycle, int steps, double s[SIZE])
{
  const double h = two_pi / p->drive_frequency / steps;
  double a[SIZE], b[SIZE], c[SIZE], d[SIZE], y[SIZE];
  for (long k = 0; k < (long)cycle * steps; k++) {
    const double t = (double)(k % steps) * h;
    slope(p, t, s, a);
    for (int i = 0; i < SIZE; i++) y[i] = s[i] + 0.5 * h * a[i];
    slope(p, t + 0.5 * h, y, b);
    for (int i = 0; i < SIZE; i++) y[i] = s[i] + 0.5 * h * b[i];
    slope(p, t + 0.5 * h, y, c);
    for (int i = 0; i < SIZE; i++) y[i] = s[i] + h * c[i];
    slope(p, t + h, y, d);
    for (int i = 0; i < SIZE; i++) s[i] += h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
  }
}

pendres_status pendres_langevin_lyapunov(const double m[4], const pendres_langevin_covariance *q,
                                         pendres_langevin_covariance *sigma)
{
  if (m == NULL || q == NULL || sigma == NULL ||
      !(isfinite(m[0]) && isfinite(m[1]) && isfinite(m[2]) && isfinite(m[3]) && isfinite(q->xx) &&
        isfinite(q->xv) && isfinite(q->vv)))
    return PENDRES_INVALID_ARGUMENT;
  const double a = m[0], b = m[1], c = m[2], d = m[3];
  const double trace = a + d, det = a * d - b * c;
  /* By Jury's criterion both eigenvalues are inside the unit circle. */
  if (!(fabs(det) < 1.0 && fabs(trace) < 1.0 + det)) return PENDRES_NOT_FOUND;

  /* (1 - K) (xx, xv, vv) = (q.xx, q.xv, q.vv), by Cramer's rule. */
  const double k[3][3] = {{1.0 - a * a, -2.0 * a * b, -b * b},
                          {-a * c, 1.0 - a * d - b * c, -b * d},
                          {-c * c, -2.0 * c * d, 1.0 - d * d}};
  const double right[3] = {q->xx, q->xv, q->vv};
  double minor[3][3], out[3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const int r = (i + 1) % 3, s = (i + 2) % 3, t = (j + 1) % 3, u = (j + 2) % 3;
      minor[i][j] = k[r][t] * k[s][u] - k[r][u] * k[s][t];
    }
  const double whole = k[0][0] * minor[0][0] + k[0][1] * minor[0][1] + k[0][2] * minor[0][2];
  for (int j = 0; j < 3; j++)
    out[j] = (right[0] * minor[0][j] + right[1] * minor[1][j] + right[2] * minor[2][j]) / whole;
  /* M is so close to the unit circle, or Q so large, that no digit of the solution is known. */
  if (!(isfinite(out[0]) && isfinite(out[1]) && isfinite(out[2]))) return PENDRES_NOT_FOUND;
  *sigma = (pendres_langevin_covariance){out[0], out[1], out[2]};
  return PENDRES_OK;
}

/* The theory with `steps` steps per period. */
static pendres_status theory(const pendres_pendulum *p, double x, double v, int cycle, int steps,
                             pendres_langevin_linear *out)
{
  double s[SIZE] = {[X] = x, [V] = v, [MXX] = 1.0, [MVV] = 1.0};
  integrate(p, cycle, steps, s);
  for (int i = 0; i < 4; i++) out->monodromy[i] = s[MXX + i];
  out->injected = (pendres_langevin_covariance){s[CXX], s[CXV], s[CVV]};
  out->closure = hypot(remainder(s[X] - x, pendres_model_turn(p)), s[V] - v);
  return pendres_langevin_lyapunov(out->monodromy, &out->injected, &out->covariance);
}

/* Where the determinant of M is not that of Liouville's formula, the steps are too long for the
 * force. */
static int is_resolved(const pendres_pendulum *p, int cycle, const pendres_langevin_linear *l)
{
  const double *m = l->monodromy, ad = m[0] * m[3], bc = m[1] * m[2];
  const double want = pendres_equation_left(
    pendres_equation_contraction(p) * cycle * two_pi / p->drive_frequency, ad - bc);
  return fabs(ad - bc - want) <= linear_resolved * (1.0 + fabs(ad) + fabs(bc));
}

/* The theory with enough steps, and with twice as many: the status is that of their clouds. */
static pendres_status resolve(const pendres_pendulum *p, double x, double v, int cycle,
                              pendres_langevin_linear *coarse, pendres_langevin_linear *out)
{
  const double fastest = fmax(1.0, pendres_pendulum_decay_rate(p));
  const double unit = two_pi / p->drive_frequency * fastest;
  const double fewest = fmin(PENDRES_MOST_STEPS, ceil(linear_steps * unit));
  double steps = fewest;
  if (!(cycle * steps <= PENDRES_MOST_SOLVER_STEPS)) return PENDRES_TOLERANCE_UNREACHABLE;
  pendres_status status = theory(p, x, v, cycle, (int)steps, coarse);
  while (!is_resolved(p, cycle, coarse)) {
    steps *= 2.0;
    if (!(cycle * steps <= PENDRES_MOST_SOLVER_STEPS && steps <= linear_most_doubling * fewest))
      return PENDRES_TOLERANCE_UNREACHABLE;
    status = theory(p, x, v, cycle, (int)steps, coarse);
  }
  const pendres_status finer = theory(p, x, v, cycle, (int)(2.0 * steps), out);
  return status != PENDRES_OK ? status : finer;
}

pendres_status pendres_noise_cycle(const pendres_pendulum *p, double x, double v, int cycle,
                                   pendres_langevin_linear *out)
{
  pendres_langevin_linear coarse;
  const pendres_status status = resolve(p, x, v, cycle, &coarse, out);
  return status == PENDRES_NOT_FOUND ? PENDRES_OK : status;
}

static pendres_status linear_theory(const pendres_pendulum *pendulum, double x, double v,
                                    int cycle, pendres_langevin_linear *out)
{
  pendres_langevin_linear coarse;
  if (out == NULL || pendres_pendulum_check(pendulum, NULL) != PENDRES_OK ||
      pendres_coordinates_refuses(pendulum, x, v) != NULL || cycle < 1 ||
      pendres_equation_drags(pendulum))
    return PENDRES_INVALID_ARGUMENT;
  const pendres_status status = resolve(pendulum, x, v, cycle, &coarse, out);
  if (status != PENDRES_OK) return status;
  const pendres_langevin_covariance *a = &coarse.covariance, *b = &out->covariance;
  /* By order four the error that is left is a fifteenth of the difference. */
  out->error =
    fmax(fabs(a->xx - b->xx), fmax(fabs(a->xv - b->xv), fabs(a->vv - b->vv))) / 15.0;
  return PENDRES_OK;
}

/* Without a context there is no door: the pendulum is brought into its units here. */
pendres_status pendres_langevin_linear_find(const pendres_pendulum *pendulum, double x,
                                            double v, int cycle, pendres_langevin_linear *out)
{
  const pendres_scales s = {pendres_units_of(pendulum), 1.0, 1.0};
  pendres_pendulum p = {.damping = 0.0};
  if (pendulum == NULL || out == NULL) return PENDRES_INVALID_ARGUMENT;
  p = *pendulum;
  pendres_units_in(&s, &pendres_dim_pendulum, 1, &p);
  const pendres_status status =
    linear_theory(&p, x / s.unit.length, v / pendres_units_factor(&s, 1, -1), cycle, out);
  if (status == PENDRES_OK) pendres_units_out(&s, &pendres_dim_linear, 1, out);
  return status;
}
