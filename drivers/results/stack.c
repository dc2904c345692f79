/* stack.c -- the results of all slices as variables with one more dimension; see
   results.h. */
#include "results/tape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/bytes.h"

typedef struct stack {
  scene_run *run;
  results_tape *tape;
  const char *name; /* of the outer dimension */
  void (*axis)(scene_run *run, const char *group);
} stack;

static void read_tape(const stack *s, uint64_t at, void *to, size_t bytes)
{
  if (scene_going(s->run) && !bytes_read(s->tape->file, (off_t)at, to, bytes))
    (void)scene_fail(s->run, PENDRES_IO, "the temporary file of an outer axis cannot be read");
}

static void *room_for(const stack *s, uint64_t n, size_t size)
{
  void *room = scene_going(s->run) && n < SIZE_MAX / 16 ? malloc(((size_t)n + 1) * size) : NULL;
  if (room == NULL)
    (void)scene_fail(s->run, PENDRES_OUT_OF_MEMORY, "out of memory for %.3g results", (double)n);
  return room;
}

/* Whether a slice has results at all; one that has failed has none. */
static int has_any(const stack *s, size_t slice)
{
  for (size_t i = 0; i < s->tape->entries; i++)
    if (s->tape->entry[i].part[slice].there) return 1;
  return 0;
}

/* ---- dimensions ---------------------------------------------------------------------------- */

/* The first slice that has most of a dimension. */
static size_t longest_of(const stack *s, const tape_entry *e)
{
  size_t longest = 0;
  for (size_t k = 0; k < s->tape->slices; k++)
    if (e->part[k].there &&
        (!e->part[longest].there || e->part[k].size[0] > e->part[longest].size[0]))
      longest = k;
  return longest;
}

/* Are the values of a slice those with which the values of another begin? */
static int begins(const stack *s, const tape_entry *e, const tape_part *p, const tape_part *whole)
{
  const size_t n = (size_t)p->size[0], bytes = n * tape_element(e->spec.type);
  if (p->numbering || whole->numbering || n == 0) return p->numbering == whole->numbering || n == 0;
  if (e->spec.type == PENDRES_STORE_STRING) {
    for (size_t i = 0; i < n; i++)
      if (strcmp(p->text[i], whole->text[i]) != 0) return 0;
    return 1;
  }
  char *one = room_for(s, n, tape_element(e->spec.type));
  char *other = room_for(s, n, tape_element(e->spec.type));
  if (one != NULL && other != NULL) {
    read_tape(s, p->at, one, bytes);
    read_tape(s, whole->at, other, bytes);
  }
  const int same = one != NULL && other != NULL && memcmp(one, other, bytes) == 0;
  free(one);
  free(other);
  return same;
}

/* How long the dimension is at each value. */
static void write_length(const stack *s, const tape_entry *e)
{
  char name[2 * DECK_NAME];
  int64_t *count = room_for(s, s->tape->slices, sizeof *count);
  pendres_store_spec spec = { .group = e->spec.group, .name = name, .type = PENDRES_STORE_INT64,
                              .dimensions = { s->name },
                              .long_name = "length of the dimension at each value of the outer "
                                           "axis" };
  snprintf(name, sizeof name, "%.100s_length", e->spec.name);
  for (size_t k = 0; k < s->tape->slices && count != NULL; k++)
    count[k] = e->part[k].there ? (int64_t)e->part[k].size[0] : 0;
  if (count != NULL && tape_find(s->tape, spec.group, name) == NULL)
    scene_put(s->run, &spec, count, NULL, s->tape->slices);
  free(count);
}

/* A dimension whose values differ counts from 0 on; NAME_values are its values. */
static void add_values(const stack *s, tape_entry *e, tape_entry *values)
{
  char *name = scene_room_take(&s->tape->room, strlen(e->spec.name) + 8, 1);
  tape_part *part = scene_room_take(&s->tape->room, s->tape->slices, sizeof *part);
  if (name == NULL || part == NULL) {
    (void)scene_fail(s->run, PENDRES_OUT_OF_MEMORY, "out of memory for results");
    return;
  }
  *values = *e;
  sprintf(name, "%s_values", e->spec.name);
  values->spec.name = name;
  values->spec.dimensions[0] = e->spec.name;
  values->dimension = 0;
  values->part = part;
  for (size_t k = 0; k < s->tape->slices; k++) {
    part[k] = e->part[k];
    part[k].there = e->part[k].there && !e->part[k].numbering;
  }
}

static void write_variable(const stack *s, tape_entry *e);

