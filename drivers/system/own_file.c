/* own_file.c -- files that a run makes; see own_file.h. */
#define _XOPEN_SOURCE 700 /* fchmod, link, lstat, O_NOFOLLOW */
#include "system/own_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_KEPT = 1000 };

int own_file_create(const char *path, const char *like)
{
  struct stat before;
  const int known = stat(like, &before) == 0;
  const mode_t mode = known ? before.st_mode & 0777 : 0666;
  const int fd = open(path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
  if (fd >= 0 && known) (void)fchmod(fd, mode); /* whatever the umask is; else it is stricter */
  return fd;
}

int own_file_is(int fd, const char *path)
{
  struct stat opened, named;
  return fstat(fd, &opened) == 0 && lstat(path, &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

void own_file_remove(int fd, const char *path)
{
  if (own_file_is(fd, path)) (void)unlink(path);
}

/* Not over another file. 0 or an errno. */
static int name_again(const char *path, const char *name)
{
  struct stat there;
  if (link(path, name) == 0) return 0;
  if (errno == EEXIST || lstat(name, &there) == 0) return EEXIST;
  return rename(path, name) == 0 ? 0 : errno;
}

char *own_file_keep(const char *path, int *why)
{
  const size_t size = strlen(path) + sizeof ".~1000~";
  char *name = malloc(size);
  *why = ENOMEM;
  for (int n = 1; n < MOST_KEPT && name != NULL; n++) {
    snprintf(name, size, "%s.~%d~", path, n);
    *why = name_again(path, name);
    if (*why != EEXIST) break;
  }
  if (*why == 0) return name;
  free(name);
  return NULL;
}
