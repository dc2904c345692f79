/*
 * journal.h -- records of finished tasks, kept on disk until the results are complete.
 *
 * Owns: the journal's file, to which data are only appended: a head that identifies the deck and
 * the code of the records, then records, each with its stage, task, length and checksums. A run
 * that is killed while it writes a record leaves an incomplete one, which is dropped when the
 * journal is opened again. States that have become outdated are left out now and then: what is
 * there is copied into a file PATH.new, which takes the name.
 */
#ifndef JOURNAL_H
#define JOURNAL_H

#include "farm/index.h"
#include "farm/record.h"

typedef struct journal journal;

/* Where the records of a run come from: the last is for a journal in a folder that the user has
   named. */
typedef enum journal_from { JOURNAL_ANEW, JOURNAL_RESUMED, JOURNAL_NAMED } journal_from;

/*
 * Open the journal at `path`, with a head of lines of text, and lock it for this process.
 *
 * JOURNAL_RESUMED: existing records are used if the heads are the same; otherwise `words` names the
 * first line that differs. The file must be the user's own, unless JOURNAL_NAMED. JOURNAL_ANEW: an
 * own journal that holds records, and any other own file, is renamed to `path.~1~` or the next name
 * that is free, and kept.
 * words[JOURNAL_WORDS] receives why it failed, what was kept, what was found damaged and dropped,
 * or that it is another user's; "" if none of these.
 * Errors: PENDRES_INVALID_ARGUMENT (another head, or not a journal), PENDRES_BUSY (another
 * process has it), PENDRES_IO, PENDRES_OUT_OF_MEMORY. On failure *out is NULL.
 */
pendres_status journal_open(const char *path, const char *head, journal_from from, journal **out,
                            char words[JOURNAL_WORDS]);

/* Use the records of another journal as well, which is read and never changed, under the same
   conditions. Errors and words as for journal_open; PENDRES_NOT_FOUND: there is none. */
pendres_status journal_add(journal *j, const char *path, char words[JOURNAL_WORDS]);

/* Finished tasks that are there; those in the own file among them; unfinished ones whose states are
   in it; its name. */
size_t journal_count(const journal *j);
size_t journal_own(const journal *j);
size_t journal_states(const journal *j);
const char *journal_path(const journal *j);

/* Whether it is locked, so that no other process writes it; on file systems without locks this
   cannot be known. NULL: no. */
int journal_alone(const journal *j);

/* The number of a stage in a journal: its ordinal, with a checksum of its name, the number of its
   tasks and the size of their records. */
uint64_t journal_stage(size_t ordinal, const char *name, size_t tasks, size_t record_size);

/* The name of the file that holds a record; NULL: none. */
const char *journal_place(const journal *j, uint64_t stage, uint64_t task);

/* Is the record of a task there? j may be NULL: no. */
int journal_has(journal *j, uint64_t stage, uint64_t task);

/* Read it; record->data is to be freed. PENDRES_IO if it cannot be read or is not what it was. */
pendres_status journal_read(journal *j, uint64_t stage, uint64_t task, farm_record *record);

/*
 * Append a record; any thread may call. What is written survives a crash of the process
 * immediately, and one of the machine after a few seconds. On failure (PENDRES_IO, for instance a
 * full disk) the file is truncated to complete records, and nothing more is written:
 * words[JOURNAL_WORDS] receives the reason the first time and is "" from then on.
 */
pendres_status journal_append(journal *j, uint64_t stage, uint64_t task, const farm_record *record,
                              char words[JOURNAL_WORDS]);

/* From now on the file is kept even if it holds no record, as when a part of a run has nothing to
   do. NULL is allowed. */
void journal_stay(journal *j);

/* Close it: the file stays, completely on disk; one without records is removed. NULL is
   allowed. */
void journal_close(journal *j);

/* The results are complete: the file is removed, and so are the journals that were added, unless
   another process is writing them; j is closed. */
void journal_remove(journal *j);

#endif
