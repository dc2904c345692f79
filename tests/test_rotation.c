/*
 * test_rotation.c -- rotations without a drive, against an integration in time that shares nothing
 * with the library, and against what is known in limits; sweeps that come to them.
 */
#include "context_fixture.h"

#include <stdlib.h>
#include <string.h>

#include <pendres/hysteresis.h>
#include <pendres/rotation.h>

static const double pi = PENDRES_PI;

static double acceleration(double damping, double torque, double y, double v)
{
  return torque - sin(y) - damping * v;
}

/* A step of the classical Runge-Kutta method: off by 1e-14 a step of 2e-3, by 1e-12 in a turn. */
static void step(double damping, double torque, double h, double *y, double *v)
{
  double a[4], u[4];
  for (int i = 0; i < 4; i++) {
    const double c = i == 0 ? 0.0 : i == 3 ? 1.0 : 0.5;
    const double at = i == 0 ? *y : *y + c * h * u[i - 1];
    u[i] = i == 0 ? *v : *v + c * h * a[i - 1];
    a[i] = acceleration(damping, torque, at, u[i]);
  }
  *y += h / 6.0 * (u[0] + 2.0 * u[1] + 2.0 * u[2] + u[3]);
  *v += h / 6.0 * (a[0] + 2.0 * a[1] + 2.0 * a[2] + a[3]);
}

/* Whether what leaves the upper equilibrium along its unstable manifold gets over the next one. The
   slope at the start is off by the manifold's bend, 1e-6, which dies away on the way. */
static int gets_over(double damping, double torque)
{
  const double top = pi - asin(torque), away = 1e-6;
  const double slope = 0.5 * (sqrt(damping * damping + 4.0 * cos(asin(torque))) - damping);
  double y = top - 2.0 * pi + away, v = slope * away;
  while (v > 0.0 && y < top + 0.1) step(damping, torque, 2e-3, &y, &v);
  return v > 0.0;
}

/* 1e-10 below and above the least torque: the integration has that wrong by 1e-11 at most. */
static void least_torque(void **state)
{
  (void)state;
  for (int i = 1; i <= 10; i++) {
    pendres_rotation_onset o;
    check_ok(pendres_rotation_onset_find(0.1 * i, &o));
    assert_int_equal(o.end, PENDRES_ROTATION_HOMOCLINIC);
    assert_true(o.torque_error < 1e-13);
    assert_false(gets_over(0.1 * i, o.torque - 1e-10));
    assert_true(gets_over(0.1 * i, o.torque + 1e-10));
  }
}

/* Values in extended precision, by power series of both manifolds of the upper equilibrium and of
   what leads from one to the other; the last one is the worst of 420 random dampings. */
static void least_torque_to_the_last_place(void **state)
{
  static const struct {
    double damping;
    long double torque;
  } known[] = {
    {0.0018061691197629919, 0.002299684090907694685846L},
    {0.056906679195430653, 0.07239776155548746227887L},
    {0.21679630119311022, 0.2728246693051324163351L},
    {0.96106154561374935, 0.9489454241426123874974L},
    {0.6247810130010959, 0.7191397683365223973228L},
  };
  (void)state;
  for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
    pendres_rotation_onset o;
    check_ok(pendres_rotation_onset_find(known[i].damping, &o));
    assert_true(fabsl(o.torque - known[i].torque) <= o.torque_error);
    assert_true(o.torque_error < 3e-15); /* no more than some ten units of the last place of 1 */
  }
}

/* Melnikov: the work of the torque over the separatrix, 2 pi I, makes up for its friction, 8 gamma;
   the next term goes with the square of the damping, and the share of its coefficient with both. */
