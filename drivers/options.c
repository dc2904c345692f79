/* options.c -- the command line; see options.h. */
#define _GNU_SOURCE /* getopt_long */
#include "options.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <pendres/pendres.h>

#include "deck/deck.h"
#include "farm/farm.h"
#include "shard.h"

enum {
  MOST_THREADS = FARM_MOST_THREADS,
  ACTION = 256 /* and more: options that say what is to be done */
};

static const char help[] =
  "Usage: resonance [OPTION]... DECK... [GROUP.KEY=VALUE]...\n"
  "  or:  resonance --verify FILE...\n"
  "Compute the scene that a deck describes, a file in Fortran namelist syntax, for driven, damped\n"
  "and noisy pendulums, and write its results to an HDF5 file (default: the deck's name with .h5,\n"
  "in the working directory). A short table goes to standard output, all else to standard error.\n"
  "DECK - is standard input. Several decks are computed one after another, each into its own\n"
  "file. Keys set behind them take the place of what the decks say of the same quantity.\n"
  "\n"
  "      --list            kinds of scenes, a line each\n"
  "      --explain=WORD    meaning, unit, default, range of a key, or of all of a kind or group;\n"
  "                        what a result is; what the docs have on a subject, as duffing, fold\n"
  "      --init=KIND       print a deck of that kind to start from, with comments; KIND may be\n"
  "                        resonator, junction, two_wells: ten lines in SI\n"
  "      --reference       print what --explain knows of keys as a page (docs/decks.md)\n"
  "  -n, --dry-run         check the deck, say what would be computed, and about how much time,\n"
  "                        memory and space on the disk it takes; some seconds\n"
  "      --verify          say of each FILE of results whether it is whole, instead of DECK\n"
  "      --dump-namelist   print the deck with all defaults resolved\n"
  "  -o, --output=FILE     write the results to FILE\n"
  "      --csv             write results of one or two dimensions as text, too: NAME.csv beside\n"
  "                        NAME.h5, and NAME.DIMENSION.csv for further tables\n"
  "  -f, --force           do not keep a file that is replaced (see below)\n"
  "      --resume          go on where a run of the same deck was stopped, if there was one\n"
  "      --journal=DIR     keep finished tasks in DIR/FILE.journal, not beside FILE\n"
  "      --no-journal      keep nothing that a stopped run could go on from\n"
  "      --shard=I/N       compute the I-th of N parts and leave it in FILE.I-of-N.journal;\n"
  "                        auto or auto/N: as the variables of an array of jobs say\n"
  "      --merge           put the parts together; with --resume compute what is missing\n"
  "      --budget=SECONDS  end a point that has taken so many seconds of processor time, mark\n"
  "                        it as failed, and go on; --resume computes such points again\n"
  "  -t, --threads=N       use N threads (default: OMP_NUM_THREADS, or all cores)\n"
  "  -q, --quiet           no progress and no notes; errors are still reported\n"
  "      --log=FILE        append progress, notes and errors to FILE, with the time\n"
  "  -h, --help            this text\n"
  "  -V, --version         versions of the program and of its libraries\n"
  "\n"
  "Exit status: 0 done; 1 failure, or a FILE is not whole; 2 bad usage or deck; 3 finished, but\n"
  "some points failed (they are marked in the file); 75 stopped by TERM, INT, HUP, USR1, USR2 or\n"
  "XCPU.\n"
  "A file of results is whole or absent: it is written as FILE.part and renamed at the end. If\n"
  "FILE is a link, what it points to is replaced. A device, a read-only file and the deck are\n"
  "not. A FILE that is there already and holds anything but results of the same deck is kept, as\n"
  "FILE.~1~, FILE.~2~ and so on.\n"
  "Finished tasks are kept in FILE.journal, which is removed when FILE is whole. After a signal,\n"
  "a crash or a loss of power the same command with --resume goes on from there and ends in the\n"
  "same results; --resume may be given always. Without it an older journal is kept, as\n"
  "FILE.journal.~1~.\n"
  "\n"
  "Examples: resonance input/f02.nml\n"
  "          resonance input/f02.nml pendulum.drive_amplitude=0.15 sweep.damping=0.2,0.3\n";

