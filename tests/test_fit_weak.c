/*
 * test_fit_weak.c -- fits to weak responses and to narrow ones: lengths of a curve are counted in
 * its own size, neither in that of the well nor in a unit of force over stiffness.
 *
 * Data are the formula of linear response, that of the balance of the first harmonic, which at a
 * bend of ten widths is good to ten widths squared, or the integration of fit_fixture.h.
 * Tolerances: without noise those of data and model, 1e-5 of the value (both integrate to 1e-7 or
 * better); with noise four and a half standard errors, which one normal number in 150,000 is not
 * within.
 */
#include "fit_fixture.h"
#include "check.h"

#include <stdio.h>

#include <pendres/pendres.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static const double exact = 1e-5, farthest_pull = 4.5, noise = 0.01;

enum { SWEEP = 60, DATA = 2 * SWEEP, OPEN = 4, SETS = 10 };

static pendres_status fit(const pendres_fit_datum *data, size_t n, const pendres_fit_model *model,
                          pendres_fit **out)
{
  pendres_context *ctx = NULL;
  const pendres_fit_data all = {.n = n, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                .other = PENDRES_PARAMETER_COUNT};
  check_ok(pendres_context_create(NULL, &ctx));
  const pendres_status status = pendres_fit_find(ctx, &all, model, NULL, out);
  if (status != PENDRES_OK) print_error("%s\n", pendres_context_message(ctx));
  pendres_context_free(ctx);
  return status;
}

/* Sweeps up of which the damping alone is not known, though it is guessed. */
static void find_damping(const lab *l, const pendres_fit_datum data[SWEEP])
{
  pendres_fit *found = NULL;
  const pendres_fit_unknown open = {.quantity = PENDRES_DAMPING, .guess = l->damping};
  const pendres_fit_model model = {
    .pendulum = {.force = l->sine ? PENDRES_FORCE_PENDULUM : PENDRES_FORCE_POLYNOMIAL,
                 .force_coefficients = {l->sine ? 0.0 : 1.0}, .damping = l->damping,
                 .drive_amplitude = l->drive},
    .unknowns = 1, .unknown = &open};
  check_ok(fit(data, SWEEP, &model, &found));
  check_relative(pendres_fit_value(found, 0), l->damping, exact);
  pendres_fit_free(found);
}

/* Drives over the square of the damping from 1, where the resonance bends by a sixteenth of its
   width, down to where rounding is not far. */
static void weakly_driven_pendulums(void **state)
{
  (void)state;
  static const double strength[] = {1.0, 0.5, 0.25, 0.1, 1e-3, 1e-6, 1e-9};
  for (size_t k = 0; k < COUNT(strength); k++) {
    const double damping = 0.1;
    const lab l = {.sine = 1, .damping = damping, .drive = strength[k] * damping * damping};
    double frequency[SWEEP];
    lab_motion m[SWEEP];
    pendres_fit_datum data[SWEEP];
    for (int i = 0; i < SWEEP; i++) frequency[i] = 0.7 + 0.6 * i / (SWEEP - 1);
    assert_int_equal(lab_sweep(l, SWEEP, frequency, m), SWEEP);
    for (int i = 0; i < SWEEP; i++)
      data[i] = (pendres_fit_datum){.observable = PENDRES_FIT_AMPLITUDE, .direction = 1,
                                    .axis = frequency[i], .observed = m[i].amplitude};
    find_damping(&l, data);
  }
}

static void linear_springs(void **state)
{
  (void)state;
  static const double quality[] = {45.0, 1e3, 1e5, 1e6}, drive[] = {1e-6, 1.0, 1e6};
  for (size_t k = 0; k < COUNT(quality); k++)
    for (size_t j = 0; j < COUNT(drive); j++) {
      const lab l = {.a1 = 1.0, .damping = 1.0 / quality[k], .drive = drive[j]};
      pendres_fit_datum data[SWEEP];
      for (int i = 0; i < SWEEP; i++) {
        const double w = 1.0 + l.damping * (10.0 * i / (SWEEP - 1) - 5.0);
        data[i] = (pendres_fit_datum){
          .observable = PENDRES_FIT_FIRST_HARMONIC, .direction = 1, .axis = w,
          .observed = l.drive / hypot(1.0 - w * w, l.damping * w),
          .error = 1e-3 * l.drive / l.damping};
      }
      find_damping(&l, data);
    }
}

