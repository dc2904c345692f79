/*
 * record.h -- the result of a task: plain bytes that depend only on its number, the deck and the
 * code.
 */
#ifndef RECORD_H
#define RECORD_H

#include <stddef.h>

#include <pendres/pendres.h>

#include "farm/numbers.h"

/* The result of a task. */
typedef struct farm_record {
  void *data;        /* zero at first; the farm's */
  size_t size;       /* in bytes: the stage's record_size, unless the task has chosen another
                        size */
  pendres_cost cost; /* the cost of the task according to its context; the farm fills it in */
  struct farm_watch *watch; /* of its points, see farm_point(): the farm's; NULL: none */
  size_t lost;       /* points that were given up, see farm_lost() */
  char message[512]; /* why the task has failed, where its context has no message; "" at first */
} farm_record;

/* Give a record a size of its own; new bytes are zero. Returns its data; NULL: out of memory. */
void *farm_record_resize(farm_record *record, size_t size);

#endif
