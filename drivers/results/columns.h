/*
 * columns.h -- tables of results from arrays of structs.
 *
 * Owns: writing a table whose columns are fields of a struct, and printing a short one; whether
 * rows that come from a journal can be what a task has written; the group `paper`. A scene gives
 * for each column its name and the place of the field; units, and words where it gives none, are
 * those of its quantity (pendres/quantity.h).
 */
#ifndef SCENE_COLUMNS_H
#define SCENE_COLUMNS_H

#include <stddef.h>

#include "results/failed.h"

typedef enum scene_column_type {
  SCENE_REAL = 0, /* double, with an error beside it */
  SCENE_PLAIN,    /* double, without an error */
  SCENE_NUMBER,   /* int, stored as int32 */
  SCENE_COUNT,    /* size_t, stored as int64, ... */
  SCENE_COUNT32,  /* ... or as int32 */
  SCENE_FLAG,     /* int or an enum, stored as int8 with the names of its values */
  SCENE_TEXT      /* array of char */
} scene_column_type;

/* The name of a value; NULL beyond the last. */
typedef const char *(*scene_names)(int value);

/* Names of one file's own codes, from 0 on, as such a function. */
#define SCENE_NAMES(function, ...)                                                    \
  static const char *function(int value)                                              \
  {                                                                                   \
    static const char *const names[] = {__VA_ARGS__};                                 \
    return value >= 0 && value < (int)(sizeof names / sizeof *names) ? names[value]   \
                                                                     : NULL;          \
  }

typedef struct scene_column {
  const char *name;
  const char *long_name;       /* NULL: the words of its quantity */
  const char *quantity;        /* by name; NULL: that of the column's own name, or none */
  const char *units;           /* of what is none of the pendulum's: seconds; else NULL */
  scene_column_type type;
  size_t value, error;         /* offsets of the fields in a row; error: of a SCENE_REAL */
  scene_names names;           /* of a SCENE_FLAG; NULL: it is a plain 0 or 1 */
  const int8_t *codes;         /* of a SCENE_FLAG that is a sum of bits: these; names are those
                                  of 0, 1, 2 ... */
  int (*when)(const deck *d);  /* not NULL: whether a deck has the column */
  int pairs;                   /* nonzero: two elements a row, over `inner` */
  const char *comment;
} scene_column;

/* What a column begins with: of a field with its error, FIELD_error, beside it; of one that is a
   struct of value and error; and of a field of another type than real. Words and quantities may be
   NULL. Other members may follow. */
