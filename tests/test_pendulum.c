/*
 * test_pendulum.c -- the model against independent closed forms; see pendres/pendulum.h.
 *
 * References are computed in extended precision, with formulas other than the library's. `ulp` is
 * the distance of doubles around one; tolerances count roundings in it.
 */
#include <complex.h>
#include <float.h>

#include <pendres/free.h>
#include <pendres/pendulum.h>

#include "check.h"

#include "model/model.h"

static const double ulp = DBL_EPSILON;
static const double pi = 3.14159265358979323846;
static const long double pi_high = 3.14159265358979323846264338327950288L;
/* What the long double above leaves out, from pi to 40 digits: needed close to the barrier. */
static const long double pi_rest = LDBL_MANT_DIG == 64 ? -5.0165576126683320235e-20L : 0.0L;

/* Valgrind computes long doubles as doubles: no reference there. */
static void need_extended_precision(void)
{
  volatile long double sum = 1.0L;
  sum += LDBL_EPSILON;
  if (sum == 1.0L) skip();
}

static const pendres_pendulum some[] = {
  {.damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.78},
  {.damping = 0.0, .drive_amplitude = 0.0, .drive_frequency = 1.0},
  {.damping = 1.0, .drive_amplitude = 2.5, .drive_frequency = 3.0},
  {.damping = 1e-3, .drive_amplitude = -0.7, .drive_frequency = 0.05},
};
enum { SOME = sizeof some / sizeof *some };

static const double states[][3] = { /* x, v, t */
  {0.3, -1.2, 0.0}, {1.5707963, 0.0, 4.0}, {-1.4, 2.0, 17.5}, {25.0, -0.01, 1.0}, {-8.1, 3.3, 2.2},
};
enum { STATES = sizeof states / sizeof *states };

static void test_acceleration(void **state)
{
  (void)state;
  need_extended_precision();
  for (int i = 0; i < SOME; i++)
    for (int j = 0; j < STATES; j++) {
      const pendres_pendulum *p = &some[i];
      const double x = states[j][0], v = states[j][1], t = states[j][2];
      const double phase = p->drive_frequency * t; /* its rounding is the caller's own */
      const long double want =
        cosl(x) - (long double)p->damping * v + p->drive_amplitude * cosl(phase);
      /* Each of three terms and two sums rounds once or twice. */
      const double size = 1.0 + fabs(p->damping * v) + fabs(p->drive_amplitude);
      check_near(pendres_pendulum_acceleration(p, x, v, t), (double)want, 4.0 * ulp * size);
    }
}

/* Central differences with h = 1e-5: h^2/6 of the third derivative, at most 1, plus ulp/h. */
static void test_jacobian(void **state)
{
  const double h = 1e-5, tolerance = h * h / 6.0 + 8.0 * ulp * 4.0 / h;
  (void)state;
  for (int i = 0; i < SOME; i++)
    for (int j = 0; j < STATES; j++) {
      const pendres_pendulum *p = &some[i];
      const double x = states[j][0], v = states[j][1], t = states[j][2];
      const double xh = (x + h) - (x - h), vh = (v + h) - (v - h);
      double dx = NAN, dv = NAN;
      pendres_model_jacobian(p, x, v, &dx, &dv);
      check_near(dx,
                 (pendres_pendulum_acceleration(p, x + h, v, t) -
                  pendres_pendulum_acceleration(p, x - h, v, t)) / xh, tolerance);
      check_near(dv,
                 (pendres_pendulum_acceleration(p, x, v + h, t) -
                  pendres_pendulum_acceleration(p, x, v - h, t)) / vh, tolerance);
    }
}

static const pendres_pendulum plain = {.drive_frequency = 1.0};

static void test_energy(void **state)
{
  (void)state;
  for (int n = -3; n <= 3; n++) {
    /* The slope vanishes at the extremes, so that a rounded x costs nothing. */
    check_near(pendres_pendulum_energy(&plain, pi / 2.0 + 2.0 * pi * n, 0.0), -1.0, ulp);
    check_near(pendres_pendulum_energy(&plain, -pi / 2.0 + 2.0 * pi * n, 0.0), 1.0, ulp);
  }
  for (int j = 0; j < STATES; j++) {
    const double x = states[j][0], v = states[j][1];
    check_near(pendres_pendulum_energy(&plain, x, v), (double)(0.5L * v * v - sinl(x)),
               2.0 * ulp * (1.0 + 0.5 * v * v));
  }
}

