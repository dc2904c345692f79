/*
 * test_centre.c -- mirror symmetry about any centre: oscillators whose coordinate is shifted, and a
 * ring with a Josephson junction at half a flux quantum.
 *
 * References: the same oscillator with its centre at 0, and reference.h (Taylor series in long
 * double, no shared code).
 */
#include <stdlib.h>

#include <pendres/pendres.h>

#include "check.h"
#include "continuation/sets.h"
#include "model/model.h"
#include "oracle/reference.h"

static const double pi = 3.14159265358979323846;

/* Duffing's double well with its centre at c: z^3 - z, z = x - c, as powers of x and a torque. */
static pendres_pendulum wells_at(double c, double drive)
{
  return (pendres_pendulum){.damping = 0.25, .drive_amplitude = drive, .drive_frequency = 1.0,
                            .torque = c * c * c - c, .force = PENDRES_FORCE_POLYNOMIAL,
                            .force_coefficients = {3.0 * c * c - 1.0, -3.0 * c, 1.0}};
}

static pendres_pendulum ring_at(int half_quanta, double drive)
{
  return (pendres_pendulum){.damping = 0.3, .drive_amplitude = drive, .drive_frequency = 1.0,
                            .torque = 0.6 * pi * half_quanta, .force = PENDRES_FORCE_SQUID,
                            .force_coefficients = {0.6}};
}

static pendres_context *context(double tolerance)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx));
  return ctx;
}

/* Coefficients come from decimals and have their roundings; what is off by more has no centre. */
static void centres(void **state)
{
  (void)state;
  for (int i = -50; i <= 50; i++) {
    const double c = 0.1 * i;
    pendres_pendulum p = wells_at(c, 0.3);
    check_near(pendres_model_centre(&p, NAN), c, 1e-15 * fabs(c));
    assert_true(pendres_pendulum_symmetric(&p));
    p.torque += 1e-13 * (1.0 + fabs(p.torque));
    assert_false(pendres_pendulum_symmetric(&p));
    p = wells_at(c, 0.3);
    p.force_coefficients[3] = 1e-13;
    assert_false(pendres_pendulum_symmetric(&p));
    p = wells_at(c, 0.3);
    p.parametric_amplitude = 0.1;
    assert_false(pendres_pendulum_symmetric(&p));
    p = ring_at(i, 0.3);
    check_near(pendres_model_centre(&p, 0.0), pi * i, 0.0);
    p.torque += 1e-13;
    assert_false(pendres_pendulum_symmetric(&p));
  }
  /* Five powers: (x - 1)^5 - (x - 1). A spring with a torque is centred where both are equal. */
  pendres_pendulum p = {.torque = 0.0, .force = PENDRES_FORCE_POLYNOMIAL,
                        .force_coefficients = {4.0, -10.0, 10.0, -5.0, 1.0}};
  check_near(pendres_model_centre(&p, 0.0), 1.0, 0.0);
  p.force_coefficients[1] = -9.0;
  assert_false(pendres_pendulum_symmetric(&p));
  p = (pendres_pendulum){.torque = 0.3, .force = PENDRES_FORCE_POLYNOMIAL,
                         .force_coefficients = {0.1}};
  check_near(pendres_model_centre(&p, 0.0), 3.0, 1e-15);
  /* Without a spring the ring is a pendulum that counts its turns. */
  p = ring_at(0, 0.3);
  p.force_coefficients[0] = 0.0;
  check_near(pendres_model_centre(&p, 7.0), 2.0 * pi, 0.0);
  p.torque = 0.1;
  assert_false(pendres_pendulum_symmetric(&p));
  p = (pendres_pendulum){.torque = 0.1};
  assert_false(pendres_pendulum_symmetric(&p));
  p.torque = 0.0;
  check_near(pendres_model_centre(&p, 3.0), 0.0, 0.0);
}

/* The attractors of a pendulum from a grid of starts about a place. */
static pendres_attractors *attractors_of(pendres_context *ctx, const pendres_pendulum *p, double c)
{
  enum { SIDE = 21 };
  double x[SIDE * SIDE], v[SIDE * SIDE];
  pendres_attractors *found = NULL;
  for (int i = 0; i < SIDE * SIDE; i++) {
    x[i] = c + 0.25 * (i % SIDE - SIDE / 2);
    v[i] = 0.25 * (i / SIDE - SIDE / 2);
  }
  check_ok(pendres_attractors_find(ctx, p, SIDE * SIDE, x, v, &found));
  return found;
}

