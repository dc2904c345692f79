/*
 * test_scene_fit.c -- the scene fit: the deck and data of input, what the file holds, and data that
 * are wrong, each told with file, line and remedy.
 *
 * The data are those of fit_fixture.h, made with damping 0.005, 1.2 MHz, 0.01 a volt of drive,
 * 4/15 V a length and 0.8 mV of offset: values must be within four and a half standard errors of
 * these.
 */
#include "scene_fixture.h"

#include <math.h>

enum { OPEN = 5, DATA = 240 };

static const char head[] = "&scene kind = 'fit' /\n&pendulum force = 'polynomial', "
                           "force_coefficients = 1, 0, 1 /\n";

static void three_drives(void **state)
{
  (void)state;
  static const double truth[OPEN] = {0.005, 1.2e6, 0.01, 4.0 / 15.0, 0.0008};
  char text[1500], folder[1000];
  assert_non_null(getcwd(folder, sizeof folder));
  snprintf(text, sizeof text,
           "%s&data file = '%.900s/input/fit.csv'\n  columns = 'frequency', 'volts', 'error', "
           "'direction', 'drive_amplitude=drive'\n  observable = 'first_harmonic_amplitude' /\n"
           "&fit free = 'damping', 'frequency_scale', 'drive_scale', 'amplitude_scale',\n"
           "  'offset' /\n",
           head, folder);
  scene_run_deck(text, 1, "fit");
  pendres_store *s = scene_open("fit");
  double value[OPEN], error[OPEN], covariance[OPEN * OPEN], chi = 0.0, p = 0.0, residual[DATA];
  check_ok(pendres_store_read(s, NULL, "value", PENDRES_STORE_DOUBLE, value, OPEN));
  check_ok(pendres_store_read(s, NULL, "value_error", PENDRES_STORE_DOUBLE, error, OPEN));
  check_ok(pendres_store_read(s, NULL, "covariance", PENDRES_STORE_DOUBLE, covariance,
                              OPEN * OPEN));
  check_ok(pendres_store_read(s, NULL, "chi_square", PENDRES_STORE_DOUBLE, &chi, 1));
  check_ok(pendres_store_read(s, NULL, "probability", PENDRES_STORE_DOUBLE, &p, 1));
  check_ok(pendres_store_read(s, NULL, "residual", PENDRES_STORE_DOUBLE, residual, DATA));
  for (int i = 0; i < OPEN; i++) {
    check_near(value[i], truth[i], 4.5 * error[i]);
    check_near(sqrt(covariance[i * OPEN + i]), error[i], 1e-9 * error[i]);
  }
  assert_true(p > 1e-5 && chi > 0.0);
  char *name = NULL;
  check_ok(pendres_store_read_text(s, NULL, "parameter_name", 1, &name));
  assert_string_equal(name, "frequency_scale");
  free(name);
  assert_true(pendres_store_has(s, NULL, "branch_stable") &&
              pendres_store_has(s, NULL, "branch_multiplier_re") &&
              pendres_store_has(s, NULL, "jump_parameter"));
  pendres_store_free(s);
}

/* Run on a data file with this text; the message of the failure. */
static void check_told(const char *data, const char *keys, const char *words)
{
  char path[100], text[600];
  const char *why = NULL;
  deck d;
  namelist_errors errors = {0};
  farm_options options = {.threads = 1};
  scene_run run = {.deck = &d};
  snprintf(path, sizeof path, "%s/data.txt", scene_folder);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  assert_true(fputs(data, f) >= 0);
  assert_int_equal(fclose(f), 0);
  snprintf(text, sizeof text, "&scene kind = 'fit' /\n&data file = '%s' %s /\n"
           "&fit free = 'damping' /\n&pendulum drive_amplitude = 0.1, damping = 0.1 /\n", path,
           keys);
  assert_int_equal(deck_read_memory("test.nml", text, strlen(text), &d, &errors), PENDRES_OK);
  check_ok(scene_precision(&d, &options.library, &why));
  check_ok(farm_create(&options, &run.farm));
  scene_path("none", path);
  check_ok(pendres_store_create(path, NULL, &run.store));
  assert_int_equal(scene_find(d.kind)->run(&run), PENDRES_INVALID_ARGUMENT);
  if (strstr(run.message, words) == NULL) fail_msg("'%s' has no '%s'", run.message, words);
  scene_room_end(&run.room);
  pendres_store_free(run.store);
  farm_free(run.farm);
  deck_free(&d);
  namelist_errors_free(&errors);
}

static void bad_data(void **state)
{
  (void)state;
  check_told("", "", "there are no data");
  check_told("0.8 0.1\n", "observable = 'amplitude', 'rms'", "no column of 'rms' is known");
  check_told("drive_frequency amplitude\n0.8 0.1\n0.9\n", "", "data.txt:3: the line has 1 col");
  check_told("0.8 0.1\n0.9 x1\n", "", "data.txt:2: 'x1' in column 2 is no number");
  check_told("0.8;0.1\n0.9;0,2\n", "", "decimals have a point");
  check_told("0.8 0.1\n# a comment\n0.9 nan\n", "", "data.txt:3: the amplitude in column 2 is not");
  check_told("0.8 0.1\n0.9 0.2\n", "columns = '1', '7'", "there is no column '7'");
  check_told("0.8 0.1\n0.9 0.2\n", "columns = 'phase=2', '1'", "'phase' is no role");
  check_told("0.8,0.1,0\n0.9,0.2,0.1\n", "columns = '1', '2', 'error=3'", "must be above 0");
  check_told("0.8 0.1\n", "", "1 data do not determine 1 unknowns");
  check_told("0.8 0.1 0\n", "columns = '1', '2', 'direction=3'", "not 0");
}

static void bad_keys(void **state)
{
  (void)state;
  scene_check_refused("&scene kind = 'fit' /\n&data file = 'a' /\n&fit free = 'dampin' /\n",
                      "did you mean 'damping'");
  scene_check_refused("&scene kind = 'fit' /\n&data file = 'a' /\n", "needs a group &fit with");
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(three_drives), cmocka_unit_test(bad_data),
                                     cmocka_unit_test(bad_keys)};
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
