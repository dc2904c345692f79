/*
 * test_large.c -- arrays of a run that are kept in a file if they are large: they are zero at first
 * and hold what is written, the file has no name, and one that cannot be made is an error with a
 * message. Bytes are compared, without tolerances.
 */
#include "driver_run.h"

#include "scenes/scene.h"

enum { SIZE = 1 << 20, LARGE = SCENE_MEMORY / SIZE + 1 };

static void holds(void **state)
{
  (void)state;
  deck *d = calloc(1, sizeof *d);
  assert_non_null(d);
  strcpy(d->output, "results.h5");
  scene_run run = {.deck = d};
  char *small = scene_large(&run, 3, SIZE), *large = scene_large(&run, LARGE, SIZE);
  const char *other = scene_array(&run, 3, SIZE);
  assert_true(small != NULL && large != NULL && other != NULL && scene_going(&run));
  assert_int_equal(count_names("resonance-"), 0);
  for (size_t i = 0; i < LARGE; i++) {
    assert_int_equal(large[i * SIZE], 0);
    memset(large + i * SIZE, (int)(i % 251), SIZE);
  }
  for (size_t i = 0; i < LARGE; i++) {
    assert_int_equal((unsigned char)large[i * SIZE], i % 251);
    assert_int_equal((unsigned char)large[(i + 1) * SIZE - 1], i % 251);
  }
  scene_room_end(&run.room);
  assert_null(run.room.held);
  free(d);
}

static void nowhere(void **state)
{
  (void)state;
  deck *d = calloc(1, sizeof *d);
  assert_non_null(d);
  strcpy(d->output, "absent/results.h5");
  scene_run run = {.deck = d};
  assert_non_null(scene_large(&run, 3, SIZE));
  assert_null(scene_large(&run, LARGE, SIZE));
  assert_int_equal(run.status, PENDRES_IO);
  check_says(run.message, "a temporary file, absent/.resonance-");
  check_says(run.message, "No such file or directory");
  assert_null(scene_large(&run, 3, SIZE)); /* nothing is done any more */
  scene_room_end(&run.room);
  free(d);
}

/* More than there can be is refused. */
static void endless(void **state)
{
  (void)state;
  scene_run run = {.deck = NULL};
  assert_null(scene_array(&run, SIZE_MAX / 8, 16));
  assert_int_equal(run.status, PENDRES_OUT_OF_MEMORY);
  scene_room_end(&run.room);
}

int main(void)
{
  const struct CMUnitTest tests[] = { TEST(holds), TEST(nowhere), TEST(endless) };
  (void)unsetenv("TMPDIR");
  if (!find_program()) return 77;
  return cmocka_run_group_tests(tests, NULL, NULL);
}
