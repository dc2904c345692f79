/*
 * fold.c -- folds and cusps of the independent reference.
 *
 * A fold is a zero of (P(z) - z, g) over (z, omega) with g = det(M - I), which is
 * 1 - trace M + exp(-damping 2 pi/omega). A cusp is a zero of (P(z) - z, g, k) over
 * (z, omega, damping), where k is the derivative of g along the null vector of M - I: there the
 * fold's quadratic term vanishes. An orbit that is its own mirror image is a fixed point of -Q,
 * where Q is half a period; there M = (DQ)^2 and the symmetry breaks where det(DQ - I) = 0. All are
 * solved by Newton's method; the rows of P are exact, those of g and k come from central
 * differences, whose small error only slows down the last steps.
 *
 * Source: Kuznetsov, Elements of Applied Bifurcation Theory, sections 4.1, 9.2 and 10.
 */
#include <math.h>
#include <stddef.h>

#include "reference/orbit.h"

/* The unknowns in their order; a fold has the first three. */
enum { BY_Y, BY_V, BY_FREQUENCY, BY_DAMPING };

static long double *unknown(pendres_reference_target *target, int i)
{
  switch (i) {
  case BY_Y: return &target->y;
  case BY_V: return &target->v;
  case BY_FREQUENCY: return &target->model.drive_frequency;
  default: return &target->model.damping;
  }
}

/* g of a finished run. */
static long double run_determinant(const pendres_reference_target *target,
                                   const pendres_reference_run *run)
{
  const long double phase = pendres_reference_taylor_two_pi().hi * (target->mirror ? 0.5L : 1.0L);
  const long double time = phase / target->model.drive_frequency;
  return (1.0L - run->u[0].hi) - run->w[1].hi + expl(-target->model.damping * time);
}

static pendres_status determinant(const pendres_reference_target *target, long double *g)
{
  pendres_reference_run run;
  long double defect[2];
  const pendres_status status =
      pendres_reference_orbit_defect(target, PENDRES_REFERENCE_BY_FREQUENCY, &run, defect);
  if (status == PENDRES_OK) *g = run_determinant(target, &run);
  return status;
}

/* k: sixth-order central difference of g along the null vector of M - I. */
static pendres_status determinant_slope(const pendres_reference_target *target, long double *k)
{
  /* Truncation step^6 and rounding epsilon/step are both below 1e-15 here. */
  static const long double step = 2e-3L, weight[3] = { 45.0L, -9.0L, 1.0L };
  pendres_reference_run run;
  long double defect[2];
  pendres_status status =
      pendres_reference_orbit_defect(target, PENDRES_REFERENCE_BY_FREQUENCY, &run, defect);
  if (status != PENDRES_OK) return status;
  const long double along[2] = { -run.u[1].hi, run.u[0].hi - 1.0L };
  const long double length = hypotl(along[0], along[1]);
  long double sum = 0.0L;
  for (int i = 1; i <= 3; i++) {
    for (int sign = -1; sign <= 1; sign += 2) {
      pendres_reference_target beside = *target;
      const long double far = (long double)(sign * i) * step / length;
      long double g = 0.0L;
      beside.y += far * along[0];
      beside.v += far * along[1];
      status = determinant(&beside, &g);
      if (status != PENDRES_OK) return status;
      sum += (long double)sign * weight[i - 1] * g;
    }
  }
  *k = sum / (60.0L * step);
  return PENDRES_OK;
}

typedef pendres_status scalar(const pendres_reference_target *target, long double *value);

/* Gradient of f over the first n unknowns. */
static pendres_status gradient(scalar *f, const pendres_reference_target *target, int n,
                               long double row[])
{
  const long double step = 1e-5L;
  for (int i = 0; i < n; i++) {
    pendres_reference_target less = *target, more = *target;
    long double low = 0.0L, high = 0.0L;
    *unknown(&less, i) -= step;
    *unknown(&more, i) += step;
    pendres_status status = f(&less, &low);
    if (status == PENDRES_OK) status = f(&more, &high);
    if (status != PENDRES_OK) return status;
    row[i] = (high - low) / (2.0L * step);
  }
  return PENDRES_OK;
}

