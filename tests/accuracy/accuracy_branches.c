/*
 * accuracy_branches.c -- branches of orbits, their points and bifurcations, against the
 * extended-precision reference.
 *
 * A branch starts from what a random start settles on and leads along one of three parameters. What
 * is true of a point is the reference's orbit at the point's parameter; of a fold or a period
 * doubling, where the reference's map has the multiplier, by Newton's method here; of a loss of
 * symmetry, where the reference has it (period one, along the drive frequency).
 *
 * The section `models` does the same with torques, parametric drives and polynomial forces, along
 * any of their parameters; `scales` with polynomial forces in any units; `weak` with resonances of
 * quality 100 to 100,000, the pendulum's and those of polynomial forces in any units, along the
 * drive frequency.
 */
#include "accuracy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "continuation/sets.h"

static const double two_pi = 6.28318530717958647693;

enum {
  POINTS = 6, BIFURCATIONS = 6, HOW = 700,
  MOST_POINTS = 60,      /* of a branch, each way */
  MOST_POINTS_WEAK = 600 /* over a narrow resonance, along which orbits count by their ratio */
};

/* A point, or a bifurcation, and what is true of it. */
typedef struct place {
  int there;
  pendres_branch_point point;
  pendres_bifurcation bifurcation;
  reference_cycle exact;
  long double value; /* of the parameter at the bifurcation */
} place;

typedef struct item {
  pendres_orbit_guess guess;
  double tolerance, low, high;
  pendres_parameter parameter;
  accuracy_units units; /* in which the library is asked */
  place points[POINTS], bifurcations[BIFURCATIONS];
  int answered; /* a branch was found */
} item;

static pendres_context *context_with(double tolerance)
{
  pendres_context *ctx = NULL;
  const pendres_options options = {.tolerance = tolerance, .block_lanes = 64};
  return pendres_context_create(&options, &ctx) == PENDRES_OK ? ctx : NULL;
}

/* A torque, a parametric drive, or both; or a well of a polynomial force, hard, soft, double or
   lopsided, with the torque or the parametric drive at times; of these some without a drive. */
static pendres_pendulum model(accuracy_random *r)
{
  pendres_pendulum p = accuracy_pendulum(r);
  const int which = accuracy_choice(r, 8), more = accuracy_choice(r, 4);
  const double sign = which == 5 ? -1.0 : 1.0;
  if (which < 2 || more == 1) p.torque = accuracy_uniform(r, -0.8, 0.8);
  if (which == 1 || which == 2 || which == 3 || more == 2)
    p.parametric_amplitude = accuracy_uniform(r, -1.0, 1.0);
  if (more < 3 && accuracy_choice(r, 8) == 0) p.drive_amplitude = 0.0;
  if (which < 4) return p;
  p.force = PENDRES_FORCE_POLYNOMIAL;
  p.force_coefficients[0] = sign * accuracy_uniform(r, 0.5, 1.5);
  if (which == 7) p.force_coefficients[1] = accuracy_uniform(r, -1.0, 1.0);
  p.force_coefficients[2] = accuracy_uniform(r, which == 6 ? -0.3 : 0.1, which == 6 ? 0.0 : 1.0);
  return p;
}

static pendres_parameter direction(accuracy_random *r, const pendres_pendulum *p)
{
  static const pendres_parameter along[] = {
    PENDRES_DRIVE_FREQUENCY, PENDRES_DRIVE_FREQUENCY, PENDRES_DAMPING, PENDRES_DRIVE_AMPLITUDE,
    PENDRES_TORQUE, PENDRES_PARAMETRIC_AMPLITUDE,
    PENDRES_A1, PENDRES_A3};
  const int plain = p->torque == 0.0 && p->parametric_amplitude == 0.0;
  const int all = p->force == PENDRES_FORCE_POLYNOMIAL ? 8 : plain ? 4 : 6;
  pendres_parameter chosen;
  do chosen = along[accuracy_choice(r, all)];
  while (pendres_parameter_get(chosen, p) == 0.0);
  return chosen;
}