static void write_dimension(const stack *s, tape_entry *e)
{
  const size_t longest = longest_of(s, e);
  const tape_part *whole = &e->part[longest];
  const uint64_t n = e->most[0] = whole->size[0];
  int same = 1, as_long = 1;
  for (size_t k = 0; k < s->tape->slices; k++) {
    const tape_part *p = &e->part[k];
    if (!p->there) as_long &= !has_any(s, k);
    else as_long &= p->size[0] == n;
    if (p->there && same) same = begins(s, e, p, whole);
  }
  pendres_store_spec spec = e->spec;
  spec.dimensions[0] = NULL;
  if (same && !whole->numbering && e->spec.type == PENDRES_STORE_STRING) {
    results_dimension(s->run, &spec, n, whole->text);
  } else if (same && !whole->numbering) {
    void *values = room_for(s, n, tape_element(spec.type));
    if (values != NULL) read_tape(s, whole->at, values, (size_t)n * tape_element(spec.type));
    results_dimension(s->run, &spec, n, values);
    free(values);
  } else {
    spec.type = PENDRES_STORE_DOUBLE;
    spec.units = NULL;
    results_dimension(s->run, &spec, n, NULL);
  }
  if (!as_long) write_length(s, e);
  if (same) return;
  tape_entry values;
  add_values(s, e, &values);
  if (scene_going(s->run)) write_variable(s, &values);
}

/* ---- variables ----------------------------------------------------------------------------- */

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
static void spread(const tape_entry *e, const tape_part *p, size_t size, const char *from, char *to)
{
  const int last = e->rank - 1;
  const uint64_t n = tape_length(e, p->size), run = e->rank > 0 ? p->size[last] : 1;
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

/* One slice of a variable, or of its errors. */
static void write_part(const stack *s, const tape_entry *e, size_t slice, int id, int errors)
{
  const tape_part *p = &e->part[slice];
  const pendres_store_type type = errors ? PENDRES_STORE_DOUBLE : e->spec.type;
  const int texts = type == PENDRES_STORE_STRING;
  const size_t size = texts ? sizeof(char *) : tape_element(type);
  const uint64_t n = tape_length(e, e->most), own = p->there ? tape_length(e, p->size) : 0;
  char *row = room_for(s, n, size), *from = texts ? NULL : room_for(s, own, size);
  if (row != NULL && (texts || from != NULL)) {
    fill(type, n, row);
    if (own > 0 && !texts) read_tape(s, errors ? p->error_at : p->at, from, (size_t)own * size);
    if (own > 0 && (!texts || p->text != NULL))
      spread(e, p, size, texts ? (const char *)p->text : from, row);
    results_write(s->run, id, slice, 1, row, (size_t)n);
  }
  free(row);
  free(from);
}

/* The sizes of its dimensions, which are as long as the longest of the slices. */
static void measure(const stack *s, tape_entry *e)
{
  for (int k = 0; k < e->rank; k++) {
    const tape_entry *d = tape_find(s->tape, e->spec.group, e->spec.dimensions[k]);
    e->most[k] = d != NULL ? d->most[0] : 0;
  }
}

static void write_variable(const stack *s, tape_entry *e)
{
  pendres_store_spec spec = e->spec;
  int id = -1, error_id = -1;
  measure(s, e);
  if (e->rank + 1 >= PENDRES_STORE_RANK) {
    (void)scene_fail(s->run, PENDRES_UNSUPPORTED, "'%s' has too many dimensions for an outer axis",
                     spec.name);
    return;
  }
  spec.dimensions[0] = s->name;
  for (int k = 0; k < e->rank; k++) spec.dimensions[k + 1] = e->spec.dimensions[k];
  results_variable(s->run, &spec, &id, e->has_error ? &error_id : NULL);
  if (tape_length(e, e->most) == 0) return;
  for (size_t k = 0; k < s->tape->slices && scene_going(s->run); k++) {
    write_part(s, e, k, id, 0);
    if (e->has_error) write_part(s, e, k, error_id, 1);
  }
}

/* ---- all of it ----------------------------------------------------------------------------- */

static void need_axis(const stack *s, const char *group)
{
  if (scene_going(s->run) && !results_has(s->run, group, s->name)) s->axis(s->run, group);
}

void results_tape_write(scene_run *run, results_tape *tape, const char *name,
                        void (*axis)(scene_run *run, const char *group))
{
  const stack s = { run, tape, name, axis };
  for (size_t i = 0; i < tape->entries && scene_going(run); i++) {
    tape_entry *e = &tape->entry[i];
    need_axis(&s, e->spec.group);
    if (strcmp(e->spec.name, name) == 0)
      (void)scene_fail(run, PENDRES_UNSUPPORTED, "the scene has a '%s' of its own: it cannot be an "
                       "outer axis", name);
    else if (e->dimension) write_dimension(&s, e);
    else write_variable(&s, e);
  }
  for (size_t i = 0; i < tape->attributes && scene_going(run); i++) {
    const tape_attribute *a = &tape->attribute[i];
    if (a->text != NULL) results_attribute(run, a->group, a->object, a->name, a->text);
    else results_number(run, a->group, a->object, a->name, a->number);
  }
}
