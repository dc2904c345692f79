/*
 * test_scene_failed.c -- points that cannot be computed are marked with their reason and named with
 * their coordinates, and do not affect the others.
 */
#include "scene_fixture.h"

#include "results/columns.h"
#include "results/failed.h"

/* Codes of a variable. */
static void get_codes(const char *file, const char *name, int *codes, size_t n)
{
  size_t count = 0;
  pendres_store *store = scene_open(file);
  double *v = scene_values(store, name, &count);
  assert_int_equal(count, n);
  for (size_t i = 0; i < n; i++) codes[i] = (int)v[i];
  free(v);
  pendres_store_free(store);
}

/* Values of two files that must be the same numbers, or both NaN, at the points that both have. */
static void check_same_values(const char *one, const char *two, const char *name, size_t n)
{
  size_t a = 0, b = 0;
  pendres_store *first = scene_open(one), *second = scene_open(two);
  double *x = scene_values(first, name, &a), *y = scene_values(second, name, &b);
  assert_true(a >= n && b >= n);
  assert_memory_equal(x, y, n * sizeof *x);
  free(x);
  free(y);
  pendres_store_free(first);
  pendres_store_free(second);
}

/* Which statuses are a point's own, and which are the run's. */
static void reasons_of_statuses(void **state)
{
  (void)state;
  for (int s = 0; s < PENDRES_STATUS_COUNT; s++) {
    const int ends_the_run = s == PENDRES_OK || s == PENDRES_OUT_OF_MEMORY ||
                             s == PENDRES_INTERRUPTED || s == PENDRES_IO ||
                             s == PENDRES_UNSUPPORTED || s == PENDRES_INTERNAL ||
                             s == PENDRES_BUSY;
    assert_int_equal(scene_failure_of((pendres_status)s) == SCENE_FAILURE_NONE, ends_the_run);
  }
  scene_run run = { 0 };
  scene_failed f[2] = {{.reason = SCENE_FAILURE_NONE}};
  scene_failure_mark(&run, &f[1], SCENE_FAILURE_NOT_FOUND, "nothing there");
  check_ok(run.status);
  assert_int_equal(f[0].reason, SCENE_FAILURE_NONE);
  assert_int_equal(f[1].reason, SCENE_FAILURE_NOT_FOUND);
  assert_string_equal(f[1].words, "nothing there");
  scene_room_end(&run.room);
}

static const char *colours(int value)
{
  static const char *const names[] = { "red", "green", "blue" };
  return value >= 0 && value < 3 ? names[value] : NULL;
}

/* Ten lines are told: points that a deck tolerates take none of them from what failed. */
static void failures_are_told_first(void **state)
{
  deck d = { .precision.unresolved_share = 0.5 };
  scene_run run = { .deck = &d };
  (void)state;
  for (int i = 0; i < SCENE_MOST_TOLD + 2; i++)
    scene_failure_tell(&run, SCENE_FAILURE_UNRESOLVED, NULL, "open %d", i);
  scene_failure_tell(&run, SCENE_FAILURE_TOLERANCE, NULL, "failed");
  assert_int_equal(run.told_count, SCENE_MOST_TOLD);
  assert_int_equal(strncmp(run.told[0], "open 0: ", 8), 0);
  assert_int_equal(strncmp(run.told[SCENE_MOST_TOLD - 1], "failed: ", 8), 0);
  assert_int_equal(run.told_open[SCENE_MOST_TOLD - 1], 0);
}

/* The codes of a row from elsewhere are those that its columns name; a blank row is NaN where it
   has doubles, and stays as it is elsewhere. */
