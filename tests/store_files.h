/*
 * store_files.h -- what the tests of the store share: statuses with their messages, and files in
 * a folder of their own that is removed at the end.
 */
#ifndef STORE_FILES_H
#define STORE_FILES_H

#ifndef _DEFAULT_SOURCE
#define _DEFAULT_SOURCE /* mkdtemp */
#endif

#include "check.h"
#include "store/internal.h" /* to look at HDF5's own state */

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The call comes first: it may set the store. */
#define WITH_STATUS(call, check)                                                                  \
  do {                                                                                            \
    const pendres_status status_ = (call);                                                        \
    check;                                                                                        \
  } while (0)
#define OK(call) WITH_STATUS(call, check_store_at(status_, store, #call, __FILE__, __LINE__))
#define REFUSED(call, words)                                                                      \
  WITH_STATUS(call, check_refused_at(status_, PENDRES_INVALID_ARGUMENT, store, (words), #call,    \
                                     __FILE__, __LINE__))
#define MISSING(call, words)                                                                      \
  WITH_STATUS(call, check_refused_at(status_, PENDRES_NOT_FOUND, store, (words), #call, __FILE__, \
                                     __LINE__))
#define LENGTH(array) (sizeof(array) / sizeof(array)[0])
/* Each test leaves nothing of HDF5 open. */
#define TEST(function) cmocka_unit_test_teardown(function, nothing_open)

enum { PATH_ROOM = 256 };

static char folder[PATH_ROOM / 2];

static inline void check_store_at(pendres_status status, const pendres_store *store,
                                  const char *what, const char *file, int line)
{
  if (status == PENDRES_OK) return;
  print_error("%s:%d: %s: status %d, %s\n", file, line, what, (int)status,
              pendres_store_message(store));
  fail();
}

/* The call failed so, and its message holds the words. */
static inline void check_refused_at(pendres_status status, pendres_status wanted,
                                    const pendres_store *store, const char *words,
                                    const char *what, const char *file, int line)
{
  if (status == wanted && strstr(pendres_store_message(store), words)) return;
  print_error("%s:%d: %s: status %d (wanted %d), message '%s' (wanted '%s')\n", file, line, what,
              (int)status, (int)wanted, pendres_store_message(store), words);
  fail();
}

/* ---- Files ----------------------------------------------------------------------------------- */

static inline const char *in_folder(char path[PATH_ROOM], const char *name)
{
  snprintf(path, PATH_ROOM, "%s/%s", folder, name);
  return path;
}

static inline int exists(const char *path)
{
  struct stat info;

  return !lstat(path, &info);
}

static inline void write_file(const char *path, const char *text)
{
  FILE *f = fopen(path, "wb");

  assert_non_null(f);
  assert_int_equal(fputs(text, f) >= 0, 1);
  assert_int_equal(fclose(f), 0);
}

/* malloc'd contents. */
static inline char *read_file(const char *path, size_t *size)
{
  FILE *f = fopen(path, "rb");
  char *bytes = NULL;
  long end;

  assert_non_null(f);
  assert_int_equal(fseek(f, 0, SEEK_END), 0);
  end = ftell(f);
  assert_true(end >= 0);
  rewind(f);
  bytes = malloc((size_t)end + 1);
  assert_non_null(bytes);
  assert_int_equal(fread(bytes, 1, (size_t)end, f), end);
  bytes[end] = '\0';
  fclose(f);
  *size = (size_t)end;
  return bytes;
}

static inline void check_contents(const char *path, const char *text)
{
  size_t size;
  char *bytes = read_file(path, &size);

  assert_string_equal(bytes, text);
  free(bytes);
}

static inline void check_same_bytes(const char *one, const char *other)
{
  size_t size, other_size;
  char *bytes = read_file(one, &size), *other_bytes = read_file(other, &other_size);

  assert_int_equal(size, other_size);
  assert_memory_equal(bytes, other_bytes, size);
  free(bytes);
  free(other_bytes);
}

static inline int make_folder(void **state)
{
  const char *base = getenv("TMPDIR");

  (void)state;
  snprintf(folder, sizeof folder, "%.80s/test_store.XXXXXX", base && *base ? base : "/tmp");
  return mkdtemp(folder) ? 0 : -1;
}

static inline int remove_folder(void **state)
{
  DIR *d = opendir(folder);
  struct dirent *entry;

  (void)state;
  while (d && (entry = readdir(d))) {
    char path[2 * PATH_ROOM];

    snprintf(path, sizeof path, "%s/%.200s", folder, entry->d_name);
    if (entry->d_name[0] != '.') remove(path);
  }
  if (d) closedir(d);
  return rmdir(folder);
}

/* Nothing of HDF5 stays open after any test: not after failures either. */
static inline int nothing_open(void **state)
{
  (void)state;
  return H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL) == 0 ? 0 : -1;
}

#endif
