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

enum { BATCH = 256, LONGEST = 8 /* periods */, HOW = 400 };

/* One item: what was drawn, found and is true. */
typedef struct item {
  pendres_orbit_guess guess;
  double tolerance;
  pendres_orbit_want want;
  int there;  /* an orbit was found, and the reference has one beside it */
  int false_; /* the library found one where the reference has none */
  pendres_orbit orbit;
  pendres_reference_cycle exact;
} item;

static pendres_context *context_with(double tolerance)
{
  pendres_context *ctx = NULL;
  const pendres_options options = {.tolerance = tolerance, .block_lanes = 8};
  return pendres_context_create(&options, &ctx) == PENDRES_OK ? ctx : NULL;
}

/* The shortest return of a settled pendulum within LONGEST periods: 1 if it closes. */
static int settled_guess(pendres_context *ctx, accuracy_random *r, pendres_orbit_guess *g)
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
      if (!settled_guess(ctx, r, &t->guess)) t->guess.period = 0;
    } else {
      t->guess.x = accuracy_uniform(r, -3.0, 3.0);
      t->guess.v = accuracy_uniform(r, -2.0, 2.0);
      t->guess.period = 1 + accuracy_choice(r, 2) * accuracy_choice(r, 5);
      t->guess.winding = accuracy_choice(r, 3) == 0 ? accuracy_choice(r, 3) - 1 : 0;
    }
  }
  pendres_context_free(ctx);
}

static void compute(item *t)
{
  pendres_context *ctx = context_with(t->tolerance);
  pendres_status outcome = PENDRES_NOT_CONVERGED;
  const pendres_orbit_guess *g = &t->guess;
  if (ctx != NULL && g->period > 0 &&
      pendres_orbit_refine(ctx, 1, g, t->want, &t->orbit, &outcome) == PENDRES_OK &&
      outcome != PENDRES_NOT_CONVERGED) {
    const pendres_status status = pendres_reference_orbit(
      &g->pendulum, t->orbit.x - half_pi, t->orbit.v, g->period, g->winding, &t->exact);
    t->there = status == PENDRES_OK;
    t->false_ = status == PENDRES_NOT_CONVERGED;
  }
  pendres_context_free(ctx);
}

/* Of the two pairs, the farther: as they are ordered, or the other way round. */
static double multipliers_apart(const pendres_orbit *o, const pendres_reference_cycle *e)
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

static void note(accuracy *a, const item *t, long number)
{
  const pendres_orbit *o = &t->orbit;
  const pendres_reference_cycle *e = &t->exact;
  const pendres_pendulum *p = &o->pendulum;
  char how[HOW];
  snprintf(how, sizeof how,
           "item %ld: F0 %.17g, damping %.17g, frequency %.17g, q %d, winding %d, x %.17g, v %.17g,"
           " tolerance %.17g",
           number, p->drive_amplitude, p->damping, p->drive_frequency, t->guess.period,
           t->guess.winding, t->guess.x, t->guess.v, t->tolerance);
  const double turn = rint((double)((o->x - half_pi) - e->y) / two_pi) * two_pi;
  accuracy_note(a, "x", o->x - turn, o->x_error, e->y + half_pi, how);
  accuracy_note(a, "v", o->v, o->v_error, e->v, how);
  accuracy_note(a, "loop area", o->loop_area, o->loop_area_error, e->loop_area, how);
  accuracy_note(a, "dissipation", o->dissipation, o->dissipation_error, e->dissipation, how);
  accuracy_note(a, "mean power", o->mean_power, o->mean_power_error, e->mean_power, how);
  accuracy_note(a, "amplitude", o->amplitude, o->amplitude_error, e->amplitude, how);
  accuracy_note(a, "first harmonic", o->first_harmonic_amplitude, o->first_harmonic_amplitude_error,
                e->first_harmonic_amplitude, how);
  accuracy_note_error(a, "phase lag",
                      fabs(remainder((double)(o->phase_lag - e->phase_lag), two_pi)),
                      o->phase_lag_error, how);
  if (t->want == PENDRES_ORBIT_PLAIN) {
    accuracy_note_error(a, "multipliers", multipliers_apart(o, e), o->multiplier_error, how);
    return;
  }
  accuracy_note_error(a, "multipliers, with slopes", multipliers_apart(o, e), o->multiplier_error,
                      how);
  accuracy_note(a, "slope of the loop area", o->loop_area_slope, o->loop_area_slope_error,
                e->loop_area_slope, how);
}

void accuracy_orbits(accuracy *a)
{
  long first, last;
  accuracy_range(a, accuracy_get_options(a)->orbits, &first, &last);
  item *items = calloc(BATCH, sizeof *items);
  if (items == NULL) {
    accuracy_complain(a, "out of memory", "");
    return;
  }
  for (long base = first; base < last; base += BATCH) {
    const long n = last - base < BATCH ? last - base : BATCH;
#pragma omp parallel for schedule(dynamic)
    for (long i = 0; i < n; i++) {
      accuracy_random r = accuracy_item(a, base + i);
      items[i] = (item){0};
      draw(&r, &items[i]);
      compute(&items[i]);
    }
    for (long i = 0; i < n; i++) {
      const item *t = &items[i];
      char how[HOW];
      snprintf(how, sizeof how, "item %ld", base + i);
      if (t->there) note(a, t, base + i);
      if (t->false_) accuracy_complain(a, "an orbit where the reference has none", how);
    }
  }
  free(items);
}
