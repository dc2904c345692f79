/*
 * test_josephson.c -- rotations under a torque and a drive: Shapiro steps, on which the mean
 * velocity is a rational multiple of the drive's frequency, and what lies between them.
 *
 * Ends of steps are compared with folds that are sought from elsewhere, mean velocities off the
 * steps with an integration that is written here, and with what is known of an overdamped junction.
 */
#include <stdlib.h>
#include <string.h>

#include <pendres/hysteresis.h>
#include <pendres/lyapunov.h>

#include "context_fixture.h"
#include "rotation_fixture.h"

/* Up and down; the caller frees. */
static pendres_hysteresis *sweep_from(pendres_context *ctx, double v, double low, double high,
                                      size_t n)
{
  enum { MOST = 32 };
  pendres_hysteresis *h = NULL;
  double value[2 * MOST];
  assert_true(n <= MOST);
  for (size_t i = 0; i < n; i++)
    value[i] = value[2 * n - 1 - i] = low + (high - low) * (double)i / (double)(n - 1);
  check_ok(pendres_hysteresis_find(ctx, &junction, &(pendres_state){1.6, v},
                                   &(pendres_hysteresis_path){PENDRES_TORQUE, 2 * n, value}, &h));
  return h;
}

static pendres_hysteresis *sweep(pendres_context *ctx, double low, double high, size_t n)
{
  return sweep_from(ctx, 0.0, low, high, n);
}

/* Over the end of the second step, both ways: up there is a jump, from a fold to a rotation that is
   not locked; down the rotation ends elsewhere. */
static void step_and_rotation(void **state)
{
  pendres_hysteresis *h = sweep(*state, 1.88, 1.95, 15);
  int steps = 0, rotations = 0;
  for (size_t i = 0; i < pendres_hysteresis_count(h); i++) {
    const pendres_hysteresis_point *p = pendres_hysteresis_get(h, i);
    if (p->attractor.label == PENDRES_LABEL_RUNNING) {
      const pendres_orbit *o = &p->attractor.orbit;
      steps++;
      assert_true(o->stable);
      check_near(p->mean_velocity * o->period, junction.drive_frequency * o->winding,
                 p->mean_velocity_error * o->period);
      assert_true(p->mean_velocity_error < 1e-14);
    } else if (p->attractor.label == PENDRES_LABEL_QUASI_PERIODIC) {
      rotations++;
      assert_int_equal(p->attractor.orbit.period, 0);
      assert_true(p->mean_velocity_error > 0.0 && p->mean_velocity_error < 1e-5);
      assert_true(p->attractor.lyapunov == 0.0 && p->attractor.lyapunov_error < 1e-5);
    }
  }
  assert_true(steps >= 10 && rotations >= 10);
  const pendres_jump *j = pendres_hysteresis_jump_get(h, 0);
  pendres_fold fold;
  assert_non_null(j);
  assert_true(j->direction == 1 && j->kind == PENDRES_JUMP_FOLD && j->certain && !j->gradual);
  assert_int_equal(j->from, PENDRES_LABEL_RUNNING);
  assert_int_equal(j->to, PENDRES_LABEL_QUASI_PERIODIC);
  assert_int_equal(j->to_period, 0);
  /* Sought from the step's orbit at the first value, with another predictor and another way. */
  check_ok(pendres_fold_find(*state, &pendres_hysteresis_get(h, 0)->attractor.orbit,
                                   PENDRES_TORQUE, &fold));
  check_near(j->value, fold.value, j->value_error + fold.value_error);
  assert_true(j->value_error < 1e-8);
  pendres_hysteresis_free(h);
}

/* A value just beyond the end of a lock, where the rotation slips once in so many periods that only
   long averages tell it: it is known what it is, as it is farther away. */