/* dE/dt = v (F - damping v): the force is minus the potential's slope, plus drive and friction. */
static void test_power(void **state)
{
  const double h = 1e-5;
  (void)state;
  for (int i = 0; i < SOME; i++)
    for (int j = 0; j < STATES; j++) {
      const pendres_pendulum *p = &some[i];
      const double x = states[j][0], v = states[j][1], t = states[j][2];
      const double slope = (pendres_pendulum_energy(&plain, x + h,
                                                    v) - pendres_pendulum_energy(&plain, x - h,
                                                                                 v)) /
                           ((x + h) - (x - h));
      const double power = v * (slope + pendres_pendulum_acceleration(p, x, v, t));
      const double drive = p->drive_amplitude * cos(p->drive_frequency * t);
      /* As for the Jacobian, times v; energies of up to 6.5 here. */
      check_near(power, v * (drive - p->damping * v),
                 fabs(v) * (h * h / 6.0 + 8.0 * ulp * 6.5 / h));
    }
}

static void mirror(double *x, double *v)
{
  *x = pi - *x;
  *v = -*v;
}

static void test_mirror(void **state)
{
  (void)state;
  for (int i = 0; i < SOME; i++)
    for (int j = 0; j < STATES; j++) {
      const pendres_pendulum *p = &some[i];
      const double x = states[j][0], v = states[j][1], t = states[j][2];
      double mx = x, mv = v;
      mirror(&mx, &mv);
      /* y changes its sign; y = x - pi/2 rounds by an ulp of x. */
      check_near(mx - pi / 2.0, -(x - pi / 2.0), 2.0 * ulp * (fabs(x) + pi));
      check_near(mv, -v, 0.0);
      check_near(pendres_pendulum_energy(&plain, mx, mv), pendres_pendulum_energy(&plain, x, v),
                 4.0 * ulp * (1.0 + fabs(x) + v * v));
      /* Half a drive period later everything turns round. The phase rounds by an ulp of itself. */
      const double later = t + pi / p->drive_frequency;
      const double phase = fabs(p->drive_frequency * later);
      check_near(pendres_pendulum_acceleration(p, mx, mv, later),
                 -pendres_pendulum_acceleration(p, x, v, t),
                 4.0 * ulp * (1.0 + fabs(x) + fabs(v) + fabs(p->drive_amplitude) * (1.0 + phase)));
      mirror(&mx, &mv);
      check_near(mx, x, 2.0 * ulp * (fabs(x) + pi));
      check_near(mv, v, 0.0);
    }
}

/*
 * y = Re z exp(i omega t) with z = F0 / (1 - omega^2 + i damping omega), by complex division.
 * Near omega = 1 the library must not lose digits in 1 - omega^2.
 */
static void test_harmonic(void **state)
{
  const double dampings[] = {1e-6, 1e-3, 0.12, 0.8, 5.0};
  const double frequencies[] = {1e-3, 0.3, 0.785398, 0.9999999, 1.0, 1.0000001, 1.3, 40.0};
  (void)state;
  need_extended_precision();
  for (size_t i = 0; i < sizeof dampings / sizeof *dampings; i++)
    for (size_t j = 0; j < sizeof frequencies / sizeof *frequencies; j++) {
      const pendres_pendulum p = {.damping = dampings[i], .drive_amplitude = 1e-6,
                                  .drive_frequency = frequencies[j]};
      const long double w = p.drive_frequency;
      const long double complex z = (long double)p.drive_amplitude /
                                    ((1.0L - w) * (1.0L + w) + I * (p.damping * w));
      pendres_harmonic h = {NAN, NAN, NAN};
      check_ok(pendres_harmonic_find(&p, &h));
      /* Some six roundings each; the area has the most. */
      check_relative(h.amplitude, (double)cabsl(z), 6.0 * ulp);
      check_near(h.phase_lag, (double)-cargl(z), 4.0 * ulp * -(double)cargl(z));
      check_relative(h.loop_area, (double)(pi_high * p.drive_amplitude * -cimagl(z)), 12.0 * ulp);
    }
}

