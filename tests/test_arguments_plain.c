/*
 * test_arguments_plain.c -- every public function without a context, with arguments that are NULL,
 * NaN, infinite, huge, negative or out of an enum: a status, a NULL, a NaN or nothing, never a
 * crash. Those with a context are in test_arguments.c.
 */
#define _XOPEN_SOURCE 700 /* mkdtemp */
#include "check.h"

#include <float.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <pendres/pendres.h>
#include <pendres/reference.h>
#include <pendres/store.h>

#include "langevin_fixture.h"

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))
#define INVALID(call) invalid((call), #call, &wrong)

static const pendres_pendulum good = {
  .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.8, .temperature = 1e-3 };
static const pendres_pendulum bad_pendulums[] = {
  { NAN, 0.2, 0.8, 0.0 }, { -0.1, 0.2, 0.8, 0.0 }, { 0.1, INFINITY, 0.8, 0.0 },
  { 0.1, 0.2, 0.0, 0.0 }, { 0.1, 0.2, NAN, 0.0 },  { 0.1, 0.2, 0.8, NAN }, { 0.1, 0.2, 0.8, -1.0 },
};
static const double bad_numbers[] = { NAN, INFINITY, -INFINITY, DBL_MAX, -1e100 };

static void invalid(pendres_status status, const char *call, int *wrong)
{
  if (status == PENDRES_INVALID_ARGUMENT) return;
  print_error("%s: status %d\n", call, (int)status);
  ++*wrong;
}

