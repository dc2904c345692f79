/*
 * test_branch_point.c -- branches that cross: where they do, the branch that crosses, states that
 * are followed through, and what is only nearly a crossing.
 *
 * References: Floquet theory of Mathieu's equation with damping, integrated here by Taylor series
 * in long double; an equilibrium in closed form; and reference.h for orbits of the nonlinear
 * equation.
 */
#include <stdlib.h>

#include <pendres/pendres.h>

#include "branch_fixture.h"

#include "continuation/sets.h"
#include "oracle/reference.h"

/* The lopsided well x - 0.6 x^2 + x^3/2 under a parametric drive: rest is an orbit at every b. */
static pendres_pendulum lopsided(double b, double torque)
{
  return (pendres_pendulum){.damping = 0.1, .drive_frequency = 1.0, .torque = torque,
                            .parametric_amplitude = b, .force = PENDRES_FORCE_POLYNOMIAL,
                            .force_coefficients = {1.0, -0.6, 0.5}};
}

static pendres_context *context(double tolerance)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx));
  return ctx;
}

static pendres_orbit orbit_near(pendres_context *ctx, const pendres_pendulum *p, double x, double v)
{
  pendres_orbit orbit;
  pendres_status outcome;
  const pendres_orbit_guess guess = {.pendulum = *p, .x = x, .v = v, .period = 1};
  check_ok(pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome));
  check_ok(outcome);
  return orbit;
}

static pendres_branch *followed(pendres_context *ctx, const pendres_orbit *start,
                                pendres_parameter parameter, double low, double high)
{
  const pendres_branch_options options = {.parameter = parameter, .low = low, .high = high};
  pendres_branch *b = NULL;
  check_ok(pendres_branch_follow(ctx, start, &options, &b));
  for (size_t i = 0; i < pendres_branch_count(b); i++)
    assert_int_equal(pendres_branch_get(b, i)->doubt, 0);
  return b;
}

/* ---- rest ---- */

/* One period of z'' + gamma z' + k (1 + b cos omega t) z = 0 from (z, v), by Taylor series of
   degree 30 in steps of a 64th: the remainder is below 1e-30. */
static void mathieu_period(long double gamma, long double k, long double b, long double omega,
                           long double z[2])
{
  enum { STEPS = 64, DEGREE = 30 };
  const long double two_pi = 6.28318530717958647692528676655900577L, h = two_pi / omega / STEPS;
  for (int step = 0; step < STEPS; step++) {
    long double s[DEGREE + 2] = {z[0], z[1]}, c[DEGREE + 1], power = 1.0L, sum[2] = {0.0L, 0.0L};
    const long double phase = two_pi * step / STEPS;
    for (int n = 0; n <= DEGREE; n++) { /* the cosine's own coefficients */
      const long double part = n % 4 == 0   ? cosl(phase)
                               : n % 4 == 1 ? -sinl(phase)
                               : n % 4 == 2 ? -cosl(phase)
                                            : sinl(phase);
      c[n] = b * part * power + (n == 0 ? 1.0L : 0.0L);
      power *= omega / (n + 1);
    }
    for (int n = 0; n < DEGREE; n++) {
      long double product = 0.0L;
      for (int i = 0; i <= n; i++) product += c[i] * s[n - i];
      s[n + 2] = -(gamma * (n + 1) * s[n + 1] + k * product) / ((n + 1) * (n + 2));
    }
    for (int n = DEGREE + 1; n > 0; n--) {
      sum[0] = (sum[0] + s[n]) * h;
      sum[1] = sum[1] * h + n * s[n];
    }
    z[0] = sum[0] + s[0];
    z[1] = sum[1];
  }
}

/* (1 - m1)(1 - m2) of the multipliers, whose product is exact. */
static long double distance_from_one(long double gamma, long double k, long double b,
                                     long double omega)
{
  const long double two_pi = 6.28318530717958647692528676655900577L;
  long double first[2] = {1.0L, 0.0L}, second[2] = {0.0L, 1.0L};
  mathieu_period(gamma, k, b, omega, first);
  mathieu_period(gamma, k, b, omega, second);
  return 1.0L - (first[0] + second[1]) + expl(-gamma * two_pi / omega);
}

