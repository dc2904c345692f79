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

/* The deck of input with other groups in front and other keys of the fit. */
static pendres_store *run_sweeps(const char *groups, const char *fit)
{
  char text[1500], folder[1000];
  assert_non_null(getcwd(folder, sizeof folder));
  snprintf(text, sizeof text,
           "%s&data file = '%.600s/input/fit.csv'\n  columns = 'frequency', 'volts', 'error', "
           "'direction', 'drive_amplitude=drive'\n  observable = 'first_harmonic_amplitude' /\n"
           "&fit %s /\n", groups, folder, fit);
  scene_run_deck(text, 1, "fit");
  return scene_open("fit");
}

static void read_numbers(pendres_store *s, const char *name, double *out, size_t n)
{
  check_ok(pendres_store_read(s, NULL, name, PENDRES_STORE_DOUBLE, out, n));
}

static void three_drives(void **state)
{
  (void)state;
  static const double truth[OPEN] = {0.005, 1.2e6, 0.01, 4.0 / 15.0, 0.0008};
  pendres_store *s = run_sweeps(head, "free = 'damping', 'frequency_scale', 'drive_scale',\n"
                                "  'amplitude_scale', 'offset'");
  double value[OPEN], error[OPEN], covariance[OPEN * OPEN], chi = 0.0, p = 0.0, residual[DATA];
  read_numbers(s, "value", value, OPEN);
  read_numbers(s, "value_error", error, OPEN);
  read_numbers(s, "covariance", covariance, OPEN * OPEN);
  read_numbers(s, "chi_square", &chi, 1);
  read_numbers(s, "probability", &p, 1);
  read_numbers(s, "residual", residual, DATA);
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
  assert_false(pendres_store_has(s, NULL, "value_si"));
  pendres_store_free(s);
}

static void check_mark(pendres_store *s, const char *name, double factor, const char *units)
{
  double value = 0.0;
  char *text = NULL;
  check_ok(pendres_store_read_attribute_double(s, NULL, name, "si_factor", &value));
  check_ok(pendres_store_read_attribute_text(s, NULL, name, "si_units", &text));
  check_near(value, factor, 1e-14 * factor);
  assert_string_equal(text, units);
  free(text);
}

/* The same data where mass, frequency and the detector are known: what follows from these is not
   sought, and data in Hz and V become numbers in the model's units and back. */
static void known_scales(void **state)
{
  (void)state;
  const double f0 = 1.2e6, mass = 1e-12, length = 1e-7, rate = 2.0 * PENDRES_PI * f0;
  const double stiffness = mass * rate * rate, volts = 4.0 / 15.0;
  const double truth[OPEN] = {0.005 * rate, stiffness, stiffness / (length * length),
                              0.01 * stiffness * length, 0.0008};
  static const char *const units[OPEN] = {"s-1", "N m-1", "N m-3", "N", "V"};
  double value[OPEN], error[OPEN], ours[DATA];
  char *text = NULL;
  pendres_store *s = run_sweeps(
    "&scene kind = 'fit' /\n&units natural_frequency = '1.2 MHz', mass = '1 ng',\n"
    "  length = '100 nm', volts_per_length = 2666666.6666666665 /\n"
    "&pendulum force = 'polynomial', force_coefficients = 1, 0, 1 /\n",
    "free = 'damping', 'a1', 'a3', 'drive_scale', 'offset',\n"
    "  bounds = 'a3 1e15, 1e16 N/m^3', prior = 'offset 0.7 0.3 mV'");
  read_numbers(s, "value_si", value, OPEN);
  read_numbers(s, "value_si_error", error, OPEN);
  for (size_t i = 0; i < OPEN; i++) {
    check_near(value[i], truth[i], 4.5 * error[i]);
    assert_true(error[i] > 0.0 && error[i] < 0.1 * truth[i]);
    check_ok(pendres_store_read_text(s, NULL, "value_units", i, &text));
    assert_string_equal(text, units[i]);
    free(text);
  }
  check_mark(s, "jump_parameter", f0, "Hz");
  check_mark(s, "jump_measured_to", f0, "Hz");
  check_mark(s, "observed", volts, "V");
  check_mark(s, "modelled_error", volts, "V");
  check_mark(s, "branch_amplitude", volts, "V");
  check_mark(s, "branch_axis", f0, "Hz");
  read_numbers(s, "datum_axis", ours, DATA);
  check_near(ours[0] * f0, 1182000.0, 1e-9); /* the first line of the file */
  read_numbers(s, "observed", ours, DATA);
  check_near(ours[0] * volts, 0.002563, 1e-15);
  /* Generators' volts have no unit. */
  double unused = 0.0;
  assert_int_equal(pendres_store_read_attribute_double(s, NULL, "datum_other", "si_factor",
                                                       &unused), PENDRES_NOT_FOUND);
  pendres_store_free(s);
}

