/* journal_file.c -- the bytes of a journal; see journal_file.h. */
#include "farm/journal_file.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <zlib.h>

#include "system/bytes.h"

static const char magic[8] = { 'P', 'E', 'N', 'D', 'R', 'E', 'S', 'J' };
static const uint64_t mark = 0x5245434f52443031u; /* of a record, version 1 */

typedef struct file_head {
  char magic[8];
  uint64_t length;
  uint32_t text_sum, sum;
} file_head;

_Static_assert(sizeof(file_head) == JOURNAL_HEAD, "the head of a journal has no gaps");

enum {
  PIECE = 1 << 20,     /* bytes summed up at a time */
  MOST_ZEROS = 1 << 20 /* bytes of a record that are left out */
};

uint32_t journal_file_sum(const void *data, size_t size)
{
  const unsigned char *p = data;
  uLong sum = crc32(0L, Z_NULL, 0);
  for (; size > PIECE; size -= PIECE, p += PIECE) sum = crc32(sum, p, PIECE);
  return (uint32_t)(size > 0 ? crc32(sum, p, (uInt)size) : sum);
}

/* ---- the head ------------------------------------------------------------------------------ */

/* The first line in which two texts differ, without its indentation. */
static void name_difference(const char *path, const char *theirs, const char *ours, char *words)
{
  while (*theirs != '\0' && *ours != '\0') {
    const size_t a = strcspn(theirs, "\n"), b = strcspn(ours, "\n");
    if (a != b || memcmp(theirs, ours, a) != 0) break;
    theirs += a + (theirs[a] != '\0');
    ours += b + (ours[b] != '\0');
  }
  theirs += strspn(theirs, " ");
  ours += strspn(ours, " ");
  snprintf(words, JOURNAL_WORDS, "the journal '%.150s' is of another deck or build: it has '%.*s', "
           "and this run '%.*s'", path, (int)strcspn(theirs, "\n"), theirs,
           (int)strcspn(ours, "\n"), ours);
}

journal_head journal_file_head(int fd, const char *path, const char *text, off_t *end,
                               char *words)
{
  file_head h;
  journal_head found = JOURNAL_TORN;
  struct stat s;
  char begin[sizeof magic] = "";
  if (fstat(fd, &s) != 0) return JOURNAL_TORN;
  const size_t some = (size_t)s.st_size < sizeof begin ? (size_t)s.st_size : sizeof begin;
  if (!bytes_read(fd, 0, begin, some)) return JOURNAL_TORN;
  if (memcmp(begin, magic, some) != 0) {
    snprintf(words, JOURNAL_WORDS, "'%.300s', where the journal should be, is none: it is left "
             "alone", path);
    return JOURNAL_NONE;
  }
  if (!bytes_read(fd, 0, &h, sizeof h) || h.sum != journal_file_sum(&h, offsetof(file_head, sum)) ||
      h.length > (uint64_t)s.st_size)
    return JOURNAL_TORN;
  char *theirs = malloc((size_t)h.length + 1);
  if (theirs == NULL) return JOURNAL_NO_MEMORY;
  theirs[h.length] = '\0';
  if (bytes_read(fd, sizeof h, theirs, (size_t)h.length) &&
      h.text_sum == journal_file_sum(theirs, (size_t)h.length)) {
    found = strcmp(theirs, text) == 0 ? JOURNAL_SAME : JOURNAL_OTHER;
    if (found == JOURNAL_OTHER) name_difference(path, theirs, text, words);
  }
  *end = (off_t)(sizeof h + h.length);
  free(theirs);
  return found;
}

int journal_file_begin(int fd, const char *text, off_t *end)
{
  file_head h = { .length = strlen(text), .text_sum = journal_file_sum(text, strlen(text)) };
  memcpy(h.magic, magic, sizeof magic);
  h.sum = journal_file_sum(&h, offsetof(file_head, sum));
  *end = (off_t)(sizeof h + h.length);
  return bytes_write(fd, 0, &h, sizeof h) && bytes_write(fd, sizeof h, text, (size_t)h.length);
}

/* ---- records ------------------------------------------------------------------------------- */

int journal_file_entry(int fd, off_t at, journal_entry *e)
{
  struct stat s;
  return fstat(fd, &s) == 0 && bytes_read(fd, at, e, sizeof *e) && e->mark == mark &&
         e->sum == journal_file_sum(e, offsetof(journal_entry, sum)) && e->stored <= e->size &&
         e->stored <= (uint64_t)s.st_size && e->size - e->stored <= MOST_ZEROS;
}

int journal_file_data(int fd, off_t at, const journal_entry *e, void *data)
{
  const size_t stored = (size_t)e->stored;
  if (!bytes_read(fd, at + (off_t)sizeof *e, data, stored)) return 0;
  memset((char *)data + stored, 0, (size_t)e->size - stored);
  return e->data_sum == journal_file_sum(data, stored);
}

int journal_file_copy(int from, off_t at, int to, off_t end, off_t length)
{
  unsigned char *piece = malloc(PIECE);
  int whole = piece != NULL;
  for (off_t n; whole && length > 0; at += n, end += n, length -= n) {
    n = length < PIECE ? length : PIECE;
    whole = bytes_read(from, at, piece, (size_t)n) && bytes_write(to, end, piece, (size_t)n);
  }
  free(piece);
  return whole;
}

/* The data are not kept: only their sum counts. */
int journal_file_next(int fd, off_t at, journal_entry *e)
{
  if (!journal_file_entry(fd, at, e)) return 0;
  uint64_t left = e->stored;
  unsigned char *piece = malloc(PIECE);
  uLong sum = crc32(0L, Z_NULL, 0);
  int whole = piece != NULL;
  at += (off_t)sizeof *e;
  while (whole && left > 0) {
    const size_t n = left < PIECE ? (size_t)left : PIECE;
    whole = bytes_read(fd, at, piece, n);
    if (whole) sum = crc32(sum, piece, (uInt)n);
    at += (off_t)n;
    left -= n;
  }
  free(piece);
  return whole && e->data_sum == (uint32_t)sum;
}

int journal_file_append(int fd, off_t at, journal_entry *e, const void *data)
{
  const char *bytes = data;
  e->stored = e->size;
  while (e->stored > 0 && e->size - e->stored < MOST_ZEROS && bytes[e->stored - 1] == 0)
    e->stored--;
  e->mark = mark;
  e->data_sum = journal_file_sum(data, (size_t)e->stored);
  e->sum = journal_file_sum(e, offsetof(journal_entry, sum));
  return bytes_write(fd, at, e, sizeof *e) &&
         bytes_write(fd, at + (off_t)sizeof *e, data, (size_t)e->stored);
}
