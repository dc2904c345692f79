/*
 * file.h -- the file below a store: a part file that becomes the real one at the end.
 *
 * Owns: the descriptor, its lock, the first failure, and the bytes that could not be written.
 */
#ifndef PENDRES_STORE_FILE_H
#define PENDRES_STORE_FILE_H

#include <stddef.h>
#include <stdint.h>

#include <pendres/status.h>

enum { PENDRES_STORE_WHY = 512 };

/* A text of the file while it is a part, and what it becomes when all is whole: so a part can be
 * told from any other file, and can be opened nevertheless. */
#define PENDRES_STORE_MARK "(part)"
#define PENDRES_STORE_SEAL "CF-1.8"
_Static_assert(sizeof PENDRES_STORE_MARK == sizeof PENDRES_STORE_SEAL, "nothing is moved");

/* Bytes that the disk refused, newest first. */
typedef struct pendres_store_refused {
  struct pendres_store_refused *next;
  uint64_t offset;
  size_t size;
  unsigned char bytes[];
} pendres_store_refused;

typedef struct pendres_store_file {
  char *path; /* what the user asked for, links followed */
  char *part; /* what is written: path with ".part" appended */
  int fd;     /* -1 when closed */
  int error;  /* errno of the first failure, 0 if none; sticky */
  pendres_store_refused *refused;
  char why[PENDRES_STORE_WHY]; /* the message of the last failure */
} pendres_store_file;

/* Make and lock the part file, or take over one that a killed run of this user has left, which may
 * be in use where locks are switched off, unless the caller says that it is `alone`; whatever else
 * is there is refused. It has the permissions
 * of the file that it is to replace. file is zeroed first; destroy it in any case. */
pendres_status pendres_store_file_create(pendres_store_file *file, const char *path, int alone);

/* Look at a file before HDF5 opens it. PENDRES_IO: it is not a regular one, as a pipe on which HDF5
   would wait; PENDRES_BUSY: it cannot be locked for reading, as HDF5 locks it. The reason is in
   why[PENDRES_STORE_WHY]. One that cannot be opened is left to HDF5. */
pendres_status pendres_store_file_look(const char *path, char *why);

/* Close what is open and free; the part file stays where it is. */
void pendres_store_file_destroy(pendres_store_file *file);

/* Remove the part file if it is open and this run's. A signal handler may call this. */
void pendres_store_file_unlink(const pendres_store_file *file);

/* Close the part file if it is open, and remove it unless `keep`. */
void pendres_store_file_abandon(pendres_store_file *file, int keep);

/* Seal it, write everything to the disk, close, rename the part file to path, and write the folder
 * to the disk. *whole is set once the part is complete on disk, even where the rename then
 * fails. */
pendres_status pendres_store_file_finish(pendres_store_file *file, int *whole);

/*
 * Read and write at an offset. Data that the disk refuses are kept in memory, and the write counts
 * as done, with `error` set: HDF5 could not close a file whose last writes failed. Reading beyond
 * the end gives zeros. All three return 0, or -1 when even that is impossible.
 */
int pendres_store_file_write(pendres_store_file *file, uint64_t offset, size_t size,
                             const void *bytes);
int pendres_store_file_read(pendres_store_file *file, uint64_t offset, size_t size, void *bytes);
int pendres_store_file_resize(pendres_store_file *file, uint64_t size);

#endif
