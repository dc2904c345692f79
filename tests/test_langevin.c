/*
 * test_langevin.c -- clouds, equilibrium, linear noise theory, rates.
 */
#include "langevin_fixture.h"

#include <stdlib.h>

#include <gsl/gsl_cdf.h>

#include "noise/noise_common.h"

/* Two periods of free flight with strong noise: the well counts for nothing. */
static void free_diffusion_is_ornstein_uhlenbeck(void **state)
{
  (void)state;
  enum { N = 4096 };
  const double g = 0.7, T = 1e6, t = 2.0 * PI;
  const pendres_langevin_request q = {.pendulum = {g, 0.3, 1.0, T}, .trajectories = N,
                                      .settle = 0, .record = 1};
  pendres_context *ctx = make(3, 24, 192);
  pendres_langevin_cloud c;
  check_ok(pendres_langevin_cloud_find(ctx, &q, &c, NULL, NULL));
  /* Uhlenbeck and Ornstein, Phys. Rev. 36 (1930) 823. The force of the well and the steps,
   * (gamma h)^4/2880, change these by less than 1e-5 relative. */
  const double e = exp(-g * t), one = -expm1(-g * t);
  const double vv = T * -expm1(-2.0 * g * t), xv = T / g * one * one;
  const double xx = T / (g * g) * (2.0 * g * t - 3.0 + 4.0 * e - e * e);
  const double want[3] = {xx, xv, vv};
  for (int i = 0; i < 3; i++) {
    const pendres_langevin_estimate s = c.statistics[PENDRES_LANGEVIN_COV_XX + i];
    check_near(s.value, want[i], sigmas * s.error);
    /* Errors of Gaussian variances: sqrt(2/N); of the covariance as its correlation r says:
     * sqrt((1 + r^2)/N) of the widths' product. A tenth for their own scatter. */
    const double r = xv / sqrt(xx * vv);
    const double error = i == 1 ? sqrt(xx * vv * (1.0 + r * r) / N) : want[i] * sqrt(2.0 / N);
    check_relative(s.error, error, 0.1);
  }
  pendres_context_free(ctx);
}

/* Around a well's bottom all is linear: Sigma(t) = T (1 - M M^T), undriven, from a point. */
static void small_oscillations_are_linear(void **state)
{
  (void)state;
  static const double damping[3] = {0.05, 0.5, 5.0};
  for (int i = 0; i < 3; i++) {
    const double T = 1e-10;
    const pendres_langevin_request q = {.pendulum = {damping[i], 0.0, 1.3, T}, .x = PI / 2.0,
                                        .trajectories = 4096, .settle = 1, .record = 1};
    pendres_langevin_linear lin;
    pendres_langevin_cloud c;
    pendres_context *ctx = make(4, damping[i] > 1.0 ? 64 : 24, 192);
    check_ok(pendres_langevin_linear_find(&q.pendulum, q.x, 0.0, 1, &lin));
    /* Equilibrium: equipartition, whatever the damping. */
    check_near(lin.covariance.xx, T, 1e-9 * T);
    check_near(lin.covariance.xv, 0.0, 1e-9 * T);
    check_near(lin.covariance.vv, T, 1e-9 * T);
    assert_true(lin.error < 1e-9 * T);

    /* Two periods: M^2. */
    const double *m = lin.monodromy;
    const double s[4] = {m[0] * m[0] + m[1] * m[2], m[0] * m[1] + m[1] * m[3],
                         m[2] * m[0] + m[3] * m[2], m[2] * m[1] + m[3] * m[3]};
    const double want[3] = {T * (1.0 - s[0] * s[0] - s[1] * s[1]),
                            T * (-s[0] * s[2] - s[1] * s[3]),
                            T * (1.0 - s[2] * s[2] - s[3] * s[3])};
    check_ok(pendres_langevin_cloud_find(ctx, &q, &c, NULL, NULL));
    for (int k = 0; k < 3; k++) {
      const pendres_langevin_estimate e = c.statistics[PENDRES_LANGEVIN_COV_XX + k];
      check_near(e.value, want[k], sigmas * e.error);
    }
    pendres_context_free(ctx);
  }
}

