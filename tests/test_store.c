/*
 * test_store.c -- result files are self-describing, and equal for equal input; mistakes of the
 * caller are refused and leave no trace. (What disks and other processes do: test_store_failure.c.)
 *
 * Values are compared exactly: a store must give back the bits it was given.
 */
#include "store_files.h"

#include <sys/wait.h>

#include "store/internal.h"

/* ---- A file with one of everything ----------------------------------------------------------- */

enum { DAMPINGS = 3, PERIODS = 700, WIDE = 300000 };

static const double damping[DAMPINGS] = { 0.06, 0.1 + 0.2, 1.0 };
static const char *const meanings[] = { "sa", "la", "unresolved" };
static const int8_t codes[] = { 0, 1, -1 };
static const char *const methods[] = { "block_fixed", "gsl_rk8pd" };

static double area(size_t i)
{
  return sin(0.37 * (double)i) / 3;
}

static void write_root(pendres_store *store)
{
  const double scalar = 1.0 / 3, scalar_error = 1e-9;
  double *areas = malloc(DAMPINGS * PERIODS * sizeof *areas);
  double *errors = malloc(DAMPINGS * PERIODS * sizeof *errors);
  int8_t labels[DAMPINGS] = { 1, 0, -1 };
  int id = -1, error_id = -1;
  const pendres_store_spec loop_area = { .name = "mean_loop_area", .units = "1",
    .dimensions = { "damping", "drive_period" }, .long_name = "mean area of the loops",
    .coordinates = "drive_frequency", .comment = "a comment" };

  assert_non_null(areas);
  assert_non_null(errors);
  for (size_t i = 0; i < DAMPINGS * PERIODS; i++) {
    areas[i] = i == 5 ? NAN : area(i);
    errors[i] = 1e-9 * (double)i;
  }
  OK(pendres_store_dimension(
    store, &(pendres_store_spec){.name = "damping", .long_name = "damping"}, DAMPINGS, damping));
  OK(pendres_store_dimension(
    store,
    &(pendres_store_spec){.group = "/", .name = "drive_period",
                          .long_name = "number of the period"}, PERIODS, NULL));
  OK(pendres_store_dimension(
    store,
    &(pendres_store_spec){.name = "method", .type = PENDRES_STORE_STRING, .long_name = "method"}, 2,
    methods));
  OK(pendres_store_variable(store, &loop_area, &id, &error_id));
  /* Rows in any order, some twice. */
  for (uint64_t r = DAMPINGS; r-- > 0;) {
    OK(pendres_store_write_rows(store, id, r, 1, areas + r * PERIODS, PERIODS));
    OK(pendres_store_write_rows(store, id, r, 1, areas + r * PERIODS, PERIODS));
  }
  OK(pendres_store_write(store, error_id, errors, DAMPINGS * PERIODS));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "cusp_damping",
       .long_name = "damping at the cusp" }, &scalar, &scalar_error, 1));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "label", .type = PENDRES_STORE_INT8,
       .dimensions = { "damping" }, .long_name = "attractor", .flag_count = LENGTH(meanings),
       .flag_values = codes, .flag_meanings = meanings }, labels, NULL, DAMPINGS));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "method_title",
       .type = PENDRES_STORE_STRING, .dimensions = { "method" }, .long_name = "title" },
       methods, NULL, 2));
  free(areas);
  free(errors);
}

/* Groups of groups, a dimension without points, an axis of its own beside the root's. */
static void write_groups(pendres_store *store)
{
  const int64_t index[] = { -5, 0, INT64_MAX };
  const int32_t turns[] = { INT32_MIN, 7, 0 };
  const double none = 0;
  int id = -1;

  OK(pendres_store_group(store, "paper"));
  OK(pendres_store_group(store, "paper"));
  OK(pendres_store_dimension(
    store,
    &(pendres_store_spec){.group = "paper/fig2", .name = "point", .type = PENDRES_STORE_INT64,
                          .long_name = "point"}, 3, index));
  OK(pendres_store_put(store, &(pendres_store_spec){ .group = "/paper/fig2/", .name = "turns",
       .type = PENDRES_STORE_INT32, .dimensions = { "point" }, .long_name = "turns" }, turns, NULL,
       3));
  OK(pendres_store_dimension(
    store, &(pendres_store_spec){.group = "paper", .name = "damping", .long_name = "damping"},
    DAMPINGS, damping));
  OK(pendres_store_dimension(
    store, &(pendres_store_spec){.group = "paper", .name = "fold", .long_name = "fold"}, 0, NULL));
  OK(pendres_store_variable(store, &(pendres_store_spec){ .group = "paper",
       .name = "fold_damping", .dimensions = { "damping", "fold" },
       .long_name = "damping of the fold" }, &id, NULL));
  OK(pendres_store_write(store, id, &none, 0));
}

