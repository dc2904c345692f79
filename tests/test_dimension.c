/*
 * test_dimension.c -- dimensions and spectra of artificial records, for which they are known
 * exactly; exponents against an integration of the variational equation that is written here.
 */
#include <stdlib.h>
#include <string.h>

#include <pendres/dimension.h>
#include <pendres/spectrum.h>

#include "check.h"

static const double two_pi = 6.28318530717958647693;

/* Marsaglia's xorshift: 0 <= u < 1. */
static double uniform(uint64_t *s)
{
  *s ^= *s << 13;
  *s ^= *s >> 7;
  *s ^= *s << 17;
  return (double)(*s >> 11) * 0x1p-53;
}

/* Digits 0 or 1 at random, each the place of a part of its interval. */
static double of_cantor(uint64_t *s, double low, double high, double share)
{
  double z = 0.3;
  for (int k = 0; k < 40; k++) z = uniform(s) < share ? low * z : 1.0 - high + high * z;
  return z;
}

/* Points of two parts of sizes a and b, visited with probabilities p and 1 - p: correlation
   dimension D with p^2 / a^D + (1 - p)^2 / b^D = 1. */
static double cantor_dimension(double a, double b, double p)
{
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; i++) {
    const double d = 0.5 * (low + high);
    *(p * p * pow(a, -d) + (1.0 - p) * (1.0 - p) * pow(b, -d) > 1.0 ? &high : &low) = d;
  }
  return low;
}

/* Within the error, which is small enough to tell the sets apart. */
static void known_sets(void **state)
{
  enum { N = 6000 };
  static const struct { double a, b, p; } sets[] = {
    {1.0 / 3.0, 1.0 / 3.0, 0.5}, {0.3, 0.2, 0.6}, {0.1, 0.4, 0.5}, {0.2, 0.3, 0.3}, {0.5, 0.5, 0.5},
  };
  static double x[N], v[N];
  uint64_t seed = 88172645463325252u;
  pendres_context *ctx = NULL;
  pendres_correlation c, again;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
    for (int k = 0; k < N; k++) {
      x[k] = uniform(&seed);
      v[k] = of_cantor(&seed, sets[i].a, sets[i].b, sets[i].p);
    }
    check_ok(pendres_correlation_find(ctx, &(pendres_section){N, x, v, 0.0}, 0.0, &c));
    check_near(c.dimension, 1.0 + cantor_dimension(sets[i].a, sets[i].b, sets[i].p),
               c.dimension_error);
    assert_true(c.dimension_error < 0.1 && c.scales > 5 && c.shortest < 0.5 * c.longest);
    for (int k = 1; k < c.scales; k++) {
      assert_true(c.sum[k] >= c.sum[k - 1] && c.sum_error[k] >= 0.0);
      check_relative(c.distance[k], sqrt(2.0) * c.distance[k - 1], 1e-12);
    }
    check_near(c.sum[c.scales - 1], 1.0, 1e-15);
  }
  /* A curve around the cylinder, which has no ends; and turns are of no matter. */
  for (int k = 0; k < N; k++) {
    x[k] = two_pi * uniform(&seed);
    v[k] = sin(x[k]);
  }
  check_ok(pendres_correlation_find(ctx, &(pendres_section){N, x, v, two_pi}, 0.0, &c));
  check_near(c.dimension, 1.0, c.dimension_error);
  assert_true(c.dimension_error < 0.05);
  for (int k = 0; k < N; k++) x[k] += two_pi * (k % 5 - 2);
  check_ok(pendres_correlation_find(ctx, &(pendres_section){N, x, v, two_pi}, 0.0, &again));
  check_near(again.dimension, c.dimension, 1e-3 * c.dimension_error);
  pendres_context_free(ctx);
}

/* An orbit of q drive periods is q points: no dimension at all, whatever is below the resolution; a
   q-th of the pairs are close. The first point stands where a turn ends and the next begins. */
