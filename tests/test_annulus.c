/*
 * test_annulus.c -- rotations that no closed orbit describes are attractors: without a drive, and
 * without a lock to it; beside rest or alone. Labels and means are compared with Runge and Kutta's
 * method of fourth order, and where there is no drive with the series of pendres_rotation_find().
 */
#include "check.h"
#include "context_fixture.h"
#include "rotation_fixture.h"

#include <pendres/attractor.h>
#include <pendres/hysteresis.h>
#include <pendres/lyapunov.h>
#include <pendres/resonance.h>
#include <pendres/response.h>
#include <pendres/rotation.h>

enum { STARTS = 400 };

/* Whether a start rotates after so long, by steps of fourth order whose errors of 1e-7 matter to
   starts alone that are as close to the boundary. */
static int rotates(const pendres_pendulum *p, double x, double v, double time)
{
  const double h = 0.01, origin = 1.57079632679489661923;
  double y = x - origin, before = y;
  const long steps = (long)(time / h), last = (long)(20.0 / h);
  for (long i = 0; i < steps; i++) {
    double dy[4], dv[4];
    if (i == steps - last) before = y;
    for (int s = 0; s < 4; s++) {
      const double part = s == 0 ? 0.0 : s == 3 ? h : 0.5 * h;
      const double at = y + (s > 0 ? part * dy[s - 1] : 0.0);
      dy[s] = v + (s > 0 ? part * dv[s - 1] : 0.0);
      dv[s] = p->torque + p->drive_amplitude * cos(p->drive_frequency * ((double)i * h + part)) -
              sin(at) - p->damping * dy[s];
    }
    y += h / 6.0 * (dy[0] + 2.0 * (dy[1] + dy[2]) + dy[3]);
    v += h / 6.0 * (dv[0] + 2.0 * (dv[1] + dv[2]) + dv[3]);
  }
  return fabs(y - before) > two_pi;
}

static double share(long k, double irrational)
{
  return fmod(0.5 + irrational * (double)k, 1.0);
}

/* Settle spread starts, and compare each with the integrator. How many rotate. */
static size_t compare_starts(const pendres_pendulum *p, pendres_label label, double *drift,
                             double *drift_error)
{
  pendres_attractors *set = NULL;
  pendres_settled outcome[STARTS];
  double x[STARTS], v[STARTS];
  pendres_pendulum all[STARTS];
  size_t turning = 0;
  pendres_context *ctx = context_with(&(pendres_options){.tolerance = 1e-8});
  for (int k = 0; k < STARTS; k++) {
    x[k] = two_pi * (share(k, 0.7548776662466927) - 0.5);
    v[k] = 20.0 * (share(k, 0.5698402909980532) - 0.5);
    all[k] = *p;
  }
  assert_int_equal(pendres_settle(ctx, STARTS, all, x, v, outcome, &set), PENDRES_OK);
  for (int k = 0; k < STARTS; k++) {
    assert_true(outcome[k].attractor >= 0);
    assert_int_equal(outcome[k].certain, 1);
    const pendres_attractor *a = pendres_attractors_get(set, (size_t)outcome[k].attractor);
    assert_int_equal(outcome[k].label, a->label);
    assert_int_equal(outcome[k].label == label, rotates(p, x[k], v[k], 40.0 / p->damping));
    if (outcome[k].label != label) continue;
    turning++;
    *drift = a->drift;
    *drift_error = a->drift_error;
  }
  pendres_attractors_free(set);
  pendres_context_free(ctx);
  return turning;
}

/* The benchmark of basins by Menck, Heitzig, Marwan and Kurths, Nature Physics 9 (2013) 89: 0.848
   of the starts rotate, as bSTAB and pyBasin find; one of 400 differs by less than five standard
   deviations of a share. */
static void beside_rest(void **state)
{
  const pendres_pendulum p = {.damping = 0.1, .torque = 0.5, .drive_frequency = 1.0};
  pendres_rotation exact;
  double drift = NAN, error = NAN;
  (void)state;
  const size_t turning = compare_starts(&p, PENDRES_LABEL_RUNNING, &drift, &error);
  check_near((double)turning / STARTS, 0.848, 5.0 * sqrt(0.848 * 0.152 / STARTS));
  assert_int_equal(pendres_rotation_find(&p, &exact, NULL), PENDRES_OK);
  check_near(drift, exact.mean_velocity / p.drive_frequency, error);
}

