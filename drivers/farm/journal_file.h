/*
 * journal_file.h -- the bytes of a journal.
 *
 * Owns: how head and records are written and read back, and their checksums (zlib's crc32).
 *
 *   head     "PENDRESJ", length of the text and two checksums, of the text and of all before it;
 *            the text
 *   record   a journal_entry, with a checksum of itself and one of the data; the data, without the
 *            zeros at its end; at most a megabyte of them is left out, so that the memory needed to
 *            read a file is not much larger than the file
 *
 * Numbers have the byte order of the machine: a journal is continued where it was begun.
 */
#ifndef JOURNAL_FILE_H
#define JOURNAL_FILE_H

#include <stdint.h>
#include <sys/types.h>

enum {
  JOURNAL_WORDS = 512, /* room for a message about a journal */
  JOURNAL_HEAD = 24    /* bytes before the text of a head */
};

typedef struct journal_entry {
  uint64_t mark;         /* filled in by journal_file_append, as are stored and the checksums */
  uint64_t stage, task;
  uint64_t size, stored; /* bytes of data, and how many of them were written */
  double cost[5];
  uint32_t data_sum, sum;
} journal_entry;

typedef enum journal_head {
  JOURNAL_SAME,
  JOURNAL_OTHER,    /* of another deck or build */
  JOURNAL_NONE,     /* not a journal */
  JOURNAL_TORN,     /* killed while it was made, or empty */
  JOURNAL_NO_MEMORY
} journal_head;

/* The checksum of bytes. */
uint32_t journal_file_sum(const void *data, size_t size);

/* Compare the head of the file, which is open, with `text`; *end is where it ends. words: the
   difference. */
journal_head journal_file_head(int fd, const char *path, const char *text, off_t *end,
                               char *words);

/* Write a head into an empty file; 0 on failure, see errno. */
int journal_file_begin(int fd, const char *text, off_t *end);

/* Read the head of the record at `at`; 0 if there is no such. */
int journal_file_entry(int fd, off_t at, journal_entry *e);

/* Read its data, zeros and all; 0 if they are damaged. */
int journal_file_data(int fd, off_t at, const journal_entry *e, void *data);

/* Is there a whole record at `at`? */
int journal_file_next(int fd, off_t at, journal_entry *e);

/* Copy bytes from one file to another; 0 on failure. */
int journal_file_copy(int from, off_t at, int to, off_t end, off_t length);

/* Write a record; 0 on failure, see errno. */
int journal_file_append(int fd, off_t at, journal_entry *e, const void *data);

#endif
