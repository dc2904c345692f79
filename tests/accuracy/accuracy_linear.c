/*
 * accuracy_linear.c -- linear forces, in any units, of quality 0.3 to 100,000, with and without a
 * drive, against their closed form.
 *
 * x'' + damping x' + a1 x = torque + F0 cos(w t) has the one orbit
 * torque/a1 + A cos(w t - lag), A = F0/|a1 - w^2 + i damping w|, and the multipliers
 * exp(r 2 pi / w) with r^2 + damping r + a1 = 0 (Landau and Lifshitz, Mechanics, section 26).
 */
#include "accuracy.h"

#include <math.h>
#include <stdio.h>

static const long double two_pi = 6.28318530717958647692528676655900577L;

enum { HOW = 400 };

typedef struct item {
  pendres_orbit_guess guess;
  double tolerance;
  accuracy_units units;
  int there;
  pendres_orbit orbit;
  reference_cycle exact;
  long periods;
  double claim;          /* of the pendulum that was advanced, a length, */
  long double off;       /* and what it is off by: velocities count by its unit of time */
} item;

static void draw(accuracy_random *r, item *t)
{
  pendres_pendulum *p = &t->guess.pendulum;
  const double w0 = accuracy_uniform(r, 0.5, 1.5);
  *p = (pendres_pendulum){.force = PENDRES_FORCE_POLYNOMIAL};
  p->force_coefficients[0] = w0 * w0;
  p->damping = w0 / accuracy_logarithmic(r, 0.3, 1e5);
  p->drive_frequency = accuracy_choice(r, 2) ? accuracy_logarithmic(r, 0.1, 3.0)
                                             : w0 + p->damping * accuracy_uniform(r, -2.0, 2.0);
  if (!(p->drive_frequency > 0.1)) p->drive_frequency = w0;
  if (accuracy_choice(r, 4) > 0)
    p->drive_amplitude = accuracy_logarithmic(r, 0.01, 1.5) * fmin(1.0, p->damping);
  if (accuracy_choice(r, 2)) p->torque = accuracy_uniform(r, -1.0, 1.0);
  /* Where nothing else is, drive and torque tell what is long: starts are as far out as they lead,
     and tolerances fractions of it. */
  double far = (fabs(p->drive_amplitude) + fabs(p->torque)) / (w0 * w0);
  t->units = accuracy_draw_units(r);
  if (far == 0.0) far = t->units.length = 1.0; /* at rest all lengths are alike */
  t->tolerance = accuracy_tolerance(r) * far;
  *p = accuracy_in_units(p, t->units);
  t->guess.x = far * accuracy_uniform(r, -2.0, 2.0) / t->units.length;
  t->guess.v = far * accuracy_uniform(r, -2.0, 2.0) / (t->units.length / t->units.time);
  t->guess.period = 1;
  t->periods = (long)accuracy_logarithmic(r, 1.0, 41.0);
}

/* The multipliers, and the exponents where these are real: r1, r2 or -damping/2 +- i r2. */
static void multipliers(const pendres_pendulum *p, reference_cycle *e)
{
  const long double a = p->force_coefficients[0], half = 0.5L * p->damping;
  const long double time = two_pi / p->drive_frequency, root = half * half - a;
  if (root < 0.0L) {
    const long double size = expl(-half * time), angle = sqrtl(-root) * time;
    for (int i = 0; i < 2; i++) {
      e->multiplier_re[i] = size * cosl(angle);
      e->multiplier_im[i] = (i == 0 ? size : -size) * sinl(angle);
    }
    return;
  }
  const long double fast = half + sqrtl(root);
  e->multiplier_re[0] = expl(-a / fast * time);
  e->multiplier_re[1] = expl(-fast * time);
}

void accuracy_linear_exact(const pendres_pendulum *p, reference_cycle *e)
{
  const long double a = p->force_coefficients[0], w = p->drive_frequency, f = p->drive_amplitude;
  const long double stiff = a - w * w, friction = p->damping * w;
  const long double square = stiff * stiff + friction * friction, size = f / sqrtl(square);
  *e = (reference_cycle){.amplitude = size, .first_harmonic_amplitude = size};
  e->y = p->torque / a + size * (stiff / sqrtl(square));
  e->v = size * w * (friction / sqrtl(square));
  e->phase_lag = atan2l(friction, stiff);
  e->loop_area = e->dissipation = 0.5L * two_pi * f * f * friction / square;
  e->mean_power = e->loop_area * w / two_pi;
  const long double square_slope = 2.0L * p->damping * friction - 4.0L * w * stiff;
  e->loop_area_slope = e->loop_area * (1.0L / w - square_slope / square);
  multipliers(p, e);
}

