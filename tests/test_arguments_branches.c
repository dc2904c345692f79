/*
 * test_arguments_branches.c -- bad arguments of branches, sweeps along a parameter, exponents and
 * curves.
 */
#include "arguments_fixture.h"

#include "continuation/sets.h"

static void branches(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  pendres_fold fold;
  pendres_orbit out;
  pendres_branch *branch = NULL;
  pendres_branches *all = NULL;
  size_t found;
  pendres_status how;
  double error;
  const pendres_branch *known = pendres_branches_get(f->branches, 0);
  const pendres_branch_options options = {
    .parameter = PENDRES_DRIVE_FREQUENCY, .low = 0.78, .high = 0.79 };
  pendres_branch_options bad[] = { options, options, options, options, options, options, options,
                                   options };
  assert_non_null(known);
  bad[0].parameter = PENDRES_PARAMETER_COUNT;
  bad[1].parameter = (pendres_parameter)-1;
  bad[2].low = NAN;
  bad[3].high = INFINITY;
  bad[4].low = 0.79, bad[4].high = 0.78;
  bad[5].spacing = NAN;
  bad[6].wildest = NAN;
  bad[7].size = sizeof options + 1; /* of a later version */
  REFUSED(pendres_fold_find(f->ctx, NULL, PENDRES_DRIVE_FREQUENCY, &fold));
  REFUSED(pendres_fold_find(f->ctx, &f->orbit, PENDRES_DRIVE_FREQUENCY, NULL));
  REFUSED(pendres_fold_find(f->ctx, NULL, PENDRES_DAMPING, &fold));
  REFUSED(pendres_fold_find(f->ctx, &f->orbit, PENDRES_DAMPING, NULL));
  REFUSED(pendres_fold_find(f->ctx, &f->orbit, PENDRES_PARAMETER_COUNT, &fold));
  REFUSED(pendres_fold_find(f->ctx, &f->orbit, (pendres_parameter)-1, &fold));
  REFUSED(pendres_branch_follow(f->ctx, NULL, &options, &branch));
  REFUSED(pendres_branch_follow(f->ctx, &f->orbit, NULL, &branch));
  REFUSED(pendres_branch_follow(f->ctx, &f->orbit, &options, NULL));
  REFUSED(pendres_branches_find(f->ctx, 1, NULL, &options, &all));
  REFUSED(pendres_branches_find(f->ctx, 1, &f->orbit, NULL, &all));
  REFUSED(pendres_branches_find(f->ctx, 1, &f->orbit, &options, NULL));
  REFUSED(pendres_branches_extend(f->ctx, 1, NULL, &options, f->branches));
  REFUSED(pendres_branches_extend(f->ctx, 1, &f->fold, NULL, f->branches));
  REFUSED(pendres_branches_extend(f->ctx, 1, &f->fold, &options, NULL));
  for (size_t i = 0; i < COUNT(bad); i++) {
    REFUSED(pendres_branch_follow(f->ctx, &f->orbit, &bad[i], &branch));
    REFUSED(pendres_branches_find(f->ctx, 1, &f->orbit, &bad[i], &all));
  }
  for (size_t i = 0; i < f->bad; i++) {
    REFUSED(pendres_fold_find(f->ctx, &f->bad_orbits[i], PENDRES_DRIVE_FREQUENCY, &fold));
    REFUSED(pendres_branch_follow(f->ctx, &f->bad_orbits[i], &options, &branch));
    REFUSED(pendres_branches_find(f->ctx, 1, &f->bad_orbits[i], &options, &all));
  }
  REFUSED(pendres_branch_cross(f->ctx, NULL, 0.785, 1, &out, &found));
  REFUSED(pendres_branch_cross(f->ctx, known, 0.785, 1, NULL, &found));
  REFUSED(pendres_branch_cross(f->ctx, known, 0.785, 1, &out, NULL));
  REFUSED(pendres_branch_cross(f->ctx, known, NAN, 1, &out, &found));
  REFUSED(pendres_branch_switch(f->ctx, NULL, &out));
  REFUSED(pendres_branch_switch(f->ctx, &f->fold, &out)); /* nothing crosses at a fold */
  REFUSED(pendres_backbone_find(f->ctx, 1, NULL, &out, &error, &how));
  REFUSED(pendres_backbone_find(f->ctx, 1, &good, NULL, &error, &how));
  REFUSED(pendres_backbone_find(f->ctx, 1, &good, &out, &error, NULL));
  for (size_t i = 0; i < COUNT(bad_pendulums); i++)
    if (i < 5 || (i >= 9 && i < 13)) /* it finds the drive frequency itself */
      REFUSED(pendres_backbone_find(f->ctx, 1, &bad_pendulums[i], &out, &error, &how));
  assert_true(branch == NULL && all == NULL);
  assert_int_equal(f->wrong, 0);
}

