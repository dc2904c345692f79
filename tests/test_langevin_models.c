/*
 * test_langevin_models.c -- noise with a torque, a parametric drive and polynomial forces: against
 * exact stationary distributions, linear theory where it is exact, and Stratonovich's formula.
 */
#include "langevin_fixture.h"

#include <string.h>

#include "noise/noise_common.h"

static const char *const names[PENDRES_LANGEVIN_STATISTICS] = {
  "mean x", "mean v", "var x", "cov xv", "var v", "cosine", "sine", "loop area"};

/* A cloud of what starts at x, with so many steps; its bias is measured beside it. */
static pendres_langevin_cloud cloud_of(pendres_context *ctx, pendres_langevin_request q, int steps,
                                       pendres_langevin_bias *bias)
{
  pendres_langevin_cloud c;
  q.steps_per_period = steps;
  check_ok(pendres_langevin_cloud_find(ctx, &q, &c, NULL, NULL));
  check_ok(pendres_langevin_measure_bias(ctx, &q, bias));
  return c;
}

/* A statistic less its bias is what it should be, and known well enough to tell. */
static void check_statistic(const pendres_langevin_cloud *c, const pendres_langevin_bias *bias,
                            int s, double want, double known_to)
{
  const pendres_langevin_estimate e = c->statistics[s], b = bias->statistics[s];
  const double error = hypot(e.error, b.error);
  print_message("%s: %.6f, exact %.6f, %.1f standard errors, bias %.1e\n", names[s], e.value, want,
                (e.value - b.value - want) / error, b.value);
  check_near(e.value - b.value, want, sigmas * error + 0.2 * fabs(b.value));
  assert_true(error < known_to);
}

/*
 * A linear force: the driven response has a closed form whatever the temperature, and the variances
 * are those of equipartition, T/a1 and T. With a parametric drive linear theory is exact.
 */
static void linear_forces_are_exact_at_any_temperature(void **state)
{
  const double a1 = 2.3, g = 0.4, w = 1.3, f0 = 0.7, T = 3.0;
  pendres_pendulum p = {.damping = g, .drive_amplitude = f0, .drive_frequency = w, .temperature = T,
                        .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {a1}};
  const double stiff = a1 - w * w, amplitude = f0 / hypot(stiff, g * w), lag = atan2(g * w, stiff);
  const double x = amplitude * cos(lag), v = w * amplitude * sin(lag);
  const double want[PENDRES_LANGEVIN_STATISTICS] = {
    x, v, T / a1, 0.0, T, x, amplitude * sin(lag), PI * f0 * amplitude * sin(lag)};
  pendres_context *ctx = make(31, 0, 192);
  pendres_langevin_linear linear;
  pendres_langevin_bias bias;
  pendres_langevin_request q = {.pendulum = p, .x = x, .v = v, .trajectories = 1536, .settle = 12,
                                .record = 60};
  (void)state;
  check_ok(pendres_langevin_linear_find(&p, x, v, 1, &linear));
  check_relative(linear.covariance.xx, T / a1, 1e-9);
  check_near(linear.covariance.xv, 0.0, 1e-9);
  check_relative(linear.covariance.vv, T, 1e-9);
  check_near(linear.closure, 0.0, 1e-9);
  const pendres_langevin_cloud c = cloud_of(ctx, q, 20, &bias);
  for (int s = 0; s < PENDRES_LANGEVIN_STATISTICS; s++)
    check_statistic(&c, &bias, s, want[s], 0.05);
  q.pendulum.parametric_amplitude = 0.5;
  q.pendulum.drive_amplitude = 0.0;
  q.x = q.v = 0.0;
  check_ok(pendres_langevin_linear_find(&q.pendulum, 0.0, 0.0, 1, &linear));
  assert_true(fabs(linear.covariance.vv - T) > 0.3); /* the drive's phase matters */
  const pendres_langevin_cloud d = cloud_of(ctx, q, 20, &bias);
  check_statistic(&d, &bias, PENDRES_LANGEVIN_COV_XX, linear.covariance.xx, 0.05);
  check_statistic(&d, &bias, PENDRES_LANGEVIN_COV_XV, linear.covariance.xv, 0.05);
  check_statistic(&d, &bias, PENDRES_LANGEVIN_COV_VV, linear.covariance.vv, 0.05);
  pendres_context_free(ctx);
}