/* Names of what is out of an enum, and what is made of no object at all. */
static void nothing(void **state)
{
  (void)state;
  for (int i = -1; i < 1000; i += 1000) {
    assert_null(pendres_label_name((pendres_label)i));
    assert_null(pendres_regime_name((pendres_regime)i));
    assert_null(pendres_method_name((pendres_method)i));
    assert_null(pendres_cloud_verdict_name((pendres_cloud_verdict)i));
    assert_null(pendres_switching_verdict_name((pendres_switching_verdict)i));
    assert_null(pendres_table_name((pendres_table)i));
    assert_int_equal(pendres_table_order((pendres_table)i), 0);
    assert_non_null(pendres_status_message((pendres_status)i));
  }
  assert_int_equal(pendres_method_named(NULL), PENDRES_METHOD_COUNT);
  assert_int_equal(pendres_table_named(NULL), PENDRES_TABLE_COUNT);
  assert_null(pendres_options_check(NULL));
  assert_non_null(pendres_version());
  assert_non_null(pendres_build_info());
  pendres_attractors_free(NULL);
  assert_int_equal(pendres_attractors_count(NULL), 0);
  assert_null(pendres_attractors_get(NULL, 0));
  pendres_boundary_free(NULL);
  assert_int_equal(pendres_boundary_count(NULL), 0);
  assert_null(pendres_boundary_x(NULL));
  assert_null(pendres_boundary_v(NULL));
  assert_null(pendres_boundary_piece(NULL));
  assert_null(pendres_boundary_error(NULL));
  (void)pendres_boundary_bound(NULL);
  (void)pendres_boundary_complete(NULL);
  pendres_branch_free(NULL);
  assert_int_equal(pendres_branch_count(NULL), 0);
  assert_null(pendres_branch_get(NULL, 0));
  assert_int_equal(pendres_branch_bifurcations(NULL), 0);
  assert_null(pendres_branch_bifurcation(NULL, 0));
  (void)pendres_branch_end_of(NULL, 7);
  assert_int_equal(pendres_branch_parts(NULL, 4, NULL), 0);
  pendres_branches_free(NULL);
  pendres_hysteresis_free(NULL);
  assert_int_equal(pendres_hysteresis_count(NULL), 0);
  assert_null(pendres_hysteresis_get(NULL, 0));
  assert_int_equal(pendres_hysteresis_jumps(NULL), 0);
  assert_null(pendres_hysteresis_jump(NULL, 0));
  const pendres_ramp no_ramp = {.corners = 0};
  pendres_ramp_summary summary;
  assert_int_equal(pendres_ramp_periods(NULL), 0);
  assert_int_equal(pendres_ramp_periods(&no_ramp), 0);
  assert_true(isnan(pendres_ramp_value(NULL, 0.0)) && isnan(pendres_ramp_value(&no_ramp, 0.0)));
  assert_int_equal(pendres_ramp_summarize(1, NULL, &summary), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_ramp_summarize(0, NULL, NULL), PENDRES_INVALID_ARGUMENT);
  assert_null(pendres_jump_kind_name(PENDRES_JUMP_COUNT));
  assert_int_equal(pendres_branches_count(NULL), 0);
  assert_null(pendres_branches_get(NULL, 0));
  assert_int_equal(pendres_branches_skipped(NULL), 0);
  pendres_branches_pack(NULL, NULL);
  assert_true(pendres_branches_packed_size(NULL) > 0);
  pendres_curve_free(NULL);
  (void)pendres_curve_kind(NULL);
  assert_int_equal(pendres_curve_count(NULL), 0);
  assert_null(pendres_curve_get(NULL, 0));
  assert_int_equal(pendres_curve_cusps(NULL), 0);
  assert_null(pendres_curve_cusp(NULL, 0));
  assert_int_equal(pendres_curve_parameter(NULL, -1), PENDRES_PARAMETER_COUNT);
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
  INVALID(pendres_parts_run(NULL, no_work, NULL, NULL, 0));
  INVALID(pendres_parts_run(&parts, NULL, NULL, NULL, 0));
  INVALID(pendres_parts_run(&parts, no_work, NULL, NULL, 1));
  INVALID(pendres_parts_run(&(pendres_parts){ .n = 1, .threads = -1 }, no_work, NULL, NULL, 0));
  INVALID(pendres_parts_run(&(pendres_parts){ .n = 1, .options = { .tolerance = NAN } }, no_work,
                            NULL, NULL, 0));
  pendres_branches *branches = NULL;
  INVALID(pendres_branches_unpack(64, NULL, &branches));
  INVALID(pendres_branches_unpack(0, &wrong, &branches));
  INVALID(pendres_branches_unpack(sizeof wrong, &wrong, NULL));
  pendres_context_free(NULL);
  assert_non_null(pendres_context_message(NULL));
  assert_null(pendres_context_options(NULL));
  pendres_context_cost(NULL, &cost);
  assert_true(isnan(cost.steps));
  pendres_context_cost(NULL, NULL);
  pendres_context_cost_reset(NULL);
  pendres_context_set_interrupt(NULL, NULL, NULL);
  assert_true(isnan(pendres_basin_accuracy(NULL, NULL)));
  assert_int_equal(wrong, 0);
}