/* The area is the integral of F dx over a cycle: a sum over equal steps is exact for harmonics. */
static void test_harmonic_area(void **state)
{
  const pendres_pendulum p = {.damping = 0.3, .drive_amplitude = 0.05, .drive_frequency = 0.8};
  enum { SAMPLES = 16 };
  pendres_harmonic h;
  double area = 0.0;
  (void)state;
  check_ok(pendres_harmonic_find(&p, &h));
  for (int i = 0; i < SAMPLES; i++) {
    const double theta = 2.0 * pi * i / SAMPLES;
    const double velocity = -h.amplitude * sin(theta - h.phase_lag); /* by theta */
    area += p.drive_amplitude * cos(theta) * velocity * 2.0 * pi / SAMPLES;
  }
  check_near(area, h.loop_area, 40.0 * ulp * 2.0 * pi * p.drive_amplitude * h.amplitude);
}

static void test_harmonic_edges(void **state)
{
  pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 0.0, .drive_frequency = 1.0};
  pendres_harmonic h;
  (void)state;
  check_ok(pendres_harmonic_find(&p, &h)); /* no drive: at rest */
  check_near(h.amplitude, 0.0, 0.0);
  check_near(h.loop_area, 0.0, 0.0);
  p = (pendres_pendulum){.damping = 0.0, .drive_amplitude = 0.1, .drive_frequency = 1.0};
  check_ok(pendres_harmonic_find(&p, &h)); /* undamped, at resonance */
  assert_true(isinf(h.amplitude) && h.amplitude > 0.0);
  p.drive_frequency = 2.0; /* undamped: in antiphase, no work */
  check_ok(pendres_harmonic_find(&p, &h));
  check_near(h.phase_lag, pi, 0.0);
  check_near(h.loop_area, 0.0, 0.0);
  check_relative(h.amplitude, 0.1 / 3.0, 2.0 * ulp);
}

/* The exact frequency is the arithmetic-geometric mean of 1 and cos(a/2). */
static double frequency_by_agm(double amplitude)
{
  long double a = 1.0L, g = sinl(((pi_high - amplitude) + pi_rest) / 2.0L);
  for (int i = 0; i < 12; i++) { /* quadratic: seven would do at the closest gap here */
    const long double next = (a + g) / 2.0L;
    g = sqrtl(a * g);
    a = next;
  }
  return (double)a;
}

static void test_free_frequency(void **state)
{
  const double gaps[] = {1.0, 0.3, 0.0415926, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9};
  (void)state;
  need_extended_precision();
  check_near(pendres_free_frequency(0.0), 1.0, 2.0 * ulp);
  /* GSL's R_F is good to a few roundings; the rest is a sine and a division. */
  for (int i = 1; i <= 310; i++)
    check_relative(pendres_free_frequency(0.01 * i), frequency_by_agm(0.01 * i), 6.0 * ulp);
  for (size_t i = 0; i < sizeof gaps / sizeof *gaps; i++)
    check_relative(pendres_free_frequency(pi - gaps[i]), frequency_by_agm(pi - gaps[i]),
                   6.0 * ulp);
}

/* The error claimed covers the formula's own and half of what a change of the amplitude by one unit
   in its last place makes, and is not above thirty times the worst of a hundred amplitudes around:
   rounding is a matter of chance at each of them. */
static void test_free_frequency_error(void **state)
{
  enum { AROUND = 100 };
  (void)state;
  need_extended_precision();
  for (double gap = 3.0; gap > 1e-9; gap *= 0.5) {
    double worst = 0.0;
    for (int i = 0; i < AROUND; i++) {
      const double a = pi - gap * (1.0 - 0.001 * i), exact = frequency_by_agm(a);
      pendres_free f;
      pendres_free_get(a, &f);
      const double off = fabs(f.frequency - exact) +
                         0.5 * fabs(frequency_by_agm(nextafter(a, 0.0)) - exact);
      const double claimed = f.frequency_error;
      assert_true(off <= claimed);
      worst = fmax(worst, off / claimed);
    }
    assert_true(worst > 1.0 / 30.0);
  }
}

