/*
 * test_resonance_duffing.c -- resonances of Duffing's oscillator at high quality factors, where the
 * basins of both states are rolled up and the mean area is a staircase of some hundred steps.
 *
 * References: the responses at many frequencies one by one, and the fold at which the state of
 * small amplitude begins, by continuation.
 */
#include "check.h"

#include <pendres/pendres.h>

#include "context_fixture.h"

enum { TRIED = 80, STARTS = 8 };

static pendres_pendulum duffing(double damping, double drive)
{
  return (pendres_pendulum){.damping = damping, .drive_amplitude = drive,
                            .force = PENDRES_FORCE_POLYNOMIAL,
                            .force_coefficients = {1.0, 0.0, 1.0}};
}

/* The fold at the lower end of the state of least amplitude at a frequency. */
static void fold_below(pendres_context *ctx, const pendres_pendulum *p, double frequency,
                       pendres_fold *fold)
{
  pendres_pendulum at = *p;
  pendres_attractors *set = NULL;
  double x[STARTS], v[STARTS] = {0.0};
  at.drive_frequency = frequency;
  for (int i = 0; i < STARTS; i++) x[i] = -1.0 + 0.3 * i;
  check_ok(pendres_attractors_find(ctx, &at, STARTS, x, v, &set));
  assert_true(pendres_attractors_count(set) > 1);
  check_ok(pendres_fold_find(ctx, &pendres_attractors_get(set, 0)->orbit, PENDRES_DRIVE_FREQUENCY,
                             fold));
  pendres_attractors_free(set);
}

/* No digits are lost to the steps: the largest is located, and none of those tried is larger. */
static void staircase(void **state)
{
  static const struct {
    double damping, drive;
    int at_fold;
  } cases[] = {{0.02, 0.1, 0}, {0.04, 0.1, 0}, {0.04, 0.05, 1}, {0.07, 0.1, 1}, {0.1, 0.1, 1}};
  const pendres_ensemble e = pendres_ensemble_default();
  pendres_context *ctx = *state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    const pendres_pendulum p = duffing(cases[k].damping, cases[k].drive);
    pendres_pendulum at[TRIED];
    pendres_response there[TRIED];
    pendres_resonance r;
    check_ok(pendres_resonance_find_ensemble(ctx, &p, 0.5, 1.2, &e, &r));
    assert_int_equal(r.peak, PENDRES_PEAK_EDGE);
    assert_true(r.complete && r.frequency_error < 1e-8);
    for (int i = 0; i < TRIED; i++) {
      at[i] = p;
      at[i].drive_frequency = 1.2 - 0.2 * i / TRIED;
    }
    check_ok(pendres_response_find(ctx, TRIED, at, &e, there));
    for (int i = 0; i < TRIED; i++)
      assert_true(there[i].mean_loop_area - there[i].mean_loop_area_error <=
                  r.loop_area + r.loop_area_error);
    if (!cases[k].at_fold) continue;
    pendres_fold fold;
    fold_below(ctx, &p, r.frequency + 0.01, &fold);
    check_near(r.frequency, fold.value, r.frequency_error + fold.value_error);
    check_near(r.fold_frequency, fold.value, r.fold_frequency_error + fold.value_error);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(staircase, setup, teardown)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
