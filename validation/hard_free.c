/*
 * hard_free.c -- pendulums without a drive: at the unstable equilibrium, on the separatrix, and for
 * a million periods. All of it is known exactly.
 */
#include <math.h>
#include <stdio.h>

#include <pendres/free.h>
#include "oracle/reference.h"

#include "validation/exact.h"
#include "validation/hard_cases.h"

/* Half a unit in the last place of an angle between 2 and 4. */
static const double last_place = 2.220446049250313e-16;

static const double half_pi_low = 6.123233995736766e-17; /* what a double's pi / 2 lacks */

static double steps_a_period(const pendres_context *ctx)
{
  pendres_cost cost;
  pendres_context_cost(ctx, &cost);
  return cost.steps / cost.pendulum_periods;
}

/*
 * How far rounding moves a pendulum next to the top, as if it had been moved at the start. A step
 * of the length h rounds the angle once, by last_place at most (the increments are summed before
 * the angle is added), and the angles of its stages, which adds up to h times as much. An error at
 * the time t is one of exp(-rate t) times its size at the start; the sum over all steps is
 * geometric. The start itself is rounded once when turned into an angle, and lacks the digits of
 * pi / 2.
 */
static double moved_by_rounding(double rate, double h)
{
  return last_place * (1.0 + (1.0 + h) / -expm1(-rate * h)) + half_pi_low;
}

/* ---- equilibrium --------------------------------------------------------------------------- */

enum { FALLING = 4 /* periods in which a start on the top stays close to it */, FALLEN = 5 };

/* Of one start next to the top at x, followed over several periods. */
typedef struct fall {
  double rate;           /* at which distances from the top grow */
  double left;           /* largest distance from the top, */
  double off;            /* largest error, both as if they had been made at the start */
  double underestimated; /* largest ratio of the error to its estimate */
  double most_claimed;   /* a larger estimate is of no use, see hard_over_claim */
} fall;

/* (x, v) against where the pendulum went that started at x0, at rest. */
static pendres_status error_from_rest(const pendres_pendulum *p, double x0, long periods, double x,
                                      double v, double *error)
{
  long double y = (long double)x0 - half_pi_exact, w = 0.0L;
  long turns = 0;
  const pendres_status status = reference_advance(p, &y, &w, &turns, periods);
  const long double at = y + half_pi_exact * (1.0L + 4.0L * (long double)turns);
  *error = hard_larger((double)fabsl((long double)x - at), (double)fabsl((long double)v - w));
  return status;
}

static pendres_status watch(pendres_context *ctx, const pendres_pendulum *p, double x0, fall *f)
{
  pendres_status status = PENDRES_OK;
  /* The tops are at 3 pi / 2 and -pi / 2. */
  const long double top = x0 > 0.0 ? 3.0L * half_pi_exact : -half_pi_exact;
  f->rate = hypot(1.0, 0.5 * p->damping) - 0.5 * p->damping;
  for (long k = 1; k <= FALLING && status == PENDRES_OK; k++) {
    const double shrink = exp(-f->rate * 2.0 * pi / p->drive_frequency * (double)k);
    double x = x0, v = 0.0, estimate, error = 0.0;
    status = pendres_strobe_advance(ctx, 1, p, &x, &v, k, &estimate);
    if (status == PENDRES_OK) status = error_from_rest(p, x0, k, x, v, &error);
    f->left = hard_larger(f->left, (double)fabsl((long double)x - top) * shrink);
    f->off = hard_larger(f->off, error * shrink);
    f->underestimated =
      hard_larger(f->underestimated, hard_over_claim(error, estimate, f->most_claimed));
  }
  return status;
}

/* Starts on either top, x = -pi / 2 and 3 pi / 2 as doubles have them, all put into one. */
static pendres_status watch_tops(pendres_context *ctx, const pendres_pendulum *p, fall *f)
{
  const pendres_status status = watch(ctx, p, -0.5 * pi, f);
  return status == PENDRES_OK ? watch(ctx, p, 1.5 * pi, f) : status;
}

static pendres_status put_tops(hard_sheet *sheet, const char *name, double damping,
                               const hard_ways *way)
{
  const pendres_pendulum p = { .damping = damping, .drive_frequency = 1.0 };
  fall ours = { .most_claimed = INFINITY }, theirs = { .most_claimed = INFINITY };
  pendres_context_cost_reset(way->ours);
  pendres_status status = watch_tops(way->ours, &p, &ours);
  if (status != PENDRES_OK) return hard_failed(sheet, status, way->ours);
  const double bound = moved_by_rounding(ours.rate, 2.0 * pi / steps_a_period(way->ours));
  status = watch_tops(way->naive, &p, &theirs);
  if (status != PENDRES_OK) return hard_failed(sheet, status, way->naive);
  return hard_sheet_add(sheet, name,
                        "a start on the top: distance from it within 4 drive periods, as if moved "
                        "at the start",
                        ours.left, bound, theirs.left);
}

