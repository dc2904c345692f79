/*
 * units.c -- what a deck's &units make of results: attributes that tell what is SI of each, and
 * the short ones behind the table in these units.
 *
 * Numbers stay in the model's units, so that ours are what they are: files with and without can be
 * put together, and what is written has the same bytes.
 */
#include "results/results.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows of a table: of a longer one every second, third, ... and the last. */
enum { MOST_PRINTED = 20 };

void scene_mark_si(scene_run *run, const char *group, const char *name, const deck_si *si)
{
  if (!scene_going(run) || !results_has(run, group, name)) return;
  results_number(run, group, name, "si_factor", si->factor);
  results_attribute(run, group, name, "si_units", si->units);
}

void scene_mark_units(scene_run *run, const pendres_store_spec *spec, pendres_kind kind,
                      int errors)
{
  char error_name[DECK_NAME + 8];
  deck_si si;
  const int is_number = spec->type == PENDRES_STORE_DOUBLE;
  if (!is_number || !scene_going(run) || !deck_si_of_kind(run->deck, kind, &si)) return;
  scene_mark_si(run, spec->group, spec->name, &si);
  (void)snprintf(error_name, sizeof error_name, "%.64s_error", spec->name);
  if (errors) scene_mark_si(run, spec->group, error_name, &si);
}

/* ---- behind the table ---------------------------------------------------------------------- */

/* A result or a coordinate: n values of all that it has, and how they are printed. */
typedef struct shown {
  char name[DECK_NAME];
  char word[MOST_PRINTED][DECK_NAME]; /* behind a value, that says what a mere number does not */
  size_t n, all;
  double value[MOST_PRINTED], error[MOST_PRINTED]; /* in the unit that is printed */
  int has_error;
  char units[DECK_UNITS];
} shown;

/* How far apart the rows of so many are that are printed, how many these are, and the place of the
   i-th of them. */
static size_t step_of(size_t all)
{
  return all <= MOST_PRINTED ? 1 : (all - 2) / (MOST_PRINTED - 1) + 1;
}

static size_t printed(size_t all)
{
  return all <= MOST_PRINTED ? all : (all - 2) / step_of(all) + 2;
}

static size_t place(size_t all, size_t i)
{
  return i + 1 == printed(all) ? all - 1 : i * step_of(all);
}

/* What the file says makes SI of a result. */
static int si_of(scene_run *run, const char *name, deck_si *out)
{
  char *units = NULL;
  if (!scene_going(run) ||
      pendres_store_read_attribute_double(run->store, "", name, "si_factor", &out->factor) !=
        PENDRES_OK ||
      pendres_store_read_attribute_text(run->store, "", name, "si_units", &units) != PENDRES_OK)
    return 0;
  (void)snprintf(out->units, sizeof out->units, "%s", units);
  free(units);
  return 1;
}

/* A line of `all` numbers of a result, which has `lines` of them. */
typedef struct line_of {
  size_t all, line, lines;
} line_of;

/* Those that are printed. */
static void read_printed(scene_run *run, const char *name, const line_of *of, double *out)
{
  const size_t n = of->all * of->lines;
  double *whole = calloc(n, sizeof *whole);
  if (whole == NULL) scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %s", name);
  else if (scene_going(run))
    scene_stored(run, pendres_store_read(run->store, "", name, PENDRES_STORE_DOUBLE, whole, n));
  for (size_t i = 0; whole != NULL && i < printed(of->all); i++)
    out[i] = whole[of->line * of->all + place(of->all, i)];
  free(whole);
}

/* Its values in SI, with the prefix that the largest of them, or of their errors, takes; without a
   unit as they are. */
