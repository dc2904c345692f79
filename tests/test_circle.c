/*
 * test_circle.c -- invariant circles of rotations: without a drive the motion on them is a rotation
 * with a period of its own, with much friction it has a closed form, and mean velocities and ends
 * of locks are those of other methods.
 */
#include <stdlib.h>

#include <pendres/hysteresis.h>
#include <pendres/lyapunov.h>
#include <pendres/rotation.h>

#include "context_fixture.h"
#include "analysis/sweeps/circles.h"
#include "rotation_fixture.h"

/* Circles over a range of torques, next to one of them; the caller frees. */
static pendres_circles *circles_of(pendres_context *ctx, const pendres_pendulum *p, double low,
                                   double high, double tolerance)
{
  const pendres_circle_family family = {
    .pendulum = *p, .parameter = PENDRES_TORQUE, .tolerance = tolerance};
  pendres_circles *c = NULL;
  check_ok(pendres_circles_create(ctx, &family, low, high, &c));
  check_ok(pendres_circles_begin(c, high, 0.0, high / p->damping));
  return c;
}

static pendres_circles_verdict verdict(pendres_circles *c, double torque)
{
  pendres_circles_verdict v;
  check_ok(pendres_circles_tell(c, torque, &v));
  assert_true(v.found);
  return v;
}

/*
 * A strobe that looks at a rotation without a drive: turns a strobe period are the strobe's period
 * over the rotation's, which pendres_rotation_find has from another equation, dv/dx.
 */
static void without_a_drive(void **state)
{
  const pendres_pendulum p = {.damping = 0.4, .drive_frequency = 1.37};
  pendres_circles *c = circles_of(*state, &p, 1.3, 2.1, 1e-9);
  for (double torque = 2.09; torque > 1.3; torque -= 0.0777) {
    pendres_pendulum q = p;
    pendres_rotation r;
    q.torque = torque;
    check_ok(pendres_rotation_find(&q, &r, NULL));
    const pendres_circles_verdict v = verdict(c, torque);
    assert_int_equal(v.turn.motion, PENDRES_CIRCLE_UNLOCKED);
    check_near(v.turn.turns, two_pi / p.drive_frequency / r.period,
               v.turn.turns_error + 2.0 * r.period_error / r.period);
    check_near(v.turn.turns_error, 0.0, 3e-9);
    check_near(v.turn.growth, 0.0, 1e-5);
  }
  pendres_circles_free(c);
}

/*
 * With much friction the mean velocity is sqrt(I^2 - 1) / gamma up to a relative gamma^-4, as in
 * test_josephson.c.
 */
static void overdamped(void **state)
{
  const pendres_pendulum p = {.damping = 20.0, .drive_amplitude = 1e-5, .drive_frequency = 0.83};
  pendres_circles *c = circles_of(*state, &p, 1.5, 3.0, 1e-9);
  for (double torque = 2.93; torque > 1.5; torque -= 0.157) {
    const pendres_circles_verdict v = verdict(c, torque);
    const double want = sqrt(torque * torque - 1.0) / p.damping / p.drive_frequency;
    assert_int_equal(v.turn.motion, PENDRES_CIRCLE_UNLOCKED);
    check_near(v.turn.turns, want,
               v.turn.turns_error + 3.0 * torque * torque * want * pow(p.damping, -4.0));
  }
  pendres_circles_free(c);
}

/* Between steps, at random torques: velocities within their errors, which are not idle. */
static void mean_velocity(void **state)
{
  enum { N = 6, PERIODS = 2000 };
  static const double torque[N] = {2.6412, 2.5107, 2.3888, 2.1813, 2.0331, 1.9571};
  pendres_circles *c = circles_of(*state, &junction, 1.93, 2.66, 1e-8);
  for (int i = 0; i < N; i++) {
    pendres_pendulum p = junction;
    p.torque = torque[i];
    const pendres_circles_verdict v = verdict(c, p.torque);
    assert_int_equal(v.turn.motion, PENDRES_CIRCLE_UNLOCKED);
    /* Richardson's extrapolation leaves a few hundredths of what the two differ by. */
    const double coarse = by_hand(&p, 160, PERIODS), fine = by_hand(&p, 320, PERIODS);
    const double want = fine + (fine - coarse) / 15.0, left = 0.05 * fabs(fine - coarse);
    check_near(v.turn.turns, want, v.turn.turns_error + left + 1e-11);
    assert_true(v.turn.turns_error < 1e-8);
  }
  pendres_circles_free(c);
}