/* A branch through what a random start of one of these settles on, not far to either side. */
static int settle_on(accuracy_random *r, pendres_pendulum (*one)(accuracy_random *r), item *t)
{
  pendres_context *ctx = context_with(1e-6);
  int closes = 0;
  for (int attempt = 0; attempt < 20 && ctx != NULL && !closes; attempt++) {
    t->guess.pendulum = one(r);
    closes = accuracy_settled_guess(ctx, r, &t->guess);
  }
  pendres_context_free(ctx);
  t->parameter = direction(r, &t->guess.pendulum);
  const double here = pendres_parameter_get(t->parameter, &t->guess.pendulum);
  t->low = here * accuracy_uniform(r, 0.6, 1.0);
  t->high = here * accuracy_uniform(r, 1.0, 1.6);
  return closes;
}

static int draw_plain(accuracy_random *r, item *t)
{
  return settle_on(r, accuracy_pendulum, t);
}

static int draw_model(accuracy_random *r, item *t)
{
  return settle_on(r, model, t);
}

static pendres_pendulum polynomial(accuracy_random *r)
{
  pendres_pendulum p;
  do p = model(r);
  while (p.force != PENDRES_FORCE_POLYNOMIAL);
  return p;
}

static int draw_scaled(accuracy_random *r, item *t)
{
  t->units = accuracy_draw_units(r);
  return settle_on(r, polynomial, t);
}

/*
 * A weakly damped resonance, from beside it to its other side. The free frequency is
 * w0 (1 + c A^2); the drive is such that at the largest amplitude it has moved by a tenth to a
 * hundred times the width, and the guess is the linear response.
 */
static int draw_weak(accuracy_random *r, item *t)
{
  pendres_pendulum *p = &t->guess.pendulum;
  *p = (pendres_pendulum){0};
  double bend = -1.0 / 16.0, w0 = 1.0;
  if (accuracy_choice(r, 2)) {
    p->force = PENDRES_FORCE_POLYNOMIAL;
    p->force_coefficients[0] = accuracy_uniform(r, 0.5, 1.5);
    p->force_coefficients[2] = accuracy_uniform(r, -1.0, 1.0);
    w0 = sqrt(p->force_coefficients[0]);
    bend = 0.375 * p->force_coefficients[2] / p->force_coefficients[0];
    t->units = accuracy_draw_units(r);
  }
  p->damping = w0 / accuracy_logarithmic(r, 1e2, 1e5);
  const double widths = accuracy_logarithmic(r, 0.1, 100.0);
  const double moved = fmin(0.1 * w0, widths * p->damping);
  const double amplitude = sqrt(moved / (w0 * fabs(bend)));
  p->drive_amplitude = amplitude * p->damping * w0;
  t->parameter = PENDRES_DRIVE_FREQUENCY;
  const double aside = 2.0 * (moved + p->damping);
  t->low = w0 - aside;
  t->high = w0 + aside;
  p->drive_frequency = accuracy_choice(r, 2) ? t->low : t->high;
  const double w = p->drive_frequency, stiff = (w0 - w) * (w0 + w), friction = p->damping * w;
  const double size = p->drive_amplitude / hypot(stiff, friction), lag = atan2(friction, stiff);
  t->guess.x = size * cos(lag) + pendres_model_of(p->force)->origin;
  t->guess.v = size * w * sin(lag);
  t->guess.period = 1;
  return 1;
}

/* Where angles of the reference are counted from. */
static double origin_of(const pendres_orbit *o)
{
  return pendres_model_of(o->pendulum.force)->origin;
}

/* ---- what is true ---- */

/* The product of an orbit's multipliers (Liouville). */
static long double product_at(const pendres_pendulum *p, long period)
{
  const long double time = 6.28318530717958647692528676655900577L * period / p->drive_frequency;
  return expl(-p->damping * time);
}

/*
 * y and v that do not come back, and the trace that is not that of the multiplier s, at a place
 * (y, v, parameter); with derivatives by the place, those of the trace and by the parameter by
 * differences.
 */
