/*
 * test_driver_settings.c -- the command line beside the deck: keys that are set there, several
 * decks, a deck from standard input, and results of another deck that stay when replaced.
 */
#include "driver_run.h"

#include <pendres/pendulum.h>
#include <pendres/store.h>
#include <pendres/version.h>

static char *text_of(const char *file, const char *group, const char *name)
{
  pendres_store *store = NULL;
  char *text = NULL;
  assert_int_equal(pendres_store_open(file, &store), PENDRES_OK);
  if (group != NULL)
    assert_int_equal(pendres_store_read_text(store, group, name, 0, &text), PENDRES_OK);
  else
    assert_int_equal(pendres_store_read_attribute_text(store, "", NULL, name, &text), PENDRES_OK);
  pendres_store_free(store);
  return text;
}

static void check_text(const char *file, const char *group, const char *name, const char *words)
{
  char *text = text_of(file, group, name);
  check_says(text, words);
  free(text);
}

/* A key that is set takes the place of all that the deck says of the quantity, in any form. */
static void test_settings(void **state)
{
  static const char sweep[] = "&scene kind = 'response' /\n&pendulum drive_amplitude = 0.2 /\n"
                              "&sweep damping = 0.1, 0.2, damping_range = 0.3, 0.5, 3\n"
                              "       drive_period_range = 5, 10, 6 /\n";
  (void)state;
  write_text("sweep.nml", sweep);
  check_code(RUN("--dump-namelist", "sweep.nml", "sweep.damping_range=0.6,0.8,2",
                 "pendulum.drive_amplitude=.25", "sweep.drive_frequency=0.7, 0.9"), DONE);
  check_says(out, "damping_range = 0.6, 0.8, 2\n");
  check_says(out, "drive_amplitude = 0.25\n");
  check_says(out, "drive_frequency = 0.7, 0.9\n");
  assert_null(strstr(out, "  damping ="));
  assert_null(strstr(out, "drive_period"));
  check_code(RUN("--dump-namelist", "sweep.nml", "pendulum.damping=0.4"), DONE);
  check_says(out, "damping = 0.4\n");
  assert_null(strstr(out, "damping_range"));
  /* One value in &pendulum and an axis of &sweep are one quantity, too, either way. */
  check_code(RUN("--dump-namelist", "sweep.nml", "sweep.drive_amplitude_range=0.1,0.3,3"), DONE);
  check_says(out, "drive_amplitude_range = 0.1, 0.3, 3\n");
  assert_null(strstr(out, "drive_amplitude ="));
  write_text("wide.nml", out);
  check_code(RUN("--dump-namelist", "wide.nml", "pendulum.drive_amplitude=.25"), DONE);
  check_says(out, "drive_amplitude = 0.25\n");
  assert_null(strstr(out, "drive_amplitude_range"));
  /* So are a coefficient that is an axis and its place in the list of all. */
  write_text("force.nml", "&scene kind = 'branches' /\n&pendulum damping = 0.2,\n"
                          "drive_frequency = 1, drive_amplitude = 0.1, force = 'polynomial',\n"
                          "force_coefficients = 1, 0, 1 /\n");
  check_code(RUN("--dump-namelist", "force.nml", "sweep.a3=1, 2"), DONE);
  check_says(out, "a3 = 1.0, 2.0\n");
  check_says(out, "force_coefficients = 1.0, 0.0, 0.0, 0.0, 0.0\n");
  write_text("force.nml", out);
  check_code(RUN("--dump-namelist", "force.nml", "pendulum.force_coefficients=1, 0, 3"), 2);
  check_says(err, "'a3' is given in 'force_coefficients' too");
  /* Strings come without the quotes that a shell has taken away, or with them. */
  check_code(RUN("--dump-namelist", "orbit.nml", "orbit.start=sa", "scene.title=it's 1, or 2",
                 "scene.output='a b.h5'", "pendulum.drive_frequency=0.8"), DONE);
  check_says(out, "start = 'sa'\n");
  check_says(out, "title = 'it''s 1, or 2'\n");
  check_says(out, "output = 'a b.h5'\n");
  assert_null(strstr(out, "drive_period"));
  check_code(RUN("-q", "orbit.nml", "pendulum.damping=0.13", "orbit.periods=1"), DONE);
  check_text("orbit.h5", "provenance", "deck_resolved", "damping = 0.13\n");
  check_text("orbit.h5", "provenance", "settings", "pendulum.damping=0.13 orbit.periods=1");
  check_text("orbit.h5", NULL, "history",
             "Z: resonance orbit.nml pendulum.damping=0.13 orbit.periods=1");
  check_text("orbit.h5", "provenance", "deck", "damping = 0.12");
}

