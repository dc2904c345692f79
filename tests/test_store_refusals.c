/*
 * test_store_refusals.c -- what a store refuses, and that a mistake leaves no trace.
 */
#include "store_files.h"

#include <sys/wait.h>

#include "store/internal.h"

/* ---- Refusals -------------------------------------------------------------------------------- */

/* The same file twice: once with every mistake in between. */
static void write_small(const char *path, void (*mistakes)(pendres_store *store, int id))
{
  const double values[2] = { 1, 2 };
  pendres_store *store = NULL;
  int id = -1;

  OK(pendres_store_create(path, NULL, &store));
  OK(pendres_store_dimension(
    store, &(pendres_store_spec){.group = "a", .name = "x", .long_name = "x"}, 2, values));
  OK(pendres_store_variable(store, &(pendres_store_spec){ .group = "a", .name = "y",
       .dimensions = { "x" }, .long_name = "y" }, &id, NULL));
  if (mistakes) mistakes(store, id);
  OK(pendres_store_write(store, id, values, 2));
  OK(pendres_store_close(store));
  pendres_store_free(store);
}

static void wrong_definitions(pendres_store *store, int id)
{
  const double values[4] = { 0 };
  const char *const odd[] = { "two words" };
  int made = 7, error_made = 7;
  pendres_store_spec spec = { .group = "a", .name = "z", .dimensions = { "x" },
                              .long_name = "z" };

#define SPEC(change, words)                                                                       \
  do {                                                                                            \
    pendres_store_spec kept = spec;                                                               \
    change;                                                                                       \
    REFUSED(pendres_store_variable(store, &spec, &made, NULL), words);                            \
    assert_int_equal(made, -1);                                                                   \
    spec = kept;                                                                                  \
  } while (0)
  SPEC(spec.name = "y", "exists already");
  SPEC(spec.name = "x", "exists already");
  SPEC(spec.name = NULL, "not a name");
  SPEC(spec.name = "", "not a name");
  SPEC(spec.name = "a/b", "not a name");
  SPEC(spec.name = "2z", "not a name");
  SPEC(spec.name = "\xc3\xa9", "not a name");
  SPEC(spec.long_name = NULL, "long_name");
  SPEC(spec.long_name = "", "long_name");
  SPEC(spec.dimensions[1] = "nowhere", "no dimension 'nowhere'");
  SPEC(spec.dimensions[1] = "x", "twice");
  SPEC(spec.dimensions[0] = "y", "no dimension 'y'");
  SPEC(spec.group = NULL, "no dimension 'x'"); /* that of another group does not count */
  SPEC(spec.group = "new", "no dimension 'x'");
  SPEC(spec.group = "a/y", "is a variable");
  SPEC(spec.group = "a/y/b", "is a variable");
  SPEC(spec.group = "a//b", "not a path");
  SPEC(spec.group = "a b", "not a path");
  SPEC(spec.type = PENDRES_STORE_TYPE_COUNT, "type");
  SPEC(spec.deflate = 10, "deflate");
  SPEC(spec.deflate = -2, "deflate");
  SPEC((spec.flag_count = 1, spec.flag_meanings = odd), "int8");
  spec.type = PENDRES_STORE_INT8;
  SPEC((spec.flag_count = 1, spec.flag_meanings = odd), "two words");
  SPEC(spec.flag_count = 1, "meaning");
  SPEC(spec.flag_count = 129, "flags");
#undef SPEC
  REFUSED(pendres_store_variable(store, NULL, &made, NULL), "no specification");
  spec.type = PENDRES_STORE_STRING;
  REFUSED(pendres_store_variable(store, &spec, &made, &error_made), "no error estimate");
  assert_int_equal(error_made, -1);
  REFUSED(pendres_store_put(store, &(pendres_store_spec){ .group = "a", .name = "y",
            .dimensions = { "x" }, .long_name = "y" }, values, NULL, 2), "exists already");
  REFUSED(pendres_store_dimension(
    store, &(pendres_store_spec){.group = "a", .name = "x", .long_name = "x"}, 3,
    NULL), "exists already");
  REFUSED(pendres_store_dimension(
    store, &(pendres_store_spec){.group = "a", .name = "y", .long_name = "x"}, 3,
    NULL), "exists already");
  REFUSED(pendres_store_dimension(store, &(pendres_store_spec){.name = "a", .long_name = "x"}, 3,
                                  NULL), "exists already");
  REFUSED(pendres_store_dimension(
    store, &(pendres_store_spec){.group = "a", .name = "w", .long_name = "w"}, UINT64_MAX / 2,
    NULL), "too large");
  REFUSED(pendres_store_dimension(
    store, &(pendres_store_spec){.group = "a", .name = "w", .long_name = NULL}, 3,
    NULL), "long_name");
  REFUSED(pendres_store_dimension(
    store,
    &(pendres_store_spec){.group = "a", .name = "w", .type = PENDRES_STORE_STRING,
                          .long_name = "w"}, 3, NULL), "no names");
  REFUSED(pendres_store_group(store, "a/x"), "is a variable");
  REFUSED(pendres_store_group(store, "a/."), "not a path");
  (void)id;
}