/* ---- Equilibrium ------------------------------------------------------------------------- */

/* Angles that cut Boltzmann's exp(cos y / T) in equal parts; returns its mean of cos y. */
static double boltzmann(double T, size_t parts, double *cuts)
{
  enum { POINTS = 20000 };
  const double width = 2.0 * PI / POINTS;
  double total = 0.0, mean = 0.0, sum = 0.0;
  size_t next = 1;
  for (int i = 0; i < POINTS; i++) {
    const double y = -PI + width * (i + 0.5), weight = exp((cos(y) - 1.0) / T);
    total += weight;
    mean += weight * cos(y);
  }
  for (int i = 0; i < POINTS && next < parts; i++) {
    const double weight = exp((cos(-PI + width * (i + 0.5)) - 1.0) / T);
    const double over = sum + weight - total * (double)next / (double)parts;
    sum += weight;
    if (over < 0.0) continue;
    cuts[next] = -PI + width * (i + 1 - over / weight);
    next++;
  }
  return mean / total;
}

static void check_equilibrium(double damping, double T)
{
  enum { N = 1536, RECORD = 30, BINS = 16 };
  /* Steps such that the bias (order four, largest for strong friction: 2e-4 of <v^2> at
   * damping 5, h = 0.1) is well below the statistical error of some 1e-3 or more. */
  const pendres_langevin_request q = {.pendulum = {damping, 0.0, 1.0, T}, .x = PI / 2.0,
                                      .trajectories = N, .record = RECORD,
                                      /* 19 or more times the slowest relaxation: energy at
                                       * weak friction, 1/gamma; position at strong, gamma. */
                                      .settle = damping < 0.1 ? 60 : 15};
  double cuts[BINS] = {0}, counts[BINS] = {0}, mean = 0.0, square = 0.0, chi2 = 0.0;
  double *x = malloc(N * RECORD * sizeof *x), *v = malloc(N * RECORD * sizeof *v);
  pendres_context *ctx = make(5, damping > 1.0 ? 64 : 14, 192);
  pendres_langevin_cloud c;

  assert_true(x != NULL && v != NULL);
  const double want = boltzmann(T, BINS, cuts);
  check_ok(pendres_langevin_cloud_find(ctx, &q, &c, x, v));
  const pendres_langevin_estimate vv = c.statistics[PENDRES_LANGEVIN_COV_VV];
  check_near(vv.value, T, sigmas * vv.error);
  /* An error that is itself sensible: between all strobes independent and all equal. */
  assert_true(vv.error > 0.9 * T * sqrt(2.0 / (N * RECORD)) && vv.error < T * sqrt(2.0 / N));

  for (size_t i = 0; i < N; i++) {
    double own = 0.0;
    for (size_t k = 0; k < RECORD; k++) own += sin(x[i * RECORD + k]) / RECORD;
    mean += own / N;
    square += own * own / N;
    /* One strobe of each trajectory: independent, so Pearson's test holds. */
    const double y = remainder(x[i * RECORD + RECORD - 1] - PI / 2.0, 2.0 * PI);
    size_t bin = 0;
    while (bin + 1 < BINS && y > cuts[bin + 1]) bin++;
    counts[bin] += 1.0;
  }
  check_near(mean, want, sigmas * sqrt((square - mean * mean) / (N - 1)));
  for (size_t b = 0; b < BINS; b++) {
    const double expected = (double)N / BINS;
    chi2 += (counts[b] - expected) * (counts[b] - expected) / expected;
  }
  /* The same chance to fail as 4.5 standard errors. */
  check_near(chi2, 0.0, gsl_cdf_chisq_Qinv(2.0 * gsl_cdf_ugaussian_Q(sigmas), BINS - 1));
  free(x);
  free(v);
  pendres_context_free(ctx);
}

