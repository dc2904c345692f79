/* text.c -- see text.h. */
#define _GNU_SOURCE /* fopencookie */
#include "system/text.h"

#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#include "system/grow.h"

static ssize_t take(void *of, const char *from, size_t n)
{
  text *t = of;
  if (t->short_of || !grow_to(&t->data, t->size + n + 1, &t->room, 1)) {
    t->short_of = 1; /* nor is anything taken behind the hole */
    return 0;
  }
  memcpy(t->data + t->size, from, n);
  t->size += n;
  t->data[t->size] = '\0';
  return (ssize_t)n;
}

int text_open(text *t)
{
  *t = (text){ .stream = NULL };
  t->stream = fopencookie(t, "w", (cookie_io_functions_t){ .write = take });
  t->short_of = t->stream == NULL || !grow_to(&t->data, 1, &t->room, 1);
  return text_whole(t);
}

int text_whole(text *t)
{
  return t->stream != NULL && fflush(t->stream) == 0 && !ferror(t->stream) && !t->short_of;
}

char *text_close(text *t)
{
  char *data = text_whole(t) ? t->data : NULL;
  if (data != NULL) t->data = NULL;
  text_drop(t);
  return data;
}

void text_drop(text *t)
{
  if (t->stream != NULL) (void)fclose(t->stream);
  free(t->data);
  *t = (text){ .stream = NULL };
}
