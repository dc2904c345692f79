/*
 * hard_limits.c -- the ends of what a double can hold: tolerances next to its last digit, drives
 * and starts from nothing to a thousand.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "oracle/reference.h"

#include "validation/exact.h"
#include "validation/hard_cases.h"

/* ---- tolerance ----------------------------------------------------------------------------- */

static const double tightest = 1e-13;

enum { STARTS = 16, PERIODS = 10, DAMPINGS = 8, FREQUENCIES = 5, SETTLED = 12 };

/* Tolerances that no double can meet, and which are taken all the same, or refused without the
   words that help. */
static pendres_status put_refused(hard_sheet *sheet)
{
  double wrong = 0.0;
  for (int k = 14; k <= 18; k++) {
    const pendres_pendulum p = { .damping = 0.1, .drive_amplitude = 0.2, .drive_frequency = 0.8 };
    const pendres_options options = { .tolerance = pow(10.0, -k) };
    pendres_context *ctx = NULL;
    double x = 0.0, v = 0.0;
    pendres_status status = pendres_context_create(&options, &ctx);
    if (status != PENDRES_OK) return status;
    status = pendres_strobe_advance(ctx, 1, &p, &x, &v, 1, NULL);
    wrong += status != PENDRES_INVALID_ARGUMENT ||
             strstr(pendres_context_message(ctx), "1e-13") == NULL;
    pendres_context_free(ctx);
  }
  return hard_sheet_add(sheet, "tolerance_refused",
                        "tolerances of 1e-14 to 1e-18 not refused by naming the least one",
                        wrong, 0.0, NAN);
}

typedef struct crowd {
  pendres_pendulum p[STARTS];
  double x[STARTS], v[STARTS], estimate[STARTS], error[STARTS];
} crowd;

/* Pendulums of Fig. 7 started from all over the well: where they go, and how far off that is. */
static pendres_status follow(hard_sheet *sheet, pendres_context *ctx, int estimated, crowd *c)
{
  double x0[STARTS];
  for (int i = 0; i < STARTS; i++) {
    c->p[i] = (pendres_pendulum){ .damping = 0.12, .drive_amplitude = 0.2,
                                  .drive_frequency = 0.25 * pi };
    c->x[i] = x0[i] = -0.5 * pi + 2.0 * pi * (i + 1.0) / (STARTS + 1.0);
    c->v[i] = 0.0;
  }
  pendres_status status = pendres_strobe_advance(ctx, STARTS, c->p, c->x, c->v, PERIODS,
                                                 estimated ? c->estimate : NULL);
  if (status != PENDRES_OK) return hard_failed(sheet, status, ctx);
  for (int i = 0; i < STARTS && status == PENDRES_OK; i++) {
    long double y = (long double)x0[i] - half_pi_exact, v = 0.0L;
    long turns = 0;
    status = reference_advance(&c->p[i], &y, &v, &turns, PERIODS);
    y += half_pi_exact * (1.0L + 4.0L * (long double)turns);
    c->error[i] = hard_larger((double)fabsl((long double)c->x[i] - y),
                              (double)fabsl((long double)c->v[i] - v));
  }
  return status == PENDRES_OK ? status : hard_failed(sheet, status, NULL);
}

/* Errors claimed at tolerances of 1e-13, and relative ones at any: more would not be an answer. */
static const double most_claimed = 1e-6;

static pendres_status put_advanced(hard_sheet *sheet, const hard_ways *way)
{
  crowd ours, theirs;
  double silent = 0.0, worst = 0.0, missed = 0.0;
  pendres_status status = follow(sheet, way->ours, 1, &ours);
  if (status == PENDRES_OK) status = follow(sheet, way->naive, 0, &theirs);
  for (int i = 0; i < STARTS && status == PENDRES_OK; i++) {
    silent += !(ours.error[i] <= tightest) && !(ours.estimate[i] > tightest);
    worst = hard_larger(worst, hard_over_claim(ours.error[i], ours.estimate[i], most_claimed));
    missed += !(theirs.error[i] <= tightest);
  }
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "tolerance_missed", "of 16 pendulums at tolerance 1e-13, those "
                            "off by more without a word", silent, 0.0, missed);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "tolerance_estimate", "the same pendulums: error over its "
                            "estimate, the worst", worst, 10.0, NAN);
  return status;
}

/* Largest difference of a Poincaré point from the reference's orbit next to it. */
static double point_error(const reference_cycle *c, double x, double v)
{
  return hard_larger((double)fabsl((long double)x - half_pi_exact - c->y),
                     (double)fabsl(v - c->v));
}

