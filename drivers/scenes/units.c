/*
 * units.c -- what a deck's &units make of results: attributes that tell what is SI of each, and
 * the short ones behind the table in these units.
 *
 * Numbers stay in the model's units, so that ours are what they are: files with and without can be
 * put together, and what is written has the same bytes.
 */
#include "scenes/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PRINTED = 20 };

void scene_mark_si(scene_run *run, const char *group, const char *name, const deck_si *si)
{
  if (!scene_going(run) || !results_has(run, group, name)) return;
  results_number(run, group, name, "si_factor", si->factor);
  results_attribute(run, group, name, "si_units", si->units);
}

void scene_mark_units(scene_run *run, const pendres_store_spec *spec, int errors)
{
  char error_name[DECK_NAME + 8];
  deck_si si;
  const int is_number = spec->type == PENDRES_STORE_DOUBLE;
  if (!is_number || !scene_going(run) || !deck_si_of(run->deck, spec->name, &si)) return;
  scene_mark_si(run, spec->group, spec->name, &si);
  (void)snprintf(error_name, sizeof error_name, "%.64s_error", spec->name);
  if (errors) scene_mark_si(run, spec->group, error_name, &si);
}

/* ---- behind the table ---------------------------------------------------------------------- */

/* A result or a coordinate: n values, and how they are printed. */
typedef struct shown {
  char name[DECK_NAME];
  char word[MOST_PRINTED][DECK_NAME]; /* behind a value, that says what a mere number does not */
  size_t n;
  double value[MOST_PRINTED], error[MOST_PRINTED]; /* in the unit that is printed */
  int has_error;
  char units[DECK_UNITS];
} shown;

/* Its values in SI, with the prefix that the largest of them, or of their errors, takes; without a
   unit as they are. */
static void read_shown(scene_run *run, const char *name, size_t n, shown *out)
{
  char error_name[DECK_NAME + 8];
  deck_si si = { .factor = 1.0 };
  double most = 0.0;
  *out = (shown){ .n = n };
  (void)snprintf(out->name, sizeof out->name, "%.63s", name);
  (void)snprintf(error_name, sizeof error_name, "%.64s_error", name);
  scene_stored(run, pendres_store_read(run->store, "", name, PENDRES_STORE_DOUBLE, out->value, n));
  out->has_error = scene_going(run) && pendres_store_has(run->store, "", error_name);
  if (out->has_error)
    scene_stored(run, pendres_store_read(run->store, "", error_name, PENDRES_STORE_DOUBLE,
                                         out->error, n));
  if (!deck_si_of(run->deck, name, &si)) return;
  for (size_t i = 0; i < n; i++)
    if (isfinite(out->value[i])) most = fmax(most, fabs(si.factor * out->value[i]));
  for (size_t i = 0; i < n && out->has_error; i++)
    if (isfinite(out->error[i])) most = fmax(most, si.factor * out->error[i]);
  si = deck_si_prefixed(&si, most);
  memcpy(out->units, si.units, sizeof out->units);
  for (size_t i = 0; i < n; i++) {
    out->value[i] *= si.factor;
    out->error[i] *= si.factor;
  }
}

/* A value with the digits that its error leaves, and two more; 0 if that leaves none. */
static void print_value(FILE *out, const shown *s, size_t i, int width)
{
  char text[80];
  const double e = s->error[i], x = fabs(s->value[i]) < 1e-3 * e ? 0.0 : s->value[i];
  int digits = 10, used = 0;
  if (isfinite(x) && isfinite(e) && e > 0.0 && x != 0.0) digits = (int)log10(fabs(x) / e) + 2;
  digits = digits < 3 ? 3 : digits > 15 ? 15 : digits;
  if (isnan(x)) used = snprintf(text, sizeof text, "-"); /* there is none */
  else used = snprintf(text, sizeof text, "%.*g", digits, x);
  if (s->word[i][0] != '\0') used += snprintf(text + used, sizeof text - (size_t)used, " (%s)",
                                              s->word[i]);
  if (s->has_error && !isnan(x) && e != 0.0) /* what is given has no error */
    used += snprintf(text + used, sizeof text - (size_t)used, " +- %.1g", e);
  if (width > 0) fprintf(out, "%-*s", used < width ? width : used + 1, text);
  else fputs(text, out);
}

/* The n codes `along`_`what`, if there are any. */
static int read_codes(scene_run *run, const char *along, const char *what, size_t n, char *name,
                      double *code)
{
  uint64_t sizes[PENDRES_STORE_RANK];
  int rank = 0;
  (void)snprintf(name, 2 * DECK_NAME, "%s_%s", along, what);
  if (!scene_going(run) || !pendres_store_has(run->store, "", name)) return 0;
  scene_stored(run, pendres_store_shape(run->store, "", name, &rank, sizes));
  if (!scene_going(run) || rank != 1 || sizes[0] != n) return 0;
  scene_stored(run, pendres_store_read(run->store, "", name, PENDRES_STORE_DOUBLE, code, n));
  return scene_going(run);
}

