/* key.c -- the values of one key: type, range, choice, default; see table.h. */
#include "deck/namelist/lex.h"
#include "deck/table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Names in one list, more than there are methods to compare. */
enum { MAX_NAMES = 1000 };

static void *field(deck *d, const deck_key *key)
{
  return (char *)d + key->offset;
}

static void complain(deck_builder *b, const namelist_value *v, const char *key, const char *message)
{
  namelist_error_at(b->nl, v->at, b->errors, "'%s' %s", key, message);
}

/* What a number must be, in the simplest words for its range. */
static void describe_range(const deck_key *key, double x, char *text, size_t size)
{
  if (!isfinite(x)) snprintf(text, size, "must be a finite number");
  else if (key->low == 0.0 && key->open && x <= 0.0) snprintf(text, size, "must be positive");
  else if (key->low == 0.0 && x < 0.0) snprintf(text, size, "must not be negative");
  else if (key->low > 0.0 && x <= 0.0) snprintf(text, size, "must be positive");
  else
    snprintf(text, size, "must lie between %.7g and %.7g%s%s%s", key->low, key->high,
             key->open ? " (both excluded)" : "", key->why != NULL ? ": " : "",
             key->why != NULL ? key->why : "");
}

static int in_range(deck_builder *b, const deck_key *key, const namelist_value *v, const char *name,
                    double x)
{
  char text[120];
  /* Written so that a NaN is outside. */
  if (key->open ? x > key->low && x < key->high : x >= key->low && x <= key->high) return 1;
  describe_range(key, x, text, sizeof text);
  complain(b, v, name, text);
  return 0;
}

static int read_real(deck_builder *b, const deck_key *key, const namelist_value *v,
                     const char *name, double *out)
{
  if (deck_value_has_unit(b->nl, v))
    return deck_quantity_read(b, key, v, name, out) && in_range(b, key, v, name, *out);
  return namelist_value_real(b->nl, v, name, out, b->errors) && in_range(b, key, v, name, *out);
}

/* Fortran pads strings with blanks; a choice ignores them and the case of letters. */
static int same_choice(const char *a, const char *b)
{
  size_t i = 0;
  for (; a[i] != '\0' && b[i] != '\0'; i++)
    if (lex_lower(a[i]) != b[i]) return 0;
  return a[i] == b[i];
}

static void trim(char *text)
{
  size_t n = strlen(text);
  while (n > 0 && text[n - 1] == ' ') text[--n] = '\0';
}

/* The index of the choice; after a typing error that of the nearest one, with *wrong set; or -1. */
static int read_choice(deck_builder *b, const deck_key *key, const namelist_value *v, int *wrong)
{
  char text[DECK_PATH], list[300] = "", hint[100];
  const char *synonym = NULL;
  char word[DECK_PATH];
  deck_suggestion s = { 0 };
  *wrong = 1;
  if (!namelist_value_string(b->nl, v, key->name, text, sizeof text, b->errors)) return -1;
  trim(text);
  s.word = text;
  for (int i = 0; key->choices[i] != NULL; i++) {
    if (same_choice(text, key->choices[i])) {
      *wrong = 0;
      return i;
    }
    deck_suggest(&s, key->choices[i]);
    if (key->choices[i][0] != '\0')
      snprintf(list + strlen(list), sizeof list - strlen(list), "%s'%s'",
               list[0] == '\0' ? "" : ", ", key->choices[i]);
  }
  for (size_t k = 0; k <= strlen(text); k++) word[k] = (char)lex_lower(text[k]);
  for (size_t k = 0; s.best == NULL && (synonym = deck_synonym(word, k)) != NULL; k++)
    for (int i = 0; key->choices[i] != NULL; i++)
      if (same_choice(synonym, key->choices[i])) s.best = key->choices[i];
  namelist_error_at(b->nl, v->at, b->errors, "'%s' knows no '%.40s'%s; it takes %s", key->name,
                    text, deck_suggestion_text(&s, hint, sizeof hint), list);
  for (int i = 0; s.best != NULL && key->choices[i] != NULL; i++)
    if (key->choices[i] == s.best) return i;
  return -1;
}

/* ---- scalars ------------------------------------------------------------------------------- */