/*
 * Forces that are stiff, or weak beside a strong friction, ask for other steps than the pendulum's.
 * Without drive the variances are those of equipartition. The error is the largest of three, with v
 * counted in the force's own units of time, and the leading term of what is left: twice it covers
 * the others. Rounding is beside it, 1e-14 for decays of 1e-4 a period.
 */
static void linear_theory_resolves_stiff_forces(void **state)
{
  (void)state;
  for (double a1 = 1e-4; a1 < 2e6; a1 *= 10.0) {
    const pendres_pendulum p = {.damping = 0.4, .drive_frequency = 1.3, .temperature = 1e-3,
                                .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {a1}};
    const double t = pendres_units_of(&p).time, xx = 1e-3 / a1, vv = 1e-3 * t * t;
    pendres_langevin_linear linear;
    check_ok(pendres_langevin_linear_find(&p, 0.0, 0.0, 1, &linear));
    const pendres_langevin_covariance *c = &linear.covariance;
    const double within = 2.0 * linear.error + 1e-14 * xx;
    print_message("a1 = %g: off by %.1e, %.1e, %.1e, estimated %.1e of %.1e\n", a1, c->xx - xx,
                  c->xv * t, c->vv * t * t - vv, linear.error, xx);
    check_near(c->xx, xx, within);
    check_near(c->xv * t, 0.0, within);
    check_near(c->vv * t * t, vv, within);
    assert_true(linear.error < 1e-7 * xx);
  }
}

/* Mean and variance of x under exp(-U/T), by the trapezoidal rule over all that counts: the density
 * and all its derivatives vanish at both ends, so that it is as exact as rounding. */
static void boltzmann(const pendres_pendulum *p, double *mean, double *variance)
{
  double sum[3] = {0.0};
  for (int i = -4000; i <= 4000; i++) {
    const double x = 1e-3 * i, w = exp(-pendres_pendulum_energy(p, x, 0.0) / p->temperature);
    for (int k = 0; k < 3; k++) sum[k] += w * pow(x, k);
  }
  *mean = sum[1] / sum[0];
  *variance = sum[2] / sum[0] - *mean * *mean;
}

/* Duffing's double well, a lopsided force with all powers and a torque, and a ring with a junction,
   whose force has a header of its own; without drive. */
static void forces_have_boltzmanns_distribution(void **state)
{
  enum { CASES = 3 };
  const pendres_pendulum cases[CASES] = {
    {.damping = 0.5, .drive_frequency = 2.0, .temperature = 0.4,
     .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0, 0.0, 1.0}},
    {.damping = 0.7, .drive_frequency = 2.0, .temperature = 0.5, .torque = 0.4,
     .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {0.5, 0.6, 1.0, 0.3, 0.4}},
    {.damping = 0.7, .drive_frequency = 2.0, .temperature = 0.5, .torque = 0.3,
     .force = PENDRES_FORCE_SQUID, .force_coefficients = {0.6}}};
  (void)state;
  for (int i = 0; i < CASES; i++) {
    pendres_context *ctx = make(32, 0, 192);
    pendres_langevin_bias bias;
    double mean, variance;
    const pendres_langevin_request q = {.pendulum = cases[i], .x = 0.1, .trajectories = 1536,
                                        .settle = 20, .record = 60};
    boltzmann(&cases[i], &mean, &variance);
    const pendres_langevin_cloud c = cloud_of(ctx, q, 24, &bias);
    check_statistic(&c, &bias, PENDRES_LANGEVIN_MEAN_X, mean, 0.02);
    check_statistic(&c, &bias, PENDRES_LANGEVIN_MEAN_V, 0.0, 0.02);
    check_statistic(&c, &bias, PENDRES_LANGEVIN_COV_XX, variance, 0.02);
    check_statistic(&c, &bias, PENDRES_LANGEVIN_COV_XV, 0.0, 0.02);
    check_statistic(&c, &bias, PENDRES_LANGEVIN_COV_VV, cases[i].temperature, 0.02);
    pendres_context_free(ctx);
  }
}

