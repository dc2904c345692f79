/*
 * test_arguments_plain.c -- every public function without a context, with arguments that are NULL,
 * NaN, infinite, huge, negative or out of an enum: a status, a NULL, a NaN or nothing, never a
 * crash. Those with a context are in test_arguments.c.
 */
#define _XOPEN_SOURCE 700 /* mkdtemp */

#include "arguments_plain_fixture.h"

/* Names of what is out of an enum, and what is made of no object at all. */
static void nothing(void **state)
{
  (void)state;
  for (int i = -1; i < 1000; i += 1000) {
    assert_null(pendres_name_get(PENDRES_NAMES_LABEL, i));
    assert_null(pendres_name_get(PENDRES_NAMES_REGIME, i));
    assert_null(pendres_name_get(PENDRES_NAMES_METHOD, i));
    assert_null(pendres_name_get(PENDRES_NAMES_CLOUD_VERDICT, i));
    assert_null(pendres_name_get(PENDRES_NAMES_SWITCHING_VERDICT, i));
    assert_null(pendres_name_get(PENDRES_NAMES_TABLE, i));
    assert_non_null(pendres_status_message((pendres_status)i));
  }
  assert_int_equal(pendres_name_find(PENDRES_NAMES_METHOD, NULL), -1);
  assert_int_equal(pendres_name_find(PENDRES_NAMES_COUNT, "tp8"), -1);
  assert_null(pendres_options_check(NULL));
  assert_non_null(pendres_version());
  assert_non_null(pendres_build_info());
  pendres_attractors_free(NULL);
  assert_int_equal(pendres_attractors_count(NULL), 0);
  assert_int_equal(pendres_attractors_count_of(NULL, 0), 0);
  assert_null(pendres_attractors_get(NULL, 0));
  assert_true(isnan(pendres_attractors_weakest_multiplier(NULL)));
  assert_true(isnan(pendres_response_weakest_multiplier(NULL)));
  assert_null(pendres_orbit_quantity_get((size_t)-1));
  pendres_boundary_free(NULL);
  assert_int_equal(pendres_branch_count(NULL), 0);
  assert_null(pendres_branch_get(NULL, 0));
  assert_int_equal(pendres_branch_bifurcation_count(NULL), 0);
  assert_null(pendres_branch_bifurcation_get(NULL, 0));
  (void)pendres_branch_end_get(NULL, 7);
  assert_int_equal(pendres_branch_parts(NULL, 4, NULL), 0);
  pendres_branches_free(NULL);
  pendres_hysteresis_free(NULL);
  assert_int_equal(pendres_hysteresis_count(NULL), 0);
  assert_null(pendres_hysteresis_get(NULL, 0));
  assert_int_equal(pendres_hysteresis_jump_count(NULL), 0);
  assert_null(pendres_hysteresis_jump_get(NULL, 0));
  assert_int_equal(pendres_hysteresis_step_count(NULL), 0);
  assert_null(pendres_hysteresis_step_get(NULL, 0));
  const pendres_ramp no_ramp = {.corners = 0};
  pendres_ramp_summary summary;
  assert_true(isnan(pendres_ramp_value(NULL, 0.0)) && isnan(pendres_ramp_value(&no_ramp, 0.0)));
  assert_int_equal(pendres_ramp_summarize(1, NULL, &summary), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_ramp_summarize(0, NULL, NULL), PENDRES_INVALID_ARGUMENT);
  assert_null(pendres_name_get(PENDRES_NAMES_JUMP, PENDRES_JUMP_COUNT));
  assert_int_equal(pendres_branches_count(NULL), 0);
  assert_null(pendres_branches_get(NULL, 0));
  assert_int_equal(pendres_branches_skipped(NULL), 0);
  (void)pendres_curve_kind_get(NULL);
  assert_int_equal(pendres_curve_count(NULL), 0);
  assert_null(pendres_curve_get(NULL, 0));
  assert_int_equal(pendres_curve_cusp_count(NULL), 0);
  assert_null(pendres_curve_cusp_get(NULL, 0));
  pendres_curves_free(NULL);
  assert_int_equal(pendres_curves_count(NULL), 0);
  assert_null(pendres_curves_get(NULL, 0));
}

