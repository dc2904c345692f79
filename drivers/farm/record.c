/* record.c -- the result of a task; see record.h. */
#include "farm/record.h"

#include <stdlib.h>
#include <string.h>

void *farm_record_resize(farm_record *record, size_t size)
{
  char *data = realloc(record->data, size + 1); /* one byte more, so that a record of no bytes is no
                                                   failure of malloc */
  if (data == NULL) return NULL;
  if (size > record->size) memset(data + record->size, 0, size - record->size);
  record->data = data;
  record->size = size;
  return data;
}
