/* scene_columns.c -- tables of results from arrays of structs; see scene_columns.h. */
#include "scenes/scene_columns.h"

#include <stdlib.h>
#include <string.h>

/* Room for a column, as it is stored. */
typedef struct buffers {
  double *value, *error;
  int8_t *flag;
  int32_t *number;
} buffers;

static const char *field(const scene_table *t, size_t row, size_t offset)
{
  return (const char *)t->rows + row * t->stride + offset;
}

static void gather_reals(const scene_table *t, const scene_column *c, buffers *b)
{
  const size_t each = c->pairs ? 2 : 1;
  for (size_t i = 0; i < t->n; i++) {
    memcpy(b->value + each * i, field(t, i, c->value), each * sizeof *b->value);
    memcpy(b->error + each * i, field(t, i, c->error), each * sizeof *b->error);
  }
}

static void gather_integers(const scene_table *t, const scene_column *c, buffers *b)
{
  for (size_t i = 0; i < t->n; i++) {
    int value;
    memcpy(&value, field(t, i, c->value), sizeof value);
    b->flag[i] = (int8_t)value;
    b->number[i] = (int32_t)value;
  }
}

static pendres_status write_column(scene_run *run, const scene_table *t, const scene_column *c,
                                   buffers *b)
{
  char name[64];
  static const pendres_store_type types[] = {[SCENE_REAL] = PENDRES_STORE_DOUBLE,
                                             [SCENE_NUMBER] = PENDRES_STORE_INT32,
                                             [SCENE_FLAG] = PENDRES_STORE_INT8};
  pendres_store_spec spec = {.name = name, .type = types[c->type], .long_name = c->long_name,
                             .units = c->units, .dimensions = {t->dimensions[0], t->dimensions[1]},
                             .flag_count = c->flags, .flag_meanings = c->meanings,
                             .flag_values = c->codes,
                             .flag_bits = c->codes != NULL};
  (void)snprintf(name, sizeof name, "%s%s%s", t->prefix != NULL ? t->prefix : "",
                 t->prefix != NULL ? "_" : "", c->name);
  if (c->pairs) spec.dimensions[t->dimensions[1] != NULL ? 2 : 1] = t->inner;
  if (c->type == SCENE_REAL) {
    gather_reals(t, c, b);
    return pendres_store_put_result(run->store, &spec, b->value, b->error,
                                    c->pairs ? 2 * t->n : t->n);
  }
  gather_integers(t, c, b);
  return pendres_store_put(run->store, &spec,
                           c->type == SCENE_FLAG ? (const void *)b->flag : b->number, t->n);
}

pendres_status scene_columns_write(scene_run *run, const scene_table *t, size_t count,
                                   const scene_column *columns)
{
  buffers b = {.value = malloc((2 * t->n + 1) * sizeof *b.value),
               .error = malloc((2 * t->n + 1) * sizeof *b.error),
               .flag = malloc(t->n + 1),
               .number = malloc((t->n + 1) * sizeof *b.number)};
  pendres_status status = PENDRES_OK;
  if (b.value == NULL || b.error == NULL || b.flag == NULL || b.number == NULL)
    status = scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu results", t->n);
  for (size_t k = 0; k < count && status == PENDRES_OK; k++) {
    status = write_column(run, t, &columns[k], &b);
    if (status != PENDRES_OK) (void)scene_store_failed(run, status);
  }
  free(b.value);
  free(b.error);
  free(b.flag);
  free(b.number);
  return status;
}