static void equilibrium_is_boltzmann(void **state)
{
  (void)state;
  static const double damping[3] = {0.05, 0.5, 5.0}, temperature[3] = {0.05, 0.2, 1.0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) check_equilibrium(damping[i], temperature[j]);
}

/* ---- Clouds ------------------------------------------------------------------------------ */

static void clouds_of_figure7_are_linear(void **state)
{
  (void)state;
  for (int large = 0; large < 2; large++) {
    pendres_langevin_request q = {.pendulum = figure7(1e-4), .trajectories = 768, .settle = 60,
                                  .record = 300};
    pendres_langevin_linear lin;
    pendres_langevin_cloud c;
    pendres_langevin_bias bias;
    pendres_context *ctx = make(7, 0, 0);

    orbit(large, &q.x, &q.v);
    check_ok(pendres_langevin_linear_find(&q.pendulum, q.x, q.v, 1, &lin));
    check_near(lin.closure, 0.0, 1e-9);
    /* The determinant of the monodromy matrix is exp(-gamma tau), by Liouville. */
    check_relative(lin.monodromy[0] * lin.monodromy[3] - lin.monodromy[1] * lin.monodromy[2],
                   exp(-0.12 * 8.0), 1e-9);

    pendres_langevin_request few = q;
    few.trajectories = 192;
    few.record = 60;
    check_ok(pendres_langevin_choose_steps(ctx, &few, PENDRES_LANGEVIN_CLOUD, 0.01, &bias));
    q.steps_per_period = bias.steps_per_period;
    check_ok(pendres_langevin_cloud_find(ctx, &q, &c, NULL, NULL));
    assert_int_equal(c.left, 0);
    const double want[3] = {lin.covariance.xx, lin.covariance.xv, lin.covariance.vv};
    for (int k = 0; k < 3; k++) {
      const int s = PENDRES_LANGEVIN_COV_XX + k;
      const double error = hypot(c.statistics[s].error, bias.statistics[s].error);
      print_message("%s %d: %.4e, linear %.4e, %.1f standard errors, bias %.1e\n",
                    large ? "LA" : "SA", k, c.statistics[s].value, want[k],
                    (c.statistics[s].value - want[k]) / error, bias.statistics[s].value);
      check_near(c.statistics[s].value - bias.statistics[s].value, want[k], sigmas * error);
      /* And the comparison means something: errors of a per cent of the scale at most. */
      assert_true(error < 0.01 * bias.scale[s]);
    }
    pendres_context_free(ctx);
  }
}

static void chosen_steps_keep_their_bias(void **state)
{
  (void)state;
  for (int large = 0; large < 2; large++) {
    pendres_langevin_request q = {.pendulum = figure7(1e-5), .trajectories = 192, .settle = 40,
                                  .record = 20};
    pendres_langevin_bias bias;
    pendres_context *ctx = make(8, 0, 0);
    double x, v;

    orbit(large, &q.x, &q.v);
    check_ok(pendres_langevin_choose_steps(ctx, &q, PENDRES_LANGEVIN_CLOUD, 0.02, &bias));
    for (int s = 0; s <= PENDRES_LANGEVIN_COV_VV; s++)
      assert_true(fabs(bias.statistics[s].value) + 2.0 * bias.statistics[s].error <=
                  0.02 * bias.scale[s]);

    /* So little noise moves the mean with its orbit: the bias is the orbit's own. The next
     * order of the steps and of the noise may change it by a quarter. */
    pendres_pendulum still = figure7(0.0);
    x = q.x;
    v = q.v;
    const pendres_langevin_run run = {.n = 1, .pendulums = &still, .periods = 200,
                                      .steps_per_period = bias.steps_per_period};
    check_ok(pendres_langevin_advance(ctx, &run, &x, &v));
    const pendres_langevin_estimate *e = bias.statistics;
    check_near(e[PENDRES_LANGEVIN_MEAN_X].value, x - q.x,
               sigmas * e[PENDRES_LANGEVIN_MEAN_X].error + 0.25 * fabs(x - q.x));
    check_near(e[PENDRES_LANGEVIN_MEAN_V].value, v - q.v,
               sigmas * e[PENDRES_LANGEVIN_MEAN_V].error + 0.25 * fabs(v - q.v));
    pendres_context_free(ctx);
  }
}