static void just_beyond_a_step(void **state)
{
  pendres_hysteresis *h = sweep(*state, 2.7, 2.73, 4);
  const pendres_jump *up = pendres_hysteresis_jump_get(h, 0);
  for (size_t i = 2; i < 6; i++)
    assert_int_equal(pendres_hysteresis_get(h, i)->attractor.label, PENDRES_LABEL_QUASI_PERIODIC);
  assert_int_equal(pendres_hysteresis_jump_count(h), 2);
  assert_int_equal(up->kind, PENDRES_JUMP_FOLD);
  assert_int_equal(up->to, PENDRES_LABEL_QUASI_PERIODIC);
  pendres_hysteresis_free(h);
}

/* Down again a rotation locks for a moment. Where that lock ends in a fold it is lost for the next
   step, and not for chaos, which less exact averages take the slow motion beyond the fold for. */
static void short_lock(void **state)
{
  pendres_hysteresis *h = sweep(*state, 1.90, 1.92, 3);
  assert_true(pendres_hysteresis_jump_count(h) > 0);
  for (size_t i = 0; i < pendres_hysteresis_jump_count(h); i++)
    assert_int_not_equal(pendres_hysteresis_jump_get(h, i)->to, PENDRES_LABEL_CHAOTIC);
  pendres_hysteresis_free(h);
}

/* The end of a step that is next to an orbit on it. */
static void check_end(pendres_context *ctx, const pendres_hysteresis *h, size_t i, double value,
                      double error)
{
  const pendres_orbit *o = &pendres_hysteresis_get(h, i)->attractor.orbit;
  pendres_fold fold;
  check_ok(pendres_fold_find(ctx, o, PENDRES_TORQUE, &fold));
  check_near(value, fold.value, error + fold.value_error);
}

/* One of the steps that the path has met; NULL: none. */
static const pendres_step *step_of(const pendres_hysteresis *h, int winding, int period)
{
  for (size_t i = 0; i < pendres_hysteresis_step_count(h); i++) {
    const pendres_step *s = pendres_hysteresis_step_get(h, i);
    if (s->winding == winding && s->period == period) return s;
  }
  return NULL;
}

/* Over a step of 3/2 both ways: both of its ends are folds, sought from the orbits next to them;
   steps below and above it go beyond the range, or are come to and not left. */
static void steps_and_their_ends(void **state)
{
  enum { N = 16 };
  pendres_hysteresis *h = sweep_from(*state, 3.0, 1.24, 1.39, N);
  size_t first = 2 * N, last = 0; /* on the step, on the way down and on the way up */
  for (size_t i = 0; i < N; i++) {
    const pendres_orbit *up = &pendres_hysteresis_get(h, i)->attractor.orbit;
    const pendres_orbit *down = &pendres_hysteresis_get(h, 2 * N - 1 - i)->attractor.orbit;
    if (up->period == 2 && up->winding == 3) last = i;
    if (down->period == 2 && down->winding == 3 && first == 2 * N) first = 2 * N - 1 - i;
  }
  const pendres_step *s = step_of(h, 3, 2), *below = step_of(h, 1, 1);
  assert_true(first < 2 * N && last > 0 && s != NULL && below != NULL);
  assert_int_equal(s->lower_end, PENDRES_STEP_END_LEFT);
  assert_int_equal(s->upper_end, PENDRES_STEP_END_LEFT);
  check_end(*state, h, first, s->lower, s->lower_error);
  check_end(*state, h, last, s->upper, s->upper_error);
  check_near(s->width, s->upper - s->lower, 0.0);
  check_near(s->width_error, s->upper_error + s->lower_error, 0.0);
  assert_true(s->width > 0.04 && s->width_error < 1e-8);
  /* The first step is left on the way up only. */
  assert_int_equal(below->lower_end, PENDRES_STEP_END_RANGE);
  assert_int_equal(below->upper_end, PENDRES_STEP_END_LEFT);
  assert_true(below->lower == 1.24 && below->lower_error == 0.0 && isnan(below->width));
  /* Jumps tell what they lead to: its mean velocity is that of the step. */
  for (size_t i = 0; i < pendres_hysteresis_jump_count(h); i++) {
    const pendres_jump *j = pendres_hysteresis_jump_get(h, i);
    if (j->to_period > 0) assert_true(j->to_winding > 0);
    else assert_int_equal(j->to_winding, 0);
  }
  pendres_hysteresis_free(h);
}

