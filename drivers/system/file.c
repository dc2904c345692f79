/* file.c -- what a name leads to; see file.h. */
#define _XOPEN_SOURCE 700 /* fchmod, link, lstat, O_NOFOLLOW */
#include "system/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_KEPT = 1000, ATTEMPTS = 100 /* of a name that others make and remove all the time */ };

/* ---- opening ------------------------------------------------------------------------------- */

/* Whether a file is of those that are opened for this; if not, `why` says so. */
static int may_open(const struct stat *s, const char *path, file_use use, int named, char *why)
{
  const uintmax_t names = s->st_nlink, owner = s->st_uid;
  if (!S_ISREG(s->st_mode)) {
    snprintf(why, FILE_WORDS, "'%.300s' is not a regular file but %s", path,
             S_ISLNK(s->st_mode) ? "a symbolic link, which is not followed here"
             : S_ISFIFO(s->st_mode) ? "a pipe" : S_ISDIR(s->st_mode) ? "a folder" : "a device");
    return 0;
  }
  if (use == FILE_READ) return 1;
  if (names > 1) {
    snprintf(why, FILE_WORDS, "'%.300s' has %ju names (hard links), and whose the others are is "
             "not known", path, names);
    return 0;
  }
  if (s->st_uid == geteuid()) return 1;
  snprintf(why, FILE_WORDS, "'%.300s' belongs to another user (number %ju)%s", path, owner,
           named ? ", and is used since its folder was named" : "");
  return named;
}

/* Making a file and opening one that is there are two calls: a system may refuse to open another
   user's with leave to make it, and would not say whose it is. What cannot be opened is looked at,
   too, so that a link is told as a link. */
int file_open(const char *path, file_use use, int named, char why[FILE_WORDS])
{
  const int flags = O_CLOEXEC | O_NONBLOCK | O_NOCTTY | (use == FILE_READ ? 0 : O_NOFOLLOW);
  const int makes = use == FILE_OWN || use == FILE_NEW;
  int fd = -1, error = ENOENT, may = 1;
  why[0] = '\0';
  for (int i = 0; i < ATTEMPTS && error == ENOENT && (i == 0 || makes); i++) {
    struct stat s;
    if (makes && (fd = open(path, O_RDWR | O_CREAT | O_EXCL | flags, 0666)) >= 0) return fd;
    error = errno;
    if (makes && (error != EEXIST || use == FILE_NEW)) break;
    fd = open(path, (use == FILE_OWN ? O_RDWR : O_RDONLY) | flags);
    error = errno;
    const int seen = fd >= 0 ? fstat(fd, &s) : use == FILE_READ ? stat(path, &s) : lstat(path, &s);
    may = seen != 0 || may_open(&s, path, use, named, why);
    if (may && fd >= 0) return fd;
    if (!may) error = EPERM;
  }
  if (fd >= 0) (void)close(fd);
  if (may) /* a note on a file that may be opened is none on why it was not */
    snprintf(why, FILE_WORDS, "'%.300s' cannot be %s: %s", path, makes ? "written" : "read",
             strerror(error));
  errno = error;
  return -1;
}

/* ---- files that are open, and their names --------------------------------------------------- */

int file_is(int fd, const char *path)
{
  struct stat opened, named;
  return fstat(fd, &opened) == 0 && lstat(path, &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

int file_remove(int fd, const char *path)
{
  return file_is(fd, path) && unlink(path) != 0 ? errno : 0;
}

void file_like(int fd, const char *path)
{
  struct stat s;
  if (stat(path, &s) == 0) (void)fchmod(fd, s.st_mode & 0777); /* else the umask's, stricter */
}

/* Not over another file. 0 or an errno. */
static int name_again(const char *path, const char *name)
{
  struct stat there;
  if (link(path, name) == 0) return 0;
  if (errno == EEXIST || lstat(name, &there) == 0) return EEXIST;
  return rename(path, name) == 0 ? 0 : errno;
}

char *file_keep(const char *path, int *why)
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
