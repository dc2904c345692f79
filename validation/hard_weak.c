/*
 * hard_weak.c -- pendulums that take long: hardly damped ones, and drives far slower or faster than
 * the pendulum.
 */
#include <float.h>
#include <math.h>

#include "oracle/reference.h"

#include "validation/exact.h"
#include "validation/hard_cases.h"

/* Larger of the errors of a state next to a reference orbit's Poincaré point. */
static double off_point(const reference_cycle *c, double x, double v)
{
  const long double y = (long double)x - half_pi_exact - c->y;
  return hard_larger((double)fabsl(remainderl(y, 4.0L * half_pi_exact)), (double)fabsl(v - c->v));
}

static pendres_status refer(hard_sheet *sheet, const pendres_orbit *o, reference_cycle *c)
{
  const pendres_status status =
    reference_orbit(&o->pendulum, (long double)o->x - half_pi_exact, o->v, 1, 0, c);
  return status == PENDRES_OK ? status : hard_failed(sheet, status, NULL);
}

/* The worst of an orbit's errors over their estimates. */
static double orbit_underestimated(const pendres_orbit *o, const reference_cycle *c)
{
  const double most = 1e-4; /* a larger claim is no answer */
  const double ratio[] = {
    hard_over_claim(off_point(c, o->x, o->v), hard_larger(o->x_error, o->v_error), most),
    hard_over_claim((double)fabsl(o->loop_area - c->loop_area), o->loop_area_error, most),
    hard_over_claim((double)fabsl(o->amplitude - c->amplitude), o->amplitude_error, most),
    hard_over_claim((double)fabsl(o->phase_lag - c->phase_lag), o->phase_lag_error, most),
  };
  double worst = 0.0;
  for (size_t i = 0; i < sizeof ratio / sizeof *ratio; i++)
    worst = hard_larger(worst, ratio[i]);
  return worst;
}

/* ---- weak damping -------------------------------------------------------------------------- */

enum { SMALL = 5, LARGE = 2, WEAK = SMALL + LARGE };

static const double weak_beside = 0.02; /* start so far beside the orbit */
static const double weak_tolerance = 1e-8;

typedef struct weak {
  pendres_pendulum p[WEAK];
  pendres_orbit orbit[WEAK];
  double x[WEAK], v[WEAK]; /* starts */
  double estimate;         /* the worst of the orbits' errors over their estimates */
  long periods;            /* that they are followed for */
} weak;

/* Orbits of small amplitude about the resonance, by linear response; and of large amplitude, where
   the free pendulum has the drive's frequency (Kittel: 1 - a^2 / 16), against the drive: those
   with it are unstable. */
static pendres_status weak_orbits(hard_sheet *sheet, pendres_context *ctx, double damping, weak *w)
{
  static const double frequency[WEAK] = { 0.8, 0.9, 0.95, 1.1, 1.2, 0.9, 0.95 };
  w->estimate = 0.0;
  for (int i = 0; i < WEAK; i++) {
    reference_cycle c;
    pendres_harmonic h;
    w->p[i] = (pendres_pendulum){ .damping = damping, .drive_amplitude = 0.02,
                                  .drive_frequency = frequency[i] };
    pendres_status status = pendres_harmonic_find(&w->p[i], &h);
    if (status != PENDRES_OK) return hard_failed(sheet, status, NULL);
    const double y = i < SMALL ? h.amplitude * cos(h.phase_lag) : -4.0 * sqrt(1.0 - frequency[i]);
    status = hard_orbit(sheet, ctx, &w->p[i], 0.5 * pi + y, 0.0, &w->orbit[i]);
    if (status == PENDRES_OK) status = refer(sheet, &w->orbit[i], &c);
    if (status != PENDRES_OK) return status;
    w->estimate = hard_larger(w->estimate, orbit_underestimated(&w->orbit[i], &c));
    w->x[i] = w->orbit[i].x + weak_beside;
    w->v[i] = w->orbit[i].v;
  }
  return PENDRES_OK;
}

/* Wait for n of them, from number `first` on in steps of `stride`; how far they are from the
   orbits then. */
static pendres_status weak_wait(hard_sheet *sheet, pendres_context *ctx, const weak *w, int first,
                                int stride, double *off)
{
  pendres_pendulum p[WEAK];
  double x[WEAK], v[WEAK];
  size_t n = 0;
  for (int i = first; i < WEAK; i += stride, n++) {
    p[n] = w->p[i];
    x[n] = w->x[i];
    v[n] = w->v[i];
  }
  const pendres_status status = pendres_strobe_advance(ctx, n, p, x, v, w->periods, NULL);
  if (status != PENDRES_OK) return hard_failed(sheet, status, ctx);
  *off = 0.0;
  for (size_t k = 0; k < n; k++) {
    const pendres_orbit *o = &w->orbit[(size_t)first + k * (size_t)stride];
    *off = hard_larger(*off, hard_larger(fabs(x[k] - o->x), fabs(v[k] - o->v)));
  }
  return PENDRES_OK;
}

