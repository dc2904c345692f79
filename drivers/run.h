/*
 * run.h -- what happens to a deck before and after its scene is run, as main.c does it.
 */
#ifndef RUN_H
#define RUN_H

#include <pendres/store.h>

#include "deck/deck.h"
#include "farm/farm.h"
#include "farm/journal.h"
#include "options.h"
#include "scenes/scene.h"
#include "terminal/progress.h"

/* Exit codes: bad usage or a bad deck; finished, but for points that are marked in the file;
   interrupted. */
enum { DONE = 0, FAILED = 1, BAD_USAGE = 2, SOME_POINTS_FAILED = 3, STOPPED = 75 };

/*
 * ---- files.c: the files of a run: none of them may be another one.
 *
 * Owns: comparing the deck, the output, its part file and the log as files, not as names: links and
 * other ways to write a path lead to the same file.
 */

/* Whether the two names are one file, existing or to be made. */
int files_same(const char *one, const char *other);

/* 0, or 2 after an error that says which would be overwritten. log may be NULL. */
int files_check(const deck *d, const char *log, progress *p);

/* 0, or 1 after an error that says why nothing can be written where the output goes; makes no file
   there. */
int files_writable(const deck *d, progress *p);

/* Remove the part of an output if it is the user's own and holds the whole results of the deck, as
   after a kill just before it is renamed: they are in the journal too, and a store replaces nothing
   that is whole. To be called under the journal's lock, before the output is made. */
void files_drop_whole(const deck *d, const char *output);

/* A file that is about to be replaced, and the name under which it is kept; all zero: none. */
typedef struct files_kept {
  char *target, *name;
} files_kept;

/*
 * If the output exists and holds anything other than results of the same deck (as resolved, so that
 * the same results would be computed again), rename it to OUTPUT.~1~ or the next name that is free.
 * To be called just before the output is replaced; afterwards files_keep_end is called with
 * `replaced` nonzero if it was. 0, or 1 after an error: then it must not be replaced.
 */
int files_keep(const deck *d, files_kept *kept, progress *p);
void files_keep_end(files_kept *kept, int replaced, progress *p);

/*
 * ---- together.c: agreement among the ranks of a run: rank 0 reads, decides and informs the
 * others.
 */

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

/* Redirect its standard streams to the null device. */
void together_silence(void);

/*
 * ---- estimate.c: time, memory and size of the output of a run, before it is begun.
 *
 * Owns: the rules for memory and for the size of the output, to which each scene contributes its
 * own (scene_size), and the time that --dry-run reports. The rules were measured on the decks of
 * input/, where they should be correct within a factor of two. What depends on the results, such as
 * the number of periods until pendulums settle and the number of neighbours in a grid that differ,
 * is found by computing a small part of the run (farm/trial.h). If that ends in the middle of a
 * task the reported time is a lower bound: the larger of two values, one as if no task took longer
 * than the part of that one, the other from a rule that depends on the damping. Where each point
 * has an ensemble, some members of it at one point tell how long they take; but a search ends when
 * its budget of work is spent, whatever its members.
 */

/* Print on standard output what a deck would compute, and what that would take: a little of it is
   computed, into a file in TMPDIR. run->deck and run->farm are set; the file, in run->store, is the
   caller's to free, and what is told of points that failed is in the run. 0, or 1 after an error:
   what was tried fails, and so would the run. */
int estimate_dry_run(scene_run *run, const scene_kind *scene, progress *p);

/* Warn if the output will not fit on the disk; the run continues, since this is only an estimate.
   0, after an error message, if the machine has less memory than the rules say that the run needs;
   otherwise 1. */
int estimate_fits(const deck *d, const farm *f, progress *p);

/*
 * ---- resume.c: continuing a run that was stopped.
 *
 * Owns: the location of a run's journal (beside the output, or in a folder of the user's choice),
 * the contents of its head (version and sources of the code, the resolved deck), and the messages
 * about it.
 */

/* Open the journal of a run of this deck; *out is NULL if it has none. 0, or an exit code after an
   error. */
int resume_open(const deck *d, const options *o, progress *p, journal **out);

/* The results are complete. The journal is closed, and removed unless a budget has ended points,
   which may still be computed. NULL is allowed. */
void resume_leave(journal *j, size_t lost, progress *p);

/* A message on how to continue, " ...", if something was kept; otherwise "". */
const char *resume_advice(const journal *j, char *text, size_t size);

/*
 * ---- provenance.c: where a file of results comes from and what it cost.
 *
 * Owns: the group `provenance`: the deck verbatim and as resolved, versions, host, threads, seed,
 * times and counts. Everything that changes from run to run is here; nothing else in the file does,
 * except for the date in the root's `history`.
 */

/* When a run began. */
typedef struct provenance {
  double wall, processor; /* seconds */
  char date[32];          /* UTC */
} provenance;

void provenance_start(provenance *p);

/* Seconds since the start. */
double provenance_wall(const provenance *p);

/* Write the group. failed_points as in scene_run. */
pendres_status provenance_write(const provenance *p, const deck *d, const farm *f,
                                size_t failed_points, pendres_store *store);

/*
 * ---- csv.c: results as text, beside the HDF5 file.
 *
 * Owns: the form of these files, and the choice of results that go into them: whatever has one to
 * four dimensions, as tables of columns, and the rest of the numbers as comments. Users find them
 * described in docs/files.md.
 */

/* 0, or 2 after an error: the main table would replace a file that is not such a table. To be
   called before anything is computed. */
int csv_check(const deck *d, progress *p);

/* Write the tables of the finished output; `force` replaces existing files. 0, or 1 after an
   error. The HDF5 file is only read. */
int csv_write(const deck *d, int force, progress *p);

/*
 * ---- verify.c: checking that files of results are complete.
 *
 * Owns: --verify, with one line per file on standard output.
 */

/* 0 if all the files are complete and of this program, otherwise 1. Each is read in a process of
   its own, since a damaged one may crash HDF5: to be called before there are threads. */
int verify_files(char *const *files, size_t count);

#endif
