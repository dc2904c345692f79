/*
 * outer.c -- the outer axis: a number of the deck, named by &outer, for each value of which the
 * scene is computed once. Whatever reads a deck sees one of these scenes, that of the value of the
 * largest size; deck_slice() gives the number any other one.
 */
#include "deck/table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pendres/names.h>

enum { MOST_SLICES = 1000 };

/* ---- the number that is meant -------------------------------------------------------------- */

/* Whether a row is a single number that an outer axis can vary. */
static int may_vary(const deck_key *key, unsigned scene)
{
  static const char *const never[] = { "scene", "units", "sweep", "outer" };
  for (size_t i = 0; i < sizeof never / sizeof *never; i++)
    if (strcmp(key->group, never[i]) == 0) return 0;
  return (key->scenes & scene) != 0 && (key->type == DECK_REAL || key->type == DECK_INTEGER ||
                                        key->type == DECK_SWEEP_VALUE);
}

/* k of "a1" to "a5"; 0: it is no coefficient. */
static int coefficient_of(const char *name)
{
  const int p = pendres_name_find(PENDRES_NAMES_PARAMETER, name);
  return p >= 0 ? pendres_parameter_of((pendres_parameter)p)->coefficient : 0;
}

/* The row of "damping", "hysteresis.rate" or "a3", which is an element of its key. */
static size_t find_row(const deck_builder *b, const char *text, int *coefficient)
{
  const char *dot = strchr(text, '.'), *name = dot != NULL ? dot + 1 : text;
  const size_t n = dot != NULL ? (size_t)(dot - text) : 0;
  int range = 0;
  *coefficient = dot == NULL || strncmp(text, "pendulum.", n + 1) == 0 ? coefficient_of(name) : 0;
  if (*coefficient > 0)
    return deck_table_find("pendulum", "force_coefficients", b->scene, &range);
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if (dot != NULL && (strlen(key->group) != n || strncmp(key->group, text, n) != 0)) continue;
    if (strcmp(key->name, name) == 0 && may_vary(key, b->scene)) return i;
  }
  return deck_table_size;
}

static void complain_of_key(deck_builder *b, const char *text)
{
  deck_suggestion s = { .word = text };
  char hint[100];
  for (size_t i = 0; i < deck_table_size; i++)
    if (may_vary(&deck_table[i], b->scene)) deck_suggest(&s, deck_table[i].name);
  deck_complain(b, deck_given_of(b, "outer", "key"), "key",
                "'%.40s' is no single number of scene '%s'%s: give a parameter of &pendulum, or a "
                "number of another group as GROUP.KEY", text, deck_kind_name(b->d->kind),
                deck_suggestion_text(&s, hint, sizeof hint));
}

void deck_outer_find(deck_builder *b)
{
  deck *d = b->d;
  if (d->outer.key[0] == '\0' || !deck_in_scene(b, "outer", "key")) return;
  for (size_t n = strlen(d->outer.key); n > 0 && d->outer.key[n - 1] == ' ';)
    d->outer.key[--n] = '\0';
  d->outer.row = find_row(b, d->outer.key, &d->outer.coefficient);
  d->outer.known = d->outer.row < deck_table_size;
  if (!d->outer.known) complain_of_key(b, d->outer.key);
}

deck_key deck_outer_values(const deck *d, const deck_key *values)
{
  int range = 0;
  deck_key key = *values;
  if (!d->outer.known) return key;
  char name[] = "a0";
  name[1] = (char)('0' + d->outer.coefficient);
  const size_t row = d->outer.coefficient > 0 ? deck_table_find("sweep", name, 0, &range)
                                              : d->outer.row;
  key = deck_table[row];
  key.group = values->group;
  key.type = values->type;
  key.axis = values->axis;
  key.when = values->when;
  return key;
}

/* ---- its values ---------------------------------------------------------------------------- */

int deck_outer_is(const deck *d, const deck_key *key)
{
  if (!d->outer.known || d->outer.coefficient > 0) return 0;
  const deck_key *own = &deck_table[d->outer.row];
  const int axis = own->type == DECK_SWEEP_VALUE || own->when == DECK_UNLESS_AXIS;
  const int other = key->type == DECK_SWEEP_VALUE || key->type == DECK_SWEEP ||
                    key->when == DECK_UNLESS_AXIS;
  return key == own || (axis && other && key->axis == own->axis);
}

/* Give the number one value; of an axis it is where that has its values. */
static void set_value(deck *d, double *value)
{
  const deck_key *key = &deck_table[d->outer.row];
  char *field = (char *)d + key->offset;
  if (d->outer.coefficient > 0)
    d->pendulum.force_coefficients[d->outer.coefficient - 1] = *value;
  else if (key->type == DECK_SWEEP_VALUE)
    d->axis[key->axis] =
      (deck_axis){ .value = value, .count = 1, .listed = value, .listed_count = 1 };
  else if (key->type == DECK_INTEGER) *(int64_t *)field = (int64_t)*value;
  else *(double *)field = *value;
}