/* A linear decay in seconds and volts, by its formula: 1 kHz, Q = 50, 2 V at first. The start is
   free though the deck does not name it, and where mass and frequency are known all comes in SI. */
static void ringdown(void **state)
{
  (void)state;
  enum { MEASURED = 300, FOUND = 4 };
  const double f0 = 1000.0, rate = 2.0 * PENDRES_PI * f0, damping = rate / 50.0;
  const double w = sqrt(rate * rate - 0.25 * damping * damping), volts = 0.5;
  const double truth[FOUND] = {1.0 / 50.0, f0, 2.0 / volts, 0.0};
  static const char groups[] = "force = 'polynomial', force_coefficients = 1 /\n"
                               "&data axis = 'time', columns = 'time', 'volts'";
  char text[900], path[100];
  double value[FOUND], error[FOUND], chi = 0.0;
  scene_path("data", path);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fprintf(f, "time, volts\n");
  for (int i = 0; i < MEASURED; i++) {
    const double t = 7e-5 * i;
    fprintf(f, "%.17g, %.17g\n", t,
            exp(-0.5 * damping * t) * 2.0 * (cos(w * t) + 0.5 * damping / w * sin(w * t)));
  }
  assert_int_equal(fclose(f), 0);
  snprintf(text, sizeof text, "&scene kind = 'fit' /\n&pendulum %s, file = '%s', error = 1e-3 /\n"
           "&fit free = 'damping', 'frequency_scale', fixed = 'amplitude_scale %.17g' /\n", groups,
           path, volts);
  scene_run_deck(text, 1, "ringdown");
  pendres_store *s = scene_open("ringdown");
  read_numbers(s, "value", value, FOUND);
  read_numbers(s, "value_error", error, FOUND);
  read_numbers(s, "chi_square", &chi, 1);
  for (int i = 0; i < FOUND; i++) check_near(value[i], truth[i], 0.01 * error[i]); /* exact data */
  assert_true(chi < 0.01 && pendres_store_has(s, NULL, "modelled"));
  assert_false(pendres_store_has(s, NULL, "branch_axis"));
  pendres_store_free(s);

  snprintf(text, sizeof text, "&scene kind = 'fit' /\n&units natural_frequency = '1 kHz', "
           "length = '1 nm', volts_per_length = '%.17g V/nm' /\n&pendulum %s, file = '%s', "
           "error = 1e-3 /\n&fit free = 'damping', 'a1' /\n", volts, groups, path);
  scene_run_deck(text, 1, "ringdown");
  s = scene_open("ringdown");
  read_numbers(s, "value_si", value, FOUND);
  read_numbers(s, "value_si_error", error, FOUND);
  check_near(value[0], damping, 0.01 * error[0]);
  check_near(value[2], 2.0, 0.01 * error[2]);
  check_mark(s, "datum_axis", 1.0 / rate, "s");
  check_mark(s, "residual", volts, "V");
  pendres_store_free(s);
}

/* Currents and voltages of a junction whose critical current and capacitance are told: all is in
   SI. */