/* Strongly damped, some starts move as the torque pushes, but not over the top: to either side. */
static void short_of_the_top(void **state)
{
  double drift, error;
  (void)state;
  for (int way = -1; way <= 1; way += 2) {
    const pendres_pendulum p = {.damping = 0.7, .torque = 0.9 * way, .drive_frequency = 1.4};
    const size_t turning = compare_starts(&p, PENDRES_LABEL_RUNNING, &drift, &error);
    assert_true(turning > 0 && turning < STARTS);
  }
}

/* What averages tell of the same pendulum: a state at rest, and one that rotates. */
static void by_averages(void **state)
{
  const pendres_pendulum p[] = {{.damping = 0.1, .torque = 0.5, .drive_frequency = 1.0},
                                {.damping = 0.1, .torque = 0.5, .drive_frequency = 1.0}};
  const double x[] = {2.0, 2.0}, v[] = {0.0, 5.0};
  pendres_settled told[2];
  pendres_rotation exact;
  (void)state;
  pendres_context *ctx = context_with(&(pendres_options){.tolerance = 1e-8});
  assert_int_equal(pendres_lyapunov_find(ctx, 2, p, x, v, NULL, told), PENDRES_OK);
  assert_int_equal(pendres_rotation_find(p, &exact, NULL), PENDRES_OK);
  assert_int_equal(told[0].label, PENDRES_LABEL_PERIODIC);
  assert_int_equal(told[1].label, PENDRES_LABEL_RUNNING);
  assert_int_equal(told[1].certain, 1);
  assert_true(told[1].exponent == 0.0);
  check_near(told[1].rotation, exact.mean_velocity, told[1].rotation_error);
  pendres_context_free(ctx);
}

/* Next to the torque at which rest begins a turn takes hundreds of periods, most of them in one
   place: nothing but the rotation is there, whoever is asked. */
static void hardly_turning(void **state)
{
  static const double torque[] = {1.00001, 1.001, -1.0001}, damping[] = {5.0, 1.2, 2.0};
  enum { N = sizeof torque / sizeof *torque };
  const pendres_state start = {1.0, 0.0};
  pendres_context *ctx = context_with(&(pendres_options){.tolerance = 1e-8});
  (void)state;
  for (size_t k = 0; k < N; k++) {
    const pendres_pendulum p = {
      .damping = damping[k], .torque = torque[k], .drive_frequency = 0.7};
    const pendres_hysteresis_path along = {PENDRES_TORQUE, 1, &torque[k]};
    pendres_attractors *set = NULL;
    pendres_hysteresis *path = NULL;
    pendres_settled outcome;
    pendres_settled told;
    pendres_rotation exact;
    assert_int_equal(pendres_rotation_find(&p, &exact, NULL), PENDRES_OK);
    const double turns = exact.mean_velocity / p.drive_frequency;
    assert_int_equal(pendres_settle(ctx, 1, &p, &start.x, &start.v, &outcome, &set), PENDRES_OK);
    assert_int_equal(outcome.label, PENDRES_LABEL_RUNNING);
    assert_int_equal(outcome.certain, 1);
    check_near(pendres_attractors_get(set, 0)->drift, turns, 1e-14);
    assert_int_equal(pendres_lyapunov_find(ctx, 1, &p, &start.x, &start.v, NULL, &told),
                     PENDRES_OK);
    assert_int_equal(told.label, PENDRES_LABEL_RUNNING);
    check_near(told.rotation, turns, 1e-14);
    assert_int_equal(pendres_hysteresis_find(ctx, &p, &start, &along, &path), PENDRES_OK);
    const pendres_hysteresis_point *point = pendres_hysteresis_get(path, 0);
    assert_int_equal(point->attractor.label, PENDRES_LABEL_RUNNING);
    check_near(point->mean_velocity, exact.mean_velocity, 1e-14);
    pendres_hysteresis_free(path);
    pendres_attractors_free(set);
  }
  pendres_context_free(ctx);
}

/* A junction with microwaves that is locked to none of them, whatever it starts from; another one
   beside the state without voltage. Means by smooth averages of an integrator of the fourth order
   with 400 steps: 1e-9. */