static void orbits(void **state)
{
  enum { N = 2000 };
  static double x[N], v[N];
  uint64_t seed = 88172645463325252u;
  pendres_context *ctx = NULL;
  pendres_correlation c;
  (void)state;
  check_ok(pendres_context_create(NULL, &ctx));
  for (int q = 1; q < 5; q++) {
    for (int k = 0; k < N; k++) {
      x[k] = k % q + 1e-7 * (uniform(&seed) - 0.5);
      v[k] = sin(k % q) + 1e-7 * uniform(&seed);
    }
    check_ok(pendres_correlation_find(ctx, &(pendres_section){N, x, v, two_pi}, 1e-6, &c));
    check_near(c.dimension, 0.0, c.dimension_error);
    assert_true(c.dimension_error < 1e-12 && c.scales > 5);
    check_near(c.sum[0], 1.0 / q, 0.01);
  }
  /* Too few to tell. */
  check_ok(pendres_correlation_find(ctx, &(pendres_section){40, x, v, two_pi}, 0.0, &c));
  assert_true(isnan(c.dimension) && isnan(c.dimension_error) && isnan(c.longest));
  pendres_context_free(ctx);
}

/* Both exponents of the pendulum by two tangent vectors that are made orthogonal once a period:
   classical Runge-Kutta steps. */
static void by_hand(const pendres_pendulum *p, double exponent[2])
{
  enum { STEPS = 200, PERIODS = 300, SIZE = 6 };
  const double h = two_pi / p->drive_frequency / STEPS, weight[] = {0.0, 0.5, 0.5, 1.0};
  double s[SIZE] = {0.7, 0.3, 1.0, 0.0, 0.0, 1.0};
  exponent[0] = exponent[1] = 0.0;
  for (int k = 0; k < PERIODS * STEPS; k++) {
    double slope[SIZE] = {0.0}, sum[SIZE] = {0.0};
    for (int stage = 0; stage < 4; stage++) {
      double u[SIZE];
      for (int m = 0; m < SIZE; m++) u[m] = s[m] + weight[stage] * h * slope[m];
      const double force = p->drive_amplitude *
                           cos(two_pi * ((k % STEPS) + weight[stage]) / STEPS);
      for (int m = 0; m < SIZE; m += 2) {
        slope[m] = u[m + 1];
        slope[m + 1] = (m == 0 ? force - sin(u[0]) : -cos(u[0]) * u[m]) - p->damping * u[m + 1];
      }
      for (int m = 0; m < SIZE; m++)
        sum[m] += h / 6.0 * (stage == 0 || stage == 3 ? 1.0 : 2.0) * slope[m];
    }
    for (int m = 0; m < SIZE; m++) s[m] += sum[m];
    if ((k + 1) % STEPS != 0) continue;
    s[0] = remainder(s[0], two_pi);
    for (int a = 0; a < 2; a++) {
      double *t = s + 2 + 2 * a;
      const double along = a == 0 ? 0.0 : t[0] * s[2] + t[1] * s[3];
      if (a == 1) {
        t[0] -= along * s[2];
        t[1] -= along * s[3];
      }
      const double length = hypot(t[0], t[1]);
      exponent[a] += log(length) / (h * STEPS * PERIODS);
      t[0] /= length;
      t[1] /= length;
    }
  }
}

/* Kaplan and Yorke: 1 + L1 / |L2|, with both exponents measured. Their sum is minus the damping up
   to the error of the steps, of fourth order, and rounding. */
static void lyapunov_dimension(void **state)
{
  const pendres_pendulum p = {
    .damping = 0.5, .drive_amplitude = 1.15, .drive_frequency = 2.0 / 3.0};
  double exponent[2], error = NAN;
  (void)state;
  by_hand(&p, exponent);
  assert_true(exponent[0] > 0.05);
  check_near(exponent[0] + exponent[1], -p.damping, 1e-6);
  const double d = pendres_lyapunov_dimension(&p, exponent[0], 1e-3, &error);
  check_near(d, 1.0 - exponent[0] / exponent[1], 1e-5);
  /* The error by a difference quotient. */
  const double more = pendres_lyapunov_dimension(&p, exponent[0] + 1e-6, 0.0, NULL);
  check_relative(error, 1e-3 * (more - d) / 1e-6, 1e-4);
  assert_true(pendres_lyapunov_dimension(&p, -0.25, 1e-3, &error) == 0.0 && error == 0.0);
}

static double total(const double *density, size_t n, double spacing)
{
  double sum = 0.0;
  for (size_t k = 0; k < n; k++) sum += density[k] * spacing;
  return sum;
}

