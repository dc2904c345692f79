/*
 * grow.h -- arrays that grow as elements are added.
 */
#ifndef PENDRES_GROW_H
#define PENDRES_GROW_H

#include <stdint.h>
#include <stdlib.h>

/*
 * Make room for one more in an array of `count` elements. Returns the array or, where it was full,
 * a larger one in its place, whose room is then in *capacity. NULL: out of memory; the array is as
 * it was.
 */
static inline void *pendres_grow(void *array, size_t count, size_t *capacity, size_t size)
{
  if (count < *capacity) return array;
  const size_t larger = count + count / 2 + 32;
  if (larger > SIZE_MAX / size) return NULL;
  void *grown = realloc(array, larger * size);
  if (grown != NULL) *capacity = larger;
  return grown;
}

#endif