/* The b at which rest has a multiplier +1, by bisection. */
static double mathieu_edge(double gamma, double k, double omega, double low, double high)
{
  long double a = low, b = high;
  const int sign = distance_from_one(gamma, k, a, omega) > 0.0L;
  assert_true(sign != (distance_from_one(gamma, k, b, omega) > 0.0L));
  for (int i = 0; i < 70; i++) {
    const long double middle = 0.5L * (a + b);
    if ((distance_from_one(gamma, k, middle, omega) > 0.0L) == sign) a = middle;
    else b = middle;
  }
  return (double)a;
}

/* Rest in the lopsided well, and in the right one of Duffing's two, which is no centre of a mirror
   symmetry though there is one. */
static void rest_exchanges_its_stability(void **state)
{
  static const double tolerances[] = {1e-6, 1e-9, 1e-12};
  (void)state;
  check_near(mathieu_edge(0.1, 1.0, 1.0, 0.7, 0.8), 0.74366394560982, 1e-14);
  for (int k = 0; k < 3; k++) {
    pendres_context *ctx = context(tolerances[k]);
    const pendres_pendulum p = lopsided(0.6, 0.0);
    const pendres_orbit rest = orbit_near(ctx, &p, 0.0, 0.0);
    pendres_branch *b = followed(ctx, &rest, PENDRES_PARAMETRIC_AMPLITUDE, 0.5, 1.0);
    const pendres_bifurcation *at = only(b, PENDRES_BRANCH_POINT);
    assert_int_equal(pendres_branch_bifurcation_count(b), 1);
    assert_non_null(at);
    check_near(at->value, mathieu_edge(0.1, 1.0, 1.0, 0.7, 0.8), at->value_error);
    assert_true(at->value_error <= tolerances[k]);
    check_near(at->orbit.multiplier_re[0], 1.0, 0.0);
    pendres_branch_free(b);

    pendres_pendulum wells = {.damping = 0.2, .drive_frequency = 1.3,
                              .force = PENDRES_FORCE_POLYNOMIAL,
                              .force_coefficients = {-1.0, 0.0, 1.0}};
    const pendres_orbit right = orbit_near(ctx, &wells, 1.0, 0.0);
    b = followed(ctx, &right, PENDRES_PARAMETRIC_AMPLITUDE, -0.1, 1.0);
    at = only(b, PENDRES_BRANCH_POINT);
    assert_non_null(at);
    check_near(at->value, mathieu_edge(0.2, 2.0, 1.3, 0.1, 1.0), at->value_error);
    check_near(at->orbit.x, 1.0, at->orbit.x_error);
    pendres_branch_free(b);
    pendres_context_free(ctx);
  }
}

