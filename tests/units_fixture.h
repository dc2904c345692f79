/*
 * units_fixture.h -- the same oscillator in other units, for tests.
 *
 * Units that are powers of two change no digit of any result, so every number is compared bit for
 * bit: no tolerance. Dimensions are written down here once more, from the equation, not taken from
 * the library's tables.
 */
#ifndef UNITS_FIXTURE_H
#define UNITS_FIXTURE_H

#include <string.h>

#include <pendres/pendres.h>

#include "check.h"

enum { MOST = 400000 };

/* Numbers with their dimensions length^l time^t, in the order in which they were found. */
typedef struct notes {
  size_t n;
  struct note {
    const char *what;
    double value;
    int l, t;
  } note[MOST];
} notes;

static notes plain, scaled;

/* What one unit of the plain problem is in the present one. */
typedef struct units {
  double length, time;
} units;

static inline double factor(units u, int l, int t)
{
  return pow(u.length, l) * pow(u.time, t); /* of powers of two: exact */
}

static inline void note(notes *to, const char *what, double value, int l, int t)
{
  assert_true(to->n < MOST);
  to->note[to->n++] = (struct note){what, value, l, t};
}

#define NOTE(value, l, t) note(to, #value, (double)(value), l, t)

static inline pendres_pendulum in_units(pendres_pendulum p, units u)
{
  p.damping *= factor(u, 0, -1);
  p.drive_frequency *= factor(u, 0, -1);
  p.drive_amplitude *= factor(u, 1, -2);
  p.torque *= factor(u, 1, -2);
  p.temperature *= factor(u, 2, -2);
  for (int k = 1; k <= PENDRES_FORCE_POWERS; k++)
    p.force_coefficients[k - 1] *= factor(u, 1 - k, -2);
  return p;
}

/* ---- what results are made of ---- */

static inline void note_pendulum(notes *to, const pendres_pendulum *p)
{
  NOTE(p->damping, 0, -1);
  NOTE(p->drive_frequency, 0, -1);
  NOTE(p->drive_amplitude, 1, -2);
  NOTE(p->torque, 1, -2);
  NOTE(p->parametric_amplitude, 0, 0);
  NOTE(p->force_coefficients[0], 0, -2);
  NOTE(p->force_coefficients[1], -1, -2);
  NOTE(p->force_coefficients[2], -2, -2);
}

/* Measures of the library's list, by their kinds; those that are known here by hand. */
static inline void note_measures(notes *to, const pendres_orbit *o)
{
  static const struct {
    const char *name;
    int l, t;
  } by_hand[] = {{"loop_area", 2, -2}, {"dissipation", 2, -2}, {"mean_power", 2, -3},
                 {"amplitude", 1, 0}, {"first_harmonic_amplitude", 1, 0}, {"phase_lag", 0, 0},
                 {"torque_work", 2, -2}, {"parametric_work", 2, -2}};
  const pendres_orbit_quantity *q;
  for (size_t k = 0; (q = pendres_orbit_quantity_get(k)) != NULL; k++) {
    const pendres_kind_info *kind = pendres_kind_of(pendres_quantity_of(q->name)->kind);
    int l = kind->length, t = kind->time;
    for (size_t i = 0; i < sizeof by_hand / sizeof *by_hand; i++)
      if (strcmp(by_hand[i].name, q->name) == 0) l = by_hand[i].l, t = by_hand[i].t;
    note(to, q->name, *(const double *)(const void *)((const char *)o + q->value), l, t);
    if (q->error != PENDRES_ORBIT_EXACT)
      note(to, q->name, *(const double *)(const void *)((const char *)o + q->error), l, t);
  }
}

static inline void note_orbit(notes *to, const pendres_orbit *o)
{
  note_pendulum(to, &o->pendulum);
  NOTE(o->x, 1, 0);
  NOTE(o->v, 1, -1);
  NOTE(o->x_error, 1, 0);
  NOTE(o->v_error, 1, -1);
  NOTE(o->period, 0, 0);
  NOTE(o->symmetric, 0, 0);
  NOTE(o->stable, 0, 0);
  NOTE(o->steps, 0, 0);
  for (int i = 0; i < 2; i++) {
    NOTE(o->multiplier_re[i], 0, 0);
    NOTE(o->multiplier_im[i], 0, 0);
    NOTE(o->monodromy[i][i], 0, 0);
  }
  NOTE(o->monodromy[0][1], 0, 1);
  NOTE(o->monodromy[1][0], 0, -1);
  NOTE(o->multiplier_error, 0, 0);
  note_measures(to, o);
  NOTE(o->mean_angle, 1, 0);
  for (int m = 0; m < PENDRES_ORBIT_HARMONICS; m++) {
    NOTE(o->cosine[m], 1, 0);
    NOTE(o->sine[m], 1, 0);
  }
  NOTE(o->frequency_derivative[0], 1, 1);
  NOTE(o->frequency_derivative[1], 1, 0);
  NOTE(o->loop_area_slope, 2, -1);
  NOTE(o->loop_area_slope_error, 2, -1);
  NOTE(o->harmonics_rest, 1, 0);
}

