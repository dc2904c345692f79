/*
 * ours.c -- the deck reader's side of the comparison with gfortran; see compare.py.
 *
 *   ours read FILE    the group &g of theirs.f90, one line an element: NAME(INDEX) VALUE
 *   ours keys         the table of keys: GROUP NAME TYPE
 *   ours dump FILE    the resolved deck
 *   ours deck FILE    any deck in the form of `read`, by the table: GROUP.NAME(INDEX) VALUE
 *
 * Errors go to stderr, and the exit code is then 1.
 */
#include <stdlib.h>
#include <string.h>

#include "deck/table.h"

typedef enum kind { INTEGER, REAL, LOGICAL, STRING } kind;

static void print_value(const namelist *nl, const namelist_value *v, kind k, const char *label,
                        namelist_errors *errors)
{
  static char text[NAMELIST_MAX_BYTES];
  int64_t i = 0;
  double x = 0.0;
  int l = 0;
  if (k == INTEGER && namelist_value_integer(nl, v, label, &i, errors)) printf("%s %lld\n", label,
                                                                               (long long)i);
  if (k == REAL && namelist_value_real(nl, v, label, &x, errors)) printf("%s %.17e\n", label, x);
  if (k == LOGICAL && namelist_value_logical(nl, v, label, &l, errors)) printf("%s %c\n", label,
                                                                               l ? 'T' : 'F');
  if (k == STRING && namelist_value_string(nl, v, label, text, sizeof text,
                                           errors)) printf("%s %s|\n", label, text);
}

static void print_name(const namelist *nl, const namelist_group *g, const char *prefix,
                       const char *name,
                       kind k, size_t limit, namelist_errors *errors)
{
  namelist_array array = { 0 };
  char label[200];
  if (namelist_array_get(nl, g, name, &array, errors) == PENDRES_OK && array.count > limit)
    namelist_error_at(nl, (namelist_place){ array.at.line, array.at.column, 1 }, errors,
                      "more than %zu values", limit);
  for (size_t i = 0; i < array.count && i < limit; i++) {
    snprintf(label, sizeof label, "%s%s(%zu)", prefix, name, i + 1);
    if (array.item[i] != NULL) print_value(nl, array.item[i], k, label, errors);
  }
  namelist_array_free(&array);
}

static void print_syntax_group(const namelist *nl, namelist_errors *errors)
{
  static const struct { const char *name; kind k; size_t limit; } known[] = {
    { "i", INTEGER, 1 }, { "iv", INTEGER, 5 }, { "l", LOGICAL, 1 }, { "lv", LOGICAL, 3 },
    { "s", STRING, 1 },  { "sv", STRING, 3 },  { "x", REAL, 1 },    { "xv", REAL, 5 },
  };
  const size_t count = sizeof known / sizeof *known;
  const namelist_group *g = namelist_group_find(nl, "g");
  if (g == NULL) {
    namelist_error_at(nl, namelist_whole, errors, "no group &g");
    return;
  }
  for (size_t i = 0; i < count; i++) print_name(nl, g, "", known[i].name, known[i].k,
                                                known[i].limit, errors);
  for (size_t a = 0; a < g->count; a++) {
    size_t i = 0;
    while (i < count && strcmp(known[i].name, nl->assignment[g->begin + a].name) != 0) i++;
    if (i == count) namelist_error_at(nl, namelist_whole, errors, "unknown name");
  }
}

static kind kind_of(const deck_key *key)
{
  if (key->type == DECK_INTEGER) return INTEGER;
  if (key->type == DECK_LOGICAL) return LOGICAL;
  if (key->type == DECK_STRING || key->type == DECK_CHOICE || key->type == DECK_CHOICES)
    return STRING;
  return REAL;
}

static void print_deck(const namelist *nl, namelist_errors *errors)
{
  for (size_t n = 0; n < nl->groups; n++) {
    const namelist_group *g = &nl->group[n];
    char prefix[2 * NAMELIST_NAME];
    snprintf(prefix, sizeof prefix, "%s.", g->name);
    for (size_t a = 0; a < g->count; a++) {
      const char *name = nl->assignment[g->begin + a].name;
      int range = 0;
      const size_t row = deck_table_find(g->name, name, 0, &range);
      if (row < deck_table_size)
        print_name(nl, g, prefix, name, kind_of(&deck_table[row]), NAMELIST_MAX_VALUES, errors);
    }
  }
}

static void print_keys(void)
{
  static const char *const kinds[] = { "integer", "real", "logical", "string" };
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    printf("%s %s %s\n", key->group, key->name, kinds[kind_of(key)]);
    if (key->type == DECK_SWEEP) printf("%s %s_range real\n", key->group, key->name);
  }
}

int main(int argc, char **argv)
{
  namelist nl = { 0 };
  namelist_errors errors = { 0 };
  deck d = { 0 };
  const char *what = argc > 1 ? argv[1] : "";
  int failed = 0;

  if (strcmp(what, "keys") == 0) {
    print_keys();
    return 0;
  }
  if (argc != 3) return 2;
  if (strcmp(what, "dump") == 0) {
    if (deck_read_set(argv[2], NULL, 0, &d, &errors) == PENDRES_OK)
      failed = deck_dump(&d, stdout) != PENDRES_OK;
  } else if (namelist_read(argv[2], &nl, &errors) == PENDRES_OK) {
    if (strcmp(what, "read") == 0) print_syntax_group(&nl, &errors);
    else print_deck(&nl, &errors);
  }
  namelist_errors_sort(&errors);
  namelist_errors_print(&errors, stderr);
  failed |= errors.count > 0 || errors.out_of_memory;
  namelist_errors_free(&errors);
  namelist_free(&nl);
  deck_free(&d);
  return failed;
}