#define SCENE_AS(label, row, field, words, of_quantity)             \
  .name = label, .long_name = words, .quantity = of_quantity,       \
  .value = offsetof(row, field), .error = offsetof(row, field##_error)
#define SCENE_ESTIMATE(label, row, field, words, of_quantity)       \
  .name = label, .long_name = words, .quantity = of_quantity,       \
  .value = offsetof(row, field.value), .error = offsetof(row, field.error)
#define SCENE_TYPED(kind, label, row, field, words)           \
  .name = label, .long_name = words, .type = kind, .value = offsetof(row, field)

/* Whole columns with the names of their fields; a code has the names of its values. */
#define SCENE_COLUMN(row, field, words) {SCENE_AS(#field, row, field, words, NULL)}
#define SCENE_COLUMN_OF(kind, row, field, words) {SCENE_TYPED(kind, #field, row, field, words)}
#define SCENE_CODE(row, field, words, names_of) \
  {SCENE_TYPED(SCENE_FLAG, #field, row, field, words), .names = names_of}

/* The column that stands beside the means of an ensemble. */
#define SCENE_UNCERTAIN(row, field)                           \
  {SCENE_TYPED(SCENE_COUNT, "uncertain_members", row, field, NULL)}

/* And the one where the force may drive them to infinity. */
#define SCENE_ESCAPED(row, field)                                                    \
  {SCENE_TYPED(SCENE_COUNT, "escaped_members", row, field,                           \
               "members that escape to infinity; means are those of the others"),    \
   .when = deck_leaves}

typedef struct scene_table {
  const char *group;         /* NULL: the root */
  const char *dimensions[3]; /* of the rows, slowest first; none: one row of scalars */
  const char *prefix;        /* before all names, with an underscore between; may be NULL */
  const char *star;          /* in the place of the * in names; may be NULL */
  const char *words;         /* behind all long names, after a blank; may be NULL */
  const char *inner;         /* of columns that are pairs */
  size_t n, stride;          /* rows; bytes from one to the next */
  const void *rows;
  size_t first;              /* values of the first dimension, written some at a time; 0: at once */
  int deflate;               /* level of compression; 0: as the file has it */
} scene_table;

/* The rows of a table: n of an array, or a single struct. */
#define SCENE_ROWS(array, count) .n = count, .stride = sizeof *(array), .rows = array

/* Write all columns; their dimensions exist. SCENE_WRITE writes those of an array. */
void scene_columns_write(scene_run *run, const scene_table *table, size_t count,
                         const scene_column *columns);
#define SCENE_WRITE(run, table, columns) \
  scene_columns_write(run, table, sizeof columns / sizeof *columns, columns)

/* Can this be a row, from a journal: are its codes among those of the columns? Doubles and numbers
   may be anything. */
int scene_columns_fit(size_t count, const scene_column *columns, const void *row);

/* Make a row one without results: its doubles are NaN, the rest stays. */
void scene_columns_blank(size_t count, const scene_column *columns, void *row);
#define SCENE_BLANK(columns, row) \
  scene_columns_blank(sizeof columns / sizeof *columns, columns, row)

/* Write a table of scene_failed as the codes of that name. */
void scene_columns_write_failed(scene_run *run, const scene_table *table, const char *name,
                                const char *long_name);

/* Write the principal measures of the orbits that stand at that offset in the rows. */
void scene_columns_write_orbits(scene_run *run, const scene_table *table, size_t orbit);

/* What the store calls a column: the numbers of its variable and, if it has one, its error's. */
typedef struct scene_variable {
  int value, error;
} scene_variable;

/* Columns of a table that comes in pieces. */
typedef struct scene_variables {
  size_t count;
  const scene_column *column;
  scene_variable *variable;
} scene_variables;

/* Define the variables; then write pieces: table->rows are the n elements of `rows` values of the
   first dimension, from number `first` on. */
void scene_columns_define(scene_run *run, const scene_table *table, const scene_variables *of);
void scene_columns_write_rows(scene_run *run, const scene_table *table, size_t first, size_t rows,
                              const scene_variables *of);

/* Names of values of the library's enums, as columns take them. */
const char *scene_motion_names(int value); /* of all that a pendulum may settle on, ... */
scene_names scene_settled_names(const pendres_pendulum *p); /* ... and of what this one may */
const char *scene_doubt_names(int value); /* "no", "yes" */
const char *scene_regime_names(int value);
const char *scene_special_names(int value);
const char *scene_jump_names(int value);
const char *scene_cloud_names(int value);
const char *scene_switching_names(int value);

/* A cell of a printed line: what stands above it, its format, and where its field stands. */
typedef struct scene_cell {
  const char *heading, *format; /* with the blanks between it and the next */
  const char *none;             /* printed in the place of NaN; may be NULL */
  scene_column_type type;
  size_t value;
  scene_names names; /* not NULL: the format is of the value's name */
} scene_cell;

/* A cell of a struct's double. */
#define SCENE_CELL(row, field, words, form) \
  {.heading = words, .format = form, .value = offsetof(row, field)}

/* Rows of a short table, of which there may be any number: what a terminal shows at once. */
enum { SCENE_TABLE_LINES = 40 };

/* A line of headings and at most `lines` rows of the table, evenly chosen, with the last one; all
   if there are not many more. Where instead (may be NULL) gives words for a row, they stand behind
   its first cell instead of the others.
   SCENE_PRINT takes all cells of an array. */
void scene_columns_print(FILE *out, const scene_table *table, size_t lines, size_t count,
                         const scene_cell *cells, const char *(*instead)(const void *row));
#define SCENE_PRINT(out, table, lines, cells, instead) \
  scene_columns_print(out, table, lines, sizeof cells / sizeof *cells, cells, instead)

/*
 * Records that come from elsewhere: the ranges of what they hold of the library's structs: codes,
 * counts, flags, numbers of things and texts. Doubles may be anything. Each returns 0 where
 * something is out of its range.
 */

/* Is a code one of 0 .. count - 1? Of an enum too, whatever its sign. */
int scene_check_code(int code, int count);

/* Does a text end within its room? */
int scene_check_text(const char *text, size_t room);

int scene_check_attractor(const pendres_attractor *a); /* closed or not */
int scene_check_response(const pendres_response *r);

/* attractors: how many the set has to which the state's number refers. */
int scene_check_basin_state(const pendres_basin_state *state, size_t attractors);

/* A value that the paper prints beside that of the run, in the group `paper` of the file. */
typedef struct scene_printed {
  const char *name;      /* of the quantity, e.g. "resonance_period_gamma_0.24" */
  double printed;        /* by the paper */
  double computed, error;
  double difference;     /* is set when it is written */
} scene_printed;

/* Write them, if there are any. */
void scene_write_paper(scene_run *run, size_t n, scene_printed *values);

#endif