/* ---- without guesses ---- */

/* The largest amplitude that balances, or the smallest: Newton's method on the square, a cubic,
   comes to it from beyond all of them. Where there is only one it may come to it from one side
   alone. */
static double balanced(const lab *l, double w, int largest)
{
  const double e = l->damping * w, square = l->drive * l->drive;
  double s = 0.0, f = INFINITY;
  for (int side = 0; side < 2 && !(fabs(f) < 1e-9 * square); side++) {
    s = largest == (side == 0) ? square / (e * e) : 0.0;
    for (int i = 0; i < 100; i++) {
      const double d = l->a1 + 0.75 * l->a3 * s - w * w;
      f = s * (d * d + e * e) - square;
      s -= f / (d * d + e * e + 1.5 * l->a3 * s * d);
    }
  }
  return sqrt(s);
}

/* A sweep towards `way`: on the upper state to its end where the resonance bends the same way. */
static void sweep(const lab *l, double low, double high, int way, uint64_t *seed,
                  pendres_fit_datum data[SWEEP])
{
  double largest = 0.0;
  for (int i = 0; i < SWEEP; i++) {
    const double w = low + (high - low) * (way > 0 ? i : SWEEP - 1 - i) / (SWEEP - 1);
    const double size = balanced(l, w, way * l->a3 >= 0.0);
    largest = fmax(largest, size);
    data[i] = (pendres_fit_datum){.observable = PENDRES_FIT_FIRST_HARMONIC, .direction = way,
                                  .axis = w, .observed = size};
  }
  for (int i = 0; i < SWEEP; i++) {
    data[i].error = noise * largest;
    data[i].observed += data[i].error * lab_normal(seed);
  }
}

static void no_guesses(void **state)
{
  (void)state;
  static const double quality[] = {5.0, 50.0, 1e3, 1e4, 1e5}, bends[] = {0.0, 0.3, 10.0, -10.0};
  uint64_t seed = 2024;
  for (size_t k = 0; k < COUNT(quality) * COUNT(bends); k++) {
    const double damping = 1.0 / quality[k % COUNT(quality)], bent = bends[k / COUNT(quality)];
    if (fabs(bent) * damping > 0.01 && bent != 0.0) continue; /* the balance is not good there */
    const lab l = {.a1 = 1.0, .a3 = 4.0 / 3.0 * bent * damping, .damping = damping,
                   .drive = damping};
    const double top = sqrt(1.0 + 0.75 * l.a3), wide = 6.0 * damping + 0.3 * fabs(top - 1.0);
    const double low = fmax(fmin(1.0, top) - wide, 0.35), high = fmax(1.0, top) + wide;
    pendres_fit_datum data[DATA];
    pendres_fit *found = NULL;
    sweep(&l, low, high, 1, &seed, data);
    sweep(&l, low, high, -1, &seed, data + SWEEP);
    const double truth[OPEN] = {l.damping, l.drive, l.a1, l.a3};
    pendres_fit_unknown open[OPEN] = {{.quantity = PENDRES_DAMPING}, {.quantity =
                                      PENDRES_DRIVE_AMPLITUDE}, {.quantity = PENDRES_A1},
                                      {.quantity = PENDRES_A3}};
    for (int i = 0; i < OPEN; i++) open[i].guess = NAN;
    const pendres_fit_model model = {.pendulum.force = PENDRES_FORCE_POLYNOMIAL,
                                     .unknowns = bent != 0.0 ? OPEN : OPEN - 1, .unknown = open};
    check_ok(fit(data, DATA, &model, &found));
    for (size_t i = 0; i < model.unknowns; i++) {
      const double error = sqrt(pendres_fit_covariance(found, i, i));
      const double pull = (pendres_fit_value(found, i) - truth[i]) / error;
      if (!(fabs(pull) < farthest_pull))
        fail_msg("Q %g, bent %g, unknown %zu is %.10g +- %.2g, not %.10g", 1.0 / damping, bent, i,
                 pendres_fit_value(found, i), error, truth[i]);
    }
    pendres_fit_free(found);
  }
}

