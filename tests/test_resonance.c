/*
 * test_resonance.c -- resonances against the extended-precision reference, the linear limit, and
 * each other.
 *
 * Tolerances: a result may differ from the exact value by its own error estimate, and the estimate
 * must meet the tolerance asked for.
 */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include <pendres/pendres.h>
#include "oracle/reference.h"

#include "golden.h"

static pendres_context *context_with(double tolerance, int lanes)
{
  pendres_context *ctx = NULL;
  const pendres_options o = {.tolerance = tolerance, .block_lanes = lanes};
  check_ok(pendres_context_create(&o, &ctx));
  return ctx;
}

static pendres_resonance find(pendres_context *ctx, double damping, double drive)
{
  pendres_resonance r;
  const pendres_pendulum p = {.damping = damping, .drive_amplitude = drive};
  const pendres_status status = pendres_resonance_find(ctx, &p, 0.5, 1.2, &r);
  if (status != PENDRES_OK) print_error("%s\n", pendres_context_message(ctx));
  check_ok(status);
  return r;
}

/* The true error is within the estimate, and the estimate within the tolerance asked for. */
static void check_honest(double got, double error, double exact, double tolerance)
{
  assert_true(isfinite(error) && error >= 0.0);
  check_near(got, exact, error);
  assert_true(error <= tolerance);
}

/*
 * Too few steps shift a resonance, peak and phase lag alike: the lag at the peak is known much
 * better than that at a given frequency, which the orbit's own error is of.
 */
static void lag_at_a_peak(void **state)
{
  static const double tolerances[] = {1e-6, 1e-8, 1e-10};
  (void)state;
  for (size_t t = 0; t < 3; t++) {
    pendres_context *ctx = context_with(tolerances[t], 0);
    const pendres_resonance r = find(ctx, 0.2, 0.03);
    const pendres_orbit *o = &r.response.state[0].orbit;
    const pendres_pendulum p = {.damping = 0.2, .drive_amplitude = 0.03, .drive_frequency = 1.0};
    reference_cycle top;
    assert_int_equal(r.peak, PENDRES_PEAK_SMOOTH);
    assert_int_equal(r.response.states, 1);
    check_ok(reference_find(REFERENCE_RESONANCE, &p,
                                    &(reference_guess){r.frequency, o->x - PENDRES_PI / 2.0,
                                                               o->v, 0.0L},
                                    &top));
    check_near(r.response.phase_lag, (double)top.phase_lag, r.response.phase_lag_error);
    assert_true(r.response.phase_lag_error < o->phase_lag_error);
    pendres_context_free(ctx);
  }
}

/* Only the dampings above the cusp have one branch, so that the golden peak is the resonance. */
static int single_branch(const reference_cycle *g)
{
  return g->damping > (g->drive_amplitude > 0.15L ? 0.164L : 0.099L);
}

static void smooth_peaks(void **state)
{
  static const double tolerances[] = {1e-6, 1e-8, 1e-10};
  (void)state;
  for (size_t t = 0; t < 3; t++) {
    pendres_context *ctx = context_with(tolerances[t], 0);
    int seen = 0;
    for (size_t i = 0; i < sizeof golden_resonances / sizeof golden_resonances[0]; i++) {
      const reference_cycle *g = &golden_resonances[i];
      if (!single_branch(g)) continue;
      const pendres_resonance r = find(ctx, (double)g->damping, (double)g->drive_amplitude);
      assert_int_equal(r.peak, PENDRES_PEAK_SMOOTH);
      check_honest(r.frequency, r.frequency_error, (double)g->drive_frequency, tolerances[t]);
      check_honest(r.loop_area, r.loop_area_error, (double)g->loop_area, tolerances[t]);
      check_honest(r.response.mean_loop_amplitude, r.response.mean_loop_amplitude_error,
                   (double)g->amplitude, 10.0 * tolerances[t]);
      check_honest(r.response.phase_lag, r.response.phase_lag_error, (double)g->phase_lag,
                   10.0 * tolerances[t]);
      seen++;
    }
    assert_true(seen >= 6);
    pendres_context_free(ctx);
  }
}

