/*
 * test_linear.c -- oscillators under a linear force, whose motion grows without bound in the
 * tongues of parametric resonance: against characteristic values of Mathieu's equation, and against
 * an integration that shares nothing with the library; and at rest.
 */
#include "check.h"

#include <float.h>

#include <gsl/gsl_sf_mathieu.h>

#include <pendres/pendres.h>

static pendres_pendulum oscillator(double damping, double frequency, double amplitude)
{
  return (pendres_pendulum){.damping = damping, .drive_frequency = frequency,
                            .parametric_amplitude = amplitude, .force = PENDRES_FORCE_POLYNOMIAL,
                            .force_coefficients = {1.0}};
}

static pendres_context *context(void)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  return ctx;
}

/*
 * The largest Floquet exponent by the classical method of Runge and Kutta, whose local errors of
 * fifth order add up to some 1e-12 with these steps: from the trace, and from Liouville's theorem
 * for the determinant.
 */
static double floquet(const pendres_pendulum *p)
{
  enum { STEPS = 20000 };
  const double period = 2.0 * PENDRES_PI / p->drive_frequency, h = period / STEPS;
  double s[2][2] = {{1.0, 0.0}, {0.0, 1.0}};
  for (int n = 0; n < STEPS; n++)
    for (int k = 0; k < 2; k++) {
      double a[4], u[4];
      for (int i = 0; i < 4; i++) {
        const double c = i == 0 ? 0.0 : i == 3 ? 1.0 : 0.5;
        const double x = i == 0 ? s[k][0] : s[k][0] + c * h * u[i - 1];
        const double drive = cos(p->drive_frequency * (n + c) * h);
        u[i] = i == 0 ? s[k][1] : s[k][1] + c * h * a[i - 1];
        a[i] = -p->damping * u[i] -
               p->force_coefficients[0] * x * (1.0 + p->parametric_amplitude * drive);
      }
      s[k][0] += h / 6.0 * (u[0] + 2.0 * u[1] + 2.0 * u[2] + u[3]);
      s[k][1] += h / 6.0 * (a[0] + 2.0 * a[1] + 2.0 * a[2] + a[3]);
    }
  const double half = 0.5 * (s[0][0] + s[1][1]), determinant = exp(-p->damping * period);
  const double root = half * half - determinant;
  const double modulus = root > 0.0 ? fabs(half) + sqrt(root) : sqrt(determinant);
  return log(modulus) / period;
}

/* Every point of a map of tongues has its exponent: where it is above 0 all motions escape, and
   elsewhere there is an orbit. */
static void map(void **state)
{
  enum { FREQUENCIES = 21, AMPLITUDES = 16, N = FREQUENCIES * AMPLITUDES };
  pendres_pendulum p[N];
  pendres_settled found[N];
  double x[N], v[N];
  int growing = 0;
  pendres_context *ctx = context();
  (void)state;
  for (int i = 0; i < N; i++) {
    p[i] = oscillator(0.1, 0.5 + 0.1 * (i / AMPLITUDES), 0.1 * (i % AMPLITUDES));
    /* Neither a drive nor a torque is of any account to a linear oscillator's multipliers. */
    if (i % 3 == 1) p[i].drive_amplitude = 0.3;
    if (i % 3 == 2) p[i].torque = 0.2;
    x[i] = 0.1;
    v[i] = 0.0;
  }
  check_ok(pendres_lyapunov_find(ctx, N, p, x, v, NULL, found));
  for (int i = 0; i < N; i++) {
    const double exact = floquet(&p[i]);
    /* Next to where two multipliers meet their difference is a root, and errors of the test's own
       integration, 1e-13, count for up to their root, too. */
    const double own = 1e-12 + 1e-13 / fmax(fabs(exact + 0.05), 1e-6);
    check_near(found[i].exponent, exact, found[i].exponent_error + own);
    assert_true(found[i].exponent_error < 1e-6);
    assert_int_equal(found[i].label, exact > 0.0 ? PENDRES_LABEL_ESCAPE : PENDRES_LABEL_PERIODIC);
    assert_int_equal(found[i].period, exact > 0.0 ? 0 : 1);
    growing += exact > 0.0;
  }
  assert_int_equal(growing, 134);
  pendres_context_free(ctx);
}