static int equations(const pendres_bifurcation *b, double s, const long double u[3],
                     long double a[3][4])
{
  static const long double aside = 1e-6L;
  const long q = b->orbit.period;
  const long double apart = (long double)(double)(u[2] + aside) - u[2];
  long double trace = 0.0L, moved[2] = {0.0L};
  for (int k = 3; k-- > -1;) { /* last the place itself */
    pendres_pendulum p = b->orbit.pendulum;
    reference_image i;
    const double value = (double)(u[2] + (k == 2 ? aside : 0.0L));
    pendres_parameter_set(b->parameter, value, &p);
    if (reference_map(&p, u[0] + (k == 0 ? aside : 0.0L), u[1] + (k == 1 ? aside : 0.0L), q,
                              &i) != PENDRES_OK)
      return 0;
    const long double off =
      i.monodromy[0][0] + i.monodromy[1][1] - s * (1.0L + product_at(&p, q));
    if (k == 2) {
      moved[0] = i.y;
      moved[1] = i.v;
    }
    if (k >= 0) {
      a[2][k] = off;
      continue;
    }
    trace = off;
    for (int r = 0; r < 2; r++) {
      for (int c = 0; c < 2; c++) a[r][c] = i.monodromy[r][c] - (r == c);
      a[r][2] = (moved[r] - (r == 0 ? i.y : i.v)) / apart;
    }
    a[0][3] = -remainderl(i.y - u[0], 6.28318530717958647692528676655900577L);
    a[1][3] = -(i.v - u[1]);
    a[2][3] = -trace;
  }
  a[2][0] = (a[2][0] - trace) / aside;
  a[2][1] = (a[2][1] - trace) / aside;
  a[2][2] = (a[2][2] - trace) / apart;
  return 1;
}

/* Gauss and Jordan; the solution is left in the last column. */
static int solve(long double a[3][4])
{
  for (int i = 0; i < 3; i++) {
    int best = i;
    for (int k = i + 1; k < 3; k++)
      if (fabsl(a[k][i]) > fabsl(a[best][i])) best = k;
    for (int k = 0; k < 4; k++) {
      const long double kept = a[i][k];
      a[i][k] = a[best][k];
      a[best][k] = kept;
    }
    if (!(fabsl(a[i][i]) > 0.0L)) return 0;
    for (int r = 0; r < 3; r++)
      for (int k = 3; k >= i && r != i; k--) a[r][k] -= a[i][k] * a[r][i] / a[i][i];
  }
  for (int i = 0; i < 3; i++) a[i][3] /= a[i][i];
  return 1;
}

/* The fold or doubling next to one that was found: what of it is noted. Places are doubles, and
   what is left of the last step is not. A step that leads far away has lost it, and an integration
   from there might take for ever. */
static int exact_bifurcation(const pendres_bifurcation *b, place *out)
{
  enum { STEPS = 6 };
  static const long double farthest = 0.1L;
  const double s = b->kind == PENDRES_FOLD ? 1.0 : -1.0;
  long double u[3] = {b->orbit.x - origin_of(&b->orbit), b->orbit.v, b->value}, a[3][4];
  long double last = INFINITY;
  for (int k = 0; k < STEPS; k++) {
    if (!equations(b, s, u, a) || !solve(a)) return 0;
    last = fmaxl(fmaxl(fabsl(a[0][3]), fabsl(a[1][3])), fabsl(a[2][3]));
    if (k + 1 == STEPS || !(last < farthest)) break;
    u[0] += a[0][3];
    u[1] += a[1][3];
    u[2] = (double)(u[2] + a[2][3]);
  }
  if (!(last < 1e-14L)) return 0;
  out->exact = (reference_cycle){.y = u[0] + a[0][3], .v = u[1] + a[1][3]};
  out->value = u[2] + a[2][3];
  return 1;
}

static int exact_of(place *at)
{
  const pendres_bifurcation *b = &at->bifurcation;
  const pendres_orbit *o = &b->orbit;
  if (b->kind == PENDRES_FOLD || b->kind == PENDRES_PERIOD_DOUBLING)
    return exact_bifurcation(b, at);
  if (b->kind != PENDRES_SYMMETRY_BREAKING || b->parameter != PENDRES_DRIVE_FREQUENCY ||
      o->period != 1 || o->winding != 0 ||
      reference_find(REFERENCE_SYMMETRY_BREAKING, &o->pendulum,
                             &(reference_guess){b->value, o->x - origin_of(o), o->v, 0.0L},
                             &at->exact) != PENDRES_OK)
    return 0;
  at->value = at->exact.drive_frequency;
  return 1;
}

/* ---- what is had ---- */

/* A bifurcation that was found in units, in those of the draw. */
static pendres_bifurcation bifurcation_out_of(const pendres_bifurcation *b, accuracy_units u)
{
  pendres_bifurcation out = *b;
  out.orbit = accuracy_out_of_units(&b->orbit, u);
  out.value = pendres_parameter_get(b->parameter, &out.orbit.pendulum);
  if (b->value != 0.0) out.value_error = b->value_error * (out.value / b->value);
  return out;
}

