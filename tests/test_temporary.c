/*
 * test_temporary.c -- arrays that are kept in a file if they are large: reading returns what was
 * written, the file has no name, and a full disk is an error with a message. Bytes are compared,
 * without tolerances.
 */
#include "driver_run.h"

#include "scenes/temporary.h"

enum { ELEMENTS = 1000, SIZE = 24 };

static void fill(char *element, size_t number)
{
  memset(element, (int)(number % 251), SIZE);
}

static void put_and_get(void **state)
{
  (void)state;
  deck *d = calloc(1, sizeof *d);
  assert_non_null(d);
  strcpy(d->output, "results.h5");
  for (int in_file = 0; in_file < 2; in_file++) {
    scene_run run = {.deck = d};
    scene_temporary s;
    char some[3 * SIZE], got[3 * SIZE], why[200];
    const size_t room = in_file ? ELEMENTS * SIZE - 1 : ELEMENTS * SIZE;
    check_ok(scene_temporary_create(&run, ELEMENTS, SIZE, room, &s));
    assert_int_equal(s.memory == NULL, in_file);
    assert_int_equal(count_names("resonance-"), 0);
    for (size_t i = ELEMENTS; i >= 3; i -= 3) { /* from the end on; the first one is never put */
      for (size_t k = 0; k < 3; k++) fill(some + k * SIZE, i - 3 + k);
      check_ok(scene_temporary_put(&run, &s, i - 3, 3, some));
    }
    for (size_t i = 1; i + 2 <= ELEMENTS; i++) {
      for (size_t k = 0; k < 2; k++) fill(some + k * SIZE, i + k);
      check_ok(scene_temporary_get(&s, i, 2, got, why, sizeof why));
      assert_memory_equal(got, some, 2 * SIZE);
    }
    if (in_file) {
      assert_int_equal(scene_temporary_get(&s, ELEMENTS, 1, got, why, sizeof why), PENDRES_IO);
      check_says(why, "the temporary file of results: ");
    }
    scene_temporary_free(&s);
    scene_temporary_free(&s);
  }
  free(d);
}

static void nowhere(void **state)
{
  (void)state;
  deck *d = calloc(1, sizeof *d);
  assert_non_null(d);
  strcpy(d->output, "absent/results.h5");
  scene_run run = {.deck = d};
  scene_temporary s;
  assert_int_equal(scene_temporary_create(&run, ELEMENTS, SIZE, 0, &s), PENDRES_IO);
  check_says(run.message, "a temporary file, absent/.resonance-");
  check_says(run.message, "No such file or directory");
  scene_temporary_free(&s);
  free(d);
}

int main(void)
{
  const struct CMUnitTest tests[] = { TEST(put_and_get), TEST(nowhere) };
  (void)unsetenv("TMPDIR");
  if (!find_program()) return 77;
  return cmocka_run_group_tests(tests, NULL, NULL);
}