/* Up to a lock and back: it is born and ends in one fold, which is sought from its orbit. */
static void lock_is_born(void **state)
{
  static const double value[] = {1.46, 1.47, 1.48, 1.49, 1.495, 1.502, 1.495, 1.49};
  enum { N = sizeof value / sizeof *value };
  pendres_hysteresis *h = NULL;
  pendres_fold fold;
  check_ok(pendres_hysteresis_find(*state, &junction, &(pendres_state){1.6, 8.0},
                                   &(pendres_hysteresis_path){PENDRES_TORQUE, N, value}, &h));
  const pendres_orbit *lock = &pendres_hysteresis_get(h, 5)->attractor.orbit;
  assert_int_equal(lock->period, 3);
  /* The path turns on it: where it ends above is not seen. */
  const pendres_step *s = step_of(h, lock->winding, 3);
  assert_true(s != NULL && s->lower_end == PENDRES_STEP_END_LEFT && isnan(s->width));
  assert_true(s->upper == 1.502 && s->upper_end == PENDRES_STEP_END_RANGE);
  check_ok(pendres_fold_find(*state, lock, PENDRES_TORQUE, &fold));
  assert_int_equal(pendres_hysteresis_jump_count(h), 2);
  for (size_t i = 0; i < 2; i++) {
    const pendres_jump *j = pendres_hysteresis_jump_get(h, i);
    assert_int_equal(j->kind, PENDRES_JUMP_FOLD);
    assert_int_equal(j->from, i == 0 ? PENDRES_LABEL_QUASI_PERIODIC : PENDRES_LABEL_RUNNING);
    check_near(j->value, fold.value, j->value_error + fold.value_error);
  }
  pendres_hysteresis_free(h);
}

/* Between steps the mean velocity is that of an independent integration, within its error. */
static void mean_velocity(void **state)
{
  static const pendres_pendulum p[] = {
    {.damping = 0.5, .drive_amplitude = 0.8, .drive_frequency = 0.9, .torque = 1.2},
    {.damping = 0.5, .drive_amplitude = 0.8, .drive_frequency = 0.9, .torque = -1.6},
    {.damping = 0.3, .drive_amplitude = 9.0, .drive_frequency = 3.0, .torque = 2.4},
    {.damping = 0.4, .parametric_amplitude = 0.6, .drive_frequency = 1.3, .torque = 1.7},
  };
  enum { N = sizeof p / sizeof *p };
  const double x[N] = {1.6, 1.6, 1.6, 1.6}, v[N] = {3.0, -3.0, 8.0, 4.0};
  pendres_settled l[N];
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) {
    assert_int_equal(l[i].label, PENDRES_LABEL_QUASI_PERIODIC);
    assert_true(l[i].period == 0 && l[i].winding == 0 && l[i].exponent == 0.0);
    /* Richardson's extrapolation leaves a few hundredths of what the two differ by. */
    const double coarse = by_hand(&p[i], 240, 6000), fine = by_hand(&p[i], 480, 6000);
    const double want = fine + (fine - coarse) / 15.0;
    check_near(l[i].rotation, want, l[i].rotation_error + 0.05 * fabs(fine - coarse));
    assert_true(l[i].rotation_error < 3e-8);
    assert_true(l[i].rotation_error < 1e-8);
  }
}

/* A sweep, in which many values are averaged side by side and once for both ways, and pendulums
   that run by themselves from where it was: the same motions, and mean velocities within both
   errors. */