static int complain(const char *name)
{
  fprintf(stderr, "Try '%s --help'.\n", name);
  return 2;
}

/* A whole number from 1 to MOST_THREADS; 0 if it is none. */
static int threads_of(const char *text)
{
  char *end = NULL;
  errno = 0;
  const long n = strtol(text, &end, 10);
  return errno != 0 || end == text || *end != '\0' || n < 1 || n > MOST_THREADS ? 0 : (int)n;
}

/* --budget; 0, or 2 after a message. */
static int take_budget(const char *value, const char *name, options *out)
{
  char *end = NULL;
  out->budget = strtod(value, &end);
  if (end != value && *end == '\0' && out->budget > 0.0 && isfinite(out->budget)) return 0;
  fprintf(stderr, "%s: --budget takes seconds, more than 0, not '%s'\n", name, value);
  return complain(name);
}

/* --shard; 0, or 2 after a message. */
static int take_shard(const char *value, const char *name, options *out)
{
  char why[300];
  if (shard_parse(value, &out->shard, &out->shards, why, sizeof why)) return 0;
  fprintf(stderr, "%s: --shard: %s\n", name, why);
  return complain(name);
}

/* What an option asks to be done; what says more goes before what says less, and the namelist
   of the deck is asked for by programs: nothing may stand beside it. */
static int take_action(options_action wanted, const char *value, options *out)
{
  if (out->action >= wanted || out->action > OPTIONS_DUMP_NAMELIST) return 0;
  out->action = wanted;
  if (value != NULL) out->word = value;
  return 0;
}

/* One option; 0, or 2 after a message. */
static int apply(int option, const char *value, const char *name, options *out)
{
  if (option >= ACTION) return take_action((options_action)(option - ACTION), value, out);
  switch (option) {
  case 0: return 0; /* a flag, which is set */
  case 'n': return take_action(OPTIONS_DRY_RUN, NULL, out);
  case 'h': return take_action(OPTIONS_HELP, NULL, out);
  case 'V': return take_action(OPTIONS_VERSION, NULL, out);
  case 'f': out->force = 1; return 0;
  case 'q': out->quiet = 1; return 0;
  case 'l': out->log = value; return 0;
  case 'j': out->journal = value; return 0;
  case 'S': return take_shard(value, name, out);
  case 'B': return take_budget(value, name, out);
  case 'o':
    out->output = value;
    if (*value != '\0') return 0;
    fprintf(stderr, "%s: --output needs the name of a file\n", name);
    return complain(name);
  case 't':
    out->threads = threads_of(value);
    if (out->threads > 0) return 0;
    fprintf(stderr, "%s: --threads takes a number from 1 to %d, not '%s'\n", name, MOST_THREADS,
            value);
    return complain(name);
  default: return complain(name); /* getopt has said why */
  }
}

/* Where --threads is not given the environment counts, as for other programs with threads: a
   number, or a list of which the first is meant. */
static int threads_of_environment(options *out, const char *name)
{
  char text[32] = "";
  const char *value = getenv("OMP_NUM_THREADS");
  if (out->threads > 0 || value == NULL || *value == '\0') return 0;
  const size_t length = strcspn(value, ",");
  if (length < sizeof text) snprintf(text, sizeof text, "%.*s", (int)length, value);
  out->threads = threads_of(text);
  if (out->threads > 0) return 0;
  fprintf(stderr, "%s: OMP_NUM_THREADS must be a number from 1 to %d, and is '%.60s': set or unset "
          "it, or give --threads\n", name,
          MOST_THREADS, value);
  return complain(name);
}

