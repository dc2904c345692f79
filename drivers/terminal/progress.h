/*
 * progress.h -- what a user sees of a run while it is computed: stderr and the log.
 *
 * Owns: a bar where stderr is a terminal, otherwise a line for each 10 % of work that takes longer
 * than a second, and at least every five minutes; notes and errors; the log file with the time in
 * front of each line. With --quiet only errors are shown; the log gets everything.
 *
 * Thread safety: one thread at a time; the farm takes care of that.
 */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stddef.h>
#include <stdio.h>

typedef struct progress {
  FILE *stream;      /* usually stderr */
  FILE *log;         /* NULL: none. Not owned */
  int quiet;
  int terminal;      /* nonzero: draw a bar */
  char what[48];     /* are counted */
  size_t total;      /* 0: nothing under way */
  size_t before;     /* were done at the start */
  int percent;       /* shown last */
  char name[120];    /* of what has been at work for the longest; "": not known */
  double since;      /* that it is, seconds */
  int width;         /* of the bar's line as it stands; 0: none */
  double start, drawn, spoken; /* seconds: of what is under way, of the bar, of the last line */
  double every;      /* seconds after which a line comes in any case */
} progress;

/* A progress without a log; the stream decides between bar and lines. */
void progress_init(progress *p, FILE *stream, int quiet);

/* `total` things called `what` are to be done, of which `done` are already; `done` of them are; no
   more follow. */
void progress_start(progress *p, const char *what, size_t total, size_t done);
void progress_step(progress *p, size_t done);
void progress_end(progress *p);

/* To be called now and then while `done` of them are: where there was no line for five minutes one
   says so, and what has been at work for the longest, `name`, for so many seconds; a bar has it
   always. */
void progress_tick(progress *p, size_t done, const char *name, double seconds);

/* A line on the run; an error. A line break is added. */
void progress_note(progress *p, const char *format, ...) __attribute__((format(printf, 2, 3)));
void progress_error(progress *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
