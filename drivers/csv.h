/*
 * csv.h -- results as text, beside the HDF5 file.
 *
 * Owns: the form of these files, and the choice of results that go into them: whatever has one or
 * two dimensions, as tables of columns, and the rest of the numbers as comments. Users find them
 * described in docs/files.md.
 */
#ifndef CSV_H
#define CSV_H

#include "deck/deck.h"
#include "terminal/progress.h"

/* 0, or 2 after an error: the main table would replace a file that is not such a table. To be
   called before anything is computed. */
int csv_check(const deck *d, progress *p);

/* Write the tables of the finished output; `force` replaces existing files. 0, or 1 after an
   error. The HDF5 file is only read. */
int csv_write(const deck *d, int force, progress *p);

#endif