/* One variable whose rows are longer than a chunk may be, one of many short rows. */
static void write_large(pendres_store *store)
{
  double *wide = malloc(2 * WIDE * sizeof *wide);
  int64_t *tall = malloc(WIDE * sizeof *tall);

  assert_non_null(wide);
  assert_non_null(tall);
  for (size_t i = 0; i < 2 * WIDE; i++) wide[i] = (double)(i / 1000);
  for (size_t i = 0; i < WIDE; i++) tall[i] = (int64_t)(i / 100);
  OK(pendres_store_dimension(
    store, &(pendres_store_spec){.group = "large", .name = "side", .long_name = "side"}, 2, NULL));
  OK(pendres_store_dimension(
    store, &(pendres_store_spec){.group = "large", .name = "sample", .long_name = "sample"}, WIDE,
    NULL));
  OK(pendres_store_put(store, &(pendres_store_spec){ .group = "large", .name = "wide",
       .dimensions = { "side", "sample" }, .long_name = "wide" }, wide, NULL, 2 * WIDE));
  OK(pendres_store_put(store, &(pendres_store_spec){ .group = "large", .name = "tall",
       .type = PENDRES_STORE_INT64, .dimensions = { "sample" }, .long_name = "tall" },
       tall, NULL, WIDE));
  free(wide);
  free(tall);
}

static void write_provenance_entries(pendres_store *store)
{
  const pendres_store_entry entries[] = {
    { .key = "deck", .text = "&scene\n  title = 'caf\xe9 \xc3\xa9'\n/\n" },
    { .key = "wall_time", .number = 1.5, .units = "s", .long_name = "time of the run" },
    { .key = "seed", .integer = -42, .is_integer = 1 },
  };

  OK(pendres_store_provenance(store, entries, LENGTH(entries)));
}

static void write_provenance(pendres_store *store)
{
  write_provenance_entries(store);
  OK(pendres_store_attribute(store, NULL, NULL, "title", "a better title"));
}

/* What GNU Octave can load: text in groups alone. */
static void write_numbers(const char *path)
{
  const char *const names[] = { "one", "\xce\xb3 two", "" };
  const double corner[] = { 1, NAN, 3, -4e-300, 5, 1.0 / 3 };
  const int8_t labels[] = { 0, 1, -1 };
  const double number = 0.1;
  pendres_store *store = NULL;

  OK(pendres_store_create(path, &(pendres_store_options){ .title = "numbers" }, &store));
  OK(pendres_store_dimension(store, &(pendres_store_spec){.name = "row", .long_name = "row"}, 2,
                             NULL));
  OK(pendres_store_dimension(store, &(pendres_store_spec){.name = "turn", .long_name = "turn"}, 3,
                             corner));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "area", .long_name = "area",
       .dimensions = { "row", "turn" } }, corner, NULL, 6));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "damping", .long_name = "damping" },
       &number, NULL, 1));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "state", .dimensions = { "turn" },
       .type = PENDRES_STORE_INT8, .long_name = "state" }, labels, NULL, 3));
  OK(pendres_store_dimension(
    store,
    &(pendres_store_spec){.group = "paper/f02", .name = "quantity", .type = PENDRES_STORE_STRING,
                          .long_name = "quantity"}, 3, names));
  OK(pendres_store_dimension(
    store,
    &(pendres_store_spec){.group = "paper", .name = "quantity", .type = PENDRES_STORE_STRING,
                          .long_name = "quantity"}, 3, names));
  write_provenance_entries(store);
  OK(pendres_store_close(store));
  pendres_store_free(store);
}

static void write_all(const char *path)
{
  pendres_store *store = NULL;

  OK(pendres_store_create(path, &(pendres_store_options){ .title = "a title", .source = "test",
       .history = "made by a test", .references = "none" }, &store));
  write_root(store);
  write_groups(store);
  write_large(store);
  write_provenance(store);
  OK(pendres_store_flush(store));
  OK(pendres_store_close(store));
  assert_string_equal(pendres_store_message(store), "");
  pendres_store_free(store);
}