/* The words of the deck's own errors, with the argument where its line stands. */
static void test_bad_settings(void **state)
{
  static const struct { const char *setting, *says; } bad[] = {
    { "pendulum.dampng=0.13", ":10: error: 'dampng' is not a key of &pendulum (did you mean "
                              "'damping'?)\n  pendulum.dampng=0.13\n           ^~~~~~" },
    { "pendulum.damping=-1", "line:1:18: error: 'damping' must not be negative" },
    { "pendulm.damping=1", "did you mean 'pendulum'" },
    { "orbit.qwertz=1", "scene 'orbit' takes start, x, v, periods, samples, transient" },
    { "sweep.x=1", "&sweep is not used by scene 'orbit'" },
    { "orbit.start=ma", "'start' knows no 'ma'" },
    { "pendulum.damping=0.1 drive_period=8", "sets one key" },
    { "pendulum.damping=0.1,0.2", "takes one value" },
    { "pendulum.damping=0.1 /", "too much" },
    { "damping=0.1", "GROUP.KEY=VALUE" },
    { "pendulum.damping=\x1b[31m", "control byte" },
  };
  (void)state;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    check_code(RUN("orbit.nml", bad[i].setting), 2);
    check_says(err, bad[i].says);
  }
  check_code(RUN("orbit.nml", "pendulum.damping=0.1", "pendulum.damping=0.2"), 2);
  check_says(err, "'pendulum.damping' is set twice");
  assert_int_equal(count_names(".h5"), 0);
}

static void test_several_decks(void **state)
{
  (void)state;
  check_code(RUN("small.nml", "orbit.nml", "precision.tolerance=1e-6"), DONE);
  check_says(out, "small.nml");
  check_says(out, "orbit.nml");
  check_text("small.h5", "provenance", "deck_resolved", "tolerance = 1e-06\n");
  check_text("orbit.h5", "provenance", "deck_resolved", "tolerance = 1e-06\n");
  check_code(RUN("-o", "one.h5", "small.nml", "orbit.nml"), 2);
  check_says(err, "--output names one file");
  check_code(RUN("small.nml", "orbit.nml", "scene.output=one.h5"), 2);
  check_says(err, "both write one.h5");
  /* One that is bad stops all, before anything is computed; one that fails, only itself. */
  write_text("bad.nml", "&scene kind = 'orbit' /\n");
  write_text("lost.nml", "&scene kind = 'free_oscillation', output = 'absent/a.h5' /\n"
                         "&sweep amplitude = 1 /\n");
  assert_int_equal(remove("small.h5"), 0);
  check_code(RUN("small.nml", "bad.nml"), 2);
  assert_false(exists("small.h5"));
  check_code(RUN("lost.nml", "small.nml"), 1);
  assert_true(exists("small.h5"));
}

static void test_standard_input(void **state)
{
  (void)state;
  const int kept = dup(0), in = open("orbit.nml", O_RDONLY);
  assert_true(kept >= 0 && in >= 0 && dup2(in, 0) == 0);
  const int code = RUN("-q", "-o", "piped.h5", "-", "pendulum.damping=0.11");
  assert_int_equal(dup2(kept, 0), 0);
  assert_int_equal(close(in) | close(kept), 0);
  check_code(code, DONE);
  check_text("piped.h5", "provenance", "deck", "kind = 'orbit'");
  check_text("piped.h5", "provenance", "deck_resolved", "damping = 0.11\n");
}

/* A table under that name would not be one. */
static void test_csv_is_no_hdf5(void **state)
{
  (void)state;
  check_code(RUN("-o", "x.csv", "small.nml"), 2);
  check_says(err, "x.csv: results are an HDF5 file");
  check_says(err, "-o x.h5 --csv");
  assert_int_equal(count_names(".csv"), 0);
}

