/*
 * csv.h -- results as text, beside the HDF5 file.
 *
 * Owns: the form of these files, and what of a file of results goes into them: whatever has one or
 * two dimensions, as tables of columns, and the rest of the numbers as comments. docs/files.md
 * tells users.
 */
#ifndef CSV_H
#define CSV_H

#include "deck/deck.h"
#include "terminal/progress.h"

/* 0, or 2 after an error: the main table would replace a file that is no such table. To be known
   before anything is computed. */
int csv_check(const deck *d, progress *p);

/* Write the tables of the finished output; `force` replaces whatever is there. 0, or 1 after an
   error. The HDF5 file is only read. */
int csv_write(const deck *d, int force, progress *p);

#endif