static void wrong_values(pendres_store *store, int id)
{
  const double values[4] = { 0 };

  REFUSED(pendres_store_write(store, id, values, 1), "2 elements are wanted, 1");
  REFUSED(pendres_store_write(store, id, values, 4), "2 elements are wanted, 4");
  REFUSED(pendres_store_write(store, id, NULL, 2), "no data");
  REFUSED(pendres_store_write(store, -1, values, 2), "no variable number -1");
  REFUSED(pendres_store_write(store, 1000, values, 2), "no variable number 1000");
  REFUSED(pendres_store_write(store, 0, values, 0), "no variable number 0"); /* the root */
  REFUSED(pendres_store_write_rows(store, id, 1, 2, values, 2), "2 rows");
  REFUSED(pendres_store_write_rows(store, id, 3, 0, values, 0), "2 rows");
  REFUSED(pendres_store_write_rows(store, id, 1, UINT64_MAX, values, 0), "2 rows");
  REFUSED(pendres_store_write_rows(store, id, 0, 1, values, 2), "1 elements are wanted, 2");
  REFUSED(pendres_store_attribute(store, "a", "y", "two words", "x"), "not a name");
  REFUSED(pendres_store_attribute(store, "a", "y", "note", NULL), "needs a text");
}

static void mistakes_leave_no_trace(void **state)
{
  char clean[PATH_ROOM], mistaken[PATH_ROOM];

  (void)state;
  write_small(in_folder(clean, "clean.h5"), NULL);
  write_small(in_folder(mistaken, "definitions.h5"), wrong_definitions);
  check_same_bytes(clean, mistaken);
  write_small(in_folder(mistaken, "values.h5"), wrong_values);
  check_same_bytes(clean, mistaken);
}

/* Half a result is no result: the name of its error was taken. */
static void result_is_made_whole_or_not(void **state)
{
  char path[PATH_ROOM];
  pendres_store *store = NULL;
  const pendres_store_spec taken = { .name = "power_error", .long_name = "taken" };
  const pendres_store_spec power = { .name = "power", .long_name = "power" };
  const double value = 1;
  int error_id, id = -1;

  (void)state;
  OK(pendres_store_create(in_folder(path, "half.h5"), NULL, &store));
  OK(pendres_store_put(store, &taken, &value, NULL, 1));
  REFUSED(pendres_store_variable(store, &power, &id, &error_id), "power_error");
  assert_int_equal(pendres_store_has(store, NULL, "power"), 0);
  OK(pendres_store_put(store, &power, &value, NULL, 1));
  pendres_store_free(store);
}

static void wrong_handles(void **state)
{
  char path[PATH_ROOM], *text = NULL;
  pendres_store *store = NULL;
  double value = 0;

  (void)state;
  assert_int_equal(pendres_store_create("x.h5", NULL, NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_store_open("x.h5", NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_store_group(NULL, "a"), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_store_write(NULL, 0, &value, 1), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_store_close(NULL), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_store_abandon(NULL, 0), PENDRES_INVALID_ARGUMENT);
  assert_int_equal(pendres_store_has(NULL, "a", NULL), 0);
  assert_non_null(pendres_store_message(NULL));
  pendres_store_free(NULL);
  REFUSED(pendres_store_create(NULL, NULL, &store), "path");
  pendres_store_free(store);
  REFUSED(pendres_store_create("", NULL, &store), "path");
  REFUSED(pendres_store_group(store, "a"), "path"); /* the first failure stays */
  pendres_store_free(store);

  OK(pendres_store_create(in_folder(path, "closed.h5"), NULL, &store));
  OK(pendres_store_close(store));
  REFUSED(pendres_store_close(store), "closed");
  REFUSED(pendres_store_group(store, "a"), "closed");
  REFUSED(pendres_store_write(store, 0, &value, 1), "closed");
  OK(pendres_store_abandon(store, 0));
  pendres_store_free(store);
  assert_true(exists(path));

  OK(pendres_store_open(path, &store));
  REFUSED(pendres_store_group(store, "a"), "reading only");
  REFUSED(pendres_store_close(store), "reading only");
  MISSING(pendres_store_read(store, "", "y", PENDRES_STORE_DOUBLE, &value, 1), "no 'y'");
  MISSING(pendres_store_read(store, "a/b", "y", PENDRES_STORE_DOUBLE, &value, 1), "a/b/y");
  REFUSED(pendres_store_read(store, "", "y", PENDRES_STORE_STRING, &value, 1), "numbers");
  MISSING(pendres_store_read_attribute_text(store, "", NULL, "title", &text), "title");
  assert_null(text);
  pendres_store_free(store);

  write_small(in_folder(path, "small.h5"), NULL);
  OK(pendres_store_open(path, &store));
  REFUSED(pendres_store_read(store, "a", "y", PENDRES_STORE_DOUBLE, &value, 1), "2 elements");
  REFUSED(pendres_store_read_rows(store, &(pendres_store_spec){.group = "a", .name = "y"}, 2, 1,
                                  &value, 1), "rows");
  REFUSED(pendres_store_read_text(store, "a", "y", 2, &text), "no text number 2");
  /* A number is not a text, nor a group a variable. */
  assert_int_equal(pendres_store_read_text(store, "a", "y", 0, &text), PENDRES_IO);
  assert_int_equal(pendres_store_read(store, "", "a", PENDRES_STORE_DOUBLE, &value, 1),
                   PENDRES_IO);
  assert_int_equal(pendres_store_read_attribute_double(store, "a", "y", "units", &value),
                   PENDRES_IO);
  OK(pendres_store_read_rows(store, &(pendres_store_spec){.group = "a", .name = "y"}, 1, 1, &value,
                             1));
  pendres_store_free(store);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    TEST(mistakes_leave_no_trace),
    TEST(result_is_made_whole_or_not),
    TEST(wrong_handles),
  };

  return cmocka_run_group_tests_name("store_refusals", tests, make_folder, remove_folder);
}
