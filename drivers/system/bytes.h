/*
 * bytes.h -- bytes at a place of a file, all of them: what the system reads or writes in parts, and
 * what a signal interrupts, goes on. No state; any thread may.
 */
#ifndef BYTES_H
#define BYTES_H

#include <sys/types.h>

/* 0 on failure, see errno: EIO where the file ends before, ENOSPC where nothing is taken. */
int bytes_read(int file, off_t at, void *to, size_t size);
int bytes_write(int file, off_t at, const void *from, size_t size);

#endif
