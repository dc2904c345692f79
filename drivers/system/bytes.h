/*
 * bytes.h -- reading and writing bytes at an offset of a file, always completely: what the system
 * does in parts, or a signal interrupts, is continued. No state; any thread may call.
 */
#ifndef BYTES_H
#define BYTES_H

#include <sys/types.h>

/* 0 on failure, see errno: EIO where the file ends before, ENOSPC where nothing is taken. */
int bytes_read(int file, off_t at, void *to, size_t size);
int bytes_write(int file, off_t at, const void *from, size_t size);

#endif
