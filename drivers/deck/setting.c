/*
 * setting.c -- keys that are set outside of the deck, `pendulum.damping=0.13`: each is read
 * like a deck of one key, and takes the place of all that the deck says of the same quantity.
 */
#include "deck/table.h"

#include <stdlib.h>
#include <string.h>

/* The end of the name that starts at `text`; `text` itself if none does. */
static const char *name_end(const char *text)
{
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  static const char others[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  return strspn(text, letters) == 0 ? text : text + strspn(text, others);
}

int deck_is_setting(const char *argument)
{
  const char *point = name_end(argument);
  if (point == argument || *point != '.') return 0;
  const char *end = name_end(point + 1);
  if (end == point + 1) return 0;
  if (*end == '(') end += strcspn(end, ")") + (strchr(end, ')') != NULL);
  return *end == '=';
}

/* The row that a setting is about, in a scene if that is known; deck_table_size if none is. */
static size_t row_of(const namelist *setting, unsigned scene)
{
  int range = 0;
  if (setting->groups == 0 || setting->assignments == 0) return deck_table_size;
  return deck_table_find(setting->group[0].name, setting->assignment[0].name, scene, &range);
}

/* A shell takes quotes away, so a string is all that stands behind the equals sign. */
static int is_string(const char *setting)
{
  const char *point = strchr(setting, '.');
  const size_t n = point == NULL ? 0 : (size_t)(point - setting), m = strcspn(setting, "=");
  for (size_t i = 0; i < deck_table_size && n > 0 && m > n; i++) {
    const deck_key *key = &deck_table[i];
    if (key->type != DECK_STRING && key->type != DECK_CHOICE) continue;
    if (strlen(key->group) == n && strncmp(setting, key->group, n) == 0 &&
        strlen(key->name) == m - n - 1 && strncmp(point + 1, key->name, m - n - 1) == 0)
      return 1;
  }
  return 0;
}

pendres_status deck_settings_parse(const char *const *text, size_t count, namelist **settings,
                                   namelist_errors *errors)
{
  pendres_status status = PENDRES_OK;
  *settings = calloc(count + 1, sizeof **settings);
  if (*settings == NULL) status = PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < count && status != PENDRES_OUT_OF_MEMORY; i++) {
    const pendres_status parsed =
      namelist_parse_setting(text[i], (int)i + 1, is_string(text[i]), &(*settings)[i], errors);
    if (parsed != PENDRES_OK) status = parsed;
  }
  if (status == PENDRES_OUT_OF_MEMORY) errors->out_of_memory = 1;
  return status;
}

void deck_settings_free(namelist *settings, size_t count)
{
  for (size_t i = 0; i < count && settings != NULL; i++) namelist_free(&settings[i]);
  free(settings);
}

static int is_axis(const deck_key *key)
{
  return key->type == DECK_SWEEP || key->type == DECK_SWEEP_VALUE;
}

/* Frequency and period of the drive are one quantity, whatever the form. */
static int is_drive(const deck_key *key)
{
  if (is_axis(key)) return deck_is_clock(key->axis);
  return key->when == DECK_BY_FREQUENCY || key->when == DECK_BY_PERIOD;
}

/* Does the key belong to an axis: as the axis itself, or as its only value? */
static int has_axis(const deck_key *key)
{
  return is_axis(key) || key->when == DECK_UNLESS_AXIS;
}

static int same_quantity(const deck_key *a, const deck_key *b)
{
  if (a == b || (is_drive(a) && is_drive(b))) return 1;
  return has_axis(a) && has_axis(b) && a->axis == b->axis;
}

int deck_is_set(const deck_builder *b, size_t row)
{
  for (size_t i = 0; i < b->setting_count; i++) {
    const size_t other = row_of(&b->settings[i], b->scene);
    if (other < deck_table_size && same_quantity(&deck_table[row], &deck_table[other])) return 1;
  }
  return 0;
}

int deck_is_set_before(deck_builder *b, size_t index)
{
  const namelist *nl = &b->settings[index];
  const namelist_assignment *a = &nl->assignment[0];
  for (size_t i = 0; i < index; i++) {
    const namelist *other = &b->settings[i];
    if (other->groups == 0 || other->assignments == 0 ||
        strcmp(other->group[0].name, nl->group[0].name) != 0 ||
        strcmp(other->assignment[0].name, a->name) != 0)
      continue;
    namelist_error_at(nl, a->at, b->errors, "'%s.%s' is set twice", nl->group[0].name, a->name);
    return 1;
  }
  return 0;
}
