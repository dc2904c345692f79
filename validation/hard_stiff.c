/*
 * hard_stiff.c -- strong damping: right at a stated cost, or refused with the remedy.
 *
 * A damping g makes velocities fade in a time 1/g, while the angle takes a time g. Explicit steps
 * must stay below about 4/g whatever is to be seen (the order-8 tables' real stability interval),
 * though nothing happens in them. Up to a million steps a period the library takes them; beyond
 * that it refuses and names cvode_bdf, whose steps follow the solution.
 */
#include <math.h>
#include <string.h>

#include "oracle/reference.h"

#include "validation/exact.h"
#include "validation/hard_cases.h"

static const double tolerance = 1e-8;

enum { STARTS = 4, PERIODS = 3 };

/* Starts that the initial layer is strong in, the same for each method. */
static int set_up(const hard_sheet *sheet, double damping, pendres_pendulum *p, double *x,
                  double *v)
{
  const int n = sheet->scale < 1.0 ? 1 : STARTS;
  for (int i = 0; i < n; i++) {
    p[i] = (pendres_pendulum){ .damping = damping, .drive_amplitude = 0.2,
                               .drive_frequency = 0.5 };
    x[i] = -1.4 + 1.5 * i;
    v[i] = 0.5 * i;
  }
  return n;
}

/* One method: its largest error, that over what it claims, right-hand sides a period. */
typedef struct measured {
  double error, over_claimed, rhs;
} measured;

static pendres_status measure(hard_sheet *sheet, double damping, pendres_method method,
                              measured *out)
{
  pendres_pendulum p[STARTS];
  double x[STARTS], v[STARTS], claimed[STARTS], again_x[STARTS], again_v[STARTS];
  pendres_context *ctx = NULL;
  pendres_cost cost;
  const int n = set_up(sheet, damping, p, x, v);
  pendres_status status =
    hard_context(sheet, &(pendres_options){ .tolerance = tolerance, .method = method }, &ctx);
  if (status != PENDRES_OK) return status;

  status = pendres_strobe_advance(ctx, (size_t)n, p, x, v, PERIODS, claimed);
  /* The cost once more without estimates, and without the probes that chose the steps. */
  (void)set_up(sheet, damping, p, again_x, again_v);
  pendres_context_cost_reset(ctx);
  if (status == PENDRES_OK)
    status = pendres_strobe_advance(ctx, (size_t)n, p, again_x, again_v, PERIODS, NULL);
  if (status != PENDRES_OK) goto done;
  pendres_context_cost(ctx, &cost);
  *out = (measured){ .rhs = cost.rhs_evaluations / cost.pendulum_periods };
  (void)set_up(sheet, damping, p, again_x, again_v);
  for (int i = 0; i < n; i++) {
    long double y = again_x[i] - half_pi_exact, w = again_v[i];
    long turns = 0;
    status = reference_advance(&p[i], &y, &w, &turns, PERIODS);
    if (status != PENDRES_OK) break;
    const long double angle = x[i] - half_pi_exact - 2.0L * pi_exact * (long double)turns;
    const double error =
      hard_larger((double)fabsl(angle - y), (double)fabsl((long double)v[i] - w));
    out->error = hard_larger(out->error, error);
    out->over_claimed = hard_larger(out->over_claimed, error / claimed[i]);
  }
done:
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  pendres_context_free(ctx);
  return status;
}

/* BDF of order 5 keeps a tolerance t with steps of about t^(1/6) of the time scale: 2 pi of them a
   drive period, and ten for the layer; two right-hand sides a step. */
static double bdf_rhs(double t)
{
  return 2.0 * (2.0 * pi + 10.0) / pow(t, 1.0 / 6.0);
}

/*
 * Damping 10, 100, 1000 at drive frequency 0.5.
 * - Error of the default method: the tolerance. Over what it claims: 10, as promised everywhere.
 * - Its cost: 12 stages, and gT/4 steps in a period T for stability, at least 200 for accuracy of
 *   an order-8 method in T = 4 pi; half more for the rounding up of cells and steps (1.25 in
 *   damping, 1.06 in frequency, 1.125 in steps).
 * - Error of cvode_bdf: the tolerance is that of a step, of which there are bdf_rhs / 2 a period.
 */