/*
 * A pendulum that a torque turns over: what the torque puts in, friction takes but for what noise
 * gives back, I <v> = gamma (<v^2> - T), exactly. Without the torque, var v is T.
 */
static void torques_work_against_friction(void **state)
{
  const pendres_pendulum p = {.damping = 0.4, .drive_frequency = 1.0, .temperature = 0.6,
                              .torque = 0.5};
  pendres_context *ctx = make(33, 0, 192);
  pendres_langevin_bias bias;
  const pendres_langevin_request q = {.pendulum = p, .x = PI / 2.0, .trajectories = 1536,
                                      .settle = 15, .record = 60};
  (void)state;
  const pendres_langevin_cloud c = cloud_of(ctx, q, 48, &bias);
  const pendres_langevin_estimate v = c.statistics[PENDRES_LANGEVIN_MEAN_V];
  const pendres_langevin_estimate vv = c.statistics[PENDRES_LANGEVIN_COV_VV];
  const double put_in = p.torque * v.value;
  const double taken = p.damping * (vv.value + v.value * v.value - p.temperature);
  const double error = hypot(fabs(p.torque - 2.0 * p.damping * v.value) * v.error,
                             p.damping * vv.error);
  const double off = fabs(p.torque - 2.0 * p.damping * v.value) *
                       fabs(bias.statistics[PENDRES_LANGEVIN_MEAN_V].value) +
                     p.damping * fabs(bias.statistics[PENDRES_LANGEVIN_COV_VV].value);
  print_message("torque's power %.5f, taken %.5f, %.1f standard errors\n", put_in, taken,
                (put_in - taken) / error);
  check_near(put_in, taken, sigmas * error + off);
  assert_true(put_in > 30.0 * error);
  pendres_context_free(ctx);
}

/* Mean velocity of the overdamped pendulum under a torque: Stratonovich, Topics in the Theory of
 * Random Noise II (1967), chapter 9; Risken, The Fokker-Planck Equation, section 11.3. Periodic
 * integrands, so that equal steps are as exact as rounding. */
static double stratonovich(const pendres_pendulum *p)
{
  enum { N = 256 };
  const double h = 2.0 * PI / N, I = p->torque, T = p->temperature;
  double sum = 0.0;
  for (int i = 0; i < N; i++)
    for (int k = 0; k <= N; k++) {
      /* exp((U(a + b) - U(a)) / T) over b from 0 to 2 pi is no periodic function of b: the
       * trapezoidal rule's own error, (2 pi)^2 / 12 of the slope's jump, is corrected for. */
      const double a = i * h, b = k * h;
      const double e = exp((cos(a) - cos(a + b) - I * b) / T);
      const double slope = e * (sin(a + b) - I) / T;
      if (k == 0) sum += h * h * (0.5 * e + h / 12.0 * slope);
      else if (k == N) sum += h * h * (0.5 * e - h / 12.0 * slope);
      else sum += h * h * e;
    }
  return 2.0 * PI * T / p->damping * (1.0 - exp(-2.0 * PI * I / T)) / sum;
}

static void overdamped_junctions_drift_as_stratonovich_says(void **state)
{
  enum { N = 1536, PERIODS = 120, SETTLE = 10 };
  const pendres_pendulum p = {.damping = 25.0, .drive_frequency = 0.5, .temperature = 0.3,
                              .torque = 0.7};
  static pendres_pendulum all[N];
  static double x[N], v[N], start[N];
  pendres_context *ctx = make(34, 0, 192);
  double mean = 0.0, square = 0.0;
  (void)state;
  for (int i = 0; i < N; i++) all[i] = p, x[i] = PI / 2.0, v[i] = 0.0;
  pendres_langevin_run run = {.n = N, .pendulums = all, .periods = SETTLE, .steps_per_period = 240};
  check_ok(pendres_langevin_advance(ctx, &run, x, v));
  memcpy(start, x, sizeof start);
  run.first_period = SETTLE;
  run.periods = PERIODS;
  check_ok(pendres_langevin_advance(ctx, &run, x, v));
  const double time = PERIODS * 2.0 * PI / p.drive_frequency;
  for (int i = 0; i < N; i++) mean += (x[i] - start[i]) / time / N;
  for (int i = 0; i < N; i++) square += pow((x[i] - start[i]) / time - mean, 2.0);
  const double error = sqrt(square / N / (N - 1.0)), want = stratonovich(&p);
  print_message("mean velocity %.6f +- %.6f, overdamped %.6f\n", mean, error, want);
  /* What inertia adds is of the order of 1/gamma^2, with curvatures up to 1. */
  check_near(mean, want, sigmas * error + 3.0 * want / (p.damping * p.damping));
  assert_true(error < 0.02 * want);
  pendres_context_free(ctx);
}

