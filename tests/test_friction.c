/*
 * test_friction.c -- friction that is not proportional to the velocity: motions that are known
 * exactly, and an integration of its own for the rest.
 *
 * References: harmonic motion, on which eta x^2 v + (eta / omega^2) v^3 is eta v; the turning
 * points of a free oscillator under c v |v|, whose energy is known as a function of x; oracle.h
 * (extrapolated midpoint rule in long double), which for |v| stops where v = 0.
 */
#include "check.h"

#include <math.h>
#include <string.h>

#include <pendres/pendres.h>

#include "continuation/sets.h"
#include "oracle.h"

#define COUNT(a) (sizeof(a) / sizeof *(a))

static const double two_pi = 6.283185307179586;

static pendres_context *context(double tolerance)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx));
  return ctx;
}

static pendres_orbit orbit_near(pendres_context *ctx, const pendres_pendulum *p, double x, double v)
{
  const pendres_orbit_guess g = {.pendulum = *p, .x = x, .v = v, .period = 1};
  pendres_status outcome = PENDRES_INTERNAL;
  pendres_orbit o;
  check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
  check_ok(outcome);
  return o;
}

static double product(const pendres_orbit *o)
{
  return o->multiplier_re[0] * o->multiplier_re[1] - o->multiplier_im[0] * o->multiplier_im[1];
}

/*
 * x = cos(omega t - phi) under a spring: friction is (gamma + eta) v on it, and its divergence has
 * the mean gamma + 2 eta. A dozen roundings of numbers of order one.
 */
static void harmonic(void **state)
{
  pendres_context *ctx = context(1e-11);
  const double eta = 0.4, gamma = 0.1, omega = 1.3, spring = 1.0 - omega * omega;
  const double lost = (gamma + eta) * omega;
  const pendres_pendulum p = {.damping = gamma, .drive_amplitude = hypot(spring, lost),
                              .drive_frequency = omega, .nonlinear_damping = eta,
                              .cubic_damping = eta / (omega * omega),
                              .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0}};
  const double phi = atan2(lost, spring), period = two_pi / omega;
  const pendres_orbit o = orbit_near(ctx, &p, cos(phi), omega * sin(phi));
  (void)state;
  check_near(o.x, cos(phi), o.x_error);
  check_near(o.v, omega * sin(phi), o.v_error);
  check_near(o.amplitude, 1.0, o.amplitude_error);
  check_near(o.phase_lag, phi, o.phase_lag_error);
  check_near(o.dissipation, (gamma + eta) * omega * omega * 0.5 * period, o.dissipation_error);
  check_relative(product(&o), exp(-(gamma + 2.0 * eta) * period), 1e-13);
  assert_true(o.x_error < 1e-11 && o.dissipation_error < 1e-10 && o.multiplier_error < 1e-10);
  assert_true(o.symmetric);
  pendres_context_free(ctx);
}

/* A resonance of a weakly damped drum: F0 = omega A (gamma + eta A^2 / 4) at a lag of a quarter of
   a turn, to first order in eta and the third harmonic, which is below eta A^2 / 32. */
static void resonance(void **state)
{
  pendres_context *ctx = context(1e-10);
  (void)state;
  for (int i = 0; i < 2; i++) {
    const double eta = 0.02 * (i + 1), gamma = 0.01, A = 0.5 + 0.2 * i;
    const pendres_pendulum p = {.damping = gamma, .drive_amplitude = A * (gamma + eta * A * A / 4),
                                .drive_frequency = 1.0, .nonlinear_damping = eta,
                                .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0}};
    const pendres_orbit o = orbit_near(ctx, &p, 0.0, A);
    check_near(o.first_harmonic_amplitude, A, eta * A * A * A / 32.0);
    check_near(o.phase_lag, 0.25 * two_pi, eta * A * A / 8.0);
  }
  pendres_context_free(ctx);
}

/* From rest at a, a spring under c v |v| turns at -b with (1 + 2ca) e^(-2ca) = (1 - 2cb) e^(2cb),
   by Newton's method from b = a. */
static double next_turn(double c, double a)
{
  const double left = (1.0 + 2.0 * c * a) * exp(-2.0 * c * a);
  double b = a / (1.0 + c * a);
  for (int k = 0; k < 60; k++)
    b -= ((1.0 - 2.0 * c * b) * exp(2.0 * c * b) - left) / (-4.0 * c * c * b * exp(2.0 * c * b));
  return b;
}

/* The largest and least x of a free decay, which are not at strobes: the energy at a strobe is less
   than at the turn before and more than at the next; and rest is left where the motion turns. */
static void decay(void **state)
{
  enum { SAMPLES = 4096, PERIODS = 3 };
  static double x[PERIODS * SAMPLES + 1], v[PERIODS * SAMPLES + 1];
  const double c = 0.15, a = 1.2;
  const pendres_pendulum p = {.drive_frequency = 1.0, .quadratic_damping = c,
                              .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0}};
  pendres_context *ctx = context(1e-11);
  const pendres_record record = {.x = x, .v = v};
  double turn = a;
  int seen = 0;
  (void)state;
  check_ok(pendres_strobe_record(ctx, &p, &(pendres_state){a, 0.0}, PERIODS, SAMPLES, &record));
  for (int k = 1; k + 1 < PERIODS * SAMPLES; k++) {
    if (!(v[k] * v[k + 1] < 0.0)) continue;
    turn = next_turn(c, turn);
    seen++;
    /* Between samples x is a parabola about the turn, to fourth order in 2e-3 and x''' h^3 / 6. */
    const double h = two_pi / SAMPLES, s = v[k] / (v[k] - v[k + 1]) * h;
    check_near(fabs(x[k] + 0.5 * v[k] * s), turn, 2e-9);
  }
  assert_int_equal(seen, 5);
  pendres_context_free(ctx);
}