/* Handles that are NULL. */
static pendres_status no_work(pendres_context *ctx, size_t first, size_t count, void *arg)
{
  (void)ctx;
  (void)first;
  (void)count;
  (void)arg;
  return PENDRES_OK;
}

static void no_handles(void **state)
{
  const pendres_parts parts = { .n = 1 };
  pendres_cost cost;
  int wrong = 0;
  (void)state;
  INVALID(pendres_context_create(NULL, NULL));
  assert_in_range(pendres_parts_threads(), 1, 4096);
  INVALID(pendres_parts_run(NULL, no_work, NULL, NULL, 0));
  INVALID(pendres_parts_run(&parts, NULL, NULL, NULL, 0));
  INVALID(pendres_parts_run(&parts, no_work, NULL, NULL, 1));
  INVALID(pendres_parts_run(&(pendres_parts){ .n = 1, .threads = -1 }, no_work, NULL, NULL, 0));
  INVALID(pendres_parts_run(&(pendres_parts){ .n = 1, .options = { .tolerance = NAN } }, no_work,
                            NULL, NULL, 0));
  pendres_context_free(NULL);
  assert_non_null(pendres_context_message(NULL));
  assert_null(pendres_context_options(NULL));
  pendres_context_cost(NULL, &cost);
  assert_true(isnan(cost.steps));
  pendres_context_cost(NULL, NULL);
  pendres_context_cost_reset(NULL);
  pendres_context_set_interrupt(NULL, NULL, NULL);
  pendres_context_set_keep(NULL, NULL);
  assert_int_equal(wrong, 0);
}

