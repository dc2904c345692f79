/*
 * test_escape.c -- pendulums that go to infinity under a softening force: against an equation that
 * is solved in closed form, and against an integration that shares nothing with the library.
 */
#include "check.h"

#include <stdlib.h>

#include <pendres/pendres.h>

#include "model/model.h"

enum { SIDE = 16 };

static pendres_context *context(void)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  return ctx;
}

/* Helmholtz' force, or that of a ring with a junction. */
static double force(const pendres_pendulum *p, double x)
{
  return p->force == PENDRES_FORCE_SQUID ? sin(x) + p->force_coefficients[0] * x : x - x * x;
}

/* Driven, with steps of 1/100, 20 periods long: whether x goes beyond 50, to the right or left. */
static int runs_away(const pendres_pendulum *p, double x, double v)
{
  const double h = 1e-2, end = 20.0 * 2.0 * PENDRES_PI / p->drive_frequency;
  for (double t = 0.0; t < end && fabs(x) < 50.0; t += h) {
    double a[4], u[4];
    for (int i = 0; i < 4; i++) {
      const double c = i == 0 ? 0.0 : i == 3 ? 1.0 : 0.5;
      const double at = i == 0 ? x : x + c * h * u[i - 1];
      u[i] = i == 0 ? v : v + c * h * a[i - 1];
      a[i] = p->drive_amplitude * cos(p->drive_frequency * (t + c * h)) - p->damping * u[i] -
             force(p, at);
    }
    x += h / 6.0 * (u[0] + 2.0 * u[1] + 2.0 * u[2] + u[3]);
    v += h / 6.0 * (a[0] + 2.0 * a[1] + 2.0 * a[2] + a[3]);
  }
  return fabs(x) >= 50.0;
}

static double weight(int i)
{
  return (i == 0 || i == SIDE - 1 ? 0.5 : 1.0) / (SIDE - 1);
}

/* Every state escapes if and only if the integration runs away, but for those that are
   uncertain. */
static void helmholtz(void **state)
{
  const pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 0.07, .drive_frequency = 0.85,
                              .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, -1.0}};
  double x[SIDE], v[SIDE], share = 0.0;
  pendres_basin_state *s = calloc(SIDE * SIDE, sizeof *s);
  pendres_attractors *set = NULL;
  pendres_basin_sums *sums = NULL;
  pendres_basin_statistics t;
  (void)state;
  for (int i = 0; i < SIDE; i++) {
    x[i] = -0.8 + 0.135 * i;
    v[i] = -0.9 + 0.115 * i;
  }
  const pendres_basin_grid grid = {.nx = SIDE, .nv = SIDE, .x = x, .v = v};
  pendres_context *ctx = context();
  assert_non_null(s);
  check_ok(pendres_basin_attractors(ctx, &p, &grid, &set));
  assert_int_equal(pendres_attractors_count(set), 1);
  check_ok(pendres_basin_find(ctx, set, &grid, s));
  for (int i = 0; i < SIDE * SIDE; i++) {
    const int away = runs_away(&p, x[i / SIDE], v[i % SIDE]);
    if (s[i].how == PENDRES_BASIN_UNCERTAIN) continue;
    assert_int_equal(s[i].label, away ? PENDRES_LABEL_ESCAPE : PENDRES_LABEL_PERIODIC);
    assert_int_equal(s[i].attractor, away ? PENDRES_ATTRACTOR_ESCAPED : 0);
    /* States at the window's edges count half. */
    share += away * weight(i / SIDE) * weight(i % SIDE);
  }
  assert_true(share > 0.3 && share < 0.7);
  check_ok(pendres_basin_sums_create(&grid, 1, &sums));
  check_ok(pendres_basin_sums_add(sums, SIDE, s));
  double fraction, error;
  check_ok(pendres_basin_sums_result(sums, &t, &fraction, &error));
  assert_true(t.unresolved == 0 && t.escaped > 0);
  /* Two states are uncertain at most. */
  check_near(t.escape_fraction, share, 2.0 / (SIDE * SIDE));
  check_near(fraction + t.escape_fraction, 1.0, 1e-12);
  assert_true(t.escape_fraction_error > 0.0 && t.escape_fraction_error < 0.2);
  pendres_basin_sums_free(sums);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
  free(s);
}

