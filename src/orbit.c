/* orbit.c -- periodic orbits by Newton's method on the stroboscopic map; see orbit.h. */
#include <pendres/orbit.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "context_internal.h"
#include "orbit_measure.h"
#include "orbit_newton.h"
#include "steps.h"
#include "strobe_noise.h"

static const double pi = 3.14159265358979323846;
static const double two_pi = 6.28318530717958647693;
static const double half_pi = 1.57079632679489661923;

/* A run of one candidate by a number of steps: the corrected point and its measures. */
typedef struct result {
  double y, w;
  double trace;
  double m[2][2];
  double dy, dw; /* by omega */
  double slope;  /* dA/domega */
  pendres_orbit_measures measures;
} result;

/* (I - M) z = r; 0 if singular. *stretch bounds how much errors of r grow. */
static int solve(const double m[2][2], const double r[2], double z[2], double *stretch)
{
  const double a = 1.0 - m[0][0], b = -m[0][1], c = -m[1][0], d = 1.0 - m[1][1];
  const double det = a * d - b * c;
  if (!(fabs(det) > 1e-300)) return 0;
  z[0] = (d * r[0] - b * r[1]) / det;
  z[1] = (a * r[1] - c * r[0]) / det;
  if (stretch != NULL)
    *stretch = fmax(fabs(d) + fabs(b), fabs(a) + fabs(c)) / fabs(det);
  return 1;
}

/* The samples of one candidate in the tape, moved to the corrected point by the linearised flow. */
static pendres_status evaluate(const pendres_newton_candidate *c, const pendres_newton_tape *tape,
                               pendres_orbit_want want, double *work, result *out)
{
  const size_t n = tape->samples;
  const double defect[2] = {c->residual[0], c->residual[1]};
  double shift[2] = {0.0, 0.0}, by_omega[2] = {NAN, NAN};
  double *y = work, *w = work + n;

  if (!solve(c->m, defect, shift, NULL)) return PENDRES_NOT_CONVERGED;
  out->y = c->y + shift[0];
  out->w = c->w + shift[1];
  memcpy(out->m, c->m, sizeof out->m);
  out->trace = c->m[0][0] + c->m[1][1];
  for (size_t k = 0; k < n; k++) {
    const double *row = pendres_newton_sample(tape, k, c->lane);
    y[k] = row[0] + row[2] * shift[0] + row[4] * shift[1];
    w[k] = row[1] + row[3] * shift[0] + row[5] * shift[1];
  }
  out->slope = NAN;
  if (want == PENDRES_ORBIT_FREQUENCY_SLOPE) {
    if (!solve(c->m, c->by_omega, by_omega, NULL)) return PENDRES_NOT_CONVERGED;
    double sum = 0.0;
    for (size_t k = 0; k < n; k++) {
      const double *row = pendres_newton_sample(tape, k, c->lane);
      const double theta = two_pi * c->guess->period * (double)k / (double)n;
      sum += cos(theta) * (row[7] + row[3] * by_omega[0] + row[5] * by_omega[1]);
    }
    out->slope = c->guess->pendulum.drive_amplitude * two_pi * sum / (double)n;
  }
  out->dy = by_omega[0];
  out->dw = by_omega[1];
  const pendres_orbit_samples samples = {
    .n = n, .period = c->guess->period, .winding = c->guess->winding, .y = y, .w = w};
  return pendres_orbit_measure(&c->guess->pendulum, &samples, work + 2 * n, &out->measures);
}

/*
 * Error of the finer of two results. With 1.4 times the steps an order-8 method's error falls to
 * a fifteenth; a quarter of the difference is claimed, for where the order has not set in yet. A
 * measure whose two values happen to agree is not better known than the point it is measured at:
 * `point` is the point's own difference. `floor` is the rounding.
 */
static double error_of(double coarse, double fine, double point, double floor)
{
  return 0.25 * fabs(fine - coarse) + 0.08 * point + floor;
}

