/* test_status.c -- codes and their messages; see pendres/status.h. */
#include <string.h>

#include <pendres/status.h>

#include "check.h"

static void test_zero_is_success(void **state)
{
  (void)state;
  assert_int_equal(PENDRES_OK, 0);
  assert_string_equal(pendres_status_message(PENDRES_OK), "success");
}

/* A message for each code, no two alike, fit to follow "error: " in a sentence. */
static void test_messages(void **state)
{
  (void)state;
  for (int i = 0; i < PENDRES_STATUS_COUNT; i++) {
    const char *message = pendres_status_message((pendres_status)i);
    assert_non_null(message);
    assert_true(strlen(message) >= 5);
    assert_null(strchr(message, '\n'));
    assert_int_not_equal(message[strlen(message) - 1], '.');
    assert_string_not_equal(message, "unknown status");
    for (int j = 0; j < i; j++)
      assert_string_not_equal(message, pendres_status_message((pendres_status)j));
  }
}

static void test_unknown_codes(void **state)
{
  const int unknown[] = {-1, PENDRES_STATUS_COUNT, PENDRES_STATUS_COUNT + 1, 1000000, -2147483647};
  (void)state;
  for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++)
    assert_string_equal(pendres_status_message((pendres_status)unknown[i]), "unknown status");
}

/* Programs store and compare them: codes may be added at the end alone. */
static void test_numbers(void **state)
{
  (void)state;
  assert_int_equal(PENDRES_INVALID_ARGUMENT, 1);
  assert_int_equal(PENDRES_OUT_OF_MEMORY, 2);
  assert_int_equal(PENDRES_INTEGRATION_FAILED, 3);
  assert_int_equal(PENDRES_TOLERANCE_UNREACHABLE, 4);
  assert_int_equal(PENDRES_NOT_CONVERGED, 5);
  assert_int_equal(PENDRES_NOT_FOUND, 6);
  assert_int_equal(PENDRES_UNRESOLVED, 7);
  assert_int_equal(PENDRES_INTERRUPTED, 8);
  assert_int_equal(PENDRES_IO, 9);
  assert_int_equal(PENDRES_UNSUPPORTED, 10);
  assert_int_equal(PENDRES_INTERNAL, 11);
  assert_int_equal(PENDRES_BUSY, 12);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_zero_is_success),
    cmocka_unit_test(test_messages),
    cmocka_unit_test(test_unknown_codes),
    cmocka_unit_test(test_numbers),
  };
  return cmocka_run_group_tests_name("status", tests, NULL, NULL);
}