/* Decks first, then the keys that are set, both in their order. */
static int take_operands(int argc, char **argv, const char *name, options *out)
{
  char **operand = argv + optind;
  const size_t count = (size_t)(argc - optind);
  for (size_t i = 0; i < count; i++) {
    char *one = operand[i];
    if (deck_is_setting(one)) continue;
    if (strchr(one, '=') != NULL && access(one, F_OK) != 0) {
      fprintf(stderr, "%s: there is no deck '%s', and it sets no key: that is written "
              "GROUP.KEY=VALUE, as in pendulum.damping=0.13\n", name, one);
      return complain(name);
    }
    memmove(&operand[out->deck_count + 1], &operand[out->deck_count],
            (i - out->deck_count) * sizeof *operand);
    operand[out->deck_count++] = one;
  }
  out->deck = operand;
  out->setting = operand + out->deck_count;
  out->setting_count = count - out->deck_count;
  if (out->deck_count > 1 && out->output != NULL) {
    fprintf(stderr, "%s: --output names one file, and there are %zu decks\n", name,
            out->deck_count);
    return complain(name);
  }
  if (out->deck_count > 0) return 0;
  fprintf(stderr, "%s: no deck was given: name a file, or - for standard input\n", name);
  return complain(name);
}

/* Of --verify. */
static int take_files(int argc, char **argv, const char *name, options *out)
{
  out->deck = argv + optind;
  out->deck_count = (size_t)(argc - optind);
  if (out->deck_count > 0) return 0;
  fprintf(stderr, "%s: --verify: no file was given: name the files of results to be read\n", name);
  return complain(name);
}

int options_parse(int argc, char **argv, options *out)
{
  const struct option table[] = {
    {"dry-run", no_argument, NULL, 'n'},
    {"dump-namelist", no_argument, NULL, ACTION + OPTIONS_DUMP_NAMELIST},
    {"list", no_argument, NULL, ACTION + OPTIONS_LIST},
    {"explain", required_argument, NULL, ACTION + OPTIONS_EXPLAIN},
    {"init", required_argument, NULL, ACTION + OPTIONS_INIT},
    {"reference", no_argument, NULL, ACTION + OPTIONS_REFERENCE},
    {"verify", no_argument, NULL, ACTION + OPTIONS_VERIFY},
    {"help", no_argument, NULL, 'h'}, {"version", no_argument, NULL, 'V'},
    {"output", required_argument, NULL, 'o'}, {"threads", required_argument, NULL, 't'},
    {"log", required_argument, NULL, 'l'}, {"journal", required_argument, NULL, 'j'},
    {"shard", required_argument, NULL, 'S'}, {"budget", required_argument, NULL, 'B'},
    {"force", no_argument, NULL, 'f'}, {"quiet", no_argument, NULL, 'q'},
    {"csv", no_argument, &out->csv, 1}, {"resume", no_argument, &out->resume, 1},
    {"no-journal", no_argument, &out->no_journal, 1}, {"merge", no_argument, &out->merge, 1},
    {NULL, 0, NULL, 0},
  };
  const char *name = argc > 0 ? argv[0] : "resonance";
  int option = 0;

  *out = (options){ .action = OPTIONS_RUN };
  optind = 0; /* start again, also the second time */
  while ((option = getopt_long(argc, argv, "no:ft:qhV", table, NULL)) != -1) {
    const int code = apply(option, optarg, name, out);
    if (code != 0) return code;
  }
  if (out->action == OPTIONS_VERIFY) return take_files(argc, argv, name, out);
  if (out->action >= OPTIONS_LIST) return 0;
  if (out->no_journal && (out->resume || out->shards > 0 || out->merge)) {
    fprintf(stderr, "%s: --resume, --shard and --merge need a journal: leave out --no-journal\n",
            name);
    return complain(name);
  }
  if (out->merge && out->shards > 0) {
    fprintf(stderr, "%s: --merge puts together what --shard has computed: give one of the two\n",
            name);
    return complain(name);
  }
  const int code = take_operands(argc, argv, name, out);
  if (code != 0) return code;
  return threads_of_environment(out, name);
}

int options_written(FILE *out)
{
  if (fflush(out) == 0 && !ferror(out)) return 0;
  perror("resonance: standard output");
  return 1;
}

int options_print_help(FILE *out)
{
  fputs(help, out);
  return options_written(out);
}

int options_print_version(FILE *out)
{
  fprintf(out,
          "resonance %s\n"
          "libpendres %s; %s\n"
          "License GPL-3.0-or-later: you are free to change and redistribute it; there is no\n"
          "warranty, to the extent permitted by law.\n",
          PENDRES_VERSION, pendres_version(), pendres_build_info());
  return options_written(out);
}