/* Without any drive: x = 0 and x = -a1/a2 cross at a1 = 0. */
static void equilibria_cross(void **state)
{
  pendres_context *ctx = context(1e-9);
  const pendres_pendulum p = {.damping = 0.3, .drive_frequency = 1.0,
                              .force = PENDRES_FORCE_POLYNOMIAL,
                              .force_coefficients = {0.2, 1.0}};
  const pendres_orbit rest = orbit_near(ctx, &p, 0.0, 0.0);
  (void)state;
  pendres_branch *b = followed(ctx, &rest, PENDRES_A1, -0.3, 0.3);
  const pendres_bifurcation *at = only(b, PENDRES_BRANCH_POINT);
  assert_non_null(at);
  check_near(at->value, 0.0, at->value_error);
  check_near(at->crossing[1] / at->crossing[0], 0.0, 1e-6);
  check_near(at->crossing[2] / at->crossing[0], -1.0, 1e-6);
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/*
 * Rest at a1 = 0, come to from either side, where rounding leaves a1 at some 1e-19: its own branch
 * goes on, and the other one, x = -a1/a2 or x^2 = -a1/a3 in closed form, is switched to there and
 * led through or out of it.
 */
static void coefficient_that_vanishes(void **state)
{
  static const double from[2] = {0.2, -0.2};
  (void)state;
  for (int k = 0; k < 4; k++) {
    const int cubic = k / 2;
    pendres_context *ctx = context(1e-9);
    pendres_pendulum p = {.damping = 0.3, .drive_frequency = 1.0,
                          .force = PENDRES_FORCE_POLYNOMIAL,
                          .force_coefficients = {from[k % 2], !cubic, cubic}};
    const pendres_orbit rest = orbit_near(ctx, &p, 0.0, 0.0);
    pendres_branch *b = followed(ctx, &rest, PENDRES_A1, -0.3, 0.3);
    assert_int_equal(pendres_branch_bifurcation_count(b), 1);
    const pendres_bifurcation *at = pendres_branch_bifurcation_get(b, 0);
    assert_int_equal(at->kind, cubic ? PENDRES_SYMMETRY_BREAKING : PENDRES_BRANCH_POINT);
    check_near(at->value, 0.0, at->value_error);
    pendres_orbit other;
    check_ok(pendres_branch_switch(ctx, at, &other));
    const double a1 = other.pendulum.force_coefficients[0];
    if (cubic) check_near(other.x * other.x, -a1, 4.0 * fabs(other.x) * other.x_error);
    else check_near(other.x, -a1, other.x_error);
    pendres_branch *second = followed(ctx, &other, PENDRES_A1, -0.3, 0.3);
    double lowest = INFINITY, highest = -INFINITY;
    for (size_t i = 0; i < pendres_branch_count(second); i++) {
      const pendres_orbit *o = &pendres_branch_get(second, i)->orbit;
      const double here = o->pendulum.force_coefficients[0];
      check_near(cubic ? o->x * o->x : o->x, -here, 1e-8);
      lowest = fmin(lowest, here);
      highest = fmax(highest, here);
    }
    check_near(lowest, -0.3, 1e-12);
    if (cubic) check_near(highest, 0.0, 1e-8);
    else check_near(highest, 0.3, 1e-12);
    pendres_branch_free(second);
    pendres_branch_free(b);
    pendres_context_free(ctx);
  }
}

/* ---- the branch that crosses ---- */

/* The mean of (m - 1)^2 of the two orbits that meet in a fold, m their larger multipliers: with a
   fold's root taken out it is smooth in the parameter, and 0 at the fold. */
static double squares_at(pendres_context *ctx, const pendres_branch *b,
                         const pendres_bifurcation *f, double off)
{
  enum { MOST = 8 };
  pendres_orbit orbit[MOST];
  size_t n = 0, used = 0;
  double sum = 0.0;
  check_ok(pendres_branch_cross(ctx, b, f->value - off, MOST, orbit, &n));
  for (size_t i = 0; i < n && i < MOST; i++) {
    if (hypot(orbit[i].x - f->orbit.x, orbit[i].v - f->orbit.v) > 0.05) continue;
    reference_cycle c;
    check_ok(
      reference_orbit(&orbit[i].pendulum, orbit[i].x, orbit[i].v, 1, 0, &c));
    const double excess = (double)(c.multiplier_re[0] - 1.0L);
    sum += excess * excess;
    used++;
  }
  assert_int_equal(used, 2);
  return 0.5 * sum;
}

/* Where that vanishes, by a parabola through three places before the fold. The next term of the
   series is the cube of 1e-5 over the distance to the branch point, 8e-3: some 1e-12. */
static void is_fold(pendres_context *ctx, const pendres_branch *b, const pendres_bifurcation *f)
{
  const double h = 5e-6;
  double g[3];
  for (int k = 0; k < 3; k++) g[k] = squares_at(ctx, b, f, (k + 1) * h);
  /* At the distance 0, from those at 1, 2 and 3 h; its slope is about g[0] / h. */
  check_near((3.0 * g[0] - 3.0 * g[1] + g[2]) / (g[0] / h), 0.0, f->value_error + 1e-10);
}

static void the_other_branch(void **state)
{
  pendres_context *ctx = context(1e-10);
  const pendres_pendulum p = lopsided(0.6, 0.0);
  const pendres_orbit rest = orbit_near(ctx, &p, 0.0, 0.0);
  (void)state;
  pendres_branch *b = followed(ctx, &rest, PENDRES_PARAMETRIC_AMPLITUDE, 0.5, 1.0);
  const pendres_bifurcation *at = only(b, PENDRES_BRANCH_POINT);
  pendres_orbit other;
  check_ok(pendres_branch_switch(ctx, at, &other));
  assert_true(other.stable && other.pendulum.parametric_amplitude > at->value);
  pendres_branch *crossing = followed(ctx, &other, PENDRES_PARAMETRIC_AMPLITUDE, 0.73, 1.0);
  const pendres_bifurcation *back = only(crossing, PENDRES_BRANCH_POINT);
  const pendres_bifurcation *fold = NULL;
  assert_non_null(back);
  check_near(back->value, at->value, back->value_error + at->value_error);
  check_near(back->orbit.x, 0.0, back->orbit.x_error);
  /* From there rest is what crosses. */
  check_near(hypot(back->crossing[0], back->crossing[1]) / back->crossing[2], 0.0, 1e-6);
  pendres_orbit down;
  check_ok(pendres_branch_switch(ctx, back, &down));
  check_near(down.x, 0.0, 1e-9);
  assert_true(down.stable && down.pendulum.parametric_amplitude < at->value);
  for (size_t i = 0; i < pendres_branch_bifurcation_count(crossing); i++)
    if (fabs(pendres_branch_bifurcation_get(crossing, i)->value - 0.751508) < 1e-5)
      fold = pendres_branch_bifurcation_get(crossing, i);
  assert_non_null(fold);
  assert_int_equal(fold->kind, PENDRES_FOLD);
  is_fold(ctx, crossing, fold);

  /* Folds are looked for beyond the branch point, and it is not taken for one. */
  pendres_fold found;
  check_ok(pendres_fold_find(ctx, &other, PENDRES_PARAMETRIC_AMPLITUDE, &found));
  check_near(found.value, 0.66667101973548, found.value_error + 1e-13); /* the nearer, downwards */
  pendres_branch_free(crossing);
  assert_int_equal(pendres_fold_find(ctx, &rest, PENDRES_PARAMETRIC_AMPLITUDE, &found),
                   PENDRES_NOT_FOUND);
  /* Its curve is that of the tongue's edge; a torque would part the branches: there is none. */
  pendres_curve *curve = NULL;
  pendres_curve_options options = {
    .second = PENDRES_DAMPING, .low = {0.5, 0.05}, .high = {1.0, 0.2}};
  check_ok(pendres_curve_follow(ctx, at, &options, &curve));
  assert_int_equal(pendres_curve_kind_get(curve), PENDRES_BRANCH_POINT);
  assert_true(pendres_curve_count(curve) > 5);
  for (size_t i = 0; i < pendres_curve_count(curve); i++) {
    const pendres_curve_point *c = pendres_curve_get(curve, i);
    const pendres_pendulum *q = &c->orbit.pendulum;
    /* Both parameters have errors: the edge's slope by the damping is below 4. */
    check_near(q->parametric_amplitude, mathieu_edge(q->damping, 1.0, 1.0, 0.3, 1.2),
               c->value_error[0] + 4.0 * c->value_error[1]);
  }
  pendres_curve_free(curve);
  options = (pendres_curve_options){
    .second = PENDRES_TORQUE, .low = {0.5, -0.1}, .high = {1.0, 0.1}};
  check_ok(pendres_curve_follow(ctx, at, &options, &curve));
  assert_int_equal(pendres_curve_count(curve), 1);
  pendres_curve_free(curve);
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/* ---- what only comes close ---- */

/*
 * A small torque keeps the branches apart: on one side there are two folds, on the other none. The
 * folds' distances from the crossing go with the root of the torque, and the branch from below
 * bends into the one that crosses.
 */
static void nearly_crossing(void **state)
{
  static const double torques[] = {1e-4, 1e-6, 1e-8, 1e-10};
  const double crossing = mathieu_edge(0.1, 1.0, 1.0, 0.7, 0.8);
  pendres_context *ctx = context(1e-10);
  double away = NAN;
  (void)state;
  for (int k = 0; k < 4; k++) {
    pendres_pendulum p = lopsided(0.6, torques[k]);
    pendres_orbit rest = orbit_near(ctx, &p, 0.0, 0.0);
    pendres_branch *b = followed(ctx, &rest, PENDRES_PARAMETRIC_AMPLITUDE, 0.55, 1.0);
    assert_null(only(b, PENDRES_BRANCH_POINT));
    const pendres_bifurcation *first = pendres_branch_bifurcation_get(b, 0);
    assert_int_equal(first->kind, PENDRES_FOLD);
    check_near(first->value, 0.751508215299, 10.0 * torques[k] + 1e-11);
    pendres_branch_free(b);

    p = lopsided(0.6, -torques[k]);
    rest = orbit_near(ctx, &p, 0.0, 0.0);
    b = followed(ctx, &rest, PENDRES_PARAMETRIC_AMPLITUDE, 0.55, 1.0);
    assert_null(only(b, PENDRES_BRANCH_POINT));
    first = pendres_branch_bifurcation_get(b, 0);
    assert_int_equal(first->kind, PENDRES_FOLD);
    assert_true(first->value < crossing && first->value_error < 1e-8);
    const double here = (crossing - first->value) / sqrt(torques[k]);
    if (k > 1) check_near(here, away, 0.05 * away); /* corrections go with the root, too */
    away = here;
    pendres_branch_free(b);
  }
  pendres_context_free(ctx);
}

/* ---- sweeps ---- */

/* Up from rest: over to the other branch without a jump, then off at its fold; and back down from
   the other branch to rest. */
static void sweeps_pass_through(void **state)
{
  static const double up[] = {0.7, 0.74, 0.745, 0.75, 0.755, 0.76};
  static const double down[] = {0.75, 0.745, 0.74, 0.7};
  pendres_context *ctx = context(1e-9);
  const pendres_pendulum p = lopsided(0.0, 0.0);
  pendres_hysteresis *h = NULL;
  (void)state;
  check_ok(pendres_hysteresis_find(
    ctx, &p, &(pendres_state){0.05, 0.0},
    &(pendres_hysteresis_path){PENDRES_PARAMETRIC_AMPLITUDE, 6, up}, &h));
  assert_int_equal(pendres_hysteresis_jump_count(h), 2);
  const pendres_jump *first = pendres_hysteresis_jump_get(h, 0),
  *next = pendres_hysteresis_jump_get(h, 1);
  assert_int_equal(first->kind, PENDRES_JUMP_BRANCH_POINT);
  assert_true(first->gradual && first->certain);
  check_near(first->value, mathieu_edge(0.1, 1.0, 1.0, 0.7, 0.8), first->value_error);
  assert_int_equal(next->kind, PENDRES_JUMP_FOLD);
  check_near(next->value, 0.751508215299, next->value_error + 1e-12);
  assert_true(next->to != PENDRES_LABEL_UNRESOLVED && !next->gradual);
  check_near(pendres_hysteresis_get(h, 1)->attractor.orbit.amplitude, 0.0, 1e-12);
  assert_true(pendres_hysteresis_get(h, 2)->attractor.orbit.amplitude > 1e-3);
  pendres_hysteresis_free(h);

  const pendres_pendulum at = lopsided(0.745, 0.0);
  const pendres_orbit other = orbit_near(ctx, &at, -0.0037, -0.0138);
  check_ok(pendres_hysteresis_find(
    ctx, &p, &(pendres_state){other.x - 0.01, other.v - 0.07},
    &(pendres_hysteresis_path){PENDRES_PARAMETRIC_AMPLITUDE, 4, down}, &h));
  assert_int_equal(pendres_hysteresis_jump_count(h), 1);
  first = pendres_hysteresis_jump_get(h, 0);
  assert_int_equal(first->kind, PENDRES_JUMP_BRANCH_POINT);
  assert_true(first->gradual && first->direction < 0);
  check_near(pendres_hysteresis_get(h, 3)->attractor.orbit.amplitude, 0.0, 1e-12);
  pendres_hysteresis_free(h);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(rest_exchanges_its_stability),
    cmocka_unit_test(equilibria_cross),
    cmocka_unit_test(coefficient_that_vanishes),
    cmocka_unit_test(the_other_branch),
    cmocka_unit_test(nearly_crossing),
    cmocka_unit_test(sweeps_pass_through),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