/*
 * With x = u exp(-damping t / 2) and time t = 2 s / omega the equation is Mathieu's, u'' + (a - 2 q
 * cos 2s) u = 0. u grows exactly where a lies between characteristic values, a_n and b_n of q.
 */
static void mathieu(void **state)
{
  static const double amplitudes[] = {0.1, 0.4, 0.8}, damping = 1e-3, off = 1e-3;
  pendres_context *ctx = context();
  (void)state;
  for (int k = 0; k < 3; k++)
    for (int n = 1; n <= 3; n++)
      for (int side = 0; side < 2; side++) {
        /* Of all a and q with a fixed ratio that belong to this oscillator, those with a = a_n(q)
           or b_n(q): by halving. */
        const double own = 1.0 - 0.25 * damping * damping;
        double low = 1.0 / n, high = 4.0 / n;
        for (int i = 0; i < 60; i++) {
          const double omega = 0.5 * (low + high), q = 2.0 * amplitudes[k] / (omega * omega);
          gsl_sf_result value;
          assert_int_equal(side == 0 ? gsl_sf_mathieu_a_e(n, q, &value)
                                     : gsl_sf_mathieu_b_e(n, q, &value), 0);
          if (4.0 * own / (omega * omega) > value.val) low = omega;
          else high = omega;
        }
        /* a falls with omega: tongues lie between a_n, on their lower edge in omega, and b_n. */
        const double inwards = side == 0 ? 1.0 : -1.0;
        for (int way = -1; way <= 1; way += 2) {
          const pendres_pendulum p =
            oscillator(damping, low * (1.0 + way * inwards * off * (n < 3 ? 1.0 : 0.01)),
                       amplitudes[k]);
          const double x = 0.1, v = 0.0;
          pendres_settled found;
          check_ok(pendres_lyapunov_find(ctx, 1, &p, &x, &v, NULL, &found));
          if (way < 0) check_near(found.exponent, -0.5 * damping, found.exponent_error + 1e-12);
          else assert_true(found.exponent > -0.5 * damping + 10.0 * found.exponent_error);
        }
      }
  pendres_context_free(ctx);
}

/* In a tongue every start escapes, at once and for certain; outside none does. */
static void all_escape(void **state)
{
  enum { N = 50 };
  pendres_context *ctx = context();
  (void)state;
  for (int grows = 0; grows < 2; grows++) {
    pendres_pendulum p[N];
    pendres_settled outcome[N];
    pendres_attractors *set = NULL;
    double x[N], v[N];
    for (int i = 0; i < N; i++) {
      p[i] = oscillator(0.1, 2.0, grows ? 0.21 : 0.19);
      p[i].drive_amplitude = 0.1;
      x[i] = -1.0 + 0.04 * i;
      v[i] = 0.3;
    }
    assert_int_equal(floquet(&p[0]) > 0.0, grows);
    check_ok(pendres_settle(ctx, N, p, x, v, outcome, &set));
    assert_int_equal(pendres_attractors_count(set), !grows);
    for (int i = 0; i < N; i++) {
      assert_int_equal(outcome[i].label == PENDRES_LABEL_ESCAPE, grows);
      assert_int_equal(outcome[i].attractor, grows ? PENDRES_ATTRACTOR_ESCAPED : 0);
      assert_true(outcome[i].certain);
    }
    pendres_attractors_free(set);
  }
  pendres_context_free(ctx);
}

/* Members that escape are counted apart from those of which nothing is known. */
static void response(void **state)
{
  const pendres_ensemble e = pendres_ensemble_default();
  pendres_pendulum p = oscillator(0.1, 2.0, 1.0);
  pendres_response r;
  pendres_context *ctx = context();
  (void)state;
  p.drive_amplitude = 0.1;
  check_ok(pendres_response_find(ctx, 1, &p, &e, &r));
  assert_int_equal(r.unresolved, 0);
  assert_int_equal(r.escaped, e.members);
  p.parametric_amplitude = 0.1;
  check_ok(pendres_response_find(ctx, 1, &p, &e, &r));
  assert_int_equal(r.unresolved, 0);
  assert_int_equal(r.escaped, 0);
  pendres_context_free(ctx);
}

