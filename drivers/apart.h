/*
 * apart.h -- what may crash, or never end, is done in a process of its own.
 *
 * Owns: reading files that may be damaged. HDF5 follows what stands in them, and may fault, end the
 * program or run in circles.
 */
#ifndef APART_H
#define APART_H

#include <sys/types.h>

enum {
  APART_FAILED = -1, /* there could be no process; errno says why */
  APART_CRASHED = -2,
  APART_ENDLESS = -3
};

/*
 * Call read(arg), which is to read a file of this size in bytes, in a process of its own that says
 * nothing on standard error and leaves the files of this run alone; its result, from 0 to 255, or
 * one of the above. What it writes to standard output it has to flush, and so has the caller
 * before. In a run with several threads only one that no other shares a lock with may call this.
 */
int apart(int (*read)(const void *arg), const void *arg, off_t bytes);

#endif
