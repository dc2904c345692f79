/*
 * accuracy_orbits.c -- closed orbits and their measures against the extended-precision reference.
 *
 * Two of three orbits are what random starts settle on, of whatever period and winding; the third
 * is where Newton's method leads from anywhere: mostly unstable ones. What is true is the
 * reference's orbit next to the library's result.
 */
#include "accuracy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double two_pi = 6.28318530717958647693;
static const double half_pi = 1.57079632679489661923;

enum { LONGEST = 8 /* periods */, HOW = 400 };

/* One item: what was drawn, found and is true. */
typedef struct item {
  pendres_orbit_guess guess;
  double tolerance;
  pendres_orbit_want want;
  int closes; /* the guess is a point of what it settles on */
  int there;  /* an orbit was found, and the reference has one beside it */
  int false_; /* the library found one where the reference has none */
  pendres_orbit orbit;
  reference_cycle exact;
  int settled; /* the attractor below is a closed orbit, and the reference has it */
  pendres_attractor attractor;
  reference_cycle of_attractor;
} item;

static pendres_context *context_with(double tolerance)
{
  pendres_context *ctx = NULL;
  const pendres_options options = {.tolerance = tolerance, .block_lanes = 8};
  return pendres_context_create(&options, &ctx) == PENDRES_OK ? ctx : NULL;
}

int accuracy_settled_guess(pendres_context *ctx, accuracy_random *r, pendres_orbit_guess *g)
{
  const pendres_pendulum *p = &g->pendulum;
  const double wait = fmin(4000.0, 10.0 + 12.0 * p->drive_frequency / (two_pi * p->damping));
  double x[LONGEST + 1], v[LONGEST + 1];
  x[0] = accuracy_uniform(r, -3.0, 3.0);
  v[0] = accuracy_uniform(r, -2.0, 2.0);
  if (pendres_strobe_advance(ctx, 1, p, x, v, (long)wait * 4, NULL) != PENDRES_OK) return 0;
  for (int k = 1; k <= LONGEST; k++) {
    x[k] = x[k - 1];
    v[k] = v[k - 1];
    if (pendres_strobe_advance(ctx, 1, p, &x[k], &v[k], 1, NULL) != PENDRES_OK) return 0;
    const double turns = rint((x[k] - x[0]) / two_pi);
    if (hypot(x[k] - x[0] - two_pi * turns, v[k] - v[0]) > 1e-2) continue;
    g->x = x[0];
    g->v = v[0];
    g->period = k;
    g->winding = (int)turns;
    return 1;
  }
  return 0;
}

static void draw(accuracy_random *r, item *t)
{
  pendres_context *ctx = context_with(1e-6);
  if (ctx == NULL) return;
  t->guess.period = 0;
  for (int attempt = 0; attempt < 20 && t->guess.period == 0; attempt++) {
    t->guess.pendulum = accuracy_pendulum(r);
    t->tolerance = accuracy_tolerance(r);
    t->want = accuracy_choice(r, 2) ? PENDRES_ORBIT_FREQUENCY_SLOPE : PENDRES_ORBIT_PLAIN;
    if (accuracy_choice(r, 3) < 2) {
      t->closes = accuracy_settled_guess(ctx, r, &t->guess);
      if (!t->closes) t->guess.period = 0;
    } else {
      t->guess.x = accuracy_uniform(r, -3.0, 3.0);
      t->guess.v = accuracy_uniform(r, -2.0, 2.0);
      t->guess.period = 1 + accuracy_choice(r, 2) * accuracy_choice(r, 5);
      t->guess.winding = accuracy_choice(r, 3) == 0 ? accuracy_choice(r, 3) - 1 : 0;
    }
  }
  pendres_context_free(ctx);
}

/* What the guess settles on; chaos takes long, and is not asked for. */
static void settle(pendres_context *ctx, item *t)
{
  const pendres_orbit_guess *g = &t->guess;
  pendres_settled outcome;
  pendres_attractors *found = NULL;
  if (pendres_settle(ctx, 1, &g->pendulum, &g->x, &g->v, &outcome, &found) == PENDRES_OK &&
      outcome.attractor >= 0) {
    t->attractor = *pendres_attractors_get(found, (size_t)outcome.attractor);
    const pendres_orbit *o = &t->attractor.orbit;
    t->settled = t->attractor.label != PENDRES_LABEL_CHAOTIC &&
                 reference_orbit(&g->pendulum, o->x - half_pi, o->v, o->period, o->winding,
                                         &t->of_attractor) == PENDRES_OK;
  }
  pendres_attractors_free(found);
}

/* Every fourth is settled as well. */
static void compute(accuracy_random *r, void *of, long number)
{
  item *t = of;
  draw(r, t);
  pendres_context *ctx = context_with(t->tolerance);
  pendres_status outcome = PENDRES_NOT_CONVERGED;
  const pendres_orbit_guess *g = &t->guess;
  if (ctx != NULL && g->period > 0 &&
      pendres_orbit_find(ctx, 1, g, t->want, &t->orbit, &outcome) == PENDRES_OK &&
      outcome != PENDRES_NOT_CONVERGED) {
    const pendres_status status = reference_orbit(
      &g->pendulum, t->orbit.x - half_pi, t->orbit.v, g->period, g->winding, &t->exact);
    t->there = status == PENDRES_OK;
    t->false_ = status == PENDRES_NOT_CONVERGED;
  }
  if (ctx != NULL && number % 4 == 0 && t->closes) settle(ctx, t);
  pendres_context_free(ctx);
}

