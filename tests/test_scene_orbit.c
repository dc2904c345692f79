/*
 * test_scene_orbit.c -- the scene `orbit`, run in this process: records in parts, what is measured
 * of them, and escapes.
 */
#include "scene_fixture.h"

#include <string.h>

#include <pendres/pendres.h>

#define PENDULUM "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8 /\n"

/* A record of several tasks is what the library records in one go, bit by bit. */
static void parts(void **state)
{
  enum { PERIODS = 5, SAMPLES = 30000, N = PERIODS * SAMPLES };
  static const char text[] =
    "&scene kind = 'orbit' /\n" PENDULUM
    "&orbit x = -1.0, v = 0.4, transient = .true., periods = 5, samples = 30000 /\n";
  static const char *const names[] = {"x", "v", "x_error", "v_error"};
  pendres_context *ctx = NULL;
  const pendres_pendulum p = {
    .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 6.28318530717958647693 / 8.0};
  double *want = malloc(4 * (N + 1) * sizeof *want);
  (void)state;
  assert_non_null(want);
  scene_run_deck(text, 1, "one");
  scene_run_deck(text, 2, "two");
  scene_check_same_bytes("one", "two");
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-8}, &ctx));
  check_ok(pendres_strobe_record(
    ctx, &p, &(pendres_state){-1.0, 0.4}, PERIODS, SAMPLES,
    &(pendres_record){want, want + (N + 1), want + 2 * (N + 1), want + 3 * (N + 1)}));
  pendres_store *store = scene_open("one");
  for (int i = 0; i < 4; i++) {
    size_t n = 0;
    double *got = scene_values(store, names[i], &n);
    assert_int_equal(n, N);
    assert_memory_equal(got, want + i * (N + 1), N * sizeof *got);
    free(got);
  }
  size_t n = 0;
  double *phase = scene_values(store, "drive_phase", &n);
  check_relative(phase[N - 1], 2.0 * 3.14159265358979323846 * (N - 1.0) / SAMPLES, 1e-15);
  free(phase);
  pendres_store_free(store);
  pendres_context_free(ctx);
  free(want);
}

/* The spectrum of a closed orbit holds the mean square of its velocity, which friction knows: its
   loss a drive cycle is damping times mean square times the drive's period. Lines are sharp. */
static void spectrum(void **state)
{
  size_t n = 0;
  (void)state;
  scene_run_deck("&scene kind = 'orbit' /\n" PENDULUM
                 "&orbit start = 'la', periods = 64, samples = 32, dimension = .true.,\n"
                 "  spectrum = .true., segment = 8 /\n", 1, "lines");
  pendres_store *store = scene_open("lines");
  double *omega = scene_values(store, "frequency", &n);
  assert_int_equal(n, 8 * 32 / 2 + 1);
  double *power = scene_values(store, "power_spectrum", &n);
  double *error = scene_values(store, "power_spectrum_error", &n);
  const double drive = 6.28318530717958647693 / 8.0;
  double sum = 0.0, wanted = scene_scalar(store, "dissipation") / (0.12 * 8.0);
  check_relative(omega[8], drive, 1e-14);
  for (size_t k = 0; k < n; k++) {
    sum += power[k] * omega[1];
    /* A line and its two neighbours at each multiple of the drive's frequency. */
    if (k % 8 > 1 && k % 8 < 7) assert_true(power[k] <= error[k] + 1e-20);
  }
  check_relative(sum, wanted, 1e-8);
  assert_true(power[8] > 0.5 * wanted / omega[1]);
  assert_true(scene_scalar(store, "correlation_dimension") == 0.0);
  assert_true(scene_scalar(store, "lyapunov_dimension") == 0.0);
  assert_true(!pendres_store_has(store, "", "correlation_sum"));
  free(omega);
  free(power);
  free(error);
  pendres_store_free(store);
  /* Nobody has asked for them. */
  scene_run_deck("&scene kind = 'orbit' /\n" PENDULUM "&orbit start = 'la' /\n", 1, "plain");
  store = scene_open("plain");
  assert_true(!pendres_store_has(store, "", "power_spectrum") &&
              !pendres_store_has(store, "", "lyapunov_dimension"));
  pendres_store_free(store);
}

/*
 * Chaos named by its number is what is recorded, though a pendulum at rest would end on the orbit
 * of period 3 beside it. Both exponents add up to -damping, so Kaplan and Yorke's dimension is
 * 1 + L / (L + damping). The correlation dimension is no larger than that, and is within its error
 * of that of a record 75 times as long, 1.053.
 */
static void chaos_by_number(void **state)
{
  size_t n = 0;
  double farthest = 0.0;
  (void)state;
  scene_run_deck("&scene kind = 'orbit' /\n"
                 "&pendulum damping = 0.4185, drive_amplitude = 0.9934,\n"
                 "  drive_frequency = 0.6827 /\n"
                 "&orbit start = '2', periods = 400, samples = 1, dimension = .true. /\n"
                 "&precision tolerance = 1e-4 /\n", 1, "chaos");
  pendres_store *store = scene_open("chaos");
  double *x = scene_values(store, "x", &n);
  assert_int_equal(n, 400);
  for (size_t k = 3; k < n; k++) farthest = fmax(farthest, fabs(sin(0.5 * (x[k] - x[k - 3]))));
  assert_true(farthest > 0.5);
  const double growth = scene_scalar(store, "lyapunov_exponent");
  const double lyapunov = scene_scalar(store, "lyapunov_dimension");
  const double correlation = scene_scalar(store, "correlation_dimension");
  const double error = scene_scalar(store, "correlation_dimension_error");
  assert_true(growth > 0.0);
  check_relative(lyapunov, 1.0 + growth / (growth + 0.4185), 1e-12);
  check_near(correlation, 1.053, error);
  assert_true(correlation < lyapunov + error && error < 0.3);
  free(x);
  pendres_store_free(store);
}

