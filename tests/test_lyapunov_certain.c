/*
 * test_lyapunov_certain.c -- what maps of many pendulums say for certain: against starts as near as
 * rounding, and against an integration written here that takes thousands of periods.
 */
#include <stdlib.h>

#include <pendres/lyapunov.h>

#include "context_fixture.h"

static const double two_pi = 6.28318530717958647693;

/* ---- an integration of its own ---- */

enum { STEPS = 256, MOST_STEPS = 4096 };

/* x'' and the derivative of a tangent vector, in time: s = (x, v, dx, dv). */
static void slope(const pendres_pendulum *p, double cosine, const double s[4], double out[4])
{
  const double *a = p->force_coefficients, x = s[0], m = 1.0 + p->parametric_amplitude * cosine;
  const int polynomial = p->force == PENDRES_FORCE_POLYNOMIAL;
  const double f = polynomial ? x * (a[0] + x * (a[1] + x * (a[2] + x * (a[3] + x * a[4]))))
                              : -cos(x);
  const double k =
    polynomial ? a[0] + x * (2.0 * a[1] + x * (3.0 * a[2] + x * (4.0 * a[3] + x * 5.0 * a[4])))
               : sin(x);
  out[0] = s[1];
  out[1] = p->drive_amplitude * cosine + p->torque - f * m - p->damping * s[1];
  out[2] = s[3];
  out[3] = -k * m * s[2] - p->damping * s[3];
}

/* Through a drive period, by the classical Runge-Kutta method; wave: the cosines at half steps. */
static void period_by_hand(const pendres_pendulum *p, int steps, const double *wave, double s[4])
{
  const double h = two_pi / p->drive_frequency / steps;
  for (int i = 0; i < steps; i++) {
    const double *c = wave + 2 * i;
    double k[4][4], u[4];
    slope(p, c[0], s, k[0]);
    for (int m = 0; m < 4; m++) u[m] = s[m] + 0.5 * h * k[0][m];
    slope(p, c[1], u, k[1]);
    for (int m = 0; m < 4; m++) u[m] = s[m] + 0.5 * h * k[1][m];
    slope(p, c[1], u, k[2]);
    for (int m = 0; m < 4; m++) u[m] = s[m] + h * k[2][m];
    slope(p, c[2], u, k[3]);
    for (int m = 0; m < 4; m++)
      s[m] += h / 6.0 * (k[0][m] + 2.0 * (k[1][m] + k[2][m]) + k[3][m]);
  }
}

typedef struct long_run {
  double exponent, error; /* of the second half, and the standard error of 16 batches of it */
  int period, winding;    /* 0: strobe points do not come back within 128 periods */
} long_run;

enum { HALVES = 16, BACK = 128 };

static long_run follow(const pendres_pendulum *p, double x, double v, int periods)
{
  const double rough = STEPS * fmax(1.0, 1.2 / p->drive_frequency);
  const int steps = (int)fmin(rough, MOST_STEPS), length = periods / (2 * HALVES);
  const double time = two_pi / p->drive_frequency * length;
  const int turns = p->force != PENDRES_FORCE_POLYNOMIAL;
  double s[4] = {x, v, 0.6, 0.8}, *wave = malloc((2 * (size_t)steps + 1) * sizeof *wave);
  double mean = 0.0, square = 0.0;
  long_run out = {0};
  assert_non_null(wave);
  for (int i = 0; i <= 2 * steps; i++) wave[i] = cos(0.5 * two_pi * i / steps);
  for (int b = -HALVES; b < HALVES; b++) {
    double growth = 0.0;
    for (int k = 0; k < length; k++) {
      period_by_hand(p, steps, wave, s);
      const double size = hypot(s[2], s[3]);
      s[2] /= size;
      s[3] /= size;
      growth += log(size) / time;
      if (turns) s[0] = remainder(s[0], two_pi);
    }
    if (b >= 0) mean += growth / HALVES;
    if (b >= 0) square += growth * growth / HALVES;
  }
  out.exponent = mean;
  out.error = sqrt(fmax(0.0, square - mean * mean) / (HALVES - 1));
  const double from[2] = {s[0], s[1]};
  for (int k = 1; k <= BACK && out.period == 0; k++) {
    period_by_hand(p, steps, wave, s);
    const double across = turns ? rint((s[0] - from[0]) / two_pi) : 0.0;
    if (!(hypot(s[0] - from[0] - two_pi * across, s[1] - from[1]) < 1e-6)) continue;
    out.period = k;
    out.winding = (int)across;
  }
  free(wave);
  return out;
}

/* ---- the start decides ---- */

/*
 * Two mirror images of a running orbit attract here, and chaos lies before both: of 24 starts 1e-14
 * apart 14 ended on one. The rotations of any two of them agree within what they claim.
 */