/* One list of attractors is the other, moved by c; those that are alone are their own images. */
static void same_attractors(const pendres_attractors *moved, const pendres_attractors *plain,
                            double c)
{
  const size_t n = pendres_attractors_count(plain);
  assert_int_equal(pendres_attractors_count(moved), n);
  for (size_t i = 0; i < n; i++) {
    const pendres_orbit *o = &pendres_attractors_get(plain, i)->orbit, *p = NULL;
    assert_true(o->period > 0);
    for (size_t k = 0; k < n && p == NULL; k++) {
      const pendres_orbit *q = &pendres_attractors_get(moved, k)->orbit;
      if (fabs(q->x - c - o->x) < 1e-6 && fabs(q->v - o->v) < 1e-6) p = q;
    }
    assert_non_null(p);
    check_near(p->x - c, o->x, p->x_error + o->x_error + 1e-15);
    check_near(p->mean_angle - c, o->mean_angle, p->x_error + o->x_error + 1e-12);
    assert_int_equal(p->symmetric, o->symmetric);
    assert_int_equal(p->period, o->period);
  }
}

static void attractors(void **state)
{
  static const double drives[] = {0.0, 1e-5, 1.205, 1.22};
  pendres_context *ctx = context(1e-9);
  (void)state;
  for (size_t i = 0; i < sizeof drives / sizeof *drives; i++) {
    const pendres_pendulum p = wells_at(0.5, drives[i]), q = wells_at(0.0, drives[i]);
    pendres_attractors *moved = attractors_of(ctx, &p, 0.5), *plain = attractors_of(ctx, &q, 0.0);
    same_attractors(moved, plain, 0.5);
    pendres_attractors_free(moved);
    pendres_attractors_free(plain);
  }
  /* Small swings in one of two wells are nobody's own image, however pure they are. */
  const pendres_pendulum p = wells_at(0.5, 1e-5);
  pendres_attractors *found = attractors_of(ctx, &p, 0.5);
  assert_int_equal(pendres_attractors_count(found), 2);
  for (size_t i = 0; i < 2; i++) assert_false(pendres_attractors_get(found, i)->orbit.symmetric);
  pendres_attractors_free(found);
  pendres_context_free(ctx);
}

/* A symmetric orbit of period 1 next to a state about the centre. */
static pendres_orbit symmetric_at(pendres_context *ctx, const pendres_pendulum *p, double x,
                                  double v)
{
  pendres_orbit orbit;
  pendres_status outcome;
  const pendres_orbit_guess guess = {
    .pendulum = *p, .x = pendres_model_centre(p, x) + x, .v = v, .period = 1};
  check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome));
  check_ok(outcome);
  assert_true(orbit.symmetric);
  return orbit;
}

/* The branch along the drive that an orbit lies on. */
static pendres_branch *branch_of(pendres_context *ctx, const pendres_orbit *o, double low,
                                 double high)
{
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_AMPLITUDE, .low = low, .high = high};
  pendres_branch *b = NULL;
  check_ok(pendres_branch_follow(ctx, o, &options, &b));
  return b;
}

static const pendres_bifurcation *breaking_of(const pendres_branch *b)
{
  for (size_t i = 0; i < pendres_branch_bifurcation_count(b); i++)
    if (pendres_branch_bifurcation_get(b, i)->kind == PENDRES_SYMMETRY_BREAKING)
      return pendres_branch_bifurcation_get(b, i);
  return NULL;
}

/* The larger multiplier, less 1, of an orbit of period 1, by the reference. */
static double excess(const pendres_bifurcation *at, double drive)
{
  reference_cycle c;
  pendres_pendulum p = at->orbit.pendulum;
  p.drive_amplitude = drive;
  check_ok(reference_orbit(&p, at->orbit.x, at->orbit.v, 1, 0, &c));
  return (double)(c.multiplier_re[0] - 1.0L);
}

