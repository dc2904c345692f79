/*
 * together.h -- what the ranks of a run agree on: rank 0 reads, decides and tells; the others
 * follow.
 */
#ifndef TOGETHER_H
#define TOGETHER_H

#include "deck/deck.h"

/* What rank 0 has in code. All ranks call it. */
int together_agree(int code);

/* Are all of them ready to go on? All ranks call it. */
int together_ready(int ready);

/* The deck of rank 0, which the others get as resolved; 0 in all ranks if one of them fails. All
   call it. */
int together_deck(deck *d);

/* Is this another rank than 0? It writes nothing: neither results nor words. */
int together_helping(void);

/* Where such a rank has what it would write: in a folder for what does not last. */
void together_output(char *path, size_t size);

/* The file that a store writes for that path loses its name, so that a rank that is killed leaves
   nothing behind. */
void together_unname(const char *path);

/* Its standard streams lead nowhere. */
void together_silence(void);

#endif