static void models(void **state)
{
  int wrong = 0;
  double x = NAN;
  long double y = 0.5L, w = 0.0L;
  pendres_harmonic harmonic;
  pendres_rotation rotation;
  pendres_rotation_onset onset;
  reference_image image;
  reference_cycle cycle;
  const char *why = NULL;
  (void)state;
  INVALID(pendres_pendulum_check(NULL, &why));
  assert_non_null(why);
  INVALID(pendres_harmonic_find(NULL, &harmonic));
  INVALID(pendres_harmonic_find(&good, NULL));
  INVALID(pendres_rotation_find(NULL, &rotation, &why));
  INVALID(pendres_rotation_find(&good, &rotation, NULL)); /* it has a drive */
  INVALID(pendres_rotation_onset_find(0.1, NULL));
  assert_true(isnan(pendres_pendulum_acceleration(NULL, 0.0, 0.0, 0.0)));
  assert_true(isnan(pendres_pendulum_energy(NULL, 0.0, 0.0)));
  pendres_free_get(1.0, NULL);
  const pendres_pendulum forceless = {.drive_frequency = 1.0, .force = (pendres_force)77};
  assert_true(isnan(pendres_pendulum_acceleration(&forceless, 0.0, 0.0, 0.0)));
  assert_true(isnan(pendres_pendulum_energy(&forceless, 0.0, 0.0)));
  assert_true(isnan(x));
  assert_null(pendres_model_of((pendres_force)77));
  assert_null(pendres_force_text((pendres_force)77));
  assert_int_equal(pendres_force_define(NULL, NULL, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_force_define("x", NULL, NULL), PENDRES_INVALID_ARGUMENT);
  assert_false(pendres_pendulum_symmetric(NULL));
  assert_true(pendres_units_of(NULL).length == 1.0 && pendres_units_of(NULL).time == 1.0);
  assert_false(pendres_pendulum_leaves(NULL));
  assert_false(pendres_pendulum_rotates(NULL));
  assert_true(isnan(pendres_pendulum_decay_rate(NULL)));
  INVALID(reference_advance(NULL, &y, &w, NULL, 1));
  INVALID(reference_advance(&good, NULL, &w, NULL, 1));
  INVALID(reference_advance(&good, &y, NULL, NULL, 1));
  INVALID(reference_advance(&good, &y, &w, NULL, -1));
  INVALID(reference_map(NULL, y, w, 1, &image));
  INVALID(reference_map(&good, y, w, 1, NULL));
  INVALID(reference_orbit(NULL, y, w, 1, 0, &cycle));
  INVALID(reference_orbit(&good, y, w, 0, 0, &cycle));
  assert_int_not_equal(reference_orbit(&good, y, w, 1, LONG_MIN, &cycle), PENDRES_OK);
  INVALID(reference_orbit(&good, y, w, 1, 0, NULL));
  INVALID(reference_find(REFERENCE_RESONANCE, NULL,
                                 &(reference_guess){0.8L, y, w, 0.0L}, &cycle));
  INVALID(reference_find(REFERENCE_RESONANCE, &good,
                                 &(reference_guess){0.8L, y, w, 0.0L}, NULL));
  INVALID(reference_find(REFERENCE_FOLD, NULL,
                                 &(reference_guess){0.8L, y, w, 0.0L}, &cycle));
  INVALID(reference_find(REFERENCE_FOLD, &good,
                                 &(reference_guess){0.8L, y, w, 0.0L}, NULL));
  INVALID(reference_find(REFERENCE_SYMMETRY_BREAKING, NULL,
                                 &(reference_guess){0.8L, y, w, 0.0L}, &cycle));
  INVALID(reference_find(REFERENCE_SYMMETRY_BREAKING, &good,
                                 &(reference_guess){0.8L, y, w, 0.0L}, NULL));
  INVALID(reference_find(REFERENCE_CUSP, NULL,
                                 &(reference_guess){0.8L, y, w, 0.1L}, &cycle));
  INVALID(reference_find(REFERENCE_CUSP, &good,
                                 &(reference_guess){0.8L, y, w, 0.1L}, NULL));
  for (size_t i = 0; i < COUNT(bad_pendulums); i++) {
    INVALID(pendres_pendulum_check(&bad_pendulums[i], NULL));
    INVALID(pendres_harmonic_find(&bad_pendulums[i], &harmonic));
    INVALID(pendres_rotation_find(&bad_pendulums[i], &rotation, &why));
    if (i > 4) continue; /* the reference knows no temperature */
    INVALID(reference_advance(&bad_pendulums[i], &y, &w, NULL, 1));
    INVALID(reference_map(&bad_pendulums[i], y, w, 1, &image));
    INVALID(reference_orbit(&bad_pendulums[i], y, w, 1, 0, &cycle));
  }
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    const double b = bad_numbers[i];
    long double far = b;
    pendres_free free_one;
    INVALID(pendres_rotation_onset_find(b, &onset));
    (void)pendres_pendulum_energy(&good, b, b);
    assert_true(isnan(pendres_free_frequency(b)));
    pendres_free_get(b, &free_one);
    assert_true(isnan(free_one.frequency_error));
    INVALID(reference_advance(&good, &far, &w, NULL, 1));
    INVALID(reference_map(&good, b, w, 1, &image));
    INVALID(reference_orbit(&good, b, w, 1, 0, &cycle));
    if (b > 0.0 && isfinite(b)) continue; /* such a frequency is found out on the way */
    INVALID(reference_find(REFERENCE_RESONANCE, &good,
                                   &(reference_guess){b, y, w, 0.0L}, &cycle));
    INVALID(reference_find(REFERENCE_FOLD, &good,
                                   &(reference_guess){b, y, w, 0.0L}, &cycle));
    INVALID(reference_find(REFERENCE_SYMMETRY_BREAKING, &good,
                                   &(reference_guess){b, y, w, 0.0L}, &cycle));
    INVALID(reference_find(REFERENCE_CUSP, &good,
                                   &(reference_guess){b, y, w, 0.1L}, &cycle));
  }
  assert_int_equal(wrong, 0);
}

