/* deck_read.c -- from the tree of a namelist to a checked deck; see deck.h. */
#include "deck/deck_table.h"

#include <stdlib.h>
#include <string.h>

/* ---- names --------------------------------------------------------------------------------- */

static const char *known_group(const char *name)
{
  for (size_t i = 0; i < deck_table_size; i++)
    if (strcmp(deck_table[i].group, name) == 0) return deck_table[i].group;
  return NULL;
}

static int group_has_scene(const char *group, unsigned scene)
{
  for (size_t i = 0; i < deck_table_size; i++)
    if (strcmp(deck_table[i].group, group) == 0 && (deck_table[i].scenes & scene) != 0) return 1;
  return 0;
}

/* The known group that is meant, after a message if it is misspelt; NULL if none is near. */
static const char *resolve_group(deck_builder *b, const namelist_group *g)
{
  const char *known = known_group(g->name);
  deck_suggestion s = { .word = g->name };
  char hint[100];
  if (known != NULL) return known;
  for (size_t i = 0; i < deck_table_size; i++)
    if (namelist_group_find(b->nl, deck_table[i].group) == NULL)
      deck_suggest(&s, deck_table[i].group);
  namelist_error_at(b->nl, g->line, g->column, (int)strlen(g->name) + 1, b->errors,
                    "&%s is not a group of decks%s", g->name,
                    deck_suggestion_text(&s, hint, sizeof hint));
  return s.best;
}

/* "free_oscillation, response": where a key or group is at home. */
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
    if (name == NULL ? group_has_scene(group, 1u << k)
                     : deck_table_find(group, name, 1u << k, &range) < deck_table_size)
      scenes |= 1u << k;
  }
  return scenes;
}

/* ---- keys ---------------------------------------------------------------------------------- */

static void offer(deck_suggestion *s, const deck_key *key, char (*names)[2 * DECK_NAME], size_t row)
{
  deck_suggest(s, key->name);
  if (key->type != DECK_SWEEP) return;
  snprintf(names[row], sizeof names[row], "%s_range", key->name);
  deck_suggest(s, names[row]);
}

/* A name that the group does not know: the nearest one that the scene takes, if any. */
static void report_unknown_key(deck_builder *b, const namelist_assignment *a, const char *group)
{
  const char *synonym = deck_synonym(a->name);
  deck_suggestion s = { .word = a->name };
  char names[DECK_MAX_KEYS][2 * DECK_NAME], hint[3 * DECK_NAME], text[300];
  int range = 0;
  size_t row = deck_table_size;

  for (size_t i = 0; i < deck_table_size; i++)
    if (strcmp(deck_table[i].group, group) == 0 &&
        (b->scene == 0 || (deck_table[i].scenes & b->scene)))
      offer(&s, &deck_table[i], names, i);
  if (synonym != NULL && deck_table_find(group, synonym, b->scene, &range) < deck_table_size)
    s.best = synonym;
  deck_suggestion_text(&s, hint, sizeof hint);
  if (s.best != NULL) row = deck_table_find(group, s.best, b->scene, &range);
  if (row < deck_table_size) b->given[row].broken = 1; /* do not call it missing too */
  else
    for (size_t i = 0; i < deck_table_size && hint[0] == '\0'; i++) { /* perhaps of another group */
      if (deck_table_find(deck_table[i].group, a->name, b->scene, &range) != i) continue;
      snprintf(hint, sizeof hint, " (it belongs in &%s)", deck_table[i].group);
      b->given[i].broken = 1;
    }
  snprintf(text, sizeof text, "'%s' is not a key of &%s%s", a->name, group, hint);
  namelist_error_at(b->nl, a->line, a->column, (int)strlen(a->name), b->errors, "%s", text);
}

static void report_idle_key(deck_builder *b, const namelist_assignment *a, const char *group)
{
  char list[300];
  list_scenes(scenes_of(group, a->name), list, sizeof list);
  namelist_error_at(b->nl, a->line, a->column, (int)strlen(a->name), b->errors,
                    "'%s' in &%s is not used by scene '%s' (only by: %s)", a->name, group,
                    deck_kind_name(b->d->kind), list[0] == '\0' ? "none" : list);
}

static void read_key(deck_builder *b, const namelist_group *g, const namelist_assignment *a,
                     const char *group)
{
  namelist_array array = { 0 };
  int range = 0;
  const size_t row = deck_table_find(group, a->name, b->scene, &range);
  if (row == deck_table_size) {
    if (deck_table_find(group, a->name, 0, &range) < deck_table_size) report_idle_key(b, a, group);
    else report_unknown_key(b, a, group);
    return;
  }
  /* Types and ranges depend on the scene; without one only the names can be checked. */
  if (b->scene == 0 && strcmp(group, "scene") != 0) return;
  if (namelist_array_get(b->nl, g, a->name, &array, b->errors) == PENDRES_OUT_OF_MEMORY)
    b->out_of_memory = 1;
  else
    deck_key_apply(b, row, &array, range);
  namelist_array_free(&array);
}

/* A name may occur several times with subscripts; all are read at the first. */
static int came_before(const deck_builder *b, const namelist_group *g, size_t i)
{
  const namelist_assignment *a = &b->nl->assignment[g->begin];
  for (size_t k = 0; k < i; k++)
    if (strcmp(a[k].name, a[i].name) == 0) return 1;
  return 0;
}

