/*
 * test_scene_ramp.c -- a parameter moved in real time by a deck: the library's numbers, the same
 * bytes whoever computes them, and decks that are wrong.
 */
#include "scene_fixture.h"

#include <pendres/pendres.h>

#define DECK "&scene kind = 'hysteresis' /\n" \
  "&pendulum drive_amplitude = 0.2, damping = 0.15, temperature = 1e-3 /\n" \
  "&sweep drive_frequency_range = 0.8, 0.89, 31 /\n&precision tolerance = 1e-5 /\n"
#define NOISE "&noise trajectories = 200, seed = 4 /\n"

static const double rate = 3e-4;

static void ramp(void **state)
{
  (void)state;
  static const char *const texts[] = {
    DECK "&hysteresis start = 'sa', rate = 3e-4, points = 30 /\n" NOISE,
    DECK "&hysteresis start = 'sa', protocol = 0, 0.8, 100, 0.83, 300, 0.89, points = 30 /\n"
    NOISE};
  size_t n = 0;
  scene_run_deck(texts[0], 1, "one");
  scene_run_deck(texts[0], 2, "two");
  scene_check_same_bytes("one", "two");
  scene_run_deck(texts[1], 2, "table");
  pendres_store *store = scene_open("one"), *other = scene_open("table");
  double *time = scene_values(store, "ramp_time", &n);
  double *value = scene_values(store, "ramp_parameter", &n);
  double *x = scene_values(store, "ramp_x", &n), *error = scene_values(store, "ramp_x_error", &n);
  assert_int_equal(n, 2 * 31);
  for (size_t i = 0; i < n; i++) {
    const double along = fmin(time[i], 600.0 - time[i]);
    check_near(time[i], (double)(10 * (i < 31 ? i : i - 1)), 0.0);
    check_near(value[i], 0.8 + rate * along, 1e-15);
    assert_true(error[i] < 1e-4 && isfinite(x[i]));
  }
  assert_true(error[0] == 0.0 && error[5] > 0.0 && x[30] == x[31]);
  double *delay = scene_values(store, "jump_delay", &n);
  double *end = scene_values(store, "jump_parameter", &n);
  double *left = scene_values(store, "jump_ramp_parameter", &n);
  double *again = scene_values(other, "jump_delay", &n);
  assert_int_equal(n, 2);
  check_near(left[0] - end[0], delay[0], 1e-12);
  check_near(end[1] - left[1], delay[1], 1e-12);
  for (size_t k = 0; k < 2; k++) {
    assert_true(delay[k] > 10.0 * rate && delay[k] < 100.0 * rate);
    check_near(again[k], delay[k], 1e-9); /* the table is the same straight line */
  }
  double *noisy = scene_values(store, "jump_noisy_parameter", &n);
  assert_int_equal(n, 2 * 200);
  double *mean = scene_values(store, "jump_mean", &n);
  double *off = scene_values(store, "jump_mean_error", &n);
  double *count = scene_values(store, "jump_count", &n);
  for (size_t k = 0; k < 2; k++) {
    double sum = 0.0;
    for (size_t i = 0; i < 200; i++) sum += noisy[200 * k + i];
    assert_true(count[k] == 200.0);
    check_near(mean[k], sum / 200.0, 1e-14);
    /* Noise makes jumps earlier, whichever the direction. */
    assert_true((left[k] - mean[k]) * (k == 0 ? 1.0 : -1.0) > 3.0 * off[k]);
  }
  pendres_store_free(store);
  pendres_store_free(other);
  free(time), free(value), free(x), free(error), free(delay), free(end), free(left), free(again);
  free(noisy), free(mean), free(off), free(count);
}

static void wrong_decks(void **state)
{
  static const struct {
    const char *text, *message;
  } wrong[] = {
    {DECK "&hysteresis x = 1 /\n", "goes with 'rate' or 'protocol'"},
    {DECK "&hysteresis x = 1, rate = 1e-3, protocol = 0, 0.8, 9, 0.89 /\n", "not both"},
    {DECK "&hysteresis x = 1, rate = 0 /\n", "'rate' must be positive"},
    {DECK "&hysteresis x = 1, rate = 1e-20 /\n", "more than 1e9 drive periods"},
    {DECK "&hysteresis x = 1, protocol = 0, 0.8, 9 /\n", "pairs of a time and a value"},
    {DECK "&hysteresis x = 1, protocol = 1, 0.8, 9, 0.89 /\n", "starts at time 0"},
    {DECK "&hysteresis x = 1, protocol = 0, 0.8, 9, 0.88 /\n", "goes from the first value"},
    {DECK "&hysteresis x = 1, protocol = 0, 0.8, 9.5, 0.89 /\n", "whole drive periods"},
    {DECK "&hysteresis x = 1, protocol = 0, 0.8, 9, 0.85, 9, 0.89 /\n", "times that ascend"},
    {DECK "&hysteresis x = 1, protocol = 0, 0.8, 9, 0.85, 10, 0.84, 11, 0.89 /\n",
     "values that ascend"},
    {DECK "&hysteresis x = 1, rate = 1e-3 /\n&sweep temperature = 0, 1 /\n", "given"},
    {"&scene kind = 'hysteresis' /\n&pendulum drive_amplitude = 0.2, damping = 0.15 /\n"
     "&sweep drive_frequency = 0.8, 0.9 /\n&hysteresis x = 1, points = 3 /\n",
     "'points' is not used: it concerns ramps"},
    {"&scene kind = 'hysteresis' /\n&pendulum drive_amplitude = 0.2, damping = 0.15 /\n"
     "&sweep drive_frequency = 0.8, 0.9, temperature = 0, 1 /\n&hysteresis x = 1, rate = 1 /\n",
     "one 'temperature'"},
  };
  (void)state;
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    scene_check_refused(wrong[i].text, wrong[i].message);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(ramp), cmocka_unit_test(wrong_decks)};
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