/* Number `column` of line `row` behind the header, which must begin with `header`. */
static double cell(const char *path, const char *header, int row, int column)
{
  static char text[TEXT_ROOM];
  read_text(path, text, sizeof text);
  const char *at = strstr(text, header);
  assert_true(at != NULL && at > text && at[-1] == '\n');
  for (int i = 0; i <= row; i++) {
    at = strchr(at, '\n');
    assert_non_null(at);
    at++;
  }
  for (int i = 0; i < column; i++) {
    at += strcspn(at, ",\n");
    assert_int_equal(*at, ',');
    at++;
  }
  return strtod(at, NULL);
}

/* A name that the table is written under first, and that leads to somebody's file, is not written
   to, nor a file there that is no table; what a killed run has left there is replaced. A link in
   the place of the table is followed, as that of the HDF5 file is, and its permissions stay. */
static void test_text_beside_others(void **state)
{
  char text[100];
  struct stat info;
  (void)state;
  write_text("theirs", "precious");
  assert_int_equal(symlink("theirs", "small.csv.part"), 0);
  check_code(RUN("--csv", "-q", "-o", "small.h5", "small.nml"), 1);
  check_says(err, "'small.csv.part' is not a regular file but a symbolic link");
  check_says(err, "whole in the HDF5 file");
  read_text("theirs", text, sizeof text);
  assert_string_equal(text, "precious");
  assert_true(exists("small.h5") && !exists("small.csv") && exists("small.csv.part"));
  assert_int_equal(rename("theirs", "small.csv.part"), 0);
  check_code(RUN("--csv", "-q", "-f", "-o", "small.h5", "small.nml"), 1);
  check_says(err, "'small.csv.part' was not left by a killed run");
  read_text("small.csv.part", text, sizeof text);
  assert_string_equal(text, "precious");
  write_text("small.csv.part", "# resonance: results as te");
  write_text("meant.csv", "");
  assert_int_equal(chmod("meant.csv", 0600), 0);
  assert_int_equal(symlink("meant.csv", "small.csv"), 0);
  check_code(RUN("--csv", "-q", "-f", "-o", "small.h5", "small.nml"), DONE);
  assert_int_equal(stat("meant.csv", &info), 0);
  assert_true(info.st_size > 1000 && (info.st_mode & 0777) == 0600);
  assert_int_equal(unlink("small.csv"), 0);
  check_code(RUN("--csv", "-q", "-f", "-o", "small.h5", "small.nml"), DONE);
  assert_true(exists("small.csv") && !exists("small.csv.part"));
}

/* Text gives back the very doubles of the HDF5 file, with their coordinates and errors beside
   them, for any number of threads; what is not ours is kept. */
static void test_text(void **state)
{
  enum { DAMPINGS = 2, PERIODS = 3, N = DAMPINGS * PERIODS };
  static const char header[] = "damping,drive_period,mean_loop_area,mean_loop_area_error,";
  static const double damping[] = { 0.1, 0.2 }, period[] = { 6.1, 7.3, 8.9 };
  static char one[TEXT_ROOM], two[TEXT_ROOM];
  double area[N], error[N], resonance[DAMPINGS];
  pendres_store *store = NULL;
  (void)state;
  write_text("r.nml", "&scene kind = 'response', title = 'two\tdampings' /\n"
                      "&pendulum drive_amplitude = 0.2 /\n"
                      "&sweep damping = 0.1, 0.2, drive_period = 6.1, 7.3, 8.9 /\n");
  write_text("two.csv", "precious");
  check_code(RUN("--csv", "-q", "-t", "2", "-o", "two.h5", "r.nml"), 2);
  check_says(err, "two.csv is there and is no table");
  check_code(RUN("--csv", "-q", "-t", "2", "-f", "-o", "two.h5", "r.nml"), DONE);
  for (int i = 0; i < 2; i++) /* over its own table without a word */
    check_code(RUN("--csv", "-q", "-t", "1", "-o", "one.h5", "r.nml"), DONE);
  read_text("one.csv", one, sizeof one);
  read_text("two.csv", two, sizeof two);
  assert_string_equal(one, two);
  check_says(one, "# title: two dampings\n");
  check_says(one, "# scene: response\n");
  check_says(one, "# drive_amplitude = 0.2\n");
  assert_null(strstr(one, "Z: resonance")); /* no date: the same bytes from run to run */
  check_says(one, "; 0 none, 1 unresolved,");
  assert_int_equal(count_names(".part"), 0);

  check_ok(pendres_store_open("one.h5", &store));
  check_ok(pendres_store_read(store, "", "mean_loop_area", PENDRES_STORE_DOUBLE, area, N));
  check_ok(pendres_store_read(store, "", "mean_loop_area_error", PENDRES_STORE_DOUBLE, error, N));
  check_ok(pendres_store_read(store, "", "resonance_period", PENDRES_STORE_DOUBLE, resonance,
                              DAMPINGS));
  pendres_store_free(store);
  for (int i = 0; i < N; i++) {
    check_near(cell("one.csv", header, i, 0), damping[i / PERIODS], 0.0);
    check_near(cell("one.csv", header, i, 1), period[i % PERIODS], 0.0);
    check_near(cell("one.csv", header, i, 2), area[i], 0.0);
    check_near(cell("one.csv", header, i, 3), error[i], 0.0);
  }
  for (int i = 0; i < DAMPINGS; i++)
    check_near(cell("one.damping.csv", "damping,resonance_period,", i, 1), resonance[i], 0.0);
}