/* Under a torque alone the coordinate does not swing with the drive's clock: no steps make a bias
 * small beside a harmonic of nothing, but beside the cloud's width. */
static void harmonics_of_nothing_have_steps(void **state)
{
  (void)state;
  pendres_langevin_request q = {.pendulum = figure7(1e-4), .trajectories = 192, .settle = 20,
                                .record = 60};
  pendres_langevin_bias bias;
  pendres_context *ctx = make(9, 0, 0);
  q.pendulum.drive_amplitude = 0.0;
  q.pendulum.torque = 0.3;
  q.x = asin(0.3) + acos(0.0); /* at rest, where sin(x - pi/2) balances the torque */
  check_ok(pendres_langevin_choose_steps(ctx, &q, PENDRES_LANGEVIN_RESPONSE, 1e-4, &bias));
  check_near(bias.scale[PENDRES_LANGEVIN_COSINE], bias.scale[PENDRES_LANGEVIN_MEAN_X], 0.0);
  check_near(bias.statistics[PENDRES_LANGEVIN_LOOP_AREA].value, 0.0, 0.0);
  pendres_context_free(ctx);
}

static pendres_langevin_answer keep_strobe(void *arg, const pendres_langevin_strobe *strobe)
{
  double *out = arg;
  out[0] = strobe->cosine[0];
  out[1] = strobe->sine[0];
  out[2] = strobe->work[0];
  return PENDRES_LANGEVIN_GO_ON;
}

static void harmonics_and_work(void **state)
{
  (void)state;
  for (int large = 0; large < 2; large++) {
    const pendres_pendulum p = figure7(0.0);
    double x, v, fine[3], coarse[3], dissipated = 0.0;
    orbit(large, &x, &v);
    for (int j = 0; j < 2; j++) {
      double y[2] = {x, v};
      const pendres_langevin_observer observer = {keep_strobe, j == 0 ? fine : coarse, 1};
      pendres_context *ctx = make(0, j == 0 ? 2000 : 40, 8);
      check_ok(pendres_langevin_advance(ctx, RUN(1, &p, NULL, 0, j == 0 ? 1 : 200, &observer), y,
                                        y + 1));
      pendres_context_free(ctx);
    }
    /* On a closed orbit the work is what friction takes. */
    enum { SPLIT = 4096 };
    const double h = 8.0 / SPLIT;
    double s[2] = {x, v};
    for (int k = 0; k < SPLIT; k++) {
      dissipated += 0.12 * s[1] * s[1] * h;
      const double t = k * h;
      /* The midpoint method: its error is about h^2 = 4e-6. */
      const double a = pendres_pendulum_acceleration(&p, s[0], s[1], t);
      const double mx = s[0] + 0.5 * h * s[1], mv = s[1] + 0.5 * h * a;
      s[0] += h * mv;
      s[1] += h * pendres_pendulum_acceleration(&p, mx, mv, t + 0.5 * h);
    }
    check_relative(fine[2], dissipated, 1e-5);
    check_near(fine[2], PI * 0.2 * fine[1], 1e-9);
    /* Forty steps: order four, (h = 0.2)^4/120 of the amplitude, times ten for the orbit. */
    for (int i = 0; i < 3; i++) check_near(coarse[i], fine[i], 1.5e-4 * hypot(fine[0], fine[1]));
  }
  /* A ramp y = k theta has sine -2 k, though it does not close. At this speed the well bends
   * it by ripples of 1/v^2 = 1e-4. */
  const pendres_pendulum free_flight = {0.0, 0.0, 1.0, 0.0};
  double x = PI / 2.0, v = 100.0, out[3];
  const pendres_langevin_observer observer = {keep_strobe, out, 1};
  pendres_context *ctx = make(0, 230, 8);
  check_ok(pendres_langevin_advance(ctx, RUN(1, &free_flight, NULL, 0, 1, &observer), &x, &v));
  check_near(out[1], -(x - PI / 2.0) / PI, 1e-3);
  pendres_context_free(ctx);
}