/* Below the cusp the resonance is where SA ends, if LA's own peak lies at lower frequency. */
static void edges_are_folds(void **state)
{
  static const double dampings[] = {0.13, 0.15};
  pendres_context *ctx = context_with(1e-8, 0);
  (void)state;
  for (size_t k = 0; k < 2; k++) {
    const pendres_resonance r = find(ctx, dampings[k], 0.2);
    double fold = NAN;
    for (size_t i = 0; i < sizeof golden_folds / sizeof golden_folds[0]; i++) {
      const reference_cycle *g = &golden_folds[i];
      /* Of the two folds at a damping, SA ends at the one of higher frequency. */
      if (fabsl(g->damping - dampings[k]) < 1e-12L && fabsl(g->drive_amplitude - 0.2L) < 1e-12L)
        fold = fmax(isnan(fold) ? 0.0 : fold, (double)g->drive_frequency);
    }
    assert_int_equal(r.peak, PENDRES_PEAK_EDGE);
    check_honest(r.frequency, r.frequency_error, fold, 1e-8);
    check_honest(r.fold_frequency, r.fold_frequency_error, fold, 1e-8);
    assert_true(r.response.sa_fraction == 0.0 && r.response.la_fraction == 1.0);
  }
  pendres_context_free(ctx);
}

/* The edge is a jump: a little below it some members are on SA and the mean area is smaller. */
static void an_edge_is_a_jump(void **state)
{
  pendres_context *ctx = context_with(1e-8, 0);
  const pendres_resonance r = find(ctx, 0.13, 0.2);
  const pendres_ensemble e = pendres_ensemble_default();
  pendres_pendulum p = {.damping = 0.13, .drive_amplitude = 0.2};
  pendres_response below;
  (void)state;
  p.drive_frequency = r.frequency - 1e-4;
  check_ok(pendres_response_find(ctx, 1, &p, &e, &below));
  assert_true(below.sa_fraction > 0.05);
  assert_true(below.mean_loop_area < r.loop_area - 0.05);
  pendres_context_free(ctx);
}

/*
 * Two members that are on one state, up to its fold, and on another one beyond: neither point of a
 * gap has a state in common with the other, and for 6e-7 beyond the fold nothing settles. The peak
 * is at the fold, which the orbit itself tells; bisection was misled there, and said that the
 * peak is ragged, with no error at all.
 */
static void all_change_at_once(void **state)
{
  pendres_context *ctx = context_with(1e-8, 0);
  const pendres_pendulum p = {.damping = 0.142788, .drive_amplitude = 0.2};
  const pendres_ensemble e = {.members = 2, .shape = PENDRES_ENSEMBLE_RANDOM, .seed = 57,
                              .x_first = -1.5707963267948966, .x_last = 4.71238898038469,
                              .v = -1.927408, .v_last = 0.28126};
  pendres_pendulum low = p;
  pendres_resonance r;
  pendres_response there;
  pendres_fold fold;
  (void)state;
  check_ok(pendres_resonance_find_ensemble(ctx, &p, 0.5, 1.2, &e, &r));
  assert_int_equal(r.peak, PENDRES_PEAK_EDGE);
  low.drive_frequency = 0.85;
  check_ok(pendres_response_find(ctx, 1, &low, &e, &there));
  check_ok(pendres_fold_find(ctx, &there.state[0].orbit, PENDRES_DRIVE_FREQUENCY, &fold));
  check_near(r.frequency, fold.value, 10.0 * (r.frequency_error + fold.value_error));
  assert_true(r.frequency_error > 0.0 && r.frequency_error < 1e-9);
  /* The areas a little below the fold and beyond what does not settle. */
  low.drive_frequency = r.frequency - 1e-8;
  check_ok(pendres_response_find(ctx, 1, &low, &e, &there));
  assert_true(there.mean_loop_area < 0.5 * r.loop_area);
  low.drive_frequency = r.frequency + 2e-6;
  check_ok(pendres_response_find(ctx, 1, &low, &e, &there));
  check_near(there.mean_loop_area, r.loop_area, 2e-5);
  pendres_context_free(ctx);
}