static void junction(void **state)
{
  (void)state;
  enum { MEASURED = 40, FOUND = 2 };
  const double current = 1e-5, flux = 6.62607015e-34 / (4.0 * PENDRES_PI * 1.602176634e-19);
  const double rate = sqrt(current / (1e-12 * flux)), damping = 0.3;
  char text[700], path[100];
  double value[FOUND], error[FOUND];
  pendres_rotation_onset onset;
  check_ok(pendres_rotation_onset_find(damping, &onset));
  scene_path("iv", path);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fprintf(f, "current, voltage, direction\n");
  for (int i = 0; i < 2 * MEASURED; i++) {
    const int up = i < MEASURED;
    const double torque = 1.8 * (up ? i : 2 * MEASURED - 1 - i) / (MEASURED - 1);
    const pendres_pendulum p = {.drive_frequency = 1.0, .damping = damping, .torque = torque};
    pendres_rotation r = {0};
    if (torque > (up ? 1.0 : onset.torque)) check_ok(pendres_rotation_find(&p, &r, NULL));
    fprintf(f, "%.17g, %.17g, %d\n", torque * current, flux * rate * r.mean_velocity, up ? 1 : -1);
  }
  assert_int_equal(fclose(f), 0);
  snprintf(text, sizeof text, "&scene kind = 'fit' /\n"
           "&units critical_current = '10 uA', capacitance = '1 pF' /\n"
           "&data file = '%s', columns = 'current', 'voltage', 'direction=direction',\n"
           "  axis = 'torque', observable = 'mean_velocity', error = 1e-7 /\n"
           "&fit free = 'damping', 'offset' /\n", path);
  scene_run_deck(text, 1, "junction");
  pendres_store *s = scene_open("junction");
  read_numbers(s, "value_si", value, FOUND);
  read_numbers(s, "value_si_error", error, FOUND);
  check_near(value[0], damping * rate, 0.05 * error[0]); /* exact data */
  check_near(value[1], 0.0, 0.05 * error[1]);
  assert_false(pendres_store_has(s, NULL, "branch_axis"));
  pendres_store_free(s);
}

/* A table of jumps in a laboratory's units: those of docs/units.md's resonator, whose places
   branches tell to 1e-3 Hz; and as lines beside an amplitude, with cells that are empty. */
static void jumps(void **state)
{
  (void)state;
  static const char *const tables[] = {
    "place; error; way\n1202939.890; 0.001; up\n1200642.890; 0.001; down\n",
    "f amplitude jump jump_error amplitude_error direction\n1200100 6.2e-9 - - 1e-7 up\n"
    "0 - 1202939.890 0.001 - up\n0 - 1200642.890 0.001 - -1\n"};
  static const char *const keys[] = {
    "columns = 'place', 'error', 'way', observable = 'jump'",
    "columns = 'drive_frequency=f', 'amplitude=amplitude', 'amplitude_error=amplitude_error',\n"
    "  'jump=jump', 'jump_error=jump_error', 'direction', observable = 'amplitude', 'jump'"};
  for (int k = 0; k < 2; k++) {
    char text[900], path[100];
    double value = 0.0, error = 0.0;
    scene_path("jumps", path);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    assert_true(fputs(tables[k], f) >= 0);
    assert_int_equal(fclose(f), 0);
    snprintf(text, sizeof text, "&scene kind = 'fit' /\n"
             "&units mass = '1e-12 kg', natural_frequency = '1.2 MHz' /\n"
             "&pendulum force = 'polynomial', force_coefficients = 1, 0, '1e14 N/m^3',\n"
             "  drive_amplitude = 1.621e-5, damping = 'Q 4900' /\n"
             "&data file = '%s' %s /\n&fit free = 'damping' /\n", path, keys[k]);
    scene_run_deck(text, 1, "table");
    pendres_store *s = scene_open("table");
    read_numbers(s, "value", &value, 1);
    read_numbers(s, "value_error", &error, 1);
    check_near(value, 2e-4, 2.0 * error); /* the last digit of the places is their error's */
    assert_true(error < 1e-9 && pendres_store_has(s, NULL, "branch_axis"));
    if (k == 0) check_mark(s, "observed", 1.2e6, "Hz");
    pendres_store_free(s);
  }
}

/* Results of our own sweeps are data, without a conversion: what they were computed with comes back
   to a tenth of the errors told, and the jumps with them. */