static void leave_at_ten(void *arg, const pendres_langevin_strobe *strobe, unsigned char *left)
{
  (void)arg;
  for (size_t i = 0; i < strobe->count; i++)
    if (strobe->period >= 10 && (strobe->first + i) % 3 == 0) left[i] = 1;
}

static void those_who_left_do_not_count(void **state)
{
  (void)state;
  enum { N = 300, RECORD = 8 };
  pendres_langevin_request q = {.pendulum = figure7(1e-4), .x = PI / 2.0, .trajectories = N,
                                .settle = 5, .record = RECORD, .leave = leave_at_ten};
  double x[N * RECORD], v[N * RECORD];
  pendres_context *ctx = make(9, 16, 64);
  pendres_langevin_cloud c;
  check_ok(pendres_langevin_cloud_find(ctx, &q, &c, x, v));
  /* A hundred left at the end of period 10, when four of their strobes had counted. */
  assert_int_equal(c.left, 100);
  check_near(c.exposure, 100 * 10.0 + 200 * 13.0, 0.0);
  check_near(c.strobes, 100 * 4.0 + 200 * 8.0, 0.0);
  assert_true(isnan(x[4]) && isnan(v[4]) && isfinite(x[3]) && isfinite(x[RECORD + 7]));
  q.settle = 20;
  q.trajectories = 2;
  q.leave = leave_at_ten;
  assert_int_equal(pendres_langevin_cloud_find(ctx, &q, &c, NULL, NULL), PENDRES_NOT_FOUND);
  pendres_context_free(ctx);
}

/* ---- Linear theory and rates ------------------------------------------------------------- */

static void lyapunov_equation(void **state)
{
  (void)state;
  const double m[4] = {0.3, -0.8, 0.5, 0.2};
  const pendres_langevin_covariance q = {1.0, 0.2, 3.0};
  pendres_langevin_covariance s;
  check_ok(pendres_langevin_lyapunov(m, &q, &s));
  /* It solves the equation: rounding of a handful of terms of order 10. */
  const double a = m[0] * s.xx + m[1] * s.xv, b = m[0] * s.xv + m[1] * s.vv;
  const double c = m[2] * s.xx + m[3] * s.xv, d = m[2] * s.xv + m[3] * s.vv;
  check_near(a * m[0] + b * m[1] + q.xx, s.xx, 1e-14);
  check_near(a * m[2] + b * m[3] + q.xv, s.xv, 1e-14);
  check_near(c * m[2] + d * m[3] + q.vv, s.vv, 1e-14);
  /* Eigenvalues outside the unit circle: real, minus one beyond, and a complex pair. */
  const double out[3][4] = {{1.1, 0.0, 0.3, 0.2}, {-1.01, 0.4, 0.0, 0.5}, {0.9, -0.6, 0.6, 0.9}};
  for (int i = 0; i < 3; i++)
    assert_int_equal(pendres_langevin_lyapunov(out[i], &q, &s), PENDRES_NOT_FOUND);
}

static void linear_theory_refuses(void **state)
{
  (void)state;
  pendres_langevin_linear out;
  pendres_pendulum p = {0.1, 0.0, 1.0, 1e-4};
  /* The barrier top repels. */
  assert_int_equal(pendres_langevin_linear_find(&p, -PI / 2.0, 0.0, 1, &out),
                   PENDRES_NOT_FOUND);
  assert_int_equal(pendres_langevin_linear_find(&p, PI / 2.0, 0.0, 0, &out),
                   PENDRES_INVALID_ARGUMENT);
  p.temperature = -1e-4;
  assert_int_equal(pendres_langevin_linear_find(&p, PI / 2.0, 0.0, 1, &out),
                   PENDRES_INVALID_ARGUMENT);
}

