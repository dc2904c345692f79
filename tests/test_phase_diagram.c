/*
 * test_phase_diagram.c -- regimes by scan and by curves, close to folds and to the cusp above all.
 *
 * Folds and cusp are those of the reference (test_continuation.c); what must hold beside them
 * follows from what a fold is: on one side both states, on the other one.
 */
#include "phase_diagram_fixture.h"

#include "analysis/phase_diagram/line.h"

static pendres_phase_point point_at(pendres_context *ctx, double damping, double frequency,
                                    size_t members)
{
  const pendres_pendulum p = {
    .damping = damping, .drive_amplitude = 0.2, .drive_frequency = frequency};
  pendres_ensemble e = pendres_ensemble_default();
  pendres_phase_point point;
  e.members = members;
  check_ok(pendres_phase_line(ctx, 1, &p, with(&e), &point, NULL));
  return point;
}

static void names_are_the_files(void **state)
{
  (void)state;
  static const char *const names[] = {"sa", "la", "coexistence", "single", "other"};
  for (int i = 0; i < PENDRES_REGIME_COUNT; i++)
    assert_string_equal(pendres_name_get(PENDRES_NAMES_REGIME, i), names[i]);
  assert_null(pendres_name_get(PENDRES_NAMES_REGIME, PENDRES_REGIME_COUNT));
}

/* The paper's Fig. 8 at damping 0.13, and above the cusp. */
static void regimes_of_the_paper(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8);
  const pendres_pendulum line[5] = {{.damping = 0.13, .drive_amplitude = 0.2,
                                     .drive_frequency = 0.6},
                                    {.damping = 0.13, .drive_amplitude = 0.2,
                                     .drive_frequency = 0.74},
                                    {.damping = 0.13, .drive_amplitude = 0.2,
                                     .drive_frequency = 0.80},
                                    {.damping = 0.13, .drive_amplitude = 0.2,
                                     .drive_frequency = 0.85},
                                    {.damping = 0.13, .drive_amplitude = 0.2,
                                     .drive_frequency = 1.0}};
  static const pendres_regime want[5] = {PENDRES_REGIME_SA, PENDRES_REGIME_SA,
                                         PENDRES_REGIME_COEXISTENCE, PENDRES_REGIME_LA,
                                         PENDRES_REGIME_LA};
  const pendres_ensemble e = pendres_ensemble_default();
  pendres_phase_point points[5];
  pendres_branches *branches = NULL;
  check_ok(pendres_phase_line(ctx, 5, line, with(&e), points, &branches));
  assert_int_equal(pendres_branches_count(branches), 1);
  for (int i = 0; i < 5; i++) {
    const pendres_phase_point *p = &points[i];
    assert_int_equal(p->regime, want[i]);
    assert_int_equal(p->exact, want[i]);
    assert_int_equal(p->other, 0);
    assert_int_equal(p->unresolved, 0);
    check_near(p->sa_fraction + p->la_fraction, 1.0, 1e-15);
    assert_int_equal(isnan(p->sa_amplitude), want[i] == PENDRES_REGIME_LA);
    assert_int_equal(isnan(p->la_amplitude), want[i] == PENDRES_REGIME_SA);
    assert_true(p->mean_loop_area_error <= 1e-8);
  }
  /* The branch attracts up to SA's fold, and from LA's on. */
  pendres_branch_part part[3];
  const pendres_branch *b = pendres_branches_get(branches, 0);
  assert_int_equal(pendres_branch_parts(b, 3, part), 2);
  assert_int_equal(pendres_branch_parts(b, 0, NULL), 2);
  assert_true(part[0].begins == PENDRES_REGULAR && part[1].ends == PENDRES_REGULAR);
  assert_true(part[0].ends == PENDRES_FOLD && part[1].begins == PENDRES_FOLD);
  const double end = pendres_branch_get(b, part[0].last)->orbit.pendulum.drive_frequency;
  const double begin = pendres_branch_get(b, part[1].first)->orbit.pendulum.drive_frequency;
  check_near(end, sa_fold, 1e-8);
  check_near(begin, la_fold, 1e-8);
  /* An orbit with the phase lag of LA by the rule of pi/3, but on SA's side of its fold, is SA. */
  assert_int_equal(point_at(ctx, 0.163, 0.86, 50).regime, PENDRES_REGIME_SA);
  const pendres_phase_point above = point_at(ctx, 0.17, 0.86, 50);
  assert_int_equal(above.regime, PENDRES_REGIME_SINGLE);
  assert_int_equal(above.exact, PENDRES_REGIME_SINGLE);
  assert_true(isnan(above.sa_fraction) && isnan(above.la_amplitude));
  pendres_branches_free(branches);
  pendres_context_free(ctx);
}

/* A fold of orbits that swing over the top, here by 5 rad, ends no small state: where one state
   alone is known it has no name. */