/* Labels by trapping regions instead of waiting: starts whose attractor is not the orbit that they
   started beside. */
static pendres_status weak_settle(hard_sheet *sheet, pendres_context *ctx, const weak *w,
                                  double *wrong)
{
  pendres_settled outcome[WEAK];
  pendres_attractors *found = NULL;
  const pendres_status status = pendres_settle(ctx, WEAK, w->p, w->x, w->v, outcome, &found);
  if (status != PENDRES_OK) return hard_failed(sheet, status, ctx);
  *wrong = 0.0;
  for (int i = 0; i < WEAK; i++) {
    const pendres_orbit *o = &w->orbit[i];
    /* -1, unresolved, is out of range of any set. */
    const pendres_attractor *a = pendres_attractors_get(found, (size_t)outcome[i].attractor);
    *wrong += a == NULL || !(hypot(a->orbit.x - o->x, a->orbit.v - o->v) < 1e-6);
  }
  pendres_attractors_free(found);
  return PENDRES_OK;
}

/*
 * weak_damping: damping 1e-4, where transients last for 1e5 drive periods, and Newton's method on
 * the strobe map, which does not wait for them. The two must agree.
 *
 * After n periods of tau there is left of the start weak_beside exp(-damping n tau / 2), times the
 * axis ratio of the orbits' neighbourhoods, which is below 10; and each way has the tolerance's
 * error. A shorter run (sheet->scale) has as much larger a damping and leaves as much. Labels must
 * be right without waiting; and the orbits' errors be no more than ten times their estimates.
 */
pendres_status hard_weak_damping(hard_sheet *sheet)
{
  const pendres_options options = { .tolerance = weak_tolerance, .block_lanes = 8 };
  const double damping = 1e-4 / sheet->scale, shortest = 2.0 * pi / 1.2;
  const long periods = (long)ceil(1e5 * sheet->scale);
  const double left = 10.0 * weak_beside * exp(-0.5 * damping * (double)periods * shortest);
  double ours = NAN, theirs = NAN, wrong = NAN;
  weak w;
  hard_ways way;
  pendres_status status = hard_ways_open(sheet, &options, weak_tolerance, &way);
  if (status == PENDRES_OK) status = weak_orbits(sheet, way.ours, damping, &w);
  w.periods = periods;
  if (status == PENDRES_OK) status = weak_wait(sheet, way.ours, &w, 0, 1, &ours);
  if (status == PENDRES_OK) status = weak_wait(sheet, way.naive, &w, 1, SMALL - 1, &theirs);
  if (status == PENDRES_OK) status = weak_settle(sheet, way.ours, &w, &wrong);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "weak_wait", "damping 1e-4: orbits by Newton's method less "
                            "where pendulums are after 1e5 periods (naive: two of seven)",
                            ours, 2.0 * weak_tolerance + left, theirs);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "weak_estimate", "errors of these orbits and of their measures "
                            "over their estimates, the worst", w.estimate, 10.0, NAN);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "weak_labels", "of seven starts beside them, those not labelled "
                            "as settling on them", wrong, 0.0, NAN);
  hard_ways_close(&way);
  return status;
}

/* ---- frequency ----------------------------------------------------------------------------- */

static const double frequency_damping = 0.2, frequency_tolerance = 1e-8;

typedef struct ways {
  pendres_orbit orbit;
  reference_cycle cycle;
  double error;       /* of the orbit's point, loop area and amplitude, the largest */
  double naive_error; /* of the point, by waiting */
} ways;

static pendres_status both_ways(hard_sheet *sheet, const hard_ways *way,
                                double drive_amplitude, double drive_frequency, ways *w)
{
  const pendres_pendulum p = { .damping = frequency_damping, .drive_amplitude = drive_amplitude,
                               .drive_frequency = drive_frequency };
  const double slow = asin(fmin(drive_amplitude, 1.0));
  const double fast = -drive_amplitude / (drive_frequency * drive_frequency);
  double x = 0.5 * pi + (drive_frequency < 1.0 ? slow : fast), v = 0.0;
  pendres_status status = hard_orbit(sheet, way->ours, &p, x, v, &w->orbit);
  if (status == PENDRES_OK) status = refer(sheet, &w->orbit, &w->cycle);
  if (status != PENDRES_OK) return status;
  w->error = hard_larger(off_point(&w->cycle, w->orbit.x, w->orbit.v),
                         hard_larger((double)fabsl(w->orbit.loop_area - w->cycle.loop_area),
                                     (double)fabsl(w->orbit.amplitude - w->cycle.amplitude)));
  /* Until a free oscillation has died down to a double's last digit. */
  const double gone = -log(DBL_EPSILON) / (0.5 * frequency_damping);
  status = pendres_strobe_advance(way->naive, 1, &p, &x, &v,
                                  (long)ceil(gone * drive_frequency / (2.0 * pi)), NULL);
  if (status != PENDRES_OK) return hard_failed(sheet, status, way->naive);
  w->naive_error = off_point(&w->cycle, x, v);
  return PENDRES_OK;
}