static void rates_have_exact_intervals(void **state)
{
  (void)state;
  pendres_langevin_interval rate;
  /* Garwood's intervals as tabulated (95 %), to the digits of the tables. */
  check_ok(pendres_langevin_rate(0.0, 2.0, 0.95, &rate));
  check_near(rate.value, 0.0, 0.0);
  check_near(rate.lower, 0.0, 0.0);
  check_near(rate.upper, 3.6889 / 2.0, 3e-5);
  /* Without events the error is the upper end at one sigma: exp(-mean) = (1 - 0.6827) / 2. */
  check_relative(rate.error, -log(0.5 * (1.0 - 0.68268949213708585)) / 2.0, 1e-9);
  check_ok(pendres_langevin_rate(10.0, 1.0, 0.95, &rate));
  check_near(rate.lower, 4.7954, 5e-5);
  check_near(rate.upper, 18.3904, 5e-5);
  check_relative(rate.error, sqrt(10.0), 1e-15);
  assert_int_equal(pendres_langevin_rate(-1.0, 1.0, 0.95, &rate),
                   PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_langevin_rate(1.0, 0.0, 0.95, &rate),
                   PENDRES_INVALID_ARGUMENT);
}

/* Probability of up to n events where `mean` are expected: the sum of Poisson's terms. */
static double poisson_up_to(long n, double mean)
{
  double sum = 0.0;
  for (long k = 0; k <= n; k++)
    sum += exp((double)k * log(mean) - mean - lgamma((double)k + 1.0));
  return sum;
}

/*
 * What an interval's ends are: were the rate the upper end, so few events would come with the
 * probability of one tail, were it the lower, so many. Terms are good to 1e-10, so are roots; from
 * 500 events on the approximation is off by 1e-4 of the width, which is 2 z standard deviations
 * for a tail beyond z of them: up to 2e-4 z^2 of the tail, 2.2e-3 at z = 3.3.
 */
static void intervals_leave_their_tails(void **state)
{
  static const long counts[] = {1, 3, 40, 499, 500, 1160, 5000, 200708};
  static const double levels[] = {0.5, 0.68268949213708585, 0.95, 0.999};
  (void)state;
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
    for (size_t k = 0; k < sizeof levels / sizeof *levels; k++) {
      const double tail = 0.5 * (1.0 - levels[k]), tolerance = counts[i] < 499 ? 1e-9 : 3e-3;
      pendres_langevin_interval rate;
      check_ok(pendres_langevin_rate((double)counts[i], 1.0, levels[k], &rate));
      check_relative(poisson_up_to(counts[i], rate.upper), tail, tolerance);
      check_relative(1.0 - poisson_up_to(counts[i] - 1, rate.lower), tail, fmax(tolerance, 1e-6));
    }
  /* Fractions of events, as counts divided by their dispersion are. */
  pendres_langevin_interval rate;
  double before = -1.0;
  for (double events = 1e-8; events < 600.0; events *= 1.5) {
    check_ok(pendres_langevin_rate(events, 1.0, 0.95, &rate));
    assert_true(rate.lower >= 0.0 && rate.lower < events);
    assert_true(rate.upper > events && rate.upper > before);
    before = rate.upper;
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(free_diffusion_is_ornstein_uhlenbeck),
    cmocka_unit_test(small_oscillations_are_linear),
    cmocka_unit_test(equilibrium_is_boltzmann),
    cmocka_unit_test(clouds_of_figure7_are_linear),
    cmocka_unit_test(chosen_steps_keep_their_bias),
    cmocka_unit_test(harmonics_of_nothing_have_steps),
    cmocka_unit_test(harmonics_and_work),
    cmocka_unit_test(those_who_left_do_not_count),
    cmocka_unit_test(lyapunov_equation),
    cmocka_unit_test(linear_theory_refuses),
    cmocka_unit_test(rates_have_exact_intervals),
    cmocka_unit_test(intervals_leave_their_tails),
  };
  return cmocka_run_group_tests_name("langevin", tests, NULL, NULL);
}
