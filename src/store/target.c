/*
 * target.c -- the file that a path means as an output, and whether it may be replaced.
 *
 * Owns: following links, and what is refused by name. A link stands for what it points to, be it
 * there or not; a device or a stream cannot be replaced by a file; a file without write permission
 * is not replaced, although the system checks only its folder in renaming. Opens nothing.
 */
#ifndef _XOPEN_SOURCE
#define _XOPEN_SOURCE 700 /* lstat, readlink, realpath */
#endif

#include <pendres/store.h>

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_LINKS = 40 /* as Linux follows */, LINK_ROOM = 4096 };

static pendres_status refuse(char *why, size_t size, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

static pendres_status refuse(char *why, size_t size, const char *format, ...)
{
  va_list args;

  va_start(args, format);
  if (why && size) vsnprintf(why, size, format, args);
  va_end(args);
  return PENDRES_IO;
}

/* The length of the folder's name within a path, its slash included. */
static size_t folder_length(const char *path)
{
  const char *slash = strrchr(path, '/');

  return slash ? (size_t)(slash - path) + 1 : 0;
}

/* What the link `path` points to, seen from where `path` is seen from; NULL: errno says why. */
static char *read_link(const char *path)
{
  char text[LINK_ROOM];
  const ssize_t length = readlink(path, text, sizeof text - 1);
  size_t head = folder_length(path);
  char *next = NULL;

  if (length < 0) return NULL;
  if ((size_t)length == sizeof text - 1) {
    errno = ENAMETOOLONG;
    return NULL;
  }
  text[length] = '\0';
  if (text[0] == '/') head = 0;
  next = malloc(head + (size_t)length + 1);
  if (!next) return NULL;
  memcpy(next, path, head);
  memcpy(next + head, text, (size_t)length + 1);
  return next;
}

/* The folder of a path, to be freed; NULL: out of memory. */
static char *folder_of(const char *path)
{
  const size_t length = folder_length(path);
  char *folder = malloc(length + 2);

  if (!folder) return NULL;
  memcpy(folder, length ? path : ".", length ? length : 1);
  folder[length ? length : 1] = '\0';
  return folder;
}

/* Whether the name belongs to the system. It may lead to a plain file, as /dev/stdout does, which
   is then a stream nevertheless. */
static int is_stream(const char *path)
{
  char *folder = folder_of(path), *real = folder ? realpath(folder, NULL) : NULL;
  const int stream = real && (!strcmp(real, "/dev") || !strncmp(real, "/proc/", 6));

  free(real);
  free(folder);
  return stream;
}

/* Whether a file is another user's in a sticky folder, as /tmp is: the system would refuse to
   rename over it. */
static int is_held(const struct stat *file, const char *target)
{
  char *name = folder_of(target);
  struct stat folder;
  const int sticky = name && !stat(name, &folder) && (folder.st_mode & S_ISVTX);
  const uid_t user = geteuid();

  free(name);
  return sticky && user && user != file->st_uid && user != folder.st_uid;
}

/* Check what is there already. */
static pendres_status check_old(const char *path, const char *target, char *why, size_t size)
{
  struct stat info;

  if (stat(target, &info)) return PENDRES_OK; /* what else is wrong is found on creating it */
  if (!S_ISREG(info.st_mode))
    return refuse(why, size, "'%s' exists and is not a regular file", path);
  /* Root may write read-only files, but this is hardly intended. */
  if (!(info.st_mode & (S_IWUSR | S_IWGRP | S_IWOTH)) || access(target, W_OK))
    return refuse(why, size, "'%s' exists and is read-only", path);
  if (is_held(&info, target))
    return refuse(why, size, "'%s' exists and belongs to another user, in a folder where only he "
                  "may replace it", path);
  return PENDRES_OK;
}

pendres_status pendres_store_target(const char *path, char **target, char *why, size_t size)
{
  struct stat info;
  char *name;
  pendres_status status;

  if (target) *target = NULL;
  if (why && size) why[0] = '\0';
  if (!path || !*path || !target) return PENDRES_INVALID_ARGUMENT;
  name = malloc(strlen(path) + 1);
  if (!name) return PENDRES_OUT_OF_MEMORY;
  strcpy(name, path);
  status = is_stream(name) ? refuse(why, size, "'%s' is a device, not a file", path) : PENDRES_OK;
  for (int links = 0; !status && !lstat(name, &info) && S_ISLNK(info.st_mode); links++) {
    char *next = NULL;

    if (info.st_uid != geteuid()) {
      status = refuse(why, size, "'%s' is a link of another user's: name the file itself", path);
      break;
    }
    if (links < MOST_LINKS) next = read_link(name);
    if (!next) {
      status = refuse(why, size, "cannot follow the link '%s': %s", path,
                      strerror(links < MOST_LINKS ? errno : ELOOP));
      break;
    }
    free(name);
    name = next;
    if (is_stream(name)) status = refuse(why, size, "'%s' is a device, not a file", path);
  }
  if (!status) status = check_old(path, name, why, size);
  if (!status) *target = name;
  else free(name);
  return status;
}
