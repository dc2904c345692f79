/*
 * test_namelist_damage.c -- floods of text, long names, and text that is damaged at random.
 */
#define _POSIX_C_SOURCE 200809L /* open_memstream */

#include "namelist_fixture.h"

/* ---- bounds -------------------------------------------------------------------------------- */

/* head, then unit as often as fits into size bytes; the result must be an error, soon and small. */
static void check_flood(const char *head, const char *unit, size_t size)
{
  namelist nl = { 0 };
  namelist_errors errors = { 0 };
  char *text = malloc(size + 1);
  size_t used = strlen(head);
  const clock_t start = clock();
  assert_non_null(text);
  strcpy(text, head);
  while (used + strlen(unit) <= size) {
    strcpy(text + used, unit);
    used += strlen(unit);
  }
  assert_int_equal(namelist_parse("t", text, used, &nl, &errors), PENDRES_INVALID_ARGUMENT);
  /* Milliseconds; work that grows with the square of the length takes tens of seconds. */
  assert_true((double)(clock() - start) / CLOCKS_PER_SEC < 2.0);
  assert_in_range(errors.count, 1, NAMELIST_MAX_ERRORS);
  assert_in_range(nl.groups, 0, NAMELIST_MAX_GROUPS);
  assert_in_range(nl.assignments, 0, NAMELIST_MAX_ASSIGNMENTS);
  assert_in_range(nl.values, 0, NAMELIST_MAX_VALUES);
  free(text);
  namelist_free(&nl);
  namelist_errors_free(&errors);
}

static void floods(void **state)
{
  static const char *const units[] = {
    "1 ", ",", "1000000*1 ", "1000000*, ", "a=", "a ", "&a ", "&a/", "/", "'", "\"'", "'\n", "x\n",
      ";",
    "(", ")", "a(", "a(1)=", "!", "!\n", "\n", " ", "=", "a%", "1e", "&", "$end", "\xCE\xB3", "a",
      "9", "*",
    "&g x='\n", "\"\n'\n",
  };
  (void)state;
  for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
    check_flood("&g x=", units[i], NAMELIST_MAX_BYTES / 8);
    check_flood("&g ", units[i], NAMELIST_MAX_BYTES / 8);
    check_flood("?", units[i], NAMELIST_MAX_BYTES / 8);
  }
  check_flood("&g x=1 / ", " ", NAMELIST_MAX_BYTES + 1);
}

static void long_names_and_numbers(void **state)
{
  char text[2000];
  namelist nl = { 0 };
  namelist_errors errors = { 0 };
  double x = 0;
  (void)state;
  /* 63 characters are a name, 64 are none. */
  snprintf(text, sizeof text, "&g %063d=1 /", 0);
  memset(text + 3, 'a', 63);
  assert_int_equal(namelist_parse("t", text, strlen(text), &nl, &errors), PENDRES_OK);
  namelist_free(&nl);
  snprintf(text, sizeof text, "&g %064d=1 /", 0);
  memset(text + 3, 'a', 64);
  assert_int_equal(namelist_parse("t", text, strlen(text), &nl, &errors), PENDRES_INVALID_ARGUMENT);
  namelist_free(&nl);
  namelist_errors_free(&errors);
  /* 500 digits are a number, 501 are refused. */
  for (int digits = 500; digits <= 501; digits++) {
    snprintf(text, sizeof text, "&g x=.%0*d /", digits - 1, 1);
    assert_int_equal(namelist_parse("t", text, strlen(text), &nl, &errors), PENDRES_OK);
    /* 1e-499 is below any double, so that only the shorter one is seen as a number. */
    assert_int_equal(namelist_value_real(&nl, only_value(&nl), "x", &x, &errors), 0);
    assert_int_equal(strstr(errors.item[0].text, "too small") != NULL, digits == 500);
    namelist_free(&nl);
    namelist_errors_free(&errors);
  }
}

