/*
 * test_driver_results.c -- what the program writes: the same bytes for any number of threads, and
 * orbits against the long double reference.
 */
#include "driver_run.h"
#include "same_results.h"

#include <pendres/pendres.h>
#include "oracle/reference.h"
#include <pendres/store.h>

static void test_run(void **state)
{
  static const char *const decks[] = { "small.nml", "orbit.nml", "hard.nml" };
  char table[TEXT_ROOM];
  (void)state;
  write_text("hard.nml", "&scene kind = 'hard_cases' /\n"
                         "&sweep case = 'tolerance', 'separatrix' /\n");
  for (size_t i = 0; i < sizeof decks / sizeof *decks; i++) {
    check_code(RUN("--quiet", "--threads=1", "-o", "one.h5", decks[i]), DONE);
    assert_string_equal(err, "");
    assert_true(strlen(out) > 100);
    strcpy(table, out);
    check_code(RUN("-t", "2", "-o", "two.h5", "--log", "log.txt", decks[i]), DONE);
    check_says(err, "two.h5 written");
    assert_string_equal(out, table);
    check_same_results("one.h5", "two.h5");
    check_code(RUN("-q", decks[i]), DONE);
  }
  assert_true(exists("small.h5") && exists("orbit.h5") && exists("hard.h5"));
  assert_int_equal(count_names(".part"), 0);
  read_text("log.txt", table, sizeof table);
  check_says(table, "two.h5 written");
}

static void read_all(const char *path, const char *name, double *values, size_t n)
{
  pendres_store *store = NULL;
  check_ok(pendres_store_open(path, &store));
  check_ok(pendres_store_read(store, NULL, name, PENDRES_STORE_DOUBLE, values, n));
  pendres_store_free(store);
}

static double read_one(const char *path, const char *name)
{
  double value = 0.0;
  read_all(path, name, &value, 1);
  return value;
}

/* Counts among the figures of hard cases are exact; errors are not told to have none. The first
   rows are two counts, of which the naive way has the second alone, and two errors. */
static void test_hard_figures(void **state)
{
  enum { ROWS = 15 };
  double error[ROWS], naive[ROWS];
  (void)state;
  write_text("hard.nml", "&scene kind = 'hard_cases' /\n"
                         "&sweep case = 'tolerance', 'separatrix' /\n");
  check_code(RUN("-q", "hard.nml"), DONE);
  read_all("hard.h5", "figure_error", error, ROWS);
  read_all("hard.h5", "naive_figure_error", naive, ROWS);
  assert_true(error[0] == 0.0 && error[1] == 0.0 && isnan(naive[0]) && naive[1] == 0.0);
  for (int i = 2; i < ROWS; i++) assert_true(isnan(error[i]) && isnan(naive[i]));
}

/* The orbit scene against the long double reference, within ten times the errors claimed. */
static void test_orbit(void **state)
{
  enum { N = 4 * 256 };
  const pendres_pendulum p = { 0.12, 0.2, 6.28318530717958647693 / 8, 0.0 };
  const double half_pi = 1.57079632679489661923;
  reference_cycle cycle;
  double x[N], v[N], x_error[N], v_error[N];
  (void)state;
  check_code(RUN("-q", "orbit.nml"), DONE);
  read_all("orbit.h5", "x", x, N);
  read_all("orbit.h5", "v", v, N);
  read_all("orbit.h5", "x_error", x_error, N);
  read_all("orbit.h5", "v_error", v_error, N);
  check_ok(reference_orbit(&p, x[0] - half_pi, v[0], 1, 0, &cycle));
  for (int k = 0; k < N; k += 256) {
    check_near(x[k], (double)cycle.y + half_pi, 10.0 * x_error[k]);
    check_near(v[k], (double)cycle.v, 10.0 * v_error[k]);
    assert_true(x_error[k] < 1e-8 && v_error[k] < 1e-8); /* the default tolerance */
  }
  /* Half a period later the orbit is its own mirror image. */
  for (int k = 0; k < 128; k++) {
    check_near(x[k] - half_pi, -(x[k + 128] - half_pi), 10.0 * x_error[k]);
    check_near(v[k], -v[k + 128], 10.0 * v_error[k]);
  }
  const struct { const char *name; double want; } scalars[] = {
    { "loop_area", (double)cycle.loop_area }, { "dissipation", (double)cycle.dissipation },
    { "amplitude", (double)cycle.amplitude }, { "phase_lag", (double)cycle.phase_lag },
    { "mean_power", (double)cycle.mean_power }, { "period", 1 }, { "winding", 0 }, { "well", 0 },
    { "first_harmonic_amplitude", (double)cycle.first_harmonic_amplitude },
  };
  for (size_t i = 0; i < sizeof scalars / sizeof *scalars; i++) {
    char name[64];
    snprintf(name, sizeof name, "%s_error", scalars[i].name);
    check_near(read_one("orbit.h5", scalars[i].name), scalars[i].want,
               10.0 * read_one("orbit.h5", name));
  }
}

