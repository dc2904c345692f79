/*
 * test_resonance_models.c -- resonances of models other than the plain pendulum: with torque,
 * parametric drive, and other forces.
 *
 * References: the closed form of a linear oscillator; oracle.h (extrapolated midpoint rule in long
 * double, no shared code), good to 1e-12 in the frequency of a peak and 1e-14 in its area. What is
 * claimed must cover the difference and be within the tolerance asked for.
 */
#include "check.h"

#include <string.h>

#include <pendres/pendres.h>

#include "context_fixture.h"
#include "oracle.h"

#define COUNT(a) (sizeof(a) / sizeof *(a))

static const double tolerance = 1e-8;
static const pendres_options options = {.tolerance = 1e-8};

/* Starts between two positions. */
static pendres_ensemble between(double first, double last)
{
  pendres_ensemble e = pendres_ensemble_default();
  e.x_first = first;
  e.x_last = last;
  e.members = 40;
  return e;
}

/*
 * Of x'' + g x' + a x = F0 cos: the area is proportional to w / ((a - w^2)^2 + g^2 w^2), largest at
 * the zero of 3 u^2 - (2 a - g^2) u - a^2 in u = w^2. In units of any size: a slow and a fast
 * oscillator, with amplitudes of 7e3 and 1e-5.
 */
static void linear_in_any_units(void **state)
{
  static const double stiffness[] = {1.0, 1e4, 1e-4}, drive[] = {0.2, 0.03, 0.2};
  const pendres_ensemble e = between(-1.0, 1.0);
  pendres_context *ctx = context_with(NULL); /* 1e-8 of the own units of each */
  (void)state;
  for (size_t i = 0; i < COUNT(stiffness); i++) {
    const double a = stiffness[i], rate = sqrt(a), g = 0.3 * rate, b = 2.0 * a - g * g;
    const double u = (b + sqrt(b * b + 12.0 * a * a)) / 6.0, w = sqrt(u);
    const double area = PENDRES_PI * drive[i] * drive[i] * g * w / ((a - u) * (a - u) + g * g * u);
    const pendres_pendulum p = {.damping = g, .drive_amplitude = drive[i],
                                .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {a}};
    pendres_resonance r;
    check_ok(pendres_resonance_find_ensemble(ctx, &p, 0.5 * rate, 1.2 * rate, &e, &r));
    assert_int_equal(r.peak, PENDRES_PEAK_SMOOTH);
    assert_true(r.complete && r.frequency_error <= tolerance * rate);
    assert_true(r.loop_area_error <= tolerance * area);
    check_near(r.frequency, w, r.frequency_error + 4e-16 * w);
    check_near(r.loop_area, area, r.loop_area_error + 4e-16 * area);
  }
  pendres_context_free(ctx);
}

/* A pendulum of each kind; of the junction in a ring coefficients and flux as in force_squid.h. */
static const struct {
  pendres_pendulum p;
  double first, last; /* of the starts */
} cases[] = {
  {{.damping = 0.3, .drive_amplitude = 0.2, .torque = 0.4}, -0.3, 2.8},
  {{.damping = 0.3, .drive_amplitude = 0.2, .parametric_amplitude = 0.3}, 0.5, 2.5},
  {{.damping = 0.3, .drive_amplitude = 0.2, .force = PENDRES_FORCE_POLYNOMIAL,
    .force_coefficients = {1.0, 0.0, 1.0}}, -1.0, 1.0},
  {{.damping = 0.25, .drive_amplitude = 0.05, .force = PENDRES_FORCE_POLYNOMIAL,
    .force_coefficients = {-1.0, 0.0, 1.0}}, 0.3, 1.4},
  {{.damping = 0.1, .drive_amplitude = 0.03, .force = PENDRES_FORCE_POLYNOMIAL,
    .force_coefficients = {1.0, -1.0}}, -0.3, 0.4},
  {{.damping = 0.3, .drive_amplitude = 0.2, .torque = 0.1, .force = PENDRES_FORCE_SQUID,
    .force_coefficients = {0.4}}, -1.0, 1.0},
};

