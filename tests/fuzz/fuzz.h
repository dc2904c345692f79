/*
 * fuzz.h -- what the harnesses of libFuzzer share. Each is a file with one function that takes any
 * bytes and ends the program where what must always hold does not. `make fuzz` builds them with
 * clang; tests/test_fuzz_corpus.c includes them and hands them the bytes in tests/fuzz/corpus.
 */
#ifndef FUZZ_H
#define FUZZ_H

#ifndef _XOPEN_SOURCE
#define _XOPEN_SOURCE 700 /* mkdtemp, pread, dup */
#endif
#ifndef _DEFAULT_SOURCE
#define _DEFAULT_SOURCE   /* syscall */
#endif
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Not assert(): it holds whatever the flags are. */
#define REQUIRE(condition)                                                             \
  do {                                                                                 \
    if (!(condition)) {                                                                \
      fprintf(stderr, "%s:%d: not true: %s\n", __FILE__, __LINE__, #condition);        \
      abort();                                                                         \
    }                                                                                  \
  } while (0)

/* A folder of this process for files that are made thousands of times: in memory, if there is such
   a place. It goes when the program ends, if it is empty by then. */
static char fuzz_folder[40];

static inline void fuzz_leave(void)
{
  (void)rmdir(fuzz_folder);
}

static inline void fuzz_path(char *path, size_t room, const char *name)
{
  if (fuzz_folder[0] == '\0') {
    const int fast = access("/dev/shm", W_OK | X_OK) == 0;
    snprintf(fuzz_folder, sizeof fuzz_folder, "%s/fuzz-XXXXXX", fast ? "/dev/shm" : "/tmp");
    REQUIRE(mkdtemp(fuzz_folder) != NULL && atexit(fuzz_leave) == 0);
  }
  REQUIRE((size_t)snprintf(path, room, "%s/%s", fuzz_folder, name) < room);
}

static inline void fuzz_save(const char *path, const uint8_t *data, size_t size)
{
  FILE *f = fopen(path, "wb");
  REQUIRE(f != NULL);
  REQUIRE(size == 0 || fwrite(data, 1, size, f) == size);
  REQUIRE(fclose(f) == 0);
}

#endif
