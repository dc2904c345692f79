/*
 * test_driver_units.c -- a laboratory's decks: from SI to results in SI, with what marks them in
 * files; and whose equation and methods a file names.
 */
#include "driver_run.h"

#include "kinds_fixture.h"

#include <math.h>

#include <pendres/pendulum.h>
#include <pendres/store.h>

static double number(pendres_store *store, const char *name, size_t i, size_t n)
{
  double value[16];
  assert_true(n <= sizeof value / sizeof *value && i < n);
  check_ok(pendres_store_read(store, "", name, PENDRES_STORE_DOUBLE, value, n));
  return value[i];
}

/* The factor that makes SI of a variable, which has that unit. */
static double factor(pendres_store *store, const char *name, const char *units)
{
  double value = NAN;
  char *text = NULL;
  check_ok(pendres_store_read_attribute_double(store, "", name, "si_factor", &value));
  check_ok(pendres_store_read_attribute_text(store, "", name, "si_units", &text));
  assert_string_equal(text, units);
  free(text);
  return value;
}

#define RESONATOR \
  "&units mass = '1e-12 kg', natural_frequency = '1.2 MHz' /\n" \
  "&pendulum force = 'polynomial', force_coefficients = 1, 0, '1e14 N/m^3', damping = 'Q 5000'"

/*
 * A resonator of 1.2 MHz. The drive is 1.621e-5 k sqrt(k/k3), at which the folds are known to a
 * thousandth of a Hz: the tolerance is half of that. They were computed by way of the dimensionless
 * equation, and converted by hand.
 */
static void test_jumps(void **state)
{
  pendres_store *store = NULL;
  double si[2], ours[2];
  (void)state;
  write_text("resonator.nml", "&scene kind = 'hysteresis' /\n" RESONATOR
             ", drive_amplitude = '694.810476271 pN' /\n&hysteresis start = '1' /\n"
             "&sweep drive_frequency_range = '1.199 MHz', '1.206 MHz', 41 /\n");
  check_code(RUN("-q", "--csv", "resonator.nml"), DONE);
  check_says(out, "jump_parameter, MHz");
  check_says(out, "\n0 (up)                        1.202939889");
  check_says(out, "\n1 (down)                      1.200642889");
  check_says(out, " 1.2029398898");
  check_says(out, "694.8104763 pN\n");
  check_ok(pendres_store_open("resonator.h5", &store));
  for (size_t i = 0; i < 2; i++) {
    ours[i] = number(store, "jump_parameter", i, 2);
    si[i] = ours[i] * factor(store, "jump_parameter", "Hz");
  }
  check_near(si[0], 1202939.890, 5e-4);
  check_near(si[1], 1200642.890, 5e-4);
  factor(store, "jump_parameter_error", "Hz");
  factor(store, "amplitude", "m");
  factor(store, "loop_area_error", "J");
  pendres_store_free(store);
  read_text("resonator.jump.csv", out, sizeof out);
  check_says(out, "# jump_parameter: value at which the state ends [Hz]\n");
  check_says(out, "\n0,1202939.8898");
  check_says(out, "# drive_amplitude = 6.94810476271e-10 N\n");

  /* The resolved deck, in the model's own units, gives the same digits. */
  check_code(RUN("--dump-namelist", "resonator.nml"), DONE);
  write_text("resolved.nml", out);
  check_code(RUN("-q", "-o", "resolved.h5", "resolved.nml"), DONE);
  check_ok(pendres_store_open("resolved.h5", &store));
  for (size_t i = 0; i < 2; i++) assert_true(number(store, "jump_parameter", i, 2) == ours[i]);
  factor(store, "jump_parameter", "Hz");
  pendres_store_free(store);
}

/* What there is not is no number: a junction's voltage where it rotates without a lock. */
static void test_absent(void **state)
{
  (void)state;
  write_text("iv.nml", "&scene kind = 'hysteresis' /\n&hysteresis x = 1.6 /\n"
             "&units critical_current = '10 uA', resistance = '10 Ohm', capacitance = '0.5 pF' /\n"
             "&pendulum drive_amplitude = 0, drive_frequency = 1 /\n"
             "&sweep torque_range = '0 A', '12 uA', 13 /\n");
  check_code(RUN("-q", "iv.nml"), DONE);
  check_says(out, "homoclinic  0.866712477541");
  check_says(out, "1 (down)                      8.66712477541");
  check_says(out, "     0\n"); /* the voltage at rest has no error */
  assert_null(strstr(out, "nan"));
  assert_null(strstr(out, " \n"));
  /* All rows are printed of 20, and of 21 every second. */
  check_code(RUN("-q", "iv.nml", "sweep.torque_range='0 A','12 uA',20"), DONE);
  check_says(out, "\n0.6315789474 ");
  check_says(out, "\n11.36842105 ");
  assert_null(strstr(out, "rows; the file has all"));
  check_code(RUN("-q", "iv.nml", "sweep.torque_range='0 A','12 uA',21"), DONE);
  check_says(out, "\n10.8 ");
  check_says(out, "\n12 ");
  assert_null(strstr(out, "\n11.4 "));
  check_says(out, "(11 of 21 rows; the file has all, and --csv writes them)\n");
}

