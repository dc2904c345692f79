/*
 * hard_wild.c -- strong drives: chaos, period doubling, and pendulums that have gone over the top a
 * million times.
 *
 * The pendulum of Baker and Gollub, Chaotic Dynamics (Cambridge 1996), chapter 3: damping 1/2,
 * drive frequency 2/3; with rising drive it swings with period 1, 2, is chaotic (1.15), runs with
 * period 1, 2, 4, and is chaotic again (1.5).
 */
#include <math.h>

#include "oracle/reference.h"

#include "validation/exact.h"
#include "validation/hard_cases.h"

static const double half_pi = 1.57079632679489661923;
static const double naive_tolerance = 1e-6;

static pendres_pendulum driven(double drive)
{
  return (pendres_pendulum){ .damping = 0.5, .drive_amplitude = drive,
                             .drive_frequency = 0.66666666666666667 };
}

static double period_of(const pendres_pendulum *p)
{
  return 4.0 * half_pi / p->drive_frequency;
}

/* ---- chaos --------------------------------------------------------------------------------- */

enum {
  BATCHES = 20, BATCH = 300, /* periods */
  TRANSIENT = 100,
  CHAOTIC_STARTS = 8
};

typedef struct exponent {
  double value, error; /* per unit time; one standard error */
} exponent;

/* Benettin's method on the extended-precision map and its derivative: batches of periods. */
static pendres_status exact_exponent(const pendres_pendulum *p, double scale, exponent *e)
{
  const int batch = scale >= 1.0 ? BATCH : scale >= 0.1 ? BATCH / 4 : BATCH / 20;
  long double y = 0.1L, v = 0.0L, u[2] = { 1.0L, 0.0L };
  double sum = 0.0, squares = 0.0;
  pendres_status status = reference_advance(p, &y, &v, NULL, TRANSIENT);
  for (int b = 0; b < BATCHES && status == PENDRES_OK; b++) {
    double growth = 0.0;
    for (int k = 0; k < batch && status == PENDRES_OK; k++) {
      reference_image m;
      status = reference_map(p, y, v, 1, &m);
      if (status != PENDRES_OK) break;
      const long double a = m.monodromy[0][0] * u[0] + m.monodromy[0][1] * u[1];
      const long double c = m.monodromy[1][0] * u[0] + m.monodromy[1][1] * u[1];
      const long double length = hypotl(a, c);
      u[0] = a / length, u[1] = c / length;
      y = m.y, v = m.v;
      growth += (double)logl(length);
    }
    growth /= batch * period_of(p);
    sum += growth, squares += growth * growth;
  }
  e->value = sum / BATCHES;
  e->error = sqrt(fmax(0.0, squares / BATCHES - e->value * e->value) / (BATCHES - 1));
  return status;
}

/* What one would try first: two neighbours, and how far they are apart after some periods. */
static pendres_status naive_exponent(hard_sheet *sheet, const pendres_pendulum *p, double *value)
{
  enum { PERIODS = 20 };
  const double apart = 1e-6;
  const pendres_pendulum both[2] = { *p, *p };
  double x[2] = { 0.1, 0.1 + apart }, v[2] = { 0.0, 0.0 };
  pendres_context *ctx = NULL;
  pendres_status status = hard_naive_context(sheet, naive_tolerance, &ctx);
  if (status != PENDRES_OK) return status;
  status = pendres_strobe_advance(ctx, 2, both, x, v, PERIODS, NULL);
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  *value = log(hypot(x[1] - x[0], v[1] - v[0]) / apart) / (PERIODS * period_of(p));
  pendres_context_free(ctx);
  return status;
}

/*
 * All pendulums are labelled chaotic, on one attractor. Its largest Lyapunov exponent agrees with
 * that of an independent computation: four standard errors of the difference, which chance
 * exceeds once in 16000; and is positive by more than that.
 */