static void rounding_decides(void **state)
{
  enum { N = 8 };
  const pendres_pendulum one = {.damping = 0.05023358555773262,
                                .drive_amplitude = 1.4276803210172417,
                                .drive_frequency = 2.140092220495635,
                                .parametric_amplitude = -1.1244206502883256};
  pendres_pendulum p[N];
  double x[N], v[N];
  pendres_settled l[N];
  int both = 0;
  for (int i = 0; i < N; i++) {
    p[i] = one;
    x[i] = 1.731637374106456 + 1e-14 * i;
    v[i] = 0.3141185235724825;
  }
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) {
    assert_int_equal(l[i].label, PENDRES_LABEL_RUNNING);
    assert_false(l[i].certain);
    check_near(fabs(l[i].rotation), 1.0, 1e-15);
    check_near(l[i].rotation, l[0].rotation, l[0].rotation_error);
    both |= l[i].winding != l[0].winding;
  }
  assert_true(both);
}

/* The mirror images of what the map knows are alike: which of them it is decides nothing here. */
static void images_are_alike(void **state)
{
  /* Period 5 next to a fold. The unstable partner is what a pendulum that comes back slowly is
     found to be next to at first. */
  const pendres_pendulum p = {.damping = 0.5, .drive_amplitude = 1.46, .drive_frequency = 0.65};
  for (int i = 0; i < 5; i++) {
    const double x = 1.4 + 0.1 * i, v = 0.0;
    pendres_settled l;
    check_ok(pendres_lyapunov_find(*state, 1, &p, &x, &v, NULL, &l));
    assert_int_equal(l.label, PENDRES_LABEL_PERIODIC);
    assert_true(l.period == 5 && l.winding == 0 && l.certain);
  }
}

/* ---- long runs ---- */

/* Chaos that goes over into a weaker one, in step with the drive, after 100 to 900 periods: the
   exponent is that of what lasts, within four combined standard errors. */
static void chaos_changes(void **state)
{
  enum { N = 12 };
  const pendres_pendulum one = {.damping = 0.12549579739790767,
                                .drive_amplitude = 1.016207720436983,
                                .drive_frequency = 0.1809454152713542,
                                .torque = -0.44868513883214955,
                                .parametric_amplitude = 0.23009914875885595};
  pendres_pendulum p[N];
  double x[N], v[N];
  pendres_settled l[N];
  for (int i = 0; i < N; i++) {
    p[i] = one;
    x[i] = 2.153064 + 1e-7 * i;
    v[i] = 0.259269;
  }
  const long_run r = follow(&one, x[0], v[0], 4096);
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) {
    assert_int_equal(l[i].label, PENDRES_LABEL_CHAOTIC);
    check_near(l[i].exponent, r.exponent, 4.0 * hypot(l[i].exponent_error, r.error));
    assert_true(l[i].exponent < 0.012);
  }
}

static double uniform(unsigned long long *seed)
{
  *seed = *seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(*seed >> 11) * 0x1p-53;
}

/*
 * Random pendulums and polynomial forces: what is said for certain is what an integration over
 * 2048 periods comes to. Exponents of orbits agree within their errors and the integration's, whose
 * steps move them by less than 1e-4; of chaos within five combined standard errors. Chaos that ends
 * late is not told from chaos that lasts: here one pendulum is on an orbit of period 4 after some
 * 2500 periods, sooner or later by the last digits of its start.
 */
static void drawn(void **state)
{
  enum { N = 40, POLYNOMIALS = 12 };
  pendres_pendulum p[N];
  double x[N], v[N];
  pendres_settled l[N];
  unsigned long long seed = 20;
  size_t certain = 0, left = 0;
  for (int i = 0; i < N; i++) {
    p[i] = (pendres_pendulum){.damping = 0.03 + 0.97 * uniform(&seed),
                              .drive_amplitude = 0.01 + 1.99 * uniform(&seed),
                              .drive_frequency = 0.1 + 2.4 * uniform(&seed)};
    if (uniform(&seed) < 0.5) p[i].parametric_amplitude = -1.5 + 3.0 * uniform(&seed);
    if (uniform(&seed) < 0.5) p[i].torque = -1.0 + 2.0 * uniform(&seed);
    x[i] = -1.5 + two_pi * uniform(&seed);
    v[i] = -1.0 + 2.0 * uniform(&seed);
    if (i >= POLYNOMIALS) continue;
    p[i].force = PENDRES_FORCE_POLYNOMIAL;
    p[i].force_coefficients[0] = -1.5 + 3.0 * uniform(&seed);
    p[i].force_coefficients[2] = 0.2 + uniform(&seed);
    x[i] *= 0.5;
  }
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) {
    if (!l[i].certain || l[i].label == PENDRES_LABEL_QUASI_PERIODIC) continue;
    const long_run r = follow(&p[i], x[i], v[i], 2048);
    const int chaotic = l[i].label == PENDRES_LABEL_CHAOTIC;
    certain++;
    if (chaotic && r.period != 0) {
      left++;
      continue;
    }
    assert_true(l[i].period == r.period && l[i].winding == r.winding);
    check_near(l[i].exponent, r.exponent,
               chaotic ? 5.0 * hypot(l[i].exponent_error, r.error)
                       : 1e-4 + l[i].exponent_error + 5.0 * r.error);
  }
  assert_true(certain > N - 8 && left <= 1);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(rounding_decides, setup, teardown),
    cmocka_unit_test_setup_teardown(images_are_alike, setup, teardown),
    cmocka_unit_test_setup_teardown(chaos_changes, setup, teardown),
    cmocka_unit_test_setup_teardown(drawn, setup, teardown),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