static void models(void **state)
{
  int wrong = 0;
  double x = NAN, v = NAN;
  long double y = 0.5L, w = 0.0L;
  pendres_harmonic harmonic;
  pendres_rotation rotation;
  pendres_rotation_onset onset;
  pendres_reference_image image;
  pendres_reference_cycle cycle;
  const char *why = NULL;
  (void)state;
  INVALID(pendres_pendulum_check(NULL, &why));
  assert_non_null(why);
  INVALID(pendres_harmonic_response(NULL, &harmonic));
  INVALID(pendres_harmonic_response(&good, NULL));
  INVALID(pendres_rotation_find(NULL, &rotation, &why));
  INVALID(pendres_rotation_find(&good, &rotation, NULL)); /* it has a drive */
  INVALID(pendres_rotation_least_torque(0.1, NULL));
  INVALID(pendres_rotation_most_damping(&x, NULL));
  INVALID(pendres_rotation_most_damping(NULL, &x));
  assert_true(isnan(pendres_pendulum_acceleration(NULL, 0.0, 0.0, 0.0)));
  pendres_pendulum_jacobian(NULL, 0.0, 0.0, &x, &v);
  pendres_pendulum_jacobian(&good, 0.0, 0.0, NULL, NULL);
  assert_null(pendres_model_of((pendres_force)77));
  assert_false(pendres_pendulum_symmetric(NULL));
  assert_true(isnan(pendres_pendulum_potential(NULL, 0.0)));
  pendres_pendulum_mirror(NULL, NULL);
  pendres_pendulum_mirror(&x, &v);
  INVALID(pendres_reference_advance(NULL, &y, &w, NULL, 1));
  INVALID(pendres_reference_advance(&good, NULL, &w, NULL, 1));
  INVALID(pendres_reference_advance(&good, &y, NULL, NULL, 1));
  INVALID(pendres_reference_advance(&good, &y, &w, NULL, -1));
  INVALID(pendres_reference_map(NULL, y, w, 1, &image));
  INVALID(pendres_reference_map(&good, y, w, 1, NULL));
  INVALID(pendres_reference_orbit(NULL, y, w, 1, 0, &cycle));
  INVALID(pendres_reference_orbit(&good, y, w, 0, 0, &cycle));
  INVALID(pendres_reference_orbit(&good, y, w, 1, 0, NULL));
  INVALID(pendres_reference_resonance(NULL, 0.8L, y, w, &cycle));
  INVALID(pendres_reference_resonance(&good, 0.8L, y, w, NULL));
  INVALID(pendres_reference_fold(NULL, 0.8L, y, w, &cycle));
  INVALID(pendres_reference_fold(&good, 0.8L, y, w, NULL));
  INVALID(pendres_reference_symmetry_breaking(NULL, 0.8L, y, w, &cycle));
  INVALID(pendres_reference_symmetry_breaking(&good, 0.8L, y, w, NULL));
  INVALID(pendres_reference_cusp(NULL, 0.8L, 0.1L, y, w, &cycle));
  INVALID(pendres_reference_cusp(&good, 0.8L, 0.1L, y, w, NULL));
  for (size_t i = 0; i < COUNT(bad_pendulums); i++) {
    INVALID(pendres_pendulum_check(&bad_pendulums[i], NULL));
    INVALID(pendres_harmonic_response(&bad_pendulums[i], &harmonic));
    INVALID(pendres_rotation_find(&bad_pendulums[i], &rotation, &why));
    if (i > 4) continue; /* the reference knows no temperature */
    INVALID(pendres_reference_advance(&bad_pendulums[i], &y, &w, NULL, 1));
    INVALID(pendres_reference_map(&bad_pendulums[i], y, w, 1, &image));
    INVALID(pendres_reference_orbit(&bad_pendulums[i], y, w, 1, 0, &cycle));
  }
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    const double b = bad_numbers[i];
    long double far = b;
    INVALID(pendres_rotation_least_torque(b, &onset));
    (void)pendres_pendulum_well(b);
    (void)pendres_pendulum_energy(b, b);
    (void)pendres_pendulum_potential(&good, b);
    assert_true(isnan(pendres_free_frequency(b)));
    (void)pendres_free_frequency_kittel(b);
    (void)pendres_free_frequency_belendez(b);
    INVALID(pendres_reference_advance(&good, &far, &w, NULL, 1));
    INVALID(pendres_reference_map(&good, b, w, 1, &image));
    INVALID(pendres_reference_orbit(&good, b, w, 1, 0, &cycle));
    if (b > 0.0 && isfinite(b)) continue; /* such a frequency is found out on the way */
    INVALID(pendres_reference_resonance(&good, b, y, w, &cycle));
    INVALID(pendres_reference_fold(&good, b, y, w, &cycle));
    INVALID(pendres_reference_symmetry_breaking(&good, b, y, w, &cycle));
    INVALID(pendres_reference_cusp(&good, b, 0.1L, y, w, &cycle));
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
  assert_true(isnan(pendres_range_value(NULL, 0)));
  assert_true(isnan(pendres_range_value(&ranges[0], SIZE_MAX)));
  INVALID(pendres_sweep_values(2, NULL, NULL, value, &count));
  INVALID(pendres_sweep_values(2, list, NULL, value, &count));
  INVALID(pendres_sweep_values(1, list, NULL, value, NULL));
  for (size_t i = 0; i < COUNT(ranges); i++)
    INVALID(pendres_sweep_values(0, NULL, &ranges[i], value, &count));
  INVALID(pendres_sweep_count(NULL, &count));
  INVALID(pendres_sweep_count(&sweep, &count));
  INVALID(pendres_sweep_count(&sweep, NULL));
  (void)pendres_sweep_pendulum(NULL, 0, &x, &v);
  sweep.axes = 1;
  sweep.axis[0] = (pendres_axis){ .quantity = PENDRES_QUANTITY_COUNT, .count = 1, .value = list };
  INVALID(pendres_sweep_count(&sweep, &count));
  sweep.axis[0] = (pendres_axis){ .quantity = PENDRES_QUANTITY_X, .count = 1, .value = NULL };
  INVALID(pendres_sweep_count(&sweep, &count));
  assert_true(isnan(pendres_ensemble_x(NULL, 1)));
  pendres_ensemble_start(NULL, 1, &x, &v);
  assert_true(isnan(x) && isnan(v));
  INVALID(pendres_ensemble_check(NULL, NULL));
  const pendres_ensemble nobody = pendres_ensemble_default();
  assert_int_equal(nobody.members, 200);
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
  INVALID(pendres_basin_sums_well_shares(NULL, fraction, error));
  check_ok(pendres_basin_sums_create(&grid, 1, &sums));
  INVALID(pendres_basin_sums_add(sums, 1, NULL));
  INVALID(pendres_basin_sums_add(sums, 3, s));
  INVALID(pendres_basin_sums_suspect(sums, NAN));
  INVALID(pendres_basin_sums_suspect(sums, -1.0));
  INVALID(pendres_basin_sums_result(sums, &statistics, fraction, error)); /* rows are missing */
  INVALID(pendres_basin_sums_well_shares(sums, fraction, error));
  check_ok(pendres_basin_sums_add(sums, 2, s));
  INVALID(pendres_basin_sums_result(sums, NULL, fraction, error));
  INVALID(pendres_basin_sums_counts(sums, NULL));
  INVALID(pendres_basin_sums_wells(sums, NULL, &wells));
  INVALID(pendres_basin_sums_wells(sums, &n, NULL));
  pendres_basin_sums_free(sums);
  assert_int_equal(wrong, 0);
}

