/* files.c -- the files of a run; see files.h. */
#define _XOPEN_SOURCE 700 /* realpath, access */
#include "files.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <pendres/store.h>

enum { ROOM = DECK_PATH + 16 };

/* The folder of a path, and the name within it. */
static const char *split(const char *path, char folder[ROOM])
{
  const char *slash = strrchr(path, '/');
  const size_t length = slash == NULL ? 0 : (size_t)(slash - path) + 1;
  snprintf(folder, ROOM, "%.*s", length == 0 ? 1 : (int)length, length == 0 ? "." : path);
  return path + length;
}

static int same_inode(const struct stat *a, const struct stat *b)
{
  return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

int files_same(const char *one, const char *other)
{
  struct stat a, b;
  char folder[2][ROOM];
  const int there = stat(one, &a) == 0, there_too = stat(other, &b) == 0;
  if (there != there_too) return 0;
  if (there) return same_inode(&a, &b);
  /* To be made: the same name in the same folder. */
  if (strcmp(split(one, folder[0]), split(other, folder[1])) != 0) return 0;
  return stat(folder[0], &a) == 0 && stat(folder[1], &b) == 0 && same_inode(&a, &b);
}

/* The file that is written first; "" where the output is refused, which is said later. */
static void part_of(const deck *d, char part[ROOM])
{
  char *target = NULL;
  part[0] = '\0';
  if (pendres_store_target(d->output, &target, NULL, 0) != PENDRES_OK) return;
  if (strlen(target) + sizeof ".part" <= ROOM) snprintf(part, ROOM, "%s.part", target);
  free(target);
}

int files_check(const deck *d, const char *log, progress *p)
{
  char part[ROOM];
  part_of(d, part);
  if (files_same(d->output, d->name)) {
    progress_error(p, "the output %s would overwrite the deck", d->output);
  } else if (part[0] != '\0' && files_same(part, d->name)) {
    progress_error(p, "the output is written to %s first, which would overwrite the deck", part);
  } else if (log != NULL && files_same(log, d->name)) {
    progress_error(p, "the log %s would be written into the deck", log);
  } else if (log != NULL && (files_same(log, d->output) || files_same(log, part))) {
    progress_error(p, "the log %s and the output are one file", log);
  } else {
    return 0;
  }
  return 2;
}

int files_writable(const deck *d, progress *p)
{
  char folder[ROOM], why[ROOM + 64];
  char *target = NULL;
  const pendres_status status = pendres_store_target(d->output, &target, why, sizeof why);
  if (status != PENDRES_OK) {
    progress_error(p, "%s", why[0] != '\0' ? why : pendres_status_message(status));
    return 1;
  }
  (void)split(target, folder);
  free(target);
  if (access(folder, W_OK | X_OK) == 0) return 0;
  progress_error(p, "nothing can be written to the folder '%s': %s", folder, strerror(errno));
  return 1;
}