/* What rests dissipates nothing. Rounding moves it at its own frequency, here some six times that
   of the drive that does not drive: speeds then have so much more of it than places. */
static void rest_dissipates_nothing(void **state)
{
  static const struct {
    double a1, damping, frequency, torque, x, v, tolerance;
  } cases[] = {
    {1665517.0556048499, 3605.4886076342309, 205.10288159516026, -3130382473.5875106,
     -2584.4633044782945, 6839388.3873940324, 1.9910852708535799e-09},
    {537391739.38797307, 53328.558285457708, 4500.3170718002884, 354942920.38559419,
     0.69582953644462875, -3155.8705689074068, 3.2978762475378451e-11},
    {0.0019439156686559102, 0.012787580441936548, 0.0055333257367304193, 0.17375054653236321,
     150.75419217262353, -4.7468773137602458, 3.7965484907739939e-09},
    {1.4341843578561111e-12, 3.4534242301403392e-06, 1.7628200030028026e-07,
     9.3446012711767336e-13, -0.54970407227221019, -1.9400812177830802e-07,
     1.2168470171197158e-10}};
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    pendres_pendulum p = oscillator(cases[i].damping, cases[i].frequency, 0.0);
    pendres_context *ctx = NULL;
    pendres_orbit o;
    pendres_status outcome;
    p.force_coefficients[0] = cases[i].a1;
    p.torque = cases[i].torque;
    const pendres_orbit_guess guess = {
      .pendulum = p, .x = cases[i].x, .v = cases[i].v, .period = 1};
    check_ok(pendres_context_create(&(pendres_options){.tolerance = cases[i].tolerance}, &ctx));
    check_ok(
      pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_FREQUENCY_SLOPE, &o, &outcome));
    assert_int_equal(outcome, PENDRES_OK);
    assert_true(o.dissipation <= o.dissipation_error);
    pendres_context_free(ctx);
  }
}

/* A sweep that comes into the tongue about twice the natural frequency goes to infinity, once. What
   has gone there does not return, nor go there again: neither on the way out of the tongue. */
static void escapes_once(void **state)
{
  const double value[] = {0.4, 1.6, 2.0, 2.1, 4.0};
  enum { VALUES = sizeof value / sizeof *value };
  const pendres_hysteresis_path along = {PENDRES_DRIVE_FREQUENCY, VALUES, value};
  pendres_pendulum p = oscillator(0.1, value[0], -0.5);
  pendres_context *ctx = NULL;
  pendres_hysteresis *h = NULL;
  (void)state;
  p.drive_amplitude = 0.05;
  check_ok(pendres_context_create(NULL, &ctx));
  check_ok(pendres_hysteresis_find(ctx, &p, &(pendres_state){-0.16, 0.04}, &along, &h));
  pendres_context_free(ctx);
  assert_int_equal(pendres_hysteresis_jump_count(h), 1);
  const pendres_jump *jump = pendres_hysteresis_jump_get(h, 0);
  assert_int_equal(jump->from, PENDRES_LABEL_PERIODIC);
  assert_int_equal(jump->to, PENDRES_LABEL_ESCAPE);
  assert_int_equal(jump->kind, PENDRES_JUMP_FLIP);
  assert_true(jump->value > value[1] && jump->value < value[2]);
  for (size_t i = 0; i < VALUES; i++)
    assert_int_equal(pendres_hysteresis_get(h, i)->attractor.label,
                     i < 2 ? PENDRES_LABEL_PERIODIC : PENDRES_LABEL_ESCAPE);
  pendres_hysteresis_free(h);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(map), cmocka_unit_test(mathieu), cmocka_unit_test(all_escape),
    cmocka_unit_test(response), cmocka_unit_test(rest_dissipates_nothing),
    cmocka_unit_test(escapes_once)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