static void without_lock(void **state)
{
  const pendres_pendulum alone = {
    .damping = 0.5, .drive_amplitude = 0.1, .drive_frequency = 1.2, .torque = 1.3};
  const pendres_pendulum beside = {
    .damping = 0.12, .drive_amplitude = 0.1, .drive_frequency = 1.2, .torque = 0.4};
  double drift = NAN, error = NAN;
  (void)state;
  assert_int_equal(compare_starts(&alone, PENDRES_LABEL_QUASI_PERIODIC, &drift, &error), STARTS);
  check_near(drift, by_hand(&alone, 400, 4000), error + 1e-9);
  assert_true(error < 1e-7);
  const size_t turning =
    compare_starts(&beside, PENDRES_LABEL_QUASI_PERIODIC, &drift, &error);
  assert_in_range(turning, STARTS / 10, STARTS - STARTS / 10);
  check_near(drift, by_hand(&beside, 400, 4000), error + 1e-9);
}

/* Members of an ensemble that rotate without a lock are on a state that is known, with its work: by
   smooth averages as above, whose sums of 400 samples a period are off by less than 1e-9. */
static void members(void **state)
{
  const pendres_pendulum p = {
    .damping = 0.12, .drive_amplitude = 0.1, .drive_frequency = 1.2, .torque = 0.4};
  const pendres_ensemble e = {.members = 50, .x_first = -1.5, .x_last = 4.5};
  pendres_response r;
  pendres_response_noise cold, warm;
  double work = 0.0, area = 0.0, known = 0.0;
  (void)state;
  pendres_context *ctx = context_with(&(pendres_options){.tolerance = 1e-8});
  assert_int_equal(pendres_response_find(ctx, 1, &p, &e, &r), PENDRES_OK);
  assert_int_equal(pendres_response_noise_find(ctx, &r, 0.0, 64, 64, &cold), PENDRES_OK);
  assert_int_equal(pendres_response_noise_find(ctx, &r, 1e-6, 64, 64, &warm), PENDRES_OK);
  pendres_context_free(ctx);
  assert_int_equal(r.unresolved, 0);
  assert_int_equal(r.states, 2);
  (void)work_by_hand(&p, 400, 4000, &work);
  for (size_t k = 0; k < r.states; k++) {
    const pendres_attractor *a = &r.state[k];
    area += (double)r.state_members[k] / 50.0 * a->orbit.loop_area;
    if (a->label != PENDRES_LABEL_QUASI_PERIODIC) {
      /* No rotation is among those that noise is added to. */
      check_near(cold.amplitude.value, a->orbit.first_harmonic_amplitude, 1e-12);
      check_near(warm.amplitude.value, cold.amplitude.value, 5.0 * warm.amplitude.error);
      check_near(warm.loop_area.value, a->orbit.loop_area, 5.0 * warm.loop_area.error);
      continue;
    }
    known++;
    check_near(a->orbit.loop_area, work, a->orbit.loop_area_error + 1e-9);
    /* What friction takes is the work of the drive and of the torque. */
    check_near(a->orbit.dissipation, work + two_pi * p.torque * a->drift,
               a->orbit.dissipation_error + 1e-9);
  }
  assert_true(known == 1.0);
  check_near(r.mean_loop_area, area, 1e-12);
}

/* Where some members rotate and others swing the largest area is found all the same: no frequency
   of a few has a larger one. */
static void resonance(void **state)
{
  enum { FEW = 5 };
  pendres_pendulum p[FEW] = {{.damping = 0.12, .drive_amplitude = 0.1, .torque = 0.4}};
  const pendres_ensemble e = {.members = 6, .x_first = -1.5, .x_last = 4.5};
  pendres_resonance peak;
  pendres_response r[FEW];
  size_t turning = 0;
  (void)state;
  pendres_context *ctx = context_with(&(pendres_options){.tolerance = 1e-8});
  assert_int_equal(pendres_resonance_find_ensemble(ctx, &p[0], 0.8, 0.96, &e, &peak), PENDRES_OK);
  for (int k = 0; k < FEW; k++) {
    p[k] = p[0];
    p[k].drive_frequency = 0.8 + 0.04 * k;
  }
  assert_int_equal(pendres_response_find(ctx, FEW, p, &e, r), PENDRES_OK);
  pendres_context_free(ctx);
  for (int k = 0; k < FEW; k++) {
    for (size_t i = 0; i < r[k].states; i++)
      turning += r[k].state[i].label == PENDRES_LABEL_QUASI_PERIODIC;
    assert_true(r[k].mean_loop_area <=
                peak.response.mean_loop_area + peak.response.mean_loop_area_error);
  }
  assert_true(turning > 1);
}

