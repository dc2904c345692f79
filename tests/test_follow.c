/*
 * test_follow.c -- orbits of driven oscillators followed in every parameter that these have.
 *
 * References: oracle.h (extrapolated midpoint rule in long double, time instead of phase, no shared
 * code), Floquet theory of Mathieu's equation (GSL).
 */
#include "check.h"
#include "continuation/sets.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_sf_mathieu.h>

#include <pendres/pendres.h>

#include "oracle.h"

#define COUNT(a) (sizeof(a) / sizeof *(a))

static const double half_pi = 1.57079632679489661923;

static pendres_context *context(double tolerance)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx));
  return ctx;
}

/* A field of the oracle's that is a parameter. */
static long double *field_of(oracle *o, pendres_parameter parameter)
{
  switch (parameter) {
  case PENDRES_DRIVE_FREQUENCY: return &o->omega;
  case PENDRES_DAMPING: return &o->gamma;
  case PENDRES_DRIVE_AMPLITUDE: return &o->drive;
  case PENDRES_TORQUE: return &o->torque;
  case PENDRES_PARAMETRIC_AMPLITUDE: return &o->b;
  case PENDRES_NONLINEAR_DAMPING: return &o->eta;
  case PENDRES_CUBIC_DAMPING: return &o->cubic;
  default: return &o->a[parameter - PENDRES_A1];
  }
}

/*
 * The same bifurcation by the oracle, from a start that is off by 1e-6: it is within the error that
 * is claimed, and that is within 1e-10. The oracle itself is good to 1e-14.
 */
static void check_bifurcation(const pendres_bifurcation *f)
{
  oracle o = oracle_of(&f->orbit.pendulum);
  long double *const parameter = field_of(&o, f->parameter);
  const double origin = pendres_model_of(f->orbit.pendulum.force)->origin;
  const int sign = f->kind == PENDRES_PERIOD_DOUBLING ? -1 : 1;
  double left = NAN;
  *parameter += 1e-6L;
  const double value = oracle_bifurcation(&o, parameter, f->orbit.period, f->orbit.winding, sign,
                                          f->orbit.x - origin + 1e-6, f->orbit.v - 1e-6, &left);
  assert_true(left < 1e-14);
  assert_true(f->value_error < 1e-10);
  check_near(f->value, value, f->value_error + 1e-14);
}

/* A branch of the state that a pendulum settles on from (x, v), along a parameter. */
static pendres_branch *branch_of(pendres_context *ctx, const pendres_orbit *o,
                                 pendres_parameter parameter, double low, double high)
{
  const pendres_branch_options options = {.parameter = parameter, .low = low, .high = high};
  pendres_branch *b = NULL;
  check_ok(pendres_branch_follow(ctx, o, &options, &b));
  for (size_t i = 0; i < pendres_branch_count(b); i++)
    assert_int_equal(pendres_branch_get(b, i)->doubt, 0);
  return b;
}

static pendres_orbit settled(pendres_context *ctx, const pendres_pendulum *p)
{
  pendres_orbit_guess g = {.pendulum = *p, .period = 1};
  pendres_status outcome = PENDRES_INTERNAL;
  pendres_orbit o;
  check_ok(pendres_strobe_advance(ctx, 1, p, &g.x, &g.v, 150, NULL));
  check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
  check_ok(outcome);
  return o;
}

/* Duffing's and Helmholtz's oscillators along each of their parameters: so many bifurcations. */
static void oscillators(void **state)
{
  static const struct {
    pendres_pendulum p;
    pendres_parameter parameter;
    double low, high;
    size_t bifurcations;
  } cases[] = {
#define DUFFING                                                            \
  {.damping = 0.1, .drive_amplitude = 0.5, .drive_frequency = 1.3,         \
   .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, 1.0}}
#define HELMHOLTZ                                                          \
  {.damping = 0.1, .drive_amplitude = 0.06, .drive_frequency = 0.8,        \
   .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, -1.0}}
