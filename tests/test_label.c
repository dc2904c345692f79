/*
 * test_label.c -- what orbits are called: the definition itself, and that all analyses use it.
 */
#include <stdlib.h>

#include <pendres/phase_diagram.h>
#include <pendres/resonance.h>

#include "check.h"
#include "analysis/phase_diagram/line.h"
#include "orbits/label.h"

enum { LINE = 6 };

static pendres_orbit orbit(double amplitude, int symmetric, double frequency)
{
  return (pendres_orbit){.pendulum = {.damping = 0.1, .drive_amplitude = 0.3,
                                      .drive_frequency = frequency},
                         .period = 1, .stable = 1, .symmetric = symmetric,
                         .amplitude = amplitude, .amplitude_error = 1e-10};
}

static void the_smallest_of_several_is_small(void **state)
{
  (void)state;
  pendres_label_states s = {.count = 0};
  const pendres_label_border border = {.distinct = 1, .amplitude = 1.2};
  pendres_orbit a = orbit(0.9, 1, 0.7), b = orbit(2.4, 0, 0.7), c = orbit(2.4 + 1e-9, 0, 0.7);
  pendres_orbit other = orbit(0.1, 0, 0.7), unstable = orbit(0.2, 1, 0.7);
  other.period = 3;
  unstable.stable = 0;
  pendres_label_note(&s, &other);
  pendres_label_note(&s, &unstable);
  assert_int_equal(s.count, 0);
  /* A pair of mirror images, alone, is one state. */
  pendres_label_note(&s, &b);
  pendres_label_note(&s, &c);
  assert_int_equal(s.count, 1);
  assert_int_equal(pendres_label_of(&s, &border, &c), PENDRES_LABEL_LA);
  assert_int_equal(pendres_label_of(&s, NULL, &c), PENDRES_LABEL_PERIODIC);
  pendres_label_note(&s, &a);
  assert_int_equal(s.count, 2);
  assert_int_equal(pendres_label_of(&s, NULL, &a), PENDRES_LABEL_SA);
  assert_int_equal(pendres_label_of(&s, NULL, &b), PENDRES_LABEL_LA);
  assert_int_equal(pendres_label_of(&s, NULL, &c), PENDRES_LABEL_LA);
  assert_int_equal(pendres_label_of(&s, NULL, &other), PENDRES_LABEL_PERIODIC);
  other.winding = 1;
  assert_int_equal(pendres_label_of(&s, NULL, &other), PENDRES_LABEL_RUNNING);
}

static void one_alone_continues_a_branch(void **state)
{
  (void)state;
  const pendres_label_states s = {.count = 1, .amplitude = {0.9}};
  const pendres_label_border border = {.distinct = 1, .amplitude = 1.2};
  const pendres_label_border behind = {.distinct = 1, .beyond = 1, .amplitude = 1.2};
  const pendres_label_border none = {.distinct = 0};
  pendres_orbit small = orbit(0.9, 1, 0.7), large = orbit(1.5, 1, 0.7);
  pendres_orbit beyond = orbit(0.9, 1, 0.81);
  assert_int_equal(pendres_label_of(&s, &border, &small), PENDRES_LABEL_SA);
  assert_int_equal(pendres_label_of(&s, &border, &large), PENDRES_LABEL_LA);
  assert_int_equal(pendres_label_of(&s, &behind, &beyond), PENDRES_LABEL_LA);
  assert_int_equal(pendres_label_of(&s, &none, &small), PENDRES_LABEL_PERIODIC);
  /* Under the paper's drives its lag tells; at rest it has none. */
  small.pendulum.drive_amplitude = beyond.pendulum.drive_amplitude = 0.2;
  small.phase_lag = 0.3;
  beyond.phase_lag = 1.9;
  assert_int_equal(pendres_label_of(&s, NULL, &small), PENDRES_LABEL_SA);
  assert_int_equal(pendres_label_of(&s, NULL, &beyond), PENDRES_LABEL_LA);
  small.phase_lag = NAN;
  assert_int_equal(pendres_label_of(&s, NULL, &small), PENDRES_LABEL_SA);
}

