/* verify.c -- see run.h. */
#define _XOPEN_SOURCE 700 /* stat */
#include "run.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <pendres/store.h>

#include "system/apart.h"
#include "system/file.h"
#include "terminal/safe_text.h"

enum { WHOLE = 0, DAMAGED = 1, UNTOLD = 2 };

static int tell(const char *file, const char *verdict, const char *why)
{
  safe_text_write(stdout, file);
  printf(": %s", verdict);
  if (*why != '\0') fputs(": ", stdout);
  safe_text_write(stdout, why);
  putchar('\n');
  return DAMAGED;
}

static int tell_whole(const char *file, uint64_t datasets, const char *deck, const char *version)
{
  safe_text_write(stdout, file);
  printf(": whole: %llu datasets, deck ", (unsigned long long)datasets);
  safe_text_write(stdout, deck);
  fputs(", resonance ", stdout);
  safe_text_write(stdout, version);
  putchar('\n');
  return WHOLE;
}

/* A file that HDF5 can open. */
static int read_store(const char *file, pendres_store *store)
{
  uint64_t datasets = 0;
  char *deck = NULL, *version = NULL;
  int code;
  if (pendres_store_verify(store, &datasets) != PENDRES_OK)
    code = tell(file, "damaged", pendres_store_message(store));
  else if (pendres_store_read_text(store, "provenance", "deck_name", 0, &deck) != PENDRES_OK ||
           pendres_store_read_text(store, "provenance", "version", 0, &version) != PENDRES_OK ||
           *deck == '\0' || *version == '\0')
    code = tell(file, "can be read, but holds no finished results of resonance",
                pendres_store_message(store));
  else
    code = tell_whole(file, datasets, deck, version);
  free(deck);
  free(version);
  return code;
}

/* In the process that reads. */
static int read_file(const void *arg)
{
  const char *file = arg;
  pendres_store *store = NULL;
  const pendres_status status = pendres_store_open(file, &store);
  const int code = status == PENDRES_OK ? read_store(file, store)
                   : tell(file, status == PENDRES_BUSY ? "cannot be read"
                                                       : "damaged, or no HDF5 file",
                          store != NULL ? pendres_store_message(store)
                                        : pendres_status_message(status));
  pendres_store_free(store);
  return fflush(stdout) == 0 ? code : UNTOLD;
}

static int verify_file(const char *file)
{
  struct stat info = { .st_size = 0 };
  char why[FILE_WORDS];
  const int fd = file_open(file, FILE_READ, 0, why);
  if (fd < 0) return tell(file, "cannot be read", why);
  (void)fstat(fd, &info);
  (void)close(fd);
  if (fflush(stdout) != 0) return DAMAGED; /* or both processes would write what is left */
  const int code = apart(read_file, file, info.st_size, -1);
  if (code == APART_FAILED) return tell(file, "cannot be read", strerror(errno));
  if (code == APART_ENDLESS) return tell(file, "damaged", "reading it does not end");
  if (code == APART_CRASHED) return tell(file, "damaged", "HDF5 crashes when it reads it");
  if (code == UNTOLD) fputs("resonance: error: standard output cannot be written\n", stderr);
  return code == WHOLE ? WHOLE : DAMAGED;
}

int verify_files(char *const *files, size_t count)
{
  int code = WHOLE;
  for (size_t i = 0; i < count; i++)
    if (verify_file(files[i]) != WHOLE) code = DAMAGED;
  return options_written(stdout) == 0 ? code : DAMAGED;
}
