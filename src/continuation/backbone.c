/*
 * backbone.c -- where the response lags a quarter of a turn; see continuation.h.
 *
 * At a lag of pi/2 the drive puts in pi F0 R_1 a cycle, R_1 the first harmonic, and friction takes
 * out pi gamma omega sum n^2 R_n^2. Where the two are equal for a free oscillation, the search
 * starts: off by the square of the damping only, and a fold is hardly further away.
 */
#include <pendres/continuation.h>

#include <math.h>
#include <stdlib.h>

#include <pendres/free.h>

#include "base/angles.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "continuation/units.h"

enum { MOST_ITERATIONS = 30 };

/* A pendulum whose frequency is sought, by the secant method for the lag over the frequency. */
typedef struct search {
  int trials;                    /* so far */
  double omega, before;          /* frequencies of this and the last trial */
  double off, off_before;        /* lag - pi/2 there */
  pendres_orbit_guess guess;
  pendres_orbit *out;            /* where its result goes */
  double *error;                 /* may be NULL */
  pendres_status *outcome;
} search;

/*
 * Drive over damping that a free oscillation of amplitude a asks for: omega sum n^2 R_n^2 / R_1
 * with its harmonics R_n = 8 q^(n/2) / (n (1 + q^n)), n odd, q the nome of k = sin(a / 2).
 */
static double balance(double a)
{
  const double omega = pendres_free_frequency(a);
  const double q = exp(-pi * omega / pendres_free_frequency(pi - a));
  const double first = 8.0 * sqrt(q) / (1.0 + q);
  double sum = 0.0;
  for (int n = 1; n < 40; n += 2) {
    const double part = 8.0 * pow(q, 0.5 * n) / (1.0 + pow(q, n)); /* n R_n */
    sum += part * part;
  }
  return omega * sum / first;
}