static int apply_choice(deck_builder *b, const deck_key *key, const namelist_value *v)
{
  int wrong = 0;
  const int i = read_choice(b, key, v, &wrong);
  if (key->offset == offsetof(deck, kind)) {
    /* Take the nearest kind, so that the rest of the deck can be checked too. */
    b->scene = i < 0 ? 0 : 1u << i;
    if (i >= 0) b->d->kind = (deck_kind)i;
    b->kind_nl = b->nl;
    b->kind_at = v->at;
  } else if (i >= 0) {
    strcpy(field(b->d, key), key->choices[i]);
  }
  return !wrong;
}

static int apply_scalar(deck_builder *b, const deck_key *key, const namelist_value *v)
{
  void *f = field(b->d, key);
  int64_t n = 0;
  switch (key->type) {
  case DECK_REAL:
    return read_real(b, key, v, key->name, f);
  case DECK_INTEGER:
    if (!namelist_value_integer(b->nl, v, key->name, &n, b->errors)) return 0;
    if (!in_range(b, key, v, key->name, (double)n)) return 0;
    *(int64_t *)f = n;
    return 1;
  case DECK_LOGICAL:
    return namelist_value_logical(b->nl, v, key->name, f, b->errors);
  case DECK_STRING:
    if (key->offset == offsetof(deck, formula)) return deck_formula_read(b, v, f, key->size);
    return namelist_value_string(b->nl, v, key->name, f, key->size, b->errors);
  case DECK_CHOICE:
    return apply_choice(b, key, v);
  default:
    return 0;
  }
}

/* ---- lists --------------------------------------------------------------------------------- */

static int apply_names(deck_builder *b, const deck_key *key, const namelist_array *array)
{
  deck_names *names = field(b->d, key);
  int good = 1;
  if (array->count > MAX_NAMES) {
    complain(b, array->item[MAX_NAMES], key->name, "takes at most 1000 names");
    return 0;
  }
  names->name = calloc(array->count, sizeof *names->name);
  if (names->name == NULL) {
    b->out_of_memory = 1;
    return 0;
  }
  for (size_t i = 0; i < array->count; i++) {
    const namelist_value *v = array->item[i];
    char *name = names->name[names->count];
    int wrong = 0;
    if (key->choices == NULL) {
      wrong = !namelist_value_string(b->nl, v, key->name, name, sizeof *names->name, b->errors);
    } else {
      const int choice = read_choice(b, key, v, &wrong);
      if (choice >= 0) strcpy(name, key->choices[choice]);
    }
    for (size_t k = 0; !wrong && !key->repeats && k < names->count; k++) {
      if (strcmp(names->name[k], name) != 0) continue;
      complain(b, v, key->name, "names this one twice");
      wrong = 1;
    }
    if (wrong) good = 0;
    else names->count++;
  }
  return good;
}

static int apply_bounds(deck_builder *b, const deck_key *key, const namelist_array *array)
{
  double *bound = field(b->d, key);
  int good = 1;
  if (array->count > 2) {
    complain(b, array->item[2] != NULL ? array->item[2] : array->item[array->count - 1], key->name,
             "takes two values here, the bounds of the search: lowest, highest");
    return 0;
  }
  for (size_t i = 0; i < array->count; i++) /* a null value leaves the default */
    if (array->item[i] != NULL && !read_real(b, key, array->item[i], key->name, &bound[i]))
      good = 0;
  if (good && !(bound[0] < bound[1])) {
    complain(b, array->item[array->count - 1], key->name, "must ascend: lowest, highest");
    good = 0;
  }
  return good;
}

static int apply_numbers(deck_builder *b, const deck_key *key, const namelist_array *array)
{
  const size_t room = key->size / sizeof(double);
  double *number = field(b->d, key);
  int good = 1;
  if (array->count > room) {
    complain(b, array->item[room] != NULL ? array->item[room] : array->item[array->count - 1],
             key->name, "takes five numbers at most");
    return 0;
  }
  for (size_t i = 0; i < array->count; i++) { /* a null value leaves zero */
    const namelist_value *v = array->item[i];
    if (v == NULL) continue;
    if (deck_value_has_unit(b->nl, v) ? !deck_coefficient_read(b, key, v, (int)i + 1)
                                      : !read_real(b, key, v, key->name, &number[i]))
      good = 0;
  }
  return good;
}

