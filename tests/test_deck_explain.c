/*
 * test_deck_explain.c -- what the program says about decks: every key is explained, every deck of
 * --init is valid, numbers are printed short, and docs/decks.md is what the program would write.
 */
#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "deck/deck.h"
#include "deck/table.h"

static char *explained(const char *word)
{
  char *text = NULL, why[200] = "";
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  assert_non_null(out);
  const pendres_status status = deck_explain(word, out, why, sizeof why);
  fclose(out);
  if (status != PENDRES_OK) print_error("%s: %s\n", word, why);
  assert_int_equal(status, PENDRES_OK);
  return text;
}

static void every_key_has_words(void **state)
{
  (void)state;
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i], *words = deck_table_words(key);
    if (key->scenes == 0) fail_msg("&%s %s is of no scene", key->group, key->name);
    if (words == NULL || words->meaning == NULL || strlen(words->meaning) < 8)
      fail_msg("&%s %s has no meaning", key->group, key->name);
    const int is_number = key->type == DECK_REAL || key->type == DECK_BOUNDS ||
                          key->type == DECK_SWEEP || key->type == DECK_SWEEP_VALUE;
    if (is_number && deck_key_unit(words) == NULL)
      fail_msg("&%s %s has no unit", key->group, key->name);
    char *text = explained(key->name);
    assert_non_null(strstr(text, words->meaning) != NULL ? text : strstr(text, key->name));
    free(text);
  }
}

static void every_kind_has_words(void **state)
{
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  (void)state;
  deck_list(out);
  fclose(out);
  for (int k = 0; k < DECK_KIND_COUNT; k++) {
    const char *name = deck_kind_name((deck_kind)k);
    assert_non_null(strstr(text, name));
    char *all = explained(name);
    for (size_t i = 0; i < deck_table_size; i++)
      if ((deck_table[i].scenes & 1u << k) != 0) assert_non_null(strstr(all, deck_table[i].name));
    free(all);
  }
  free(text);
}

static void groups_ranges_and_paths_are_words_too(void **state)
{
  char why[200] = "";
  (void)state;
  char *text = explained("damping_range");
  assert_non_null(strstr(text, "&sweep"));
  assert_null(strstr(text, "&pendulum\n"));
  free(text);
  text = explained("pendulum.damping");
  assert_null(strstr(text, "&sweep\n"));
  assert_non_null(strstr(text, "quality factor"));
  free(text);
  text = explained("ensemble");
  assert_non_null(strstr(text, "members"));
  free(text);
  assert_int_equal(deck_explain("dampng", stdout, why, sizeof why), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(why, "did you mean 'damping'"));
  assert_int_equal(deck_explain("tau", stdout, why, sizeof why), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(why, "did you mean 'drive_period'"));
  assert_int_equal(deck_init("reponse", stdout, why, sizeof why), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(why, "did you mean 'response'"));
}

/* It is read without a complaint; its kind. */
static int kind_to_start_from(const char *name)
{
  char *text = NULL, why[200] = "";
  size_t size = 0;
  namelist_errors errors = { 0 };
  deck d = { 0 };
  FILE *out = open_memstream(&text, &size);
  assert_int_equal(deck_init(name, out, why, sizeof why), PENDRES_OK);
  fclose(out);
  const pendres_status status = deck_read_memory("init.nml", text, size, &d, &errors);
  const int kind = (int)d.kind;
  namelist_errors_print(&errors, stderr);
  assert_int_equal(status, PENDRES_OK);
  deck_free(&d);
  namelist_errors_free(&errors);
  free(text);
  return kind;
}

static void decks_to_start_from_are_decks(void **state)
{
  (void)state;
  for (int k = 0; k < DECK_KIND_COUNT; k++)
    assert_int_equal(kind_to_start_from(deck_kind_name((deck_kind)k)), k);
  assert_int_equal(kind_to_start_from("resonator"), DECK_BRANCHES);
  assert_int_equal(kind_to_start_from("junction"), DECK_HYSTERESIS);
  assert_int_equal(kind_to_start_from("two_wells"), DECK_BASINS);
}

/* By the definition: it reads back, and no decimal of fewer digits does. */
static void decimals_are_short(void **state)
{
  static const struct { double x; const char *text; } expected[] = {
    { 0.2, "0.2" }, { 2.0, "2.0" }, { 0.1 + 0.2, "0.30000000000000004" }, { 1e-8, "1e-08" },
    { -0.06, "-0.06" }, { 0x1p-1074, "5e-324" }, { 1e22, "1e+22" },
    { 1.0 / 3, "0.3333333333333333" },
    { 5e-320, "5e-320" }, { 4.0 / 3, "1.3333333333333333" },
  };
  char text[DECK_DECIMAL];
  (void)state;
  for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
    assert_string_equal(deck_decimal(expected[i].x, text), expected[i].text);
  for (int i = 1; i < 2000; i++) {
    const double x = (double)i / 997.0, y = (double)i / 1000.0;
    char shorter[DECK_DECIMAL];
    assert_true(strtod(deck_decimal(x, text), NULL) == x);
    snprintf(shorter, sizeof shorter, "%g", y);
    if (strchr(shorter, '.') != NULL) assert_string_equal(deck_decimal(y, text), shorter);
  }
}

/* Run at the top of the tree; `make decks-reference` writes the page. */
static void the_page_is_current(void **state)
{
  char *page = NULL, *read = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&page, &size), *file = fopen("docs/decks.md", "rb");
  (void)state;
  assert_non_null(file);
  deck_reference(out);
  fclose(out);
  read = calloc(1, size + 2);
  const size_t length = fread(read, 1, size + 1, file);
  fclose(file);
  if (length != size || memcmp(read, page, size) != 0)
    fail_msg("docs/decks.md is not what the table of keys says: make decks-reference");
  free(read);
  free(page);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_key_has_words),
    cmocka_unit_test(every_kind_has_words),
    cmocka_unit_test(groups_ranges_and_paths_are_words_too),
    cmocka_unit_test(decks_to_start_from_are_decks),
    cmocka_unit_test(decimals_are_short),
    cmocka_unit_test(the_page_is_current),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
