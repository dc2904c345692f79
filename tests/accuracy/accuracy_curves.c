/*
 * accuracy_curves.c -- whole response curves, of quality up to a million, in any units: of linear
 * oscillators against their closed form, and of strongly driven springs that stiffen against the
 * extended-precision reference.
 *
 * A curve is to lead from one end of its range to the other, over its resonance, without doubts.
 */
#include "accuracy.h"

#include <math.h>
#include <stdio.h>

#include "continuation/sets.h"

static const double two_pi = 6.28318530717958647693;

enum { POINTS = 8, HOW = 500 };

/* Of a linear one as many points as its steps of a twentieth lead to, and half as many again: 40
   ln(Q) up and down, 20 pi round the half circle, and a hundred for each w0 of its range. */
static const double linear_points = 1.5;

typedef struct place {
  int there;
  pendres_branch_point point;
  reference_cycle exact;
} place;

typedef struct item {
  pendres_orbit_guess guess;
  double tolerance, low, high;
  double highest;       /* amplitude at the resonance, nearly */
  accuracy_units units; /* in which the library is asked */
  size_t points, doubts;
  int answered, whole;
  double largest;
  place at[POINTS];
} item;

/* What is small beside the resonance, where the spring is linear. */
static void guess_beside(item *t)
{
  const pendres_pendulum *p = &t->guess.pendulum;
  const double w = p->drive_frequency, stiff = p->force_coefficients[0] - w * w;
  const double friction = p->damping * w, square = stiff * stiff + friction * friction;
  t->guess.x = p->torque / p->force_coefficients[0] + p->drive_amplitude * stiff / square;
  t->guess.v = w * p->drive_amplitude * friction / square;
  t->guess.period = 1;
}

static void draw_linear(accuracy_random *r, item *t)
{
  pendres_pendulum *p = &t->guess.pendulum;
  const double w0 = accuracy_uniform(r, 0.5, 1.5), quality = accuracy_logarithmic(r, 1.0, 1e6);
  p->force_coefficients[0] = w0 * w0;
  p->damping = w0 / quality;
  p->drive_amplitude = accuracy_logarithmic(r, 1e-6, 1e3);
  if (accuracy_choice(r, 2)) p->torque = p->drive_amplitude * accuracy_uniform(r, -10.0, 10.0);
  t->low = w0 * accuracy_uniform(r, 0.3, 0.9);
  t->high = w0 * accuracy_uniform(r, 1.1, 3.0);
  p->drive_frequency = accuracy_choice(r, 2) ? t->low : t->high;
  /* The largest, at w0 (1 - 1/2Q^2)^(1/2). */
  t->highest = p->drive_amplitude / (p->damping * w0);
  t->tolerance *= (p->drive_amplitude + fabs(p->torque)) / (w0 * w0);
}

/*
 * x'' + damping x' + x + a3 x^3, driven up to an amplitude A of 3 to 300 lengths, where its
 * frequency is about A sqrt(3 a3/4). There the resonance is as narrow as damping/A; narrower than
 * 1e-8, no double leads along both of its sides.
 */
static void draw_strong(accuracy_random *r, item *t)
{
  pendres_pendulum *p = &t->guess.pendulum;
  const double size = accuracy_logarithmic(r, 3.0, 300.0);
  p->force_coefficients[0] = 1.0;
  p->force_coefficients[2] = accuracy_uniform(r, 0.5, 1.5);
  const double fast = size * sqrt(0.75 * p->force_coefficients[2]);
  p->damping = accuracy_logarithmic(r, fmax(1e-6, 1e-8 * size), 0.1);
  p->drive_amplitude = p->damping * fast * size;
  t->high = p->drive_frequency = 1.5 * fast + 2.0;
  /* Below the lower fold, at 1 or where the drive alone would be balanced; and above superharmonic
     resonances. */
  t->low = 0.9 * fmax(1.0, cbrt(p->drive_amplitude * sqrt(p->force_coefficients[2])));
  t->highest = size;
}

/* What is drawn, in the units in which the library is asked. */
static void convert(accuracy_random *r, item *t)
{
  t->units = accuracy_draw_units(r);
  t->guess.pendulum = accuracy_in_units(&t->guess.pendulum, t->units);
  t->guess.x /= t->units.length;
  t->guess.v /= t->units.length / t->units.time;
  t->low *= t->units.time;
  t->high *= t->units.time;
  t->tolerance /= t->units.length;
}

static void look(accuracy_random *r, const pendres_branch *b, item *t)
{
  const accuracy_units u = accuracy_near_units(t->units);
  t->points = pendres_branch_count(b);
  t->whole = pendres_branch_end_get(b, 0) == PENDRES_END_RANGE &&
             pendres_branch_end_get(b, 1) == PENDRES_END_RANGE;
  for (size_t k = 0; k < t->points; k++) {
    const pendres_branch_point *p = pendres_branch_get(b, k);
    t->largest = fmax(t->largest, p->orbit.amplitude * t->units.length);
    t->doubts += p->doubt != 0;
  }
  for (int k = 0; k < POINTS && t->points > 0; k++) {
    place *at = &t->at[k];
    at->point = *pendres_branch_get(b, (size_t)accuracy_choice(r, (int)t->points));
    at->point.orbit = accuracy_out_of_units(&at->point.orbit, u);
    const pendres_orbit *o = &at->point.orbit;
    at->there = at->point.bifurcation < 0;
    if (o->pendulum.force_coefficients[2] == 0.0)
      accuracy_linear_exact(&o->pendulum, &at->exact);
    else if (reference_orbit(&o->pendulum, o->x, o->v, 1, 0, &at->exact) != PENDRES_OK)
      at->there = 0;
  }
}