static void read_group(deck_builder *b, const namelist_group *g, const char *group)
{
  for (size_t i = 0; i < deck_table_size; i++)
    if (strcmp(deck_table[i].group, group) == 0) b->given[i].group = g;
  if (b->scene != 0 && !group_has_scene(group, b->scene)) {
    char list[300];
    list_scenes(scenes_of(group, NULL), list, sizeof list);
    namelist_error_at(b->nl, g->line, g->column, (int)strlen(g->name) + 1, b->errors,
                      "&%s is not used by scene '%s' (only by: %s)", group,
                      deck_kind_name(b->d->kind), list);
    return;
  }
  for (size_t i = 0; i < g->count; i++)
    if (!came_before(b, g, i)) read_key(b, g, &b->nl->assignment[g->begin + i], group);
}

/* ---- the whole deck ------------------------------------------------------------------------ */

/* &scene first, wherever it stands: all else depends on the kind. */
static void read_groups(deck_builder *b)
{
  const char *name[NAMELIST_MAX_GROUPS] = { NULL };
  const namelist *nl = b->nl;
  int found = 0;
  for (size_t i = 0; i < nl->groups; i++)
    if (!nl->group[i].repeated) name[i] = resolve_group(b, &nl->group[i]);
  for (int scene = 1; scene >= 0; scene--) {
    for (size_t i = 0; i < nl->groups; i++) {
      if (name[i] == NULL || (strcmp(name[i], "scene") == 0) != scene) continue;
      if (scene) {
        b->kind_line = nl->group[i].line;
        b->kind_column = nl->group[i].column;
        found = 1;
      }
      read_group(b, &nl->group[i], name[i]);
    }
    int range = 0;
    const deck_given *kind = &b->given[deck_table_find("scene", "kind", 0, &range)];
    if (!scene || kind->given || kind->broken) continue;
    if (!found && (nl->groups > 0 || b->errors->count == 0))
      namelist_error_at(nl, 1, 1, 1, b->errors, "the deck has no group &scene with a 'kind'");
    else if (found && !kind->group->broken)
      namelist_error_at(nl, b->kind_line, b->kind_column, 6, b->errors, "&scene needs a 'kind'");
  }
}

/* The name of the deck without folder and extension, with .h5, in the working directory. */
static void default_output(deck *d, const char *name)
{
  const char *slash = strrchr(name, '/');
  const char *base = slash != NULL ? slash + 1 : name;
  const char *dot = strrchr(base, '.');
  size_t n = dot != NULL && dot > base ? (size_t)(dot - base) : strlen(base);
  if (n == 0 || strcmp(base, "-") == 0) {
    base = "resonance";
    n = strlen(base);
  }
  if (n > DECK_PATH - 4) n = DECK_PATH - 4;
  snprintf(d->output, sizeof d->output, "%.*s.h5", (int)n, base);
}

static pendres_status keep_text(deck *d, const namelist *nl)
{
  d->name = malloc(strlen(nl->name) + 1);
  d->text = malloc(nl->length + 1);
  if (d->name == NULL || d->text == NULL) return PENDRES_OUT_OF_MEMORY;
  strcpy(d->name, nl->name);
  memcpy(d->text, nl->text, nl->length + 1);
  d->text_length = nl->length;
  return PENDRES_OK;
}

/* nl may hold the remains of a text with errors: the rest of them is found here. */
static pendres_status build(const namelist *nl, deck *out, namelist_errors *errors)
{
  deck d = { 0 };
  deck_builder b = { .nl = nl, .errors = errors, .d = &d, .kind_line = 1, .kind_column = 1 };

  deck_key_defaults(&d);
  default_output(&d, nl->name);
  read_groups(&b);
  deck_check(&b);
  namelist_errors_sort(errors);
  if (b.out_of_memory || errors->out_of_memory) goto no_memory;
  if (errors->count > 0) {
    deck_free(&d);
    return PENDRES_INVALID_ARGUMENT;
  }
  if (keep_text(&d, nl) != PENDRES_OK) goto no_memory;
  *out = d;
  return PENDRES_OK;
no_memory:
  errors->out_of_memory = 1;
  deck_free(&d);
  return PENDRES_OUT_OF_MEMORY;
}

static pendres_status finish(pendres_status parsed, namelist *nl, deck *out,
                             namelist_errors *errors)
{
  pendres_status status = parsed;
  *out = (deck){ 0 };
  if (parsed == PENDRES_OK || (parsed == PENDRES_INVALID_ARGUMENT && nl->length > 0))
    status = build(nl, out, errors);
  namelist_free(nl);
  return status;
}

pendres_status deck_read(const char *path, deck *out, namelist_errors *errors)
{
  namelist nl = { 0 };
  const pendres_status status = namelist_read(path, &nl, errors);
  return finish(status, &nl, out, errors);
}

pendres_status deck_read_memory(const char *name, const char *text, size_t length, deck *out,
                                namelist_errors *errors)
{
  namelist nl = { 0 };
  const pendres_status status = namelist_parse(name, text, length, &nl, errors);
  return finish(status, &nl, out, errors);
}

void deck_free(deck *d)
{
  if (d == NULL) return;
  free(d->name);
  free(d->text);
  for (int i = 0; i < DECK_AXIS_COUNT; i++) {
    free(d->axis[i].value);
    free(d->axis[i].listed);
  }
  free(d->methods.name);
  free(d->cases.name);
  *d = (deck){ 0 };
}
