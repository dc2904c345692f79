/* bytes.c -- see bytes.h. */
#define _POSIX_C_SOURCE 200809L /* pread, pwrite */
#include "system/bytes.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "system/grow.h"

enum { PIECE = 1 << 16 /* bytes for which there is room at first, where a size is not known */ };

int bytes_read(int file, off_t at, void *to, size_t size)
{
  for (char *p = to; size > 0;) {
    const ssize_t n = pread(file, p, size, at);
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = EIO;
    if (n <= 0) return 0;
    p += n;
    at += n;
    size -= (size_t)n;
  }
  return 1;
}

int bytes_write(int file, off_t at, const void *from, size_t size)
{
  for (const char *p = from; size > 0;) {
    const ssize_t n = pwrite(file, p, size, at);
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = ENOSPC;
    if (n <= 0) return 0;
    p += n;
    at += n;
    size -= (size_t)n;
  }
  return 1;
}

/* All of it into *text, which has been given room; *used bytes so far. */
static pendres_status read_all(int file, size_t most, char **text, size_t *room, size_t *used)
{
  for (;;) {
    if (!grow_to(text, *used + 2, room, 1)) return PENDRES_OUT_OF_MEMORY; /* a byte, and the zero */
    const ssize_t n = read(file, *text + *used, *room - *used - 1);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n == 0 ? PENDRES_OK : PENDRES_IO;
    *used += (size_t)n;
    if (*used > most) return PENDRES_UNSUPPORTED;
  }
}

pendres_status bytes_text(int file, size_t most, char **text, size_t *length)
{
  struct stat s;
  const int known = fstat(file, &s) == 0 && S_ISREG(s.st_mode);
  *text = NULL;
  *length = 0;
  if (known && (uintmax_t)s.st_size > most) return PENDRES_UNSUPPORTED;
  size_t room = known ? (size_t)s.st_size + 2 : PIECE;
  *text = malloc(room);
  const pendres_status status = *text != NULL ? read_all(file, most, text, &room, length)
                                              : PENDRES_OUT_OF_MEMORY;
  if (status == PENDRES_OK) {
    (*text)[*length] = '\0';
    return status;
  }
  free(*text);
  *text = NULL;
  return status;
}
