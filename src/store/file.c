/*
 * file.c -- the file below a store: a part file that becomes the real one at the end.
 *
 * Owns: making and locking PATH.part, writing at offsets, and the way from PATH.part to PATH:
 * fsync, rename, fsync of the folder, in this order, so that after a crash of the machine PATH is
 * either the old file or the whole new one. Knows nothing of HDF5. Units: bytes.
 */
#ifndef _DEFAULT_SOURCE
#define _DEFAULT_SOURCE /* flock */
#endif
#ifndef _FILE_OFFSET_BITS
#define _FILE_OFFSET_BITS 64
#endif

#include "store/file.h"

#include <pendres/store.h>

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* One pread or pwrite moves at most this much: Linux itself stops at 2 GiB. */
#define LARGEST_PIECE ((size_t)1 << 30)
/* How often a part file may vanish between two checks. */
#define OPEN_ATTEMPTS 100

static pendres_status file_fail(pendres_store_file *file, const char *format, ...)
  __attribute__((format(printf, 2, 3)));

static pendres_status file_fail(pendres_store_file *file, const char *format, ...)
{
  va_list args;

  va_start(args, format);
  vsnprintf(file->why, sizeof file->why, format, args);
  va_end(args);
  return PENDRES_IO;
}

/* "cannot ACTION NAME: reason" */
static pendres_status file_failed(pendres_store_file *file, const char *action, const char *name,
                                  int error)
{
  return file_fail(file, "cannot %s '%s': %s", action, name, strerror(error));
}

static char *joined(const char *head, size_t length, const char *tail)
{
  char *text = malloc(length + strlen(tail) + 1);

  if (text) {
    memcpy(text, head, length);
    strcpy(text + length, tail);
  }
  return text;
}

/* Whether locks show that a file is being written. HDF5's own environment variable may switch them
   off; then a file without a lock may still be another run's. */
static int locks_count(void)
{
  const char *use = getenv("HDF5_USE_FILE_LOCKING");

  return !use || (strcmp(use, "FALSE") && strcmp(use, "0"));
}

