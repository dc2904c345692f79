/*
 * test_arguments_store.c -- every function of the store with arguments that are NULL, out of range
 * or out of an enum: they are refused, and the file is not damaged. See test_arguments.c.
 */
#define _XOPEN_SOURCE 700 /* mkdtemp */
#include "check.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <pendres/store.h>

/* Refused with some status, and no crash: which one is what test_store.c looks at. */
#define REFUSED(call) refused((call), #call, &wrong)

static void refused(pendres_status status, const char *call, int *wrong)
{
  if (status != PENDRES_OK) return;
  print_error("%s: accepted\n", call);
  ++*wrong;
}

static void no_store(void **state)
{
  int wrong = 0, id = 0, rank = 0;
  double number = 0.0;
  uint64_t sizes[PENDRES_STORE_RANK];
  char *text = NULL, why[100];
  pendres_store *none = NULL;
  const pendres_store_spec spec = { .name = "a", .long_name = "a" };
  const pendres_store_entry entry = { .key = "a", .text = "b" };
  const int64_t whole = 1;
  const char *const words[] = { "a" };
  (void)state;
  REFUSED(pendres_store_target(NULL, &text, why, sizeof why));
  REFUSED(pendres_store_target("a.h5", NULL, why, sizeof why));
  REFUSED(pendres_store_create(NULL, NULL, &none));
  pendres_store_free(none); /* what failed may still have its message */
  none = NULL;
  REFUSED(pendres_store_create("a.h5", NULL, NULL));
  REFUSED(pendres_store_open(NULL, &none));
  pendres_store_free(none);
  REFUSED(pendres_store_open("a.h5", NULL));
  REFUSED(pendres_store_close(NULL));
  pendres_store_drop_part(NULL);
  pendres_store_free(NULL);
  assert_non_null(pendres_store_message(NULL));
  REFUSED(pendres_store_flush(NULL));
  REFUSED(pendres_store_dimension(NULL, &(pendres_store_spec){.name = "x", .long_name = "x"}, 1,
                                  &number));
  REFUSED(pendres_store_dimension(
    NULL, &(pendres_store_spec){.name = "x", .type = PENDRES_STORE_INT64, .long_name = "x"}, 1,
    &whole));
  REFUSED(pendres_store_dimension(
    NULL, &(pendres_store_spec){.name = "x", .type = PENDRES_STORE_STRING, .long_name = "x"}, 1,
    words));
  REFUSED(pendres_store_variable(NULL, &spec, &id, NULL));
  REFUSED(pendres_store_variable(NULL, &spec, &id, &id));
  REFUSED(pendres_store_write(NULL, 0, &number, 1));
  REFUSED(pendres_store_write_rows(NULL, 0, 0, 1, &number, 1));
  REFUSED(pendres_store_put(NULL, &spec, &number, NULL, 1));
  REFUSED(pendres_store_put(NULL, &spec, &number, &number, 1));
  REFUSED(pendres_store_attribute(NULL, "", NULL, "a", "a"));
  REFUSED(pendres_store_attribute_number(NULL, "", NULL, "a", 1.0));
  REFUSED(pendres_store_provenance(NULL, &entry, 1));
  assert_false(pendres_store_has(NULL, "", "a"));
  REFUSED(pendres_store_shape(NULL, "", "a", &rank, sizes));
  REFUSED(pendres_store_member(NULL, "", 0, NULL, &text));
  REFUSED(pendres_store_dimension_of(NULL, "", "a", 0, &text));
  REFUSED(pendres_store_read(NULL, "", "a", PENDRES_STORE_DOUBLE, &number, 1));
  REFUSED(pendres_store_read_rows(NULL, &(pendres_store_spec){.name = "a"}, 0, 1, &number, 1));
  REFUSED(pendres_store_read_text(NULL, "", "a", 0, &text));
  REFUSED(pendres_store_read_attribute_text(NULL, "", NULL, "a", &text));
  REFUSED(pendres_store_read_attribute_double(NULL, "", NULL, "a", &number));
  REFUSED(pendres_store_verify(NULL, NULL));
  pendres_store_hdf5_version(NULL, NULL, NULL);
  assert_int_equal(wrong, 0);
}