static void check_attribute(const char *path, const char *name, const char *want)
{
  pendres_store *store = NULL;
  char *text = NULL;
  check_ok(pendres_store_open(path, &store));
  check_ok(pendres_store_read_attribute_text(store, "", NULL, name, &text));
  assert_string_equal(text, want);
  free(text);
  pendres_store_free(store);
}

/* A file says which run it is of, so that several can be put together. */
static void test_identity(void **state)
{
  (void)state;
  check_code(RUN("-q", "orbit.nml"), DONE);
  check_attribute("orbit.h5", "scene", "orbit");
  check_attribute("orbit.h5", "deck", "orbit.nml");
  check_attribute("orbit.h5", "coordinates",
                  "drive_amplitude damping drive_frequency drive_period");
  check_near(read_one("orbit.h5", "drive_amplitude"), 0.2, 0.0);
  check_near(read_one("orbit.h5", "damping"), 0.12, 0.0);
  check_near(read_one("orbit.h5", "drive_period"), 8.0, 0.0);
  check_code(RUN("-q", "orbit.nml", "pendulum.force='polynomial'", "pendulum.torque=0.1",
                 "pendulum.force_coefficients=1, 0, 0.5", "orbit.start='1'"), DONE);
  check_attribute("orbit.h5", "coordinates",
                  "drive_amplitude damping drive_frequency drive_period torque a1 a2 a3 a4 a5");
  check_near(read_one("orbit.h5", "torque"), 0.1, 0.0);
  check_near(read_one("orbit.h5", "a3"), 0.5, 0.0);
}

/* A start in the next well: the record begins there, and the orbit is the same one beside. */
static void test_transient(void **state)
{
  enum { N = 20 * 8 };
  double x[N], v[N];
  (void)state;
  write_text("start.nml", "&scene kind = 'orbit' /\n"
                          "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8 /\n"
                          "&orbit x = 7.5, v = 0.1, transient = T, periods = 20, samples = 8 /\n");
  check_code(RUN("-q", "start.nml"), DONE);
  read_all("start.h5", "x", x, N);
  read_all("start.h5", "v", v, N);
  check_near(x[0], 7.5, 0.0);
  check_near(v[0], 0.1, 0.0);
  check_near(read_one("start.h5", "well"), 1.0, 0.0);
  check_near(read_one("start.h5", "label"), PENDRES_LABEL_SA, 0.0);
  assert_true(read_one("start.h5", "settling_periods") >= 0.0);
}

/* Another method than the default says what it is not for. */
static void test_method(void **state)
{
  (void)state;
  write_text("method.nml", "&scene kind = 'response' /\n"
                           "&pendulum damping = 0.2 drive_amplitude = 0.2 drive_frequency = 0.8 /\n"
                           "&ensemble members = 2 /\n&precision method = 'single' /\n");
  check_code(RUN("--threads=1", "method.nml"), DONE);
  check_says(err, "method 'single' advances and settles");
}

/* The decks of the repository that take no time. */
static void test_input(void **state)
{
  static const char *const names[] = { "f01", "f05", "f06" };
  (void)state;
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    char deck[PATH_ROOM + 20], result[20];
    snprintf(deck, sizeof deck, "%s/input/%s.nml", top, names[i]);
    snprintf(result, sizeof result, "%s.h5", names[i]);
    check_code(RUN("-q", deck), DONE);
    assert_true(exists(result));
  }
}

/* A point without a result: the file is there, and says so. */
/* The provenance tells all that was done, what noise costs included. */
static void test_cost_of_noise(void **state)
{
  pendres_store *store = NULL;
  double periods = 0.0, forces = 0.0;
  (void)state;
  write_text("noise.nml", "&scene kind = 'switching' /\n"
                          "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 7.7 /\n"
                          "&sweep temperature = 0.02 /\n"
                          "&noise trajectories = 200, periods = 500 /\n");
  check_code(RUN("-q", "-t", "2", "-o", "noise.h5", "noise.nml"), DONE);
  assert_int_equal(pendres_store_open("noise.h5", &store), PENDRES_OK);
  assert_int_equal(pendres_store_read(store, "provenance", "pendulum_periods",
                                      PENDRES_STORE_DOUBLE, &periods, 1), PENDRES_OK);
  assert_int_equal(pendres_store_read(store, "provenance", "rhs_evaluations",
                                      PENDRES_STORE_DOUBLE, &forces, 1), PENDRES_OK);
  pendres_store_free(store);
  /* The trajectories themselves, at 8 steps a period at least; and choices and settling beside. */
  assert_true(periods >= 200.0 * 500.0 && periods < 10.0 * 200.0 * 500.0);
  assert_true(forces >= 2.0 * 8.0 * 200.0 * 500.0);
}