/* rounding: of a step, of an angle of order one. */
static void fill(const pendres_newton_candidate *c, const result *coarse, const result *fine,
                 double rounding, pendres_orbit *o)
{
  const pendres_pendulum *p = &c->guess->pendulum;
  const double omega = p->drive_frequency, q = c->guess->period;
  const pendres_orbit_measures *a = &coarse->measures, *b = &fine->measures;
  const double point = hypot(fine->y - coarse->y, fine->w - coarse->w);
  double unit[2] = {1.0, 1.0}, z[2], stretch = 1.0;

  (void)solve(fine->m, unit, z, &stretch);
  /* Rounding errors of steps add at random, and the fixed point feels them amplified by
     (I - M)^-1. */
  const double size = fmax(b->amplitude, fmax(fabs(fine->y), fabs(fine->w)));
  const double last_place = fmax(rounding * size, DBL_TRUE_MIN);
  const double floor = last_place * sqrt(c->steps * q) * fmax(1.0, stretch);

  memset(o, 0, sizeof *o);
  o->pendulum = *p;
  o->period = c->guess->period;
  o->winding = c->guess->winding;
  o->steps = c->steps;
  /* The mean angle belongs into well 0. */
  long turns = 0;
  o->mean_angle = b->mean_angle;
  pendres_strobe_wrap(&o->mean_angle, &turns);
  o->x = fine->y - two_pi * (double)turns + half_pi;
  o->v = omega * fine->w;
  o->x_error = error_of(coarse->y, fine->y, point, floor);
  o->v_error = omega * error_of(coarse->w, fine->w, point, floor);

  o->monodromy[0][0] = fine->m[0][0];
  o->monodromy[0][1] = fine->m[0][1] / omega;
  o->monodromy[1][0] = fine->m[1][0] * omega;
  o->monodromy[1][1] = fine->m[1][1];
  pendres_orbit_set_multipliers(fine->trace, exp(-p->damping * q * pi / omega), o);
  /* The trace's error moves a multiplier mu by trace' mu / (mu - other). */
  const double gap = hypot(o->multiplier_re[0] - o->multiplier_re[1],
                           o->multiplier_im[0] - o->multiplier_im[1]);
  const double trace_error = error_of(coarse->trace, fine->trace, 100.0 * point, floor);
  o->multiplier_error = fmin(trace_error * fmax(1.0, hypot(o->multiplier_re[0], o->multiplier_im[0])
                                                       / fmax(gap, 1e-300)),
                             sqrt(trace_error) + trace_error);

  o->loop_area = b->loop_area;
  o->loop_area_error =
    error_of(a->loop_area, b->loop_area, point * fabs(p->drive_amplitude),
             pi * fabs(p->drive_amplitude) * floor);
  o->dissipation = b->dissipation;
  o->dissipation_error = error_of(a->dissipation, b->dissipation, point * p->damping * omega * size,
                                  two_pi * p->damping * omega * size * floor);
  o->mean_power = o->loop_area * omega / two_pi;
  o->mean_power_error = o->loop_area_error * omega / two_pi;
  o->amplitude = b->amplitude;
  o->amplitude_error = error_of(a->amplitude, b->amplitude, point, floor);
  memcpy(o->cosine, b->cosine, sizeof o->cosine);
  memcpy(o->sine, b->sine, sizeof o->sine);
  o->first_harmonic_amplitude = hypot(b->cosine[0], b->sine[0]);
  o->first_harmonic_amplitude_error =
    error_of(hypot(a->cosine[0], a->sine[0]), o->first_harmonic_amplitude, point, floor);
  o->phase_lag = pendres_orbit_phase_lag(b->cosine[0], b->sine[0], p->drive_amplitude);
  o->phase_lag_error = error_of(pendres_orbit_phase_lag(a->cosine[0], a->sine[0],
                                                        p->drive_amplitude), o->phase_lag,
                                point / o->first_harmonic_amplitude,
                                floor / o->first_harmonic_amplitude);
  o->symmetric = o->winding == 0 && b->symmetry_defect <= 1e-7 * fmax(1.0, b->amplitude);
  o->frequency_derivative[0] = fine->dy;
  o->frequency_derivative[1] = fine->w + omega * fine->dw;
  o->loop_area_slope = fine->slope;
  /* What the point is to the other measures its derivative is to the slope. */
  const double derivative = hypot(fine->dy - coarse->dy, fine->dw - coarse->dw);
  o->loop_area_slope_error =
    error_of(coarse->slope, fine->slope, pi * fabs(p->drive_amplitude) * (derivative + point),
             fabs(p->drive_amplitude) * floor * stretch);
}