/*
 * Linear limit: A is proportional to w / ((k - w^2)^2 + g^2 w^2); its maximum solves
 * 3 u^2 - (2 k - g^2) u - k^2 = 0 in u = w^2. A pendulum of small amplitude a has
 * k = 1 - a^2 / 8; that a changes along the peak matters less: a tenth of the shift is allowed
 * for that, and the resonance's own error comes on top.
 */
static void linear_limit(void **state)
{
  const double g = 0.5, drive = 1e-4;
  double frequency[2], shift = 0.0;
  pendres_context *ctx = context_with(1e-9, 0);
  const pendres_resonance r = find(ctx, g, drive);
  (void)state;
  for (int i = 0; i < 2; i++) {
    const double k = 1.0 - shift, b = 2.0 * k - g * g;
    const double u = (b + sqrt(b * b + 12.0 * k * k)) / 6.0;
    frequency[i] = sqrt(u);
    shift = drive * drive / ((1.0 - u) * (1.0 - u) + g * g * u) / 8.0;
  }
  check_near(r.frequency, frequency[1],
             0.1 * (frequency[0] - frequency[1]) + 10.0 * r.frequency_error);
  pendres_context_free(ctx);
}

/* A drive of the other sign is the same drive half a period later. */
static void sign_of_the_drive(void **state)
{
  pendres_context *ctx = context_with(1e-8, 0);
  const pendres_resonance a = find(ctx, 0.3, 0.2), b = find(ctx, 0.3, -0.2);
  (void)state;
  check_near(a.frequency, b.frequency, a.frequency_error + b.frequency_error);
  check_near(a.response.phase_lag, b.response.phase_lag,
             a.response.phase_lag_error + b.response.phase_lag_error);
  pendres_context_free(ctx);
}

/* Same bytes for every block size. */
static void independent_of_blocks(void **state)
{
  static const int lanes[] = {8, 64, 256};
  static const double dampings[] = {0.15, 0.24};
  (void)state;
  for (size_t k = 0; k < 2; k++) {
    pendres_context *ctx = context_with(1e-8, 0);
    const pendres_resonance first = find(ctx, dampings[k], 0.2);
    pendres_context_free(ctx);
    for (size_t i = 0; i < 3; i++) {
      ctx = context_with(1e-8, lanes[i]);
      const pendres_resonance r = find(ctx, dampings[k], 0.2);
      assert_true(r.frequency == first.frequency && r.loop_area == first.loop_area &&
                  r.frequency_error == first.frequency_error &&
                  r.response.phase_lag == first.response.phase_lag);
      pendres_context_free(ctx);
    }
  }
}

/*
 * At weak damping SA's basin is torn: its last members leave one by one within 1e-4 below the fold,
 * some before it, and each leaves a jump. No mean area nearby may exceed the one found; an edge at
 * the fold says so, and an edge that is a little below it does not.
 */