/* 1 if the descriptor is still the file of that name: its writer may have renamed it meanwhile. */
static int is_same_file(int fd, const char *name)
{
  struct stat opened, named;

  return !fstat(fd, &opened) && !lstat(name, &named) && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

static pendres_status busy(pendres_store_file *file)
{
  return file_fail(file, "'%s' is being written by another process", file->part);
}

static pendres_status close_again(pendres_store_file *file, pendres_status status)
{
  close(file->fd);
  file->fd = -1;
  return status;
}

/* Where the mark of a part stands in the open file; -1: nowhere, or behind the seal, in a title.
   HDF5 writes it with the first texts, not compressed and without a checksum of theirs. */
static off_t find_mark(int fd)
{
  char begin[8192];
  const size_t size = sizeof PENDRES_STORE_MARK - 1;
  const ssize_t n = pread(fd, begin, sizeof begin, 0);

  for (ssize_t at = 0; at + (ssize_t)size <= n; at++) {
    if (!memcmp(begin + at, PENDRES_STORE_MARK, size)) return at;
    if (!memcmp(begin + at, PENDRES_STORE_SEAL, size)) break;
  }
  return -1;
}

/* Why what stands in the place of the part cannot have been left there by a run of this user; NULL:
   it can. */
static const char *foreign(const struct stat *info)
{
  if (S_ISLNK(info->st_mode)) return "is a symbolic link";
  if (!S_ISREG(info->st_mode)) return "is not a regular file";
  if (info->st_uid != geteuid()) return "belongs to another user";
  return info->st_nlink > 1 ? "has another name, too (a hard link)" : NULL;
}

/*
 * Take over a part file that is there already: one that a killed run has left is no longer locked.
 * *again: it has gone meanwhile, and the name is free.
 */
static pendres_status take_over(pendres_store_file *file, int alone, int *again)
{
  struct stat info;
  const char *why;

  *again = 0;
  if (!lstat(file->part, &info) && (why = foreign(&info)) != NULL)
    return file_fail(file, "'%s' exists, and %s", file->part, why);
  if (!alone && !locks_count())
    return file_fail(file, "'%s' exists: another process is writing it, or one was killed; without "
                     "file locks (HDF5_USE_FILE_LOCKING) nobody can tell. Remove it if no run is "
                     "writing it", file->part);
  file->fd = open(file->part, O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file->fd < 0) {
    *again = errno == ENOENT;
    return file_failed(file, "write", file->part, errno);
  }
  if (flock(file->fd, LOCK_EX | LOCK_NB)) {
    if (errno == EWOULDBLOCK) return close_again(file, busy(file));
    if (!alone)
      return close_again(file, file_fail(file, "'%s' exists, and cannot be locked to see whether "
                                         "it is being written: %s. Remove it if no run is writing "
                                         "it", file->part, strerror(errno)));
  }
  if (fstat(file->fd, &info) || !is_same_file(file->fd, file->part)) {
    *again = 1;
    return close_again(file, PENDRES_IO);
  }
  if ((why = foreign(&info)) != NULL) /* it may have come between the two looks */
    return close_again(file, file_fail(file, "'%s' exists, and %s", file->part, why));
  if (info.st_size && find_mark(file->fd) < 0)
    return close_again(file, file_fail(file, "'%s' exists, and was not left by a run that was "
                                       "killed: move it elsewhere", file->part));
  if (ftruncate(file->fd, 0))
    return close_again(file, file_failed(file, "empty", file->part, errno));
  return PENDRES_OK;
}

/*
 * Make the part file of this run. It is created, never just opened, so that the later of two runs
 * is refused at once, with or without locks. Where there are locks one is held, which tells others
 * that the file is in use.
 */
static pendres_status open_own(pendres_store_file *file, int alone)
{
  for (int attempt = 0; attempt < OPEN_ATTEMPTS; attempt++) {
    int again = 0;
    pendres_status status;

    file->fd = open(file->part, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file->fd >= 0) {
      /* Another run may have taken it for a remainder before it was locked: it then belongs to that
         run. */
      if (flock(file->fd, LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK)
        return close_again(file, busy(file));
      return PENDRES_OK;
    }
    if (errno != EEXIST) return file_failed(file, "write", file->part, errno);
    status = take_over(file, alone, &again);
    if (!again) return status;
  }
  return file_fail(file, "'%s' is replaced all the time by other processes", file->part);
}

pendres_status pendres_store_file_create(pendres_store_file *file, const char *path, int alone)
{
  struct stat before;
  pendres_status status;

  memset(file, 0, sizeof *file);
  file->fd = -1;
  /* Refuse now what the rename would refuse hours later. */
  status = pendres_store_target(path, &file->path, file->why, sizeof file->why);
  if (status) return status;
  file->part = joined(file->path, strlen(file->path), ".part");
  if (!file->part) return PENDRES_OUT_OF_MEMORY;
  status = open_own(file, alone);
  /* Keep the permissions of the file that is replaced; file systems without permissions have
     none. */
  if (!status && !stat(file->path, &before)) (void)fchmod(file->fd, before.st_mode & 0777);
  return status;
}

pendres_status pendres_store_file_look(const char *path, char *why)
{
  const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat info;
  pendres_status status = PENDRES_BUSY;
  int error = 0;

  if (fd < 0) return PENDRES_OK;
  if (locks_count() && flock(fd, LOCK_SH | LOCK_NB)) error = errno;
  if (fstat(fd, &info) || !S_ISREG(info.st_mode)) {
    status = PENDRES_IO;
    snprintf(why, PENDRES_STORE_WHY, "cannot read '%s': it is not a regular file", path);
  } else if (error == EWOULDBLOCK)
    snprintf(why, PENDRES_STORE_WHY, "'%s' is open for writing in another process", path);
  else if (error)
    snprintf(why, PENDRES_STORE_WHY, "'%s' cannot be locked: %s. HDF5_USE_FILE_LOCKING=FALSE in "
             "the environment reads it without a lock", path, strerror(error));
  else
    status = PENDRES_OK;
  close(fd);
  return status;
}

void pendres_store_file_destroy(pendres_store_file *file)
{
  while (file->refused) {
    pendres_store_refused *next = file->refused->next;

    free(file->refused);
    file->refused = next;
  }
  if (file->fd >= 0) close(file->fd);
  file->fd = -1;
  free(file->path);
  free(file->part);
  file->path = file->part = NULL;
}

void pendres_store_file_unlink(const pendres_store_file *file)
{
  /* Remove it only if it is our own: with locking off, another process may have taken the name. */
  if (file->fd >= 0 && is_same_file(file->fd, file->part)) unlink(file->part);
}

void pendres_store_file_abandon(pendres_store_file *file, int keep)
{
  if (file->fd < 0) return;
  if (!keep) pendres_store_file_unlink(file);
  close(file->fd);
  file->fd = -1;
}

/* Write the folder's entry to the disk. File systems that cannot do this return EINVAL. */
static int sync_folder(const char *path)
{
  const char *slash = strrchr(path, '/');
  char *folder = slash ? joined(path, (size_t)(slash - path) + 1, "") : joined(".", 1, "");
  int fd = -1, error = 0;

  if (!folder) return ENOMEM;
  fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd >= 0) {
    if (fsync(fd) && errno != EINVAL && errno != ENOTSUP) error = errno;
    close(fd);
  }
  /* A folder that can be written but not read cannot be opened: nothing more can be done. */
  free(folder);
  return error;
}

/* The seal in the place of the mark. Nonzero: see errno. */
static int seal(const pendres_store_file *file)
{
  const size_t size = sizeof PENDRES_STORE_SEAL - 1;
  const off_t at = find_mark(file->fd);

  if (at < 0) errno = EIO;
  return at < 0 || pwrite(file->fd, PENDRES_STORE_SEAL, size, at) != (ssize_t)size;
}

pendres_status pendres_store_file_finish(pendres_store_file *file, int *whole)
{
  int error;

  *whole = 0;
  if (!is_same_file(file->fd, file->part))
    return file_fail(file, "'%s' was taken away or replaced during the run", file->part);
  if (file->error) return file_failed(file, "write", file->part, file->error);
  if (seal(file) || (fsync(file->fd) && errno != EINVAL))
    return file_failed(file, "write", file->part, file->error = errno);
  *whole = 1;
  /* The file is renamed while it is still locked: no other process can take the name in between. */
  if (rename(file->part, file->path))
    return file_fail(file, "cannot rename '%s' to '%s': %s; the results are whole in the former",
                     file->part, file->path, strerror(errno));
  close(file->fd); /* its status says nothing new after fsync */
  file->fd = -1;
  error = sync_folder(file->path);
  if (error) return file_failed(file, "save the folder of", file->path, error);
  return PENDRES_OK;
}

static int refuse(pendres_store_file *file, uint64_t offset, size_t size, const void *bytes)
{
  pendres_store_refused *block = malloc(sizeof *block + size);

  if (!block) return -1;
  block->next = file->refused;
  block->offset = offset;
  block->size = size;
  memcpy(block->bytes, bytes, size);
  file->refused = block;
  return 0;
}

int pendres_store_file_write(pendres_store_file *file, uint64_t offset, size_t size,
                             const void *bytes)
{
  size_t done = 0;

  while (!file->error && done < size) {
    const size_t piece = size - done < LARGEST_PIECE ? size - done : LARGEST_PIECE;
    const ssize_t n = pwrite(file->fd, (const char *)bytes + done, piece, (off_t)(offset + done));

    if (n > 0)
      done += (size_t)n;
    else if (n == 0 || errno != EINTR)
      file->error = n == 0 ? ENOSPC : errno;
  }
  return done < size ? refuse(file, offset + done, size - done, (const char *)bytes + done) : 0;
}

/* Lay the refused bytes over what was read: the oldest first, so that the newest wins. */
static void overlay(const pendres_store_refused *block, uint64_t offset, size_t size,
                    unsigned char *bytes)
{
  uint64_t from, to;

  if (!block) return;
  overlay(block->next, offset, size, bytes);
  from = block->offset > offset ? block->offset : offset;
  to = block->offset + block->size < offset + size ? block->offset + block->size : offset + size;
  if (from < to)
    memcpy(bytes + (from - offset), block->bytes + (from - block->offset), (size_t)(to - from));
}

int pendres_store_file_read(pendres_store_file *file, uint64_t offset, size_t size, void *bytes)
{
  size_t done = 0;

  while (done < size) {
    const size_t piece = size - done < LARGEST_PIECE ? size - done : LARGEST_PIECE;
    const ssize_t n = pread(file->fd, (char *)bytes + done, piece, (off_t)(offset + done));

    if (n == 0) break;
    if (n > 0)
      done += (size_t)n;
    else if (errno != EINTR) {
      if (!file->error) file->error = errno;
      return -1;
    }
  }
  if (done < size) memset((char *)bytes + done, 0, size - done);
  overlay(file->refused, offset, size, bytes);
  return 0;
}

int pendres_store_file_resize(pendres_store_file *file, uint64_t size)
{
  while (!file->error && ftruncate(file->fd, (off_t)size))
    if (errno != EINTR) file->error = errno;
  return 0;
}