/* Newton's correction over n = 3 (fold) or 4 (cusp) unknowns, into change. */
static pendres_status correction(const pendres_reference_target *target, int n,
                                 long double change[4])
{
  pendres_reference_run run;
  long double a[4][4];
  pendres_status status =
      pendres_reference_orbit_defect(target, PENDRES_REFERENCE_COLUMNS, &run, change);
  if (status != PENDRES_OK) return status;
  const long double start = target->mirror ? 1.0L : -1.0L; /* its sign in the defect */
  change[2] = run_determinant(target, &run);
  for (int i = 0; i < n; i++) {
    const pendres_reference_pair *u = run.u, *w = run.w;
    a[0][i] = u[i].hi + (i == BY_Y ? start : 0.0L);
    a[1][i] = w[i].hi + (i == BY_V ? start : 0.0L);
  }
  status = gradient(determinant, target, n, a[2]);
  if (status != PENDRES_OK) return status;
  if (n == 4) {
    status = determinant_slope(target, &change[3]);
    if (status == PENDRES_OK) status = gradient(determinant_slope, target, n, a[3]);
    if (status != PENDRES_OK) return status;
  }
  return pendres_reference_orbit_solve(n, a, change) ? PENDRES_NOT_CONVERGED : PENDRES_OK;
}

static pendres_status solve(pendres_reference_target *target, int n, pendres_reference_cycle *out)
{
  enum { MOST = 60 };
  long double last = HUGE_VALL;
  for (int i = 0; i < MOST; i++) {
    long double change[4] = { 0.0L, 0.0L, 0.0L, 0.0L }, moved = 0.0L;
    pendres_status status = correction(target, n, change);
    if (status != PENDRES_OK) return status;
    for (int j = 0; j < n; j++) moved = hypotl(moved, change[j]);
    if (!isfinite(moved)) return PENDRES_NOT_CONVERGED;
    /* Folds are near each other: a long step would change branch. */
    const long double part = fminl(1.0L, 0.05L / moved);
    for (int j = 0; j < n; j++) *unknown(target, j) -= part * change[j];
    if (!(target->model.drive_frequency > 0.0L) || !(target->model.damping >= 0.0L))
      return PENDRES_NOT_CONVERGED;
    if (moved == 0.0L || (moved < 1e-10L && moved >= 0.25L * last)) {
      status = pendres_reference_orbit_measure(target, out);
      if (status != PENDRES_OK) return status;
      out->loop_area_slope = out->state_slope[0] = out->state_slope[1] = (long double)NAN;
      return PENDRES_OK;
    }
    last = moved;
  }
  return PENDRES_NOT_CONVERGED;
}

/* The target of an orbit of period one near a guess; 0 if a parameter is not valid. */
static int target_of(const pendres_pendulum *p, long double frequency, long double damping,
                     long double y, long double v, pendres_reference_target *out)
{
  if (p == NULL || !(fabsl(y) <= 1e9L) || !isfinite(v)) return 0;
  pendres_pendulum checked = *p;
  checked.drive_frequency = (double)frequency;
  checked.damping = (double)damping;
  *out = (pendres_reference_target){.y = y, .v = v, .period = 1};
  if (pendres_reference_model_of(&checked, &out->model) != PENDRES_OK) return 0;
  out->model.drive_frequency = frequency;
  out->model.damping = damping;
  return 1;
}

pendres_status pendres_reference_find(pendres_reference_kind kind, const pendres_pendulum *p,
                                      const pendres_reference_guess *guess,
                                      pendres_reference_cycle *out)
{
  pendres_reference_target target;
  if (p == NULL || guess == NULL || out == NULL || (unsigned)kind >= PENDRES_REFERENCE_KINDS)
    return PENDRES_INVALID_ARGUMENT;
  const int cusp = kind == PENDRES_REFERENCE_CUSP;
  const long double damping = cusp ? guess->damping : (long double)p->damping;
  if (!target_of(p, guess->frequency, damping, guess->y, guess->v, &target))
    return PENDRES_INVALID_ARGUMENT;
  if (kind == PENDRES_REFERENCE_RESONANCE) return pendres_reference_orbit_resonance(&target, out);
  if (kind == PENDRES_REFERENCE_SYMMETRY_BREAKING) {
    if (!pendres_pendulum_symmetric(p)) return PENDRES_INVALID_ARGUMENT;
    target.mirror = 1;
    target.centre =
      pendres_model_of(p->force)->centre(p->force_coefficients, p->torque, (double)guess->y);
  }
  return solve(&target, cusp ? 4 : 3, out);
}