static void read_shown(scene_run *run, const char *name, const line_of *of, shown *out)
{
  char error_name[DECK_NAME + 8];
  deck_si si = { .factor = 1.0 };
  double most = 0.0;
  const size_t n = printed(of->all);
  *out = (shown){ .n = n, .all = of->all };
  (void)snprintf(out->name, sizeof out->name, "%.63s", name);
  (void)snprintf(error_name, sizeof error_name, "%.64s_error", name);
  read_printed(run, name, of, out->value);
  out->has_error = scene_going(run) && pendres_store_has(run->store, "", error_name);
  if (out->has_error) read_printed(run, error_name, of, out->error);
  if (!si_of(run, name, &si)) return;
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

/* The codes `along`_`what`, if there are any. */
static int read_codes(scene_run *run, const shown *along, const char *what, char *name,
                      double *code)
{
  uint64_t sizes[PENDRES_STORE_RANK];
  int rank = 0;
  (void)snprintf(name, 2 * DECK_NAME, "%s_%s", along->name, what);
  if (!scene_going(run) || !pendres_store_has(run->store, "", name)) return 0;
  scene_stored(run, pendres_store_shape(run->store, "", name, &rank, sizes));
  if (!scene_going(run) || rank != 1 || sizes[0] != along->all) return 0;
  read_printed(run, name, &(line_of){along->all, 0, 1}, code);
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
    if (!read_codes(run, along, codes[k], name, code)) continue;
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
  if (!read_codes(run, along, "winding", name, turns) ||
      !read_codes(run, along, "period", name, code))
    return;
  for (size_t i = 0; i < along->n; i++)
    (void)snprintf(along->word[i], DECK_NAME, code[i] == 1.0 ? "%g" : "%g/%g", turns[i], code[i]);
}

/* Whether the dimension number `which` of a result has this name. */
static int lies_over(scene_run *run, const char *name, int which, const char *over)
{
  char *along = NULL;
  int same = 0;
  scene_stored(run, pendres_store_dimension_of(run->store, "", name, which, &along));
  same = along != NULL && strcmp(along, over) == 0;
  free(along);
  return same;
}

static int shape_of(scene_run *run, const char *name, uint64_t *sizes)
{
  const size_t length = strlen(name);
  int rank = 0;
  if (length > 6 && strcmp(name + length - 6, "_error") == 0) return -1;
  scene_stored(run, pendres_store_shape(run->store, "", name, &rank, sizes));
  return scene_going(run) ? rank : -1;
}

/* How many lines over a dimension a result with a unit has: one, two where it was swept up and
   down, none where it lies over something else. */
static size_t lines_over(scene_run *run, const char *name, const shown *along)
{
  uint64_t sizes[PENDRES_STORE_RANK];
  deck_si si;
  const int rank = shape_of(run, name, sizes);
  if (rank < 1 || rank > 2 || !si_of(run, name, &si) ||
      strcmp(name, along->name) == 0 || sizes[rank - 1] != along->all ||
      !lies_over(run, name, rank - 1, along->name))
    return 0;
  if (rank == 1) return 1;
  return sizes[0] == 2 && lies_over(run, name, 0, "direction") ? 2 : 0;
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
  uint64_t sizes[PENDRES_STORE_RANK];
  char *name = NULL;
  deck_si si;
  shown s;
  for (uint64_t at = 0; (name = next_number(run, &at)) != NULL; free(name)) {
    if (shape_of(run, name, sizes) != 0 || !si_of(run, name, &si)) continue;
    read_shown(run, name, &(line_of){1, 0, 1}, &s);
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

/* What is held fixed is told without a dimension, and zeros need no column, nor what is nowhere. */
static int varies(const shown *s)
{
  int varied = 0;
  for (size_t i = 0; i < s->n; i++) {
    const double error = s->has_error ? fmax(s->error[i] + s->error[0], 0.0) : 0.0;
    varied |= isnan(s->value[i]) != isnan(s->value[0]) ||
              fabs(s->value[i] - s->value[0]) > error || (error > 0.0 && fabs(s->value[i]) > error);
  }
  return varied;
}

enum { COLUMNS = 3 };

/* Results over a dimension, COLUMNS at a time. */
typedef struct told {
  shown along, column[COLUMNS];
  int columns, tables;
} told;

static void tell(scene_run *run, told *t)
{
  if (t->columns > 0) t->tables++;
  tell_columns(run, &t->along, t->column, t->columns);
  t->columns = 0;
}

static void add_lines(scene_run *run, told *t, const char *name)
{
  static const char *const ways[] = {" up", " down"};
  const size_t lines = lines_over(run, name, &t->along);
  for (size_t k = 0; k < lines; k++) {
    shown *s = &t->column[t->columns];
    const size_t length = strlen(name);
    read_shown(run, name, &(line_of){t->along.all, k, lines}, s);
    if (lines == 2 && length + 6 < sizeof s->name)
      (void)snprintf(s->name + length, sizeof s->name - length, "%s", ways[k]);
    if (t->along.n == 1 || varies(s)) t->columns++;
    if (t->columns == COLUMNS) tell(run, t);
  }
}

static void tell_dimension(scene_run *run, const char *dimension, size_t n)
{
  told t = {.columns = 0};
  char *name = NULL;
  read_shown(run, dimension, &(line_of){n, 0, 1}, &t.along);
  if (n > MOST_PRINTED && t.along.units[0] == '\0') { /* points, samples: numbers of a list */
    fprintf(run->table, "(%zu rows over %s are in the file, and --csv writes them)\n", n,
            dimension);
    return;
  }
  read_words(run, &t.along);
  for (uint64_t at = 0; (name = next_number(run, &at)) != NULL; free(name))
    add_lines(run, &t, name);
  tell(run, &t);
  if (t.tables > 0 && t.along.n < n)
    fprintf(run->table, "(%zu of %zu rows; the file has all, and --csv writes them)\n", t.along.n,
            n);
}

void scene_tell_units(scene_run *run)
{
  uint64_t sizes[PENDRES_STORE_RANK];
  char *name = NULL;
  /* The table of a fit has its own column for them. */
  if (!deck_has_units(run->deck) || !scene_prints(run) || run->deck->kind == DECK_FIT) return;
  fputs("\nin SI:\n", run->table);
  tell_scalars(run);
  for (uint64_t at = 0; (name = next_number(run, &at)) != NULL; free(name))
    if (shape_of(run, name, sizes) == 1 && sizes[0] > 0 && lies_over(run, name, 0, name))
      tell_dimension(run, name, (size_t)sizes[0]);
}