/* Bit for bit: who is beside whom does not matter, whatever their forces. */
static void neighbours_of_other_models_do_not_matter(void **state)
{
  enum { N = 60 };
  pendres_pendulum p[N];
  double x[N], v[N];
  pendres_context *ctx = make(35, 16, 192);
  (void)state;
  for (int i = 0; i < N; i++) {
    p[i] = figure7(0.1);
    if (i / 7 % 3 == 1) p[i].torque = 0.01 * i;
    if (i % 5 == 2) p[i].parametric_amplitude = 0.4;
    if (i % 4 == 3) {
      p[i].force = PENDRES_FORCE_POLYNOMIAL;
      p[i].force_coefficients[0] = 0.5;
      p[i].force_coefficients[2] = 0.01 * i;
    }
    x[i] = 0.02 * i;
    v[i] = 0.1;
  }
  check_ok(pendres_langevin_advance(ctx, RUN(N, p, NULL, 0, 6, NULL), x, v));
  for (int i = 0; i < N; i++) {
    const uint64_t id = (uint64_t)i;
    double a = 0.02 * i, b = 0.1;
    check_ok(pendres_langevin_advance(ctx, RUN(1, &p[i], &id, 0, 6, NULL), &a, &b));
    assert_true(a == x[i] && b == v[i]);
  }
  pendres_context_free(ctx);
}

/* A ring is a spring far out. Where its parametric drive makes oscillations there grow, in tongues
   that begin far below b = 1 as well as above, noise has no steady state, however stable the states
   within are; and has one where they decay. Oscillations that begin at 200 tell. */
static void rings_are_lost_in_tongues(void **state)
{
  enum { PERIODS = 10 };
  static const double far = 200.0;
  int lost = 0, kept = 0;
  pendres_context *ctx = make(0, 0, 8);
  (void)state;
  for (double b = 0.25; b < 2.0; b += 0.25)
    for (double omega = 0.5; omega < 2.1; omega += 0.5) {
      const pendres_pendulum p = {
        .damping = 0.1, .drive_amplitude = 0.1, .drive_frequency = omega,
        .parametric_amplitude = b, .force = PENDRES_FORCE_SQUID, .force_coefficients = {0.5}};
      double x = far, v = 0.0;
      check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, PERIODS, NULL));
      const int refused = pendres_noise_refuses(&p) != NULL, strong = b >= 1.0;
      if (hypot(x, v) > 3.0 * far) assert_true(refused);
      else if (hypot(x, v) < 0.3 * far) assert_false(refused);
      else continue;
      lost |= refused << strong;
      kept |= !refused << strong;
    }
  assert_int_equal(lost, 3);
  assert_int_equal(kept, 3);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(linear_forces_are_exact_at_any_temperature),
    cmocka_unit_test(linear_theory_resolves_stiff_forces),
    cmocka_unit_test(forces_have_boltzmanns_distribution),
    cmocka_unit_test(torques_work_against_friction),
    cmocka_unit_test(overdamped_junctions_drift_as_stratonovich_says),
    cmocka_unit_test(neighbours_of_other_models_do_not_matter),
    cmocka_unit_test(rings_are_lost_in_tongues),
  };
  return cmocka_run_group_tests_name("langevin_models", tests, NULL, NULL);
}