static int accurate(const pendres_orbit *o, double tolerance)
{
  /* A phase matters as much as the amplitude it belongs to. */
  return o->x_error <= tolerance && o->v_error <= tolerance && o->loop_area_error <= tolerance &&
         o->amplitude_error <= tolerance &&
         !(o->phase_lag_error * fmin(1.0, o->first_harmonic_amplitude) > tolerance);
}

/* The measures of all converged candidates at their present steps. */
static pendres_status measure_all(pendres_context *ctx, size_t n, pendres_newton_candidate *c,
                                  pendres_orbit_want want, result *results)
{
  pendres_newton_tape tape = {0};
  double *work = NULL;
  size_t work_size = 0;
  pendres_status status = PENDRES_OK;

  for (size_t first = 0, last; first < n && status == PENDRES_OK; first = last) {
    status = pendres_newton_pass(ctx, n, c, first, want, &tape, &last);
    if (status != PENDRES_OK) break;
    if (4 * tape.samples > work_size) {
      work_size = 4 * tape.samples;
      double *grown = realloc(work, work_size * sizeof *work);
      if (grown == NULL) {
        status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for samples");
        break;
      }
      work = grown;
    }
    for (size_t i = first; i < last; i++) {
      if (c[i].state != PENDRES_NEWTON_CONVERGED) continue;
      const pendres_status one = evaluate(&c[i], &tape, want, work, &results[c[i].index]);
      if (one == PENDRES_NOT_CONVERGED)
        c[i].state = PENDRES_NEWTON_FAILED;
      else if (one != PENDRES_OK)
        status = pendres_context_fail(ctx, one, "the samples of an orbit could not be measured");
    }
  }
  pendres_newton_tape_free(&tape);
  free(work);
  return status;
}

static double singularity(const double m[2][2])
{
  return (1.0 - m[0][0]) * (1.0 - m[1][1]) - m[0][1] * m[1][0];
}

/*
 * Whether there is an orbit where Newton's method has come to rest; by det (I - M) before and
 * after one more step. Beyond a fold it wanders about the ghost of the orbit that is gone:
 * where the map's defect is like z^2 + s^2, a step takes det (I - M) ~ 2 z to less than half, or
 * past zero. At an orbit, -s^2, a step leaves it as it is. The fold of the map with n steps must
 * not lie elsewhere than that with 1.4 n either, as seen from here.
 */
static int is_there(double before, double after)
{
  const double ratio = after / before;
  return ratio > 0.7 && ratio < 1.4;
}

/*
 * One Newton step with the finer map. The linearised flow moves samples to the finer map's point
 * well enough, but not their derivatives: taken at the coarser map's point, slopes would be no
 * better than its own, and the two would agree on a wrong value.
 */
static pendres_status move_to_finer_point(pendres_context *ctx, size_t n,
                                          pendres_newton_candidate *c, const result *coarse)
{
  for (size_t first = 0, last; first < n; first = last) {
    const pendres_status status =
      pendres_newton_pass(ctx, n, c, first, PENDRES_ORBIT_PLAIN, NULL, &last);
    if (status != PENDRES_OK) return status;
    for (size_t i = first; i < last; i++) {
      const pendres_newton_candidate *at = &c[i];
      const result *before = &coarse[at->index];
      double shift[2];
      if (at->state == PENDRES_NEWTON_CONVERGED &&
          is_there(singularity(before->m), singularity(at->m)) &&
          solve(at->m, at->residual, shift, NULL)) {
        c[i].y += shift[0];
        c[i].w += shift[1];
      }
    }
  }
  return PENDRES_OK;
}