static void test_failed_points(void **state)
{
  (void)state;
  write_text("free.nml", "&scene kind = 'orbit' /\n"
                         "&pendulum drive_amplitude = 0, damping = 0, drive_frequency = 1 /\n"
                         "&orbit x = 1 /\n");
  check_code(RUN("free.nml"), 3);
  check_says(err, "1 point");
  assert_true(isnan(read_one("free.h5", "loop_area")));
  assert_true(isnan(read_one("free.h5", "loop_area_error")));
  check_near(read_one("free.h5", "label"), PENDRES_LABEL_UNRESOLVED, 0.0);
  check_near(read_one("free.h5", "failed"), 1.0, 0.0); /* unresolved */
  check_says(err, "orbit: ");
}

/*
 * Helmholtz' oscillator: members that escape are an answer, and no error is told. How many is what
 * Runge and Kutta's method of order four at 400 steps a period finds, where x < -20 within 60
 * periods. Means are those of the others, to their errors as everywhere, and there is none where
 * all escape.
 */
static void test_escapes(void **state)
{
  enum { N = 12 };
  static const double known[N] = {9, 10, 12, 14, 20, 20, 10, 5, 4, 4, 4, 4};
  static const char *const kinds[] = {"response", "branches", "phase_diagram"};
  double escaped[N], failed[N], area[N], error[N], other[N];
  char text[400];
  (void)state;
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
    snprintf(text, sizeof text, "&scene kind = '%s' /\n&pendulum force = 'polynomial', "
             "force_coefficients = 1, 1, drive_amplitude = 0.1 /\n"
             "&sweep damping = 0.1, drive_frequency_range = 0.6, 1.2, 12 /\n"
             "&ensemble members = 20, x_first = -1.2, x_last = 0.8 /\n", kinds[k]);
    write_text("helmholtz.nml", text);
    check_code(RUN("-q", "helmholtz.nml"), DONE);
    assert_string_equal(err, "");
    read_all("helmholtz.h5", "escaped_members", escaped, N);
    read_all("helmholtz.h5", "failed", failed, N);
    for (size_t i = 0; i < N; i++) {
      check_near(escaped[i], known[i], 0.0);
      check_near(failed[i], 0.0, 0.0);
    }
  }
  read_all("helmholtz.h5", "other", other, N);
  read_all("helmholtz.h5", "mean_loop_area", area, N);
  read_all("helmholtz.h5", "mean_loop_area_error", error, N);
  for (size_t i = 0; i < N; i++) {
    assert_true(((int)other[i] & PENDRES_OTHER_ESCAPE) != 0);
    if (known[i] == 20) assert_true(isnan(area[i]) && isnan(error[i]));
    else assert_true(area[i] > 0.0 && error[i] < 1e-8);
  }
}

/* Two of the ten points, resonances among them, are unresolved after twelve periods: the share that
   a deck tolerates decides, and nothing that it tolerates is called an error. */
static void test_unresolved_share(void **state)
{
  (void)state;
  write_text("short.nml", "&scene kind = 'response' /\n&pendulum drive_amplitude = 0.2 /\n"
                          "&sweep damping = 0.05, 0.24, drive_frequency_range = 0.7, 0.8, 4 /\n"
                          "&ensemble members = 4 /\n&precision period_budget = 12 /\n");
  check_code(RUN("short.nml"), 3);
  check_says(err, "error: 2 points failed");
  check_code(RUN("short.nml", "precision.unresolved_share=0.19"), 3);
  check_says(err, "error: 2 points failed");
  check_code(RUN("short.nml", "precision.unresolved_share=0.2"), DONE);
  check_says(err, "2 of 10 points unresolved");
  assert_null(strstr(err, "error:"));
  double failed[8], marked = 0.0; /* all the same */
  read_all("short.h5", "failed", failed, 8);
  for (size_t i = 0; i < 8; i++) marked += failed[i] == 1.0;
  assert_true(marked >= 1.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    TEST(test_escapes), TEST(test_unresolved_share),
    TEST(test_run),        TEST(test_orbit), TEST(test_identity),      TEST(test_transient),
    TEST(test_hard_figures),
    TEST(test_method),
    TEST(test_input),      TEST(test_failed_points), TEST(test_cost_of_noise),
  };
  return find_program() ? cmocka_run_group_tests(tests, NULL, NULL) : 77;
}