/* The time of a fall from d beside the top is log(8 / d) to within d^2: an error e of the start
   comes e / d too early or late, and speeds and accelerations are at most 2. */
static pendres_status put_fall(hard_sheet *sheet, double d, const hard_ways *way)
{
  const pendres_pendulum p = { .drive_frequency = 1.0 };
  const double x0 = 1.5 * pi - d;
  pendres_context *const each[] = { way->ours, way->naive };
  double error[2] = { NAN, NAN }, bound = NAN;
  /* Within the four periods of a fall an error of the start grows by up to 1 / d. */
  fall f[2] = { { .most_claimed = 0.1 }, { .most_claimed = INFINITY } };
  pendres_status status = PENDRES_OK;
  for (int i = 0; i < 2 && status == PENDRES_OK; i++) {
    double x = x0, v = 0.0;
    pendres_context_cost_reset(each[i]);
    status = watch(each[i], &p, x0, &f[i]);
    if (i == 0) bound = moved_by_rounding(f[i].rate, 2.0 * pi / steps_a_period(way->ours));
    if (status == PENDRES_OK) status = pendres_strobe_advance(each[i], 1, &p, &x, &v, FALLEN, NULL);
    if (status == PENDRES_OK) status = error_from_rest(&p, x0, FALLEN, x, v, &error[i]);
    if (status != PENDRES_OK) (void)hard_failed(sheet, status, each[i]);
  }
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("equilibrium", d).text,
                            "a start so far beside the top: error within 4 drive periods, as "
                            "if made at the start", f[0].off, bound, f[1].off);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "equilibrium_fall", "the same start: error where it has fallen "
                            "to the bottom", error[0], 2.0 * bound / d, error[1]);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "equilibrium_estimate", "the same start: error over its "
                            "estimate", f[0].underestimated, 10.0, f[1].underestimated);
  return status;
}

/* Newton's method on the top: its larger multiplier is exp(2 pi), to the tolerance of orbits. */
static pendres_status put_multiplier(hard_sheet *sheet, pendres_context *ctx, double tolerance)
{
  const pendres_orbit_guess guess = { .pendulum.drive_frequency = 1.0, .x = 1.5 * pi - 1e-3,
                                      .period = 1 };
  pendres_orbit orbit = { .stable = 1 };
  pendres_status outcome = PENDRES_OK;
  const pendres_status status =
    pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome);
  if (status != PENDRES_OK) return hard_failed(sheet, status, ctx);
  const double error = fabs(orbit.multiplier_re[0] / exp(2.0 * pi) - 1.0);
  const int found = outcome == PENDRES_OK && !orbit.stable;
  return hard_sheet_add(sheet, "equilibrium_multiplier",
                        "relative error of the multiplier of the top, found as an orbit",
                        found ? error : NAN, tolerance, NAN);
}

/*
 * equilibrium: starts on the unstable equilibrium and 1e-12 beside it, without a drive.
 *
 * Nothing can stay on top: pi / 2 is not a double, and what is left of it grows as exp(rate t),
 * rate being sqrt(1 + damping^2 / 4) - damping / 2, as every rounding does. So all errors are
 * divided by that growth; what remains is the error of a start that would have explained them.
 */
pendres_status hard_equilibrium(hard_sheet *sheet)
{
  const pendres_options options = { .tolerance = 1e-12 };
  hard_ways way;
  pendres_status status = hard_ways_open(sheet, &options, options.tolerance, &way);
  if (status == PENDRES_OK) status = put_tops(sheet, "equilibrium_undamped", 0.0, &way);
  if (status == PENDRES_OK) status = put_tops(sheet, "equilibrium_damped", 0.2, &way);
  if (status == PENDRES_OK) status = put_fall(sheet, 1e-12, &way);
  if (status == PENDRES_OK) status = put_multiplier(sheet, way.ours, options.tolerance);
  hard_ways_close(&way);
  return status;
}

/* ---- separatrix ---------------------------------------------------------------------------- */

static pendres_status free_frequency(hard_sheet *sheet, pendres_context *ctx, double amplitude,
                                     double *frequency, double *error)
{
  const pendres_status status =
    pendres_free_find(ctx, 1, &amplitude, frequency, error);
  return status == PENDRES_OK ? status : hard_failed(sheet, status, ctx);
}