static void noise(void **state)
{
  int wrong = 0;
  double x = 1.0, v = 0.0;
  pendres_langevin_interval rate;
  const double m[4] = { 0.5, 0.1, -0.1, 0.5 };
  const pendres_langevin_covariance q = { 1.0, 0.0, 1.0 };
  pendres_langevin_covariance sigma;
  pendres_langevin_linear linear;
  pendres_langevin_cloud cloud;
  pendres_langevin_bias bias;
  pendres_context *ctx = make(1, 16, 8);
  const unsigned all = PENDRES_LANGEVIN_CLOUD;
  const pendres_langevin_request request = {
    .pendulum = good, .x = 1.0, .trajectories = 2, .record = 1 };
  (void)state;
  INVALID(pendres_langevin_advance(NULL, RUN(1, &good, NULL, 0, 1, NULL), &x, &v));
  INVALID(pendres_langevin_advance(ctx, RUN(1, NULL, NULL, 0, 1, NULL), &x, &v));
  INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, 1, NULL), NULL, &v));
  INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, 1, NULL), &x, NULL));
  INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, -1, 1, NULL), &x, &v));
  INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, LONG_MAX, NULL), &x, &v));
  INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, LONG_MAX, LONG_MAX, NULL), &x, &v));
  const pendres_langevin_observer blind = { NULL, NULL, 0 };
  INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, 1, &blind), &x, &v));
  INVALID(pendres_langevin_advance(ctx, NULL, &x, &v));
  for (int i = 0; i < 3; i++) {
    const int steps[3] = { 1, INT_MIN, INT_MAX };
    const pendres_langevin_run run = { .n = 1, .pendulums = &good, .steps_per_period = steps[i] };
    INVALID(pendres_langevin_advance(ctx, &run, &x, &v));
  }
  INVALID(pendres_langevin_measure(NULL, &request, &cloud, NULL, NULL));
  INVALID(pendres_langevin_measure(ctx, NULL, &cloud, NULL, NULL));
  INVALID(pendres_langevin_measure(ctx, &request, NULL, NULL, NULL));
  INVALID(pendres_langevin_measure(ctx, &request, &cloud, &x, NULL));
  INVALID(pendres_langevin_measure_bias(ctx, NULL, &bias));
  INVALID(pendres_langevin_measure_bias(ctx, &request, NULL));
  INVALID(pendres_langevin_choose_steps(ctx, NULL, all, 0.1, &bias));
  INVALID(pendres_langevin_choose_steps(ctx, &request, all, 0.1, NULL));
  INVALID(pendres_langevin_choose_steps(ctx, &request, 0, 0.1, &bias));
  INVALID(pendres_langevin_choose_steps(ctx, &request, ~0u, 0.1, &bias));
  INVALID(pendres_langevin_choose_steps(ctx, &request, all, NAN, &bias));
  INVALID(pendres_langevin_choose_steps(ctx, &request, all, -1.0, &bias));
  for (size_t i = 0; i < COUNT(bad_pendulums); i++) {
    pendres_langevin_request r = request;
    r.pendulum = bad_pendulums[i];
    INVALID(pendres_langevin_advance(ctx, RUN(1, &bad_pendulums[i], NULL, 0, 1, NULL), &x, &v));
    INVALID(pendres_langevin_measure(ctx, &r, &cloud, NULL, NULL));
    INVALID(pendres_langevin_measure_bias(ctx, &r, &bias));
    INVALID(pendres_langevin_choose_steps(ctx, &r, all, 0.1, &bias));
    INVALID(pendres_langevin_linear_theory(&bad_pendulums[i], x, v, 1, &linear));
  }
  for (size_t i = 0; i < COUNT(bad_numbers); i++) {
    double b = bad_numbers[i];
    pendres_langevin_request r = request;
    *(i % 2 ? &r.x : &r.v) = b;
    double bad_m[4] = { 0.5, 0.1, -0.1, b };
    const pendres_langevin_covariance bad_q = { 1.0, b, 1.0 };
    INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, 1, NULL), &b, &v));
    INVALID(pendres_langevin_advance(ctx, RUN(1, &good, NULL, 0, 1, NULL), &x, &b));
    INVALID(pendres_langevin_measure(ctx, &r, &cloud, NULL, NULL));
    INVALID(pendres_langevin_linear_theory(&good, b, v, 1, &linear));
    INVALID(pendres_langevin_linear_theory(&good, x, b, 1, &linear));
    if (i > 2) continue; /* large numbers are no worse than others here */
    INVALID(pendres_langevin_lyapunov(bad_m, &q, &sigma));
    INVALID(pendres_langevin_lyapunov(m, &bad_q, &sigma));
    INVALID(pendres_langevin_rate(b, 1.0, 0.9, &rate));
    INVALID(pendres_langevin_rate(1.0, b, 0.9, &rate));
    INVALID(pendres_langevin_rate(1.0, 1.0, b, &rate));
  }
  INVALID(pendres_langevin_lyapunov(NULL, &q, &sigma));
  INVALID(pendres_langevin_lyapunov(m, NULL, &sigma));
  INVALID(pendres_langevin_lyapunov(m, &q, NULL));
  INVALID(pendres_langevin_linear_theory(NULL, x, v, 1, &linear));
  INVALID(pendres_langevin_linear_theory(&good, x, v, 0, &linear));
  INVALID(pendres_langevin_linear_theory(&good, x, v, 1, NULL));
  assert_int_not_equal(pendres_langevin_linear_theory(&good, x, v, INT_MAX, &linear), PENDRES_OK);
  INVALID(pendres_langevin_rate(1.0, 1.0, 0.9, NULL));
  INVALID(pendres_langevin_merge(1, NULL, &cloud));
  INVALID(pendres_langevin_merge(1, &cloud, NULL));
  assert_true(x == 1.0 && v == 0.0);
  pendres_context_free(ctx);
  assert_int_equal(wrong, 0);
}