/* What the rows over a mere number are: the way of a jump, which step, what kind of bifurcation. */
static void read_words(scene_run *run, shown *along)
{
  static const char *const codes[] = {"direction", "label", "branch", "kind"};
  char name[2 * DECK_NAME];
  double code[MOST_PRINTED], turns[MOST_PRINTED];
  for (size_t k = 0; k < sizeof codes / sizeof *codes; k++) {
    char *meanings = NULL;
    if (!read_codes(run, along->name, codes[k], along->n, name, code)) continue;
    if (pendres_store_read_attribute_text(run->store, "", name, "flag_meanings", &meanings) !=
        PENDRES_OK)
      continue;
    for (size_t i = 0; i < along->n; i++) {
      const char *word = meanings;
      for (int skip = (int)code[i]; skip > 0 && *word != '\0'; skip--)
        word += strcspn(word, " ") + (word[strcspn(word, " ")] == ' ');
      (void)snprintf(along->word[i], DECK_NAME, "%.*s", (int)strcspn(word, " "), word);
    }
    free(meanings);
    return;
  }
  if (!read_codes(run, along->name, "winding", along->n, name, turns) ||
      !read_codes(run, along->name, "period", along->n, name, code))
    return;
  for (size_t i = 0; i < along->n; i++)
    (void)snprintf(along->word[i], DECK_NAME, code[i] == 1.0 ? "%g" : "%g/%g", turns[i], code[i]);
}

/* Whether it is a number of this rank with few values that has a unit, or a dimension; of rank 1,
   over that dimension unless it is NULL. */
static int is_wanted(scene_run *run, const char *name, int rank, const char *over, size_t *n)
{
  const size_t length = strlen(name);
  uint64_t sizes[PENDRES_STORE_RANK];
  char *along = NULL;
  deck_si si;
  int found = 0, wanted = 0;
  const int is_error = length > 6 && strcmp(name + length - 6, "_error") == 0;
  if (is_error || !scene_going(run)) return 0;
  scene_stored(run, pendres_store_shape(run->store, "", name, &found, sizes));
  if (!scene_going(run) || found != rank || sizes[0] == 0 || sizes[0] > MOST_PRINTED) return 0;
  *n = (size_t)sizes[0];
  if (rank == 0) return deck_si_of(run->deck, name, &si);
  scene_stored(run, pendres_store_dimension_of(run->store, "", name, 0, &along));
  if (along != NULL && over == NULL) wanted = strcmp(along, name) == 0;
  else if (along != NULL)
    wanted = strcmp(along, over) == 0 && strcmp(name, over) != 0 &&
             deck_si_of(run->deck, name, &si);
  free(along);
  return wanted;
}

/* The next number of the root from *at on; NULL: there are no more. To be freed. */
static char *next_number(scene_run *run, uint64_t *at)
{
  while (scene_going(run)) {
    char *name = NULL;
    pendres_store_type type;
    const pendres_status status = pendres_store_member(run->store, "", (*at)++, &type, &name);
    if (status == PENDRES_NOT_FOUND) return NULL;
    if (scene_stored(run, status) == PENDRES_OK && type != PENDRES_STORE_STRING &&
        type != PENDRES_STORE_TYPE_COUNT)
      return name;
    free(name);
  }
  return NULL;
}

static void tell_scalars(scene_run *run)
{
  char *name = NULL;
  shown s;
  size_t n = 0;
  for (uint64_t at = 0; (name = next_number(run, &at)) != NULL; free(name)) {
    if (!is_wanted(run, name, 0, NULL, &n)) continue;
    read_shown(run, name, 1, &s);
    if (isnan(s.value[0]) || (s.value[0] == 0.0 && !s.has_error)) continue; /* it is not there */
    fprintf(run->table, "%-26s ", name);
    print_value(run->table, &s, 0, 0);
    fprintf(run->table, "%s%s\n", s.units[0] != '\0' ? " " : "", s.units);
  }
}

/* A table of the results over one dimension, some columns at a time. */
static void tell_columns(scene_run *run, const shown *along, const shown *column, int columns)
{
  enum { WIDTH = 30 };
  char heading[2 * DECK_NAME];
  if (columns == 0) return;
  for (int k = -1; k < columns; k++) {
    const shown *s = k < 0 ? along : &column[k];
    (void)snprintf(heading, sizeof heading, "%s%s%s", s->name, s->units[0] != '\0' ? ", " : "",
                   s->units);
    fprintf(run->table, "%-*s", k + 1 < columns ? WIDTH : 0, heading);
  }
  fputc('\n', run->table);
  for (size_t i = 0; i < along->n; i++) {
    print_value(run->table, along, i, WIDTH);
    for (int k = 0; k < columns; k++)
      print_value(run->table, &column[k], i, k + 1 < columns ? WIDTH : 0);
    fputc('\n', run->table);
  }
}

/* What is held fixed is told without a dimension. */
static int varies(const shown *s)
{
  int varied = 0;
  for (size_t i = 0; i < s->n; i++) varied |= s->value[i] != s->value[0] || s->error[i] != 0.0;
  return varied;
}

static void tell_dimension(scene_run *run, const char *dimension, size_t n)
{
  enum { COLUMNS = 3 };
  shown along, column[COLUMNS];
  int columns = 0;
  char *name = NULL;
  size_t same = 0;
  read_shown(run, dimension, n, &along);
  read_words(run, &along);
  for (uint64_t at = 0; (name = next_number(run, &at)) != NULL; free(name)) {
    if (!is_wanted(run, name, 1, dimension, &same)) continue;
    read_shown(run, name, n, &column[columns]);
    if (n == 1 || varies(&column[columns])) columns++;
    if (columns < COLUMNS) continue;
    tell_columns(run, &along, column, columns);
    columns = 0;
  }
  tell_columns(run, &along, column, columns);
}

void scene_tell_units(scene_run *run)
{
  char *name = NULL;
  size_t n = 0;
  /* The table of a fit has its own column for them. */
  if (!deck_has_units(run->deck) || !scene_prints(run) || run->deck->kind == DECK_FIT) return;
  fputs("\nin SI:\n", run->table);
  tell_scalars(run);
  for (uint64_t at = 0; (name = next_number(run, &at)) != NULL; free(name))
    if (is_wanted(run, name, 1, NULL, &n)) tell_dimension(run, name, n);
}
