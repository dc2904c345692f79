/*
 * grow.h -- arrays that grow as elements are added.
 */
#ifndef PENDRES_GROW_H
#define PENDRES_GROW_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/*
 * Make room for `capacity` elements in the array whose address is stored at `array`: pass &a for an
 * array a of any type. For several arrays with a common capacity: the caller stores the new
 * capacity after all of them have grown. 0: out of memory; the array is unchanged.
 */
static inline int pendres_regrow(void *array, size_t capacity, size_t size)
{
  void *old, *grown;
  memcpy(&old, array, sizeof old);
  if (capacity > SIZE_MAX / size) return 0;
  grown = realloc(old, capacity * size);
  if (grown == NULL) return 0;
  memcpy(array, &grown, sizeof grown);
  return 1;
}

/*
 * Make room for one more in an array of `count` elements. Returns the array or, where it was full,
 * a larger one in its place, whose size is then in *capacity. NULL: out of memory; the array is
 * unchanged.
 */
static inline void *pendres_grow(void *array, size_t count, size_t *capacity, size_t size)
{
  if (count < *capacity) return array;
  const size_t larger = count + count / 2 + 32;
  if (!pendres_regrow(&array, larger, size)) return NULL;
  *capacity = larger;
  return array;
}

#endif
