/* grow.c -- arrays that grow; see grow.h. */
#include "system/grow.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

void keep_freed_memory(void)
{
#if defined(__GLIBC__)
  enum { MEGABYTE = 1 << 20 };
  /* The largest size that does not go to the system by itself, and what may be left unused. */
  (void)mallopt(M_MMAP_THRESHOLD, 32 * MEGABYTE);
  (void)mallopt(M_TRIM_THRESHOLD, 256 * MEGABYTE);
#endif
}

int grow_to(void *array, size_t wanted, size_t *capacity, size_t size)
{
  const size_t room = wanted + wanted / 2 + 8;
  void *old;
  if (wanted <= *capacity) return 1;
  if (room < wanted || room > SIZE_MAX / size) return 0;
  memcpy(&old, array, sizeof old);
  char *grown = realloc(old, room * size);
  if (grown == NULL) return 0;
  memset(grown + *capacity * size, 0, (room - *capacity) * size);
  memcpy(array, &grown, sizeof grown);
  *capacity = room;
  return 1;
}