static pendres_status add_damping(hard_sheet *sheet, double damping)
{
  const double period = 4.0 * pi;
  const double rhs = 12.0 * 1.5 * fmax(200.0, 0.25 * damping * period);
  measured ours, bdf, naive;
  pendres_status status = measure(sheet, damping, PENDRES_BLOCK_FIXED, &ours);
  if (status == PENDRES_OK) status = measure(sheet, damping, PENDRES_CVODE_BDF, &bdf);
  if (status == PENDRES_OK) status = measure(sheet, damping, PENDRES_NAIVE, &naive);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("stiff_error", damping).text,
                            "error after three drive periods", ours.error, tolerance, naive.error);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("stiff_claim", damping).text,
                            "that error over the claimed one", ours.over_claimed, 10.0,
                            naive.over_claimed);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("stiff_rhs", damping).text,
                            "right-hand sides a drive period", ours.rhs, rhs, naive.rhs);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("stiff_bdf_error", damping).text, "error of cvode_bdf",
                            bdf.error, 0.5 * PERIODS * bdf_rhs(tolerance) * tolerance, naive.error);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("stiff_bdf_claim", damping).text,
                            "that error over the claimed one", bdf.over_claimed, 10.0,
                            naive.over_claimed);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("stiff_bdf_rhs", damping).text,
                            "right-hand sides a drive period of cvode_bdf", bdf.rhs,
                            bdf_rhs(tolerance), naive.rhs);
  return status;
}

/*
 * What overdamped pendulums settle on, against the reference's orbit: all on the one orbit that is
 * there, and its errors over the claimed ones within 10.
 */
static pendres_status add_orbit(hard_sheet *sheet, double damping)
{
  pendres_pendulum p[STARTS];
  double x[STARTS], v[STARTS];
  pendres_settled outcome[STARTS];
  pendres_attractors *found = NULL;
  pendres_context *ctx = NULL;
  reference_cycle exact;
  const int n = set_up(sheet, damping, p, x, v);
  pendres_status status =
    hard_context(sheet, &(pendres_options){ .tolerance = tolerance }, &ctx);
  if (status == PENDRES_OK) status = pendres_settle(ctx, (size_t)n, p, x, v, outcome, &found);
  if (status == PENDRES_OK) status = reference_orbit(p, 0.0L, 0.0L, 1, 0, &exact);
  if (status != PENDRES_OK) {
    (void)hard_failed(sheet, status, ctx);
    goto done;
  }
  int wrong = pendres_attractors_count(found) != 1;
  for (int i = 0; i < n; i++) wrong += outcome[i].attractor != 0;
  double off = NAN;
  if (!wrong) {
    const pendres_orbit *o = &pendres_attractors_get(found, 0)->orbit;
    const double most = 1e-6; /* of amplitudes below 1, at a tolerance far below */
    off = hard_over_claim((double)fabsl(o->amplitude - exact.amplitude), o->amplitude_error, most);
    off = hard_larger(off, hard_over_claim((double)fabsl(o->loop_area - exact.loop_area),
                                           o->loop_area_error, most));
    off = hard_larger(off, hard_over_claim((double)fabsl(o->x - half_pi_exact - exact.y),
                                           o->x_error, most));
  }
  status = hard_sheet_add(sheet, hard_at("stiff_settled", damping).text,
                          "pendulums that did not settle on the only orbit", wrong, 0.0, NAN);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("stiff_orbit", damping).text,
                            "the orbit's errors over the claimed", off, 10.0, NAN);
done:
  pendres_attractors_free(found);
  pendres_context_free(ctx);
  return status;
}

/*
 * The overdamped limit. With s = t/g and e = 1/g^2, x obeys e x_ss + x_s = f(x, s) = cos x +
 * F0 cos(g omega s). After a layer that adds e (x_s - f) at s = 0 to x, x follows
 * x_s = f - e (f_s + f f_x) up to e^2 (the slow manifold to first order). Integrated by the
 * classical Runge-Kutta method with steps so small that e^2 = 1e-12 is all that is left.
 */
static long double slow_slope(const pendres_pendulum *p, long double x, long double s)
{
  const long double g = p->damping, rate = g * p->drive_frequency, amplitude = p->drive_amplitude;
  const long double f = cosl(x) + amplitude * cosl(rate * s);
  const long double fs = -amplitude * rate * sinl(rate * s), fx = -sinl(x);
  return f - (fs + f * fx) / (g * g);
}

