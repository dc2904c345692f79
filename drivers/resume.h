/*
 * resume.h -- continuing a run that was stopped.
 *
 * Owns: the location of a run's journal (beside the output, or in a folder of the user's choice),
 * the contents of its head (version and sources of the code, the resolved deck), and the messages
 * about it.
 */
#ifndef RESUME_H
#define RESUME_H

#include "deck/deck.h"
#include "farm/journal.h"
#include "options.h"
#include "terminal/progress.h"

/* Open the journal of a run of this deck; *out is NULL if it has none. 0, or an exit code after an
   error. */
int resume_open(const deck *d, const options *o, progress *p, journal **out);

/* The results are complete. The journal is closed, and removed unless a budget has ended points,
   which may still be computed. NULL is allowed. */
void resume_leave(journal *j, size_t lost, progress *p);

/* A message on how to continue, " ...", if something was kept; otherwise "". */
const char *resume_advice(const journal *j, char *text, size_t size);

#endif