#define RING                                                               \
  {.damping = 0.1, .drive_amplitude = 0.3, .drive_frequency = 0.8,         \
   .force = PENDRES_FORCE_SQUID, .force_coefficients = {0.1}}
    {RING, PENDRES_DRIVE_FREQUENCY, 0.5, 1.2, 1},
    {RING, PENDRES_A1, 0.02, 0.8, 2},
    {DUFFING, PENDRES_DRIVE_FREQUENCY, 1.3, 2.22, 2},
    {DUFFING, PENDRES_DRIVE_AMPLITUDE, 0.05, 0.6, 2},
    {DUFFING, PENDRES_PARAMETRIC_AMPLITUDE, 0.0, 0.8, 1},
    {DUFFING, PENDRES_A3, 0.05, 1.1, 2},
    {DUFFING, PENDRES_A4, -0.6, 0.1, 1},
    {HELMHOLTZ, PENDRES_DRIVE_FREQUENCY, 0.7, 1.0, 1},
    {HELMHOLTZ, PENDRES_TORQUE, -0.1, 0.3, 5},
    {HELMHOLTZ, PENDRES_A1, 0.8, 1.2, 2},
  };
  pendres_context *ctx = context(1e-10);
  (void)state;
  for (size_t i = 0; i < COUNT(cases); i++) {
    const pendres_orbit o = settled(ctx, &cases[i].p);
    pendres_branch *b = branch_of(ctx, &o, cases[i].parameter, cases[i].low, cases[i].high);
    assert_int_equal(pendres_branch_bifurcation_count(b), cases[i].bifurcations);
    for (size_t m = 0; m < pendres_branch_bifurcation_count(b); m++)
      check_bifurcation(pendres_branch_bifurcation_get(b, m));
    pendres_branch_free(b);
  }
  pendres_context_free(ctx);
}

/* A state that turns over `winding` times a period, at the first torque that has one. */
static pendres_orbit running(pendres_context *ctx, pendres_pendulum p, int winding)
{
  enum { TORQUES = 64, PERIODS = 60 };
  pendres_pendulum pendulum[TORQUES];
  double x[TORQUES], v[TORQUES], from[TORQUES];
  for (int i = 0; i < TORQUES; i++) {
    pendulum[i] = p;
    pendulum[i].torque = 0.04 * i;
    x[i] = half_pi;
    v[i] = winding * p.drive_frequency;
  }
  check_ok(pendres_strobe_advance(ctx, TORQUES, pendulum, x, v, PERIODS, NULL));
  memcpy(from, x, sizeof from);
  check_ok(pendres_strobe_advance(ctx, TORQUES, pendulum, x, v, 1, NULL));
  for (int i = 0; i < TORQUES; i++) {
    const pendres_orbit_guess g = {
      .pendulum = pendulum[i], .x = x[i], .v = v[i], .period = 1, .winding = winding};
    pendres_status outcome;
    pendres_orbit o;
    if (fabs(x[i] - from[i] - 2.0 * (double)ORACLE_PI * winding) > 0.1) continue;
    check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
    if (outcome == PENDRES_OK && o.stable) return o;
  }
  fail_msg("no orbit of winding %d", winding);
  return (pendres_orbit){.period = 0};
}

/*
 * Where Shapiro steps begin and end: the folds of states of winding 0 to 3 along the torque. Their
 * branches close, the way round leading from one well to the next; the orbits that the states of no
 * winding meet at their folds lie on top of the barrier, and the branch is its own mirror image.
 */
static void steps(void **state)
{
  static const pendres_pendulum p = {
    .damping = 0.2, .drive_amplitude = 1.0, .drive_frequency = 1.6};
  pendres_context *ctx = context(1e-10);
  (void)state;
  for (int winding = 0; winding <= 3; winding++) {
    const pendres_orbit o = running(ctx, p, winding);
    pendres_branch *b = branch_of(ctx, &o, PENDRES_TORQUE, -3.0, 3.0);
    size_t folds = 0;
    assert_int_equal(pendres_branch_end_get(b, 0), PENDRES_END_CLOSED);
    for (size_t m = 0; m < pendres_branch_bifurcation_count(b); m++) {
      const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, m);
      check_bifurcation(f);
      folds += f->kind == PENDRES_FOLD;
    }
    assert_int_equal(folds, 2);
    pendres_branch_free(b);
  }
  pendres_context_free(ctx);
}

/* ---- parametric resonance ---- */

/* Rest of a pendulum, or of a polynomial oscillator, at the bottom of its well. */
static pendres_orbit rest(pendres_context *ctx, const pendres_pendulum *p)
{
  const pendres_orbit_guess g = {
    .pendulum = *p, .x = p->force == PENDRES_FORCE_PENDULUM ? half_pi : 0.0, .period = 1};
  pendres_status outcome = PENDRES_INTERNAL;
  pendres_orbit o;
  check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
  check_ok(outcome);
  return o;
}