/*
 * Converge, measure at n and at 1.4 n steps; candidates are sorted in place. What is a ghost, or
 * too close to one to tell, is PENDRES_NOT_CONVERGED with its state left at converged.
 */
static pendres_status refine_once(pendres_context *ctx, size_t n, pendres_newton_candidate *c,
                                  pendres_orbit_want want, result *coarse, result *fine,
                                  pendres_orbit *out, pendres_status *outcome)
{
  /* Periodic orbits keep below what the worst of pendulums round. */
  const double rounding = 0.27 * pendres_strobe_noise_of_step(ctx->options.table);
  pendres_status status = pendres_newton_converge(ctx, n, c);
  if (status == PENDRES_OK) status = measure_all(ctx, n, c, want, coarse);
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < n; i++) {
    if (c[i].state != PENDRES_NEWTON_CONVERGED) continue;
    c[i].y = coarse[c[i].index].y;
    c[i].w = coarse[c[i].index].w;
    c[i].steps = pendres_steps_rung((int)ceil(1.4 * c[i].steps));
  }
  if (want == PENDRES_ORBIT_FREQUENCY_SLOPE) status = move_to_finer_point(ctx, n, c, coarse);
  if (status == PENDRES_OK) status = measure_all(ctx, n, c, want, fine);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    const size_t k = c[i].index;
    if (c[i].state != PENDRES_NEWTON_CONVERGED) {
      outcome[k] = PENDRES_NOT_CONVERGED;
      continue;
    }
    const result *first = &coarse[k], *second = &fine[k];
    if (!is_there(singularity(first->m), singularity(second->m))) {
      outcome[k] = PENDRES_NOT_CONVERGED;
      continue;
    }
    fill(&c[i], first, second, rounding, &out[k]);
    outcome[k] =
      accurate(&out[k], ctx->options.tolerance) ? PENDRES_OK : PENDRES_TOLERANCE_UNREACHABLE;
  }
  return status;
}

static pendres_status start(pendres_context *ctx, size_t n, const pendres_orbit_guess *guess,
                            pendres_newton_candidate *c)
{
  for (size_t i = 0; i < n; i++) {
    const pendres_orbit_guess *g = &guess[i];
    const char *why = NULL;
    if (pendres_pendulum_check(&g->pendulum, &why) == PENDRES_OK) {
      why = pendres_strobe_refuses(&g->pendulum, g->x, g->v);
      if (g->period < 1) why = "a guess needs a period of at least 1";
    }
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "guess %zu: %s", i, why);
    c[i] = (pendres_newton_candidate){.guess = g,
                                      .index = i,
                                      .w = g->v / g->pendulum.drive_frequency};
    long turns = 0;
    pendres_strobe_angle(g->x, &c[i].y, &turns);
    /* The probes of the choice are harder than an orbit: start there, the orbit's own two runs
       tell whether it was enough. */
    const pendres_status status = pendres_steps_choose(ctx, &g->pendulum, fabs(g->v),
                                                       10.0 * ctx->options.tolerance, &c[i].steps);
    if (status != PENDRES_OK) return status;
  }
  return PENDRES_OK;
}

