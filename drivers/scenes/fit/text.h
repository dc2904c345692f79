/* text.h -- tables in text: lines of cells, with names and units of the columns. */
#ifndef SCENE_FIT_TEXT_H
#define SCENE_FIT_TEXT_H

#include "scenes/scene.h"

enum { FIT_COLUMNS = 64, FIT_CELL = 128 };

typedef struct fit_text {
  scene_run *run;
  const char *path;
  const char *format;  /* as the deck tells it; "any": by content */
  int comma;           /* decimals stand behind one */
  const size_t *lines; /* numbers of the lines in the file; NULL: they are the text's own */
  /* What is called once before the data, and at each line of them. */
  void (*head)(void *to);
  void (*row)(void *to, size_t n, char *const *cell);
  void *to;
  /* While it is read: */
  char separator;    /* ' ': blanks */
  size_t line;       /* that is read */
  size_t columns;    /* of the first data */
  int whispered;     /* names are those of a comment */
  int gaps;          /* what is no number may be left out with its line */
  char name[FIT_COLUMNS][FIT_CELL];  /* "": there is none */
  char plain[FIT_COLUMNS][FIT_CELL]; /* the same without a unit in brackets */
  char unit[FIT_COLUMNS][FIT_CELL]; /* in a line of their own, or in brackets behind names */
} fit_text;

/* Read a text, which is overwritten; what is wrong is the run's failure. */
void fit_text_read(fit_text *t, char *text, size_t length);

/* The number in a cell, with an exponent by e or d; 0: there is none. */
int fit_text_number(const fit_text *t, const char *cell, double *out);

#endif