static void small_damping(void **state)
{
  (void)state;
  double share[3];
  for (int i = 0; i < 3; i++) {
    const double damping = 0.02 / (1 << i);
    pendres_rotation_onset o;
    check_ok(pendres_rotation_onset_find(damping, &o));
    share[i] = (1.0 - o.torque * pi / (4.0 * damping)) / (damping * damping);
    check_near(o.torque, 4.0 * damping / pi, 0.26 * damping * damping * o.torque);
  }
  /* The terms are of even order: a halved damping quarters the rest. */
  check_near(share[2] - share[1], 0.25 * (share[1] - share[0]), 2e-7);
  pendres_rotation_onset least;
  check_ok(pendres_rotation_onset_find(1e-9, &least));
  check_near(least.torque, 4e-9 / pi, least.torque_error);
}

/* At a torque of 1, from next to the equilibrium along its centre manifold, v = s^2/(2 gamma). */
static int turns_at_one(double damping)
{
  const double away = 0.01;
  double y = -1.5 * pi + away, v = away * away / (2.0 * damping);
  /* Above the damping looked for it comes to the equilibrium slowly, from y below pi/2. */
  for (int i = 0; v > 0.0 && y < 0.5 * pi + 1e-3 && i < 4000000; i++) step(damping, 1.0, 2e-3, &y,
                                                                           &v);
  return y >= 0.5 * pi;
}

/* Urabe: the damping from which on nothing rotates at a torque of 1 is 1.193. */
static void most_damping(void **state)
{
  (void)state;
  pendres_rotation_onset o;
  assert_true(turns_at_one(1.1925));
  assert_false(turns_at_one(1.1935));
  check_ok(pendres_rotation_onset_find(1.1925, &o));
  assert_true(o.end == PENDRES_ROTATION_HOMOCLINIC && o.torque < 1.0);
  check_ok(pendres_rotation_onset_find(1.1935, &o));
  assert_true(o.end == PENDRES_ROTATION_SADDLE_NODE && o.torque == 1.0);
}

/* The time of a turn by integration, the last step shortened by Newton's method. */
static double turn(double damping, double torque, double *v)
{
  const double h = 1e-3;
  double y = 0.0, time = 0.0;
  while (y + *v * h < 2.0 * pi) {
    step(damping, torque, h, &y, v);
    time += h;
  }
  for (int k = 0; k < 4; k++) {
    const double left = (2.0 * pi - y) / *v;
    step(damping, torque, left, &y, v);
    time += left;
  }
  return time;
}

/* The turn closes, takes the period, and what is added to the velocity shrinks by the
   multiplier. */
static void rotations(void **state)
{
  static const double sets[][2] = {{0.1, 0.13}, {0.1, 1.0}, {0.5, 0.6}, {1.0, 0.97}, {0.3, 1.01},
                                   {1.5, 1.2}, {0.2, 3.0}, {0.5, 1.000001}};
  (void)state;
  for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
    const pendres_pendulum p = {.damping = sets[i][0], .torque = sets[i][1],
                                .drive_frequency = 1.0};
    pendres_pendulum mirror = p;
    pendres_rotation r, back;
    check_ok(pendres_rotation_find(&p, &r, NULL));
    double v = r.v, other = r.v * (1.0 + 1e-6);
    /* Of the integration: 1e-12, which the slow passage near a connection takes hundredfold. */
    check_near(turn(p.damping, p.torque, &v), r.period, 2e-10);
    check_near(v, r.v, 1e-10);
    (void)turn(p.damping, p.torque, &other);
    check_near((other - v) / (1e-6 * r.v), r.multiplier, 1e-4);
    check_near(r.mean_velocity, 2.0 * pi / r.period, r.mean_velocity_error);
    assert_true(r.period_error < 1e-10 * r.period);
    mirror.torque = -p.torque;
    check_ok(pendres_rotation_find(&mirror, &back, NULL));
    assert_true(back.mean_velocity == -r.mean_velocity && back.period == r.period);
  }
  /* Overdamped: 2 pi / T = sqrt(I^2 - 1) / gamma, and corrections of gamma^-2. */
  const pendres_pendulum slow = {.damping = 50.0, .torque = 1.5, .drive_frequency = 1.0};
  pendres_rotation r;
  check_ok(pendres_rotation_find(&slow, &r, NULL));
  check_near(r.mean_velocity, sqrt(1.25) / 50.0, 1e-3 * r.mean_velocity);
}