static void hysteresis(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  const double value[] = { 0.7, 0.75 }, none[] = { 0.7, NAN }, undamped[] = { 0.1, 0.0 };
  const pendres_parameter along = PENDRES_DRIVE_FREQUENCY;
  const pendres_state start = { 1.0, 0.0 };
  const pendres_hysteresis_path path = { along, 2, value };
  pendres_hysteresis *h = NULL;
  REFUSED(pendres_hysteresis_states_find(f->ctx, NULL, &start, &path, &h));
  REFUSED(pendres_hysteresis_states_find(f->ctx, &good, &start, NULL, &h));
  REFUSED(pendres_hysteresis_find(f->ctx, NULL, &start, &path, &h));
  REFUSED(pendres_hysteresis_find(f->ctx, &good, NULL, &path, &h));
  REFUSED(pendres_hysteresis_find(f->ctx, &good, &start, NULL, &h));
  REFUSED(pendres_hysteresis_find(f->ctx, &good, &start,
                                  &(pendres_hysteresis_path){along, 2, NULL}, &h));
  REFUSED(pendres_hysteresis_find(f->ctx, &good, &start, &path, NULL));
  REFUSED(pendres_hysteresis_find(f->ctx, &good, &start,
                                  &(pendres_hysteresis_path){along, 2, none}, &h));
  REFUSED(pendres_hysteresis_find(f->ctx, &good, &start,
                                  &(pendres_hysteresis_path){PENDRES_DAMPING, 2, undamped}, &h));
  REFUSED(pendres_hysteresis_find(f->ctx, &good, &start,
                                  &(pendres_hysteresis_path){(pendres_parameter)-1, 2, value},
                                  &h));
  REFUSED(pendres_hysteresis_find(f->ctx, &good, &start,
                                  &(pendres_hysteresis_path){PENDRES_PARAMETER_COUNT, 2, value},
                                  &h));
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    REFUSED(pendres_hysteresis_find(f->ctx, &good, &(pendres_state){bad_numbers[i], 0.0}, &path,
                                    &h));
    REFUSED(pendres_hysteresis_find(f->ctx, &good, &(pendres_state){1.0, bad_numbers[i]}, &path,
                                    &h));
  }
  assert_null(h);
  assert_int_equal(f->wrong, 0);
}

static void cascades(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  const pendres_parameter along = PENDRES_DRIVE_AMPLITUDE;
  pendres_cascade c;
  REFUSED(pendres_cascade_find(f->ctx, NULL, along, 0.3, &c));
  REFUSED(pendres_cascade_find(f->ctx, &f->orbit, along, 0.3, NULL));
  REFUSED(pendres_cascade_find(f->ctx, &f->orbit, (pendres_parameter)-1, 0.3, &c));
  REFUSED(pendres_cascade_find(f->ctx, &f->orbit, PENDRES_PARAMETER_COUNT, 0.3, &c));
  REFUSED(pendres_cascade_find(f->ctx, &f->orbit, along, NAN, &c));
  for (size_t i = 0; i < f->bad; i++)
    REFUSED(pendres_cascade_find(f->ctx, &f->bad_orbits[i], along, 0.3, &c));
  assert_int_equal(f->wrong, 0);
}

static void exponents(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  const double zero = 0.0;
  const pendres_lyapunov_options bad[] = { { .size = 4 }, { .transient = -1 }, { .periods = -1 },
                                           { .transient = LONG_MAX }, { .periods = LONG_MAX } };
  pendres_pendulum undamped = good;
  pendres_settled l;
  undamped.damping = 0.0;
  REFUSED(pendres_lyapunov_find(f->ctx, 1, NULL, &zero, &zero, NULL, &l));
  REFUSED(pendres_lyapunov_find(f->ctx, 1, &good, NULL, &zero, NULL, &l));
  REFUSED(pendres_lyapunov_find(f->ctx, 1, &good, &zero, NULL, NULL, &l));
  REFUSED(pendres_lyapunov_find(f->ctx, 1, &good, &zero, &zero, NULL, NULL));
  REFUSED(pendres_lyapunov_find(f->ctx, 1, &undamped, &zero, &zero, NULL, &l));
  for (size_t i = 0; i < COUNT(bad); i++)
    REFUSED(pendres_lyapunov_find(f->ctx, 1, &good, &zero, &zero, &bad[i], &l));
  for (size_t i = 0; i < COUNT(bad_pendulums); i++)
    REFUSED(pendres_lyapunov_find(f->ctx, 1, &bad_pendulums[i], &zero, &zero, NULL, &l));
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    REFUSED(pendres_lyapunov_find(f->ctx, 1, &good, &bad_numbers[i], &zero, NULL, &l));
    REFUSED(pendres_lyapunov_find(f->ctx, 1, &good, &zero, &bad_numbers[i], NULL, &l));
  }
  assert_int_equal(f->wrong, 0);
}