static long double slow_position(const pendres_pendulum *p, long double x, long double v,
                                 long periods)
{
  enum { STEPS = 10000 };
  const long double g = p->damping;
  const long double h = 2.0L * pi_exact / p->drive_frequency * (long double)periods / g / STEPS;
  x += (v * g - cosl(x) - p->drive_amplitude) / (g * g);
  for (int i = 0; i < STEPS; i++) {
    const long double s = i * h;
    const long double a = slow_slope(p, x, s), b = slow_slope(p, x + 0.5L * h * a, s + 0.5L * h);
    const long double c = slow_slope(p, x + 0.5L * h * b, s + 0.5L * h);
    const long double d = slow_slope(p, x + h * c, s + h);
    x += h / 6.0L * (a + 2.0L * b + 2.0L * c + d);
  }
  return x;
}

/*
 * Damping 1000 at drive frequency 0.001: 1.6 million explicit steps a period, too many. Refused
 * with the remedy; the remedy at 1e-10 a step, against the overdamped limit, whose own error of
 * some 1e-12 is below the claimed one; its cost as above. Plain ARKODE pays a hundred
 * thousandfold (left out of shortened runs).
 */
static pendres_status add_refusal(hard_sheet *sheet)
{
  const pendres_pendulum p = { .damping = 1000.0, .drive_amplitude = 0.2, .drive_frequency = 1e-3 };
  const double x0 = 1.0, v0 = 0.5, fine = 1e-10;
  const double exact = (double)slow_position(&p, x0, v0, 1);
  double x = x0, v = v0, claimed = NAN, naive = NAN, naive_rhs = NAN;
  pendres_context *ctx = NULL;
  pendres_cost cost;

  pendres_status status = hard_context(sheet, NULL, &ctx);
  if (status != PENDRES_OK) return status;
  const int refused = pendres_strobe_advance(ctx, 1, &p, &x, &v, 1, NULL) ==
                        PENDRES_TOLERANCE_UNREACHABLE &&
                      strstr(pendres_context_message(ctx), "cvode_bdf") != NULL && x == x0;
  pendres_context_free(ctx);
  if (sheet->scale >= 1.0) {
    naive = x0, v = v0;
    status = hard_naive_context(sheet, 1e-8, &ctx);
    if (status != PENDRES_OK) return status;
    status = pendres_strobe_advance(ctx, 1, &p, &naive, &v, 1, NULL);
    pendres_context_cost(ctx, &cost);
    naive_rhs = cost.rhs_evaluations;
    naive = fabs(naive - exact);
    if (status != PENDRES_OK) goto done;
    pendres_context_free(ctx);
  }
  const pendres_options o = { .tolerance = fine, .method = PENDRES_CVODE_BDF };
  status = hard_context(sheet, &o, &ctx);
  if (status != PENDRES_OK) return status;
  x = x0, v = v0;
  status = pendres_strobe_advance(ctx, 1, &p, &x, &v, 1, NULL);
  pendres_context_cost(ctx, &cost);
  const double rhs = cost.rhs_evaluations;
  double error_x = x0, error_v = v0;
  if (status == PENDRES_OK)
    status = pendres_strobe_advance(ctx, 1, &p, &error_x, &error_v, 1, &claimed);
  if (status != PENDRES_OK) goto done;
  status = hard_sheet_add(sheet, "stiff_refused", "0: refused, with the remedy; 1: not", !refused,
                          0.0, NAN);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "stiff_remedy", "error of the remedy (tolerance 1e-10)",
                            fabs(x - exact), 0.5 * bdf_rhs(fine) * fine, naive);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "stiff_remedy_claim", "that error over the claimed one",
                            fabs(x - exact) / claimed, 10.0, NAN);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, "stiff_remedy_rhs", "right-hand sides a drive period", rhs,
                            bdf_rhs(fine), naive_rhs);
  pendres_context_free(ctx);
  return status;
done:
  (void)hard_failed(sheet, status, ctx);
  pendres_context_free(ctx);
  return status;
}

pendres_status hard_stiff(hard_sheet *sheet)
{
  static const double damping[] = { 10.0, 100.0, 1000.0 };
  const int count = sheet->scale < 0.1 ? 2 : 3;
  pendres_status status = PENDRES_OK;
  for (int i = 0; i < count && status == PENDRES_OK; i++) {
    status = add_damping(sheet, damping[i]);
    if (status == PENDRES_OK) status = add_orbit(sheet, damping[i]);
  }
  return status == PENDRES_OK ? add_refusal(sheet) : status;
}