/* Its cusp, known to a tenth of a pN. */
static void test_cusp(void **state)
{
  pendres_store *store = NULL;
  (void)state;
  write_text("resonator.nml", "&scene kind = 'branches' /\n" RESONATOR " /\n"
             "&sweep drive_amplitude = '100 pN', '300 pN',\n"
             "  drive_frequency_range = '1.1995 MHz', '1.202 MHz', 21 /\n"
             "&ensemble members = 2, x_first = '-10 nm', x_last = '10 nm' /\n");
  check_code(RUN("-q", "resonator.nml"), DONE);
  check_says(out, "cusp_drive_amplitude       173.74");
  check_ok(pendres_store_open("resonator.h5", &store));
  check_near(number(store, "cusp_drive_amplitude", 0, 1) *
             factor(store, "cusp_drive_amplitude", "N"), 173.7e-12, 0.05e-12);
  pendres_store_free(store);
}

/* Marks change no number, and there are none without scales. */
static void test_marks(void **state)
{
  static const char *const names[] = { "amplitude", "loop_area", "drive_frequency",
                                       "drive_period" };
  pendres_store *plain = NULL, *marked = NULL;
  double unused = 0;
  (void)state;
  check_code(RUN("-q", "-o", "plain.h5", "orbit.nml"), DONE);
  assert_null(strstr(out, "in SI"));
  check_code(RUN("-q", "-o", "marked.h5", "orbit.nml", "units.natural_frequency=0.83 Hz"), 2);
  check_code(RUN("-q", "-o", "marked.h5", "orbit.nml", "units.natural_frequency='0.83 Hz'"), DONE);
  check_says(out, "in SI:\n");
  check_code(RUN("-q", "-o", "marked.h5", "orbit.nml", "units.natural_frequency=0.83Hz"), DONE);
  check_ok(pendres_store_open("plain.h5", &plain));
  check_ok(pendres_store_open("marked.h5", &marked));
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    assert_true(number(plain, names[i], 0, 1) == number(marked, names[i], 0, 1));
    assert_int_equal(pendres_store_read_attribute_double(plain, "", names[i], "si_factor", &unused),
                     PENDRES_NOT_FOUND);
  }
  assert_true(factor(marked, "drive_frequency", "Hz") == 0.83);
  check_relative(factor(marked, "drive_period", "s"), 1 / (2 * PENDRES_PI * 0.83), 4e-16);
  assert_int_equal(pendres_store_read_attribute_double(marked, "", "loop_area", "si_factor",
                                                       &unused), PENDRES_NOT_FOUND);
  pendres_store_free(plain);
  pendres_store_free(marked);
  check_code(RUN("-q", "orbit.nml", "units.natural_frequency=-1"), 2);
}

/* Numbers without a unit: the ends of their names, or with a star how they begin. */
static const char *const pure[] = {
  "drift", "escape_rate_bound", "phase_lag", "watched_periods", "basin_entropy", "fraction",
  "curvature", "multiplier", "multiplier_re", "multiplier_im", "parametric_amplitude", "period",
  "ratio", "level", "dispersion_*", "distance", "phase", "escapes", "events_*", "fit_chi2_*",
  "share", "ramp_time", "log_prefactor_*", "occupation_*", "implied_occupation_*",
  "prefactor_exponent_*", "missed_*", "rotation", "settling_periods", "uncertainty_exponent",
  "well", "winding",
  "lyapunov_dimension", "correlation_dimension", "correlation_sum",
  /* Of fits: values have various units, which value_units has; drives are in an instrument's. */
  "value", "value_si", "covariance", "chi_square", "degrees_of_freedom", "probability", "other",
};

static int is_pure(const char *name)
{
  const size_t n = strlen(name);
  for (size_t i = 0; i < sizeof pure / sizeof *pure; i++) {
    const size_t m = strlen(pure[i]);
    if (pure[i][m - 1] == '*' && strncmp(name, pure[i], m - 1) == 0) return 1;
    if (n < m || strcmp(name + n - m, pure[i]) != 0) continue;
    if (n == m || name[n - m - 1] == '_') return 1;
  }
  return 0;
}