static void written(pendres_store *s, int *count)
{
  int wrong = 0, id = -1;
  const double numbers[2] = { 1.0, 2.0 };
  const int64_t whole[2] = { 1, 2 };
  const pendres_store_spec good = { .name = "v", .dimensions = { "x" }, .long_name = "v" };
  pendres_store_spec bad[] = { good, good, good, good, good, good };
  const pendres_store_entry entries[] = { { .text = "no key" }, { .key = "bad/key", .text = "b" } };
  bad[0].name = NULL;
  bad[1].long_name = NULL;
  bad[2].type = (pendres_store_type)99;
  bad[3].dimensions[0] = "nowhere";
  bad[4].deflate = 99;
  bad[5].flag_count = 3;
  REFUSED(pendres_store_dimension(s, &(pendres_store_spec){.name = NULL, .long_name = "x"}, 2,
                                  numbers));
  REFUSED(pendres_store_dimension(
    s, &(pendres_store_spec){.name = NULL, .type = PENDRES_STORE_INT64, .long_name = "x"}, 2,
    whole));
  REFUSED(pendres_store_dimension(
    s, &(pendres_store_spec){.name = "w", .type = PENDRES_STORE_STRING, .long_name = "w"}, 2,
    NULL));
  REFUSED(pendres_store_dimension(s, NULL, 2, numbers));
  REFUSED(pendres_store_dimension(
    s, &(pendres_store_spec){.name = "w", .type = (pendres_store_type)99, .long_name = "w"}, 2,
    numbers));
  check_ok(pendres_store_dimension(s, &(pendres_store_spec){.name = "x", .long_name = "x"}, 2,
                                   numbers));
  REFUSED(pendres_store_variable(s, NULL, &id, NULL));
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    REFUSED(pendres_store_variable(s, &bad[i], &id, NULL));
    REFUSED(pendres_store_put(s, &bad[i], numbers, NULL, 2));
  }
  REFUSED(pendres_store_variable(s, NULL, &id, &id));
  REFUSED(pendres_store_put(s, NULL, numbers, NULL, 2));
  REFUSED(pendres_store_put(s, &good, NULL, NULL, 2));
  REFUSED(pendres_store_put(s, NULL, numbers, numbers, 2));
  check_ok(pendres_store_variable(s, &good, &id, NULL));
  REFUSED(pendres_store_write(s, -1, numbers, 2));
  REFUSED(pendres_store_write(s, INT_MAX, numbers, 2));
  REFUSED(pendres_store_write(s, id, NULL, 2));
  REFUSED(pendres_store_write(s, id, numbers, 1));
  REFUSED(pendres_store_write_rows(s, id, 2, 1, numbers, 1));
  REFUSED(pendres_store_write_rows(s, id, UINT64_MAX, 2, numbers, 2));
  REFUSED(pendres_store_write_rows(s, id, 0, 1, NULL, 1));
  REFUSED(pendres_store_attribute(s, "", NULL, NULL, "a"));
  REFUSED(pendres_store_attribute(s, "", NULL, "a", NULL));
  REFUSED(pendres_store_attribute_number(s, "", NULL, NULL, 1.0));
  REFUSED(pendres_store_attribute_number(s, "", "no_such", "a", 1.0));
  REFUSED(pendres_store_provenance(s, NULL, 1));
  REFUSED(pendres_store_provenance(s, &entries[0], 1));
  REFUSED(pendres_store_provenance(s, &entries[1], 1));
  check_ok(pendres_store_write(s, id, numbers, 2));
  *count += wrong;
}

static void read_back(pendres_store *s, int *count)
{
  int wrong = 0, rank = 0;
  uint64_t sizes[PENDRES_STORE_RANK];
  double numbers[2];
  char *text = NULL;
  assert_false(pendres_store_has(s, "", "nowhere"));
  assert_true(pendres_store_has(s, NULL, NULL)); /* the root is there */
  assert_true(pendres_store_has(s, "", "v"));
  REFUSED(pendres_store_shape(s, "", NULL, &rank, sizes));
  REFUSED(pendres_store_shape(s, "", "nowhere", &rank, sizes));
  REFUSED(pendres_store_member(s, "", 0, NULL, NULL));
  REFUSED(pendres_store_member(s, "", 99, NULL, &text));
  REFUSED(pendres_store_member(s, "nowhere", 0, NULL, &text));
  REFUSED(pendres_store_dimension_of(s, "", "v", 0, NULL));
  REFUSED(pendres_store_dimension_of(s, "", NULL, 0, &text));
  REFUSED(pendres_store_dimension_of(s, "", "v", -1, &text));
  REFUSED(pendres_store_dimension_of(s, "", "v", PENDRES_STORE_RANK, &text));
  REFUSED(pendres_store_read(s, "", NULL, PENDRES_STORE_DOUBLE, numbers, 2));
  REFUSED(pendres_store_read(s, "", "v", PENDRES_STORE_DOUBLE, NULL, 2));
  REFUSED(pendres_store_read(s, "", "v", PENDRES_STORE_DOUBLE, numbers, 1));
  REFUSED(pendres_store_read(s, "", "v", (pendres_store_type)99, numbers, 2));
  REFUSED(pendres_store_read_rows(s, NULL, 0, 1, numbers, 1));
  REFUSED(pendres_store_read_rows(s, &(pendres_store_spec){.name = "v"}, 2, 1, numbers, 1));
  REFUSED(pendres_store_read_rows(s, &(pendres_store_spec){.name = "v"}, UINT64_MAX, 2, numbers,
                                  2));
  REFUSED(pendres_store_read_rows(s, &(pendres_store_spec){.name = "v"}, 0, 1, NULL, 1));
  REFUSED(pendres_store_read_text(s, "", "v", 0, NULL));
  REFUSED(pendres_store_read_text(s, "", NULL, 0, &text));
  REFUSED(pendres_store_read_attribute_text(s, "", NULL, NULL, &text));
  REFUSED(pendres_store_read_attribute_text(s, "", NULL, "nothing", &text));
  REFUSED(pendres_store_read_attribute_double(s, "", NULL, NULL, numbers));
  REFUSED(pendres_store_read_attribute_double(s, "", NULL, "nothing", numbers));
  check_ok(pendres_store_read(s, "", "v", PENDRES_STORE_DOUBLE, numbers, 2));
  assert_true(numbers[0] == 1.0 && numbers[1] == 2.0);
  *count += wrong;
}

static void a_store(void **state)
{
  char folder[] = "/tmp/arguments-XXXXXX", path[100];
  int wrong = 0;
  pendres_store *s = NULL;
  (void)state;
  assert_non_null(mkdtemp(folder));
  (void)snprintf(path, sizeof path, "%s/a.h5", folder);
  check_ok(pendres_store_create(path, NULL, &s));
  written(s, &wrong);
  check_ok(pendres_store_close(s));
  pendres_store_free(s);
  check_ok(pendres_store_open(path, &s));
  read_back(s, &wrong);
  pendres_store_free(s);
  assert_int_equal(remove(path), 0);
  assert_int_equal(rmdir(folder), 0);
  assert_int_equal(wrong, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = { cmocka_unit_test(no_store), cmocka_unit_test(a_store) };
  return cmocka_run_group_tests_name("arguments_store", tests, NULL, NULL);
}
