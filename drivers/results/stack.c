/* stack.c -- where results go: into the store, or beside those of other slices; see stack.h. */
#include "results/stack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/grow.h"

/* Of a dimension or variable, what one slice has. */
typedef struct part {
  int there, numbering;     /* numbering: a dimension that counts from 0 on */
  uint64_t size[PENDRES_STORE_RANK];
  void *values;             /* of strings const char *; NULL: none were written */
  double *errors;
} part;

typedef struct entry {
  pendres_store_spec spec;
  int dimension, has_error, rank;
  uint64_t most[PENDRES_STORE_RANK]; /* of the sizes of all slices, once all are there */
  part *part;               /* [slices] */
} entry;

typedef struct attribute {
  const char *group, *object, *name;
  const char *text;         /* NULL: it is a number */
  double number;
} attribute;

struct results_stack {
  size_t slices, slice;
  scene_room room;
  entry *entry;             /* in the order in which they first came */
  size_t entries, entry_room;
  attribute *attribute;
  size_t attributes, attribute_room;
};

/* Bytes of an element in memory. */
static size_t element_of(pendres_store_type type)
{
  static const size_t element[] = {
    [PENDRES_STORE_DOUBLE] = sizeof(double), [PENDRES_STORE_INT8] = sizeof(int8_t),
    [PENDRES_STORE_INT32] = sizeof(int32_t), [PENDRES_STORE_INT64] = sizeof(int64_t),
    [PENDRES_STORE_STRING] = sizeof(char *),
  };
  return element[type];
}

/* The product of an entry's sizes. */
static uint64_t length_of(const entry *e, const uint64_t *size)
{
  uint64_t n = 1;
  for (int k = 0; k < e->rank; k++) n *= size[k];
  return n;
}

