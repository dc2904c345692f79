/* files.c -- the files of a run; see run.h. */
#define _XOPEN_SOURCE 700 /* realpath, access */
#include "run.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <pendres/store.h>

#include "system/apart.h"
#include "system/file.h"

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
static void part_of(const char *output, char part[ROOM])
{
  char *target = NULL;
  part[0] = '\0';
  if (pendres_store_target(output, &target, NULL, 0) != PENDRES_OK) return;
  if (strlen(target) + sizeof ".part" <= ROOM) snprintf(part, ROOM, "%s.part", target);
  free(target);
}

int files_check(const deck *d, const char *log, progress *p)
{
  char part[ROOM];
  part_of(d->output, part);
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
    progress_error(p, "%s", progress_words(why, status));
    return 1;
  }
  (void)split(target, folder);
  free(target);
  if (access(folder, W_OK | X_OK) == 0) return 0;
  progress_error(p, "nothing can be written to the folder '%s': %s", folder, strerror(errno));
  return 1;
}

/* ---- what is replaced ---------------------------------------------------------------------- */

/* A file, and a deck as resolved. */
typedef struct held {
  const char *path, *resolved;
} held;

/* 1: the file holds the results of the deck. */
static int holds(const void *arg)
{
  const held *h = arg;
  pendres_store *store = NULL;
  char *text = NULL;
  pendres_status status = pendres_store_open(h->path, &store);
  if (status == PENDRES_OK)
    status = pendres_store_read_text(store, "provenance", "deck_resolved", 0, &text);
  const int same = status == PENDRES_OK && strcmp(text, h->resolved) == 0;
  free(text);
  pendres_store_free(store);
  return same;
}

/* Does the file hold the results of this deck? Then nothing is lost with it. One that crashes its
   reader may hold anything. */
static int same_deck(const char *path, off_t bytes, const deck *d)
{
  char *resolved = NULL;
  if (deck_resolved(d, &resolved) != PENDRES_OK) return 0;
  const held h = { path, resolved };
  const int same = apart(holds, &h, bytes, -1) == 1;
  free(resolved);
  return same;
}

void files_drop_whole(const deck *d, const char *output)
{
  char part[ROOM], why[FILE_WORDS];
  struct stat info;
  part_of(output, part);
  const int fd = part[0] != '\0' ? file_open(part, FILE_TRUSTED, 0, why) : -1;
  if (fd < 0) return; /* there is none, or the store tells */
  if (fstat(fd, &info) == 0 && same_deck(part, info.st_size, d)) (void)file_remove(fd, part);
  (void)close(fd);
}

int files_keep(const deck *d, files_kept *kept, progress *p)
{
  struct stat info;
  int why = 0;
  *kept = (files_kept){ 0 };
  if (pendres_store_target(d->output, &kept->target, NULL, 0) != PENDRES_OK)
    return 0; /* the store tells */
  if (stat(kept->target, &info) != 0 || info.st_size == 0 ||
      same_deck(kept->target, info.st_size, d)) {
    files_keep_end(kept, 1, p);
    return 0;
  }
  kept->name = file_keep(kept->target, &why);
  if (kept->name != NULL) return 0;
  files_keep_end(kept, 1, p);
  progress_error(p, "%s cannot be kept under another name: %s; --force replaces it", d->output,
                 strerror(why));
  return 1;
}

void files_keep_end(files_kept *kept, int replaced, progress *p)
{
  if (kept->name != NULL && replaced) {
    progress_note(p, "what was there before is kept as %s", kept->name);
  } else if (kept->name != NULL) {
    if (access(kept->target, F_OK) == 0) (void)unlink(kept->name);
    else (void)rename(kept->name, kept->target);
  }
  free(kept->name);
  free(kept->target);
  *kept = (files_kept){ 0 };
}
