/*
 * apart.h -- work that may crash, or never end, in a process of its own.
 *
 * Owns: reading files that may be damaged. HDF5 trusts their contents, and may fault, end the
 * program, or loop without end.
 */
#ifndef APART_H
#define APART_H

#include <sys/types.h>

enum {
  APART_FAILED = -1, /* the process could not be started; errno says why */
  APART_CRASHED = -2,
  APART_ENDLESS = -3
};

/*
 * Call read(arg), which is to read a file of this size in bytes, in a process of its own that
 * writes nothing to standard error and does not touch the files of this run but for `keep`, where
 * it may write (-1: none); its result, from 0 to 255, or one of the above. What it writes to
 * standard output it must flush, and the caller must flush before. In a run with several threads,
 * only one that shares no lock with others may call this.
 */
int apart(int (*read)(const void *arg), const void *arg, off_t bytes, int keep);

#endif