static void the_last_of_many_jumps(void **state)
{
  enum { NEARBY = 81 };
  static const struct {
    double damping;
    int at_fold;
  } cases[] = {{0.04, 1}, {0.02 + 0.068 * 4 / 60, 1}, {0.02 + 0.068 * 2 / 60, 0}};
  pendres_context *ctx = context_with(1e-8, 0);
  const pendres_ensemble e = pendres_ensemble_default();
  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    const pendres_resonance r = find(ctx, cases[k].damping, 0.1);
    pendres_pendulum nearby[NEARBY];
    pendres_response there[NEARBY];
    assert_int_equal(r.peak, PENDRES_PEAK_EDGE);
    for (int i = 0; i < NEARBY; i++)
      nearby[i] = (pendres_pendulum){.damping = cases[k].damping,
                                     .drive_amplitude = 0.1,
                                     .drive_frequency = r.frequency + 1e-6 * (i - 40) + 1e-8};
    check_ok(pendres_response_find(ctx, NEARBY, nearby, &e, there));
    for (int i = 0; i < NEARBY; i++)
      assert_true(there[i].mean_loop_area - there[i].mean_loop_area_error <=
                  r.loop_area + r.loop_area_error);

    pendres_attractors *found = NULL;
    pendres_fold fold;
    pendres_pendulum p = nearby[0];
    p.drive_frequency = 0.88;
    check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &found));
    check_ok(pendres_fold_find(ctx, &pendres_attractors_get(found, 0)->orbit,
                               PENDRES_DRIVE_FREQUENCY, &fold));
    pendres_attractors_free(found);
    if (cases[k].at_fold) {
      check_near(r.frequency, fold.value, r.frequency_error + fold.value_error);
      check_near(r.fold_frequency, fold.value, r.fold_frequency_error + fold.value_error);
    } else {
      assert_true(isnan(r.fold_frequency) && r.frequency < fold.value - 1e-6);
    }
  }
  pendres_context_free(ctx);
}

static void no_peak_is_said(void **state)
{
  pendres_context *ctx = context_with(1e-8, 0);
  const pendres_pendulum p = {.damping = 0.3, .drive_amplitude = 0.2};
  pendres_resonance r;
  (void)state;
  /* The peak near 0.96 is outside: the area rises all the way. */
  assert_int_equal(pendres_resonance_find(ctx, &p, 0.5, 0.8, &r), PENDRES_NOT_FOUND);
  assert_non_null(strstr(pendres_context_message(ctx), "upper end"));
  assert_int_equal(pendres_resonance_find(ctx, &p, 0.8, 0.5, &r), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_resonance_find(ctx, &p, NAN, 0.5, &r), PENDRES_INVALID_ARGUMENT);
  const pendres_pendulum bad = {.damping = -0.1, .drive_amplitude = 0.2};
  assert_int_equal(pendres_resonance_find(ctx, &bad, 0.5, 1.2, &r), PENDRES_INVALID_ARGUMENT);
  pendres_context_free(ctx);
}

/* Shares of the ensemble and its mean area, against long double integration of all members. */
static void shares(void **state)
{
  pendres_context *ctx = context_with(1e-8, 0);
  const pendres_ensemble e = pendres_ensemble_default();
  (void)state;
  for (size_t i = 0; i < sizeof golden_shares / sizeof golden_shares[0]; i++) {
    const golden_share *g = &golden_shares[i];
    pendres_response r;
    check_ok(pendres_response_find(ctx, 1, &g->pendulum, &e, &r));
    assert_int_equal(r.unresolved, 0);
    check_near(r.sa_fraction, g->small / 200.0, 1e-15);
    check_near(r.la_fraction, g->large / 200.0, 1e-15);
    check_near(r.mean_loop_area, (double)g->mean_loop_area, r.mean_loop_area_error);
  }
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(smooth_peaks),         cmocka_unit_test(edges_are_folds),
    cmocka_unit_test(an_edge_is_a_jump),    cmocka_unit_test(the_last_of_many_jumps),
    cmocka_unit_test(all_change_at_once),
    cmocka_unit_test(linear_limit),         cmocka_unit_test(lag_at_a_peak),
    cmocka_unit_test(sign_of_the_drive),    cmocka_unit_test(independent_of_blocks),
    cmocka_unit_test(no_peak_is_said),      cmocka_unit_test(shares),
  };
  return cmocka_run_group_tests_name("resonance", tests, NULL, NULL);
}