static pendres_status put_ways(hard_sheet *sheet, const char *name, const char *name_estimate,
                               const char *quantity, const ways *w)
{
  const pendres_status status = hard_sheet_add(sheet, name, quantity, w->error,
                                               frequency_tolerance, w->naive_error);
  if (status != PENDRES_OK) return status;
  return hard_sheet_add(sheet, name_estimate, "the same errors, and that of the phase lag, over "
                        "their estimates, the worst", orbit_underestimated(&w->orbit, &w->cycle),
                        10.0, NAN);
}

/*
 * A slow drive: the pendulum stays where the forces balance, sin y = F0 cos(theta), and what
 * friction takes is damping w times the integral of (dy/dtheta)^2, which is
 * 2 pi (1 - sqrt(1 - F0^2)). What comes next is of the order w^2: (2 - damping^2) w^2 relative for
 * small F0, and the powers of 1 / cos y that large angles add do not make it five times as much at
 * F0 = 0.9 (cos y >= 0.43: two of them).
 */
static pendres_status put_slow(hard_sheet *sheet, const hard_ways *way)
{
  const double w = 1e-3, f = 0.9;
  ways ways;
  pendres_status status = both_ways(sheet, way, f, w, &ways);
  if (status == PENDRES_OK)
    status = put_ways(sheet, "frequency_1e-3", "frequency_1e-3_estimate", "drive frequency 0.001, "
                      "F0 = 0.9: largest error of point, loop area, amplitude", &ways);
  if (status != PENDRES_OK) return status;
  const double area = 2.0 * pi * frequency_damping * w * (1.0 - sqrt(1.0 - f * f));
  return hard_sheet_add(sheet, "frequency_adiabatic", "the same: loop area over that of an "
                        "infinitely slow drive, less 1", fabs(ways.orbit.loop_area / area - 1.0),
                        5.0 * 2.0 * w * w, NAN);
}

/*
 * A fast drive: linear response where it is weak, as -y^3 / 6 is not even 1e-9 of y, and its
 * share of the amplitude a is 1 / w^2 of that, a^2 / (8 w^2) = 3e-13. Beside it a drive that shakes
 * the pendulum over one radian.
 */
static pendres_status put_fast(hard_sheet *sheet, const hard_ways *way)
{
  const double w = 50.0;
  ways ways;
  pendres_harmonic h;
  pendres_status status = both_ways(sheet, way, 0.2, w, &ways);
  if (status == PENDRES_OK)
    status = put_ways(sheet, "frequency_50", "frequency_50_estimate", "drive frequency 50, "
                      "F0 = 0.2: largest error of point, loop area, amplitude", &ways);
  if (status != PENDRES_OK) return status;
  status = pendres_harmonic_find(&ways.orbit.pendulum, &h);
  if (status != PENDRES_OK) return hard_failed(sheet, status, NULL);
  status = hard_sheet_add(sheet, "frequency_linear", "the same: amplitude over that of a harmonic "
                          "oscillator, less 1", fabs(ways.orbit.amplitude / h.amplitude - 1.0),
                          h.amplitude * h.amplitude / (8.0 * w * w) +
                            ways.orbit.amplitude_error / h.amplitude,
                          NAN);
  if (status == PENDRES_OK) status = both_ways(sheet, way, w * w, w, &ways);
  if (status == PENDRES_OK)
    status = put_ways(sheet, "frequency_shaken", "frequency_shaken_estimate", "drive frequency "
                      "50, F0 = 2500: largest error of point, loop area, amplitude", &ways);
  return status;
}

/*
 * frequency: orbits under drives of frequency 0.001 and 50, against extended precision to the
 * tolerance, with estimates good to a factor of ten, and against perturbation theory.
 */
pendres_status hard_frequency(hard_sheet *sheet)
{
  const pendres_options options = { .tolerance = frequency_tolerance };
  hard_ways way;
  pendres_status status = hard_ways_open(sheet, &options, frequency_tolerance, &way);
  if (status == PENDRES_OK) status = put_slow(sheet, &way);
  if (status == PENDRES_OK) status = put_fast(sheet, &way);
  hard_ways_close(&way);
  return status;
}