/* x'' + gamma x' - x = I + F0 cos(omega t): everything escapes, but for a line. */
static void inverted(void **state)
{
  const pendres_pendulum p = {.damping = 0.3, .drive_amplitude = 0.5, .drive_frequency = 1.1,
                              .torque = 0.2, .force = PENDRES_FORCE_POLYNOMIAL,
                              .force_coefficients = {-1.0}};
  (void)state;
  pendres_pendulum many[SIDE];
  double x[SIDE], v[SIDE];
  pendres_settled o[SIDE];
  pendres_context *ctx = context();
  for (int i = 0; i < SIDE; i++) {
    many[i] = p;
    x[i] = cos(i);
    v[i] = 0.5 * sin(3.0 * i);
  }
  check_ok(pendres_settle(ctx, SIDE, many, x, v, o, NULL));
  for (int i = 0; i < SIDE; i++) {
    assert_int_equal(o[i].label, PENDRES_LABEL_ESCAPE);
    assert_int_equal(o[i].settling_periods, 0); /* the force is linear: known from the start */
  }
  pendres_context_free(ctx);
}

/* One period of a ring, whose spring and junction a parametric drive moves. */
static void ring_period(const pendres_pendulum *p, double *x, double *v)
{
  enum { STEPS = 3000 }; /* 60 rad/s with waves of 2 pi: 50 steps a wave */
  const double h = 2.0 * PENDRES_PI / p->drive_frequency / STEPS;
  for (int n = 0; n < STEPS; n++) {
    double a[4], u[4];
    for (int i = 0; i < 4; i++) {
      const double c = i == 0 ? 0.0 : i == 3 ? 1.0 : 0.5, t = (n + c) * h;
      const double at = i == 0 ? *x : *x + c * h * u[i - 1];
      u[i] = i == 0 ? *v : *v + c * h * a[i - 1];
      a[i] = p->drive_amplitude * cos(p->drive_frequency * t) - p->damping * u[i] -
             force(p, at) * (1.0 + p->parametric_amplitude * cos(p->drive_frequency * t));
    }
    *x += h / 6.0 * (u[0] + 2.0 * u[1] + 2.0 * u[2] + u[3]);
    *v += h / 6.0 * (a[0] + 2.0 * a[1] + 2.0 * a[2] + a[3]);
  }
}

/*
 * A ring within a tongue of its spring: it settles on one of seven orbits of two periods, the
 * largest of which reaches 51, or its oscillations grow for ever. After 250 periods the latter are
 * beyond 1000, with the exponent of the spring, and the others on their orbits.
 */
static void ring_in_tongue(void **state)
{
  const pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 0.1, .drive_frequency = 1.0,
                              .parametric_amplitude = 1.25, .force = PENDRES_FORCE_SQUID,
                              .force_coefficients = {0.5}};
  double x[SIDE], v[SIDE];
  int away = 0;
  pendres_basin_state s[SIDE * SIDE];
  pendres_attractors *set = NULL;
  pendres_context *ctx = context();
  (void)state;
  for (int i = 0; i < SIDE; i++) {
    x[i] = -3.1 + 6.2 * i / (SIDE - 1);
    v[i] = -2.0 + 4.0 * i / (SIDE - 1);
  }
  const pendres_basin_grid grid = {.nx = SIDE, .nv = SIDE, .x = x, .v = v};
  check_ok(pendres_basin_attractors(ctx, &p, &grid, &set));
  assert_int_equal(pendres_attractors_count(set), 7);
  check_ok(pendres_basin_find(ctx, set, &grid, s));
  for (int i = 0; i < SIDE * SIDE; i += 3) {
    double z[2] = {x[i / SIDE], v[i % SIDE]};
    for (int k = 0; k < 250; k++) ring_period(&p, &z[0], &z[1]);
    const int escapes = hypot(z[0], z[1]) > 1000.0;
    away += escapes;
    assert_int_equal(s[i].how, PENDRES_BASIN_INTEGRATED);
    assert_int_equal(s[i].label, escapes ? PENDRES_LABEL_ESCAPE : PENDRES_LABEL_PERIODIC);
    if (escapes) continue;
    const pendres_orbit *o = &pendres_attractors_get(set, (size_t)s[i].attractor)->orbit;
    double other[2] = {z[0], z[1]};
    ring_period(&p, &other[0], &other[1]);
    assert_true(fmin(hypot(z[0] - o->x, z[1] - o->v), hypot(other[0] - o->x, other[1] - o->v)) <
                0.05);
  }
  assert_true(away > 5);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

/* A force of one's own: a ring whose spring pushes. What does not escape is on the one attractor
   around x = 0, and both happen. */