double accuracy_multipliers_apart(const pendres_orbit *o, const reference_cycle *e)
{
  double apart[2] = {0.0, 0.0};
  for (int swap = 0; swap < 2; swap++)
    for (int i = 0; i < 2; i++) {
      const int j = i ^ swap;
      apart[swap] = fmax(apart[swap],
                         (double)hypotl(o->multiplier_re[i] - e->multiplier_re[j],
                                        o->multiplier_im[i] - e->multiplier_im[j]));
    }
  return fmin(apart[0], apart[1]);
}

/* The exponent is the larger multiplier's logarithm in time. */
static void note_attractor(accuracy *a, const item *t, const char *how)
{
  const reference_cycle *e = &t->of_attractor;
  const long double time = two_pi * (long double)e->period / e->drive_frequency;
  const long double exponent =
    logl(hypotl(e->multiplier_re[0], e->multiplier_im[0])) / time;
  accuracy_note(a, "Lyapunov exponent", t->attractor.lyapunov, t->attractor.lyapunov_error,
                exponent, how);
  accuracy_note(a, "loop area of an attractor", t->attractor.orbit.loop_area,
                t->attractor.orbit.loop_area_error, e->loop_area, how);
  accuracy_note(a, "amplitude of an attractor", t->attractor.orbit.amplitude,
                t->attractor.orbit.amplitude_error, e->amplitude, how);
}

/* Points along the orbit, at drive phase 0 as far as the reference goes. */
static void note_samples(accuracy *a, const item *t, const char *how)
{
  enum { MOST = 8 };
  const pendres_orbit *o = &t->orbit;
  double x[MOST], v[MOST], error[2] = {INFINITY, INFINITY}, off[2] = {0.0, 0.0};
  pendres_context *ctx = context_with(t->tolerance);
  if (ctx != NULL && o->period <= MOST && o->period > 1 &&
      pendres_orbit_sample(ctx, o, 1, x, v, error) == PENDRES_OK) {
    for (int k = 0; k < o->period; k++) {
      long double y = t->exact.y, w = t->exact.v;
      if (reference_advance(&o->pendulum, &y, &w, NULL, k) != PENDRES_OK) continue;
      const double turn = rint((double)((x[k] - half_pi) - y) / two_pi) * two_pi;
      off[0] = fmax(off[0], (double)fabsl(x[k] - turn - half_pi - y));
      off[1] = fmax(off[1], (double)fabsl(v[k] - w));
    }
    accuracy_note_error(a, "x of samples", off[0], error[0], how);
    accuracy_note_error(a, "v of samples", off[1], error[1], how);
  }
  pendres_context_free(ctx);
}

void accuracy_note_orbit(accuracy *a, const pendres_orbit *o, const reference_cycle *e,
                         const char *how)
{
  accuracy_note(a, "v", o->v, o->v_error, e->v, how);
  accuracy_note(a, "dissipation", o->dissipation, o->dissipation_error, e->dissipation, how);
  accuracy_note(a, "amplitude", o->amplitude, o->amplitude_error, e->amplitude, how);
  accuracy_note(a, "first harmonic", o->first_harmonic_amplitude, o->first_harmonic_amplitude_error,
                e->first_harmonic_amplitude, how);
  if (o->pendulum.drive_amplitude == 0.0) { /* all of these are known exactly */
    if (o->loop_area != 0.0 || o->mean_power != 0.0)
      accuracy_complain(a, "no drive, and a loop area", how);
    return;
  }
  accuracy_note(a, "loop area", o->loop_area, o->loop_area_error, e->loop_area, how);
  accuracy_note(a, "mean power", o->mean_power, o->mean_power_error, e->mean_power, how);
  accuracy_note_error(a, "phase lag",
                      fabs(remainder((double)(o->phase_lag - e->phase_lag), two_pi)),
                      o->phase_lag_error, how);
}

static void note(accuracy *a, const void *of, long number, void *tally)
{
  const item *t = of;
  const pendres_orbit *o = &t->orbit;
  const reference_cycle *e = &t->exact;
  const pendres_pendulum *p = &t->guess.pendulum;
  char how[HOW];
  (void)tally;
  snprintf(how, sizeof how,
           "item %ld: F0 %.17g, damping %.17g, frequency %.17g, q %d, winding %d, x %.17g, v %.17g,"
           " tolerance %.17g",
           number, p->drive_amplitude, p->damping, p->drive_frequency, t->guess.period,
           t->guess.winding, t->guess.x, t->guess.v, t->tolerance);
  if (t->false_) accuracy_complain(a, "an orbit where the reference has none", how);
  if (t->settled) note_attractor(a, t, how);
  if (!t->there) return;
  note_samples(a, t, how);
  const double turn = rint((double)((o->x - half_pi) - e->y) / two_pi) * two_pi;
  accuracy_note(a, "x", o->x - turn, o->x_error, e->y + half_pi, how);
  accuracy_note_orbit(a, o, e, how);
  const int plain = t->want == PENDRES_ORBIT_PLAIN;
  accuracy_note_error(a, plain ? "multipliers" : "multipliers, with slopes",
                      accuracy_multipliers_apart(o, e), o->multiplier_error, how);
  if (plain) return;
  accuracy_note(a, "slope of the loop area", o->loop_area_slope, o->loop_area_slope_error,
                e->loop_area_slope, how);
}

void accuracy_orbits(accuracy *a)
{
  accuracy_each(a, &(accuracy_work){.items = accuracy_get_options(a)->orbits, .at_once = 256,
                                    .size = sizeof(item), .compute = compute, .note = note});
}