static void branches(void **state)
{
  pendres_context *ctx = context(1e-9);
  (void)state;
  const pendres_pendulum p = wells_at(0.5, 1.22), q = wells_at(0.0, 1.22);
  const pendres_orbit here = symmetric_at(ctx, &p, -0.7913, 0.1514);
  const pendres_orbit there = symmetric_at(ctx, &q, -0.7913, 0.1514);
  pendres_branch *moved = branch_of(ctx, &here, 1.2, 1.25);
  pendres_branch *plain = branch_of(ctx, &there, 1.2, 1.25);
  const pendres_bifurcation *at = breaking_of(moved), *want = breaking_of(plain);
  assert_true(at != NULL && want != NULL);
  check_near(at->value, want->value, at->value_error + want->value_error);
  check_near(at->value, 1.2092916380737273, at->value_error);
  for (size_t i = 0; i < pendres_branch_count(moved); i++)
    assert_int_equal(pendres_branch_get(moved, i)->doubt, 0);
  /* The pair: two orbits that the mirror about 1/2 exchanges. */
  pendres_orbit pair;
  check_ok(pendres_branch_switch(ctx, at, &pair));
  assert_false(pair.symmetric);
  assert_true(fabs(pair.mean_angle - 0.5) > 1e-4);
  pendres_branch_free(moved);
  pendres_branch_free(plain);

  /* The ring: the multiplier goes through +1 straight, beside the reference. */
  const pendres_pendulum ring = ring_at(1, 1.65);
  pendres_attractors *found = attractors_of(ctx, &ring, pi);
  const pendres_orbit *start = &pendres_attractors_get(found, 0)->orbit;
  assert_true(start->symmetric);
  pendres_branch *b = branch_of(ctx, start, 1.55, 1.65);
  const pendres_bifurcation *breaks = breaking_of(b);
  assert_non_null(breaks);
  const double h = 1e-6;
  const double below = excess(breaks, breaks->value - h), above = excess(breaks, breaks->value + h);
  assert_true(below * above < 0.0);
  check_near(h * (below + above) / (below - above), 0.0, breaks->value_error + 1e-11);
  pendres_branch_free(b);
  pendres_attractors_free(found);
  pendres_context_free(ctx);
}

/* The state that a pendulum is on as the drive falls: the first thing that happens to it. */
static pendres_jump first_jump(pendres_context *ctx, const pendres_pendulum *p, double from,
                               double to)
{
  enum { VALUES = 5 };
  double value[VALUES];
  pendres_hysteresis *h = NULL;
  const double c = pendres_model_centre(p, 0.0);
  for (int i = 0; i < VALUES; i++) value[i] = from + (to - from) * i / (VALUES - 1);
  const pendres_state start = {c - 0.7913, 0.1514};
  const pendres_hysteresis_path path = {PENDRES_DRIVE_AMPLITUDE, VALUES, value};
  check_ok(pendres_hysteresis_find(ctx, p, &start, &path, &h));
  assert_true(pendres_hysteresis_jump_count(h) > 0);
  const pendres_jump jump = *pendres_hysteresis_jump_get(h, 0);
  pendres_hysteresis_free(h);
  return jump;
}

/* A loss of symmetry is gone through without a jump. */
static void sweeps(void **state)
{
  pendres_context *ctx = context(1e-9);
  (void)state;
  const pendres_pendulum p = wells_at(0.5, 0.0), q = wells_at(0.0, 0.0), ring = ring_at(1, 0.0);
  const pendres_jump moved = first_jump(ctx, &p, 1.22, 1.2), plain = first_jump(ctx, &q, 1.22, 1.2);
  const pendres_jump lost = first_jump(ctx, &ring, 1.65, 1.6);
  assert_int_equal(moved.kind, PENDRES_JUMP_SYMMETRY);
  assert_int_equal(plain.kind, PENDRES_JUMP_SYMMETRY);
  assert_int_equal(lost.kind, PENDRES_JUMP_SYMMETRY);
  assert_int_equal(moved.gradual, plain.gradual);
  check_near(moved.value, plain.value, moved.value_error + plain.value_error);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(centres),
    cmocka_unit_test(attractors),
    cmocka_unit_test(branches),
    cmocka_unit_test(sweeps),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