/* An orbit that claims to meet the tolerance against the reference; 0 if it makes no claim. */
static pendres_status orbit_error(pendres_context *ctx, const pendres_orbit_guess *guess,
                                  double *error, reference_cycle *cycle)
{
  pendres_orbit o;
  pendres_status outcome = PENDRES_OK;
  *error = 0.0;
  pendres_status status = pendres_orbit_find(ctx, 1, guess, PENDRES_ORBIT_PLAIN, &o, &outcome);
  if (status == PENDRES_OK && outcome == PENDRES_NOT_CONVERGED) status = outcome; /* there is one */
  if (status != PENDRES_OK) return status;
  status = reference_orbit(&o.pendulum, (long double)o.x - half_pi_exact, o.v, 1, 0, cycle);
  if (status != PENDRES_OK || outcome != PENDRES_OK) return status;
  *error = hard_larger(point_error(cycle, o.x, o.v),
                       hard_larger((double)fabsl(o.loop_area - cycle->loop_area),
                                   (double)fabsl(o.amplitude - cycle->amplitude)));
  return status;
}

/* Damping from next to none to strong, at frequencies about the resonance. Where it is 1 all that
   is not the orbit is gone after 12 periods (exp(-34)): there the naive way gets to it too. */
static pendres_status put_orbits(hard_sheet *sheet, const hard_ways *way)
{
  static const double damping[DAMPINGS] = { 0.001, 0.01, 0.05, 0.12, 0.24, 0.5, 1.0, 5.0 };
  static const double frequency[FREQUENCIES] = { 0.5, 0.7, 0.8, 0.9, 1.1 };
  double ours = 0.0, theirs = 0.0;
  pendres_status status = PENDRES_OK;
  for (int i = 0; i < DAMPINGS * FREQUENCIES && status == PENDRES_OK; i++) {
    pendres_orbit_guess g = { .pendulum = { .damping = damping[i / FREQUENCIES],
                                            .drive_amplitude = 0.2,
                                            .drive_frequency = frequency[i % FREQUENCIES] },
                              .period = 1 };
    pendres_harmonic h;
    reference_cycle cycle;
    double error = 0.0;
    status = pendres_harmonic_find(&g.pendulum, &h);
    if (status != PENDRES_OK) return hard_failed(sheet, status, NULL);
    h.amplitude = fmin(h.amplitude, 1.0);
    g.x = 0.5 * pi + h.amplitude * cos(h.phase_lag);
    g.v = g.pendulum.drive_frequency * h.amplitude * sin(h.phase_lag);
    status = orbit_error(way->ours, &g, &error, &cycle);
    if (status != PENDRES_OK) return hard_failed(sheet, status, way->ours);
    ours = hard_larger(ours, error);
    if (g.pendulum.damping != 1.0) continue;
    double x = g.x, v = g.v;
    status = pendres_strobe_advance(way->naive, 1, &g.pendulum, &x, &v, SETTLED, NULL);
    if (status != PENDRES_OK) return hard_failed(sheet, status, way->naive);
    theirs = hard_larger(theirs, point_error(&cycle, x, v));
  }
  return hard_sheet_add(sheet, "tolerance_orbits", "largest error of orbits said to be good to "
                        "1e-13 (naive: where damping is 1, by waiting)", ours, tightest, theirs);
}

/*
 * tolerance: 1e-13 is the least that can be asked for. What asks for less is refused; what cannot
 * be met (trajectories amplify rounding) has an estimate that says so, good to a factor of ten as
 * all estimates; what is said to be met is met.
 */
pendres_status hard_tolerance(hard_sheet *sheet)
{
  const pendres_options options = { .tolerance = tightest };
  hard_ways way;
  pendres_status status = hard_ways_open(sheet, &options, tightest, &way);
  if (status == PENDRES_OK) status = put_refused(sheet);
  if (status == PENDRES_OK) status = put_advanced(sheet, &way);
  if (status == PENDRES_OK) status = put_orbits(sheet, &way);
  hard_ways_close(&way);
  return status;
}

/* ---- drive --------------------------------------------------------------------------------- */

static const double drive_damping = 0.3, drive_frequency = 0.9, drive_tolerance = 1e-10;

static pendres_pendulum driven_by(double drive_amplitude)
{
  return (pendres_pendulum){ .damping = drive_damping, .drive_frequency = drive_frequency,
                             .drive_amplitude = drive_amplitude };
}

/* Drive periods in which a free oscillation falls below a double's last digit. */
static long until_gone(void)
{
  return (long)ceil(-log(DBL_EPSILON) / (0.5 * drive_damping) * drive_frequency / (2.0 * pi));
}

typedef struct reached {
  pendres_orbit orbit;
  double x, v; /* by the naive way, where nothing is left of the start */
} reached;