/* Responses, resonances and the phase diagram beyond the paper's drives: the same shares, and none
   where damping leaves one state alone. */
static void all_questions_name_alike(void **state)
{
  (void)state;
  static const double frequency[LINE] = {0.6, 0.7, 0.75, 0.8, 0.85, 0.9};
  pendres_ensemble e = pendres_ensemble_default();
  e.members = 60;
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  for (int k = 0; k < 2; k++) {
    pendres_pendulum p[LINE];
    pendres_response *r = calloc(LINE, sizeof *r);
    pendres_phase_point points[LINE];
    assert_non_null(r);
    for (int i = 0; i < LINE; i++)
      p[i] = (pendres_pendulum){.damping = k == 0 ? 0.1111 : 0.5, .drive_amplitude = 0.26,
                                .drive_frequency = frequency[i]};
    check_ok(pendres_response_find(ctx, LINE, p, &e, r));
    check_ok(pendres_response_label(ctx, LINE, r));
    check_ok(pendres_phase_line(ctx, LINE, p, &(pendres_phase_options){.ensemble = e}, points,
                                NULL));
    for (int i = 0; i < LINE; i++) {
      /* Both count members: equal to rounding, or both without a name. */
      assert_int_equal(isnan(r[i].sa_fraction), k == 1);
      assert_int_equal(isnan(points[i].sa_fraction), k == 1);
      if (k == 1) continue;
      check_near(r[i].sa_fraction, points[i].sa_fraction, 1e-15);
      check_near(r[i].la_fraction, points[i].la_fraction, 1e-15);
      check_near(r[i].sa_fraction + r[i].la_fraction, 1.0, 1e-15);
    }
    /* Alone, as both are beyond 0.8, they have no name: nothing is known of others. */
    check_ok(pendres_response_find(ctx, 1, &p[LINE - 1], &e, r));
    check_ok(pendres_response_label(ctx, 1, r));
    assert_true(isnan(r[0].sa_fraction));
    free(r);
  }
  pendres_resonance peak;
  const pendres_pendulum p = {.damping = 0.1111, .drive_amplitude = 0.26};
  check_ok(pendres_resonance_find_ensemble(ctx, &p, 0.7, 0.95, &e, &peak));
  check_near(peak.response.sa_fraction + peak.response.la_fraction, 1.0, 1e-15);
  pendres_context_free(ctx);
}

/* LA's pair of mirror images beside SA, whether members reach it or not (at 0.61 none does): its
   amplitude as an independent code has it, to its digits. */
static void a_pair_is_a_state(void **state)
{
  (void)state;
  pendres_pendulum p[5];
  pendres_phase_point points[5];
  const pendres_ensemble e = pendres_ensemble_default();
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(NULL, &ctx));
  for (int i = 0; i < 5; i++)
    p[i] = (pendres_pendulum){.damping = 1.0 / 9.0, .drive_amplitude = 0.35,
                              .drive_frequency = 0.605 + 0.005 * i};
  check_ok(pendres_phase_line(ctx, 5, p, &(pendres_phase_options){.ensemble = e}, points, NULL));
  for (int i = 0; i < 5; i++) {
    assert_int_equal(points[i].exact, PENDRES_REGIME_COEXISTENCE);
    if (i < 3) check_near(points[i].la_amplitude, 2.74, 0.01);
    assert_true(points[i].sa_amplitude < 1.0);
  }
  assert_int_equal(points[0].other & PENDRES_OTHER_ASYMMETRIC, PENDRES_OTHER_ASYMMETRIC);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_smallest_of_several_is_small),
    cmocka_unit_test(one_alone_continues_a_branch),
    cmocka_unit_test(all_questions_name_alike),
    cmocka_unit_test(a_pair_is_a_state),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