/* x'' = 0.1 cos(0.85 t) - 0.1 x' - x + x^2 by the classical method of order 4, whose 4000 steps a
   drive period leave some 1e-12. */
static void helmholtz_period(double s[2])
{
  enum { STEPS = 4000 };
  const double omega = 0.85, h = 6.28318530717958647693 / omega / STEPS;
  for (int k = 0; k < STEPS; k++) {
    double d[4][2] = {{0.0}}, sum[2] = {0.0};
    for (int i = 0; i < 4; i++) {
      const double part = i == 0 ? 0.0 : i == 3 ? 1.0 : 0.5, weight = i % 3 == 0 ? 1.0 : 2.0;
      const double *before = d[i > 0 ? i - 1 : 0];
      const double x = s[0] + part * h * before[0], v = s[1] + part * h * before[1];
      d[i][0] = v;
      d[i][1] = 0.1 * cos(omega * h * (k + part)) - 0.1 * v - x + x * x;
      for (int j = 0; j < 2; j++) sum[j] += weight * d[i][j];
    }
    for (int j = 0; j < 2; j++) s[j] += h / 6.0 * sum[j];
  }
}

/* A trajectory to infinity is an answer, and not a failure: its label says so, and the record goes
   as far as there is something to record; in parts, too. Without a transient there is nothing. */
static void escape(void **state)
{
  enum { PERIODS = 8, STAYS = 3 };
  size_t n = 0;
  double s[2] = {0.0, 0.0};
  (void)state;
  for (int samples = 4; samples <= 40000; samples += 39996) {
    char text[400];
    snprintf(text, sizeof text, "&scene kind = 'orbit' /\n&pendulum force = 'polynomial',\n"
             "  force_coefficients = 1, -1, damping = 0.1, drive_amplitude = 0.1,\n"
             "  drive_frequency = 0.85 /\n"
             "&orbit x = 0, v = 0, samples = %d, periods = %d, transient = .true. /\n", samples,
             PERIODS);
    scene_run_deck(text, 1, "escape");
    pendres_store *store = scene_open("escape");
    double *x = scene_values(store, "x", &n), *error = scene_values(store, "x_error", &n);
    assert_int_equal(n, PERIODS * samples);
    assert_true(scene_scalar(store, "label") == (double)PENDRES_LABEL_ESCAPE);
    assert_true(isnan(scene_scalar(store, "loop_area")));
    s[0] = s[1] = 0.0;
    for (int k = 0; k <= STAYS; k++, helmholtz_period(s))
      check_near(x[k * samples], s[0], error[k * samples] + 1e-11);
    for (size_t k = 0; k < n; k++)
      assert_int_equal(isnan(x[k]) != 0 && isnan(error[k]) != 0, k > (size_t)(STAYS * samples));
    free(x);
    free(error);
    pendres_store_free(store);
  }
  scene_run_deck("&scene kind = 'orbit' /\n&pendulum force = 'polynomial',\n"
                 "  force_coefficients = 1, -1, damping = 0.1, drive_amplitude = 0.1,\n"
                 "  drive_frequency = 0.85 /\n&orbit x = 0, v = 0, samples = 4 /\n", 1, "gone");
  pendres_store *store = scene_open("gone");
  double *x = scene_values(store, "x", &n);
  for (size_t k = 0; k < n; k++) assert_true(isnan(x[k]));
  free(x);
  pendres_store_free(store);
}

/* An attribute of a variable is a text, and a word is in it or not. */
static void check_text(pendres_store *store, const char *name, const char *attribute,
                       const char *text, const char *never)
{
  char *got = NULL;
  check_ok(pendres_store_read_attribute_text(store, "", name, attribute, &got));
  if (text != NULL) assert_string_equal(got, text);
  if (never != NULL) assert_null(strstr(got, never));
  free(got);
}

/* The scene, and what every file has beside it. */
static pendres_status run_whole(scene_run *run)
{
  (void)scene_find(run->deck->kind)->run(run);
  scene_write_identity(run);
  return run->status;
}

/* An oscillator's coordinate is no angle: only phases are in rad, and no word tells of an angle or
   of a pendulum's units. A junction's in a ring is one. */
static void units_of_the_coordinate(void **state)
{
  static const struct {
    const char *name, *oscillator, *ring;
  } units[] = {{"x", "1", "rad"}, {"x_error", "1", "rad"}, {"amplitude", "1", "rad"},
               {"phase_lag", "rad", "rad"}, {"drive_phase", "rad", "rad"}};
  (void)state;
  for (int ring = 0; ring < 2; ring++) {
    char text[300];
    snprintf(text, sizeof text, "&scene kind = 'orbit' /\n&pendulum drive_amplitude = 0.2, damping "
             "= 0.4, drive_frequency = 1,\n  force = '%s', force_coefficients = 1 /\n"
             "&orbit x = 0.1, periods = 1, samples = 4 /\n", ring ? "squid" : "polynomial");
    scene_run_deck_by(run_whole, text, 1, "units");
    pendres_store *store = scene_open("units");
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
      check_text(store, units[i].name, "units", ring ? units[i].ring : units[i].oscillator, NULL);
    check_text(store, "amplitude", "long_name", ring ? NULL : "half peak to peak of x", NULL);
    check_text(store, "loop_area", "comment", NULL, ring ? NULL : "m g l");
    pendres_store_free(store);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(parts), cmocka_unit_test(spectrum),
                                     cmocka_unit_test(chaos_by_number), cmocka_unit_test(escape),
                                     cmocka_unit_test(units_of_the_coordinate)};
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