/* Amplitude below pi at which the drive meets friction, or NaN. */
static double start_amplitude(const pendres_pendulum *p)
{
  /* What is asked for grows up to a >= 2 and falls towards the top: the lower root is meant. */
  double low = 0.0, high = 0.0, best = 0.0;
  for (double a = 0.05; a < 3.14; a += 0.05) {
    const double asked = balance(a);
    if (asked > best) {
      best = asked;
      high = a;
    }
  }
  const double wanted = p->drive_amplitude / p->damping;
  if (!(wanted < best)) return NAN;
  for (int i = 0; i < 60; i++) {
    const double middle = 0.5 * (low + high);
    if (balance(middle) < wanted)
      low = middle;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

static void finish(const pendres_context *ctx, const search *s, const pendres_orbit *o,
                   pendres_status refined)
{
  /* The slope of the lag over the frequency turns the error of the lag into that of the other. */
  const double slope = (s->off - s->off_before) / (s->omega - s->before);
  const double e = fabs(s->off / slope) + fabs(o->phase_lag_error / slope);
  const int good = refined == PENDRES_OK && e <= ctx->options.tolerance;
  *s->out = *o;
  if (s->error != NULL) *s->error = e;
  *s->outcome = good ? PENDRES_OK : PENDRES_TOLERANCE_UNREACHABLE;
}

/* Take over a trial's orbit. Returns 1 when the search is over. */
static int improve(const pendres_context *ctx, search *s, const pendres_orbit *o,
                   pendres_status refined)
{
  const int trial = s->trials++;
  if (refined == PENDRES_NOT_CONVERGED || s->trials == MOST_ITERATIONS) return 1;
  const double omega = o->pendulum.drive_frequency;
  s->off_before = s->off;
  s->off = o->phase_lag - half_pi;
  if (trial > 0 &&
      fabs(s->off) <= pendres_accuracy_negligible(ctx) + 2.0 * o->phase_lag_error) {
    finish(ctx, s, o, refined);
    return 1;
  }
  /* The first step goes a little way; the lag grows with the frequency. */
  double next = trial == 0 ? omega - copysign(fmin(1e-3, 0.1 * fabs(s->off) + 1e-7), s->off)
                           : omega - s->off * (omega - s->before) / (s->off - s->off_before);
  if (!(fabs(next - omega) < 0.1)) next = omega - copysign(0.1, s->off);
  if (!(next > 0.0)) return 1;
  s->before = omega;
  s->omega = next;
  s->guess.pendulum.drive_frequency = next;
  s->guess.x = o->x;
  s->guess.v = o->v;
  return 0;
}

static size_t begin(size_t n, const pendres_pendulum *pendulums, const search *into, search *s)
{
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    pendres_pendulum p = pendulums[i];
    const double a = start_amplitude(&p);
    const search to = {.out = into->out + i,
                       .error = into->error != NULL ? into->error + i : NULL,
                       .outcome = into->outcome + i};
    *to.outcome = PENDRES_NOT_FOUND;
    if (to.error != NULL) *to.error = NAN;
    if (isnan(a)) continue;
    p.drive_frequency = pendres_free_frequency(a);
    s[count] = to;
    s[count].omega = p.drive_frequency;
    /* y goes as sin(theta): through its well with the speed of its energy. */
    s[count++].guess =
      (pendres_orbit_guess){.pendulum = p, .x = half_pi, .v = 2.0 * sin(0.5 * a), .period = 1};
  }
  return count;
}

static pendres_status backbone_find(pendres_context *ctx, size_t n,
                                    const pendres_pendulum *pendulums, pendres_orbit *out,
                                    double *frequency_error, pendres_status *outcome)
{
  if (n > 0 && (pendulums == NULL || out == NULL || outcome == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "pendulums, out and outcome");
  for (size_t i = 0; i < n; i++)
    if (!(pendulums[i].temperature >= 0.0 && pendulums[i].damping < 1e15 &&
          pendulums[i].drive_amplitude < 1e15 && pendulums[i].damping > 0.0 &&
          pendulums[i].drive_amplitude > 0.0 &&
          isfinite(pendulums[i].damping) && isfinite(pendulums[i].drive_amplitude)))
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                  "pendulum %zu: a backbone needs damping and drive", i);
  pendres_status status = PENDRES_OK;
  search *s = calloc(n + 1, sizeof *s);
  pendres_orbit_guess *guess = calloc(n + 1, sizeof *guess);
  pendres_orbit *orbit = malloc((n + 1) * sizeof *orbit);
  pendres_status *refined = malloc((n + 1) * sizeof *refined);
  if (s == NULL || guess == NULL || orbit == NULL || refined == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu orbits", n);
    goto done;
  }
  const search into = {.out = out, .error = frequency_error, .outcome = outcome};
  for (size_t left = begin(n, pendulums, &into, s), again = 0; left > 0 && status == PENDRES_OK;
       left = again) {
    again = 0;
    for (size_t i = 0; i < left; i++) guess[i] = s[i].guess;
    status = pendres_orbit_find(ctx, left, guess, PENDRES_ORBIT_PLAIN, orbit, refined);
    for (size_t i = 0; i < left && status == PENDRES_OK; i++)
      if (!improve(ctx, &s[i], &orbit[i], refined[i])) s[again++] = s[i];
  }
done:
  free(s);
  free(guess);
  free(orbit);
  free(refined);
  return status;
}

pendres_status pendres_backbone_find(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums, pendres_orbit *out,
                                     double *frequency_error, pendres_status *outcome)
{
  pendres_door d;
  pendres_door_open_many(&d, ctx, n, pendulums, sizeof *pendulums);
  while (pendres_door_next(&d)) {
    const size_t i = d.first, m = d.count;
    const pendres_pendulum *p =
      pendres_door_in(&d, &pendres_dim_pendulum, m, PENDRES_DOOR_AT(pendulums, i));
    pendres_orbit *o = pendres_door_out(&d, &pendres_dim_orbit, m, PENDRES_DOOR_AT(out, i));
    double *e =
      pendres_door_out(&d, &pendres_dim_frequency, m, PENDRES_DOOR_AT(frequency_error, i));
    PENDRES_DOOR_CALL(&d, backbone_find(ctx, m, p, o, e, PENDRES_DOOR_AT(outcome, i)));
  }
  return pendres_door_close(&d);
}
