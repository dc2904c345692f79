/*
 * test_hard.c -- hard cases: what the scene hard_cases runs, a test a case. Where the bounds come
 * from is said in drivers/hard_*.c. Sanitizers get shorter runs.
 */
#include "check.h"

#include "hard_cases.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
static const double scale = 0.01;
#else
static const double scale = 0.1;
#endif

static void run_case(void **state)
{
  const hard_case *c = *state;
  hard_sheet sheet = { .scale = scale };
  size_t broken = 0;
  const pendres_status status = c->run(&sheet);
  if (status != PENDRES_OK) print_error("%s: %s\n", c->name, sheet.message);
  check_ok(status);
  for (size_t i = 0; i < sheet.count; i++) {
    const hard_row *row = &sheet.row[i];
    print_message("%-24s %9.2e <= %9.2e (naive %9.2e) %s\n", row->name, row->figure, row->bound,
                  row->naive, row->quantity);
    if (!hard_row_holds(row)) {
      print_error("%s is broken\n", row->name);
      broken++;
    }
  }
  assert_true(sheet.count > 0);
  assert_int_equal(broken, 0);
  hard_sheet_clear(&sheet);
}

int main(void)
{
#define HARD_CASE_TEST(name)                                                                      \
  { #name, run_case, NULL, NULL, (void *)(uintptr_t)hard_case_find(#name) },
  const struct CMUnitTest tests[] = { HARD_CASE_LIST(HARD_CASE_TEST) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