/* The rotation without a drive, whose period is this one. */
static pendres_rotation found_with(double damping, double torque, double period)
{
  const pendres_pendulum p = {.damping = damping, .torque = torque, .drive_frequency = 1.0};
  pendres_rotation r;
  check_ok(pendres_rotation_find(&p, &r, NULL));
  check_near(r.period, period, r.period_error);
  return r;
}

/* Strong friction next to a torque of 1, where a turn by small steps takes seconds: beside Taylor
   series of order 40 in 30 digits. Claims are some units of the last place. */
static void strong_friction(void **state)
{
  static const struct { double damping, torque, period, v; } sets[] = {
    {1.2, 3.0, 2.5401712794634990071, 2.8199640520959619256},
    {1.3, 1.01, 48.717559734254404895, 1.1800287646076878590},
    {3.0, 1.001, 421.15507285660146246, 0.37995682113905322506},
    {5.0, 1.5, 28.080010484735955869, 0.31299278401533727204},
  };
  (void)state;
  for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
    const pendres_rotation r = found_with(sets[i].damping, sets[i].torque, sets[i].period);
    check_near(r.v, sets[i].v, r.v_error);
    assert_true(r.period_error < 1e-14 * r.period && r.v_error < 1e-14 * r.v);
  }
  /* All the way to the fold 2 pi / T = sqrt(I^2 - 1) / gamma, but for a share of damping^-2 times
     what I is above 1 by, and one of damping^-4 times that root. */
  for (int k = 4; k <= 12; k += 4) {
    const pendres_pendulum p = {.damping = 20.0, .torque = 1.0 + pow(10.0, -k),
                                .drive_frequency = 1.0};
    const double above = p.torque - 1.0;
    pendres_rotation r;
    check_ok(pendres_rotation_find(&p, &r, NULL));
    check_near(r.mean_velocity, sqrt(above * (2.0 + above)) / p.damping,
               (above + 2.0 * pow(p.damping, -4.0) * sqrt(2.0 * above) + 1e-14) *
                 r.mean_velocity);
    assert_true(r.mean_velocity_error < 1e-14 * r.mean_velocity);
  }
}

/* Next to a connection rounding of the velocity lengthens a turn: by as much as the period is known
   to. The periods are from series in long doubles, as far as those of v and of 1/v both reach.
   Where 1/v was used farther than that the last one was 8e-7 off, and claimed 2e-4. */
static void next_to_connections(void **state)
{
  static const struct { double damping, torque, period, most; } sets[] = {
    {0.0081989169277785212, 0.010439015410540589, 19.2086429835211767, 1e-4},
    {0.089859112866695928, 0.11418361594927673, 18.7873589651812303, 1e-4},
    {0.11546235276923988, 0.14652657333769994, 17.5029032000322609, 1e-4},
    {0.92556386197126206, 0.93269127117704165, 52.868838177931277048, 1e-9},
  };
  (void)state;
  for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
    const pendres_rotation r = found_with(sets[i].damping, sets[i].torque, sets[i].period);
    assert_true(r.period_error < sets[i].most * r.period);
  }
}

