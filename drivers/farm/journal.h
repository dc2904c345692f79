/*
 * journal.h -- records of finished tasks, kept on disk until the results stand whole.
 *
 * Owns: the journal's file. It is only ever appended to: a head that says of which deck and code
 * the records are, then records, each with its stage, task, length and checksums. A run that was
 * killed in the middle of one leaves a torn end, which is dropped when the journal is opened again.
 */
#ifndef JOURNAL_H
#define JOURNAL_H

#include "farm/journal_file.h"
#include "farm/record.h"

typedef struct journal journal;

/*
 * Open the journal at `path`, with a head of lines of text, and lock it for this process.
 *
 * resume: the records that are there are taken over, if the heads are the same; else `words` names
 * the first line that differs. Without resume a journal that holds records, and any other file, is
 * kept under another name, `path.~1~` or the next one that is free, and stays there.
 * words[JOURNAL_WORDS] says why it failed, what was kept, or what was found damaged and dropped; ""
 * if none of these.
 * Errors: PENDRES_INVALID_ARGUMENT (another head, or no journal at all), PENDRES_BUSY (another
 * process has it), PENDRES_IO, PENDRES_OUT_OF_MEMORY. On failure *out is NULL.
 */
pendres_status journal_open(const char *path, const char *head, int resume, journal **out,
                            char words[JOURNAL_WORDS]);

/* Take over the records of another journal as well, which is read and never changed. Errors as for
   journal_open; PENDRES_NOT_FOUND: there is none. */
pendres_status journal_add(journal *j, const char *path, char words[JOURNAL_WORDS]);

/* Records that are there; those in the own file among them; its name. */
size_t journal_count(const journal *j);
size_t journal_own(const journal *j);
const char *journal_path(const journal *j);

/* Is it locked, so that no other process writes it? Some file systems know no locks: then nobody
   can tell. NULL: no. */
int journal_alone(const journal *j);

/* What a stage is called in a journal: its ordinal, with a checksum of its name, the number of its
   tasks and the size of their records. */
uint64_t journal_stage(size_t ordinal, const char *name, size_t tasks, size_t record_size);

/* The name of the file that holds a record; NULL: none. */
const char *journal_place(const journal *j, uint64_t stage, size_t task);

/* Is the record of a task there? j may be NULL: no. */
int journal_has(const journal *j, uint64_t stage, size_t task);

/* Read it; record->data is to be freed. PENDRES_IO if it cannot be read or is not what it was. */
pendres_status journal_read(journal *j, uint64_t stage, size_t task, farm_record *record);

/*
 * Append a record; any thread may. What is written survives the process at once, and the machine
 * after a few seconds. On failure (PENDRES_IO: the disk is full, say) the file is cut back to whole
 * records and takes no more: words[JOURNAL_WORDS] says why the first time and is "" from then on.
 */
pendres_status journal_append(journal *j, uint64_t stage, size_t task, const farm_record *record,
                              char words[JOURNAL_WORDS]);

/* From now on the file stays though it may hold no record: a part of a run has nothing to do. NULL
   is allowed. */
void journal_stay(journal *j);

/* Let go of it: the file stays, all of it on disk; one without records is removed. NULL is
   allowed. */
void journal_close(journal *j);

/* The results stand whole: the file is removed, and the journals that were added, unless another
   process is writing them; j is let go of. */
void journal_remove(journal *j);

#endif