/* What does not exist is NaN, and what the file holds as words are words. */
static void test_text_of_failures(void **state)
{
  static char text[TEXT_ROOM];
  (void)state;
  write_text("free.nml", "&scene kind = 'orbit' /\n"
                         "&pendulum drive_amplitude = 0, damping = 0, drive_frequency = 1 /\n"
                         "&orbit x = 1 /\n");
  check_code(RUN("-q", "--csv", "free.nml"), 3);
  read_text("free.csv", text, sizeof text);
  check_says(text, "# loop_area = NaN\n");
  write_text("up.nml", "&scene kind = 'hysteresis' /\n"
                       "&pendulum drive_amplitude = 0.2, damping = 0.2 /\n"
                       "&sweep drive_frequency = 0.5, 0.6 /\n"
                       "&hysteresis start = 'sa' /\n");
  check_code(RUN("-q", "--csv", "up.nml"), DONE);
  read_text("up.csv", text, sizeof text);
  check_says(text, "\ndirection,drive_frequency,");
  check_says(text, "\ndown,0.6,");
}

/* What a number is stands beside it. */
static void test_measures_are_defined(void **state)
{
  pendres_store *store = NULL;
  char *text = NULL;
  (void)state;
  check_code(RUN("-q", "orbit.nml"), DONE);
  assert_int_equal(pendres_store_open("orbit.h5", &store), PENDRES_OK);
  assert_int_equal(pendres_store_read_attribute_text(store, "", "x", "comment", &text), PENDRES_OK);
  check_says(text, "x - pi/2");
  free(text);
  assert_int_equal(pendres_store_read_attribute_text(store, "", "loop_area", "comment", &text),
                   PENDRES_OK);
  check_says(text, "closed integral of F dx");
  free(text);
  pendres_store_free(store);
}

/* Replaced are results of the same deck, which can be had again; all else keeps a name. */
static void test_results_are_kept(void **state)
{
  char text[20];
  (void)state;
  check_code(RUN("orbit.nml"), DONE);
  check_code(RUN("orbit.nml"), DONE);
  assert_int_equal(count_names(".h5"), 1);
  check_code(RUN("orbit.nml", "pendulum.damping=0.11"), DONE);
  check_says(err, "kept as ");
  check_text("orbit.h5.~1~", "provenance", "deck_resolved", "damping = 0.12\n");
  check_text("orbit.h5", "provenance", "deck_resolved", "damping = 0.11\n");
  write_text("orbit.h5", "precious");
  check_code(RUN("orbit.nml"), DONE);
  read_text("orbit.h5.~2~", text, sizeof text);
  assert_string_equal(text, "precious");
  assert_int_equal(count_names(".h5"), 3);
  check_code(RUN("--force", "small.nml", "scene.output=orbit.h5"), DONE);
  assert_int_equal(count_names(".h5"), 3);
  /* Nothing is renamed for results that do not come. */
  write_text("kept.h5", "precious");
  const char *const arguments[] = { "-o", "kept.h5", "orbit.nml", NULL };
  check_code(finish(start("stdout.txt", 2048, arguments)), 1);
  assert_int_equal(count_names("kept"), 1);
}