static void slow_sweep(void **state)
{
  enum { N = 24 };
  pendres_hysteresis *h = NULL;
  double value[2 * N], x[N], v[N];
  pendres_pendulum p[N];
  pendres_settled l[N];
  int locked = 0, told = 0;
  for (int i = 0; i < N; i++) value[i] = value[2 * N - 1 - i] = 2.2787 - 0.0091 * i;
  check_ok(pendres_hysteresis_find(*state, &junction, &(pendres_state){0.0, 7.5},
                                     &(pendres_hysteresis_path){PENDRES_TORQUE, 2 * N, value}, &h));
  for (int i = 0; i < N; i++) {
    const pendres_hysteresis_point *point = pendres_hysteresis_get(h, (size_t)i);
    p[i] = junction;
    p[i].torque = value[i];
    x[i] = point->x + 0.01;
    v[i] = point->v - 0.01;
  }
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) {
    const pendres_hysteresis_point *point = pendres_hysteresis_get(h, (size_t)i);
    const pendres_hysteresis_point *back = pendres_hysteresis_get(h, (size_t)(2 * N - 1 - i));
    assert_int_equal(point->attractor.label, back->attractor.label);
    check_near(point->mean_velocity, back->mean_velocity,
               point->mean_velocity_error + back->mean_velocity_error);
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

/* Mean turns that are known from elsewhere: Richardson's extrapolation of Runge and Kutta's method
   with 400 and 800 steps, over 2000 and 5000 periods. The third rotation slips once in hundreds of
   periods. */
static void known_means(void **state)
{
  enum { N = 3 };
  static const double torque[N] = {1.75, 2.5, 1.5};
  static const double want[N] = {1.741226778736, 2.496573071814, 1.47369906};
  static const double off[N] = {1e-12, 1e-12, 1e-7};
  pendres_pendulum p[N];
  double x[N], v[N];
  pendres_settled l[N];
  for (int i = 0; i < N; i++) {
    p[i] = (pendres_pendulum){.damping = 0.5, .drive_amplitude = 3.0, .drive_frequency = 2.0,
                              .torque = torque[i]};
    x[i] = 1.6;
    v[i] = 3.0;
  }
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) {
    if (i == 2 && l[i].label == PENDRES_LABEL_UNRESOLVED) continue; /* or known with its error */
    assert_int_equal(l[i].label, PENDRES_LABEL_QUASI_PERIODIC);
    check_near(l[i].rotation, want[i], l[i].rotation_error + off[i]);
    assert_true(l[i].rotation_error < (i < 2 ? 3e-8 : 1e-6));
  }
}

/*
 * Just beyond the end of a lock a rotation is p/q turns a period for long, and then slips, the
 * more seldom by the root of the distance. What is not seen to slip is not claimed: at a distance
 * of 1e-4 slips make 2.6e-3 turns a period.
 */
static void slips(void **state)
{
  const double value[2] = {1.37, 1.39};
  pendres_hysteresis *h = NULL;
  check_ok(pendres_hysteresis_find(*state, &junction, &(pendres_state){1.6, 8.0},
                                   &(pendres_hysteresis_path){PENDRES_TORQUE, 2, value}, &h));
  const pendres_jump *j = pendres_hysteresis_jump_get(h, 0);
  assert_non_null(j);
  assert_int_equal(j->kind, PENDRES_JUMP_FOLD);
  const pendres_orbit *o = &pendres_hysteresis_get(h, 0)->attractor.orbit;
  pendres_fold fold;
  check_ok(pendres_fold_find(*state, o, PENDRES_TORQUE, &fold));
  enum { N = 12 };
  pendres_pendulum p[N];
  double x[N], v[N], distance[N];
  pendres_settled l[N];
  int told = 0;
  for (int i = 0; i < N; i++) {
    distance[i] = pow(10.0, -4.0 - 2.0 * (i / 3));
    p[i] = junction;
    p[i].torque = fold.value + distance[i];
    x[i] = fold.orbit.x + 1e-4 * (i % 3 - 1);
    v[i] = fold.orbit.v;
  }
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) {
    const double slip = 2.6e-3 * sqrt(distance[i] / 1e-4);
    assert_true(l[i].label == PENDRES_LABEL_QUASI_PERIODIC ||
                l[i].label == PENDRES_LABEL_UNRESOLVED);
    if (l[i].label != PENDRES_LABEL_QUASI_PERIODIC) continue;
    check_near(l[i].rotation - (double)o->winding / o->period, slip,
               l[i].rotation_error + 0.02 * slip);
    told++;
  }
  assert_true(told >= 3);
  pendres_hysteresis_free(h);
}

