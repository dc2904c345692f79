/*
 * index.h -- where the records of a journal's files are.
 *
 * Owns: which of several records of a task counts, and how many bytes of the first file, which the
 * run writes, count no more. A tree: it takes no more memory than there are records, whatever their
 * numbers are.
 */
#ifndef FARM_INDEX_H
#define FARM_INDEX_H

#include <stddef.h>

#include "farm/journal_file.h"

/* To be added to the number of a task: the state of one that is not finished, of which the last
   that was appended counts. It is no finished task. */
#define JOURNAL_STATE (UINT64_C(1) << 63)

typedef struct journal_slot {
  uint64_t stage, task;
  size_t file;      /* number of the file that holds the record */
  off_t at, length; /* of its head; and of all of it */
} journal_slot;

typedef struct journal_index {
  void *tree;
  size_t count, states; /* finished tasks; states that count, in the first file */
  off_t dead;           /* bytes of states in that file that count no more */
} journal_index;

/* Note the record at `at`. One may be there twice, with the same bytes; of states the last counts,
   and none of a finished task. 0: no memory. */
int index_note(journal_index *x, size_t file, const journal_entry *e, off_t at);

/* NULL: there is none. */
journal_slot *index_find(const journal_index *x, uint64_t stage, uint64_t task);

void index_free(journal_index *x);

#endif