/* The orbit by Newton's method from (x, v), and where the naive way gets to from there. */
static pendres_status both_ways(hard_sheet *sheet, const hard_ways *way, double drive_amplitude,
                                double x, double v, reached *out)
{
  const pendres_pendulum p = driven_by(drive_amplitude);
  pendres_status status = hard_orbit(sheet, way->ours, &p, x, v, &out->orbit);
  if (status != PENDRES_OK) return status;
  out->x = x;
  out->v = v;
  status = pendres_strobe_advance(way->naive, 1, &p, &out->x, &out->v, until_gone(), NULL);
  return status == PENDRES_OK ? status : hard_failed(sheet, status, way->naive);
}

/* Without a drive the orbit is rest. The last step of Newton's method is below 1e-7 and rounded to
   DBL_EPSILON of itself; there is nothing that could have a phase lag. */
static pendres_status put_no_drive(hard_sheet *sheet, const hard_ways *way)
{
  reached r;
  const pendres_status status = both_ways(sheet, way, 0.0, 0.5 * pi + 0.3, 0.0, &r);
  if (status != PENDRES_OK) return status;
  const pendres_orbit o = r.orbit;
  const double off = hard_larger(o.amplitude, hard_larger(fabs(o.x - 0.5 * pi), fabs(o.v)));
  return hard_sheet_add(sheet, "drive_0", "no drive: how far the orbit is from rest, if it has no "
                        "phase lag", isnan(o.phase_lag) ? off : INFINITY, 1e-7 * DBL_EPSILON,
                        hard_larger(fabs(r.x - 0.5 * pi), fabs(r.v)));
}

/*
 * Small drives: linear response, relative to its own size. The map's error is that of pendulums of
 * order one, ten times the tolerance at the start of the search for steps, and the orbit feels it
 * enlarged by 1 / (1 - |multiplier|). Denormal numbers add a last place of theirs each step.
 */
static pendres_status put_small_drive(hard_sheet *sheet, const hard_ways *way,
                                      double drive_amplitude)
{
  const pendres_pendulum p = driven_by(drive_amplitude);
  pendres_harmonic h;
  reached r;
  pendres_status status = pendres_harmonic_find(&p, &h);
  if (status != PENDRES_OK) return hard_failed(sheet, status, NULL);
  status = both_ways(sheet, way, drive_amplitude, 0.5 * pi + 0.3, 0.0, &r);
  if (status != PENDRES_OK) return status;
  const pendres_orbit o = r.orbit;
  const double resolvent = 1.0 / -expm1(-pi * drive_damping / drive_frequency);
  const double wanted_v = drive_frequency * h.amplitude * sin(h.phase_lag);
  return hard_sheet_add(sheet, hard_at("drive", drive_amplitude).text,
                        "a drive so small: error of amplitude (relative) and phase lag",
                        hard_larger(fabs(o.amplitude / h.amplitude - 1.0),
                        fabs(o.phase_lag - h.phase_lag)), resolvent * (10.0 * drive_tolerance +
                        o.steps * DBL_TRUE_MIN / h.amplitude), fabs(r.v - wanted_v) / h.amplitude);
}

/*
 * A drive of a thousand: the angle swings over 2 * 1171 rad, about the top (a fast swing's mean
 * potential is J0 of its amplitude times gravity's, and J0 is negative there). Each step rounds
 * an angle A to 1.1e-16 A, and the velocity, whose error moves the angle until friction has it, by
 * (frequency / damping) times as much. That adds up at random over the steps of a period, three
 * standard errors of it, and by 1 / (1 - |multiplier|) over periods.
 */