/*
 * With much friction y' = (I - sin y)(1 + cos y / gamma^2) / gamma up to a relative gamma^-4, and
 * so the mean velocity is sqrt(I^2 - 1) / gamma up to that: the cosine's mean over 1/(I - sin y) is
 * zero. A drive of 1e-5 changes it by its square.
 */
static void overdamped(void **state)
{
  enum { N = 3 };
  static const double torque[N] = {1.2, 1.7, 4.3};
  for (int k = 0; k < 2; k++) {
    const double gamma = k == 0 ? 10.0 : 20.0;
    pendres_pendulum p[N];
    const double x[N] = {0.0}, v[N] = {0.0};
    pendres_settled l[N];
    for (int i = 0; i < N; i++)
      p[i] = (pendres_pendulum){.damping = gamma, .drive_amplitude = 1e-5, .drive_frequency = 0.83,
                                .torque = torque[i]};
    check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
    for (int i = 0; i < N; i++) {
      const double want = sqrt(torque[i] * torque[i] - 1.0) / gamma / p[i].drive_frequency;
      assert_int_equal(l[i].label, PENDRES_LABEL_QUASI_PERIODIC);
      check_near(l[i].rotation, want,
                 l[i].rotation_error + 3.0 * torque[i] * torque[i] * want * pow(gamma, -4.0));
    }
  }
}

/* What is not such a rotation is not called so: a lock, chaos with a torque, and all that a mirror
   symmetry keeps from rotating. */
static void others(void **state)
{
  static const struct {
    pendres_pendulum p;
    pendres_label label;
  } known[] = {
    {{.damping = 0.3, .drive_amplitude = 9.0, .drive_frequency = 3.0, .torque = 1.8},
     PENDRES_LABEL_RUNNING},
    {{.damping = 0.5, .drive_amplitude = 0.8, .drive_frequency = 0.9, .torque = 0.8},
     PENDRES_LABEL_CHAOTIC},
    {{.damping = 0.5, .drive_amplitude = 1.15, .drive_frequency = 2.0 / 3.0},
     PENDRES_LABEL_CHAOTIC},
    {{.damping = 0.1, .parametric_amplitude = 0.1, .drive_frequency = 2.0},
     PENDRES_LABEL_PERIODIC},
  };
  enum { N = sizeof known / sizeof *known };
  pendres_pendulum p[N];
  const double x[N] = {1.6, 1.6, 1.8, 1.6}, v[N] = {6.0, 0.0, 0.1, 0.0};
  pendres_settled l[N];
  for (int i = 0; i < N; i++) p[i] = known[i].p;
  check_ok(pendres_lyapunov_find(*state, N, p, x, v, NULL, l));
  for (int i = 0; i < N; i++) assert_int_equal(l[i].label, known[i].label);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(step_and_rotation, setup, teardown),
    cmocka_unit_test_setup_teardown(just_beyond_a_step, setup, teardown),
    cmocka_unit_test_setup_teardown(short_lock, setup, teardown),
    cmocka_unit_test_setup_teardown(steps_and_their_ends, setup, teardown),
    cmocka_unit_test_setup_teardown(lock_is_born, setup, teardown),
    cmocka_unit_test_setup_teardown(mean_velocity, setup, teardown),
    cmocka_unit_test_setup_teardown(slow_sweep, setup, teardown),
    cmocka_unit_test_setup_teardown(known_means, setup, teardown),
    cmocka_unit_test_setup_teardown(slips, setup, teardown),
    cmocka_unit_test_setup_teardown(overdamped, setup, teardown),
    cmocka_unit_test_setup_teardown(others, setup, teardown),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