/* Where locks of two and three periods begin and end: folds of their orbits, found by continuation,
   which knows nothing of circles. */
static void ends_of_locks(void **state)
{
  static const struct {
    double inside, outside[2];
    int period;
  } lock[] = {{2.251, {2.24, 2.26}, 2}, {2.1025, {2.09, 2.11}, 3}};
  pendres_circles *c = circles_of(*state, &junction, 2.08, 2.28, 1e-8);
  for (int i = 0; i < 2; i++) {
    const pendres_circles_verdict v = verdict(c, lock[i].inside);
    assert_int_equal(v.turn.motion, PENDRES_CIRCLE_LOCKED);
    assert_int_equal(v.turn.period, lock[i].period);
    pendres_orbit_guess guess = {.pendulum = junction, .x = v.x, .v = v.v,
                                 .period = v.turn.period, .winding = v.turn.winding};
    pendres_orbit orbit;
    pendres_status outcome;
    guess.pendulum.torque = lock[i].inside;
    check_ok(pendres_orbit_find(*state, 1, &guess, PENDRES_ORBIT_PLAIN, &orbit, &outcome));
    assert_int_equal(outcome, PENDRES_OK);
    assert_true(orbit.stable && orbit.period == v.turn.period);
    /* The guess was on the circle, as near as that is known. */
    check_near(remainder(orbit.x - v.x, two_pi), 0.0, 1e-5);
    check_near(orbit.v, v.v, 1e-5);
    pendres_fold fold;
    check_ok(pendres_fold_find(*state, &orbit, PENDRES_TORQUE, &fold));
    const double outside = lock[i].outside[fold.value > lock[i].inside];
    pendres_circles_end end;
    double distance = 0.0;
    check_ok(pendres_circles_edge(c, &v.turn, lock[i].inside, outside, &end));
    assert_true(end.found && end.error < 1e-7);
    check_near(end.value, fold.value, end.error + fold.value_error);
    check_ok(pendres_circles_distance(c, fold.value, fold.orbit.x, fold.orbit.v, &distance));
    assert_true(distance < 1e-6);
  }
  pendres_circles_free(c);
}

/* A sweep by circles and pendulums that run from where it was: the same motions, and mean
   velocities within both errors. */
static void slow_sweep(void **state)
{
  enum { N = 24 };
  pendres_hysteresis *h = NULL;
  double value[N];
  for (int i = 0; i < N; i++) value[i] = 2.2787 - 0.0091 * i;
  check_ok(pendres_hysteresis_find(*state, &junction, &(pendres_state){0.0, 7.5},
                                   &(pendres_hysteresis_path){PENDRES_TORQUE, N, value}, &h));
  pendres_pendulum p[N];
  pendres_lyapunov l[N];
  double x[N], v[N];
  for (int i = 0; i < N; i++) {
    const pendres_hysteresis_point *point = pendres_hysteresis_get(h, (size_t)i);
    p[i] = junction;
    p[i].torque = value[i];
    x[i] = point->x + 0.01;
    v[i] = point->v - 0.01;
  }
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  int locked = 0, told = 0;
  for (int i = 0; i < N; i++) {
    const pendres_hysteresis_point *point = pendres_hysteresis_get(h, (size_t)i);
    if (l[i].label == PENDRES_LABEL_UNRESOLVED) continue;
    told++;
    assert_int_equal(point->attractor.label, l[i].label);
    assert_int_equal(point->attractor.orbit.period, l[i].period);
    check_near(point->mean_velocity, junction.drive_frequency * l[i].rotation,
               point->mean_velocity_error + junction.drive_frequency * l[i].rotation_error);
    locked += l[i].label == PENDRES_LABEL_RUNNING;
  }
  /* Of two steps that the sweep goes over, one has values on it: it begins and ends once. */
  assert_true(told > N / 2 && locked > 0 && locked < 4);
  assert_true(pendres_hysteresis_jump_count(h) > 0);
  pendres_hysteresis_free(h);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(without_a_drive, setup, teardown),
    cmocka_unit_test_setup_teardown(overdamped, setup, teardown),
    cmocka_unit_test_setup_teardown(mean_velocity, setup, teardown),
    cmocka_unit_test_setup_teardown(ends_of_locks, setup, teardown),
    cmocka_unit_test_setup_teardown(slow_sweep, setup, teardown),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