static void no_text(void **state)
{
  namelist nl = { 0 };
  namelist_errors errors = { 0 };
  static const char zeros[3] = { 0 };
  (void)state;
  assert_int_equal(namelist_parse("t", NULL, 0, &nl, &errors), PENDRES_OK);
  namelist_free(&nl);
  namelist_free(&nl);
  assert_int_equal(namelist_parse("t", zeros, sizeof zeros, &nl, &errors),
                   PENDRES_INVALID_ARGUMENT);
  namelist_free(&nl);
  assert_int_equal(namelist_parse("t", "\xFF\xFE&\0g\0", 6, &nl, &errors),
                   PENDRES_INVALID_ARGUMENT);
  namelist_free(&nl);
  assert_int_equal(namelist_read("no/such/deck.nml", &nl, &errors), PENDRES_IO);
  namelist_free(&nl);
  assert_int_equal(namelist_read("/", &nl, &errors), PENDRES_IO);
  namelist_free(&nl);
  assert_int_equal(namelist_read("/dev/zero", &nl, &errors), PENDRES_IO);
  namelist_free(&nl);
  assert_int_equal(errors.count, 5);
  assert_non_null(strstr(errors.item[2].text, "no/such/deck.nml: error: cannot read"));
  assert_non_null(strstr(errors.item[4].text, "'/dev/zero' is not a regular file but a device"));
  namelist_errors_free(&errors);
  namelist_errors_free(&errors);
}

/* ---- random damage ------------------------------------------------------------------------- */

static uint32_t draw(uint64_t *seed)
{
  *seed = *seed * 6364136223846793005u + 1442695040888963407u; /* Knuth, MMIX */
  return (uint32_t)(*seed >> 33);
}

/* No crash, no hang; whatever is not an error has no errors listed. */
static void damaged_text(void **state)
{
  static const char characters[] = "&/$!'\"=,;*()%:.+-eEdD019aAzT_ \t\n\r\xCE\xB3\xFF\x01";
  uint64_t seed = 1;
  (void)state;
  for (int round = 0; round < 20000; round++) {
    char text[200];
    namelist nl = { 0 };
    namelist_errors errors = { 0 };
    const char *from = good[draw(&seed) % (sizeof good / sizeof *good)].text;
    size_t length = strlen(from);
    memcpy(text, from, length + 1);
    for (uint32_t k = draw(&seed) % 6; k > 0 && length > 0 && length < 150; k--) {
      const size_t at = draw(&seed) % length;
      const char c = characters[draw(&seed) % (sizeof characters - 1)];
      const uint32_t how = draw(&seed) % 4;
      if (how == 0) text[at] = c;
      else if (how == 1) length = at;
      else if (how == 2) memmove(text + at, text + at + 1, length-- - at - 1);
      else {
        memmove(text + at + 1, text + at, length++ - at);
        text[at] = c;
      }
    }
    const pendres_status status = namelist_parse("t", text, length, &nl, &errors);
    assert_int_equal(status == PENDRES_OK, errors.count == 0);
    for (size_t g = 0; g < nl.groups; g++)
      for (size_t a = 0; a < nl.group[g].count; a++) {
        namelist_array array = { 0 };
        namelist_array_get(&nl, &nl.group[g], nl.assignment[nl.group[g].begin + a].name, &array,
                           &errors);
        for (size_t v = 0; v < array.count && v < 10; v++) {
          double x;
          int64_t i;
          int l;
          char s[20];
          if (array.item[v] == NULL) continue;
          namelist_value_real(&nl, array.item[v], "x", &x, &errors);
          namelist_value_integer(&nl, array.item[v], "i", &i, &errors);
          namelist_value_logical(&nl, array.item[v], "l", &l, &errors);
          namelist_value_string(&nl, array.item[v], "s", s, sizeof s, &errors);
        }
        namelist_array_free(&array);
      }
    namelist_free(&nl);
    namelist_errors_free(&errors);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(floods),
    cmocka_unit_test(long_names_and_numbers),
    cmocka_unit_test(no_text),
    cmocka_unit_test(damaged_text),
  };
  return cmocka_run_group_tests_name("namelist_damage", tests, NULL, NULL);
}
