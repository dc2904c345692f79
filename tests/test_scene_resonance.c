/*
 * test_scene_resonance.c -- the scene resonance_curve: a signal stops it at any point of the
 * computation, and points without a resonance say why.
 */
#include "scene_fixture.h"

#include <pendres/free.h>

#include "results/failed.h"
#include "scenes/peak.h"

/* Asked for the `limit`-th time, the farm is told to stop. */
typedef struct stopper {
  long asked, limit;
} stopper;

static int ask(void *arg)
{
  stopper *s = arg;
  return ++s->asked >= s->limit;
}

/* Few members in a narrow range: the turning point of the curve is computed after the dampings. */
static pendres_status run_until(stopper *s)
{
  static const char text[] =
    "&scene kind = 'resonance_curve' /\n&pendulum drive_amplitude = 0.2 /\n"
    "&sweep damping = 0.37, 0.38, 0.39, drive_frequency_range = 0.94, 0.98 /\n"
    "&ensemble members = 8 /\n";
  char path[100];
  deck d;
  namelist_errors errors = {0};
  farm_options options = {.threads = 1, .stop = ask, .stop_arg = s};
  scene_run run = {.deck = &d};
  assert_int_equal(deck_read_memory("test.nml", text, strlen(text), &d, &errors), PENDRES_OK);
  check_ok(farm_create(&options, &run.farm));
  scene_path("stopped", path);
  check_ok(pendres_store_create(path, NULL, &run.store));
  const pendres_status status = scene_find(d.kind)->run(&run);
  scene_room_end(&run.room);
  check_ok(pendres_store_close(run.store));
  pendres_store_free(run.store);
  farm_free(run.farm);
  deck_free(&d);
  namelist_errors_free(&errors);
  return status;
}

/* Once near the end, when only the turning point is left to compute, and once at the very end. */
static void a_signal_at_the_turning_point(void **state)
{
  stopper all = {.limit = 1L << 40};
  (void)state;
  check_ok(run_until(&all));
  assert_true(all.asked > 100);
  for (int i = 0; i < 2; i++) {
    stopper s = {.limit = i == 0 ? all.asked - all.asked / 8 : all.asked};
    assert_int_equal(run_until(&s), PENDRES_INTERRUPTED);
  }
}

/* Two dampings whose area rises throughout the range and two with a peak: marked, whatever the
   threads, and the terminal says which end. */
static void points_without_a_peak(void **state)
{
  static const char text[] =
    "&scene kind = 'resonance_curve' /\n&pendulum drive_amplitude = 0.2 /\n"
    "&sweep damping = 0.37, 0.38, 1.2, 1.5, drive_frequency_range = 0.94, 0.98 /\n"
    "&ensemble members = 8 /\n";
  (void)state;
  assert_int_equal(scene_run_marked(NULL, text, 1, "one"), 2);
  assert_non_null(strstr(scene_told, "end of the range"));
  assert_int_equal(scene_run_marked(NULL, text, 3, "three"), 2);
  scene_check_same_bytes("one", "three");
  pendres_store *store = scene_open("one");
  size_t n;
  double *failed = scene_values(store, "failed", &n), *peak = scene_values(store, "peak", &n);
  double *area = scene_values(store, "mean_loop_area", &n);
  assert_int_equal(n, 4);
  for (size_t i = 0; i < n; i++) {
    const int none = i >= 2;
    assert_int_equal((int)failed[i], none ? SCENE_FAILURE_NOT_FOUND : SCENE_FAILURE_NONE);
    assert_int_equal((int)peak[i], none ? 3 : PENDRES_PEAK_SMOOTH);
    assert_true(none == (isnan(area[i]) != 0));
  }
  free(failed);
  free(peak);
  free(area);
  pendres_store_free(store);
}

/*
 * A curve over drive amplitudes is that over dampings at each of its values, and so are resonances
 * of a response where both look in the same range; beside it there is none.
 */
static void drive_amplitudes(void **state)
{
  static const char members[] = "&ensemble members = 8 /\n";
  char text[4][400];
  size_t n = 0;
  double *frequency[2], *period[3];
  (void)state;
  snprintf(text[0], sizeof text[0], "&scene kind = 'resonance_curve' /\n&pendulum damping = 0.5 /\n"
           "&sweep drive_amplitude = 0.1, 0.2, drive_frequency_range = 0.8, 1.0 /\n%s", members);
  snprintf(text[1], sizeof text[1], "&scene kind = 'resonance_curve' /\n"
           "&pendulum drive_amplitude = 0.2 /\n"
           "&sweep damping = 0.5, drive_frequency_range = 0.8, 1.0 /\n%s", members);
  for (int i = 2; i < 4; i++)
    snprintf(text[i], sizeof text[i], "&scene kind = 'response' /\n&pendulum damping = 0.5 /\n"
             "&sweep drive_amplitude = 0.1, 0.2, drive_frequency_range = 0.7, 0.8, 2,\n"
             "  resonance_range = %s /\n%s", i == 2 ? "0.8, 1.0" : "1.0, 1.1", members);
  for (int i = 0; i < 4; i++) {
    char name[] = "amplitudes0";
    name[10] = (char)('0' + i);
    /* Both amplitudes are marked where the range holds no peak. */
    assert_int_equal(scene_run_marked(NULL, text[i], 1, name), i == 3 ? 2 : 0);
    pendres_store *store = scene_open(name);
    if (i < 2) frequency[i] = scene_values(store, "resonance_frequency", &n);
    if (i != 1) period[i == 0 ? 0 : i - 1] = scene_values(store, "resonance_period", &n);
    pendres_store_free(store);
  }
  assert_true(frequency[0][1] == frequency[1][0] && frequency[0][0] > frequency[0][1]);
  for (int i = 0; i < 2; i++) {
    assert_true(period[0][i] == period[1][i]);
    assert_true(isnan(period[2][i]));
    free(frequency[i]);
  }
  for (int i = 0; i < 3; i++) free(period[i]);
}