static inline void note_attractor(notes *to, const pendres_attractor *a)
{
  NOTE(a->label, 0, 0);
  note_orbit(to, &a->orbit);
  for (int i = 0; i < 3; i++) NOTE(a->trap_metric[i], 0, 0);
  NOTE(a->trap_radius, 1, 0);
  NOTE(a->lyapunov, 0, -1);
  NOTE(a->lyapunov_error, 0, -1);
  NOTE(a->drift, 0, 0);
}

static inline void note_arrays(notes *to, size_t n, const double *x, const double *v)
{
  for (size_t i = 0; i < n; i++) {
    NOTE(x[i], 1, 0);
    NOTE(v[i], 1, -1);
  }
}

/* ---- questions ---- */

/* A problem in its units, and where the answers go. */
typedef struct problem {
  pendres_context *ctx;
  pendres_pendulum p;
  units u;
  notes *to;
} problem;

/* The attractor that the pendulum settles on from a position of the plain problem. */
static inline pendres_attractor settled(const problem *q, double x0)
{
  const double x = x0 * q->u.length, v = 0.0;
  pendres_settled outcome;
  pendres_attractors *found = NULL;
  notes *to = q->to;
  check_ok(pendres_settle(q->ctx, 1, &q->p, &x, &v, &outcome, &found));
  NOTE(outcome.label, 0, 0);
  NOTE(outcome.settling_periods, 0, 0);
  NOTE(outcome.certain, 0, 0);
  assert_true(outcome.attractor >= 0);
  const pendres_attractor a = *pendres_attractors_get(found, (size_t)outcome.attractor);
  note_attractor(to, &a);
  pendres_attractors_free(found);
  return a;
}

/* ---- comparing ---- */

static const units others[] = {{0x1p-10, 1.0}, {0x1p10, 1.0}, {0x1p-20, 0x1p7}, {1.0, 0x1p-7},
                               {0x1p-20, 0x1p-22}};

static inline void compare(const char *model, units u)
{
  size_t wrong = 0;
  assert_int_equal(plain.n, scaled.n);
  for (size_t i = 0; i < plain.n; i++) {
    const struct note *a = &plain.note[i], *b = &scaled.note[i];
    const double want = a->value * factor(u, a->l, a->t);
    assert_string_equal(a->what, b->what);
    if (want == b->value || (isnan(want) && isnan(b->value))) continue;
    if (wrong++ < 8)
      print_error("%s, length %g, time %g: %s (%zu) is %.17g, wanted %.17g\n", model, u.length,
                  u.time, b->what, i, b->value, want);
  }
  assert_int_equal(wrong, 0);
}

/* Ask the same in all units. */
static inline void in_all_units(const char *name, const pendres_pendulum *p, double tolerance,
                                void (*ask)(const problem *q))
{
  const units one = {1.0, 1.0};
  problem q = {.p = *p, .u = one, .to = &plain};
  plain.n = 0;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &q.ctx));
  ask(&q);
  pendres_context_free(q.ctx);
  for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
    q = (problem){.p = in_units(*p, others[k]), .u = others[k], .to = &scaled};
    scaled.n = 0;
    check_ok(pendres_context_create(
      &(pendres_options){.tolerance = tolerance * others[k].length}, &q.ctx));
    ask(&q);
    pendres_context_free(q.ctx);
    compare(name, others[k]);
  }
}

static const pendres_pendulum duffing = {.damping = 0.1, .drive_amplitude = 0.3,
                                         .drive_frequency = 1.5,
                                         .force = PENDRES_FORCE_POLYNOMIAL,
                                         .force_coefficients = {1.0, 0.0, 1.0}};

#endif