/* Complain of a value that stands elsewhere, too. */
static int is_given_twice(deck_builder *b)
{
  const deck *d = b->d;
  const int k = d->outer.coefficient;
  const deck_given *at = deck_given_of(b, "outer", "key");
  if (k > 0 && d->pendulum.force_coefficients[k - 1] != 0.0) {
    deck_complain(b, at, "key", "'a%d' is given in 'force_coefficients' too: give 0 there", k);
    return 1;
  }
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if ((key->scenes & b->scene) == 0 || !deck_outer_is(d, key) || !deck_is_there(&b->given[i]))
      continue;
    deck_complain(b, &b->given[i], key->name, "'%s' has its values in &outer (line %d): leave out "
                  "one of the two", key->name, at->at.line);
    return 1;
  }
  return 0;
}

static const char *refuse_values(const deck *d)
{
  const deck_axis *a = &d->axis[DECK_AXIS_OUTER];
  const deck_key *key = &deck_table[d->outer.row];
  if (a->count > MOST_SLICES) return "an outer axis has 1000 values at most";
  for (size_t i = 0; i < a->count; i++)
    if (key->type == DECK_INTEGER && a->value[i] != rint(a->value[i]))
      return "the outer axis takes whole numbers";
  return NULL;
}

void deck_outer_apply(deck_builder *b)
{
  deck *d = b->d;
  const deck_given *key = deck_given_of(b, "outer", "key");
  const deck_given *values = deck_given_of(b, "outer", "values");
  if (!deck_is_there(key) && !deck_is_there(values)) return;
  if (!deck_is_there(key) || !deck_is_there(values)) {
    deck_complain(b, deck_is_there(key) ? key : values, deck_is_there(key) ? "key" : "values",
                  "an outer axis has both: 'key', what varies, and 'values' or 'values_range'");
    return;
  }
  if (!d->outer.known || key->broken || is_given_twice(b)) return;
  deck_given *own = &b->given[d->outer.row];
  *own = *values; /* a bad value is not called missing, too */
  deck_expand_axis(b, DECK_AXIS_OUTER);
  if (values->broken || b->out_of_memory || d->axis[DECK_AXIS_OUTER].count == 0) return;
  const char *why = refuse_values(d);
  if (why != NULL) {
    deck_complain(b, values, "values", "%s", why);
    return;
  }
  double largest = deck_axis_largest(&d->axis[DECK_AXIS_OUTER]);
  set_value(d, &largest);
  deck_axis *axis = &d->axis[deck_table[d->outer.row].axis];
  if (axis->listed != &largest) return;
  *axis = (deck_axis){ .listed = malloc(sizeof largest), .listed_count = 1 }; /* the deck's own */
  if (axis->listed == NULL) b->out_of_memory = 1;
  else *axis->listed = largest;
}

/* What the results have as an axis already cannot be an outer one. */
void deck_outer_check(deck_builder *b)
{
  const deck *d = b->d;
  if (!d->outer.known) return;
  const deck_key *key = &deck_table[d->outer.row];
  const int over = key->type == DECK_SWEEP_VALUE || key->when == DECK_UNLESS_AXIS;
  const int temperature = over && key->axis == DECK_AXIS_TEMPERATURE && d->kind != DECK_HYSTERESIS;
  if (over && d->outer.coefficient == 0 &&
      (temperature || deck_has_axis(d, (deck_axis_id)key->axis)))
    deck_complain(b, deck_given_of(b, "outer", "key"), "key",
                  "'%s' is an axis of the results without &outer: give its values in &sweep",
                  key->name);
}

/* ---- one of the scenes --------------------------------------------------------------------- */

size_t deck_slices(const deck *d)
{
  return d->outer.known ? d->axis[DECK_AXIS_OUTER].count : 0;
}

const char *deck_outer_name(const deck *d, char name[2 * DECK_NAME])
{
  const deck_key *key = &deck_table[d->outer.row];
  const int own = strcmp(key->group, "pendulum") == 0;
  if (d->outer.coefficient > 0) snprintf(name, 2 * DECK_NAME, "a%d", d->outer.coefficient);
  else snprintf(name, 2 * DECK_NAME, "%s%s%s", own ? "" : key->group, own ? "" : "_", key->name);
  return name;
}

const char *deck_outer_words(const deck *d)
{
  return d->outer.coefficient > 0 ? "coefficient of the force"
                                  : deck_table_words(&deck_table[d->outer.row])->meaning;
}

deck deck_slice(const deck *d, size_t slice)
{
  const deck_key *key = &deck_table[d->outer.row];
  double *value = &d->axis[DECK_AXIS_OUTER].value[slice];
  deck one = *d;
  one.outer.known = 0;
  one.outer.key[0] = '\0';
  one.axis[DECK_AXIS_OUTER] = (deck_axis){ 0 };
  set_value(&one, value);
  if (key->type == DECK_REAL && (key->offset == offsetof(deck, drive_period) ||
                                 key->offset == offsetof(deck, pendulum.drive_frequency)))
    deck_derive_clock(&one);
  return one;
}