/* Take all numbers of an array, in place of those that the field has. */
static int read_numbers(deck_builder *b, const deck_key *key, const namelist_array *array,
                        double **numbers, size_t *count)
{
  int good = 1;
  double *read = malloc(array->count * sizeof *read);
  if (read == NULL) {
    b->out_of_memory = 1;
    return 0;
  }
  for (size_t i = 0; i < array->count; i++)
    if (!read_real(b, key, array->item[i], key->name, &read[i])) good = 0;
  free(*numbers);
  *numbers = read;
  *count = good ? array->count : 0;
  return good;
}

static int apply_list(deck_builder *b, const deck_key *key, const namelist_array *array)
{
  deck_numbers *list = field(b->d, key);
  return read_numbers(b, key, array, &list->number, &list->count);
}

static int apply_range(deck_builder *b, const deck_key *key, const namelist_array *array,
                       const char *name)
{
  deck_axis *axis = &b->d->axis[key->axis];
  double first = 0.0, last = 0.0;
  int64_t count = 0;
  int good = 1;
  if (array->count != 3) {
    complain(b, array->item[array->count > 3 ? 3 : array->count - 1], name,
             "takes three values: first, last, count");
    return 0;
  }
  if (!read_real(b, key, array->item[0], name, &first)) good = 0;
  if (!read_real(b, key, array->item[1], name, &last)) good = 0;
  if (!namelist_value_integer(b->nl, array->item[2], name, &count, b->errors)) return 0;
  if (count < 1 || count > DECK_MAX_COUNT) {
    complain(b, array->item[2], name, "must have a count between 1 and 1000000");
    good = 0;
  } else if (good && first > last) {
    complain(b, array->item[0], name, "must ascend: first, last, count");
    good = 0;
  } else if (good && (count == 1) != (first == last)) {
    complain(b, array->item[2], name,
             count == 1 ? "has one value only where first and last agree"
                        : "has several values only where first and last differ");
    good = 0;
  }
  if (!good) return 0;
  axis->range_first = first;
  axis->range_last = last;
  axis->range_count = (size_t)count;
  return 1;
}

static int apply_listed(deck_builder *b, const deck_key *key, const namelist_array *array)
{
  deck_axis *axis = &b->d->axis[key->axis];
  return read_numbers(b, key, array, &axis->listed, &axis->listed_count);
}

/* ---- any key ------------------------------------------------------------------------------- */

static int is_list(const deck_key *key)
{
  return key->type == DECK_CHOICES || key->type == DECK_LIST || key->type == DECK_SWEEP;
}

/* Is it the name of a key of that group, so that its equals sign has probably been forgotten? */
static int is_key_name(const deck_builder *b, const deck_key *key, const namelist_value *v,
                       size_t *row)
{
  for (size_t i = 0; v->form == NAMELIST_BARE && i < deck_table_size; i++) {
    const size_t n = strlen(deck_table[i].name);
    if (strcmp(deck_table[i].group, key->group) != 0 || v->length != n || n < 2) continue;
    if (strncmp(b->nl->text + v->begin, deck_table[i].name, n) != 0) continue;
    *row = i;
    return 1;
  }
  return 0;
}

/* `0,2`: a comma between digits without a blank. */
static int is_decimal_comma(const deck_builder *b, const namelist_value *v)
{
  const char *t = b->nl->text + v->begin;
  return v->begin >= 2 && t[-1] == ',' && t[-2] >= '0' && t[-2] <= '9' && *t >= '0' && *t <= '9';
}

/* Errors that do not depend on the type: gaps, too many values, a forgotten equals sign. */
static int check_shape(deck_builder *b, const deck_key *key, const namelist_array *array, int range)
{
  for (size_t i = 0; i < array->count; i++) {
    const namelist_value *v = array->item[i];
    size_t row = 0;
    if (v == NULL && (is_list(key) || range)) {
      namelist_place at = array->at;
      at.width = (int)strlen(key->name);
      namelist_error_at(b->nl, at, b->errors, "'%s': value %zu is missing (a blank after 'r*', or "
                        "two commas?)", key->name, i + 1);
      return 0;
    }
    if (v == NULL) continue;
    if (is_key_name(b, key, v, &row)) {
      namelist_error_at(b->nl, v->at, b->errors, "expected '=' after '%s'",
                        deck_table[row].name);
      b->given[row].broken = 1;
      return 0;
    }
    if (i == 0 || is_list(key) || key->type == DECK_BOUNDS || key->type == DECK_NUMBERS)
      continue;
    complain(b, v, key->name,
             key->type == DECK_SWEEP_VALUE ? "takes one value; a list belongs in &sweep"
             : is_decimal_comma(b, v)      ? "takes one value (decimals have a point)"
                                           : "takes one value");
    return 0;
  }
  return 1;
}