static void rows_from_elsewhere(void **state)
{
  static const int8_t bits[] = { 0, 1, 4 };
  typedef struct row {
    double x, x_error;
    int colour, sum, yes;
  } row;
  static const scene_column columns[] = {
    SCENE_COLUMN(row, x, "x"), SCENE_CODE(row, colour, "colour", colours),
    { .name = "sum", .type = SCENE_FLAG, .value = offsetof(row, sum), .names = colours,
      .codes = bits },
    { .name = "yes", .type = SCENE_FLAG, .value = offsetof(row, yes) } };
  static const struct { row row; int fits; } rows[] = {
    { { NAN, 0.0, 2, 5, 1 }, 1 }, { { 0.0, 0.0, 3, 0, 0 }, 0 }, { { 0.0, 0.0, -1, 0, 0 }, 0 },
    { { 0.0, 0.0, 0, 2, 0 }, 0 }, { { 0.0, 0.0, 0, 0, 2 }, 0 } };
  (void)state;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    assert_int_equal(scene_columns_fit(4, columns, &rows[i].row), rows[i].fits);
  row blank = { 1.0, 2.0, 2, 5, 1 };
  scene_columns_blank(4, columns, &blank);
  assert_true(isnan(blank.x) && isnan(blank.x_error));
  assert_true(blank.colour == 2 && blank.sum == 5 && blank.yes == 1);
}

/* Steps go with one over a weak damping, and with the square of a strong one. */
static void what_takes_too_long(void **state)
{
  static const struct { double damping, frequency; int too_long; } cases[] = {
    { 1e-9, 0.5, 1 }, { 1e-6, 0.5, 1 }, { 1e-4, 0.5, 0 }, { 0.2, 0.5, 0 }, { 20.0, 0.5, 0 },
    { 2e5, 0.5, 1 }, { 0.12, 1e6, 1 }, { 0.12, 1e3, 0 }, { 0.12, 1e-4, 0 } };
  char words[SCENE_TOLD] = "";
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const pendres_pendulum p = { .damping = cases[i].damping,
                                 .drive_frequency = cases[i].frequency };
    assert_int_equal(scene_failure_too_long(&p, 1.0, words, sizeof words), cases[i].too_long);
    /* 18 times 2 / damping, of two steps in three units of time. */
    if (i == 0)
      assert_non_null(strstr(words, "damping 1e-09, drive_frequency 0.5 ask for some 2.4e+10 "
                                    "steps"));
    /* 300 units of time and 20 periods, each of which has 8 steps. */
    if (i == 6) assert_non_null(strstr(words, "3.8e+08 steps"));
  }
}

/* The last damping needs more steps than anybody waits for, or than are allowed in a period. */
static void response_keeps_the_others(void **state)
{
  static const char format[] = "&scene kind = 'response' /\n&pendulum drive_amplitude = 0.2 /\n"
                               "&sweep damping = 0.3, 0.5%s, drive_period = 7, 8 /\n"
                               "&ensemble members = 10 /\n";
  static const int wanted[6] = { 0, 0, 0, 0, SCENE_FAILURE_TOO_LONG, SCENE_FAILURE_TOO_LONG };
  static const char *const strong[2] = { ", 999999", ", 200000" };
  char whole[300], good[300], told[100];
  int codes[6];
  (void)state;
  snprintf(good, sizeof good, format, "");
  for (int i = 0; i < 2; i++) {
    snprintf(whole, sizeof whole, format, strong[i]);
    assert_int_equal(scene_run_marked(NULL, whole, 1, "response"), 3); /* two and the resonance */
    snprintf(told, sizeof told, "response at damping %s, drive_period 7: ", strong[i] + 2);
    assert_non_null(strstr(scene_told, told));
    assert_int_equal(scene_run_marked(NULL, whole, 2, "again"), 3);
    scene_check_same_bytes("response", "again");
    get_codes("response", "failed", codes, 6);
    assert_memory_equal(codes, wanted, sizeof codes);
    get_codes("response", "resonance_failed", codes, 3);
    assert_memory_equal(codes, (&wanted[2]), 3 * sizeof *codes);
  }
  scene_run_deck(good, 1, "good");
  check_same_values("response", "good", "mean_loop_area", 4);
  check_same_values("response", "good", "phase_lag_error", 4);
  check_same_values("response", "good", "resonance_period", 2);
}