static void look(accuracy_random *r, const pendres_branch *b, item *t)
{
  const accuracy_units u = accuracy_near_units(t->units);
  const size_t n = pendres_branch_count(b), met = pendres_branch_bifurcation_count(b);
  for (int k = 0; k < POINTS && n > 0; k++) {
    place *at = &t->points[k];
    at->point = *pendres_branch_get(b, (size_t)accuracy_choice(r, (int)n));
    at->point.orbit = accuracy_out_of_units(&at->point.orbit, u);
    const pendres_orbit *o = &at->point.orbit;
    at->there = at->point.bifurcation < 0 &&
                reference_orbit(&o->pendulum, o->x - origin_of(o), o->v, o->period,
                                        o->winding, &at->exact) == PENDRES_OK;
  }
  for (size_t k = 0; k < met && k < BIFURCATIONS; k++) {
    place *at = &t->bifurcations[k];
    at->bifurcation = bifurcation_out_of(pendres_branch_bifurcation_get(b, k), u);
    at->there = exact_of(at);
  }
}

/* What is drawn, in the units in which the library is asked. */
static void convert(item *t)
{
  const accuracy_units u = t->units;
  pendres_pendulum *p = &t->guess.pendulum;
  double *const ends[2] = {&t->low, &t->high};
  for (int k = 0; k < 2; k++) {
    pendres_pendulum at = *p;
    pendres_parameter_set(t->parameter, *ends[k], &at);
    at = accuracy_in_units(&at, u);
    *ends[k] = pendres_parameter_get(t->parameter, &at);
  }
  *p = accuracy_in_units(p, u);
  t->guess.x /= u.length;
  t->guess.v /= u.length / u.time;
}

