/* find.c -- rows of the table by name, and kinds of scenes; see table.h. */
#include "deck/table.h"

#include <string.h>

int deck_table_has_range(const deck_key *key)
{
  /* Tolerances are given as a list, since they are rarely evenly spaced. */
  return key->type == DECK_SWEEP && key->axis != DECK_AXIS_TOLERANCE;
}

int deck_table_matches(const deck_key *key, const char *name, int *range)
{
  const size_t n = strlen(key->name);
  if (strncmp(key->name, name, n) != 0) return 0;
  *range = name[n] != '\0';
  return !*range || (deck_table_has_range(key) && strcmp(name + n, "_range") == 0);
}

size_t deck_table_find(const char *group, const char *name, unsigned scenes, int *range)
{
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if (strcmp(key->group, group) != 0 || (scenes != 0 && (key->scenes & scenes) == 0)) continue;
    if (deck_table_matches(key, name, range)) return i;
  }
  return deck_table_size;
}

const deck_key *deck_table_words(const deck_key *key)
{
  const deck_key *other = NULL;
  if (key->meaning != NULL) return key;
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *k = &deck_table[i];
    if (k->meaning == NULL || strcmp(k->name, key->name) != 0) continue;
    if (strcmp(k->group, key->group) == 0) return k;
    if (other == NULL) other = k;
  }
  return other;
}

const char *deck_key_unit(const deck_key *words)
{
  const int number = words->type == DECK_REAL || words->type == DECK_BOUNDS ||
                     words->type == DECK_SWEEP || words->type == DECK_SWEEP_VALUE;
  if (words->unit != NULL || !number) return words->unit;
  return pendres_kind_of(words->kind)->unit;
}

int64_t deck_spectrum_least(const deck *d)
{
  const int64_t samples = d->orbit.samples;
  return samples == 1 ? 4 : samples == 2 || samples % 2 != 0 ? 2 : 1;
}

const deck_kind_info *deck_kind_of(deck_kind kind)
{
  static const deck_kind_info info[] = {
#define KIND_INFO(code, name, words, ...) {name, words, __VA_ARGS__},
    DECK_KIND_LIST(KIND_INFO)
#undef KIND_INFO
  };
  return (unsigned)kind < DECK_KIND_COUNT ? &info[kind] : NULL;
}

const char *deck_kind_name(deck_kind kind)
{
  return (unsigned)kind < DECK_KIND_COUNT ? deck_kind_of(kind)->name : NULL;
}