static void no_rotations(void **state)
{
  const pendres_pendulum weak = {.damping = 0.1, .torque = 0.127, .drive_frequency = 1.0};
  const pendres_pendulum over = {.damping = 1.2, .torque = 1.0, .drive_frequency = 1.0};
  const pendres_pendulum still = {.damping = 1.2, .drive_frequency = 1.0};
  const pendres_pendulum driven = {.damping = 0.1, .torque = 0.5, .drive_frequency = 1.0,
                                   .drive_amplitude = 0.1};
  const pendres_pendulum other = {.damping = 0.1, .drive_frequency = 1.0,
                                  .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0}};
  pendres_rotation r;
  const char *why = NULL;
  (void)state;
  assert_int_equal(pendres_rotation_find(&weak, &r, &why), PENDRES_NOT_FOUND);
  assert_non_null(strstr(why, "too small"));
  assert_int_equal(pendres_rotation_find(&over, &r, &why), PENDRES_NOT_FOUND);
  /* Where all comes to rest on its way, which was integrated without end. */
  for (int k = 0; k < 3; k++) {
    const pendres_pendulum slow = {.damping = k == 0 ? 1.2 : k == 1 ? 5.0 : 100.0, .torque = 0.2,
                                   .drive_frequency = 1.0};
    assert_int_equal(pendres_rotation_find(&slow, &r, &why), PENDRES_NOT_FOUND);
  }
  assert_int_equal(pendres_rotation_find(&still, &r, &why), PENDRES_NOT_FOUND);
  assert_int_equal(pendres_rotation_find(&driven, &r, &why), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(why, "under a drive"));
  assert_int_equal(pendres_rotation_find(&other, &r, &why), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(why, "no period"));
}

/* ---- swept ---- */

/* From the first value to the last and back; the caller frees. */
static pendres_hysteresis *sweep(pendres_context *ctx, pendres_pendulum p, pendres_parameter which,
                                 double from, double to, size_t n, double v)
{
  pendres_hysteresis *h = NULL;
  double *value = malloc(2 * n * sizeof *value);
  assert_non_null(value);
  for (size_t i = 0; i < n; i++)
    value[i] = value[2 * n - 1 - i] = from + (to - from) * (double)i / (double)(n - 1);
  p.drive_frequency = 0.7; /* which nothing depends on */
  check_ok(pendres_hysteresis_find(ctx, &p, &(pendres_state){0.5 * pi, v},
                                   &(pendres_hysteresis_path){which, 2 * n, value}, &h));
  free(value);
  return h;
}

/* The mean velocity of the rotation: of one turn, after so many that the start is forgotten. */
static double mean_velocity(double damping, double torque)
{
  double v = (torque + 1.0) / damping, time = 0.0, last = 0.0; /* faster than any rotation */
  for (double all = 0.0; all < 36.0 / damping; all += time) {
    last = time;
    time = turn(damping, torque, &v);
  }
  check_near(time, last, 1e-12 * time);
  return 2.0 * pi / time;
}

/* A junction's current up and down, either way round: it stands still up to the fold at 1, and
   rotates down to the least torque. Velocities agree with an integration in time, whose steps leave
   1e-12, which the slow passage near the connection takes tenfold. */
static void current_and_voltage(void **state)
{
  enum { N = 301 };
  pendres_rotation_onset o;
  check_ok(pendres_rotation_onset_find(0.3, &o));
  for (int way = 1; way >= -1; way -= 2) {
    const pendres_pendulum p = {.damping = 0.3};
    pendres_hysteresis *h = sweep(*state, p, PENDRES_TORQUE, 0.0, 1.5 * way, N, 0.0);
    assert_int_equal(pendres_hysteresis_jump_count(h), 2);
    const pendres_jump *up = pendres_hysteresis_jump_get(h, 0),
    *down = pendres_hysteresis_jump_get(h, 1);
    assert_true(up->kind == PENDRES_JUMP_FOLD && up->certain && up->to == PENDRES_LABEL_RUNNING);
    check_near(up->value, way, up->value_error);
    assert_true(down->kind == PENDRES_JUMP_HOMOCLINIC && down->to == PENDRES_LABEL_PERIODIC);
    check_near(down->value, way * o.torque, down->value_error);
    for (size_t i = 0; i < 2 * N; i++) {
      const pendres_hysteresis_point *point = pendres_hysteresis_get(h, i);
      const double torque = fabs(point->value), least = i < N ? 1.0 : o.torque;
      if (torque == 1.0) continue; /* where the state ends, either is right */
      assert_int_equal(point->attractor.label == PENDRES_LABEL_RUNNING, torque > least);
      assert_int_equal(point->attractor.orbit.period, torque > least ? 0 : 1);
      if (torque <= least) assert_true(point->mean_velocity == 0.0);
      if (torque <= least || i % 29 > 0) continue;
      assert_true(point->mean_velocity_error < 1e-11);
      assert_true(point->attractor.lyapunov == 0.0);
      check_near(point->mean_velocity, way * mean_velocity(0.3, torque),
                 point->mean_velocity_error + 1e-11);
    }
    pendres_hysteresis_free(h);
  }
}