/*
 * separatrix: the frequency at amplitudes pi - d against elliptic integrals.
 *
 * Near pi the quarter period is K = log(8 / d), so that an error e of the start changes it by e / d
 * and the frequency by e / (d K) of itself: that is the condition number. Rounding is that of the
 * equilibrium, with steps no shorter than if all steps of all iterations had been the last one's.
 * To this comes the tolerance, which is relative to the frequency, and as many units in the last
 * place as the elliptic integral is good to.
 */
pendres_status hard_separatrix(hard_sheet *sheet)
{
  const double tolerance = 1e-12;
  const pendres_options options = { .tolerance = tolerance };
  double worst = 0.0, worst_naive = 0.0;
  hard_ways way;
  pendres_status status = hard_ways_open(sheet, &options, tolerance, &way);
  for (int k = 3; k <= 12 && status == PENDRES_OK; k++) {
    const double a = pi - pow(10.0, -k), exact = pendres_free_frequency(a);
    const double d = (pi - a) + 2.0 * half_pi_low, quarter = 0.5 * pi / exact;
    double ours = NAN, error = NAN, theirs = NAN, their_error = NAN;
    pendres_cost cost;
    pendres_context_cost_reset(way.ours);
    status = free_frequency(sheet, way.ours, a, &ours, &error);
    if (status == PENDRES_OK) status = free_frequency(sheet, way.naive, a, &theirs, &their_error);
    if (status != PENDRES_OK) break;
    pendres_context_cost(way.ours, &cost);
    const double moved = moved_by_rounding(1.0, quarter / cost.steps);
    status = hard_sheet_add(sheet, hard_at("separatrix", pow(10.0, -k)).text,
                            "relative error of the frequency at amplitude pi less this",
                            fabs(ours / exact - 1.0),
                            tolerance + moved / (d * quarter) + 4.0 * last_place,
                            fabs(theirs / exact - 1.0));
    worst = hard_larger(worst, hard_over_claim(fabs(ours - exact), error, 1e-3 * exact));
    worst_naive =
      hard_larger(worst_naive, hard_over_claim(fabs(theirs - exact), their_error, INFINITY));
  }
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "separatrix_estimate", "error over its estimate, the worst of "
                            "these amplitudes", worst, 10.0, worst_naive);
  hard_ways_close(&way);
  return status;
}

/* ---- energy -------------------------------------------------------------------------------- */

enum { SWINGS = 8 };

static pendres_status drift(hard_sheet *sheet, pendres_context *ctx, const pendres_pendulum *p,
                            long periods, double *largest)
{
  static const double amplitude[SWINGS] = { 0.01, 0.1, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0 };
  double x[SWINGS], v[SWINGS], before[SWINGS];
  for (int i = 0; i < SWINGS; i++) {
    x[i] = 0.5 * pi + amplitude[i];
    v[i] = 0.0;
    before[i] = pendres_pendulum_energy(&p[i], x[i], v[i]);
  }
  const pendres_status status = pendres_strobe_advance(ctx, SWINGS, p, x, v, periods, NULL);
  if (status != PENDRES_OK) return hard_failed(sheet, status, ctx);
  *largest = 0.0;
  for (int i = 0; i < SWINGS; i++)
    *largest = hard_larger(*largest, fabs(pendres_pendulum_energy(&p[i], x[i], v[i]) - before[i]));
  return status;
}

/*
 * energy: eight amplitudes from 0.01 to 3 rad in a block, over a million periods of small swings.
 *
 * The tolerance asks that errors of x and v that a period adds, summed over all of them, be at most
 * this. An error of the state changes the energy by its gradient (-cos x, v), of length 2 at most,
 * times the error; that holds for each period by itself, however much a growing phase shift moves
 * the pendulum along its orbit, where the energy does not change.
 */
pendres_status hard_energy(hard_sheet *sheet)
{
  const long periods = (long)ceil(1e6 * sheet->scale);
  const pendres_options options = { .tolerance = 1e-5, .block_lanes = SWINGS };
  pendres_pendulum p[SWINGS];
  double ours = NAN, theirs = NAN;
  char quantity[sizeof sheet->row->quantity];
  hard_ways way;
  for (int i = 0; i < SWINGS; i++) p[i] = (pendres_pendulum){ .drive_frequency = 1.0 };
  /* Theirs is a tolerance of a step, not of the run. */
  pendres_status status = hard_ways_open(sheet, &options, 1e-8, &way);
  if (status == PENDRES_OK) status = drift(sheet, way.ours, p, periods, &ours);
  if (status == PENDRES_OK) status = drift(sheet, way.naive, p, (periods + 99) / 100, &theirs);
  (void)snprintf(quantity, sizeof quantity, "largest change of the energy, of eight amplitudes, "
                 "in %g periods (naive: in a hundredth of them)", (double)periods);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "energy", quantity, ours, 2.0 * options.tolerance, theirs);
  hard_ways_close(&way);
  return status;
}
