/* read.c -- from the tree of a namelist to a checked deck; see deck.h. */
#include "deck/table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void read_key(deck_builder *b, const namelist_group *g, const namelist_assignment *a,
                     const char *group)
{
  namelist_array array = { 0 };
  int range = 0;
  const size_t row = deck_table_find(group, a->name, b->scene, &range);
  if (b->nl->order == 0 && row < deck_table_size && deck_is_set(b, row)) return;
  if (row == deck_table_size) {
    if (deck_table_find(group, a->name, 0, &range) < deck_table_size)
      deck_report_idle_key(b, a, group);
    else
      deck_report_unknown_key(b, a, group);
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

/* The order in which keys are read, wherever they stand: all depends on the kind of scene, scales
   on the force, numbers with units on the scales, and what a ramp does on what is swept. */
enum { STAGE_SCENE, STAGE_FORCE, STAGE_SCALES, STAGE_REST, STAGE_RAMP, STAGES };

/* The stage of a key; that of a group is that of a key which is none. */
static int stage_of(const char *group, const char *name)
{
  if (strcmp(group, "scene") == 0) return STAGE_SCENE;
  if (strcmp(group, "units") == 0) return STAGE_SCALES;
  if (strcmp(group, "outer") == 0 && strcmp(name, "key") == 0) return STAGE_FORCE;
  if (strcmp(name, "rate") == 0 || strcmp(name, "protocol") == 0) return STAGE_RAMP;
  if (strcmp(group, "pendulum") != 0) return STAGE_REST;
  if (strcmp(name, "force") == 0 || strcmp(name, "formula") == 0) return STAGE_FORCE;
  return strcmp(name, "force_coefficients") == 0 ? STAGE_SCALES : STAGE_REST;
}

/* The keys of a group of the deck, or the one of a setting, that are read at this stage. */
static void read_keys(deck_builder *b, const namelist_group *g, const char *group, int stage)
{
  if (b->scene != 0 && !deck_group_has_scene(group, b->scene)) {
    if (stage == stage_of(group, "")) deck_report_idle_group(b, g, group);
    return;
  }
  for (size_t i = 0; i < g->count; i++) {
    const namelist_assignment *a = &b->nl->assignment[g->begin + i];
    if (stage == stage_of(group, a->name) && !came_before(b, g, i)) read_key(b, g, a, group);
  }
}

static void read_group(deck_builder *b, const namelist_group *g, const char *group, int stage)
{
  for (size_t i = 0; i < deck_table_size; i++)
    if (strcmp(deck_table[i].group, group) == 0) b->given[i].group = g;
  read_keys(b, g, group, stage);
}

static void read_settings(deck_builder *b, int stage)
{
  const namelist *text = b->nl;
  for (size_t i = 0; i < b->setting_count; i++) {
    b->nl = &b->settings[i];
    if (b->nl->groups == 0 || b->nl->assignments == 0) continue; /* not understood, and reported */
    const namelist_group *g = &b->nl->group[0];
    const char *name = b->nl->assignment[0].name;
    if (stage_of(g->name, name) != stage) continue;
    const char *group = deck_resolve_group(b, g);
    if (group != NULL && !deck_is_set_before(b, i))
      read_keys(b, g, group, stage_of(group, name));
  }
  b->nl = text;
}

/* ---- the whole deck ------------------------------------------------------------------------ */

static void check_kind(deck_builder *b, int found)
{
  int range = 0;
  const namelist *nl = b->nl;
  const deck_given *kind = &b->given[deck_table_find("scene", "kind", 0, &range)];
  if (kind->given || kind->broken) return;
  if (!found && (nl->groups > 0 || b->errors->count == 0))
    namelist_error_at(nl, (namelist_place){ 1, 1, 1 }, b->errors,
                      "the deck has no group &scene with a 'kind'");
  else if (found && !kind->group->broken)
    namelist_error_at(nl, b->kind_at, b->errors, "&scene needs a 'kind'");
}

static void find_force(deck *d)
{
  for (int f = 0; f < PENDRES_FORCE_COUNT; f++)
    if (strcmp(d->force, pendres_model_of((pendres_force)f)->name) == 0)
      d->pendulum.force = (pendres_force)f;
}

static void read_groups(deck_builder *b)
{
  const char *name[NAMELIST_MAX_GROUPS] = { NULL };
  const namelist *nl = b->nl;
  int found = 0;
  for (size_t i = 0; i < nl->groups; i++)
    if (!nl->group[i].repeated) name[i] = deck_resolve_group(b, &nl->group[i]);
  for (int stage = 0; stage < STAGES; stage++) {
    for (size_t i = 0; i < nl->groups; i++) {
      if (name[i] == NULL) continue;
      if (stage == STAGE_SCENE && stage_of(name[i], "") == STAGE_SCENE) {
        b->kind_at = nl->group[i].at;
        found = 1;
      }
      read_group(b, &nl->group[i], name[i], stage);
    }
    read_settings(b, stage);
    if (stage == STAGE_SCENE) check_kind(b, found);
    if (stage == STAGE_SCENE && b->scene != 0) deck_key_defaults(b);
    if (stage == STAGE_FORCE) {
      find_force(b->d);
      deck_formula_find(b);
    }
    if (stage == STAGE_FORCE && b->scene != 0) deck_outer_find(b);
    if (stage == STAGE_SCALES && b->scene != 0) deck_scales_find(b);
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

static pendres_status keep_text(deck *d, const namelist *nl, const namelist *settings, size_t count)
{
  size_t size = 1, used = 0;
  for (size_t i = 0; i < count; i++) size += settings[i].length + 1;
  d->name = malloc(strlen(nl->name) + 1);
  d->text = malloc(nl->length + 1);
  d->settings = malloc(size);
  if (d->name == NULL || d->text == NULL || d->settings == NULL) return PENDRES_OUT_OF_MEMORY;
  strcpy(d->name, nl->name);
  memcpy(d->text, nl->text, nl->length + 1);
  d->text_length = nl->length;
  d->settings[0] = '\0';
  for (size_t i = 0; i < count; i++)
    used += (size_t)snprintf(d->settings + used, size - used, "%s%s", i > 0 ? " " : "",
                             settings[i].text);
  return PENDRES_OK;
}

/* nl may hold the remains of a text with errors: the rest of them is found here. */
static pendres_status build(const namelist *nl, const namelist *settings, size_t count, deck *out,
                            namelist_errors *errors)
{
  deck d = { 0 };
  deck_builder b = { .nl = nl, .settings = settings, .setting_count = count, .errors = errors,
                     .d = &d, .kind_nl = nl, .kind_at = { 1, 1, 1 }, .damping = NAN };
  for (int i = 0; i < PENDRES_FORCE_POWERS; i++) b.in_si[i] = NAN;

  deck_key_defaults(&b);
  default_output(&d, nl->name);
  read_groups(&b);
  deck_check(&b);
  namelist_errors_sort(errors);
  if (b.out_of_memory || errors->out_of_memory) goto no_memory;
  if (errors->count == 0 && keep_text(&d, nl, settings, count) != PENDRES_OK) goto no_memory;
  if (errors->count == 0) deck_check_slices(&b);
  if (b.out_of_memory || errors->out_of_memory) goto no_memory;
  if (errors->count > 0) {
    deck_free(&d);
    return PENDRES_INVALID_ARGUMENT;
  }
  *out = d;
  return PENDRES_OK;
no_memory:
  errors->out_of_memory = 1;
  deck_free(&d);
  return PENDRES_OUT_OF_MEMORY;
}

static pendres_status finish(pendres_status parsed, namelist *nl, const char *const *settings,
                             size_t count, deck *out, namelist_errors *errors)
{
  pendres_status status = parsed;
  *out = (deck){ 0 };
  if (parsed == PENDRES_OK || (parsed == PENDRES_INVALID_ARGUMENT && nl->length > 0)) {
    namelist *set = NULL;
    status = deck_settings_parse(settings, count, &set, errors);
    if (status != PENDRES_OUT_OF_MEMORY) status = build(nl, set, count, out, errors);
    deck_settings_free(set, count);
  }
  namelist_free(nl);
  return status;
}

pendres_status deck_read_set(const char *path, const char *const *settings, size_t count,
                             deck *out, namelist_errors *errors)
{
  namelist nl = { 0 };
  const pendres_status status = namelist_read(path, &nl, errors);
  return finish(status, &nl, settings, count, out, errors);
}

pendres_status deck_read_memory(const char *name, const char *text, size_t length, deck *out,
                                namelist_errors *errors)
{
  namelist nl = { 0 };
  const pendres_status status = namelist_parse(name, text, length, &nl, errors);
  return finish(status, &nl, NULL, 0, out, errors);
}

void deck_free(deck *d)
{
  if (d == NULL) return;
  free(d->name);
  free(d->text);
  free(d->settings);
  for (int i = 0; i < DECK_AXIS_COUNT; i++) {
    free(d->axis[i].value);
    free(d->axis[i].listed);
  }
  free(d->methods.name);
  free(d->data.columns.name);
  free(d->data.observables.name);
  free(d->data.units.name);
  free(d->fit.free.name);
  free(d->fit.fixed.name);
  free(d->fit.bounds.name);
  free(d->fit.prior.name);
  free(d->cases.name);
  free(d->ramp.protocol.number);
  *d = (deck){ 0 };
}
