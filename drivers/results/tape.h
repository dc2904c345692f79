/*
 * tape.h -- results of scenes that are computed one after another for the values of an outer axis:
 * tape.c puts them on a tape, stack.c puts them together.
 *
 * Owns: the tape, a file without a name; how results of several scenes become variables with one
 * more dimension. A dimension that is the same for all values stays what it is; one that differs,
 * as the number of attractors, is as long as the longest, NAME_length tells how long it is at each
 * value, and what lies beyond is NaN, -1 or an empty text.
 */
#ifndef TAPE_H
#define TAPE_H

#include "results/results.h"

/* A tape for the results of `slices` scenes; NULL: why is on record. */
typedef struct results_tape results_tape;
results_tape *results_tape_create(scene_run *run, size_t slices);
void results_tape_free(results_tape *tape);

/* What is written from now on is of this slice; and what it has written so far is forgotten. */
void results_tape_begin(results_tape *tape, size_t slice);
void results_tape_forget(results_tape *tape, size_t slice);

/* Write it all into the run's store; axis(run, group) makes the outer dimension, of that name, in
   each of the groups. */
void results_tape_write(scene_run *run, results_tape *tape, const char *name,
                        void (*axis)(scene_run *run, const char *group));

/* Of a dimension or variable, what one slice has. */
typedef struct tape_part {
  int there, numbering;     /* numbering: a dimension that counts from 0 on */
  uint64_t size[PENDRES_STORE_RANK];
  uint64_t at, error_at;    /* bytes on the tape */
  const char **text;        /* of strings, which are not on it */
} tape_part;

typedef struct tape_entry {
  pendres_store_spec spec;
  int dimension, has_error, rank;
  uint64_t most[PENDRES_STORE_RANK]; /* of the sizes of all slices, once all are there */
  tape_part *part;          /* [slices] */
} tape_entry;

typedef struct tape_attribute {
  const char *group, *object, *name;
  const char *text;         /* NULL: it is a number */
  double number;
} tape_attribute;

struct results_tape {
  int file;
  uint64_t length;          /* bytes */
  size_t slices, slice;
  scene_room room;
  tape_entry *entry;        /* in the order in which they first came */
  size_t entries, room_for;
  tape_attribute *attribute;
  size_t attributes, attribute_room;
};

/* Bytes of an element; 0: a string. */
size_t tape_element(pendres_store_type type);

/* The product of an entry's sizes. */
uint64_t tape_length(const tape_entry *e, const uint64_t *size);

/* NULL: there is none. */
tape_entry *tape_find(results_tape *t, const char *group, const char *name);

#endif