static pendres_status orbit_refine(pendres_context *ctx, size_t n, const pendres_orbit_guess *guess,
                                   pendres_orbit_want want, pendres_orbit *out,
                                   pendres_status *outcome)
{
  enum { MOST_TRIES = 4 };
  if (n > 0 && (guess == NULL || out == NULL || outcome == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "guess, out and outcome");
  if (n == 0) return PENDRES_OK;

  pendres_status status = PENDRES_OK;
  pendres_newton_candidate *c = malloc(n * sizeof *c);
  result *coarse = malloc(n * sizeof *coarse), *fine = malloc(n * sizeof *fine);
  if (c == NULL || coarse == NULL || fine == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu orbits", n);
    goto done;
  }
  status = start(ctx, n, guess, c);
  size_t left = n;
  for (int attempt = 0; attempt < MOST_TRIES && left > 0 && status == PENDRES_OK; attempt++) {
    status = refine_once(ctx, left, c, want, coarse, fine, out, outcome);
    /* What missed the tolerance, or could not be told from a ghost, goes on from where it is, with
       more steps. */
    size_t again = 0;
    for (size_t i = 0; i < left && status == PENDRES_OK; i++)
      if (outcome[c[i].index] != PENDRES_OK && c[i].state == PENDRES_NEWTON_CONVERGED &&
          ctx->options.steps_per_period == 0)
        c[again++] = c[i];
    left = again;
  }
done:
  free(c);
  free(coarse);
  free(fine);
  return status;
}

pendres_status pendres_orbit_refine(pendres_context *ctx, size_t n,
                                    const pendres_orbit_guess *guess, pendres_orbit_want want,
                                    pendres_orbit *out, pendres_status *outcome)
{
  return PENDRES_CONTEXT_CALL(ctx, orbit_refine(ctx, n, guess, want, out, outcome));
}

typedef struct sampling {
  double *y, *w;
} sampling;

static void keep_sample(void *arg, int step, double theta, size_t stride, const double *state)
{
  sampling *s = arg;
  (void)theta;
  s->y[step] = state[0];
  s->w[step] = state[stride];
}

static pendres_status orbit_sample(pendres_context *ctx, const pendres_orbit *orbit, int count,
                                   double *x, double *v)
{
  pendres_flow *flow = NULL;
  if (orbit == NULL) return PENDRES_CONTEXT_NULL(ctx, "orbit");
  if (count < 1 || orbit->steps < 1 || orbit->period < 1)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "samples of an orbit: one at least, and an orbit that closes");
  const int q = orbit->period, steps = orbit->steps;
  const size_t n = (size_t)q * (size_t)steps, points = (size_t)q * (size_t)count;
  pendres_status status = pendres_context_flow(ctx, PENDRES_FLOW_STATE, &flow);
  if (status != PENDRES_OK) return status;

  double *memory = malloc((3 * n + 2 + points) * sizeof *memory);
  if (memory == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu samples", n);
  double *y = memory, *w = y + n + 1, *work = w + n + 1, *value = work + n;
  const double omega = orbit->pendulum.drive_frequency;

  y[0] = orbit->x - half_pi;
  w[0] = orbit->v / omega;
  pendres_flow_resize(flow, 1);
  pendres_flow_set_lane(flow, 0, &orbit->pendulum, y[0], w[0]);
  status = pendres_flow_set_steps(flow, steps);
  for (int k = 0; k < q && status == PENDRES_OK; k++) {
    sampling s = {.y = y + (size_t)k * (size_t)steps, .w = w + (size_t)k * (size_t)steps};
    status = pendres_flow_period_sampled(flow, keep_sample, &s);
    ctx->cost.pendulum_periods += 1.0;
  }
  if (status != PENDRES_OK) {
    status = pendres_context_flow_failed(ctx, flow, status);
    goto done;
  }
  /* The drift of a running orbit is taken out for the series and put back. */
  const double drift = two_pi * orbit->winding;
  for (size_t k = 0; k < n; k++) y[k] -= drift * (double)k / (double)n;
  if (x != NULL) {
    status = pendres_orbit_interpolate(y, n, points, work, value);
    for (size_t k = 0; k < points; k++)
      x[k] = value[k] + half_pi + drift * (double)k / (double)points;
  }
  if (v != NULL && status == PENDRES_OK) {
    status = pendres_orbit_interpolate(w, n, points, work, value);
    for (size_t k = 0; k < points; k++) v[k] = omega * value[k];
  }
  if (status != PENDRES_OK)
    status = pendres_context_fail(ctx, status, "the samples of an orbit could not be transformed");
done:
  free(memory);
  return status;
}

pendres_status pendres_orbit_sample(pendres_context *ctx, const pendres_orbit *orbit, int count,
                                    double *x, double *v)
{
  return PENDRES_CONTEXT_CALL(ctx, orbit_sample(ctx, orbit, count, x, v));
}