/* So slow that all pendulums are in one place most of the time; and hardly damped, so that none has
   come to its rotation for thousands of periods. What friction takes is the work of the drive and
   of the torque, within the errors of all three. */
static void slow_or_weak(void **state)
{
  const pendres_pendulum p[] = {
    {.damping = 5.0, .drive_amplitude = 0.1, .drive_frequency = 1.2, .torque = 1.05},
    {.damping = 8.0, .drive_amplitude = 0.3, .drive_frequency = 1.2, .torque = 1.3},
    {.damping = 0.001, .drive_amplitude = 0.05, .drive_frequency = 2.3, .torque = 0.0033}};
  enum { N = sizeof p / sizeof *p };
  const double x[N] = {2.0, 1.0, 1.0}, v[N] = {1.0, 0.0, 3.3};
  pendres_attractors *set = NULL;
  pendres_settled outcome[N];
  pendres_settled told[N];
  (void)state;
  pendres_context *ctx = context_with(&(pendres_options){.tolerance = 1e-8});
  assert_int_equal(pendres_settle(ctx, N, p, x, v, outcome, &set), PENDRES_OK);
  assert_int_equal(pendres_lyapunov_find(ctx, N, p, x, v, NULL, told), PENDRES_OK);
  for (int k = 0; k < N; k++) {
    assert_int_equal(outcome[k].label, PENDRES_LABEL_QUASI_PERIODIC);
    assert_int_equal(told[k].label, outcome[k].label);
    const pendres_attractor *a = pendres_attractors_get(set, (size_t)outcome[k].attractor);
    check_near(a->drift, told[k].rotation, a->drift_error + told[k].rotation_error);
    assert_true(a->orbit.loop_area_error < 1e-6);
    assert_true(fabs(a->orbit.x - 0.25 * two_pi) <= 0.5 * two_pi); /* in well 0 */
    check_near(a->orbit.dissipation, a->orbit.loop_area + two_pi * p[k].torque * a->drift,
               a->orbit.dissipation_error + a->orbit.loop_area_error +
                 two_pi * p[k].torque * a->drift_error);
  }
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

/* One that is locked is a closed orbit still, and one way round is not the other. */
static void locks_and_ways(void **state)
{
  const pendres_pendulum locked = {
    .damping = 0.3, .drive_amplitude = 9.0, .drive_frequency = 3.0, .torque = 1.0};
  const pendres_pendulum back = {.damping = 0.1, .torque = -0.5, .drive_frequency = 1.0};
  pendres_attractors *set = NULL;
  pendres_context *ctx = context_with(&(pendres_options){.tolerance = 1e-8});
  size_t closed = 0, without = 0;
  (void)state;
  assert_int_equal(pendres_attractors_find(ctx, &locked, 0, NULL, NULL, &set), PENDRES_OK);
  for (size_t i = 0; i < pendres_attractors_count(set); i++) {
    const pendres_attractor *a = pendres_attractors_get(set, i);
    closed += a->orbit.winding != 0;
    without += a->label == PENDRES_LABEL_QUASI_PERIODIC;
  }
  assert_true(closed > 0);
  assert_int_equal(without, 0);
  pendres_attractors_free(set);
  assert_int_equal(pendres_attractors_find(ctx, &back, 0, NULL, NULL, &set), PENDRES_OK);
  assert_int_equal(pendres_attractors_count(set), 2);
  assert_int_equal(pendres_attractors_get(set, 1)->label, PENDRES_LABEL_RUNNING);
  assert_true(pendres_attractors_get(set, 1)->drift < 0.0);
  pendres_attractors_free(set);
  pendres_context_free(ctx);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(beside_rest), cmocka_unit_test(short_of_the_top),
    cmocka_unit_test(by_averages), cmocka_unit_test(hardly_turning),
    cmocka_unit_test(without_lock), cmocka_unit_test(members), cmocka_unit_test(resonance),
    cmocka_unit_test(slow_or_weak),
    cmocka_unit_test(locks_and_ways),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
