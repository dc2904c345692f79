/*
 * test_scene_escape.c -- least actions in files: one point with all ways and its path, and a sweep
 * whose last point has no such state.
 */
#include "scene_fixture.h"

#include "results/failed.h"

static double *values_of(const char *file, const char *name, size_t *n)
{
  pendres_store *store = scene_open(file);
  double *v = scene_values(store, name, n);
  pendres_store_free(store);
  return v;
}

/* The plain pendulum's SA and LA, see docs/noise.md; the path leads from one orbit to the other. */
static void one_point(void **state)
{
  static const char text[] =
    "&scene kind = 'escape' / &pendulum damping = 0.13, drive_amplitude = 0.2, drive_period = 7.6 /"
    "&escape from = 'sa' /";
  size_t n, m;
  (void)state;
  assert_int_equal(scene_run_marked(NULL, text, 1, "point"), 0);
  double *action = values_of("point", "action", &n), *to = values_of("point", "escape_to", &m);
  assert_true(n == 1 && m == 1);
  check_near(action[0], 0.0685246389157, 1e-11);
  check_near(to[0], 2.0, 0.0);
  double *noise = values_of("point", "path_noise", &n);
  double *q = values_of("point", "path_momentum", &m);
  double sum = 0.0;
  assert_true(n == m && n > 100);
  for (size_t k = 0; k < n; k++) {
    check_near(noise[k], 0.26 * q[k], 1e-15);
    sum += 0.13 * q[k] * q[k];
  }
  /* S is the integral of damping q^2; both ends are zero, so that a sum has all its digits. */
  double *phase = values_of("point", "path_phase", &m);
  check_relative(sum * (phase[1] - phase[0]) * 7.6 / (2.0 * 3.14159265358979323846), action[0],
                 1e-7);
  free(phase);
  double *x = values_of("point", "path_x", &n), *saddle = values_of("point", "saddle_x", &m);
  check_near(x[n - 1], saddle[0], 1e-3);
  free(action);
  free(to);
  free(noise);
  free(q);
  free(x);
  free(saddle);
}

/* Without a drive the action is the barrier, 2 sqrt(1 - I^2) - I (pi - 2 asin I); beyond the last
   well there is no state, and the point says so. */
static void a_sweep(void **state)
{
  static const char text[] =
    "&scene kind = 'escape' / &pendulum damping = 0.5, drive_amplitude = 0, drive_frequency = 1 /"
    "&sweep torque = 0.5, 0.8, 1.2 / &escape x = 2.5 /";
  static const double torque[2] = {0.5, 0.8};
  size_t n, m;
  (void)state;
  assert_int_equal(scene_run_marked(NULL, text, 2, "sweep"), 1);
  double *action = values_of("sweep", "action", &n), *failed = values_of("sweep", "failed", &m);
  assert_true(n == 3 && m == 3);
  for (int k = 0; k < 2; k++) {
    const double i = torque[k], pi = 3.14159265358979323846;
    check_relative(action[k], 2.0 * sqrt(1.0 - i * i) - i * (pi - 2.0 * asin(i)), 1e-11);
    assert_int_equal((int)failed[k], SCENE_FAILURE_NONE);
  }
  assert_true(isnan(action[2]));
  assert_int_equal((int)failed[2], SCENE_FAILURE_REFUSED);
  assert_non_null(strstr(scene_told, "no closed orbits"));
  free(action);
  free(failed);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(one_point), cmocka_unit_test(a_sweep)};
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