/* Whoever adds a result tells its quantity (drivers/deck/quantity.c), or that it is a number. */
static int check_all_marked(const char *file)
{
  pendres_store *store = NULL;
  pendres_store_type type;
  char *name = NULL;
  int wrong = 0;
  check_ok(pendres_store_open(file, &store));
  /* What a fit seeks is no coordinate of its file: the deck has a guess at most. */
  if (pendres_store_has(store, "", "value_si")) assert_false(pendres_store_has(store, "", "a3"));
  for (uint64_t i = 0; pendres_store_member(store, "", i, &type, &name) == PENDRES_OK; i++) {
    char result[200];
    double value = NAN;
    const size_t n = strlen(name);
    const int error = n > 6 && strcmp(name + n - 6, "_error") == 0;
    snprintf(result, sizeof result, "%.*s", (int)(error ? n - 6 : n), name);
    const int marked = pendres_store_read_attribute_double(store, "", name, "si_factor", &value) ==
                       PENDRES_OK;
    if (type == PENDRES_STORE_DOUBLE && !marked && !is_pure(result)) {
      print_error("%s of %s has no unit\n", name, file);
      wrong++;
    }
    free(name);
  }
  pendres_store_free(store);
  return wrong;
}

static void test_all_marked(void **state)
{
  const char *decks[MOST_ARGUMENTS + 1];
  int wrong = 0;
  (void)state;
  add_kinds(decks, 0);
  for (size_t i = 0; decks[i] != NULL; i++) {
    /* The scale of its data is what a fit seeks without units. */
    const int fits = strstr(decks[i], "fit.nml") != NULL;
    const int code = RUN("-q", "-o", "kind.h5", decks[i], "units.mass=3", "units.length=5",
                         "sweep.resolution=1",
                         fits ? "units.natural_frequency=1.2e6" : "units.natural_frequency=2",
                         fits ? "units.volts_per_length=0.05333" : NULL,
                         "fit.free=damping,a3,drive_scale,offset");
    if (strstr(decks[i], "hard.nml") != NULL) check_code(code, 2); /* a benchmark has no units */
    else assert_true(code == DONE || code == 3);
    if (code != 2) wrong += check_all_marked("kind.h5");
    (void)remove("kind.h5");
  }
  assert_int_equal(wrong, 0);
}

static void check_references(const char *setting, const char *words, const char *missing)
{
  pendres_store *store = NULL;
  char *text = NULL;
  check_code(RUN("-q", "-o", "of.h5", "of.nml", "pendulum.drive_amplitude=0.01", setting), DONE);
  check_ok(pendres_store_open("of.h5", &store));
  check_ok(pendres_store_read_attribute_text(store, "", NULL, "references", &text));
  check_says(text, words);
  if (strstr(text, missing) != NULL) fail_msg("%s in %s", missing, text);
  free(text);
  pendres_store_free(store);
}

/* Each equation has its own, and the pendulum's paper stands where it is the pendulum's. */
static void test_references(void **state)
{
  static const char paper[] = "Kharkongor";
  (void)state;
  write_text("of.nml", "&scene kind = 'orbit' /\n"
             "&pendulum damping = 0.3, drive_frequency = 0.8, drive_amplitude = 0 /\n"
             "&orbit x = 0.1 /\n");
  check_references("pendulum.damping=0.3", "driven simple pendulum, Figs. 5 and 6", "Duffing");
  check_references("pendulum.torque=0.1", "Stewart", paper);
  check_references("pendulum.parametric_amplitude=0.1", "Kapitza", paper);
  write_text("of.nml", "&scene kind = 'branches' /\n"
             "&pendulum force = 'polynomial', force_coefficients = 1, 0, 1, damping = 0.3 /\n"
             "&sweep drive_frequency = 0.8, 0.9 /\n"
             "&ensemble members = 2, x_first = -0.1, x_last = 0.1 /\n");
  check_references("pendulum.damping=0.3", "(1918); Y. A. Kuznetsov", paper);
  check_references("pendulum.force_coefficients=-1,0,1", "Holmes", "Duffing");
  check_references("pendulum.force_coefficients=0,0,1", "Ueda", "Duffing");
  check_references("pendulum.force_coefficients=1,-1", "Thompson", "Duffing");
  check_references("pendulum.force_coefficients=1,1,1", "Nayfeh", "Duffing");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    TEST(test_jumps), TEST(test_absent), TEST(test_cusp), TEST(test_marks),
    TEST(test_all_marked), TEST(test_references),
  };
  return find_program() ? cmocka_run_group_tests(tests, NULL, NULL) : 77;
}