static void own_force(void **state)
{
  const pendres_pendulum p = {.damping = 0.3, .drive_amplitude = 0.3, .drive_frequency = 0.8,
                              .force = PENDRES_FORCE_SQUID, .force_coefficients = {-0.3}};
  (void)state;
  pendres_pendulum many[SIDE * SIDE];
  double x[SIDE * SIDE], v[SIDE * SIDE];
  pendres_settled o[SIDE * SIDE];
  int away = 0, uncertain = 0;
  pendres_context *ctx = context();
  for (int i = 0; i < SIDE * SIDE; i++) {
    many[i] = p;
    x[i] = 0.6 * (i / SIDE) - 4.4;
    v[i] = 0.3 * (i % SIDE) - 2.2;
  }
  check_ok(pendres_settle(ctx, SIDE * SIDE, many, x, v, o, NULL));
  for (int i = 0; i < SIDE * SIDE; i++) {
    const int escapes = runs_away(&p, x[i], v[i]);
    assert_int_not_equal(o[i].label, PENDRES_LABEL_UNRESOLVED);
    away += escapes;
    uncertain += !o[i].certain;
    if (o[i].certain) assert_int_equal(o[i].label == PENDRES_LABEL_ESCAPE, escapes);
  }
  assert_true(away > SIDE * SIDE / 4 && away < 3 * SIDE * SIDE / 4 && uncertain < 4);
  pendres_context_free(ctx);
}

/* The bound: beyond it the acceleration at rest is outwards at every phase, and no less far out. */
static void bound(void **state)
{
  static const pendres_pendulum some[] = {
    {.damping = 0.1, .drive_amplitude = 0.3, .drive_frequency = 1.0, .torque = -0.4,
     .parametric_amplitude = 0.6, .force = PENDRES_FORCE_POLYNOMIAL,
     .force_coefficients = {1.0, -1.0}},
    {.damping = 0.1, .drive_amplitude = 2.0, .drive_frequency = 1.0, .torque = 3.0,
     .parametric_amplitude = -0.9, .force = PENDRES_FORCE_POLYNOMIAL,
     .force_coefficients = {2.0, 0.5, -0.1}},
    {.damping = 0.1, .drive_amplitude = 1.0, .drive_frequency = 1.0,
     .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, 3.0, -0.2, -0.05}},
    {.damping = 0.1, .drive_amplitude = 0.4, .drive_frequency = 1.0, .torque = 2.0,
     .parametric_amplitude = 0.5, .force = PENDRES_FORCE_SQUID, .force_coefficients = {-0.1}}};
  (void)state;
  for (size_t i = 0; i < sizeof some / sizeof *some; i++)
    for (int side = -1; side <= 1; side += 2) {
      int met = 0;
      for (double z = 0.01; z < 1e4; z *= 1.01) {
        const double x = side * z;
        if (!pendres_model_escapes(&some[i], x, side * 0.0)) {
          assert_false(met);
          continue;
        }
        met = 1;
        for (int k = 0; k < 64; k++)
          assert_true(side * pendres_pendulum_acceleration(&some[i], x, 0.0,
                                                           PENDRES_PI * k / 32.0) >
                      0.0);
        assert_false(pendres_model_escapes(&some[i], x, -1e-3 * side));
      }
      /* The quadratic force drives to the right alone. */
      assert_int_equal(met, i != 0 || side > 0);
    }
  /* None where the sign of the parametric drive's factor changes, and none for a pendulum. */
  pendres_pendulum strong = some[0];
  assert_true(pendres_pendulum_leaves(&strong));
  strong.parametric_amplitude = 1.0;
  assert_false(pendres_pendulum_leaves(&strong));
  assert_false(pendres_model_escapes(&strong, 1e6, 1.0));
  strong.force = PENDRES_FORCE_PENDULUM;
  assert_false(pendres_model_escapes(&strong, 1e6, 1.0));
  pendres_pendulum ring = some[3];
  assert_true(pendres_pendulum_leaves(&ring));
  ring.force_coefficients[0] = 0.1;
  assert_false(pendres_pendulum_leaves(&ring));
  assert_false(pendres_model_escapes(&ring, 1e6, 1.0));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(helmholtz), cmocka_unit_test(inverted),
    cmocka_unit_test(own_force),
    cmocka_unit_test(ring_in_tongue), cmocka_unit_test(bound),
  };
  return cmocka_run_group_tests_name("escape", tests, NULL, NULL);
}