static void large_folds_name_nothing(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8);
  pendres_pendulum p[9];
  const pendres_ensemble e = {.members = 24}; /* all from x = 0 */
  pendres_phase_point point[9];
  pendres_branches *branches = NULL;
  double largest = 0.0;
  for (int i = 0; i < 9; i++)
    p[i] = (pendres_pendulum){.damping = 0.16689, .drive_amplitude = 0.78464,
                              .drive_frequency = 0.4573 + 0.0355 * i};
  check_ok(pendres_phase_line(ctx, 9, p, with(&e), point, &branches));
  for (size_t i = 0; i < pendres_branches_count(branches); i++) {
    const pendres_branch *b = pendres_branches_get(branches, i);
    for (size_t k = 0; k < pendres_branch_bifurcation_count(b); k++)
      largest = fmax(largest, pendres_branch_bifurcation_get(b, k)->orbit.amplitude);
  }
  assert_true(largest > PENDRES_PI);
  assert_int_equal(point[0].exact, PENDRES_REGIME_SINGLE);
  pendres_branches_free(branches);
  pendres_context_free(ctx);
}

/* LA at damping 0.08 ceases to attract at frequency 0.537944036 by losing its symmetry, not in a
   fold; the pair that is born there goes on below. */
static void branches_end_otherwise(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8);
  const pendres_pendulum p = {.damping = 0.08, .drive_amplitude = 0.2, .drive_frequency = 0.65};
  pendres_ensemble e = pendres_ensemble_default();
  pendres_phase_point point;
  pendres_branches *branches = NULL;
  e.members = 100;
  check_ok(pendres_phase_line(ctx, 1, &p, with(&e), &point, &branches));
  int seen = 0;
  for (size_t k = 0; k < pendres_branches_count(branches); k++) {
    const pendres_branch *b = pendres_branches_get(branches, k);
    pendres_branch_part part[8];
    const size_t n = pendres_branch_parts(b, 8, part);
    for (size_t i = 0; i < n && i < 8; i++)
      for (int side = 0; side < 2; side++) {
        const size_t at = side ? part[i].last : part[i].first;
        const double value = pendres_branch_get(b, at)->orbit.pendulum.drive_frequency;
        if ((side ? part[i].ends : part[i].begins) == PENDRES_SYMMETRY_BREAKING)
          seen += fabs(value - 0.537944036) < 1e-8;
      }
  }
  assert_true(seen > 0);
  pendres_branches_free(branches);
  pendres_context_free(ctx);
}

/* Close to a fold nothing is mislabelled: the ghost of a vanished orbit is not an attractor, and
   who lingers there is unresolved at worst. */
static void ghosts_are_not_attractors(void **state)
{
  (void)state;
  static const double away[] = {1e-6, 1e-9};
  pendres_context *ctx = context_of(1e-9);
  for (int i = 0; i < 2; i++) {
    const size_t members = i == 0 ? 100 : 25;
    const pendres_phase_point both = point_at(ctx, 0.13, sa_fold - away[i], members);
    const pendres_phase_point la = point_at(ctx, 0.13, sa_fold + away[i], members);
    assert_int_equal(both.exact, PENDRES_REGIME_COEXISTENCE);
    assert_int_equal(both.regime, PENDRES_REGIME_COEXISTENCE);
    assert_int_equal(la.exact, PENDRES_REGIME_LA);
    assert_int_equal(la.regime, PENDRES_REGIME_LA);
    assert_true(la.sa_fraction == 0.0 && isnan(la.sa_amplitude));
    /* All that went to SA before now go to LA, or are still on their way past the ghost. */
    check_near(la.la_fraction + la.la_fraction_error, 1.0, 1e-15);
    if (i == 0) assert_int_equal(la.unresolved, 0);

    const pendres_phase_point also = point_at(ctx, 0.13, la_fold + away[i], members);
    const pendres_phase_point sa = point_at(ctx, 0.13, la_fold - away[i], members);
    assert_int_equal(also.exact, PENDRES_REGIME_COEXISTENCE);
    assert_int_equal(sa.exact, PENDRES_REGIME_SA);
    assert_int_equal(sa.regime, PENDRES_REGIME_SA);
    assert_true(sa.la_fraction == 0.0 && isnan(sa.la_amplitude));
    check_near(sa.sa_fraction + sa.sa_fraction_error, 1.0, 1e-15);
  }
  pendres_context_free(ctx);
}

/* On both sides of the cusp, 1e-6 and 1e-9 away in damping. */
static void cusp_parts_the_regimes(void **state)
{
  (void)state;
  static const double away[] = {1e-6, 1e-9};
  pendres_context *ctx = context_of(1e-10);
  for (int i = 0; i < 2; i++) {
    const double below = cusp_damping - away[i], above = cusp_damping + away[i];
    assert_int_equal(point_at(ctx, below, cusp_frequency - 0.01, 20).regime, PENDRES_REGIME_SA);
    assert_int_equal(point_at(ctx, below, cusp_frequency + 0.01, 20).regime, PENDRES_REGIME_LA);
    assert_int_equal(point_at(ctx, above, cusp_frequency - 0.01, 20).regime, PENDRES_REGIME_SINGLE);
    assert_int_equal(point_at(ctx, above, cusp_frequency + 0.01, 20).regime, PENDRES_REGIME_SINGLE);
  }
  pendres_context_free(ctx);
}