static void smooth_peaks(void **state)
{
  pendres_context *ctx = context_with(&options);
  (void)state;
  for (size_t i = 0; i < COUNT(cases); i++) {
    const pendres_ensemble e = between(cases[i].first, cases[i].last);
    const double origin = pendres_model_of(cases[i].p.force)->origin;
    pendres_resonance r;
    check_ok(pendres_resonance_find_ensemble(ctx, &cases[i].p, 0.5, 1.9, &e, &r));
    assert_int_equal(r.peak, PENDRES_PEAK_SMOOTH);
    assert_int_equal(r.response.states, 1);
    assert_true(r.complete && r.frequency_error <= tolerance && r.loop_area_error <= tolerance);
    const pendres_orbit *o = &r.response.state[0].orbit;
    oracle peak = oracle_of(&o->pendulum);
    long double area = 0.0L;
    const long double frequency = oracle_resonance(&peak, o->x - origin, o->v, &area);
    check_near(r.frequency, (double)frequency, r.frequency_error + 1e-12);
    check_near(r.loop_area, (double)area, r.loop_area_error + 1e-14);
  }
  pendres_context_free(ctx);
}

/*
 * A stiffening oscillator's resonance bends to higher frequencies, the more the stronger the drive.
 * Where two states coexist the mean jumps: from the fold on, members are on the small one too.
 */
static void a_bent_peak_ends_in_a_fold(void **state)
{
  const pendres_ensemble e = between(-2.0, 2.0);
  pendres_pendulum p = {.damping = 0.1, .drive_amplitude = 0.02,
                        .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, 1.0}};
  pendres_context *ctx = context_with(&options);
  pendres_resonance weak, strong;
  pendres_response beside[2];
  (void)state;
  check_ok(pendres_resonance_find_ensemble(ctx, &p, 0.5, 2.0, &e, &weak));
  p.drive_amplitude = 0.2;
  check_ok(pendres_resonance_find_ensemble(ctx, &p, 0.5, 2.0, &e, &strong));
  assert_int_equal(weak.peak, PENDRES_PEAK_SMOOTH);
  assert_int_equal(strong.peak, PENDRES_PEAK_EDGE);
  assert_true(strong.frequency > weak.frequency + 0.1);
  for (int k = 0; k < 2; k++) {
    p.drive_frequency = strong.frequency + (k == 0 ? -1e-4 : 1e-4);
    check_ok(pendres_response_find(ctx, 1, &p, &e, &beside[k]));
  }
  assert_int_equal(beside[0].states, 1);
  assert_int_equal(beside[1].states, 2);
  check_near(beside[0].mean_loop_area, strong.loop_area, 1e-3);
  assert_true(beside[1].mean_loop_area < strong.loop_area - 0.01);

  /* Where the small state ends. */
  p.drive_frequency = strong.frequency + 1e-7;
  check_ok(pendres_response_find(ctx, 1, &p, &e, &beside[1]));
  const pendres_orbit *o = &beside[1].state[0].orbit;
  oracle fold = oracle_of(&o->pendulum);
  double left;
  const double value = oracle_bifurcation(&fold, &fold.omega, 1, 0, 1, o->x, o->v, &left);
  assert_true(left < 1e-12);
  check_near(strong.fold_frequency, value, strong.fold_frequency_error + 1e-13);
  check_near(strong.frequency, value, strong.frequency_error + 1e-13);
  pendres_context_free(ctx);
}

/* What has no work of the drive has no resonance, and it is said. */
static void no_work(void **state)
{
  const pendres_ensemble e = between(-1.0, 1.0);
  const pendres_pendulum p = {.damping = 0.1, .parametric_amplitude = 0.5};
  pendres_context *ctx = context_with(&options);
  pendres_resonance r;
  (void)state;
  assert_int_equal(pendres_resonance_find_ensemble(ctx, &p, 0.5, 2.2, &e, &r), PENDRES_NOT_FOUND);
  assert_non_null(strstr(pendres_context_message(ctx), "parametric"));
  assert_true(isnan(r.frequency) && isnan(r.loop_area));
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(linear_in_any_units), cmocka_unit_test(smooth_peaks),
    cmocka_unit_test(a_bent_peak_ends_in_a_fold), cmocka_unit_test(no_work),
  };
  return cmocka_run_group_tests_name("resonance_models", tests, NULL, NULL);
}