/* The same on lines, where branches and curves are followed through the good points. */
static void lines_keep_the_others(void **state)
{
  static const char format[] = "&scene kind = '%s' /\n&pendulum drive_amplitude = 0.2 /\n"
                               "&sweep damping = 0.5%s, drive_frequency = %s0.8, 0.9 /\n"
                               "&ensemble members = 10 /\n";
  static const char *const kinds[2] = { "phase_diagram", "branches" };
  const int wanted[6] = { SCENE_FAILURE_TOLERANCE, 0, 0, SCENE_FAILURE_TOO_LONG,
                          SCENE_FAILURE_TOO_LONG, SCENE_FAILURE_TOO_LONG };
  (void)state;
  for (int i = 0; i < 2; i++) {
    char whole[300], good[300];
    int codes[6];
    size_t n = 0;
    /* So slow a drive needs too many steps at any damping, so strong a damping at any drive. */
    snprintf(whole, sizeof whole, format, kinds[i], ", 999999", "2e-6, ");
    snprintf(good, sizeof good, format, kinds[i], "", "");
    assert_int_equal(scene_run_marked(NULL, whole, 1, kinds[i]), 4);
    assert_non_null(strstr(scene_told, "damping 0.5, drive_frequency 2e-06: "));
    assert_int_equal(scene_run_marked(NULL, whole, 2, "again"), 4);
    scene_check_same_bytes(kinds[i], "again");
    get_codes(kinds[i], "failed", codes, 6);
    assert_memory_equal(codes, wanted, sizeof codes);
    get_codes(kinds[i], "curves_failed", codes, 1);
    assert_int_equal(codes[0], SCENE_FAILURE_NONE);
    scene_run_deck(good, 1, "good");
    pendres_store *one = scene_open(kinds[i]), *two = scene_open("good");
    double *a = scene_values(one, "mean_loop_area", &n);
    double *b = scene_values(two, "mean_loop_area", &n);
    assert_int_equal(n, 2);
    assert_true(isnan(a[0]) && isnan(a[3]) && isnan(a[5]));
    assert_memory_equal(a + 1, b, 2 * sizeof *a);
    free(a);
    free(b);
    pendres_store_free(one);
    pendres_store_free(two);
  }
}

/* What takes too long, alone or beside others, is marked at once by other scenes, too. */
static void others_mark_what_takes_too_long(void **state)
{
  static const char orbit[] = "&scene kind = 'orbit' /\n&pendulum damping = %s, "
                              "drive_amplitude = 0.2, drive_frequency = %s /\n"
                              "&orbit start = 'sa' /\n";
  static const char map[] = "&scene kind = 'lyapunov_map' /\n&pendulum drive_amplitude = 0.2 /\n"
                            "&sweep damping = 1e-9, 0.3, drive_frequency = 0.5, 0.8 /\n";
  static const char *const odd[3][2] = { { "1e-9", "0.84" }, { "0.12", "1e6" }, { "1e5", "0.84" } };
  static const int wanted[4] = { SCENE_FAILURE_TOO_LONG, SCENE_FAILURE_TOO_LONG, 0, 0 };
  char deck[300];
  int codes[4];
  (void)state;
  for (int i = 0; i < 3; i++) {
    snprintf(deck, sizeof deck, orbit, odd[i][0], odd[i][1]);
    assert_int_equal(scene_run_marked(NULL, deck, 1, "orbit"), 1);
    get_codes("orbit", "failed", codes, 1);
    assert_int_equal(codes[0], SCENE_FAILURE_TOO_LONG);
    assert_non_null(strstr(scene_told, "precision.period_budget bounds them"));
  }
  assert_int_equal(scene_run_marked(NULL, map, 1, "map"), 2);
  get_codes("map", "failed", codes, 4);
  assert_memory_equal(codes, wanted, sizeof codes);
  assert_non_null(strstr(scene_told, "lyapunov_map.transient"));
}

/* States that do not settle in the time given. */
static void states_are_marked(void **state)
{
  static const char basins[] = "&scene kind = 'basins' /\n"
    "&pendulum damping = 0.12, drive_amplitude = 0.2, drive_period = 8 /\n"
    "&sweep x_range = -1, 4, 6, v_range = -2, 2, 5 /\n&precision period_budget = 12 /\n";
  int failed[30], label[30];
  size_t unresolved = 0;
  (void)state;
  const size_t marked = scene_run_marked(NULL, basins, 1, "basins");
  get_codes("basins", "failed", failed, 30);
  get_codes("basins", "label", label, 30);
  for (int i = 0; i < 30; i++) {
    assert_int_equal(failed[i] == SCENE_FAILURE_UNRESOLVED, label[i] == PENDRES_LABEL_UNRESOLVED);
    unresolved += failed[i] != SCENE_FAILURE_NONE;
  }
  assert_true(unresolved > 0);
  assert_int_equal(marked, unresolved);
  assert_non_null(strstr(scene_told, "of 30 states did not settle within 12 periods (weakest "
                                     "multiplier 0."));
  assert_non_null(strstr(scene_told, "raise precision.period_budget"));
}