static void sweeps(void **state)
{
  int wrong = 0;
  size_t count = 0;
  double value[4], x, v;
  const double list[2] = { 1.0, NAN };
  const pendres_range ranges[] = {
    { NAN, 1.0, 3 }, { 0.0, INFINITY, 3 }, { 1.0, 0.0, 3 }, { 1.0, 1.0, 3 } };
  pendres_sweep sweep = { .pendulum = good, .axes = 99 };
  (void)state;
  INVALID(pendres_sweep_values(2, NULL, NULL, value, &count));
  INVALID(pendres_sweep_values(2, list, NULL, value, &count));
  INVALID(pendres_sweep_values(1, list, NULL, value, NULL));
  for (size_t i = 0; i < COUNT(ranges); i++)
    INVALID(pendres_sweep_values(0, NULL, &ranges[i], value, &count));
  INVALID(pendres_sweep_count(NULL, &count));
  INVALID(pendres_sweep_count(&sweep, &count));
  INVALID(pendres_sweep_count(&sweep, NULL));
  assert_true(isnan(pendres_sweep_pendulum(NULL, 0, &x, &v).damping) && isnan(x) && isnan(v));
  assert_true(isnan(pendres_sweep_pendulum(&sweep, 0, NULL, NULL).damping));
  sweep.axes = 1;
  const pendres_axis no_axes[] = {
    { .parameter = PENDRES_X, .count = 0, .value = list },
    { .parameter = PENDRES_X, .count = 1, .value = NULL },
    { .parameter = (pendres_parameter)-1, .count = 1, .value = list },
    { .parameter = PENDRES_X, .count = 1, .value = list } }; /* but one value */
  for (size_t i = 0; i < COUNT(no_axes); i++) {
    sweep.axis[0] = no_axes[i];
    assert_true(isnan(pendres_sweep_pendulum(&sweep, 1, &x, &v).damping) && isnan(x) && isnan(v));
  }
  sweep.axis[0] = (pendres_axis){ .parameter = PENDRES_PARAMETER_COUNT, .count = 1, .value = list };
  INVALID(pendres_sweep_count(&sweep, &count));
  sweep.axis[0] = (pendres_axis){ .parameter = PENDRES_X, .count = 1, .value = NULL };
  INVALID(pendres_sweep_count(&sweep, &count));
  pendres_ensemble_start(NULL, 1, &x, &v);
  assert_true(isnan(x) && isnan(v));
  INVALID(pendres_ensemble_check(NULL, NULL));
  const pendres_ensemble nobody = pendres_ensemble_default();
  assert_int_equal(nobody.members, 200);
  const pendres_pendulum none = { .force = PENDRES_FORCE_COUNT };
  assert_true(pendres_ensemble_of(&none).x_last == nobody.x_last);
  pendres_response_average(NULL);
  pendres_response r = { .states = SIZE_MAX };
  pendres_response_average(&r);
  assert_true(isnan(r.mean_loop_area));
  assert_int_equal(wrong, 0);
}