static void test_free_frequency_range(void **state)
{
  const double outside[] = {-1e-300, -1.0, 3.1415926535897936, 4.0, INFINITY, -INFINITY, NAN};
  (void)state;
  for (size_t i = 0; i < sizeof outside / sizeof *outside; i++) {
    pendres_free f;
    pendres_free_get(outside[i], &f);
    assert_true(isnan(f.frequency) && isnan(f.frequency_error));
    assert_true(isnan(pendres_free_frequency(outside[i])));
  }
}

/*
 * Kittel's is the series 1 - a^2/16 + a^4/3072 - ... cut short; the exact one lies above it by
 * the next term (the one after that is smaller than a^6/700). Belendez' is the second arithmetic
 * mean of the iteration above, so it lies above the limit.
 */
static void test_approximations(void **state)
{
  (void)state;
  need_extended_precision();
  for (int i = 1; i <= 30; i++) {
    const double a = 0.1 * i, exact = frequency_by_agm(a);
    const long double c = cosl(a / 2.0L), mean = (1.0L + c) / 2.0L;
    pendres_free f;
    pendres_free_get(a, &f);
    check_relative(f.kittel, (double)(1.0L - (long double)a * a / 16.0L),
                   4.0 * ulp);
    check_relative(f.belendez, (double)((mean + sqrtl(c)) / 2.0L),
                   4.0 * ulp);
    assert_true(f.belendez >= exact - 4.0 * ulp);
    if (a <= 0.5)
      check_near(exact - f.kittel, pow(a, 4) / 3072.0,
                 pow(a, 6) / 700.0 + 4.0 * ulp);
  }
}

static void test_check(void **state)
{
  const pendres_pendulum good = some[0];
  const double bad[] = {NAN, INFINITY, -INFINITY, -1.0, -1e-300};
  const char *why = NULL;
  (void)state;
  check_ok(pendres_pendulum_check(&good, &why));
  check_ok(pendres_pendulum_check(&good, NULL));
  assert_null(why); /* nothing to say */
  for (int field = 0; field < 4; field++)
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
      pendres_pendulum p = good;
      double *const of[] = {&p.damping, &p.drive_amplitude, &p.drive_frequency, &p.temperature};
      *of[field] = bad[i];
      const int allowed = field == 1 && isfinite(bad[i]); /* a drive may have either sign */
      why = NULL;
      assert_int_equal(pendres_pendulum_check(&p, &why),
                       allowed ? PENDRES_OK : PENDRES_INVALID_ARGUMENT);
      assert_int_equal(why == NULL, allowed);
      assert_int_equal(pendres_pendulum_check(&p, NULL),
                       allowed ? PENDRES_OK : PENDRES_INVALID_ARGUMENT);
      pendres_harmonic h;
      assert_int_equal(pendres_harmonic_find(&p, &h),
                       allowed ? PENDRES_OK : PENDRES_INVALID_ARGUMENT);
    }
  pendres_pendulum p = good;
  p.drive_frequency = 0.0;
  assert_int_equal(pendres_pendulum_check(&p, &why), PENDRES_INVALID_ARGUMENT);
  assert_non_null(why);
  p = good;
  p.damping = p.temperature = 0.0; /* both may vanish */
  check_ok(pendres_pendulum_check(&p, NULL));
}

static void test_null_arguments(void **state)
{
  const char *why = NULL;
  pendres_harmonic h;
  (void)state;
  assert_int_equal(pendres_pendulum_check(NULL, &why), PENDRES_INVALID_ARGUMENT);
  assert_non_null(why);
  assert_int_equal(pendres_pendulum_check(NULL, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_harmonic_find(NULL, &h), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_harmonic_find(&some[0], NULL), PENDRES_INVALID_ARGUMENT);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_acceleration),
    cmocka_unit_test(test_jacobian),
    cmocka_unit_test(test_energy),
    cmocka_unit_test(test_power),
    cmocka_unit_test(test_mirror),
    cmocka_unit_test(test_harmonic),
    cmocka_unit_test(test_harmonic_area),
    cmocka_unit_test(test_harmonic_edges),
    cmocka_unit_test(test_free_frequency),
    cmocka_unit_test(test_free_frequency_error),
    cmocka_unit_test(test_free_frequency_range),
    cmocka_unit_test(test_approximations),
    cmocka_unit_test(test_check),
    cmocka_unit_test(test_null_arguments),
  };
  return cmocka_run_group_tests_name("pendulum", tests, NULL, NULL);
}