static pendres_status put_strong_drive(hard_sheet *sheet, const hard_ways *way)
{
  const double drive_amplitude = 1e3;
  const double a = drive_amplitude / (drive_frequency * hypot(drive_frequency, drive_damping));
  const double lag = atan2(drive_damping, -drive_frequency);
  const pendres_pendulum p = driven_by(drive_amplitude);
  reference_cycle c;
  reached r;
  pendres_status status =
    both_ways(sheet, way, drive_amplitude, 1.5 * pi + a * cos(lag),
              a * drive_frequency * sin(lag), &r);
  if (status != PENDRES_OK) return status;
  const pendres_orbit o = r.orbit;
  status = reference_orbit(&p, (long double)o.x - half_pi_exact, o.v, 1, 0, &c);
  if (status != PENDRES_OK) return hard_failed(sheet, status, NULL);
  const double off[] = { (double)fabsl(o.amplitude - c.amplitude),
                         (double)fabsl(o.loop_area - c.loop_area),
                         (double)fabsl(o.phase_lag - c.phase_lag) };
  const double multiplier = hypot(o.multiplier_re[0], o.multiplier_im[0]);
  const double rounding = 3.0 * 1.1e-16 * sqrt(o.steps / 3.0) *
                          (1.0 + drive_frequency / drive_damping) / (1.0 - multiplier);
  status = hard_sheet_add(sheet, "drive_1e3", "a drive of 1000: relative error of the amplitude "
                          "(naive: of the state, by waiting)", off[0] / a,
                          rounding + drive_tolerance / a,
                          hypot(remainder(r.x - 0.5 * pi - (double)c.y, 2.0 * pi),
                                r.v - (double)c.v) / a);
  if (status != PENDRES_OK) return status;
  const double worst =
    hard_larger(hard_over_claim(off[0], o.amplitude_error, most_claimed * a),
                hard_larger(hard_over_claim(off[1], o.loop_area_error,
                                            most_claimed * fabs(o.loop_area)),
                            hard_over_claim(off[2], o.phase_lag_error, most_claimed)));
  return hard_sheet_add(sheet, "drive_1e3_estimate", "the same: error of amplitude, loop area and "
                        "phase lag over its estimate, the worst", worst, 10.0, NAN);
}

/* The same drive at the tightest tolerance, far below its rounding: an answer and its error, not a
   search for steps that would help. */
static pendres_status put_strong_and_tight(hard_sheet *sheet)
{
  const pendres_options options = { .tolerance = tightest };
  const pendres_pendulum p = driven_by(1e3);
  const double x0 = 0.5 * pi + 0.3;
  long double y = (long double)x0 - half_pi_exact, w = 0.0L;
  long turns = 0;
  double x = x0, v = 0.0, estimate = NAN;
  pendres_context *ctx = NULL;
  pendres_status status = hard_context(sheet, &options, &ctx);
  if (status != PENDRES_OK) return status;
  status = pendres_strobe_advance(ctx, 1, &p, &x, &v, 1, &estimate);
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  pendres_context_free(ctx);
  if (status == PENDRES_OK) status = reference_advance(&p, &y, &w, &turns, 1);
  if (status != PENDRES_OK) return status;
  y += half_pi_exact * (1.0L + 4.0L * (long double)turns);
  const double error =
    hard_larger((double)fabsl((long double)x - y), (double)fabsl((long double)v - w));
  return hard_sheet_add(sheet, "drive_1e3_tight", "such a drive at tolerance 1e-13: error after a "
                        "period over its estimate", hard_over_claim(error, estimate,
                                                                    most_claimed * 1e3),
                        10.0, NAN);
}

/*
 * A free pendulum, undamped, started with a speed that only denormal numbers hold: v = v0 cos t, to
 * the tolerance as any other of order one, and a last place of denormals each step.
 */
static pendres_status put_denormal_start(hard_sheet *sheet, const hard_ways *way)
{
  const double v0 = 1e-310, t = PERIODS * 2.0 * pi / drive_frequency;
  const pendres_pendulum p = { .drive_frequency = drive_frequency };
  pendres_context *const each[] = { way->ours, way->naive };
  double error[2] = { NAN, NAN };
  pendres_cost cost;
  pendres_context_cost_reset(way->ours);
  for (int i = 0; i < 2; i++) {
    double x = 0.5 * pi, v = v0;
    const pendres_status status = pendres_strobe_advance(each[i], 1, &p, &x, &v, PERIODS, NULL);
    if (status != PENDRES_OK) return hard_failed(sheet, status, each[i]);
    error[i] = fabs(v / v0 - cos(t));
  }
  pendres_context_cost(way->ours, &cost);
  return hard_sheet_add(sheet, hard_at("drive_start", v0).text,
                        "a start with so small a speed, no drive, no "
                        "damping: its error over the start", error[0],
                        drive_tolerance + cost.steps * DBL_TRUE_MIN / v0, error[1]);
}

/* drive: none, too small to see, denormal, a thousand; and a denormal start. */
pendres_status hard_drive(hard_sheet *sheet)
{
  const pendres_options options = { .tolerance = drive_tolerance };
  hard_ways way;
  pendres_status status = hard_ways_open(sheet, &options, drive_tolerance, &way);
  if (status == PENDRES_OK) status = put_no_drive(sheet, &way);
  if (status == PENDRES_OK) status = put_small_drive(sheet, &way, 1e-300);
  if (status == PENDRES_OK) status = put_small_drive(sheet, &way, 1e-310);
  if (status == PENDRES_OK) status = put_denormal_start(sheet, &way);
  if (status == PENDRES_OK) status = put_strong_drive(sheet, &way);
  if (status == PENDRES_OK) status = put_strong_and_tight(sheet);
  hard_ways_close(&way);
  return status;
}
