/*
 * test_scene_coefficients.c -- scenes in which coefficients of the force are axes, against an exact
 * change of variables: x = X/s makes x'' + g x' + x + s^2 x^3 = F cos wt the same oscillator with
 * the coefficient 1 and the drive s F. So what is known along the drive is known along a3.
 */
#include "scene_fixture.h"

/* A value of a file, with the error beside it. */
typedef struct result {
  double value, error;
} result;

static result result_of(pendres_store *store, const char *name, size_t i)
{
  char error[80];
  size_t n = 0;
  (void)snprintf(error, sizeof error, "%s_error", name);
  double *values = scene_values(store, name, &n), *errors = scene_values(store, error, &n);
  assert_true(i < n);
  const result r = {values[i], errors[i]};
  free(values), free(errors);
  return r;
}

/* A place along a3, at the drive F, is that along the drive at a3 = 1. */
static void check_scaled(result a3, result drive, double F)
{
  const double s = drive.value / F;
  check_near(a3.value, s * s, a3.error + 2.0 * s * drive.error / F);
}

#define OSCILLATOR "&pendulum damping = 0.1, drive_frequency = 1.5, force = 'polynomial', "

/* The file as the driver writes it. */
static pendres_status identified(scene_run *run)
{
  scene_write_identity(run);
  const pendres_status status = run->status;
  return status == PENDRES_OK ? scene_find(run->deck->kind)->run(run) : status;
}

/* Up and down: both folds, and the orbits at a value. */
static void hysteresis(void **state)
{
  (void)state;
  scene_run_deck_by(identified, "&scene kind = 'hysteresis' /\n"
                    OSCILLATOR "drive_amplitude = 0.3, force_coefficients = 1 /\n"
                    "&sweep a3 = 4, a3_range = 0.1, 9.1, 31 /\n&hysteresis start = '1' /\n", 1,
                    "a3");
  scene_run_deck("&scene kind = 'hysteresis' /\n" OSCILLATOR "force_coefficients = 1, 0, 1 /\n"
                 "&sweep drive_amplitude_range = 0.1, 1.0, 10 /\n&hysteresis start = '1' /\n", 1,
                 "drive");
  pendres_store *a3 = scene_open("a3"), *drive = scene_open("drive");
  size_t n = 0;
  double *value = scene_values(a3, "jump_parameter", &n);
  assert_int_equal(n, 2);
  for (size_t i = 0; i < n; i++)
    check_scaled(result_of(a3, "jump_parameter", i), result_of(drive, "jump_parameter", i), 0.3);
  free(value);
  value = scene_values(a3, "a3", &n);
  size_t at = 0;
  while (value[at] != 4.0) at++;
  for (size_t way = 0; way < 2; way++) {
    const result one = result_of(a3, "amplitude", way * n + at);
    const result other = result_of(drive, "amplitude", way * 10 + 5); /* 0.6 */
    check_near(2.0 * one.value, other.value, 2.0 * one.error + other.error);
  }
  free(value);
  /* What is held fixed is a scalar, and what is swept is not. */
  assert_true(scene_scalar(a3, "a1") == 1.0 && scene_scalar(a3, "a2") == 0.0);
  char *words = NULL;
  check_ok(pendres_store_read_attribute_text(a3, "", NULL, "coordinates", &words));
  assert_string_equal(words, "drive_amplitude damping drive_frequency a1 a2 a4 a5");
  free(words);
  pendres_store_free(a3);
  pendres_store_free(drive);
}

/* Lines along the frequency, at values of a3 or of the drive: their folds, and the curves' cusp. */
static void curves(void **state)
{
  (void)state;
#define DIAGRAM "&scene kind = 'phase_diagram' /\n&pendulum damping = 0.2, force = 'polynomial', "
#define REST "drive_frequency_range = 0.8, 2.4, 5 /\n&ensemble members = 4 /\n"
  scene_run_deck(DIAGRAM "drive_amplitude = 0.3, force_coefficients = 1 /\n"
                 "&sweep a3 = 0.25, 1, 4, " REST, 1, "a3");
  scene_run_deck(DIAGRAM "force_coefficients = 1, 0, 1 /\n"
                 "&sweep drive_amplitude = 0.15, 0.3, 0.6, " REST, 1, "drive");
  pendres_store *a3 = scene_open("a3"), *drive = scene_open("drive");
  size_t n = 0;
  double *value = scene_values(a3, "bifurcation_a3", &n);
  assert_int_equal(n, 4);
  for (size_t i = 0; i < n; i++) {
    const result one = result_of(a3, "bifurcation_frequency", i);
    const result other = result_of(drive, "bifurcation_frequency", i);
    check_near(one.value, other.value, one.error + other.error);
    assert_true(result_of(drive, "bifurcation_drive_amplitude", i).value == 0.3 * sqrt(value[i]));
  }
  free(value);
  check_scaled(result_of(a3, "cusp_a3", 0), result_of(drive, "cusp_drive_amplitude", 0), 0.3);
  const result one = result_of(a3, "cusp_frequency", 0), other = result_of(drive, "cusp_frequency",
                                                                           0);
  check_near(one.value, other.value, one.error + other.error);
  pendres_store_free(a3);
  pendres_store_free(drive);
#undef DIAGRAM
#undef REST
}

