/*
 * text.h -- texts that are written in memory, through a stream.
 *
 * Owns: the text, which grows, and whether all that was written is there. The C library's streams
 * of this kind tell nobody when memory ends: what they hold then has a hole, or is not there at
 * all, and closing them succeeds. No state; a text belongs to one thread at a time.
 */
#ifndef TEXT_H
#define TEXT_H

#include <stdio.h>

/* All zero at first. It may not be moved while its stream is open. */
typedef struct text {
  FILE *stream; /* to write to */
  char *data;   /* what was written, with a zero behind it, as far as text_whole() has been asked */
  size_t size, room;
  int short_of; /* memory */
} text;

/* Open the stream; 0: no memory. */
int text_open(text *t);

/* Whether all is there that was written so far; 0: memory has ended before. */
int text_whole(text *t);

/* Close it. What was written, to be freed; NULL: some of it is not there, for want of memory. */
char *text_close(text *t);

/* Close it and free what was written. */
void text_drop(text *t);

#endif
