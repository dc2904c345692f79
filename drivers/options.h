/*
 * options.h -- the command line.
 *
 * Owns: names and checks of options. The deck, and keys set on the command line, say what is
 * computed; options say how, and where the result goes.
 */
#ifndef OPTIONS_H
#define OPTIONS_H

#include <stdio.h>

typedef enum options_action {
  OPTIONS_RUN,
  OPTIONS_DRY_RUN,       /* check the deck and say what would be computed */
  OPTIONS_DUMP_NAMELIST, /* print the resolved deck */
  OPTIONS_LIST,          /* name the kinds of scenes */
  OPTIONS_EXPLAIN,       /* describe a kind, group or key */
  OPTIONS_INIT,          /* print a deck to start from */
  OPTIONS_REFERENCE,     /* print the page docs/decks.md */
  OPTIONS_VERIFY,        /* read files of results */
  OPTIONS_HELP,
  OPTIONS_VERSION
} options_action;

/* Texts are argv's own. */
typedef struct options {
  options_action action;
  char **deck;        /* names of decks; "-": standard input; those of files to verify */
  size_t deck_count;  /* 0 for help, version and the like */
  char **setting;     /* keys set behind the decks, for all of them */
  size_t setting_count;
  const char *output; /* instead of the deck's; NULL: not given */
  int resume;         /* nonzero: go on from the journal */
  int no_journal;
  size_t shard, shards; /* of --shard, from 1; 0: not given */
  int merge;            /* put shards together */
  const char *journal; /* its folder; NULL: the output's */
  int csv;            /* nonzero: results as text, too */
  int force;          /* nonzero: an existing output is not kept */
  const char *log;    /* NULL: none */
  const char *word;   /* of --explain and --init */
  double budget;      /* processor seconds per point; 0: no limit */
  int threads;        /* of --threads or OMP_NUM_THREADS; 0: all cores */
  int quiet;
} options;

/* 0, or 2 after a message on stderr. Puts argv into order. Not thread safe (getopt). */
int options_parse(int argc, char **argv, options *out);

/* 0 if everything sent to the stream was written, or 1 after a message. */
int options_written(FILE *out);

/* What --help and --version print; 0, or 1 if that could not be written. */
int options_print_help(FILE *out);
int options_print_version(FILE *out);

#endif