static pendres_status add_chaos(hard_sheet *sheet, double drive)
{
  pendres_pendulum p[CHAOTIC_STARTS];
  double x[CHAOTIC_STARTS], v[CHAOTIC_STARTS], naive = NAN;
  pendres_settled outcome[CHAOTIC_STARTS];
  pendres_attractors *found = NULL;
  pendres_context *ctx = NULL;
  exponent exact = { NAN, NAN }, ours = { NAN, NAN };
  for (int i = 0; i < CHAOTIC_STARTS; i++) {
    p[i] = driven(drive);
    x[i] = -1.0 + 0.7 * i;
    v[i] = 0.0;
  }
  pendres_status status = hard_context(sheet, NULL, &ctx);
  if (status != PENDRES_OK) return status;
  status = pendres_settle(ctx, CHAOTIC_STARTS, p, x, v, outcome, &found);
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  if (status == PENDRES_OK) status = exact_exponent(p, sheet->scale, &exact);
  if (status == PENDRES_OK) status = naive_exponent(sheet, p, &naive);
  if (status != PENDRES_OK) goto done;
  int wrong = pendres_attractors_count(found) != 1;
  for (int i = 0; i < CHAOTIC_STARTS; i++) wrong += outcome[i].label != PENDRES_LABEL_CHAOTIC;
  if (pendres_attractors_count(found) > 0) {
    const pendres_attractor *a = pendres_attractors_get(found, 0);
    ours = (exponent){ .value = a->lyapunov, .error = a->lyapunov_error };
  }
  /* An error of a quarter of the exponent would be of no use: it is to be known to be positive. */
  const double error = hypot(exact.error, ours.error), least = 0.25 * fabs(exact.value);
  status = hard_sheet_add(sheet, hard_at("chaos_label", drive).text, "starts not labelled chaotic",
                          wrong, 0.0, NAN);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("chaos_exponent", drive).text,
                            "its largest exponent: difference in standard errors",
                            hard_over_claim(fabs(ours.value - exact.value), error, least), 4.0,
                            fabs(naive - exact.value) / error);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("chaos_positive", drive).text,
                            "four standard errors over the exponent",
                            hard_above_zero(ours.value, error), 1.0, NAN);
done:
  pendres_attractors_free(found);
  pendres_context_free(ctx);
  return status;
}

/* ---- period doubling ----------------------------------------------------------------------- */

/* 1.0663 is just short of the first doubling: a multiplier of -0.997, errors fade slowly. */
static const struct cascade {
  double drive;
  int period, winding; /* the latter up to its sign */
} cascades[] = { { 0.9, 1, 0 },  { 1.0663, 1, 0 }, { 1.07, 2, 0 },
                 { 1.35, 1, 1 }, { 1.45, 2, 2 },   { 1.47, 4, 4 } };

/* Errors claimed for orbits at the default tolerance of 1e-8: more would not be an answer. */
static const double most_claimed = 1e-6;

/* Whether extended precision denies an orbit: not closed, unstable, closed earlier, elsewhere. */
static pendres_status denied(const pendres_orbit *o, int *wrong)
{
  const long double y = o->x - half_pi_exact;
  reference_cycle c;
  reference_image early;
  pendres_status status = reference_orbit(&o->pendulum, y, o->v, o->period, o->winding, &c);
  *wrong = status == PENDRES_NOT_CONVERGED;
  if (status != PENDRES_OK) return *wrong ? PENDRES_OK : status;
  *wrong = !(hypotl(c.multiplier_re[0], c.multiplier_im[0]) < 1.0L) ||
           hard_misplaced((double)fabsl(remainderl(y - c.y, 4.0L * half_pi_exact)), o->x_error,
                          most_claimed) ||
           hard_misplaced((double)fabsl(o->v - c.v), o->v_error, most_claimed);
  for (int k = 1; k < o->period && status == PENDRES_OK; k++) {
    status = reference_map(&o->pendulum, c.y, c.v, k, &early);
    *wrong |= !(hypotl(early.y - c.y, early.v - c.v) >= 1e-3L);
  }
  return status;
}

/* After some periods by plain ARKODE: the first period within which the start of it comes back. */
static pendres_status naive_period(hard_sheet *sheet, const pendres_pendulum *p, int *period)
{
  enum { PERIODS = 60, LONGEST = 8 };
  const double close = 1e-3;
  pendres_context *ctx = NULL;
  double x = 0.1, v = 0.0;
  pendres_status status = hard_naive_context(sheet, naive_tolerance, &ctx);
  if (status != PENDRES_OK) return status;
  status = pendres_strobe_advance(ctx, 1, p, &x, &v, PERIODS, NULL);
  *period = 0;
  for (int q = 1; q <= LONGEST && *period == 0 && status == PENDRES_OK; q++) {
    double x1 = x, v1 = v;
    status = pendres_strobe_advance(ctx, 1, p, &x1, &v1, q, NULL);
    if (hypot(remainder(x1 - x, 4.0 * half_pi), v1 - v) < close) *period = q;
  }
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  pendres_context_free(ctx);
  return status;
}

