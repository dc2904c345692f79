/*
 * test_scene_free.c -- free oscillations of any force by deck, beside elliptic integrals, and the
 * free backbone in files of branches beside their folds.
 */
#include "scene_fixture.h"

#include <math.h>

#include <gsl/gsl_sf_ellint.h>

#include <pendres/continuation.h>

/* Of x + x^3: 2 pi over 4 K(k) / sqrt(1 + a^2). */
static double of_duffing(double a)
{
  const double rate = 1.0 + a * a;
  return 2.0 * atan(1.0) * sqrt(rate) / gsl_sf_ellint_Kcomp(a / sqrt(2.0 * rate), GSL_PREC_DOUBLE);
}

/* GSL's integral has a few units in the last place. */
static void check_exact(const double *a, const double *frequency, const double *error, size_t n)
{
  for (size_t i = 0; i < n; i++) {
    check_near(frequency[i], of_duffing(a[i]), error[i] + 2e-15 * frequency[i]);
    assert_true(error[i] < 1e-13 * frequency[i]);
  }
}

static void duffing(void **state)
{
  (void)state;
  size_t n;
  scene_run_deck("&scene kind = 'free_oscillation' /\n&sweep amplitude_range = 0.01, 5, 300 /\n"
                 "&pendulum force = 'polynomial', force_coefficients = 1, 0, 1 /\n", 2, "free");
  pendres_store *s = scene_open("free");
  double *a = scene_values(s, "amplitude", &n), *low = scene_values(s, "turning_point_low", &n);
  double *f = scene_values(s, "frequency", &n), *error = scene_values(s, "frequency_error", &n);
  assert_int_equal(n, 300);
  check_exact(a, f, error, n);
  double *off = scene_values(s, "turning_point_low_error", &n);
  for (size_t i = 0; i < n; i++) {
    check_near(low[i], -a[i], 1e-15 * a[i]);
    assert_true(off[i] > 0.0 && off[i] < 1e-15 * a[i]);
  }
  assert_false(pendres_store_has(s, NULL, "frequency_exact"));
  free(a);
  free(low);
  free(off);
  free(f);
  free(error);
  pendres_store_free(s);
}

/* From the separatrix on there is none, which is marked. */
static void beyond(void **state)
{
  (void)state;
  size_t n;
  const size_t failed = scene_run_marked(
    NULL, "&scene kind = 'free_oscillation' /\n&sweep amplitude = 0.5, 0.99, 1, 2 /\n"
    "&pendulum force = 'polynomial', force_coefficients = 1, 0, -1 /\n", 1, "beyond");
  assert_int_equal(failed, 2);
  pendres_store *s = scene_open("beyond");
  double *f = scene_values(s, "frequency", &n);
  assert_true(f[0] > f[1] && f[1] > 0.0 && isnan(f[2]) && isnan(f[3]));
  free(f);
  pendres_store_free(s);
}

/* In a file of branches it goes beyond the highest of them. Where damping is weak an upper fold is
   next to it: apart by about half the damping's square, over the bend of the backbone. */
static void beside_branches(void **state)
{
  (void)state;
  size_t n, folds;
  scene_run_deck("&scene kind = 'branches' /\n&ensemble members = 2 /\n"
                 "&pendulum force = 'polynomial', force_coefficients = 1, 0, 1, damping = 0.02 /\n"
                 "&sweep drive_amplitude = 0.02, drive_frequency_range = 0.9, 1.4, 11 /\n", 1,
                 "beside");
  pendres_store *s = scene_open("beside");
  double *a = scene_values(s, "free_amplitude", &n), *f = scene_values(s, "free_frequency", &n);
  double *error = scene_values(s, "free_frequency_error", &n);
  double *at = scene_values(s, "bifurcation_frequency", &folds);
  double *high = scene_values(s, "bifurcation_amplitude", &folds), top = 0.0, peak = NAN;
  check_exact(a, f, error, n);
  for (size_t i = 0; i < folds; i++)
    if (high[i] > top) {
      top = high[i];
      peak = at[i];
    }
  assert_true(top > 0.5 && top < a[n - 1]);
  check_near(peak, of_duffing(top), 0.02 * 0.02);
  free(a);
  free(f);
  free(error);
  free(at);
  free(high);
  pendres_store_free(s);
}

/* Lines that are drives, or coefficients, have each its own place on the backbone with damping:
   by the library's own search, and with a lag of pi/2 there. */
static void driven_lines(void **state)
{
  static const struct { const char *text, *name; double a3[2], drive[2]; } decks[] = {
    {"force_coefficients = 1, 0, 1 /\n&sweep drive_amplitude = 0.1, 0.3", "drives", {1.0, 1.0},
     {0.1, 0.3}},
    {"force_coefficients = 1, drive_amplitude = 0.3 /\n&sweep a3 = 0.5, 2", "springs", {0.5, 2.0},
     {0.3, 0.3}}};
  (void)state;
  for (size_t k = 0; k < sizeof decks / sizeof *decks; k++) {
    char text[400];
    size_t n = 0;
    pendres_pendulum p[2];
    pendres_orbit orbit[2];
    pendres_status outcome[2];
    pendres_options options = {.tolerance = 1e-8};
    pendres_context *ctx = NULL;
    snprintf(text, sizeof text, "&scene kind = 'branches' /\n&ensemble members = 2 /\n"
             "&pendulum force = 'polynomial', damping = 0.1, %s,\n"
             "  drive_frequency = 1.0, 1.5 /\n", decks[k].text);
    scene_run_deck(text, 1, decks[k].name);
    pendres_store *s = scene_open(decks[k].name);
    double *f = scene_values(s, "backbone_frequency", &n);
    double *error = scene_values(s, "backbone_frequency_error", &n);
    assert_int_equal(n, 2);
    for (int i = 0; i < 2; i++)
      p[i] = (pendres_pendulum){.force = PENDRES_FORCE_POLYNOMIAL, .damping = 0.1,
                                .force_coefficients = {1.0, 0.0, decks[k].a3[i]},
                                .drive_amplitude = decks[k].drive[i], .drive_frequency = 1.0};
    check_ok(pendres_context_create(&options, &ctx));
    check_ok(pendres_backbone_find(ctx, 2, p, orbit, NULL, outcome));
    for (int i = 0; i < 2; i++) {
      check_near(f[i], orbit[i].pendulum.drive_frequency, error[i]);
      check_near(orbit[i].phase_lag, 2.0 * atan(1.0), 1e-7);
      assert_true(error[i] < 1e-8);
    }
    pendres_context_free(ctx);
    free(f);
    free(error);
    pendres_store_free(s);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(duffing), cmocka_unit_test(beyond),
                                     cmocka_unit_test(beside_branches),
                                     cmocka_unit_test(driven_lines)};
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