static void results_as_data(void **state)
{
  (void)state;
  char text[700], path[100];
  double value[3], error[3], unit = 0.0;
  static const double truth[3] = {0.05, 0.05, 0.5};
  scene_run_deck("&scene kind = 'hysteresis' /\n&units natural_frequency = '1 MHz' /\n"
                 "&pendulum force = 'polynomial', force_coefficients = 1, 0, 0.5, damping = 0.05,\n"
                 "  drive_amplitude = 0.05 /\n&hysteresis x = 0.1 /\n"
                 "&sweep drive_frequency_range = 0.9, 1.4, 31 /\n", 1, "swept");
  scene_path("swept", path);
  for (int scaled = 0; scaled < 2; scaled++) {
    snprintf(text, sizeof text, "&scene kind = 'fit' /\n%s"
             "&pendulum force = 'polynomial', force_coefficients = 1 /\n"
             "&data file = '%s', error = 1e-3, observable = 'amplitude', 'phase_lag' /\n"
             "&fit free = 'damping', 'drive_amplitude', 'a3' /\n",
             scaled ? "&units natural_frequency = '1 MHz' /\n" : "", path);
    scene_run_deck(text, 1, "again");
    pendres_store *s = scene_open("again");
    read_numbers(s, "value", value, 3);
    read_numbers(s, "value_error", error, 3);
    for (int i = 0; i < 3; i++) check_near(value[i], truth[i], 0.1 * error[i]);
    int rank = 0;
    uint64_t size[PENDRES_STORE_RANK];
    check_ok(pendres_store_shape(s, NULL, "observed", &rank, size));
    assert_int_equal(size[0], 4 * 31); /* two observables, both ways */
    assert_int_equal(pendres_store_read_attribute_double(s, NULL, "datum_axis", "si_factor", &unit),
                     scaled ? PENDRES_OK : PENDRES_NOT_FOUND);
    pendres_store_free(s);
  }
}

/* Noise is no resonance: the best values are given, and that they are not converged is told. */
static void no_convergence(void **state)
{
  (void)state;
  char text[500], path[100];
  double value[3];
  int8_t converged = 1;
  scene_path("noise", path);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  for (unsigned i = 0; i < 60; i++)
    fprintf(f, "%.2f %.2f 0.01\n", 0.7 + 0.01 * i, 0.01 * (i * i * 7919u % 101u));
  assert_int_equal(fclose(f), 0);
  snprintf(text, sizeof text, "&scene kind = 'fit' /\n"
           "&pendulum force = 'polynomial', force_coefficients = 1, 0, 1 /\n"
           "&data file = '%s', columns = '1', '2', '3' /\n"
           "&fit free = 'damping', 'drive_amplitude', 'a3' /\n", path);
  assert_int_equal(scene_run_marked(NULL, text, 1, "none"), 1); /* exit code 3 */
  assert_non_null(strstr(scene_told, "did not converge"));
  pendres_store *s = scene_open("none");
  check_ok(pendres_store_read(s, NULL, "converged", PENDRES_STORE_INT8, &converged, 1));
  read_numbers(s, "value", value, 3);
  assert_true(converged == 0 && isfinite(value[0]) && value[0] > 0.0);
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
  check_told("drive_frequency\t amplitude\n0.8\t 0.1\n", "", "1 data do not"); /* blanks are none */
  check_told("\211HDF and no more", "", "the file of results cannot be read");
  check_told("0.8 0.1\n0.9 x1\n", "", "data.txt:2: 'x1' in column 2 is no number");
  check_told("0.8;0.1\n0.9;0,2\n", "", "decimals have a point");
  check_told("0.8 0.1\n# a comment\n0.9 nan\n", "", "data.txt:3: the amplitude in column 2 is not");
  check_told("0.8 0.1\n0.9 0.2\n", "columns = '1', '7'", "there is no column '7'");
  /* What is no amplitude, nor rad; the swept value is the library's to refuse, with its line. */
  static const char *const phase = "observable = 'phase_lag'";
  check_told("0.8 0.1\n# up\n0.9 -0.2\n1.0 0.3\n", "", "data.txt:3: amplitudes and rms are not");
  check_told("0.8 0.1\n0.9 -0.2\n", "error = 0.01", "data.txt:2: amplitudes and rms are not");
  check_told("0.8 -41\n0.9 -22\n", "", "10^(dB/20)");
  check_told("0.8 -0.1\n0.9 -0.2\n", "observable = 'loop_area'", "data.txt:1: a loop area");
  check_told("0.8 10\n0.9 80\n", phase, "data.txt:1: a phase_lag is in rad");
  check_told("0.8 1\n0.9 -179.5\n", phase, "data.txt:2: a phase_lag is in rad");
  check_told("0.8 0.1\n-0.9 0.2\n", "", "data.txt:2: the swept parameter must be positive");
  check_told("0.8 0.1\n0.9 0.2\n", "columns = 'phase=2', '1'", "'phase' is no role");
  check_told("0.8,0.1,0\n0.9,0.2,0.1\n", "columns = '1', '2', 'error=3'", "must be above 0");
  check_told("0.8 0.1\n", "", "1 data do not determine 1 unknowns");
  check_told("0 1\n1 2\n", "axis = 'time', observable = 'amplitude'", "a displacement is a datum");
  check_told("0 1\n1 2\n", "observable = 'displacement'", "a displacement is a datum");
  check_told("0.8 0.01\n0.9 0.01\n", "observable = 'jump'", "give a column for the direction");
  check_told("0.8 0.1 0\n", "columns = '1', '2', 'direction=3'", "not 0");
}