void deck_key_apply(deck_builder *b, size_t row, const namelist_array *array, int range)
{
  const deck_key *key = &deck_table[row];
  deck_given *given = &b->given[row];
  char name[2 * DECK_NAME];
  int good = !array->broken;
  snprintf(name, sizeof name, "%s%s", key->name, range ? "_range" : "");
  const deck_key of_outer = deck_outer_values(b->d, key);
  if (key->type == DECK_SWEEP && key->axis == DECK_AXIS_OUTER) key = &of_outer;
  if (good && array->count == 0) return; /* nothing but null values */
  if (!given->given) {
    given->nl = b->nl;
    given->at = array->at;
  }
  if (good) good = check_shape(b, key, array, range);
  if (good && key->type == DECK_SWEEP && range) good = apply_range(b, key, array, name);
  else if (good && (key->type == DECK_SWEEP || key->type == DECK_SWEEP_VALUE))
    good = apply_listed(b, key, array);
  else if (good && key->type == DECK_BOUNDS) good = apply_bounds(b, key, array);
  else if (good && key->type == DECK_NUMBERS) good = apply_numbers(b, key, array);
  else if (good && key->type == DECK_LIST) good = apply_list(b, key, array);
  else if (good && is_list(key)) good = apply_names(b, key, array);
  else if (good) good = apply_scalar(b, key, array->item[0]);
  if (good) given->given = 1;
  else given->broken = 1;
}

void deck_key_defaults(deck_builder *b)
{
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    void *f = field(b->d, key);
    if (b->given[i].given || (b->scene != 0 && (key->scenes & b->scene) == 0)) continue;
    switch (key->type) {
    case DECK_REAL:
      *(double *)f = key->number;
      break;
    case DECK_BOUNDS:
      ((double *)f)[0] = key->number;
      ((double *)f)[1] = key->number2;
      break;
    case DECK_INTEGER:
      *(int64_t *)f = (int64_t)key->number;
      break;
    case DECK_LOGICAL:
      *(int *)f = key->number != 0.0;
      break;
    case DECK_CHOICE:
    case DECK_STRING:
      if (key->text != NULL) strcpy(f, key->text);
      break;
    default:
      break;
    }
  }
}

const deck_when_words *deck_when_of(deck_when when)
{
  static const deck_when_words words[] = {
#define DECK_WHEN_WORDS(code, condition, why) {condition, why},
    DECK_WHEN_LIST(DECK_WHEN_WORDS)
#undef DECK_WHEN_WORDS
  };
  return &words[when];
}

int deck_key_applies(const deck_key *key, const deck *d)
{
  switch (key->when) {
  case DECK_WITH_NOISE: return deck_has_noise(d);
  case DECK_WITH_RAMP: return deck_has_ramp(d);
  case DECK_WITHOUT_START: return d->orbit.start[0] == '\0';
  case DECK_OFF_LINE: return strcmp(d->ensemble.shape, "line") != 0;
  case DECK_IN_RECTANGLE: return strcmp(d->ensemble.shape, "rectangle") == 0;
  case DECK_AT_RANDOM: return strcmp(d->ensemble.shape, "random") == 0;
  case DECK_WITH_SEARCH: return deck_searches(d);
  case DECK_UNLESS_AXIS:
    return d->axis[key->axis].listed_count + d->axis[key->axis].range_count == 0;
  case DECK_WITH_FORMULA: return d->formula[0] != '\0';
  case DECK_WITH_OUTER: return d->outer.key[0] != '\0';
  case DECK_BY_FREQUENCY: return !d->by_period;
  case DECK_BY_PERIOD: return d->by_period;
  default: return 1;
  }
}