static void compute(accuracy_random *r, item *t, void (*draw)(accuracy_random *r, item *t))
{
  pendres_context *ctx = NULL;
  pendres_status outcome = PENDRES_NOT_CONVERGED;
  pendres_orbit start;
  pendres_branch *b = NULL;
  t->guess.pendulum.force = PENDRES_FORCE_POLYNOMIAL;
  t->tolerance = accuracy_tolerance(r);
  draw(r, t);
  guess_beside(t);
  convert(r, t);
  const pendres_options options = {.tolerance = t->tolerance, .block_lanes = 64};
  const pendres_branch_options along = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = t->low, .high = t->high};
  if (pendres_context_create(&options, &ctx) == PENDRES_OK &&
      pendres_orbit_find(ctx, 1, &t->guess, PENDRES_ORBIT_PLAIN, &start, &outcome) == PENDRES_OK &&
      outcome != PENDRES_NOT_CONVERGED &&
      pendres_branch_follow(ctx, &start, &along, &b) == PENDRES_OK)
    look(r, b, t);
  t->answered = b != NULL;
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

static void compute_linear(accuracy_random *r, void *of, long number)
{
  (void)number;
  compute(r, of, draw_linear);
}

static void compute_strong(accuracy_random *r, void *of, long number)
{
  (void)number;
  compute(r, of, draw_strong);
}

static void note_curve(accuracy *a, const item *t, const char *how)
{
  const pendres_pendulum *p = &t->guess.pendulum;
  const double quality = sqrt(p->force_coefficients[0]) / p->damping;
  const double range = (t->high - t->low) / sqrt(p->force_coefficients[0]);
  const double most = 40.0 * log(fmax(quality, 1.0)) + 10.0 * two_pi + 100.0 * range;
  if (!t->answered) accuracy_complain(a, "no curve", how);
  else if (!t->whole) accuracy_complain(a, "a curve that is not whole", how);
  else if (t->doubts > 0) accuracy_complain(a, "a curve with doubts", how);
  else if (t->largest < 0.95 * t->highest) accuracy_complain(a, "a curve without its peak", how);
  else if (p->force_coefficients[2] == 0.0 && (double)t->points > linear_points * most)
    accuracy_complain(a, "a curve of too many points", how);
}

/* Of a large orbit in a narrow resonance the phase is known far less well than the size, and claims
   are those of the whole orbit: what does not turn with the phase is claimed too carefully, by far.
   None may be claimed too well. */
static void note_strong(accuracy *a, const pendres_orbit *o, const reference_cycle *e,
                        const char *how)
{
  accuracy_note(a, "v", o->v, o->v_error, e->v, how);
  accuracy_note(a, "loop area", o->loop_area, o->loop_area_error, e->loop_area, how);
  accuracy_note_error(a, "phase lag",
                      fabs(remainder((double)(o->phase_lag - e->phase_lag), two_pi)),
                      o->phase_lag_error, how);
  if (fabsl(o->x - e->y) > o->x_error || fabsl(o->amplitude - e->amplitude) > o->amplitude_error ||
      fabsl(o->dissipation - e->dissipation) > o->dissipation_error ||
      accuracy_multipliers_apart(o, e) > o->multiplier_error)
    accuracy_complain(a, "a point beyond its claims", how);
}

static void note(accuracy *a, const void *of, long number, void *tally)
{
  const item *t = of;
  const pendres_pendulum *p = &t->guess.pendulum;
  char how[HOW];
  (void)tally;
  snprintf(how, sizeof how,
           "item %ld: a1 %.17g, a3 %.17g, damping %.17g, F0 %.17g, frequency %.17g, torque %.17g, "
           "x %.17g, v %.17g, along %.17g to %.17g, tolerance %.17g, %zu points, largest %.9g of "
           "%.9g", number, p->force_coefficients[0], p->force_coefficients[2], p->damping,
           p->drive_amplitude, p->drive_frequency, p->torque, t->guess.x, t->guess.v, t->low,
           t->high, t->tolerance, t->points, t->largest, t->highest);
  note_curve(a, t, how);
  for (int k = 0; k < POINTS && t->answered; k++) {
    const place *at = &t->at[k];
    const pendres_orbit *o = &at->point.orbit;
    if (!at->there) continue;
    if (p->force_coefficients[2] != 0.0) {
      note_strong(a, o, &at->exact, how);
      continue;
    }
    accuracy_note(a, "x", o->x, o->x_error, at->exact.y, how);
    accuracy_note_orbit(a, o, &at->exact, how);
    accuracy_note_error(a, "multipliers", accuracy_multipliers_apart(o, &at->exact),
                        o->multiplier_error, how);
  }
}

static void follow_all(accuracy *a, void (*how)(accuracy_random *r, void *item, long number))
{
  accuracy_each(a, &(accuracy_work){.items = accuracy_get_options(a)->points, .at_once = 64,
                                    .size = sizeof(item), .compute = how, .note = note});
}

void accuracy_linear_curves(accuracy *a)
{
  follow_all(a, compute_linear);
}

void accuracy_strong_curves(accuracy *a)
{
  follow_all(a, compute_strong);
}
