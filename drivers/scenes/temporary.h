/*
 * temporary.h -- results of tasks that later tasks read, if they may be too large for memory.
 *
 * Owns: an array of elements of one size, in memory if it is small, otherwise in a file without a
 * name, in TMPDIR or in the folder of the output, which vanishes with the run however that ends.
 */
#ifndef SCENE_TEMPORARY_H
#define SCENE_TEMPORARY_H

#include "scenes/scene.h"

enum { SCENE_TEMPORARY_MEMORY = 64 << 20 /* bytes; larger arrays are in a file */ };

typedef struct scene_temporary {
  size_t element;
  char *memory; /* NULL: the array is in the file */
  int file;
} scene_temporary;

/* An array of n elements, in memory if it has at most `memory` bytes. After a failure run->message
   has the reason. */
pendres_status scene_temporary_create(scene_run *run, size_t n, size_t element, size_t memory,
                                      scene_temporary *out);
/* Does nothing to one that is all zero, since it was never created. */
void scene_temporary_free(scene_temporary *s);

/* Write or read elements first ... first + n - 1. */
pendres_status scene_temporary_put(scene_run *run, const scene_temporary *s, size_t first, size_t n,
                                   const void *data);
pendres_status scene_temporary_read(scene_run *run, const scene_temporary *s, size_t first,
                                    size_t n, void *data);

/* Read them in a task, on any thread. PENDRES_IO: why[size] receives the reason. */
pendres_status scene_temporary_get(const scene_temporary *s, size_t first, size_t n, void *data,
                                   char *why, size_t size);

#endif