/* What the balance does not tell begins at 0 beside guesses of all else. */
static void offset_beside_guesses(void **state)
{
  (void)state;
  pendres_fit *found = NULL;
  pendres_fit_datum data[SWEEP];
  const pendres_fit_unknown open[] = {{.quantity = PENDRES_DAMPING, .guess = 0.09},
                                      {.quantity = PENDRES_FIT_OFFSET, .guess = NAN}};
  const pendres_fit_model model = {
    .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0},
                 .drive_amplitude = 0.1}, .unknowns = 2, .unknown = open};
  for (int i = 0; i < SWEEP; i++) {
    const double w = 0.7 + 0.6 * i / (SWEEP - 1);
    data[i] = (pendres_fit_datum){.observable = PENDRES_FIT_AMPLITUDE, .direction = 1, .axis = w,
                                  .observed = 0.1 / hypot(1.0 - w * w, 0.1 * w) - 0.3,
                                  .error = 0.01};
  }
  check_ok(fit(data, SWEEP, &model, &found));
  check_relative(pendres_fit_value(found, 0), 0.1, exact);
  check_relative(pendres_fit_value(found, 1), -0.3, exact);
  pendres_fit_free(found);
}

/* Whether a call has asked this often: a search that does not end does. */
static int has_gone_on(void *asked)
{
  return ++*(long *)asked > 1000000;
}

/* A barrier at the origin, between two wells, never softens to half of its stiffness: a curve's
   size is not halved without end, and the search ends, with an answer or without. */
static void barrier_at_the_origin(void **state)
{
  (void)state;
  enum { N = 30 };
  long asked = 0;
  pendres_context *ctx = NULL;
  pendres_fit *found = NULL;
  pendres_fit_datum data[N];
  const pendres_fit_unknown open = {.quantity = PENDRES_DAMPING, .guess = 0.1};
  const pendres_fit_model model = {
    .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-0.05, 0.0, 1.0},
                 .drive_amplitude = 0.02}, .unknowns = 1, .unknown = &open};
  for (int i = 0; i < N; i++) {
    const double w = 0.2 + 0.01 * i, stiff = 0.1; /* of the wells */
    data[i] = (pendres_fit_datum){.observable = PENDRES_FIT_AMPLITUDE, .direction = 1, .axis = w,
                                  .observed = 0.02 / hypot(stiff - w * w, 0.1 * w), .error = 0.01};
  }
  const pendres_fit_data all = {.n = N, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                .other = PENDRES_PARAMETER_COUNT};
  check_ok(pendres_context_create(NULL, &ctx));
  pendres_context_set_interrupt(ctx, has_gone_on, &asked);
  const pendres_status status = pendres_fit_find(ctx, &all, &model, NULL, &found);
  assert_true(status == PENDRES_OK || status == PENDRES_NOT_CONVERGED);
  pendres_fit_free(found);
  pendres_context_free(ctx);
}

/* ---- places ---- */

/* Where weak drives find the resonance: at the frequency of the well, whatever the damping. */
static void weak_resonances(void **state)
{
  (void)state;
  static const double quality[] = {10.0, 1e3, 1e5};
  for (size_t k = 0; k < 2 * COUNT(quality); k++) {
    const int sine = k % 2 == 0;
    const double damping = 1.0 / quality[k / 2];
    pendres_fit *found = NULL;
    pendres_fit_datum data[3];
    const pendres_fit_unknown open = {.quantity = PENDRES_FIT_FREQUENCY_SCALE, .guess = 980.0};
    const pendres_fit_model model = {
      .pendulum = {.force = sine ? PENDRES_FORCE_PENDULUM : PENDRES_FORCE_POLYNOMIAL,
                   .force_coefficients = {sine ? 0.0 : 1.0}, .damping = damping,
                   .drive_amplitude = 1e-3 * damping * damping},
      .unknowns = 1, .unknown = &open};
    for (int i = 0; i < 3; i++)
      data[i] = (pendres_fit_datum){.observable = PENDRES_FIT_RESONANCE, .direction = 1,
                                    .observed = 999.9 + 0.1 * i, .error = 0.1};
    check_ok(fit(data, 3, &model, &found));
    check_relative(pendres_fit_value(found, 0), 1000.0, 1e-6);
    check_near(sqrt(pendres_fit_covariance(found, 0, 0)), 0.1 / sqrt(3.0), 1e-4);
    pendres_fit_free(found);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(weakly_driven_pendulums),
                                     cmocka_unit_test(linear_springs),
                                     cmocka_unit_test(no_guesses),
                                     cmocka_unit_test(offset_beside_guesses),
                                     cmocka_unit_test(barrier_at_the_origin),
                                     cmocka_unit_test(weak_resonances)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