results_stack *results_stack_create(scene_run *run, size_t slices)
{
  results_stack *s = calloc(1, sizeof *s);
  if (s == NULL) (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for an outer axis");
  else s->slices = slices;
  return s;
}

void results_stack_free(results_stack *s)
{
  if (s == NULL) return;
  scene_room_end(&s->room);
  free(s->entry);
  free(s->attribute);
  free(s);
}

void results_stack_begin(results_stack *s, size_t slice)
{
  s->slice = slice;
}

void results_stack_forget(results_stack *s, size_t slice)
{
  for (size_t i = 0; i < s->entries; i++) s->entry[i].part[slice] = (part){ 0 };
}

/* ---- what is kept -------------------------------------------------------------------------- */

/* NULL: why is on record. What all slices have of a variable takes no more memory than one large
   array does: beyond that it is in files. */
static void *take(scene_run *run, size_t n, size_t size)
{
  results_stack *s = run->stack;
  return scene_room_large(run, &s->room, n, size, SCENE_MEMORY / s->slices);
}

/* A text that lasts; NULL stays NULL. */
static const char *copy(scene_run *run, const char *text)
{
  char *own = text != NULL ? take(run, strlen(text) + 1, 1) : NULL;
  if (own != NULL) strcpy(own, text);
  return own;
}

static const char **copy_all(scene_run *run, size_t n, const char *const *texts)
{
  const char **own = take(run, n, sizeof *own);
  for (size_t i = 0; i < n && own != NULL; i++) own[i] = copy(run, texts[i]);
  return scene_going(run) ? own : NULL;
}

static const char *group_of(const char *group)
{
  return group == NULL || strcmp(group, "/") == 0 ? "" : group;
}

static entry *find(const results_stack *s, const char *group, const char *name)
{
  for (size_t i = 0; i < s->entries; i++)
    if (strcmp(s->entry[i].spec.name, name) == 0 &&
        strcmp(s->entry[i].spec.group, group_of(group)) == 0)
      return &s->entry[i];
  return NULL;
}

/* Labels with their names; of specs that differ in these, that with the most is kept. */
static void copy_flags(scene_run *run, const pendres_store_spec *from, pendres_store_spec *to)
{
  const size_t n = (size_t)from->flag_count;
  int8_t *values = from->flag_values != NULL ? take(run, n, 1) : NULL;
  if (values != NULL) memcpy(values, from->flag_values, n);
  to->flag_count = from->flag_count;
  to->flag_meanings = copy_all(run, n, from->flag_meanings);
  to->flag_values = values;
}

static void copy_spec(scene_run *run, const pendres_store_spec *from, pendres_store_spec *to)
{
  *to = *from;
  to->group = copy(run, group_of(from->group));
  to->name = copy(run, from->name);
  to->long_name = copy(run, from->long_name);
  to->units = copy(run, from->units);
  to->comment = copy(run, from->comment);
  to->coordinates = copy(run, from->coordinates);
  for (int k = 0; k < PENDRES_STORE_RANK; k++) to->dimensions[k] = copy(run, from->dimensions[k]);
  if (from->flag_count > 0) copy_flags(run, from, to);
}

/* The entry of that name, for this slice; NULL: why is on record. */
static entry *need(scene_run *run, const pendres_store_spec *spec)
{
  results_stack *s = run->stack;
  entry *e = find(s, spec->group, spec->name);
  if (e == NULL) {
    if (!grow_to(&s->entry, s->entries + 1, &s->entry_room, sizeof *s->entry)) {
      (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for results");
      return NULL;
    }
    e = &s->entry[s->entries];
    *e = (entry){ .part = take(run, s->slices, sizeof *e->part) };
    copy_spec(run, spec, &e->spec);
    if (scene_going(run)) s->entries++;
  } else if (spec->flag_count > e->spec.flag_count) {
    copy_flags(run, spec, &e->spec);
  }
  return scene_going(run) ? e : NULL;
}

/* Values into the place of rows from number `first` on, or of all. */
static void keep_values(scene_run *run, const entry *e, uint64_t first, const void *data, size_t n)
{
  part *p = &e->part[run->stack->slice];
  const size_t size = element_of(e->spec.type);
  if (e->spec.type == PENDRES_STORE_STRING) p->values = copy_all(run, n, data);
  else memcpy((char *)p->values + first * size, data, n * size);
}

static void keep_dimension(scene_run *run, const pendres_store_spec *spec, uint64_t n,
                           const void *values)
{
  entry *e = need(run, spec);
  if (e == NULL) return;
  part *p = &e->part[run->stack->slice];
  e->dimension = e->rank = 1;
  *p = (part){ .there = 1, .size = { n }, .numbering = values == NULL };
  if (values == NULL) return;
  p->values = take(run, (size_t)n, element_of(spec->type));
  if (p->values != NULL) keep_values(run, e, 0, values, (size_t)n);
}

static void keep_variable(scene_run *run, const pendres_store_spec *spec, int *id, int *error_id)
{
  results_stack *s = run->stack;
  entry *e = need(run, spec);
  if (e == NULL) return;
  part *p = &e->part[s->slice];
  *p = (part){ .there = 1 };
  e->rank = 0;
  for (; e->rank < PENDRES_STORE_RANK && spec->dimensions[e->rank] != NULL; e->rank++) {
    const entry *d = find(s, spec->group, spec->dimensions[e->rank]);
    p->size[e->rank] = d != NULL ? d->part[s->slice].size[0] : 0;
  }
  const size_t n = (size_t)length_of(e, p->size);
  if (spec->type != PENDRES_STORE_STRING) p->values = take(run, n, element_of(spec->type));
  *id = 2 * (int)(e - s->entry);
  if (error_id == NULL) return;
  e->has_error = 1;
  p->errors = take(run, n, sizeof *p->errors);
  *error_id = *id + 1;
}

static void keep_attribute(scene_run *run, const attribute *a)
{
  results_stack *s = run->stack;
  for (size_t i = 0; i < s->attributes; i++) { /* the first slice to have it decides */
    const attribute *b = &s->attribute[i];
    if (strcmp(b->group, group_of(a->group)) == 0 && strcmp(b->name, a->name) == 0 &&
        strcmp(b->object, a->object != NULL ? a->object : "") == 0)
      return;
  }
  if (!grow_to(&s->attribute, s->attributes + 1, &s->attribute_room, sizeof *s->attribute)) {
    (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for results");
    return;
  }
  const attribute own = { copy(run, group_of(a->group)),
                          copy(run, a->object != NULL ? a->object : ""), copy(run, a->name),
                          copy(run, a->text), a->number };
  if (scene_going(run)) s->attribute[s->attributes++] = own;
}

/* ---- where results go ---------------------------------------------------------------------- */

void results_dimension(scene_run *run, const pendres_store_spec *spec, uint64_t n,
                       const void *values)
{
  if (!scene_going(run)) return;
  if (run->stack != NULL) keep_dimension(run, spec, n, values);
  else scene_stored(run, pendres_store_dimension(run->store, spec, n, values));
}

void results_variable(scene_run *run, const pendres_store_spec *spec, int *id, int *error_id)
{
  if (!scene_going(run)) return;
  if (run->stack != NULL) keep_variable(run, spec, id, error_id);
  else scene_stored(run, pendres_store_variable(run->store, spec, id, error_id));
}

void results_write(scene_run *run, int id, uint64_t first, uint64_t rows, const void *data,
                   size_t n)
{
  if (!scene_going(run)) return;
  if (run->stack == NULL) {
    scene_stored(run, rows > 0 ? pendres_store_write_rows(run->store, id, first, rows, data, n)
                               : pendres_store_write(run->store, id, data, n));
    return;
  }
  const entry *e = &run->stack->entry[id / 2];
  const uint64_t at = rows > 0 ? first * (n / rows) : 0;
  if (id % 2 == 0) keep_values(run, e, at, data, n);
  else memcpy(e->part[run->stack->slice].errors + at, data, n * sizeof(double));
}

void results_attribute(scene_run *run, const char *group, const char *object, const char *name,
                       const char *text)
{
  if (!scene_going(run)) return;
  if (run->stack != NULL) keep_attribute(run, &(attribute){ group, object, name, text, 0.0 });
  else scene_stored(run, pendres_store_attribute(run->store, group, object, name, text));
}

void results_number(scene_run *run, const char *group, const char *object, const char *name,
                    double number)
{
  if (!scene_going(run)) return;
  if (run->stack != NULL) keep_attribute(run, &(attribute){ group, object, name, NULL, number });
  else scene_stored(run, pendres_store_attribute_number(run->store, group, object, name, number));
}

int results_has(scene_run *run, const char *group, const char *name)
{
  char of[DECK_NAME * 2];
  if (run->stack == NULL) return pendres_store_has(run->store, group, name);
  if (find(run->stack, group, name) != NULL) return 1;
  const size_t n = strlen(name);
  if (n < 6 || strcmp(name + n - 6, "_error") != 0 || n >= sizeof of) return 0;
  snprintf(of, sizeof of, "%.*s", (int)(n - 6), name);
  const entry *e = find(run->stack, group, of);
  return e != NULL && e->has_error;
}

/* ---- putting together: dimensions ---------------------------------------------------------- */

/* What is put together, beside the outer dimension. */
typedef struct whole {
  scene_run *run;
  results_stack *of;
  const char *name; /* of the outer dimension */
} whole;

/* Whether a slice has results at all; one that has failed has none. */
static int has_any(const results_stack *s, size_t slice)
{
  for (size_t i = 0; i < s->entries; i++)
    if (s->entry[i].part[slice].there) return 1;
  return 0;
}

/* What the first slice has that has most of a dimension. */
static const part *longest_of(const results_stack *s, const entry *e)
{
  const part *longest = &e->part[0];
  for (const part *p = e->part; p < e->part + s->slices; p++)
    if (p->there && (!longest->there || p->size[0] > longest->size[0])) longest = p;
  return longest;
}

/* Are the values of a slice those with which the values of another begin? */
static int begins(pendres_store_type type, const part *p, const part *other)
{
  const size_t n = (size_t)p->size[0];
  const char *const *one = p->values, *const *another = other->values;
  if (p->numbering || other->numbering || n == 0) return p->numbering == other->numbering || n == 0;
  if (type != PENDRES_STORE_STRING) return memcmp(one, another, n * element_of(type)) == 0;
  for (size_t i = 0; i < n; i++)
    if (strcmp(one[i], another[i]) != 0) return 0;
  return 1;
}

/* How long the dimension is at each value. */
static void write_length(const whole *w, const entry *e)
{
  char name[2 * DECK_NAME];
  int64_t *count = scene_array(w->run, w->of->slices, sizeof *count);
  const pendres_store_spec spec = {
    .group = e->spec.group, .name = name, .type = PENDRES_STORE_INT64, .dimensions = { w->name },
    .long_name = "length of the dimension at each value of the outer axis" };
  snprintf(name, sizeof name, "%.100s_length", e->spec.name);
  for (size_t k = 0; k < w->of->slices && count != NULL; k++) /* what has failed has none */
    count[k] = e->part[k].there ? (int64_t)e->part[k].size[0] : 0;
  if (count == NULL || find(w->of, spec.group, name) != NULL) return;
  scene_stored(w->run, pendres_store_put(w->run->store, &spec, count, NULL, w->of->slices));
}

static void write_variable(const whole *w, entry *e);

/* A dimension whose values differ counts from 0 on; NAME_values are its values. */
static void write_values(const whole *w, const entry *e)
{
  char name[2 * DECK_NAME];
  part *own = scene_array(w->run, w->of->slices, sizeof *own);
  entry values = *e;
  if (own == NULL) return;
  snprintf(name, sizeof name, "%.100s_values", e->spec.name);
  values.spec.name = name;
  values.spec.dimensions[0] = e->spec.name;
  values.part = own;
  for (size_t k = 0; k < w->of->slices; k++) {
    own[k] = e->part[k];
    own[k].there = own[k].there && !own[k].numbering;
  }
  write_variable(w, &values);
}

static void write_dimension(const whole *w, entry *e)
{
  const part *longest = longest_of(w->of, e);
  const uint64_t n = e->most[0] = longest->size[0];
  int same = 1, as_long = 1;
  for (size_t k = 0; k < w->of->slices; k++) {
    const part *p = &e->part[k];
    as_long &= p->there ? p->size[0] == n : !has_any(w->of, k);
    same = same && (!p->there || begins(e->spec.type, p, longest));
  }
  const int kept = same && !longest->numbering;
  pendres_store_spec spec = e->spec;
  spec.dimensions[0] = NULL;
  if (!kept) {
    spec.type = PENDRES_STORE_DOUBLE;
    spec.units = NULL;
  }
  results_dimension(w->run, &spec, n, kept ? longest->values : NULL);
  if (!as_long) write_length(w, e);
  if (!same) write_values(w, e);
}

/* ---- putting together: variables ----------------------------------------------------------- */

static void fill(pendres_store_type type, uint64_t n, void *row)
{
  for (uint64_t i = 0; i < n; i++)
    switch (type) {
    case PENDRES_STORE_DOUBLE: ((double *)row)[i] = NAN; break;
    case PENDRES_STORE_INT8: ((int8_t *)row)[i] = -1; break;
    case PENDRES_STORE_INT32: ((int32_t *)row)[i] = -1; break;
    case PENDRES_STORE_INT64: ((int64_t *)row)[i] = -1; break;
    default: ((const char **)row)[i] = ""; break;
    }
}

/* Copy the elements of a slice to their places in a row that is as large as the largest. */
static void spread(const entry *e, const part *p, size_t size, const char *from, char *to)
{
  const int last = e->rank - 1;
  const uint64_t n = length_of(e, p->size), run = e->rank > 0 ? p->size[last] : 1;
  for (uint64_t i = 0; i < n; i += run) {
    uint64_t rest = run > 0 ? i / run : 0, at = 0, step = e->rank > 0 ? e->most[last] : 1;
    for (int k = last - 1; k >= 0; k--) {
      at += rest % p->size[k] * step;
      rest /= p->size[k];
      step *= e->most[k];
    }
    memcpy(to + at * size, from + i * size, (size_t)run * size);
  }
}

/* One slice of a variable, or of its errors, by way of `row`. */
static void write_part(const whole *w, const entry *e, const part *p, const int id[2], void *row)
{
  const size_t n = (size_t)length_of(e, e->most), slice = (size_t)(p - e->part);
  for (int errors = 0; errors <= e->has_error; errors++) {
    const pendres_store_type type = errors ? PENDRES_STORE_DOUBLE : e->spec.type;
    const void *from = errors ? p->errors : p->values;
    fill(type, n, row);
    if (p->there && from != NULL) spread(e, p, element_of(type), from, row);
    results_write(w->run, id[errors], slice, 1, row, n);
  }
}

static void write_variable(const whole *w, entry *e)
{
  pendres_store_spec spec = e->spec;
  int id[2] = { -1, -1 };
  for (int k = 0; k < e->rank; k++) { /* dimensions are as long as the longest of the slices */
    const entry *d = find(w->of, e->spec.group, e->spec.dimensions[k]);
    e->most[k] = d != NULL ? d->most[0] : 0;
  }
  if (e->rank + 1 >= PENDRES_STORE_RANK) {
    (void)scene_fail(w->run, PENDRES_UNSUPPORTED, "'%s' has too many dimensions for an outer axis",
                     spec.name);
    return;
  }
  spec.dimensions[0] = w->name;
  for (int k = 0; k < e->rank; k++) spec.dimensions[k + 1] = e->spec.dimensions[k];
  results_variable(w->run, &spec, &id[0], e->has_error ? &id[1] : NULL);
  const uint64_t n = length_of(e, e->most);
  if (n == 0 || !scene_going(w->run)) return;
  void *row = n < SIZE_MAX / 16 ? malloc((size_t)n * sizeof(double)) : NULL;
  if (row == NULL)
    (void)scene_fail(w->run, PENDRES_OUT_OF_MEMORY, "out of memory for %.3g results", (double)n);
  for (size_t k = 0; k < w->of->slices && scene_going(w->run); k++)
    write_part(w, e, &e->part[k], id, row);
  free(row);
}

void results_stack_write(scene_run *run, results_stack *s, const char *name,
                         void (*axis)(scene_run *run, const char *group))
{
  const whole w = { run, s, name };
  for (size_t i = 0; i < s->entries && scene_going(run); i++) {
    entry *e = &s->entry[i];
    if (!results_has(run, e->spec.group, name)) axis(run, e->spec.group);
    if (strcmp(e->spec.name, name) == 0)
      (void)scene_fail(run, PENDRES_UNSUPPORTED, "the scene has a '%s' of its own: it cannot be an "
                       "outer axis", name);
    else if (e->dimension) write_dimension(&w, e);
    else write_variable(&w, e);
  }
  for (size_t i = 0; i < s->attributes; i++) {
    const attribute *a = &s->attribute[i];
    const char *object = a->object[0] != '\0' ? a->object : NULL;
    if (a->text != NULL) results_attribute(run, a->group, object, a->name, a->text);
    else results_number(run, a->group, object, a->name, a->number);
  }
}
