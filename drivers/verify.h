/*
 * verify.h -- checking that files of results are complete.
 *
 * Owns: --verify, with one line per file on standard output.
 */
#ifndef VERIFY_H
#define VERIFY_H

#include <stddef.h>

/* 0 if all the files are complete and of this program, otherwise 1. Each is read in a process of
   its own, since a damaged one may crash HDF5: to be called before there are threads. */
int verify_files(char *const *files, size_t count);

#endif
