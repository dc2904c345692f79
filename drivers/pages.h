/*
 * pages.h -- what the pages of docs/ say of a word: their headings and rows of tables, which are in
 * the program.
 */
#ifndef PAGES_H
#define PAGES_H

#include <stdio.h>

/*
 * Tell about a result (a variable of files), an oscillator, a deck, or any other subject that a
 * table names or a heading has; exact: of rows with this very name alone. Returns how much was
 * found.
 */
int pages_tell(const char *word, int exact, FILE *out);

#endif