/*
 * Of others than the plain pendulum: over torques, of which 0 is the plain pendulum's resonance to
 * the last bit; of a linear oscillator, whose peak is at the zero of 3 u^2 - (2 a - g^2) u - a^2 in
 * u = w^2; and beside a response if the deck says where to look. What compares with the plain
 * pendulum's free oscillations is left out.
 */
static void other_models(void **state)
{
  static const char range[] = "drive_frequency_range = 0.7, 1.1 /\n&ensemble members = 8 /\n";
  char text[500];
  size_t n = 0;
  (void)state;
  snprintf(text, sizeof text, "&scene kind = 'resonance_curve' /\n&pendulum drive_amplitude = 0.1, "
           "damping = 0.5 /\n&sweep torque = 0, 0.2, %s", range);
  assert_int_equal(scene_run_marked(NULL, text, 1, "torques"), 0);
  snprintf(text, sizeof text, "&scene kind = 'resonance_curve' /\n&pendulum drive_amplitude = 0.1 /"
           "\n&sweep damping = 0.5, %s", range);
  assert_int_equal(scene_run_marked(NULL, text, 1, "plain"), 0);
  pendres_store *store = scene_open("torques"), *plain = scene_open("plain");
  double *frequency = scene_values(store, "resonance_frequency", &n);
  double *want = scene_values(plain, "resonance_frequency", &n);
  double *torque = scene_values(store, "torque", &n);
  assert_true(n == 2 && torque[1] == 0.2 && frequency[0] == want[0] && frequency[1] < want[0]);
  assert_true(pendres_store_has(plain, "", "free_frequency"));
  assert_false(pendres_store_has(store, "", "free_frequency"));
  free(frequency), free(want), free(torque);
  pendres_store_free(store);
  pendres_store_free(plain);

  const double a = 4.0, g = 0.4, b = 2.0 * a - g * g;
  const double exact = sqrt((b + sqrt(b * b + 12.0 * a * a)) / 6.0);
  for (int looked = 0; looked < 2; looked++) {
    snprintf(text, sizeof text, "&scene kind = 'response' /\n&pendulum drive_amplitude = 0.1, "
             "force = 'polynomial', force_coefficients = 4 /\n&sweep damping = 0.4, "
             "drive_frequency = 1.5, 2.5%s /\n&ensemble members = 8 /\n",
             looked ? ", resonance_range = 1.5, 2.5" : "");
    assert_int_equal(scene_run_marked(NULL, text, 1, "linear"), 0);
    store = scene_open("linear");
    assert_true(pendres_store_has(store, "", "resonance_frequency") == looked);
    if (looked) {
      double *found = scene_values(store, "resonance_frequency", &n);
      double *error = scene_values(store, "resonance_frequency_error", &n);
      check_near(found[0], exact, error[0]);
      free(found), free(error);
    }
    pendres_store_free(store);
  }
}

/* Resonances that may be narrower than a search can look: a peak, marked, and exit code 3. */
static void a_search_that_is_not_complete(void **state)
{
  static const char text[] =
    "&scene kind = 'resonance_curve' /\n&pendulum drive_amplitude = 1e-4 /\n"
    "&sweep damping = 1.2e-3, drive_frequency_range = 0.7, 1.3 /\n"
    "&precision tolerance = 1e-3 /\n&ensemble members = 1, x_first = 1.57, x_last = 1.58 /\n";
  (void)state;
  assert_int_equal(scene_run_marked(NULL, text, 1, "budget"), 1);
  assert_non_null(strstr(scene_told, "too few frequencies"));
  pendres_store *store = scene_open("budget");
  size_t n;
  double *failed = scene_values(store, "failed", &n), *peak = scene_values(store, "peak", &n);
  assert_int_equal(n, 1);
  assert_int_equal((int)failed[0], SCENE_FAILURE_BUDGET);
  assert_int_equal((int)peak[0], PENDRES_PEAK_SMOOTH);
  free(failed);
  free(peak);
  pendres_store_free(store);
}

/*
 * A loop whose amplitude may be that of a pendulum upside down or more: its free frequency may be
 * anything from zero to that of the least amplitude, which is 1 for none. Both ends are exact.
 */
static void amplitudes_up_to_the_top(void **state)
{
  (void)state;
  for (int k = 1; k < 31; k++) {
    const double loop = 0.1 * k;
    const pendres_resonance r = {
      .frequency = 0.8, .response = {.mean_loop_amplitude = loop,
                                     .mean_loop_amplitude_error = 3.2}};
    scene_peak p;
    scene_peak_set(&p, 0.01, PENDRES_OK, &r);
    const double free = pendres_free_frequency(loop);
    check_near(p.free_frequency, free, 0.0);
    check_near(p.free_frequency_error, fmax(free, 1.0 - free), 1e-15);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_signal_at_the_turning_point),
    cmocka_unit_test(points_without_a_peak),
    cmocka_unit_test(a_search_that_is_not_complete),
    cmocka_unit_test(drive_amplitudes), cmocka_unit_test(other_models),
    cmocka_unit_test(amplitudes_up_to_the_top),
  };
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