static void compute_one(accuracy_random *r, int (*draw)(accuracy_random *r, item *t), item *t)
{
  t->units = (accuracy_units){1.0, 1.0};
  const int drawn = draw(r, t);
  t->tolerance = accuracy_tolerance(r) / t->units.length;
  if (!drawn) return;
  convert(t);
  pendres_context *ctx = context_with(t->tolerance);
  pendres_status outcome = PENDRES_NOT_CONVERGED;
  pendres_orbit start;
  pendres_branch *b = NULL;
  const pendres_branch_options options = {
    .parameter = t->parameter, .low = t->low, .high = t->high,
    .most_points = draw == draw_weak ? MOST_POINTS_WEAK : MOST_POINTS};
  if (ctx != NULL &&
      pendres_orbit_find(ctx, 1, &t->guess, PENDRES_ORBIT_PLAIN, &start, &outcome) ==
        PENDRES_OK &&
      outcome != PENDRES_NOT_CONVERGED &&
      pendres_branch_follow(ctx, &start, &options, &b) == PENDRES_OK)
    look(r, b, t);
  t->answered = b != NULL;
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

static void compute(accuracy_random *r, void *of, long number)
{
  (void)number;
  compute_one(r, draw_plain, of);
}

static void compute_model(accuracy_random *r, void *of, long number)
{
  (void)number;
  compute_one(r, draw_model, of);
}

static void compute_scaled(accuracy_random *r, void *of, long number)
{
  (void)number;
  compute_one(r, draw_scaled, of);
}

static void compute_weak(accuracy_random *r, void *of, long number)
{
  (void)number;
  compute_one(r, draw_weak, of);
}

/* How far an x is from where the reference has it, in whole turns. */
static double turn_of(const pendres_orbit *o, const reference_cycle *e)
{
  const double apart = o->x - origin_of(o) - (double)e->y;
  return o->pendulum.force == PENDRES_FORCE_POLYNOMIAL ? 0.0 : rint(apart / two_pi) * two_pi;
}

static void note_point(accuracy *a, const place *at, const char *how)
{
  const pendres_orbit *o = &at->point.orbit;
  const reference_cycle *e = &at->exact;
  accuracy_note(a, "x of a point", o->x - turn_of(o, e), o->x_error, e->y + origin_of(o), how);
  accuracy_note(a, "v of a point", o->v, o->v_error, e->v, how);
  if (o->pendulum.drive_amplitude != 0.0) /* without a drive it is 0 exactly */
    accuracy_note(a, "loop area of a point", o->loop_area, o->loop_area_error, e->loop_area, how);
  accuracy_note(a, "amplitude of a point", o->amplitude, o->amplitude_error, e->amplitude, how);
  if (!(isnan(o->phase_lag) && isnan(e->phase_lag))) /* at rest there is none */
    accuracy_note_error(a, "phase lag of a point",
                      fabs(remainder((double)(o->phase_lag - e->phase_lag), two_pi)),
                      o->phase_lag_error, how);
  accuracy_note_error(a, "multipliers of a point", accuracy_multipliers_apart(o, e),
                      o->multiplier_error, how);
}

static void note_bifurcation(accuracy *a, const place *at, const char *how)
{
  const pendres_bifurcation *b = &at->bifurcation;
  const pendres_orbit *o = &b->orbit;
  const char *name = pendres_name_get(PENDRES_NAMES_SPECIAL, b->kind);
  char kind[64];
  pendres_pendulum p = o->pendulum;
  reference_cycle e = at->exact;
  snprintf(kind, sizeof kind, "%s", name);
  accuracy_note(a, kind, b->value, b->value_error, at->value, how);
  snprintf(kind, sizeof kind, "x of a %s", name);
  accuracy_note(a, kind, o->x - turn_of(o, &e), o->x_error, e.y + origin_of(o), how);
  pendres_parameter_set(b->parameter, (double)at->value, &p);
  const long double s = b->kind == PENDRES_PERIOD_DOUBLING ? -1.0L : 1.0L;
  e = (reference_cycle){
    .multiplier_re = {s, s * product_at(&p, o->period)}};
  snprintf(kind, sizeof kind, "multipliers of a %s", name);
  accuracy_note_error(a, kind, accuracy_multipliers_apart(o, &e), o->multiplier_error, how);
}

/* Without a symmetry branches do not cross, other than by chance. One that is followed in several
   periods may be of orbits that close in fewer, and crosses where the period of these doubles. */
static int is_false(const place *at)
{
  const pendres_orbit *o = &at->bifurcation.orbit;
  return at->bifurcation.kind == PENDRES_BRANCH_POINT && o->period == 1 &&
         o->pendulum.drive_amplitude != 0.0 && !pendres_pendulum_symmetric(&o->pendulum);
}

static void note(accuracy *a, const void *of, long number, void *tally)
{
  const item *t = of;
  const pendres_pendulum *p = &t->guess.pendulum;
  char how[HOW];
  (void)tally;
  for (int k = 0; k < POINTS + BIFURCATIONS; k++) {
    const place *at = k < POINTS ? &t->points[k] : &t->bifurcations[k - POINTS];
    const pendres_orbit *o = k < POINTS ? &at->point.orbit : &at->bifurcation.orbit;
    if (!at->there && !is_false(at)) continue;
    snprintf(how, sizeof how,
             "item %ld: F0 %.17g, damping %.17g, frequency %.17g, torque %.17g, parametric %.17g, "
             "force %d: %.17g, %.17g, %.17g, from x %.17g, v %.17g, q %d, winding %d, along %s "
             "%.17g to %.17g, tolerance %.17g; at %.17g, units %.17g, %.17g", number,
             p->drive_amplitude, p->damping, p->drive_frequency, p->torque, p->parametric_amplitude,
             (int)p->force, p->force_coefficients[0], p->force_coefficients[1],
             p->force_coefficients[2], t->guess.x, t->guess.v, t->guess.period, t->guess.winding,
             pendres_name_get(PENDRES_NAMES_PARAMETER, t->parameter), t->low, t->high, t->tolerance,
             pendres_parameter_get(t->parameter, &o->pendulum), t->units.length, t->units.time);
    if (is_false(at)) accuracy_complain(a, "branches that cross without a symmetry", how);
    else if (k < POINTS) note_point(a, at, how);
    else note_bifurcation(a, at, how);
  }
}

static void follow_all(accuracy *a, void (*how)(accuracy_random *r, void *item, long number))
{
  accuracy_each(a, &(accuracy_work){.items = 2 * accuracy_get_options(a)->points, .at_once = 64,
                                    .size = sizeof(item), .compute = how, .note = note});
}

void accuracy_branches(accuracy *a)
{
  follow_all(a, compute);
}

void accuracy_models(accuracy *a)
{
  follow_all(a, compute_model);
}

void accuracy_scales(accuracy *a)
{
  follow_all(a, compute_scaled);
}

void accuracy_weak(accuracy *a)
{
  follow_all(a, compute_weak);
}
