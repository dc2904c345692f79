/*
 * grow.h -- arrays that grow as elements are added.
 */
#ifndef PENDRES_GROW_H
#define PENDRES_GROW_H

#include <stdint.h>
#include <stdlib.h>

/*
 * An array of `count` elements with room for one more: itself, or a larger one in its place, and
 * *capacity is then what that has room for. NULL: out of memory; the array is as it was.
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
