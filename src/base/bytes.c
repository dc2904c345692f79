/* bytes.c -- records as plain bytes; see bytes.h. */
#include "base/bytes.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"

pendres_bytes pendres_bytes_read(size_t size, const void *bytes)
{
  pendres_bytes b = {.reads = 1, .size = size};
  memcpy(&b.bytes, &bytes, sizeof bytes); /* they are not written to */
  if (bytes == NULL) b.status = PENDRES_INVALID_ARGUMENT;
  return b;
}

int pendres_bytes_fit(pendres_bytes *b, int fits)
{
  if (b->status == PENDRES_OK && !fits) b->status = PENDRES_INVALID_ARGUMENT;
  return b->status == PENDRES_OK;
}

int pendres_bytes_end(pendres_bytes *b)
{
  return pendres_bytes_fit(b, b->at == b->size);
}

/* Make room for more bytes to be written. */
static int make_room(pendres_bytes *b, size_t more)
{
  const size_t larger = b->size + more + b->capacity / 2;
  if (b->size + more <= b->capacity) return 1;
  if (!pendres_regrow(&b->bytes, larger, 1)) return 0;
  b->capacity = larger;
  return 1;
}

void pendres_bytes_pass(pendres_bytes *b, size_t n, size_t size, void *elements)
{
  if (b->reads) {
    if (pendres_bytes_fit(b, n <= (b->size - b->at) / size) && n > 0)
      memcpy(elements, b->bytes + b->at, n * size);
    else if (n > 0)
      memset(elements, 0, n * size);
    if (b->status == PENDRES_OK) b->at += n * size;
    return;
  }
  if (b->status != PENDRES_OK || n == 0) return;
  if (make_room(b, n * size)) {
    memcpy(b->bytes + b->size, elements, n * size);
    b->size += n * size;
  } else {
    b->status = PENDRES_OUT_OF_MEMORY;
  }
}

void pendres_bytes_pass_array(pendres_bytes *b, size_t n, size_t size, void *array)
{
  void *elements = NULL;
  if (!b->reads) {
    memcpy(&elements, array, sizeof elements);
  } else if (pendres_bytes_fit(b, n <= (b->size - b->at) / size) && n > 0) {
    elements = malloc(n * size);
    if (elements == NULL) b->status = PENDRES_OUT_OF_MEMORY;
  }
  if (b->status == PENDRES_OK) pendres_bytes_pass(b, n, size, elements);
  if (b->reads) memcpy(array, &elements, sizeof elements);
}