static void curves(void **state)
{
  fixture *f = *state;
  f->wrong = 0;
  pendres_curve *curve = NULL;
  pendres_curves *all = NULL;
  pendres_bifurcation out;
  pendres_cusp cusp;
  size_t found;
  const pendres_curve_options options = { .second = PENDRES_DAMPING, .low = { 0.7, 0.1 },
                                          .high = { 0.9, 0.2 } };
  pendres_curve_options bad[] = { options, options, options, options, options, options };
  pendres_bifurcation starts[] = { f->fold, f->fold, f->fold, f->fold };
  bad[0].second = PENDRES_PARAMETER_COUNT;
  bad[1].second = (pendres_parameter)-1;
  bad[2].low[0] = NAN;
  bad[3].high[1] = INFINITY;
  bad[4].low[1] = 0.3;
  bad[5].spacing = NAN;
  starts[0].kind = PENDRES_REGULAR;
  starts[1].kind = (pendres_special)9;
  starts[2].parameter = PENDRES_PARAMETER_COUNT;
  starts[3].parameter = (pendres_parameter)-1;
  for (size_t i = 0; i < COUNT(bad); i++)
    REFUSED(pendres_curve_follow(f->ctx, &f->fold, &bad[i], &curve));
  for (size_t i = 0; i < COUNT(starts); i++) {
    REFUSED(pendres_curve_follow(f->ctx, &starts[i], &options, &curve));
    REFUSED(pendres_cusp_find(f->ctx, &starts[i], PENDRES_DAMPING, &cusp));
    REFUSED(pendres_branch_switch(f->ctx, &starts[i], &f->orbit));
  }
  for (size_t i = 0; i < f->bad; i++) {
    pendres_bifurcation b = f->fold;
    b.orbit = f->bad_orbits[i];
    REFUSED(pendres_curve_follow(f->ctx, &b, &options, &curve));
    REFUSED(pendres_cusp_find(f->ctx, &b, PENDRES_DAMPING, &cusp));
    b.kind = PENDRES_PERIOD_DOUBLING;
    REFUSED(pendres_branch_switch(f->ctx, &b, &f->orbit));
  }
  REFUSED(pendres_curve_follow(f->ctx, NULL, &options, &curve));
  REFUSED(pendres_curve_follow(f->ctx, &f->fold, NULL, &curve));
  REFUSED(pendres_curve_follow(f->ctx, &f->fold, &options, NULL));
  REFUSED(pendres_curve_cross(f->ctx, NULL, 0.1, 1, &out, &found));
  REFUSED(pendres_curves_find(f->ctx, 1, NULL, &options, &all));
  REFUSED(pendres_curves_find(f->ctx, 1, &f->fold, NULL, &all));
  REFUSED(pendres_curves_find(f->ctx, 1, &f->fold, &options, NULL));
  REFUSED(pendres_cusp_find(f->ctx, NULL, PENDRES_DAMPING, &cusp));
  REFUSED(pendres_cusp_find(f->ctx, &f->fold, PENDRES_DAMPING, NULL));
  REFUSED(pendres_cusp_find(f->ctx, &f->fold, PENDRES_DRIVE_FREQUENCY, &cusp));
  REFUSED(pendres_cusp_find(f->ctx, &f->fold, PENDRES_PARAMETER_COUNT, &cusp));
  REFUSED(pendres_cusp_find(f->ctx, &f->fold, (pendres_parameter)-1, &cusp));
  assert_true(curve == NULL && all == NULL);
  assert_int_equal(f->wrong, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(branches),
    cmocka_unit_test(curves),
    cmocka_unit_test(hysteresis),
    cmocka_unit_test(exponents),
    cmocka_unit_test(cascades),
  };
  return cmocka_run_group_tests_name("arguments_branches", tests, make, clear);
}
