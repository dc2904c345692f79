/* bytes.c -- see bytes.h. */
#define _POSIX_C_SOURCE 200809L /* pread, pwrite */
#include "system/bytes.h"

#include <errno.h>
#include <unistd.h>

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