static void check_text(pendres_store *store, const char *group, const char *object,
                       const char *attribute, const char *wanted)
{
  char *text = NULL;

  if (attribute)
    OK(pendres_store_read_attribute_text(store, group, object, attribute, &text));
  else
    OK(pendres_store_read_text(store, group, object, 0, &text));
  assert_string_equal(text, wanted);
  free(text);
}

/* Each once, in the order in which they were made, with its type. */
static void check_members(pendres_store *store)
{
  pendres_store_type type = PENDRES_STORE_TYPE_COUNT;
  char *name = NULL;
  uint64_t count = 0;
  int found = 0;

  while (pendres_store_member(store, "", count, &type, &name) == PENDRES_OK) {
    assert_true(pendres_store_has(store, "", name));
    if (count == 0) assert_string_equal(name, "damping");
    if (!strcmp(name, "label")) found += type == PENDRES_STORE_INT8;
    if (!strcmp(name, "method_title")) found += type == PENDRES_STORE_STRING;
    if (!strcmp(name, "mean_loop_area_error")) found += type == PENDRES_STORE_DOUBLE;
    if (!strcmp(name, "paper")) found += type == PENDRES_STORE_TYPE_COUNT;
    free(name);
    count++;
  }
  assert_int_equal(found, 4);
  assert_null(name);
  OK(pendres_store_member(store, "paper/fig2", 1, NULL, &name));
  assert_string_equal(name, "turns");
  free(name);
}

static void what_is_written_is_read(void **state)
{
  char path[PATH_ROOM], part[PATH_ROOM];
  static double areas[DAMPINGS * PERIODS];
  int64_t index[PERIODS];
  int32_t turns[3];
  int8_t labels[DAMPINGS];
  double number = 0, rows[DAMPINGS];
  uint64_t sizes[PENDRES_STORE_RANK];
  int rank = -1;
  char *text = NULL;
  pendres_store *store = NULL;

  (void)state;
  write_all(in_folder(path, "all.h5"));
  assert_false(exists(in_folder(part, "all.h5.part")));

  OK(pendres_store_open(path, &store));
  OK(pendres_store_shape(store, "", "mean_loop_area_error", &rank, sizes));
  assert_int_equal(rank, 2);
  assert_int_equal(sizes[0], DAMPINGS);
  assert_int_equal(sizes[1], PERIODS);
  assert_int_equal(sizes[2], 1);
  OK(pendres_store_dimension_of(store, "", "mean_loop_area_error", 1, &text));
  assert_string_equal(text, "drive_period");
  free(text);
  OK(pendres_store_dimension_of(store, "", "damping", 0, &text)); /* itself */
  assert_string_equal(text, "damping");
  free(text);
  check_members(store);
  OK(pendres_store_read(store, "", "mean_loop_area", PENDRES_STORE_DOUBLE, areas, LENGTH(areas)));
  for (size_t i = 0; i < LENGTH(areas); i++)
    assert_true(i == 5 ? isnan(areas[i]) : areas[i] == area(i));
  OK(pendres_store_read_rows(store, &(pendres_store_spec){.name = "mean_loop_area_error"}, 2, 1,
                             areas, PERIODS));
  assert_true(areas[3] == 1e-9 * (2 * PERIODS + 3));
  OK(pendres_store_read(store, "", "damping", PENDRES_STORE_DOUBLE, rows, DAMPINGS));
  assert_memory_equal(rows, damping, sizeof damping);
  OK(pendres_store_read(store, "", "drive_period", PENDRES_STORE_INT64, index, PERIODS));
  for (int i = 0; i < PERIODS; i++) assert_int_equal(index[i], i);
  OK(pendres_store_read(store, "", "label", PENDRES_STORE_INT8, labels, DAMPINGS));
  assert_int_equal(labels[0], 1);
  assert_int_equal(labels[2], -1);
  OK(pendres_store_read(store, "", "label", PENDRES_STORE_DOUBLE, rows, DAMPINGS));
  assert_true(rows[2] == -1); /* numbers are converted */
  OK(pendres_store_read(store, "", "cusp_damping", PENDRES_STORE_DOUBLE, &number, 1));
  assert_true(number == 1.0 / 3);
  OK(pendres_store_read(store, "paper/fig2", "turns", PENDRES_STORE_INT32, turns, 3));
  assert_int_equal(turns[0], INT32_MIN);
  OK(pendres_store_read(store, "paper/fig2", "point", PENDRES_STORE_INT64, index, 3));
  assert_true(index[2] == INT64_MAX);
  OK(pendres_store_read(store, "paper", "fold_damping", PENDRES_STORE_DOUBLE, NULL, 0));
  REFUSED(pendres_store_read(store, "large", "wide", PENDRES_STORE_DOUBLE, NULL, 0), "room for");
  OK(pendres_store_read_text(store, "", "method_title", 1, &text));
  assert_string_equal(text, "gsl_rk8pd");
  free(text);
  check_text(store, "", "cusp_damping_error", "long_name", "error estimate of damping at the cusp");
  check_text(store, "", "cusp_damping", "ancillary_variables", "cusp_damping_error");
  check_text(store, "", "cusp_damping", "units", "1");
  check_text(store, "", "label", "flag_meanings", "sa la unresolved");
  check_text(store, "", "mean_loop_area", "coordinates", "drive_frequency");
  check_text(store, "", NULL, "Conventions", "CF-1.8");
  check_text(store, "", NULL, "title", "a better title"); /* replaced */
  check_text(store, "provenance", "wall_time", "units", "s");
  /* The stray Latin-1 byte became UTF-8, the UTF-8 beside it stayed. */
  check_text(store, "provenance", "deck", NULL,
             "&scene\n  title = 'caf\xc3\xa9 \xc3\xa9'\n/\n");
  OK(pendres_store_read(store, "provenance", "seed", PENDRES_STORE_INT64, index, 1));
  assert_int_equal(index[0], -42);
  assert_int_equal(pendres_store_has(store, "paper", "turns"), 0);
  assert_int_equal(pendres_store_has(store, "paper/fig2", "turns"), 1);
  assert_int_equal(pendres_store_has(store, "paper/fig2", NULL), 1);
  assert_int_equal(pendres_store_has(store, "no/such/group", "turns"), 0);
  pendres_store_free(store);
}

