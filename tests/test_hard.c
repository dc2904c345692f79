/*
 * test_hard.c -- the cases of the scene hard_cases, one test each. Their bounds are derived in
 * validation/hard_*.c. With sanitizers the runs are shorter.
 */
#include "check.h"

#include <string.h>

#include "validation/hard_cases.h"

static const double scale = CHECK_SHORT ? 0.01 : 0.1;

/* Rows by the beginnings of their names where the naive way must do worse than ours. The energy's
   does in a hundredth of the time. */
static const char *const naive_is_worse[] = {
  "equilibrium_1e", "equilibrium_fall", "separatrix_1e", "energy", "weak_wait", "frequency_1e",
  "frequency_50", "frequency_shaken", "stiff_error", "stiff_bdf_rhs", "stiff_remedy_rhs",
  "fold_orbit", "fold_ghost_1e-12", "fold_label_1e-12", "cusp_orbit", "boundary_1e-9",
  "cascade_1.0663", "turns_velocity", "tolerance_missed", "tolerance_orbits", "drive_0",
  "drive_1e", "drive_start",
};

static int naive_must_be_worse(const hard_row *row)
{
  for (size_t i = 0; i < sizeof naive_is_worse / sizeof *naive_is_worse; i++)
    if (strncmp(row->name, naive_is_worse[i], strlen(naive_is_worse[i])) == 0)
      return !isnan(row->naive);
  return 0;
}

/* Names are keys in the file of results. */
static int is_new(const char *name)
{
  static char seen[400][sizeof((hard_row *)0)->name];
  static size_t count;
  for (size_t i = 0; i < count; i++)
    if (strcmp(seen[i], name) == 0) return 0;
  assert_true(count < sizeof seen / sizeof *seen);
  strcpy(seen[count++], name);
  return 1;
}

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
    const char *what = !hard_row_holds(row)                                       ? "is broken"
                       : naive_must_be_worse(row) && !(row->naive > row->figure) ? "is no better"
                       : !is_new(row->name)                                       ? "comes twice"
                                                                                  : NULL;
    if (what == NULL) continue;
    print_error("%s %s\n", row->name, what);
    broken++;
  }
  assert_true(sheet.count > 0);
  assert_int_equal(broken, 0);
  hard_sheet_clear(&sheet);
}

/* What has no number does not hold; names are short and tell one row from the other. */
static void rows(void **state)
{
  static const struct { double number; const char *name; } names[] = {
    { 1e-3, "a_1e-3" }, { 1e-12, "a_1e-12" }, { 1e-310, "a_1e-310" }, { 10.0, "a_10" },
    { 0.5, "a_0.5" },   { 0.0, "a_0" },
  };
  hard_sheet sheet = { .scale = 1.0 };
  (void)state;
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    check_ok(hard_sheet_add(&sheet, hard_at("a", names[i].number).text, "b", 1.0, 1.0, NAN));
    assert_string_equal(sheet.row[i].name, names[i].name);
    assert_true(hard_row_holds(&sheet.row[i]));
  }
  assert_false(hard_row_holds(&(hard_row){ .figure = 1.1, .bound = 1.0 }));
  assert_false(hard_row_holds(&(hard_row){ .figure = NAN, .bound = 1.0 }));
  assert_false(hard_row_holds(&(hard_row){ .figure = 1.0, .bound = NAN }));
  assert_true(isnan(hard_larger(NAN, 1.0)) && isnan(hard_larger(1.0, NAN)));
  assert_true(hard_larger(1.0, 2.0) == 2.0 && hard_larger(2.0, 1.0) == 2.0);
  assert_null(hard_case_find("no such case"));
  hard_sheet_clear(&sheet);
}

/* What rows are judged by does not hold where nothing is there to hold: each is broken
   on purpose. */
static void judges(void **state)
{
  static const double useless[] = { NAN, INFINITY, -1e-9, 1.1e-6 };
  const double most = 1e-6;
  (void)state;
  check_near(hard_over_claim(2e-9, 1e-9, most), 2.0, 1e-15);
  check_near(hard_over_claim(0.0, 0.0, most), 0.0, 0.0);
  assert_false(hard_over_claim(1e-300, 0.0, most) <= 10.0);
  assert_false(hard_over_claim(NAN, 0.0, most) <= 10.0);
  assert_false(hard_over_claim(NAN, 1e-9, most) <= 10.0);
  for (size_t i = 0; i < sizeof useless / sizeof *useless; i++) {
    assert_false(hard_over_claim(0.0, useless[i], most) <= 10.0);
    assert_true(hard_misplaced(0.0, useless[i], most));
  }
  assert_false(hard_over_claim(0.0, INFINITY, INFINITY) <= 10.0); /* not even for the naive way */
  assert_false(hard_misplaced(9e-9, 1e-9, most));
  assert_true(hard_misplaced(11e-9, 1e-9, most));
  assert_true(hard_misplaced(NAN, 1e-9, most));
  assert_true(hard_above_zero(0.05, 0.01) <= 1.0);
  assert_false(hard_above_zero(0.03, 0.01) <= 1.0);
  static const double none[][2] = { { -0.05, 0.01 }, { 0.0, 0.0 },  { NAN, 0.01 },
                                    { 0.05, NAN },   { 0.05, INFINITY }, { 0.05, -0.01 } };
  for (size_t i = 0; i < sizeof none / sizeof *none; i++)
    assert_false(hard_above_zero(none[i][0], none[i][1]) <= 1.0);
}

/*
 * Denormal numbers take processors some 150 cycles an operation, 40 times a block's usual pace:
 * what has come to rest must not pay for that, so it is put to rest. `make bench` times it.
 */
static void what_rests_has_no_denormal_numbers(void **state)
{
  static const double speeds[] = { 1e-310, 1e-291, 1e-289, 1e-280 };
  enum { LANES = sizeof speeds / sizeof *speeds };
  const pendres_options options = { .tolerance = 1e-8 };
  pendres_context *ctx = NULL;
  pendres_pendulum p[LANES];
  double x[LANES], v[LANES];
  (void)state;
  check_ok(pendres_context_create(&options, &ctx));
  for (int i = 0; i < LANES; i++) {
    p[i] = (pendres_pendulum){ .damping = 0.2, .drive_frequency = 1.0 };
    x[i] = 1.57079632679489661923;
    v[i] = speeds[i];
  }
  /* exp(-0.1 * 2 pi * 60) = 4e-17: all are below 1e-290 then, and none is 1e-308 yet. */
  check_ok(pendres_strobe_advance(ctx, LANES, p, x, v, 60, NULL));
  for (int i = 0; i < LANES; i++) {
    assert_true(x[i] == 1.57079632679489661923);
    assert_true(v[i] == 0.0);
  }
  pendres_context_free(ctx);
}

int main(void)
{
#define HARD_CASE_TEST(name)                                                                      \
  { #name, run_case, NULL, NULL, (void *)(uintptr_t)hard_case_find(#name) },
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(rows),
    cmocka_unit_test(judges),
    cmocka_unit_test(what_rests_has_no_denormal_numbers),
    DECK_CASE_LIST(HARD_CASE_TEST)
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