/* The boundaries of tongues along a parameter: two with multipliers -1, two with +1. */
static pendres_branch *tongues(pendres_context *ctx, const pendres_pendulum *p)
{
  const pendres_orbit o = rest(ctx, p);
  pendres_branch *b = branch_of(ctx, &o, PENDRES_DRIVE_FREQUENCY, 0.85, 3.0);
  size_t count[PENDRES_SPECIAL_COUNT] = {0};
  for (size_t i = 0; i < pendres_branch_bifurcation_count(b); i++)
    count[pendres_branch_bifurcation_get(b, i)->kind]++;
  assert_int_equal(count[PENDRES_FOLD], 0);
  assert_int_equal(count[PENDRES_PERIOD_DOUBLING], 2);
  assert_int_equal(count[PENDRES_SYMMETRY_BREAKING], 2);
  return b;
}

/*
 * Without damping x'' + a1 (1 + b cos omega t) x = 0 is Mathieu's equation with a = 4 a1 / omega^2
 * and q = 2 a1 b / omega^2, and the boundaries are its characteristic values of order 1, with
 * multipliers -1, and of order 2. GSL's are good to 1e-13.
 */
static void mathieu(void **state)
{
  const pendres_pendulum p = {.drive_frequency = 1.5, .parametric_amplitude = 0.7,
                              .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.3}};
  pendres_context *ctx = context(1e-11);
  pendres_branch *b = tongues(ctx, &p);
  (void)state;
  for (size_t i = 0; i < pendres_branch_bifurcation_count(b); i++) {
    const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, i);
    const double a1 = p.force_coefficients[0], square = f->value * f->value;
    const double a = 4.0 * a1 / square, q = 2.0 * a1 * p.parametric_amplitude / square;
    const int order = f->kind == PENDRES_PERIOD_DOUBLING ? 1 : 2;
    const double even = gsl_sf_mathieu_a(order, q), odd = gsl_sf_mathieu_b(order, q);
    const double near = fabs(a - even) < fabs(a - odd) ? even : odd;
    assert_true(f->value_error < 1e-10);
    check_near(a, near, 4.0 * a / f->value * f->value_error + 1e-12);
  }
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/* With damping the same by the oracle's multipliers of a pendulum at rest. */
static void damped_tongues(void **state)
{
  const pendres_pendulum p = {.damping = 0.1, .drive_frequency = 1.5, .parametric_amplitude = 0.7};
  const long double still[2] = {0.0L, 0.0L}, h = 1e-5L;
  pendres_context *ctx = context(1e-10);
  pendres_branch *b = tongues(ctx, &p);
  (void)state;
  for (size_t i = 0; i < pendres_branch_bifurcation_count(b); i++) {
    const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, i);
    const int sign = f->kind == PENDRES_PERIOD_DOUBLING ? -1 : 1;
    oracle o = oracle_of(&f->orbit.pendulum);
    o.omega += 1e-6L;
    for (int round = 0; round < 3; round++) {
      long double miss[3], high[3], low[3];
      const long double omega = o.omega;
      oracle_miss(&o, 1, 0, sign, still, miss);
      o.omega = omega + h;
      oracle_miss(&o, 1, 0, sign, still, high);
      o.omega = omega - h;
      oracle_miss(&o, 1, 0, sign, still, low);
      o.omega = omega - 2.0L * h * miss[2] / (high[2] - low[2]);
    }
    assert_true(f->value_error < 1e-10);
    check_near(f->value, (double)o.omega, f->value_error + 1e-14);
  }
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/* The pairs and the orbits of two periods that rest gives birth to are followed back to it, where
   they meet what they were born at, once. */
static void born_of_rest(void **state)
{
  const pendres_pendulum p = {.damping = 0.1, .drive_frequency = 1.5, .parametric_amplitude = 0.7};
  pendres_context *ctx = context(1e-9);
  pendres_branch *b = tongues(ctx, &p);
  (void)state;
  for (size_t i = 0; i < pendres_branch_bifurcation_count(b); i++) {
    const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, i);
    const int doubling = f->kind == PENDRES_PERIOD_DOUBLING;
    pendres_orbit o;
    check_ok(pendres_branch_switch(ctx, f, &o));
    assert_int_equal(o.period, doubling ? 2 : 1);
    assert_true(o.amplitude > 1e-3);
    pendres_branch *born =
      branch_of(ctx, &o, PENDRES_DRIVE_FREQUENCY, f->value - 0.15, f->value + 0.15);
    size_t met = 0;
    for (size_t k = 0; k < pendres_branch_bifurcation_count(born); k++) {
      const pendres_bifurcation *at = pendres_branch_bifurcation_get(born, k);
      met += at->kind == f->kind && fabs(at->value - f->value) < 1e-8;
    }
    assert_int_equal(met, 1);
    pendres_branch_free(born);
  }
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/*
 * Under a parametric drive alone an orbit of six periods may be its own mirror image three periods
 * later. It loses that symmetry where a multiplier of three periods and the reflection is -1, by
 * the oracle, which is no fold: the parameter does not turn there.
 */