static void large_arrays_are_read_and_compressed(void **state)
{
  char path[PATH_ROOM];
  double *wide = malloc(2 * WIDE * sizeof *wide);
  int64_t *tall = malloc(WIDE * sizeof *tall);
  hsize_t chunk[2];
  hid_t id, creation;
  pendres_store *store = NULL;

  (void)state;
  assert_non_null(wide);
  assert_non_null(tall);
  write_all(in_folder(path, "all.h5"));
  OK(pendres_store_open(path, &store));
  OK(pendres_store_read(store, "large", "wide", PENDRES_STORE_DOUBLE, wide, 2 * WIDE));
  for (size_t i = 0; i < 2 * WIDE; i++) assert_true(wide[i] == (double)(i / 1000));
  OK(pendres_store_read(store, "large", "tall", PENDRES_STORE_INT64, tall, WIDE));
  for (size_t i = 0; i < WIDE; i++) assert_true(tall[i] == (int64_t)(i / 100));

  id = H5Dopen2(store->h5, "large/wide", H5P_DEFAULT);
  creation = H5Dget_create_plist(id);
  assert_int_equal(H5Pget_chunk(creation, 2, chunk), 2);
  assert_int_equal(chunk[0], 1);
  assert_true(chunk[1] * sizeof(double) <= 1024 * 1024);
  assert_int_equal(H5Pget_nfilters(creation), 2); /* shuffle, deflate */
  /* Steps of 1000 equal numbers: anything above a tenth would mean that no filter ran. */
  assert_true(H5Dget_storage_size(id) < 2 * WIDE * sizeof(double) / 10);
  H5Pclose(creation);
  H5Dclose(id);

  id = H5Dopen2(store->h5, "mean_loop_area", H5P_DEFAULT);
  creation = H5Dget_create_plist(id);
  assert_int_equal(H5Pget_chunk(creation, 2, chunk), 2);
  assert_int_equal(chunk[1], PERIODS); /* whole rows */
  H5Pclose(creation);
  H5Dclose(id);
  pendres_store_free(store);
  free(wide);
  free(tall);
}

static void equal_runs_give_equal_bytes(void **state)
{
  char one[PATH_ROOM], other[PATH_ROOM];

  (void)state;
  write_all(in_folder(one, "one.h5"));
  sleep(1); /* past the next tick of a time stamp, if there were any */
  write_all(in_folder(other, "other.h5"));
  check_same_bytes(one, other);
}