/* Branches along a3 under torques: two axes, neither of which is the damping or the drive's. */
static void two_others(void **state)
{
  (void)state;
  scene_run_deck("&scene kind = 'branches' /\n" OSCILLATOR "drive_amplitude = 0.3,\n"
                 "force_coefficients = 1 /\n&sweep torque = 0, 0.1, a3_range = 0.2, 6.2, 4 /\n"
                 "&ensemble members = 4 /\n", 1, "torques");
  scene_run_deck("&scene kind = 'response' /\n&pendulum damping = 0.2, drive_frequency = 0.7,\n"
                 "force = 'polynomial', force_coefficients = 1 /\n"
                 "&sweep drive_amplitude = 0.15, 0.3, a3 = 1, 4 /\n&ensemble members = 3 /\n", 1,
                 "plane");
  pendres_store *store = scene_open("torques");
  int rank = 0;
  uint64_t sizes[PENDRES_STORE_RANK];
  check_ok(pendres_store_shape(store, "", "mean_loop_amplitude", &rank, sizes));
  assert_true(rank == 2 && sizes[0] == 2 && sizes[1] == 4);
  size_t n = 0;
  double *torque = scene_values(store, "bifurcation_torque", &n);
  assert_true(n == 4 && torque[0] == 0.0 && torque[3] == 0.1);
  free(torque);
  pendres_store_free(store);
  store = scene_open("plane"); /* [drive_amplitude][a3] */
  const result one = result_of(store, "mean_loop_amplitude", 1);
  const result other = result_of(store, "mean_loop_amplitude", 2);
  check_near(2.0 * one.value, other.value, 2.0 * one.error + other.error);
  pendres_store_free(store);
}

/* A map over two coefficients is what the library finds at each point. */
static void map(void **state)
{
  (void)state;
  scene_run_deck("&scene kind = 'lyapunov_map' /\n&pendulum damping = 0.25, drive_frequency = 1,\n"
                 "drive_amplitude = 0.4, force = 'polynomial' /\n"
                 "&sweep a1 = -1, 0.5, a3 = 0.5, 1, 2 /\n&lyapunov_map x = 0.3, periods = 64 /\n"
                 "&precision tolerance = 1e-6 /\n", 1, "map");
  static const double a1[] = {-1.0, 0.5}, a3[] = {0.5, 1.0, 2.0};
  const pendres_lyapunov_options options = {.periods = 64};
  pendres_store *store = scene_open("map");
  pendres_context *ctx = NULL;
  size_t n = 0;
  double *exponent = scene_values(store, "lyapunov", &n);
  assert_int_equal(n, 6);
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-6}, &ctx));
  for (size_t i = 0; i < n; i++) {
    const pendres_pendulum p = {.damping = 0.25, .drive_frequency = 1.0, .drive_amplitude = 0.4,
                                .force = PENDRES_FORCE_POLYNOMIAL,
                                .force_coefficients = {a1[i / 3], 0.0, a3[i % 3]}};
    const double x = 0.3, v = 0.0;
    pendres_settled l;
    check_ok(pendres_lyapunov_find(ctx, 1, &p, &x, &v, &options, &l));
    assert_true(exponent[i] == l.exponent);
  }
  free(exponent);
  pendres_context_free(ctx);
  pendres_store_free(store);
}

/* Below the cusp of both: one peak, at the same frequency. */
static void resonances(void **state)
{
  (void)state;
#define CURVE "&scene kind = 'resonance_curve' /\n&pendulum damping = 0.2, force = 'polynomial', "
#define REST "drive_frequency_range = 0.6, 1.8 /\n&ensemble members = 4 /\n"
  scene_run_deck(CURVE "drive_amplitude = 0.05, force_coefficients = 1 /\n&sweep a3 = 1, 4, " REST,
                 1, "a3");
  scene_run_deck(CURVE "force_coefficients = 1, 0, 1 /\n&sweep drive_amplitude = 0.05, 0.1, " REST,
                 1, "drive");
  pendres_store *a3 = scene_open("a3"), *drive = scene_open("drive");
  for (size_t i = 0; i < 2; i++) {
    const double s = i == 0 ? 1.0 : 2.0;
    const result one = result_of(a3, "resonance_frequency", i);
    const result other = result_of(drive, "resonance_frequency", i);
    check_near(one.value, other.value, one.error + other.error);
    const result area = result_of(a3, "mean_loop_area", i);
    const result larger = result_of(drive, "mean_loop_area", i);
    check_near(s * s * area.value, larger.value, s * s * area.error + larger.error);
  }
  pendres_store_free(a3);
  pendres_store_free(drive);
#undef CURVE
#undef REST
}

/* A coefficient that the force has not, and a scene without such axes. */
static void refused(void **state)
{
  (void)state;
  scene_check_refused("&scene kind = 'branches' /\n&pendulum damping = 0.1,\n"
                      "drive_amplitude = 0.2, drive_frequency = 1, force = 'squid' /\n"
                      "&sweep a1 = 0.1, 0.2, a2 = 0, 1 /\n", "has no coefficient 'a2'");
  scene_check_refused("&scene kind = 'orbit' /\n&pendulum damping = 0.1, drive_amplitude = 0.2,\n"
                      "drive_frequency = 1, force = 'squid' /\n&sweep a1 = 1 /\n"
                      "&orbit x = 0 /\n", "'a1' in &sweep is not used by scene 'orbit'");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(hysteresis), cmocka_unit_test(curves),     cmocka_unit_test(two_others),
    cmocka_unit_test(map),        cmocka_unit_test(resonances), cmocka_unit_test(refused),
  };
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
