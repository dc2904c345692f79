/* test_version.c -- version of the library; see pendres/version.h. */
#include <string.h>

#include <pendres/version.h>

#include "check.h"

static void test_version(void **state)
{
  char text[64];
  (void)state;
  assert_string_equal(pendres_version(), PENDRES_VERSION);
  snprintf(text, sizeof text, "%d.%d.%d", PENDRES_VERSION_MAJOR, PENDRES_VERSION_MINOR,
           PENDRES_VERSION_PATCH);
  assert_string_equal(text, PENDRES_VERSION);
}

/* One line with a number after each name. */
static void test_build_info(void **state)
{
  const char *const names[] = {"SUNDIALS ", "GSL ", "HDF5 "};
  const char *info = pendres_build_info();
  (void)state;
  assert_null(strchr(info, '\n'));
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    const char *at = strstr(info, names[i]);
    assert_non_null(at);
    assert_in_range(at[strlen(names[i])], '1', '9');
  }
  assert_ptr_equal(info, pendres_build_info());
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_version),
    cmocka_unit_test(test_build_info),
  };
  return cmocka_run_group_tests_name("version", tests, NULL, NULL);
}