/* Members that do not settle in the time given: why, and the remedy. Both of the states there have
   complex multipliers, whose moduli are exp(-gamma pi / omega) by Liouville's formula: 0.6242. */
static void lines_name_the_remedy(void **state)
{
  static const char *const kinds[2] = { "phase_diagram", "branches" };
  (void)state;
  for (int i = 0; i < 2; i++) {
    char deck[300];
    int code;
    snprintf(deck, sizeof deck, "&scene kind = '%s' /\n&pendulum drive_amplitude = 0.2 /\n"
             "&sweep damping = 0.12, drive_frequency = 0.8 /\n&ensemble members = 10 /\n"
             "&precision period_budget = 3 /\n", kinds[i]);
    assert_int_equal(scene_run_marked(NULL, deck, 1, kinds[i]), 1);
    get_codes(kinds[i], "failed", &code, 1);
    assert_int_equal(code, SCENE_FAILURE_UNRESOLVED);
    assert_non_null(strstr(scene_told, "of 10 members did not settle within 3 periods (weakest "
                                       "multiplier 0.6242): raise precision.period_budget"));
  }
}

/*
 * With a quality factor of 1e5 members settle by charts of the strobe map; at 1e8 they take too
 * long if nothing bounds them. Orbits and what they lead to need no settling: within a budget, too,
 * branches go all the way round the peak. There the drive's work is that of friction, so that the
 * amplitude is f / (gamma omega) but for harmonics, which make less than a hundredth at one radian.
 */
static void branches_of_weak_damping(void **state)
{
  static const char deck[] = "&scene kind = 'branches' /\n&pendulum drive_amplitude = 1e-5 /\n"
    "&sweep damping = %g, drive_frequency_range = 0.9, 1.005, 4 /\n"
    "&ensemble members = 2 /\n&precision period_budget = %d /\n";
  static const int budget[2] = { 0, 100 };
  char text[300];
  int codes[4];
  (void)state;
  snprintf(text, sizeof text, deck, 1e-8, 0);
  assert_int_equal(scene_run_marked(NULL, text, 1, "none"), 4);
  assert_non_null(strstr(scene_told, "precision.period_budget bounds them"));
  for (int k = 0; k < 2; k++) {
    size_t n = 0, top = 0;
    snprintf(text, sizeof text, deck, 1e-5, budget[k]);
    assert_true(scene_run_marked(NULL, text, 1, "weak") <= (k == 0 ? 0 : 4));
    get_codes("weak", "failed", codes, 4);
    for (int i = 0; i < 4; i++) assert_true(codes[i] != SCENE_FAILURE_TOO_LONG);
    pendres_store *store = scene_open("weak");
    double *amplitude = scene_values(store, "branch_amplitude", &n);
    double *omega = scene_values(store, "branch_frequency", &n);
    for (size_t i = 0; i < n; i++)
      if (amplitude[i] > amplitude[top]) top = i;
    assert_true(n > 100);
    check_near(amplitude[top] * omega[top], 1.0, 1e-2);
    free(amplitude);
    free(omega);
    pendres_store_free(store);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(reasons_of_statuses),
    cmocka_unit_test(failures_are_told_first), cmocka_unit_test(rows_from_elsewhere),
    cmocka_unit_test(what_takes_too_long),
    cmocka_unit_test(response_keeps_the_others),
    cmocka_unit_test(lines_keep_the_others),
    cmocka_unit_test(others_mark_what_takes_too_long),
    cmocka_unit_test(states_are_marked),
    cmocka_unit_test(lines_name_the_remedy),
    cmocka_unit_test(branches_of_weak_damping),
  };
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
