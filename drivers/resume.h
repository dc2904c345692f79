/*
 * resume.h -- a run that goes on where an earlier one was stopped.
 *
 * Owns: where the journal of a run stands (beside the output, or in a folder of the user's choice),
 * what its head holds (version and sources of the code, the resolved deck), and what the user is
 * told of it.
 */
#ifndef RESUME_H
#define RESUME_H

#include "deck/deck.h"
#include "farm/journal.h"
#include "options.h"
#include "terminal/progress.h"

/* The journal of a run of this deck, open; *out is NULL where there is to be none. 0, or an exit
   code after an error. */
int resume_open(const deck *d, const options *o, progress *p, journal **out);

/* The results stand, and the journal, which is let go of, is no longer needed: unless a budget has
   ended points, which may be computed yet. NULL is allowed. */
void resume_leave(journal *j, size_t lost, progress *p);

/* How to go on, in words, where something was kept: " ...", else "". */
const char *resume_advice(const journal *j, char *text, size_t size);

#endif