static void plans(void **state)
{
  int wrong = 0;
  const double x[2] = { 0.0, 1.0 };
  const pendres_basin_grid grid = { .nx = 2, .nv = 2, .x = x, .v = x };
  pendres_basin_plan *plan = NULL;
  pendres_basin_sums *sums = NULL;
  pendres_basin_state s[4] = { { 0 } };
  pendres_basin_statistics statistics;
  const pendres_basin_well *wells;
  const size_t *index;
  size_t n;
  double fraction[4], error[4];
  pendres_basin_grid no_end = grid;
  no_end.by = (pendres_basin_end)7;
  (void)state;
  INVALID(pendres_basin_plan_create(NULL, 0, 1, 0, &plan));
  INVALID(pendres_basin_plan_create(&grid, 0, 1, 0, NULL));
  INVALID(pendres_basin_plan_create(&grid, 2, 1, 0, &plan));
  INVALID(pendres_basin_plan_create(&grid, 1, SIZE_MAX, 0, &plan));
  INVALID(pendres_basin_plan_create(&grid, 0, 1, -3, &plan));
  INVALID(pendres_basin_plan_create(&grid, 0, 1, 5, &plan));
  pendres_basin_plan_free(NULL);
  INVALID(pendres_basin_plan_next(NULL, &n, &index));
  INVALID(pendres_basin_plan_accept(NULL, s));
  INVALID(pendres_basin_plan_sample(NULL, 1, 1, &n, &index));
  INVALID(pendres_basin_plan_verify(NULL, s, &n));
  INVALID(pendres_basin_plan_states(NULL, s));
  INVALID(pendres_basin_plan_rows(NULL, 0, 1, s));
  assert_int_equal(pendres_basin_plan_integrated(NULL), 0);
  assert_int_equal(pendres_basin_plan_filled(NULL), 0);
  assert_true(pendres_basin_plan_suspected(5, 0) == 5.0);
  assert_true(pendres_basin_plan_suspected(0, SIZE_MAX) == 0.0);
  check_ok(pendres_basin_plan_create(&grid, 0, 2, 0, &plan));
  INVALID(pendres_basin_plan_next(plan, NULL, &index));
  INVALID(pendres_basin_plan_next(plan, &n, NULL));
  INVALID(pendres_basin_plan_accept(plan, NULL));
  INVALID(pendres_basin_plan_sample(plan, 1, 1, NULL, &index));
  INVALID(pendres_basin_plan_sample(plan, 1, 1, &n, NULL));
  INVALID(pendres_basin_plan_verify(plan, NULL, &n));
  INVALID(pendres_basin_plan_verify(plan, s, NULL));
  INVALID(pendres_basin_plan_states(plan, NULL));
  INVALID(pendres_basin_plan_rows(plan, 0, 1, NULL));
  pendres_basin_plan_free(plan);
  INVALID(pendres_basin_sums_create(NULL, 1, &sums));
  INVALID(pendres_basin_sums_create(&grid, 1, NULL));
  INVALID(pendres_basin_sums_create(&grid, SIZE_MAX, &sums));
  INVALID(pendres_basin_sums_create(&no_end, 1, &sums));
  pendres_basin_sums_free(NULL);
  INVALID(pendres_basin_sums_add(NULL, 1, s));
  INVALID(pendres_basin_sums_suspect(NULL, 1.0));
  INVALID(pendres_basin_sums_result(NULL, &statistics, fraction, error));
  INVALID(pendres_basin_sums_counts(NULL, &n));
  INVALID(pendres_basin_sums_wells(NULL, &n, &wells));
  check_ok(pendres_basin_sums_create(&grid, 1, &sums));
  INVALID(pendres_basin_sums_add(sums, 1, NULL));
  INVALID(pendres_basin_sums_add(sums, 3, s));
  INVALID(pendres_basin_sums_suspect(sums, NAN));
  INVALID(pendres_basin_sums_suspect(sums, -1.0));
  INVALID(pendres_basin_sums_result(sums, &statistics, fraction, error)); /* rows are missing */
  check_ok(pendres_basin_sums_add(sums, 2, s));
  INVALID(pendres_basin_sums_result(sums, NULL, fraction, error));
  INVALID(pendres_basin_sums_counts(sums, NULL));
  INVALID(pendres_basin_sums_wells(sums, NULL, &wells));
  INVALID(pendres_basin_sums_wells(sums, &n, NULL));
  pendres_basin_sums_free(sums);
  assert_int_equal(wrong, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(nothing),
    cmocka_unit_test(no_handles),
    cmocka_unit_test(models),
    cmocka_unit_test(sweeps),
    cmocka_unit_test(plans),
  };
  return cmocka_run_group_tests_name("arguments_plain", tests, NULL, NULL);
}
