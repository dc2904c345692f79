/* room.c -- arrays that are freed together; see room.h. */
#include "engine/room.h"

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "engine/context_internal.h"

typedef struct pendres_room_array {
  struct pendres_room_array *before;
  max_align_t element[];
} array;

void *pendres_room_take(pendres_room *r, size_t n, size_t size)
{
  if (r->status != PENDRES_OK) return NULL;
  const int fits = size == 0 || n <= (SIZE_MAX - sizeof(array)) / size;
  array *a = fits ? calloc(1, sizeof *a + n * size) : NULL;
  if (a == NULL) {
    r->status = pendres_context_fail(r->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu %s", n,
                                     r->what);
    return NULL;
  }
  a->before = r->last;
  r->last = a;
  return a->element;
}

pendres_status pendres_room_close(pendres_room *r, pendres_status status)
{
  while (r->last != NULL) {
    array *a = r->last;
    r->last = a->before;
    free(a);
  }
  return status;
}