/* Surveys of two states without any attractors, or of nothing. */
static void surveys(pendres_context *ctx, int *failed)
{
  int wrong = 0, steps, two[2] = { 7, 7 };
  const double t = 0.01;
  const pendres_switching_survey q = { .trajectories = 2, .periods = 1, .steps_per_period = 16 };
  pendres_switching_tally tally = { 0 };
  pendres_switching_rates rates;
  pendres_switching_activation energy[PENDRES_SWITCHING_WAYS];
  pendres_switching_states(NULL, two);
  assert_true(two[0] == -1 && two[1] == -1);
  pendres_switching_states(NULL, NULL);
  for (int i = 0; i < 2; i++) {
    const pendres_switching_survey *s = i == 0 ? NULL : &q;
    INVALID(pendres_switching_measure(ctx, s, 1, &t, &rates, energy));
    INVALID(pendres_switching_choose_steps(ctx, s, 0, &steps));
    INVALID(pendres_switching_follow(ctx, s, t, 0, &tally));
    INVALID(pendres_switching_conclude(s, t, &tally, &rates));
    INVALID(pendres_switching_activate(s, 1, &rates, energy));
  }
  INVALID(pendres_switching_measure(NULL, &q, 1, &t, &rates, energy));
  INVALID(pendres_switching_measure(ctx, &q, 1, NULL, &rates, energy));
  INVALID(pendres_switching_measure(ctx, &q, 1, &t, NULL, energy));
  INVALID(pendres_switching_measure(ctx, &q, 1, &t, &rates, NULL));
  INVALID(pendres_switching_choose_steps(ctx, &q, 0, NULL));
  INVALID(pendres_switching_choose_steps(ctx, &q, 2, &steps));
  INVALID(pendres_switching_follow(ctx, &q, t, SIZE_MAX, &tally));
  INVALID(pendres_switching_follow(ctx, &q, t, 0, NULL));
  INVALID(pendres_switching_conclude(&q, t, &tally, NULL));
  INVALID(pendres_switching_activate(&q, 1, NULL, energy));
  INVALID(pendres_switching_activate(&q, 1, &rates, NULL));
  assert_int_equal(pendres_switching_parts(NULL), 0);
  *failed += wrong;
}