static double uniform(double low, double high)
{
  static uint64_t state = 42;
  state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return low + (high - low) * ((double)(state >> 11) * 0x1p-53);
}

/* Random oscillators with all kinds of friction, or one of them. */
static pendres_pendulum random_pendulum(int i)
{
  pendres_pendulum p = {.damping = uniform(0.02, 0.3), .drive_amplitude = uniform(0.1, 0.8),
                        .drive_frequency = uniform(0.6, 1.8),
                        .quadratic_damping = i % 3 == 2 ? 0.0 : uniform(0.0, 0.3),
                        .cubic_damping = i % 3 == 1 ? 0.0 : uniform(0.0, 0.2)};
  if (i % 2 == 0) return p;
  p.force = PENDRES_FORCE_POLYNOMIAL;
  p.nonlinear_damping = uniform(0.0, 0.5);
  p.force_coefficients[0] = 1.0;
  p.force_coefficients[2] = uniform(0.2, 1.5);
  return p;
}

/* Orbits, their multipliers and their works are within their errors of the oracle's, and known to
   what was asked for. */
static void orbits(void **state)
{
  enum { PENDULUMS = CHECK_SHORT ? 3 : 9 }; /* sixty were compared once */
  pendres_context *ctx = context(1e-10), *loose = context(1e-4);
  int found = 0;
  double worst = 0.0;
  (void)state;
  for (int i = 0; i < PENDULUMS; i++) {
    const pendres_pendulum p = random_pendulum(i);
    const double origin = pendres_model_of(p.force)->origin;
    pendres_orbit_guess g = {.pendulum = p, .x = origin, .period = 1};
    pendres_status outcome = PENDRES_INTERNAL;
    pendres_orbit o;
    oracle q = oracle_of(&p);
    check_ok(pendres_strobe_advance(loose, 1, &p, &g.x, &g.v, 100, NULL));
    check_ok(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
    if (outcome != PENDRES_OK || o.winding != 0) continue;
    found++;
    long double start[2] = {o.x - origin, o.v};
    const long double area = oracle_loop_area(&q, start);
    long double s[ORACLE_SIZE] = {start[0], start[1], 1.0L, 0.0L, 0.0L, 1.0L};
    oracle_advance(&q, 1, s);
    check_near(o.x - origin, (double)start[0], o.x_error);
    check_near(o.v, (double)start[1], o.v_error);
    /* Samples of a drive's work in the oracle are 32, with |v| to some 1e-6. */
    if (p.quadratic_damping == 0.0)
      check_near(o.loop_area, (double)area, o.loop_area_error + 1e-12);
    check_near(product(&o), (double)(s[2] * s[5] - s[3] * s[4]),
               2.0 * o.multiplier_error * hypot(o.multiplier_re[0], o.multiplier_im[0]) + 1e-15);
    check_near(o.multiplier_re[0] + o.multiplier_re[1], (double)(s[2] + s[5]),
               2.0 * o.multiplier_error + 1e-15);
    worst = fmax(worst, fmax(o.x_error, o.v_error));
  }
  assert_true(2 * found >= PENDULUMS);
  check_near(worst, 0.0, 1e-10);
  pendres_context_free(loose);
  pendres_context_free(ctx);
}

/* Folds of a drum, x'' + gamma x' + eta x^2 x' + x + x^3 = F cos omega t, and with cubic damping:
   both ends of the interval of two states by the oracle's Newton method. */
static void folds(void **state)
{
  enum { SETS = 2 }; /* ten were compared once */
  pendres_context *ctx = context(1e-10);
  int seen = 0;
  (void)state;
  for (int i = 0; i < SETS; i++) {
    const pendres_pendulum p = {
      .damping = uniform(0.05, 0.1), .drive_amplitude = uniform(0.3, 0.5), .drive_frequency = 0.6,
      .nonlinear_damping = uniform(0.01, 0.08), .cubic_damping = i < 1 ? 0.0 : 0.02,
      .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, 1.0}};
    const pendres_orbit o = orbit_near(ctx, &p, p.drive_amplitude, 0.0);
    const pendres_branch_options options = {
      .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.6, .high = 4.0};
    pendres_branch *b = NULL;
    check_ok(pendres_branch_follow(ctx, &o, &options, &b));
    for (size_t m = 0; m < pendres_branch_bifurcation_count(b); m++) {
      const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, m);
      oracle q = oracle_of(&f->orbit.pendulum);
      double left = NAN;
      if (f->kind != PENDRES_FOLD) continue;
      q.omega += 1e-7L;
      const double value = oracle_bifurcation(&q, &q.omega, 1, 0, 1, f->orbit.x, f->orbit.v, &left);
      assert_true(left < 1e-12);
      check_near(f->value, value, fmin(f->value_error + 1e-14, 1e-9));
      seen++;
    }
    pendres_branch_free(b);
  }
  assert_true(seen >= 2 * SETS);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(harmonic),
    cmocka_unit_test(resonance),
    cmocka_unit_test(decay),
    cmocka_unit_test(orbits),
    cmocka_unit_test(folds),
  };
  return cmocka_run_group_tests_name("friction", tests, NULL, NULL);
}