#define SCALED "&scene kind = 'fit' /\n&data file = 'a' /\n&units natural_frequency = 2 /\n&fit "

static void bad_keys(void **state)
{
  (void)state;
  static const struct { const char *keys, *words; } wrong[] = {
    {"free = 'damping', 'frequency_scale'", "'frequency_scale' is what 'natural_frequency'"},
    {"free = 'damping', fixed = 'frequency_scale 3'", "leave out one of the two"},
    {"free = 'damping', fixed = 'gain 3'", "begins with no quantity of a fit"},
    {"free = 'damping', fixed = 'offset'", "is not of the form 'NAME VALUE'"},
    {"free = 'damping', fixed = 'offset 1 mV'", "'offset' is in rad here: 'mV' does not fit"},
    {"free = 'damping', fixed = 'drive_scale 1 N'", "complete &units"},
    {"free = 'damping', fixed = 'offset 1', 'offset 2'", "has 'offset' twice"},
    {"free = 'damping', fixed = 'damping 1'", "'damping' is in 'free' too"},
    {"free = 'damping', bounds = 'offset 1 2'", "name 'offset' in 'free'"},
    {"free = 'damping', bounds = 'damping 2 1'", "must be below the upper"},
    {"free = 'damping', bounds = 'damping 1 2 kHq'", "'kHq' is no unit"},
    {"free = 'damping', bounds = 'damping 1 2 kHz'", NULL},
    {"free = 'damping', prior = 'damping 1 0'", "must be above 0"},
    {"free = 'damping', prior = 'damping x 0'", "is not of the form 'NAME MEAN ERROR'"},
  };
  scene_check_refused("&scene kind = 'fit' /\n&data file = 'a', axis = 'torque' /\n"
                      "&units critical_current = 1, capacitance = 1 /\n"
                      "&fit free = 'torque_scale' /\n",
                      "'torque_scale' is what 'critical_current'");
  scene_check_refused("&scene kind = 'fit' /\n&data file = 'a' /\n&fit free = 'dampin' /\n",
                      "did you mean 'damping'");
  scene_check_refused("&scene kind = 'fit' /\n&data file = 'a' /\n", "needs a group &fit with");
  scene_check_refused("&scene kind = 'fit' /\n&data file = 'a' /\n&pendulum force = 'polynomial' /"
                      "\n&units volts_per_length = 1 /\n&fit free = 'amplitude_scale' /\n",
                      "'amplitude_scale' is what 'volts_per_length'");
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    char text[400];
    deck d;
    namelist_errors errors = {0};
    snprintf(text, sizeof text, "%s%s /\n", SCALED, wrong[i].keys);
    if (wrong[i].words != NULL) {
      scene_check_refused(text, wrong[i].words);
      continue;
    }
    assert_int_equal(deck_read_memory("test.nml", text, strlen(text), &d, &errors), PENDRES_OK);
    deck_free(&d);
    namelist_errors_free(&errors);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(three_drives), cmocka_unit_test(known_scales),
                                     cmocka_unit_test(ringdown), cmocka_unit_test(junction),
                                     cmocka_unit_test(jumps),
                                     cmocka_unit_test(results_as_data),
                                     cmocka_unit_test(no_convergence),
                                     cmocka_unit_test(bad_data), cmocka_unit_test(bad_keys)};
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