/* Stronger damping stops a rotation where the least torque is the pendulum's, for good; beyond a
   damping of 1.19 the equilibria are born on the rotation, both ways. */
static void other_ends(void **state)
{
  pendres_rotation_onset o;
  const pendres_pendulum half = {.torque = 0.5}, over = {.damping = 1.5};
  pendres_hysteresis *h = sweep(*state, half, PENDRES_DAMPING, 0.1, 0.8, 71, 5.0);
  assert_int_equal(pendres_hysteresis_jump_count(h), 1);
  const pendres_jump *j = pendres_hysteresis_jump_get(h, 0);
  check_ok(pendres_rotation_onset_find(j->value, &o));
  assert_true(j->value_error < 1e-12 && j->from == PENDRES_LABEL_RUNNING);
  check_near(o.torque, 0.5, 2.0 * j->value_error);
  pendres_hysteresis_free(h);
  h = sweep(*state, over, PENDRES_TORQUE, 0.5, 1.25, 76, 0.0);
  assert_int_equal(pendres_hysteresis_jump_count(h), 2);
  for (size_t k = 0; k < 2; k++) {
    j = pendres_hysteresis_jump_get(h, k);
    assert_true(j->kind == PENDRES_JUMP_FOLD && j->certain);
    check_near(j->value, 1.0, j->value_error);
  }
  for (size_t i = 0; i < pendres_hysteresis_count(h); i++) {
    const pendres_hysteresis_point *point = pendres_hysteresis_get(h, i);
    assert_int_not_equal(point->attractor.label, PENDRES_LABEL_UNRESOLVED);
    assert_int_equal(point->mean_velocity > 0.0, point->value > 1.0);
  }
  pendres_hysteresis_free(h);
}

/* Where both are stable the start decides; as an integration for a hundred units of time says. */
static void starts(void **state)
{
  const pendres_pendulum p = {.damping = 0.3, .torque = 0.5, .drive_frequency = 0.7};
  int rotating = 0;
  for (int i = 0; i < 24; i++) {
    const double start = -6.0 + 0.5 * i;
    double y = 0.0, v = start;
    pendres_hysteresis *h = NULL;
    check_ok(pendres_hysteresis_find(*state, &p, &(pendres_state){0.5 * pi, start},
                                     &(pendres_hysteresis_path){PENDRES_TORQUE, 1, &p.torque},
                                     &h));
    for (int k = 0; k < 50000; k++) step(p.damping, p.torque, 2e-3, &y, &v);
    assert_int_equal(pendres_hysteresis_get(h, 0)->attractor.label,
                     v > 0.1 ? PENDRES_LABEL_RUNNING : PENDRES_LABEL_PERIODIC);
    rotating += v > 0.1;
    pendres_hysteresis_free(h);
  }
  assert_in_range(rotating, 4, 20);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(least_torque),
    cmocka_unit_test(least_torque_to_the_last_place), cmocka_unit_test(small_damping),
    cmocka_unit_test(most_damping),
    cmocka_unit_test(rotations),    cmocka_unit_test(strong_friction),
    cmocka_unit_test(next_to_connections),    cmocka_unit_test(no_rotations),
    cmocka_unit_test_setup_teardown(current_and_voltage, setup, teardown),
    cmocka_unit_test_setup_teardown(other_ends, setup, teardown),
    cmocka_unit_test_setup_teardown(starts, setup, teardown),
  };
  return cmocka_run_group_tests_name("rotation", tests, NULL, NULL);
}
