/*
 * files.h -- the files of a run: none of them may be another one.
 *
 * Owns: comparing the deck, the output, its part file and the log as files, not as names: links and
 * other ways to write a path lead to the same file.
 */
#ifndef FILES_H
#define FILES_H

#include "deck/deck.h"
#include "terminal/progress.h"

/* Whether the two names are one file, existing or to be made. */
int files_same(const char *one, const char *other);

/* 0, or 2 after an error that says which would be overwritten. log may be NULL. */
int files_check(const deck *d, const char *log, progress *p);

/* 0, or 1 after an error that says why nothing can be written where the output goes; makes no file
   there. */
int files_writable(const deck *d, progress *p);

/* A file that is about to be replaced, and the name under which it is kept; all zero: none. */
typedef struct files_kept {
  char *target, *name;
} files_kept;

/*
 * If the output exists and holds anything other than results of the same deck (as resolved, so that
 * the same results would be computed again), rename it to OUTPUT.~1~ or the next name that is free.
 * To be called just before the output is replaced; afterwards files_keep_end is called with
 * `replaced` nonzero if it was. 0, or 1 after an error: then it must not be replaced.
 */
int files_keep(const deck *d, files_kept *kept, progress *p);
void files_keep_end(files_kept *kept, int replaced, progress *p);

#endif
