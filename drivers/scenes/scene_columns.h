/*
 * scene_columns.h -- tables of results from arrays of structs.
 *
 * Owns: writing a table whose columns are fields of a struct. A scene says of every column its
 * name, its words and where the field stands.
 */
#ifndef SCENE_COLUMNS_H
#define SCENE_COLUMNS_H

#include <stddef.h>

#include "scenes/scene.h"

typedef enum scene_column_type {
  SCENE_REAL = 0, /* double, with an error beside it */
  SCENE_NUMBER,   /* int, stored as int32 */
  SCENE_FLAG      /* int or an enum, stored as int8 with the names of its values */
} scene_column_type;

typedef struct scene_column {
  const char *name, *long_name, *units;
  scene_column_type type;
  size_t value, error;         /* offsets of the fields in a row; error: of a SCENE_REAL */
  int flags;                   /* of a SCENE_FLAG: how many values it has, */
  const char *const *meanings; /* their names, */
  const int8_t *codes;         /* bits, if they are sums of such, else NULL */
  int pairs;                   /* nonzero: two elements a row, over `inner` */
} scene_column;

/* A column of a struct with the fields NAME and NAME_error. */
#define SCENE_COLUMN(row, field, words, unit)                   \
  {.name = #field, .long_name = words, .units = unit,           \
   .value = offsetof(row, field), .error = offsetof(row, field##_error)}

typedef struct scene_table {
  const char *dimensions[2]; /* of the rows, slowest first; the second may be NULL */
  const char *prefix;        /* before all names, with an underscore between; may be NULL */
  const char *inner;         /* of columns that are pairs */
  size_t n, stride;          /* rows; bytes from one to the next */
  const void *rows;
} scene_table;

/* Write all columns; their dimensions exist. */
pendres_status scene_columns_write(scene_run *run, const scene_table *table, size_t count,
                                   const scene_column *columns);

#endif
