/*
 * orbit.c -- closed orbits, resonances, folds and cusps of the independent reference.
 *
 * An orbit is a fixed point z of the strobe map P taken `period` times, up to whole turns:
 * Newton's method with the exact derivative M - I. Along its branch
 * dz/domega = (I - M)^-1 dP/domega, and with the loop area A(z, omega) of one run
 * dA/domega = A_z dz/domega + A_omega; the resonance is its zero, found by secants.
 * Definitions of the measures: reference.h.
 */
#include "oracle/reference.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "oracle/taylor.h"

/* An orbit to be found. */
typedef struct reference_target {
  reference_model model;
  long double y, v;     /* guess, then solution */
  long period, winding;
  int mirror;           /* nonzero: one that is its own mirror image half a period later, */
  long double centre;   /* about this y */
} reference_target;

/* Solve a x = b by elimination with pivoting, in place (x in b); n <= 4. Nonzero: singular. */
static int solve_linear(int n, long double a[][4], long double b[])
{
  for (int i = 0; i < n; i++) {
    int pivot = i;
    for (int j = i + 1; j < n; j++)
      if (fabsl(a[j][i]) > fabsl(a[pivot][i])) pivot = j;
    if (!(fabsl(a[pivot][i]) > 0.0L)) return 1;
    for (int k = 0; k < n; k++) {
      const long double swap = a[i][k];
      a[i][k] = a[pivot][k];
      a[pivot][k] = swap;
    }
    const long double swap = b[i];
    b[i] = b[pivot];
    b[pivot] = swap;
    for (int j = i + 1; j < n; j++) {
      const long double factor = a[j][i] / a[i][i];
      for (int k = i; k < n; k++) a[j][k] -= factor * a[i][k];
      b[j] -= factor * b[i];
    }
  }
  for (int i = n - 1; i >= 0; i--) {
    for (int k = i + 1; k < n; k++) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  return 0;
}

/* M - I of a run. */
static void shifted_monodromy(const reference_run *run, long double a[][4])
{
  a[0][0] = run->u[0].hi - 1.0L + run->u[0].lo;
  a[0][1] = run->u[1].hi;
  a[1][0] = run->w[0].hi;
  a[1][1] = run->w[1].hi - 1.0L + run->w[1].lo;
}

static pendres_status mirror_defect(const reference_target *target,
                                    reference_run *run, long double defect[2])
{
  const reference_pair two_pi = reference_taylor_two_pi();
  const long double start_y = run->y.hi;
  const pendres_status status = reference_taylor_advance_half(run);
  if (status != PENDRES_OK) return status;
  const long double off =
    run->model.turns ? -rintl((start_y + run->y.hi) / two_pi.hi) : 0.0L;
  defect[0] = (run->y.hi + (start_y + off * two_pi.hi)) + run->y.lo + off * two_pi.lo -
              2.0L * target->centre;
  defect[1] = (run->v.hi + target->v) + run->v.lo;
  return PENDRES_OK;
}

/* The defect of an orbit: its end minus its start over the period or, for a mirror orbit (whose
   centre may be any well), end plus start over half a period. *run is the run with `columns`
   columns that gave it. */
static pendres_status defect_of(const reference_target *target, int columns,
                                reference_run *run, long double defect[2])
{
  const reference_pair two_pi = reference_taylor_two_pi();
  reference_taylor_init(run, &target->model, target->y, target->v);
  const long double start = run->y.hi; /* target->y, wrapped */
  run->columns = columns;
  if (target->mirror) return mirror_defect(target, run, defect);
  const pendres_status status = reference_taylor_advance(run, target->period);
  if (status != PENDRES_OK) return status;
  const long double off = (long double)run->turns - (long double)target->winding;
  defect[0] = (run->y.hi - start) + off * two_pi.hi;
  defect[0] += run->y.lo + off * two_pi.lo;
  defect[1] = (run->v.hi - target->v) + run->v.lo;
  return PENDRES_OK;
}

static long double norm(const long double d[2])
{
  return hypotl(d[0], d[1]);
}

/* One step from target along -(M - I)^-1 defect, halved until the defect shrinks. */
static pendres_status newton_step(reference_target *target, long double *moved)
{
  reference_run run;
  long double d[2], a[2][4];
  pendres_status status = defect_of(target, REFERENCE_BY_FREQUENCY, &run, d);
  if (status != PENDRES_OK) return status;
  const long double before = norm(d);
  shifted_monodromy(&run, a);
  if (solve_linear(2, a, d)) return PENDRES_NOT_CONVERGED;
  if (!isfinite(norm(d))) return PENDRES_NOT_CONVERGED;
  const reference_target from = *target;
  /* A radian is too far for a linear map to be of use. */
  long double part = fminl(1.0L, 0.5L / norm(d));
  for (int i = 0; i < 8; i++, part *= 0.5L) {
    long double after[2];
    target->y = from.y - part * d[0];
    target->v = from.v - part * d[1];
    *moved = part * norm(d);
    /* Below this only rounding is left to shrink. */
    if (*moved < 1e-9L) return PENDRES_OK;
    status = defect_of(target, 0, &run, after);
    if (status == PENDRES_OK && norm(after) < before) return PENDRES_OK;
  }
  return PENDRES_NOT_CONVERGED;
}

/* Newton's method on the defect, which changes target->y and v. */
static pendres_status close_orbit(reference_target *target)
{
  enum { MOST = 100 };
  long double last = HUGE_VALL;
  for (int i = 0; i < MOST; i++) {
    long double moved = 0.0L;
    const pendres_status status = newton_step(target, &moved);
    if (status != PENDRES_OK) return status;
    /* Quadratic convergence has reached the noise when steps stop shrinking. */
    if (moved < 1e-9L && moved >= 0.25L * last) break;
    if (moved == 0.0L) break;
    last = moved;
    if (i == MOST - 1) return PENDRES_NOT_CONVERGED;
  }
  const long double two_pi = reference_taylor_two_pi().hi;
  if (target->model.turns && fabsl(target->y) > two_pi / 2.0L)
    target->y -= two_pi * rintl(target->y / two_pi);
  return PENDRES_OK;
}

static void fill_multipliers(reference_cycle *out)
{
  const long double half = 0.5L * (out->monodromy[0][0] + out->monodromy[1][1]);
  const long double two_pi = reference_taylor_two_pi().hi;
  /* Liouville's determinant is exact, the matrix' own cancels. */
  const long double determinant =
      expl(-out->damping * two_pi * (long double)out->period / out->drive_frequency);
  const long double discriminant = half * half - determinant;
  out->liouville_residual =
      fabsl((out->monodromy[0][0] * out->monodromy[1][1] -
             out->monodromy[0][1] * out->monodromy[1][0]) / determinant - 1.0L);
  memset(out->multiplier_im, 0, sizeof out->multiplier_im);
  if (discriminant < 0.0L) {
    out->multiplier_re[0] = out->multiplier_re[1] = half;
    out->multiplier_im[0] = sqrtl(-discriminant);
    out->multiplier_im[1] = -out->multiplier_im[0];
  } else {
    out->multiplier_re[0] = half + copysignl(sqrtl(discriminant), half);
    out->multiplier_re[1] = determinant / out->multiplier_re[0];
  }
}

static void fill_slopes(const reference_run *run, reference_cycle *out)
{
  const int by = REFERENCE_BY_FREQUENCY;
  long double a[2][4], slope[2] = { -run->u[by].hi, -run->w[by].hi };
  shifted_monodromy(run, a);
  if (solve_linear(2, a, slope)) slope[0] = slope[1] = NAN;
  out->state_slope[0] = slope[0];
  out->state_slope[1] = slope[1];
  out->loop_area_slope = (run->area_by[REFERENCE_BY_Y].hi * slope[0] +
                          run->area_by[REFERENCE_BY_V].hi * slope[1] +
                          run->area_by[by].hi) / (long double)out->period;
}

static void fill_measures(const reference_run *run, reference_cycle *out)
{
  const long double pi = reference_taylor_two_pi().hi / 2.0L;
  const long double cycles = (long double)out->period, omega = out->drive_frequency;
  const long double a = omega * run->cosine.hi / (pi * cycles);
  const long double b = omega * run->sine.hi / (pi * cycles);
  out->loop_area = run->area.hi / cycles;
  out->dissipation = out->damping * run->square.hi / cycles;
  const long double others =
    run->parametric.hi / cycles +
    run->model.torque * 2.0L * pi * (long double)out->winding / cycles;
  out->energy_residual = fabsl(out->loop_area + others - out->dissipation);
  out->amplitude = 0.5L * (run->highest - run->lowest);
  out->first_harmonic_amplitude = hypotl(a, b);
  /* The lag is behind the force; if F0 is negative it is that of minus the angle. */
  const long double sign = out->drive_amplitude < 0.0L ? -1.0L : 1.0L;
  out->phase_lag =
    out->first_harmonic_amplitude > 0.0L ? atan2l(sign * b, sign * a) : (long double)NAN;
  out->mean_power = out->loop_area * omega / (2.0L * pi);
}

/* Measures of the orbit at the target, which must be closed already. */
static pendres_status measure_orbit(const reference_target *target,
                                    reference_cycle *out)
{
  const reference_pair two_pi = reference_taylor_two_pi();
  reference_cycle cycle = { .damping = target->model.damping,
                                    .drive_amplitude = target->model.drive_amplitude,
                                    .drive_frequency = target->model.drive_frequency,
                                    .y = target->y, .v = target->v,
                                    .period = target->period, .winding = target->winding };
  reference_run run;
  reference_taylor_init(&run, &target->model, target->y, target->v);
  cycle.y = run.y.hi;
  run.columns = REFERENCE_BY_FREQUENCY + 1;
  run.measures = 1;
  run.drift = (long double)target->winding / (long double)target->period;
  const pendres_status status = reference_taylor_advance(&run, target->period);
  if (status != PENDRES_OK) return status;
  const long double off = (long double)(run.turns - target->winding);
  const long double dy = (run.y.hi - cycle.y) + off * two_pi.hi + run.y.lo + off * two_pi.lo;
  cycle.closure = fmaxl(fabsl(dy), fabsl((run.v.hi - cycle.v) + run.v.lo));
  for (int i = 0; i < 2; i++) {
    cycle.monodromy[0][i] = run.u[i].hi;
    cycle.monodromy[1][i] = run.w[i].hi;
  }
  fill_multipliers(&cycle);
  fill_measures(&run, &cycle);
  fill_slopes(&run, &cycle);
  *out = cycle;
  return PENDRES_OK;
}

static pendres_status close_and_measure(reference_target *target,
                                        reference_cycle *out)
{
  const pendres_status status = close_orbit(target);
  return status == PENDRES_OK ? measure_orbit(target, out) : status;
}

pendres_status reference_orbit(const pendres_pendulum *p, long double y, long double v,
                                       long period, long winding, reference_cycle *out)
{
  reference_target target = {.y = y, .v = v, .period = period, .winding = winding};
  if (out == NULL || reference_model_of(p, &target.model) != PENDRES_OK || period < 1 ||
      (winding != 0 && !target.model.turns) || !(fabsl(y) <= 1e9L) || !isfinite(v))
    return PENDRES_INVALID_ARGUMENT;
  return close_and_measure(&target, out);
}

/* The orbit at another drive frequency, from `here` along the branch's tangent and then by
   Newton. */
static pendres_status move_to(const reference_model *model,
                              const reference_cycle *here, long double frequency,
                              reference_cycle *out)
{
  const long double change = frequency - here->drive_frequency;
  reference_target target = {
    *model, here->y + change * here->state_slope[0], here->v + change * here->state_slope[1],
    here->period, here->winding, 0, 0.0L };
  target.model.drive_frequency = frequency;
  return close_and_measure(&target, out);
}

/* Where the slope of the loop area vanishes, by two points' secant; uphill where the area
   is not concave, and never farther than the branch is straight. */
static long double next_change(const reference_cycle *here, long double curvature)
{
  const long double most = 0.02L;
  if (!(curvature < 0.0L)) return copysignl(most, here->loop_area_slope);
  return fminl(most, fmaxl(-most, -here->loop_area_slope / curvature));
}

/* The maximum of the loop area along the branch that the target's orbit is on. */
static pendres_status find_resonance(reference_target *target,
                                     reference_cycle *out)
{
  enum { MOST = 200 };
  reference_cycle here, next;
  pendres_status status = close_and_measure(target, &here);
  if (status != PENDRES_OK) return status;
  long double change = copysignl(1e-3L, here.loop_area_slope), last = HUGE_VALL;
  for (int i = 0; i < MOST; i++) {
    status = move_to(&target->model, &here, here.drive_frequency + change, &next);
    if (status != PENDRES_OK) {
      /* Past the end of the branch, or too far for Newton. */
      change *= 0.25L;
      if (fabsl(change) < 1e-12L) return status;
      continue;
    }
    const long double moved = next.drive_frequency - here.drive_frequency;
    const long double curvature = (next.loop_area_slope - here.loop_area_slope) / moved;
    here = next;
    change = next_change(&here, curvature);
    /* Secants converge until their difference is noise. */
    if (change == 0.0L || moved == 0.0L || (fabsl(moved) < 1e-9L && fabsl(moved) >= 0.5L * last)) {
      *out = here;
      return PENDRES_OK;
    }
    last = fabsl(moved);
  }
  return PENDRES_NOT_CONVERGED;
}

/*
 * ---- folds and cusps ----
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

/* The unknowns in their order; a fold has the first three. */
enum { BY_Y, BY_V, BY_FREQUENCY, BY_DAMPING };

static long double *unknown(reference_target *target, int i)
{
  switch (i) {
  case BY_Y: return &target->y;
  case BY_V: return &target->v;
  case BY_FREQUENCY: return &target->model.drive_frequency;
  default: return &target->model.damping;
  }
}

/* g of a finished run. */
static long double run_determinant(const reference_target *target,
                                   const reference_run *run)
{
  const long double phase = reference_taylor_two_pi().hi * (target->mirror ? 0.5L : 1.0L);
  const long double time = phase / target->model.drive_frequency;
  return (1.0L - run->u[0].hi) - run->w[1].hi + expl(-target->model.damping * time);
}

static pendres_status determinant(const reference_target *target, long double *g)
{
  reference_run run;
  long double defect[2];
  const pendres_status status = defect_of(target, REFERENCE_BY_FREQUENCY, &run, defect);
  if (status == PENDRES_OK) *g = run_determinant(target, &run);
  return status;
}

/* k: sixth-order central difference of g along the null vector of M - I. */
static pendres_status determinant_slope(const reference_target *target, long double *k)
{
  /* Truncation step^6 and rounding epsilon/step are both below 1e-15 here. */
  static const long double step = 2e-3L, weight[3] = { 45.0L, -9.0L, 1.0L };
  reference_run run;
  long double defect[2];
  pendres_status status = defect_of(target, REFERENCE_BY_FREQUENCY, &run, defect);
  if (status != PENDRES_OK) return status;
  const long double along[2] = { -run.u[1].hi, run.u[0].hi - 1.0L };
  const long double length = hypotl(along[0], along[1]);
  long double sum = 0.0L;
  for (int i = 1; i <= 3; i++) {
    for (int sign = -1; sign <= 1; sign += 2) {
      reference_target beside = *target;
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

typedef pendres_status scalar(const reference_target *target, long double *value);

/* Gradient of f over the first n unknowns. */
static pendres_status gradient(scalar *f, const reference_target *target, int n,
                               long double row[])
{
  const long double step = 1e-5L;
  for (int i = 0; i < n; i++) {
    reference_target less = *target, more = *target;
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
static pendres_status correction(const reference_target *target, int n,
                                 long double change[4])
{
  reference_run run;
  long double a[4][4];
  pendres_status status = defect_of(target, REFERENCE_COLUMNS, &run, change);
  if (status != PENDRES_OK) return status;
  const long double start = target->mirror ? 1.0L : -1.0L; /* its sign in the defect */
  change[2] = run_determinant(target, &run);
  for (int i = 0; i < n; i++) {
    const reference_pair *u = run.u, *w = run.w;
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
  return solve_linear(n, a, change) ? PENDRES_NOT_CONVERGED : PENDRES_OK;
}

static pendres_status solve(reference_target *target, int n, reference_cycle *out)
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
      status = measure_orbit(target, out);
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
                     long double y, long double v, reference_target *out)
{
  if (p == NULL || !(fabsl(y) <= 1e9L) || !isfinite(v)) return 0;
  pendres_pendulum checked = *p;
  checked.drive_frequency = (double)frequency;
  checked.damping = (double)damping;
  *out = (reference_target){.y = y, .v = v, .period = 1};
  if (reference_model_of(&checked, &out->model) != PENDRES_OK) return 0;
  out->model.drive_frequency = frequency;
  out->model.damping = damping;
  return 1;
}

pendres_status reference_find(reference_kind kind, const pendres_pendulum *p,
                                      const reference_guess *guess,
                                      reference_cycle *out)
{
  reference_target target;
  if (p == NULL || guess == NULL || out == NULL || (unsigned)kind >= REFERENCE_KINDS)
    return PENDRES_INVALID_ARGUMENT;
  const int cusp = kind == REFERENCE_CUSP;
  const long double damping = cusp ? guess->damping : (long double)p->damping;
  if (!target_of(p, guess->frequency, damping, guess->y, guess->v, &target))
    return PENDRES_INVALID_ARGUMENT;
  if (kind == REFERENCE_RESONANCE) return find_resonance(&target, out);
  if (kind == REFERENCE_SYMMETRY_BREAKING) {
    if (!pendres_pendulum_symmetric(p)) return PENDRES_INVALID_ARGUMENT;
    target.mirror = 1;
    target.centre =
      pendres_model_of(p->force)->centre(p->force_coefficients, p->torque, (double)guess->y);
  }
  return solve(&target, cusp ? 4 : 3, out);
}
