/*
 * progress.h -- what a user sees of a run while it is computed: stderr and the log.
 *
 * Owns: a bar where stderr is a terminal, otherwise a line for each 10 % of work that takes longer
 * than a second, and at least every five minutes; notes and errors; the log file with the time in
 * front of each line. With --quiet only warnings and errors are shown; the log gets everything.
 *
 * Thread safety: one thread at a time; the farm takes care of that.
 */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stddef.h>
#include <stdio.h>

#include <pendres/pendres.h>

typedef struct progress {
  FILE *stream;      /* usually stderr */
  FILE *log;         /* NULL: none. Not owned */
  int quiet;
  int terminal;      /* nonzero: draw a bar */
  char what[48];     /* are counted */
  size_t total;      /* 0: nothing is counted at present */
  size_t before;     /* were done at the start */
  int percent;       /* shown last */
  char doing[160];   /* while nothing is counted; "": the next tasks have not begun */
  char name[120];    /* of what has been running for the longest time; "": not known */
  double since;      /* that time, seconds */
  int width;         /* of the bar's present line; 0: none */
  double start, drawn, spoken; /* times in seconds: of the start, or of the end before it; of the
                                  bar, counted from there; of the last line */
  double every;      /* seconds after which a line is written in any case */
} progress;

/* A progress without a log; the stream decides between bar and lines. */
void progress_init(progress *p, FILE *stream, int quiet);

/* Begin: `total` items called `what`, of which `done` are done already. Report that `done` are
   done. End. */
void progress_start(progress *p, const char *what, size_t total, size_t done);
void progress_step(progress *p, size_t done);
void progress_end(progress *p);

/* To be called now and then while `done` items are done. If there was no line for five minutes, one
   is written, with the name of what has been running for the longest time and its seconds; a bar
   always shows these. As progress_wait() while nothing is counted. */
void progress_tick(progress *p, size_t done, const char *name, double seconds);

/* What is done from now on while nothing is counted, as a sentence; "": that is over. */
void progress_doing(progress *p, const char *what);

/* To be called now and then while nothing is counted, as before a run's first tasks: a terminal
   shows for how long, once a second; otherwise there is a line after five minutes, of what has a
   sentence after ten seconds and whenever the time has doubled. */
void progress_wait(progress *p);

/* A message about the run; one that --quiet shows as well, although nothing has failed; an error
   message. A line break is added. */
void progress_note(progress *p, const char *format, ...) __attribute__((format(printf, 2, 3)));
void progress_warning(progress *p, const char *format, ...) __attribute__((format(printf, 2, 3)));
void progress_error(progress *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The words of a failure, or those of its status where there are none, as without memory. */
const char *progress_words(const char *words, pendres_status status);

#endif