/* A basin can exist and miss the line v = 0: LA at damping 0.124 a little below its highest
   frequency on the branch born away, where 200 members at rest all go to SA. */
static void basins_can_miss_the_members(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8);
  pendres_pendulum line[12];
  pendres_phase_point points[12];
  const pendres_ensemble e = pendres_ensemble_default();
  for (int i = 0; i < 12; i++)
    line[i] = (pendres_pendulum){
      .damping = 0.124, .drive_amplitude = 0.2, .drive_frequency = 0.49 + 0.004 * i};
  check_ok(pendres_phase_line(ctx, 12, line, with(&e), points, NULL));
  int missed = 0;
  for (int i = 0; i < 12; i++) {
    /* Members never see more than exists. */
    if (points[i].regime == PENDRES_REGIME_COEXISTENCE)
      assert_int_equal(points[i].exact, PENDRES_REGIME_COEXISTENCE);
    const int miss =
      points[i].exact == PENDRES_REGIME_COEXISTENCE && points[i].regime == PENDRES_REGIME_SA;
    if (miss) assert_true(points[i].la_amplitude > 2.5 && points[i].la_fraction == 0.0);
    missed += miss;
  }
  assert_true(missed > 0);
  pendres_context_free(ctx);
}

/* What else lives there is told: LA's lopsided pair below its symmetry breaking. */
static void others_are_told(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8);
  pendres_pendulum line[4];
  pendres_phase_point points[4];
  const pendres_ensemble e = pendres_ensemble_default();
  /* At damping 0.08 it breaks at 0.537944 and the pair doubles its period at 0.527712. */
  for (int i = 0; i < 4; i++)
    line[i] = (pendres_pendulum){
      .damping = 0.08, .drive_amplitude = 0.2, .drive_frequency = 0.530 + 0.003 * i};
  check_ok(pendres_phase_line(ctx, 4, line, with(&e), points, NULL));
  int told = 0;
  for (int i = 0; i < 4; i++) {
    /* The pair is one state, LA, beside SA. */
    const int pair = (points[i].other & PENDRES_OTHER_ASYMMETRIC) != 0;
    told += pair;
    if (pair) assert_true(points[i].exact == PENDRES_REGIME_COEXISTENCE);
    if (pair) assert_true(points[i].la_amplitude > 2.0 && points[i].la_fraction > 0.0);
    if (points[i].regime == PENDRES_REGIME_OTHER)
      assert_true((points[i].other & ~PENDRES_OTHER_ASYMMETRIC) != 0);
  }
  assert_true(told > 0);
  pendres_context_free(ctx);
}

/* Without any drive a member on top of the barrier rests there, which is an answer. */
static void rest_is_told(void **state)
{
  const pendres_pendulum at = {.force = PENDRES_FORCE_POLYNOMIAL, .damping = 0.2,
                               .drive_frequency = 1.0, .force_coefficients = {-1.0, 0.0, 1.0}};
  pendres_ensemble e = pendres_ensemble_default();
  pendres_context *ctx = context_of(1e-8);
  pendres_phase_point point;
  (void)state;
  e.members = 2;
  e.x_first = -0.5;
  e.x_last = 0.5;
  check_ok(pendres_phase_line(ctx, 1, &at, with(&e), &point, NULL));
  assert_true((point.other & PENDRES_OTHER_UNSTABLE) != 0);
  assert_true((point.other & PENDRES_OTHER_UNRESOLVED) == 0 && point.unresolved == 0);
  pendres_context_free(ctx);
}

/* ---- what curves through other dampings know ---- */

static void mistakes_are_told(void **state)
{
  (void)state;
  pendres_context *ctx = context_of(1e-8);
  pendres_pendulum line[2] = {{.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.8},
                              {.damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.7}};
  pendres_ensemble e = pendres_ensemble_default();
  pendres_phase_point points[2];
  assert_int_equal(pendres_phase_line(ctx, 2, line, with(&e), points, NULL),
                   PENDRES_INVALID_ARGUMENT);
  assert_true(strlen(pendres_context_message(ctx)) > 0);
  line[1] = (pendres_pendulum){.damping = 0.14, .drive_amplitude = 0.2, .drive_frequency = 0.9};
  assert_int_equal(pendres_phase_line(ctx, 2, line, with(&e), points, NULL),
                   PENDRES_INVALID_ARGUMENT);
  e.members = 0;
  assert_int_equal(pendres_phase_line(ctx, 1, line, with(&e), points, NULL),
                   PENDRES_INVALID_ARGUMENT);
  e.members = 1;
  check_ok(pendres_phase_line(ctx, 0, NULL, with(&e), NULL, NULL));
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(names_are_the_files),
    cmocka_unit_test(regimes_of_the_paper),
    cmocka_unit_test(ghosts_are_not_attractors),
    cmocka_unit_test(cusp_parts_the_regimes),
    cmocka_unit_test(basins_can_miss_the_members),
    cmocka_unit_test(others_are_told),
    cmocka_unit_test(rest_is_told),
    cmocka_unit_test(mistakes_are_told),
    cmocka_unit_test(large_folds_name_nothing),
    cmocka_unit_test(branches_end_otherwise),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