/* How far x, v is from where the start goes in so many periods: the orbit, and what of the start's
   distance from it is left. */
static long double off_by(const item *t, double x, double v)
{
  const pendres_pendulum *p = &t->orbit.pendulum;
  const reference_cycle *e = &t->exact;
  const accuracy_units u = accuracy_near_units(t->units);
  const long double half = 0.5L * p->damping, a = p->force_coefficients[0];
  const long double time = two_pi * t->periods / p->drive_frequency, root = half * half - a;
  const long double y0 = (long double)t->guess.x * u.length - e->y;
  const long double v0 = (long double)t->guess.v * (u.length / u.time) - e->v;
  const long double rate = sqrtl(fabsl(root)), size = expl(-half * time);
  const long double c = root < 0.0L ? cosl(rate * time) : coshl(rate * time);
  const long double s = (root < 0.0L ? sinl(rate * time) : sinhl(rate * time)) / rate;
  const long double y = size * (y0 * c + (v0 + half * y0) * s);
  const long double w = size * (v0 * c - (a * y0 + half * v0) * s);
  const double unit = pendres_units_of(&t->guess.pendulum).time * u.time;
  return fmaxl(fabsl((long double)x * u.length - e->y - y),
               fabsl((long double)v * (u.length / u.time) - e->v - w) * unit);
}

static void compute(accuracy_random *r, void *of, long number)
{
  item *t = of;
  pendres_context *ctx = NULL;
  pendres_status outcome = PENDRES_NOT_CONVERGED;
  (void)number;
  draw(r, t);
  const accuracy_units u = accuracy_near_units(t->units);
  const pendres_options options = {.tolerance = t->tolerance / t->units.length, .block_lanes = 8};
  double x = t->guess.x, v = t->guess.v;
  pendres_status status = pendres_context_create(&options, &ctx);
  if (status == PENDRES_OK)
    status = pendres_orbit_find(ctx, 1, &t->guess, PENDRES_ORBIT_FREQUENCY_SLOPE, &t->orbit,
                                &outcome);
  if (status == PENDRES_OK && outcome != PENDRES_NOT_CONVERGED)
    status = pendres_strobe_advance(ctx, 1, &t->guess.pendulum, &x, &v, t->periods, &t->claim);
  pendres_context_free(ctx);
  t->there = status == PENDRES_OK && outcome != PENDRES_NOT_CONVERGED;
  if (!t->there) return;
  t->orbit = accuracy_out_of_units(&t->orbit, u);
  accuracy_linear_exact(&t->orbit.pendulum, &t->exact);
  t->off = off_by(t, x, v);
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
           "item %ld: a1 %.17g, damping %.17g, F0 %.17g, frequency %.17g, torque %.17g, x %.17g, "
           "v %.17g, %ld periods, tolerance %.17g", number, p->force_coefficients[0], p->damping,
           p->drive_amplitude, p->drive_frequency, p->torque, t->guess.x, t->guess.v, t->periods,
           t->tolerance / t->units.length);
  if (!t->there) {
    accuracy_complain(a, "a linear oscillator without an orbit", how);
    return;
  }
  accuracy_note(a, "x", o->x, o->x_error, e->y, how);
  accuracy_note_orbit(a, o, e, how);
  if (p->drive_amplitude != 0.0)
    accuracy_note(a, "slope of the loop area", o->loop_area_slope, o->loop_area_slope_error,
                  e->loop_area_slope, how);
  accuracy_note_error(a, "multipliers", accuracy_multipliers_apart(o, e), o->multiplier_error, how);
  accuracy_note_error(a, "advanced", (double)t->off,
                      t->claim * accuracy_near_units(t->units).length, how);
}

void accuracy_linear(accuracy *a)
{
  accuracy_each(a, &(accuracy_work){.items = accuracy_get_options(a)->orbits, .at_once = 256,
                                    .size = sizeof(item), .compute = compute, .note = note});
}