/* Clouds and responses of nothing. */
static void clouds(void **state)
{
  int wrong = 0;
  double x = 1.0;
  size_t first = 7;
  pendres_context *ctx = make(1, 16, 8);
  const pendres_cloud_request q = { .temperature = 1e-3, .trajectories = 2, .record = 1,
                                    .steps_per_period = 16 };
  pendres_cloud cloud;
  pendres_langevin_cloud part;
  pendres_response still = { .pendulum = good };
  pendres_response_noise noisy;
  (void)state;
  for (int i = 0; i < 2; i++) {
    const pendres_cloud_request *r = i == 0 ? NULL : &q;
    INVALID(pendres_cloud_measure(ctx, r, &cloud, NULL, NULL));
    INVALID(pendres_cloud_prepare(ctx, r, &cloud, NULL, NULL));
    INVALID(pendres_cloud_prepare(ctx, r, &cloud, &x, NULL));
    INVALID(pendres_cloud_follow(ctx, r, 0, &part, NULL, NULL));
    INVALID(pendres_cloud_conclude(r, 1, &part, &cloud));
  }
  INVALID(pendres_cloud_measure(NULL, &q, &cloud, NULL, NULL));
  INVALID(pendres_cloud_measure(ctx, &q, NULL, NULL, NULL));
  INVALID(pendres_cloud_prepare(ctx, &q, NULL, NULL, NULL));
  INVALID(pendres_cloud_follow(ctx, &q, SIZE_MAX, &part, NULL, NULL));
  INVALID(pendres_cloud_follow(ctx, &q, 0, NULL, NULL, NULL));
  INVALID(pendres_cloud_conclude(&q, 1, &part, NULL));
  assert_int_equal(pendres_cloud_parts(NULL), 0);
  assert_int_equal(pendres_cloud_part(NULL, 0, &first), 0);
  assert_int_equal(pendres_cloud_part(&q, SIZE_MAX, NULL), 0);
  INVALID(pendres_response_add_noise(NULL, &still, 0.0, 2, 1, &noisy));
  INVALID(pendres_response_add_noise(ctx, NULL, 0.0, 2, 1, &noisy));
  INVALID(pendres_response_add_noise(ctx, &still, 0.0, 2, 1, NULL));
  INVALID(pendres_response_add_noise(ctx, &still, 0.0, 2, -1, &noisy));
  for (size_t i = 0; i < 3; i++)
    INVALID(pendres_response_add_noise(ctx, &still, bad_numbers[i], 2, 1, &noisy));
  still.states = SIZE_MAX;
  INVALID(pendres_response_add_noise(ctx, &still, 0.0, 2, 1, &noisy));
  assert_true(first == 0 && x == 1.0);
  pendres_context_free(ctx);
  assert_int_equal(wrong, 0);
}