/*
 * All attractors found are orbits with the period and the turns that are known, and confirmed in
 * extended precision, with errors within ten times the claimed ones. Bound: none wrong.
 */
static pendres_status add_cascade(hard_sheet *sheet, const struct cascade *known)
{
  const pendres_pendulum p = driven(known->drive);
  pendres_attractors *found = NULL;
  pendres_context *ctx = NULL;
  int wrong, naive = 0;
  pendres_status status = hard_context(sheet, NULL, &ctx);
  if (status != PENDRES_OK) return status;
  status = pendres_attractors_find(ctx, &p, 0, NULL, NULL, &found);
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  if (status == PENDRES_OK) status = naive_period(sheet, &p, &naive);
  wrong = pendres_attractors_count(found) == 0;
  for (size_t i = 0; i < pendres_attractors_count(found) && status == PENDRES_OK; i++) {
    const pendres_attractor *a = pendres_attractors_get(found, i);
    int bad = a->label == PENDRES_LABEL_CHAOTIC || a->orbit.period != known->period ||
              (a->orbit.winding != known->winding && a->orbit.winding != -known->winding);
    if (!bad) status = denied(&a->orbit, &bad);
    wrong += bad;
  }
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("cascade", known->drive).text,
                            "attractors of another period than the known one", wrong, 0.0,
                            naive != known->period);
  pendres_attractors_free(found);
  pendres_context_free(ctx);
  return status;
}

/* ---- a million turns ----------------------------------------------------------------------- */

/* Advance by a method from the orbit's point some turns away; x and v become their distances from
   where the orbit is then. */
static pendres_status run_on(hard_sheet *sheet, const pendres_options *o,
                             const reference_cycle *orbit, long periods, double *x,
                             double *v)
{
  const double turns = 1e6 - (double)periods;
  const pendres_pendulum p = driven((double)orbit->drive_amplitude);
  const long double two_pi = 4.0L * half_pi_exact, at = orbit->y + half_pi_exact;
  pendres_context *ctx = NULL;
  pendres_status status = hard_context(sheet, o, &ctx);
  if (status != PENDRES_OK) return status;
  *x = (double)(at + two_pi * (long double)turns);
  *v = (double)orbit->v;
  status = pendres_strobe_advance(ctx, 1, &p, x, v, periods, NULL);
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  const long double end =
    at + two_pi * ((long double)turns + (long double)periods * (long double)orbit->winding);
  *x = (double)fabsl(*x - end);
  *v = (double)fabsl(*v - orbit->v);
  pendres_context_free(ctx);
  return status;
}

/*
 * A pendulum that runs with one turn a period, up to its millionth turn: by then the orbit of
 * extended precision is all that it remembers. Bounds: for the velocity the tolerance, whatever
 * the turns; for the angle half a unit in the last place of six million. The naive way starts out
 * as far and has the sine of such angles, each with that error, in every step.
 */
static pendres_status add_turns(hard_sheet *sheet)
{
  const double tolerance = 1e-12, last_place = 0x1p-31;
  const long periods = sheet->scale < 1.0 ? 100 : 5000, few = 20;
  const pendres_pendulum p = driven(1.35);
  reference_cycle orbit;
  double x, v, naive_x, naive_v;
  pendres_status status =
    reference_orbit(&p, 2.450188L - half_pi_exact, 1.910757L, 1, 1, &orbit);
  if (status != PENDRES_OK) return hard_failed(sheet, status, NULL);
  status = run_on(sheet, &(pendres_options){ .tolerance = tolerance }, &orbit, periods,
                  &x, &v);
  if (status == PENDRES_OK)
    status = run_on(sheet, &(pendres_options){ .tolerance = tolerance, .method = PENDRES_NAIVE },
                    &orbit, few, &naive_x, &naive_v);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "turns_velocity", "error of the velocity after a million turns",
                            v, tolerance, naive_v);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "turns_angle", "error of the angle, six million, itself", x,
                            last_place, naive_x);
  return status;
}

pendres_status hard_wild(hard_sheet *sheet)
{
  static const double chaotic[] = { 1.15, 1.5 };
  pendres_status status = PENDRES_OK;
  for (int i = 0; i < 2 && status == PENDRES_OK; i++) status = add_chaos(sheet, chaotic[i]);
  for (size_t i = 0; i < sizeof cascades / sizeof *cascades && status == PENDRES_OK; i++)
    status = add_cascade(sheet, &cascades[i]);
  return status == PENDRES_OK ? add_turns(sheet) : status;
}
