/* verify.c -- see verify.h. */
#define _XOPEN_SOURCE 700 /* fork, setrlimit, stat */
#include "verify.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <pendres/store.h>

#include "options.h"
#include "terminal/safe_text.h"

enum { WHOLE = 0, DAMAGED = 1, UNTOLD = 2 };

/* Reading may cost so much processor time, and a second more a megabyte: one that goes on has lost
   its way in a damaged file. */
enum { SECONDS = 60 };

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

static int read_file(const char *file)
{
  pendres_store *store = NULL;
  const pendres_status status = pendres_store_open(file, &store);
  const int code = status == PENDRES_OK ? read_store(file, store)
                   : tell(file, "damaged, or no HDF5 file",
                          store != NULL ? pendres_store_message(store)
                                        : pendres_status_message(status));
  pendres_store_free(store);
  return code;
}

/* The process that reads; it ends here. */
static _Noreturn void read_apart(const char *file, off_t size)
{
  const rlim_t seconds = SECONDS + (rlim_t)(size / 1000000);
  const struct rlimit no_core = { 0, 0 }, time_limit = { seconds, seconds };
  (void)setrlimit(RLIMIT_CORE, &no_core);
  (void)setrlimit(RLIMIT_CPU, &time_limit);
  /* The last words of a crash are no use to anybody: the verdict is told. */
  const int silent = freopen("/dev/null", "w", stderr) != NULL;
  const int code = silent ? read_file(file) : tell(file, "cannot be read", strerror(errno));
  _exit(fflush(stdout) == 0 ? code : UNTOLD);
}

static int verify_file(const char *file)
{
  struct stat info;
  int end = 0;
  if (stat(file, &info) != 0) return tell(file, "cannot be read", strerror(errno));
  if (!S_ISREG(info.st_mode)) return tell(file, "cannot be read", "it is not a regular file");
  if (fflush(stdout) != 0) return DAMAGED; /* or both processes would write what is left */
  const pid_t reader = fork();
  if (reader == 0) read_apart(file, info.st_size);
  if (reader < 0) return tell(file, "cannot be read", strerror(errno));
  while (waitpid(reader, &end, 0) < 0)
    if (errno != EINTR) return tell(file, "cannot be read", strerror(errno));
  if (WIFEXITED(end) && WEXITSTATUS(end) == UNTOLD)
    fputs("resonance: error: standard output cannot be written\n", stderr);
  if (WIFEXITED(end)) return WEXITSTATUS(end) == WHOLE ? WHOLE : DAMAGED;
  return tell(file, "damaged", WTERMSIG(end) == SIGXCPU || WTERMSIG(end) == SIGKILL
                               ? "reading it does not end" : "HDF5 crashes when it reads it");
}

int verify_files(char *const *files, size_t count)
{
  int code = WHOLE;
  for (size_t i = 0; i < count; i++)
    if (verify_file(files[i]) != WHOLE) code = DAMAGED;
  return options_written(stdout) == 0 ? code : DAMAGED;
}
