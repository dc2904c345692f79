/*
 * together.h -- agreement among the ranks of a run: rank 0 reads, decides and informs the others.
 */
#ifndef TOGETHER_H
#define TOGETHER_H

#include "deck/deck.h"

/* What rank 0 has in code. All ranks call it. */
int together_agree(int code);

/* Whether all of them are ready to continue. All ranks call it. */
int together_ready(int ready);

/* The deck of rank 0, which the others get as resolved; 0 in all ranks if one of them fails. All
   call it. */
int together_deck(deck *d);

/* Whether this rank is not rank 0: such a rank writes neither results nor messages. */
int together_helping(void);

/* The path to which such a rank writes its output: in a folder for temporary files. */
void together_output(char *path, size_t size);

/* Unlink the file that a store writes for that path, so that a rank that is killed leaves nothing
   behind. */
void together_unname(const char *path);

/* Redirect its standard streams to the null device. */
void together_silence(void);

#endif