static void switching(void **state)
{
  int wrong = 0, attractor = 7;
  long well = 7;
  pendres_switching_tally tally = { 0 };
  pendres_switching_rate rate;
  pendres_switching_activation energy;
  pendres_context *ctx = make(1, 16, 8);
  const pendres_switching_request nowhere = { .pendulum = good, .trajectories = 2, .periods = 1 };
  const double t[3] = { 0.01, 0.02, 0.03 };
  pendres_switching_rate r[3];
  (void)state;
  pendres_switching_locate(NULL, 0.5, 1.0, 0.0, &attractor, &well);
  assert_true(attractor == -1 && well == 0);
  pendres_switching_locate(NULL, NAN, NAN, INFINITY, NULL, NULL);
  INVALID(pendres_switching_count(NULL, &nowhere, &tally));
  INVALID(pendres_switching_count(ctx, NULL, &tally));
  INVALID(pendres_switching_count(ctx, &nowhere, NULL));
  INVALID(pendres_switching_count(ctx, &nowhere, &tally)); /* no attractors */
  pendres_switching_add(NULL, &tally);
  pendres_switching_add(&tally, NULL);
  INVALID(pendres_switching_rate_of(NULL, 0, 0, 0.9, &rate));
  INVALID(pendres_switching_rate_of(&tally, 0, 0, 0.9, NULL));
  INVALID(pendres_switching_rate_of(&tally, SIZE_MAX, 0, 0.9, &rate));
  INVALID(pendres_switching_rate_of(&tally, 0, SIZE_MAX, 0.9, &rate));
  INVALID(pendres_switching_rate_of(&tally, 0, 0, NAN, &rate));
  INVALID(pendres_switching_rate_of(&tally, 0, 0, 1.0, &rate));
  for (size_t i = 0; i < 3; i++)
    r[i] = (pendres_switching_rate){ .events = 100.0, .value = exp(-0.1 / t[i]),
                                     .error = 0.1 * exp(-0.1 / t[i]) };
  check_ok(pendres_switching_fit(3, t, r, 0.0, &energy));
  INVALID(pendres_switching_fit(3, NULL, r, 0.0, &energy));
  INVALID(pendres_switching_fit(3, t, NULL, 0.0, &energy));
  INVALID(pendres_switching_fit(3, t, r, 0.0, NULL));
  for (size_t i = 0; i < 6; i++) {
    const pendres_switching_rate kept = r[1];
    const double bad[] = { NAN, INFINITY, -1.0 };
    *(i % 2 ? &r[1].value : &r[1].error) = bad[i / 2];
    INVALID(pendres_switching_fit(3, t, r, 0.0, &energy));
    r[1] = kept;
  }
  pendres_switching_leave(NULL, NULL, NULL);
  surveys(ctx, &wrong);
  pendres_context_free(ctx);
  assert_int_equal(wrong, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(nothing), cmocka_unit_test(no_handles), cmocka_unit_test(models),
    cmocka_unit_test(sweeps),  cmocka_unit_test(plans),      cmocka_unit_test(noise),
    cmocka_unit_test(switching), cmocka_unit_test(clouds),
  };
  return cmocka_run_group_tests_name("arguments_plain", tests, NULL, NULL);
}