/* Parseval: all densities together are the mean square under the window, to rounding. */
static void parseval(void **state)
{
  enum { N = 360, LINES = N / 2 + 1 };
  const double interval = 0.37;
  double value[N], frequency[LINES], density[LINES], error[LINES], square = 0.0, weight = 0.0;
  uint64_t seed = 88172645463325252u;
  pendres_spectrum *s = NULL;
  (void)state;
  for (int i = 0; i < N; i++) {
    const double window = 0.5 - 0.5 * cos(two_pi * i / N);
    value[i] = 3.0 + sin(0.2 * i) + uniform(&seed);
    square += window * window * value[i] * value[i];
    weight += window * window;
  }
  check_ok(pendres_spectrum_create(N, interval, &s));
  check_ok(pendres_spectrum_get(s, NULL, density, error));
  assert_true(isnan(density[0]) && isnan(error[0]));
  check_ok(pendres_spectrum_add(s, N, value));
  assert_true(pendres_spectrum_count(s) == LINES);
  check_ok(pendres_spectrum_get(s, frequency, density, error));
  assert_true(frequency[0] == 0.0 && isinf(error[3]));
  check_relative(frequency[LINES - 1], 0.5 * two_pi / interval, 1e-14);
  check_relative(total(density, LINES, frequency[1]), square / weight, 1e-13);
  pendres_spectrum_free(s);
}

/* A line that stands on a frequency of the spectrum: half its squared amplitude there and in the
   two neighbours, in shares of 2/3 and 1/6, and nothing elsewhere. */
static void a_line(void **state)
{
  enum { N = 250, LINES = N / 2 + 1, PIECES = 7, AT = 17 };
  double value[N], frequency[LINES], density[LINES], error[LINES];
  pendres_spectrum *s = NULL;
  (void)state;
  for (int i = 0; i < N; i++) value[i] = 3.0 * cos(two_pi * AT * i / N + 0.3);
  check_ok(pendres_spectrum_create(N, 0.1, &s));
  for (int i = 0; i < PIECES; i++) check_ok(pendres_spectrum_add(s, N, value));
  check_ok(pendres_spectrum_get(s, frequency, density, error));
  for (int k = 0; k < LINES; k++) {
    const double share = k == AT ? 2.0 / 3.0 : abs(k - AT) == 1 ? 1.0 / 6.0 : 0.0;
    check_near(density[k] * frequency[1], share * 4.5, error[k] * frequency[1]);
    assert_true(error[k] < 1e-12);
  }
  pendres_spectrum_free(s);
}

/* Independent numbers: the same density everywhere; 68 % of errors hold, of 511 lines that are
   nearly independent +- 2 %. In pieces of any length it is the same. */
static void noise(void **state)
{
  enum { N = 200000, LENGTH = 1024, LINES = LENGTH / 2 + 1 };
  const double interval = 0.5, want = interval / 12.0 / (0.5 * two_pi);
  double density[LINES], again[LINES], error[LINES];
  double *value = malloc(N * sizeof *value);
  uint64_t seed = 88172645463325252u;
  pendres_spectrum *s = NULL, *other = NULL;
  int held = 0;
  (void)state;
  assert_non_null(value);
  for (int i = 0; i < N; i++) value[i] = uniform(&seed) - 0.5;
  check_ok(pendres_spectrum_create(LENGTH, interval, &s));
  check_ok(pendres_spectrum_create(LENGTH, interval, &other));
  check_ok(pendres_spectrum_add(s, N, value));
  for (size_t i = 0, some = 1; i < N; i += some, some = some % 3000 + 7)
    check_ok(pendres_spectrum_add(other, some < N - i ? some : N - i, value + i));
  check_ok(pendres_spectrum_get(s, NULL, density, error));
  check_ok(pendres_spectrum_get(other, NULL, again, NULL));
  assert_memory_equal(density, again, sizeof density);
  for (int k = 1; k < LINES - 1; k++) held += fabs(density[k] - want) < error[k];
  check_near((double)held / (LINES - 2), 0.683, 0.06);
  pendres_spectrum_free(s);
  pendres_spectrum_free(other);
  free(value);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(known_sets), cmocka_unit_test(orbits), cmocka_unit_test(lyapunov_dimension),
    cmocka_unit_test(parseval),   cmocka_unit_test(a_line), cmocka_unit_test(noise),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
