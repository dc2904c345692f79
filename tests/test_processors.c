/*
 * test_processors.c -- threads on machines with more processors than a cpu_set_t has room for. The
 * system's answer is made up.
 */
#define _GNU_SOURCE /* sched_getaffinity */
#include "check.h"

#include <errno.h>
#include <sched.h>

#include "farm/farm.h"

static int processors = 1;

/* In the place of the C library's. */
int sched_getaffinity(pid_t process, size_t size, cpu_set_t *set)
{
  (void)process;
  if (8 * size < (size_t)processors) {
    errno = EINVAL;
    return -1;
  }
  CPU_ZERO_S(size, set);
  for (int i = 0; i < processors; i++) CPU_SET_S((size_t)i, size, set);
  return 0;
}

/* Unless told, a farm has a thread for each processor that it may use, up to a bound. */
static void each_has_a_thread(void **state)
{
  static const int many[] = {3, 1024, 1500, 10000};
  (void)state;
  for (size_t k = 0; k < sizeof many / sizeof *many; k++) {
    farm *f = NULL;
    processors = many[k];
    check_ok(farm_create(&(farm_options){ .threads = 0 }, &f));
    assert_int_equal(farm_threads(f), many[k] < FARM_MOST_THREADS ? many[k] : FARM_MOST_THREADS);
    farm_free(f);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(each_has_a_thread),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