/* The file small.h5 of n bytes, with `size` of them at `place` turned over, becomes bad.h5. */
static void spoil(const char *bytes, size_t n, size_t place, size_t size)
{
  FILE *f = fopen("bad.h5", "wb");
  assert_non_null(f);
  for (size_t i = 0; i < n; i++)
    assert_true(fputc(bytes[i] ^ (i >= place && i < place + size ? 1 : 0), f) != EOF);
  assert_int_equal(fclose(f), 0);
}

static void check_damaged(const char *bytes, size_t n, size_t place, size_t size)
{
  spoil(bytes, n, place, size);
  check_code(RUN("--verify", "bad.h5"), 1);
  check_says(out, "bad.h5: ");
  assert_null(strstr(out, "whole"));
  assert_ptr_equal(strchr(out, '\n'), strrchr(out, '\n')); /* one line */
}

/* Where a number of the file stands: in a chunk that is not compressed, and in a header. */
static void test_verify(void **state)
{
  static char bytes[4 * TEXT_ROOM];
  pendres_store *store = NULL;
  static double numbers[600];
  const double scalar = 0.12345678901234567;
  (void)state;
  for (size_t i = 0; i < 600; i++) numbers[i] = 1.0 + 1e-3 * (double)i;
  check_code(RUN("-q", "orbit.nml"), DONE);
  check_code(RUN("--verify", "orbit.h5", "missing.h5", "orbit.nml"), 1);
  check_says(out, "orbit.h5: whole: ");
  check_says(out, "deck orbit.nml, resonance " PENDRES_VERSION "\n");
  check_says(out, "missing.h5: cannot be read: ");
  check_says(out, "orbit.nml: damaged, or no HDF5 file: ");
  check_code(RUN("--verify", "orbit.h5"), DONE);
  check_code(RUN("--verify"), 2);

  assert_int_equal(pendres_store_create("plain.h5", NULL, &store), PENDRES_OK);
  const pendres_store_spec one = { .name = "one", .long_name = "one" };
  const pendres_store_spec many = { .name = "many", .long_name = "many", .dimensions = { "x" },
                                    .deflate = -1 };
  assert_int_equal(pendres_store_dimension(
    store, &(pendres_store_spec){.name = "x", .long_name = "x"}, 600, NULL), PENDRES_OK);
  assert_int_equal(pendres_store_put(store, &one, &scalar, NULL, 1), PENDRES_OK);
  assert_int_equal(pendres_store_put(store, &many, numbers, NULL, 600), PENDRES_OK);
  const pendres_store_entry origin[] = { { .key = "deck_name", .text = "a.nml" },
                                         { .key = "version", .text = "7" } };
  assert_int_equal(pendres_store_provenance(store, origin, 2), PENDRES_OK);
  assert_int_equal(pendres_store_close(store), PENDRES_OK);
  pendres_store_free(store);
  check_code(RUN("--verify", "plain.h5"), DONE);
  FILE *f = fopen("plain.h5", "rb");
  assert_non_null(f);
  const size_t n = fread(bytes, 1, sizeof bytes, f);
  fclose(f);
  assert_true(n > 4800 && n < sizeof bytes);
  for (size_t i = 0; i + 8 <= n; i++) {
    if (memcmp(bytes + i, &scalar, 8) != 0 && memcmp(bytes + i, &numbers[300], 8) != 0) continue;
    for (size_t k = 0; k < 8; k++) check_damaged(bytes, n, i + k, 1);
  }
  /* Anything at all may be wrong: it is told, or does no harm, but nothing crashes. */
  for (size_t i = 0; i < n; i += n / 40) {
    spoil(bytes, n, i, 16);
    assert_in_range(RUN("--verify", "bad.h5"), 0, 1);
  }
  check_damaged(bytes, n - 1, 0, 0);
  check_damaged(bytes, n / 2, 0, 0);
  check_damaged(bytes, 0, 0, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    TEST(test_settings),       TEST(test_bad_settings),     TEST(test_several_decks),
    TEST(test_standard_input), TEST(test_results_are_kept), TEST(test_csv_is_no_hdf5),
    TEST(test_text_beside_others),
    TEST(test_text), TEST(test_text_of_failures),
    TEST(test_measures_are_defined), TEST(test_verify),
  };
  return find_program() ? cmocka_run_group_tests(tests, NULL, NULL) : 77;
}
