/*
 * verify.h -- are files of results whole?
 *
 * Owns: --verify: one line a file on standard output.
 */
#ifndef VERIFY_H
#define VERIFY_H

#include <stddef.h>

/* 0 if all the files are whole and of this program, or 1. Each is read in a process of its own,
   since a damaged one may crash HDF5: to be called before there are threads. */
int verify_files(char *const *files, size_t count);

#endif
