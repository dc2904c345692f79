/* tape.c -- the tape, and what is put on it; stack.c puts it together. See tape.h. */
#define _POSIX_C_SOURCE 200809L /* pwrite */
#include "results/tape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "system/bytes.h"
#include "system/grow.h"

static const size_t element[] = {
  [PENDRES_STORE_DOUBLE] = sizeof(double), [PENDRES_STORE_INT8] = sizeof(int8_t),
  [PENDRES_STORE_INT32] = sizeof(int32_t), [PENDRES_STORE_INT64] = sizeof(int64_t),
};

size_t tape_element(pendres_store_type type)
{
  return type == PENDRES_STORE_STRING ? 0 : element[type];
}

uint64_t tape_length(const tape_entry *e, const uint64_t *size)
{
  uint64_t n = 1;
  for (int k = 0; k < e->rank; k++) n *= size[k];
  return n;
}

results_tape *results_tape_create(scene_run *run, size_t slices)
{
  results_tape *t = calloc(1, sizeof *t);
  if (t == NULL) {
    (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for an outer axis");
    return NULL;
  }
  t->slices = slices;
  t->file = scene_unnamed(run, 0);
  if (t->file >= 0) return t;
  free(t);
  return NULL;
}

void results_tape_free(results_tape *t)
{
  if (t == NULL) return;
  (void)close(t->file);
  scene_room_end(&t->room);
  free(t->entry);
  free(t->attribute);
  free(t);
}

void results_tape_begin(results_tape *t, size_t slice)
{
  t->slice = slice;
}

void results_tape_forget(results_tape *t, size_t slice)
{
  for (size_t i = 0; i < t->entries; i++) t->entry[i].part[slice] = (tape_part){ 0 };
}

/* ---- room ---------------------------------------------------------------------------------- */

static void *take(scene_run *run, size_t n, size_t size)
{
  void *room = scene_room_take(&run->tape->room, n, size);
  if (room == NULL) (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for results");
  return room;
}

/* A text that lasts; NULL stays NULL. */
static const char *copy(scene_run *run, const char *text)
{
  char *own = text != NULL ? take(run, strlen(text) + 1, 1) : NULL;
  if (own != NULL) strcpy(own, text);
  return own;
}

static const char *group_of(const char *group)
{
  return group == NULL || strcmp(group, "/") == 0 ? "" : group;
}

tape_entry *tape_find(results_tape *t, const char *group, const char *name)
{
  for (size_t i = 0; i < t->entries; i++)
    if (strcmp(t->entry[i].spec.name, name) == 0 &&
        strcmp(t->entry[i].spec.group, group_of(group)) == 0)
      return &t->entry[i];
  return NULL;
}

/* Labels with their names; of specs that differ in these, that with the most is kept. */
static void copy_flags(scene_run *run, const pendres_store_spec *from, pendres_store_spec *to)
{
  const size_t n = (size_t)from->flag_count;
  const char **meanings = take(run, n, sizeof *meanings);
  int8_t *values = from->flag_values != NULL ? take(run, n, 1) : NULL;
  if (meanings == NULL) return;
  for (size_t i = 0; i < n; i++) meanings[i] = copy(run, from->flag_meanings[i]);
  if (values != NULL) memcpy(values, from->flag_values, n);
  to->flag_count = from->flag_count;
  to->flag_meanings = meanings;
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
static tape_entry *need(scene_run *run, const pendres_store_spec *spec)
{
  results_tape *t = run->tape;
  tape_entry *e = tape_find(t, spec->group, spec->name);
  if (e == NULL) {
    if (!grow_to(&t->entry, t->entries + 1, &t->room_for, sizeof *t->entry)) {
      (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for results");
      return NULL;
    }
    e = &t->entry[t->entries];
    *e = (tape_entry){ .part = take(run, t->slices, sizeof *e->part) };
    copy_spec(run, spec, &e->spec);
    if (!scene_going(run)) return NULL;
    t->entries++;
  } else if (spec->flag_count > e->spec.flag_count) {
    copy_flags(run, spec, &e->spec);
  }
  return scene_going(run) ? e : NULL;
}

/* ---- dimensions and variables -------------------------------------------------------------- */

/* Room on the tape for n elements. */
static uint64_t reserve(results_tape *t, pendres_store_type type, uint64_t n)
{
  const uint64_t at = t->length;
  t->length += (n * tape_element(type) + 7) / 8 * 8;
  return at;
}

static void put_texts(scene_run *run, tape_part *p, uint64_t n, const void *data)
{
  const char *const *texts = data;
  p->text = take(run, (size_t)n, sizeof *p->text);
  for (size_t i = 0; i < n && p->text != NULL; i++) p->text[i] = copy(run, texts[i]);
}

static void put(scene_run *run, uint64_t at, size_t bytes, const void *data)
{
  if (scene_going(run) && !bytes_write(run->tape->file, (off_t)at, data, bytes))
    (void)scene_fail(run, PENDRES_IO, "the temporary file of an outer axis cannot be written");
}

static void keep_dimension(scene_run *run, const pendres_store_spec *spec, uint64_t n,
                           const void *values)
{
  results_tape *t = run->tape;
  tape_entry *e = need(run, spec);
  if (e == NULL) return;
  tape_part *p = &e->part[t->slice];
  e->dimension = e->rank = 1;
  *p = (tape_part){ .there = 1, .size = { n }, .numbering = values == NULL };
  if (values == NULL) return;
  if (spec->type == PENDRES_STORE_STRING) put_texts(run, p, n, values);
  else {
    p->at = reserve(t, spec->type, n);
    put(run, p->at, (size_t)n * tape_element(spec->type), values);
  }
}

void results_dimension(scene_run *run, const pendres_store_spec *spec, uint64_t n,
                       const void *values)
{
  if (!scene_going(run)) return;
  if (run->tape != NULL) keep_dimension(run, spec, n, values);
  else scene_stored(run, pendres_store_dimension(run->store, spec, n, values));
}

static void keep_variable(scene_run *run, const pendres_store_spec *spec, int *id, int *error_id)
{
  results_tape *t = run->tape;
  tape_entry *e = need(run, spec);
  if (e == NULL) return;
  tape_part *p = &e->part[t->slice];
  *p = (tape_part){ .there = 1 };
  e->rank = 0;
  for (; e->rank < PENDRES_STORE_RANK && spec->dimensions[e->rank] != NULL; e->rank++) {
    const tape_entry *d = tape_find(t, spec->group, spec->dimensions[e->rank]);
    p->size[e->rank] = d != NULL ? d->part[t->slice].size[0] : 0;
  }
  const uint64_t n = tape_length(e, p->size);
  p->at = reserve(t, spec->type, n);
  if (error_id != NULL) {
    e->has_error = 1;
    p->error_at = reserve(t, PENDRES_STORE_DOUBLE, n);
    *error_id = 2 * (int)(e - t->entry) + 1;
  }
  *id = 2 * (int)(e - t->entry);
}

void results_variable(scene_run *run, const pendres_store_spec *spec, int *id, int *error_id)
{
  if (!scene_going(run)) return;
  if (run->tape != NULL) keep_variable(run, spec, id, error_id);
  else scene_stored(run, pendres_store_variable(run->store, spec, id, error_id));
}

static void keep(scene_run *run, int id, uint64_t first, uint64_t rows, const void *data, size_t n)
{
  results_tape *t = run->tape;
  tape_entry *e = &t->entry[id / 2];
  tape_part *p = &e->part[t->slice];
  const pendres_store_type type = id % 2 != 0 ? PENDRES_STORE_DOUBLE : e->spec.type;
  const size_t size = tape_element(type);
  if (type == PENDRES_STORE_STRING) {
    put_texts(run, p, n, data);
    return;
  }
  const uint64_t each = rows > 0 ? n / rows : 0;
  put(run, (id % 2 != 0 ? p->error_at : p->at) + first * each * size, n * size, data);
}

void results_write(scene_run *run, int id, uint64_t first, uint64_t rows, const void *data,
                   size_t n)
{
  if (!scene_going(run)) return;
  if (run->tape != NULL) keep(run, id, first, rows, data, n);
  else
    scene_stored(run, rows > 0 ? pendres_store_write_rows(run->store, id, first, rows, data, n)
                               : pendres_store_write(run->store, id, data, n));
}

/* ---- attributes ---------------------------------------------------------------------------- */

static int same(const char *a, const char *b)
{
  return a == NULL || b == NULL ? a == b : strcmp(a, b) == 0;
}

/* The first slice to have it decides. */
static void keep_attribute(scene_run *run, const tape_attribute *a)
{
  results_tape *t = run->tape;
  for (size_t i = 0; i < t->attributes; i++)
    if (same(t->attribute[i].group, group_of(a->group)) &&
        same(t->attribute[i].object, a->object) && same(t->attribute[i].name, a->name))
      return;
  if (!grow_to(&t->attribute, t->attributes + 1, &t->attribute_room, sizeof *t->attribute)) {
    (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for results");
    return;
  }
  t->attribute[t->attributes++] =
    (tape_attribute){ copy(run, group_of(a->group)), copy(run, a->object), copy(run, a->name),
                      copy(run, a->text), a->number };
}

void results_attribute(scene_run *run, const char *group, const char *object, const char *name,
                       const char *text)
{
  if (!scene_going(run)) return;
  if (run->tape != NULL)
    keep_attribute(run, &(tape_attribute){ group, object, name, text, 0.0 });
  else scene_stored(run, pendres_store_attribute(run->store, group, object, name, text));
}

void results_number(scene_run *run, const char *group, const char *object, const char *name,
                    double number)
{
  if (!scene_going(run)) return;
  if (run->tape != NULL)
    keep_attribute(run, &(tape_attribute){ group, object, name, NULL, number });
  else scene_stored(run, pendres_store_attribute_number(run->store, group, object, name, number));
}

int results_has(scene_run *run, const char *group, const char *name)
{
  char of[DECK_NAME * 2];
  if (run->tape == NULL) return pendres_store_has(run->store, group, name);
  if (tape_find(run->tape, group, name) != NULL) return 1;
  const size_t n = strlen(name);
  if (n < 6 || strcmp(name + n - 6, "_error") != 0 || n >= sizeof of) return 0;
  snprintf(of, sizeof of, "%.*s", (int)(n - 6), name);
  const tape_entry *e = tape_find(run->tape, group, of);
  return e != NULL && e->has_error;
}
