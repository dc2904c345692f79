/*
 * unknown.c -- messages about groups and keys that do not exist, or that the deck's scene does
 * not use: what was probably meant or, failing that, all that there are.
 */
#include "deck/table.h"

#include <string.h>

enum { LIST = 480 };

static const char *known_group(const char *name)
{
  for (size_t i = 0; i < deck_table_size; i++)
    if (strcmp(deck_table[i].group, name) == 0) return deck_table[i].group;
  return NULL;
}

int deck_group_has_scene(const char *group, unsigned scene)
{
  for (size_t i = 0; i < deck_table_size; i++)
    if (strcmp(deck_table[i].group, group) == 0 && (deck_table[i].scenes & scene) != 0) return 1;
  return 0;
}

/* The known group that is meant, after a message if it is misspelt; NULL if none is near. */
const char *deck_resolve_group(deck_builder *b, const namelist_group *g)
{
  const char *known = known_group(g->name);
  deck_suggestion s = { .word = g->name };
  char hint[100];
  if (known != NULL) return known;
  for (size_t i = 0; i < deck_table_size; i++)
    if (namelist_group_find(b->nl, deck_table[i].group) == NULL)
      deck_suggest(&s, deck_table[i].group);
  namelist_error_at(b->nl, g->at, b->errors, "&%s is not a group of decks%s", g->name,
                    deck_suggestion_text(&s, hint, sizeof hint));
  return s.best;
}

/* "free_oscillation, response": the scenes that use a key or group. */
static void list_scenes(unsigned scenes, char *text, size_t size)
{
  text[0] = '\0';
  for (int k = 0; k < DECK_KIND_COUNT; k++)
    if ((scenes & (1u << k)) != 0)
      snprintf(text + strlen(text), size - strlen(text), "%s%s", text[0] == '\0' ? "" : ", ",
               deck_kind_name((deck_kind)k));
}

static unsigned scenes_of(const char *group, const char *name)
{
  unsigned scenes = 0;
  for (int k = 0; k < DECK_KIND_COUNT; k++) {
    int range = 0;
    if (name == NULL ? deck_group_has_scene(group, 1u << k)
                     : deck_table_find(group, name, 1u << k, &range) < deck_table_size)
      scenes |= 1u << k;
  }
  return scenes;
}

static void offer(deck_suggestion *s, const deck_key *key, char (*names)[2 * DECK_NAME], size_t row)
{
  deck_suggest(s, key->name);
  if (key->type != DECK_SWEEP) return;
  snprintf(names[row], sizeof names[row], "%s_range", key->name);
  deck_suggest(s, names[row]);
}

/* Does the group take this key, in the deck's scene if that is known? */
static int takes(const deck_builder *b, const char *group, const deck_key *key)
{
  return strcmp(key->group, group) == 0 &&
         (b->scene == 0 ? key->scenes != 0 : (key->scenes & b->scene) != 0);
}

/* The nearest key that the group takes, by spelling or as a symbol of the literature; its row. */
static size_t find_near(const deck_builder *b, const char *word, const char *group, char *hint,
                        size_t size)
{
  const char *synonym;
  char names[DECK_MAX_KEYS][2 * DECK_NAME];
  deck_suggestion s = { .word = word };
  int range = 0;
  for (size_t i = 0; i < deck_table_size; i++)
    if (takes(b, group, &deck_table[i])) offer(&s, &deck_table[i], names, i);
  for (size_t k = 0; (synonym = deck_synonym(word, k)) != NULL; k++)
    if (deck_table_find(group, synonym, b->scene, &range) < deck_table_size) s.best = synonym;
  deck_suggestion_text(&s, hint, size);
  return s.best != NULL ? deck_table_find(group, s.best, b->scene, &range) : deck_table_size;
}

/* " (it belongs in &noise)" if another group takes the key, or one of that meaning; its row. */
static size_t find_elsewhere(const deck_builder *b, const char *name, char *hint, size_t size)
{
  const char *synonym = deck_synonym(name, 0);
  int range = 0;
  for (size_t i = 0; i < deck_table_size; i++) {
    if (deck_table_find(deck_table[i].group, name, b->scene, &range) != i) continue;
    snprintf(hint, size, " (it belongs in &%s)", deck_table[i].group);
    return i;
  }
  for (size_t i = 0; i < deck_table_size && synonym != NULL; i++) {
    if (deck_table_find(deck_table[i].group, synonym, b->scene, &range) != i) continue;
    snprintf(hint, size, " (did you mean '%s' in &%s?)", synonym, deck_table[i].group);
    return i;
  }
  return deck_table_size;
}

/* "; scene 'response' takes 'a', 'b' there": all keys of the group. */
static void list_keys(const deck_builder *b, const char *group, char *hint, size_t size)
{
  const char *before = "";
  if (b->scene == 0) snprintf(hint, size, "; its keys are ");
  else snprintf(hint, size, "; scene '%s' takes ", deck_kind_name(b->d->kind));
  for (size_t i = 0; i < deck_table_size; i++) {
    const size_t n = strlen(hint);
    const deck_key *key = &deck_table[i];
    int range = 0;
    if (!takes(b, group, key) || deck_table_find(group, key->name, b->scene, &range) != i) continue;
    snprintf(hint + n, size - n, deck_table_has_range(key) ? "%s%s, %s_range" : "%s%s", before,
             key->name, key->name);
    before = ", ";
  }
}

/* A name that the group does not know: the nearest one that the scene takes, or all of them. */
void deck_report_unknown_key(deck_builder *b, const namelist_assignment *a, const char *group)
{
  char hint[LIST] = "";
  size_t row = find_near(b, a->name, group, hint, sizeof hint);
  if (row == deck_table_size) row = find_elsewhere(b, a->name, hint, sizeof hint);
  if (row < deck_table_size) b->given[row].broken = 1; /* do not call it missing too */
  else list_keys(b, group, hint, sizeof hint);
  namelist_error_at(b->nl, a->at, b->errors, "'%s' is not a key of &%s%s%s", a->name, group, hint,
                    row < deck_table_size ? "" : "; docs/limits.md says what cannot be asked");
}

void deck_report_idle_key(deck_builder *b, const namelist_assignment *a, const char *group)
{
  char list[300];
  list_scenes(scenes_of(group, a->name), list, sizeof list);
  namelist_error_at(b->nl, a->at, b->errors, "'%s' in &%s is not used by scene '%s' (only by: %s)",
                    a->name, group, deck_kind_name(b->d->kind), list);
}

void deck_report_idle_group(deck_builder *b, const namelist_group *g, const char *group)
{
  char list[300];
  list_scenes(scenes_of(group, NULL), list, sizeof list);
  namelist_error_at(b->nl, g->at, b->errors, "&%s is not used by scene '%s' (only by: %s)", group,
                    deck_kind_name(b->d->kind), list);
}