/* Readers by h5py, xarray, HDF5, Octave and R, where they are installed; $PYTHON names Python. */
static void readers_open_every_group(void **state)
{
  const char *const pythons[] = { getenv("PYTHON"), "python3", "/usr/bin/python3" };
  char path[PATH_ROOM], numbers[PATH_ROOM], command[4 * PATH_ROOM];
  int result = 77;

  (void)state;
  write_all(in_folder(path, "all.h5"));
  write_numbers(in_folder(numbers, "numbers.h5"));
  for (size_t i = 0; i < LENGTH(pythons) && result != 0; i++) {
    int code;

    if (!pythons[i]) continue;
    snprintf(command, sizeof command, "%.200s tests/store_readers.py %s %s", pythons[i], path,
             numbers);
    code = system(command);
    if (WIFEXITED(code) && WEXITSTATUS(code) == 127) continue; /* no such program */
    result = WIFEXITED(code) ? WEXITSTATUS(code) : -1;
    if (result != 77) break;
  }
  if (result == 77) skip();
  assert_int_equal(result, 0);
}

/* ---- Refusals -------------------------------------------------------------------------------- */

/* Sums of bits: each is looked at by its own bit, and that there is none by all of them. */
static void bits_have_masks(void **state)
{
  static const int8_t values[] = { 0, 1, 4 }, wanted[] = { 5, 1, 4 }, sum = 5;
  static const char *const meanings[] = { "none", "one", "four" };
  const pendres_store_spec spec = { .name = "sums", .type = PENDRES_STORE_INT8,
                                    .long_name = "sums", .flag_count = 3, .flag_values = values,
                                    .flag_meanings = meanings, .flag_bits = 1 };
  char path[PATH_ROOM];
  int8_t found[3] = { 0 };
  pendres_store *store = NULL;
  (void)state;
  in_folder(path, "bits.h5");
  OK(pendres_store_create(path, NULL, &store));
  OK(pendres_store_put(store, &spec, &sum, NULL, 1));
  OK(pendres_store_close(store));
  pendres_store_free(store);
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t masks = H5Aopen_by_name(file, "sums", "flag_masks", H5P_DEFAULT, H5P_DEFAULT);
  assert_true(masks >= 0 && H5Aread(masks, H5T_NATIVE_INT8, found) >= 0);
  assert_memory_equal(found, wanted, sizeof wanted);
  H5Aclose(masks);
  H5Fclose(file);
}

static void text_becomes_utf8(void **state)
{
  const char *const texts[][2] = {
    { "", "" },
    { "plain", "plain" },
    { "\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80", "\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80" },
    { "1\xb0", "1\xc2\xb0" },                         /* a degree sign in Latin-1 */
    { "\xe2\x82", "\xc3\xa2\xc2\x82" },               /* cut off */
    { "\xc0\x80", "\xc3\x80\xc2\x80" },               /* zero, written too long */
    { "\xed\xa0\x80", "\xc3\xad\xc2\xa0\xc2\x80" },   /* half of a pair of surrogates */
    { "\xf4\x90\x80\x80", "\xc3\xb4\xc2\x90\xc2\x80\xc2\x80" }, /* beyond U+10FFFF */
    { "\xff", "\xc3\xbf" },
  };

  (void)state;
  for (size_t i = 0; i < LENGTH(texts); i++) {
    char *text = pendres_store_utf8(texts[i][0]);

    assert_string_equal(text, texts[i][1]);
    free(text);
  }
}

static void version_is_that_of_the_library(void **state)
{
  unsigned major = 0, minor = 0, release = 0;

  (void)state;
  pendres_store_hdf5_version(&major, &minor, &release);
  assert_int_equal(major, H5_VERS_MAJOR);
  assert_int_equal(minor, H5_VERS_MINOR);
  pendres_store_hdf5_version(NULL, NULL, NULL);
  (void)release;
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    TEST(what_is_written_is_read),
    TEST(large_arrays_are_read_and_compressed),
    TEST(equal_runs_give_equal_bytes),
    TEST(readers_open_every_group),
    TEST(bits_have_masks),
    TEST(text_becomes_utf8),
    TEST(version_is_that_of_the_library),
  };

  return cmocka_run_group_tests_name("store", tests, make_folder, remove_folder);
}