static void symmetric_after_three_periods(void **state)
{
  const pendres_pendulum p = {
    .damping = 0.1, .drive_frequency = 1.655, .parametric_amplitude = 0.6};
  const pendres_orbit_guess g = {
    .pendulum = p, .x = 3.9146139, .v = -0.2149686, .period = 6};
  pendres_context *ctx = context(1e-10);
  pendres_status outcome = PENDRES_INTERNAL;
  pendres_orbit o;
  size_t breakings = 0;
  (void)state;
  check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
  check_ok(outcome);
  pendres_branch *b = branch_of(ctx, &o, PENDRES_DRIVE_FREQUENCY, 1.64, 1.67);
  for (size_t i = 0; i < pendres_branch_bifurcation_count(b); i++) {
    const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, i);
    double left = NAN;
    oracle mirror = oracle_of(&f->orbit.pendulum);
    if (f->kind != PENDRES_SYMMETRY_BREAKING) continue;
    breakings++;
    mirror.reflects = 1;
    mirror.omega += 1e-7L;
    const double value = oracle_bifurcation(&mirror, &mirror.omega, 3, 0, -1,
                                            f->orbit.x - half_pi, f->orbit.v, &left);
    assert_true(left < 1e-13 && f->value_error < 1e-9);
    check_near(f->value, value, f->value_error + 1e-13);
  }
  assert_int_equal(breakings, 1);
  assert_int_equal(pendres_branch_bifurcation_count(b), 2); /* and a fold */
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/*
 * Under a parametric drive alone orbits of two periods may be born of orbits of one, by doubling,
 * and not of rest: the branch leads through that doubling to the same orbits one period later. That
 * is a doubling of the orbit of one period, by the oracle, and no fold of theirs; and both halves
 * of the branch meet the next doubling at one frequency.
 */
static void born_of_a_doubling(void **state)
{
  static const int periods[] = {2, 1, 2};
  const pendres_pendulum p = {
    .damping = 0.1, .drive_frequency = 0.85, .parametric_amplitude = 0.9};
  const pendres_orbit_guess g = {.pendulum = p, .x = 1.706, .v = 1.909, .period = 2};
  pendres_context *ctx = context(1e-10);
  pendres_status outcome = PENDRES_INTERNAL;
  pendres_orbit o;
  (void)state;
  check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
  check_ok(outcome);
  pendres_branch *b = branch_of(ctx, &o, PENDRES_DRIVE_FREQUENCY, 0.836, 0.86);
  assert_int_equal(pendres_branch_bifurcation_count(b), COUNT(periods));
  for (size_t i = 0; i < COUNT(periods); i++) {
    const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, i);
    assert_int_equal(f->kind, PENDRES_PERIOD_DOUBLING);
    assert_int_equal(f->orbit.period, periods[i]);
    check_bifurcation(f);
  }
  pendres_branch_free(b);
  pendres_context_free(ctx);
}

/* What cannot be followed, or not along this, is refused. */
static void refusals(void **state)
{
  pendres_context *ctx = context(1e-8);
  const pendres_pendulum p = {.damping = 0.2, .drive_amplitude = 1.0, .drive_frequency = 1.6};
  pendres_orbit o = settled(ctx, &p);
  pendres_branch_options options = {
    .parameter = PENDRES_A1, .low = 0.0, .high = 1.0};
  pendres_branch *b = NULL;
  pendres_fold fold;
  (void)state;
  assert_int_equal(pendres_branch_follow(ctx, &o, &options, &b), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "no such coefficient"));
  o.pendulum.drive_amplitude = 0.0;
  o.winding = 1;
  assert_int_equal(pendres_fold_find(ctx, &o, PENDRES_TORQUE, &fold),
                   PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(pendres_context_message(ctx), "period of its own"));
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(oscillators), cmocka_unit_test(steps),
                                     cmocka_unit_test(mathieu),
                                     cmocka_unit_test(damped_tongues),
                                     cmocka_unit_test(born_of_rest),
                                     cmocka_unit_test(symmetric_after_three_periods),
                                     cmocka_unit_test(born_of_a_doubling),
                                     cmocka_unit_test(refusals)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
