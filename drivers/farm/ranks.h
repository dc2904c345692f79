/*
 * ranks.h -- processes that a launcher of MPI has started together, numbered from 0.
 *
 * Owns: everything of MPI. ranks_mpi.c and ranks_serial.c have the same functions, the latter for
 * one process; which of them is built in, `make MPI=1` decides. Any thread may send and receive.
 */
#ifndef RANKS_H
#define RANKS_H

#include <stddef.h>
#include <stdlib.h>

enum { RANKS_WORDS = 256 };

/* To be called first, on the main thread. 0 on failure, and words[RANKS_WORDS] say why: as where a
   launcher has started several processes that know nothing of each other. */
int ranks_start(int *argc, char ***argv, char words[RANKS_WORDS]);

/* To be called last, on the main thread. */
void ranks_end(void);

int ranks_own(void);   /* from 0 */
int ranks_count(void); /* 1: no others */

/* Copy what rank 0 has in data[size] to all ranks, which all call this. */
void ranks_broadcast(void *data, size_t size);

/* Do all ranks say yes? All of them call this. */
int ranks_all(int yes);

/* Bytes with a tag from 0 to 32000, in order between two ranks for each tag. `data` is taken over,
   whatever happens, and freed when it has been sent; this returns at once, unless much is under way
   already. 0 on failure. */
int ranks_send(int to, int tag, void *data, size_t size);

/* Wait until all that was sent has left: where nobody here looks at MPI, nothing moves. */
void ranks_flush(void);

/* What came with a tag, from any rank: 1 and data that are to be freed; 0: nothing is there yet, or
   no memory. Never waits for anything to come. */
typedef struct ranks_parcel {
  int from;
  size_t size;
  void *data;
} ranks_parcel;
int ranks_receive(int tag, ranks_parcel *out);

/* Sleep between two looks, the longer the longer nothing has come, but at most so many
   microseconds: a sleep costs up to 25 microseconds of a processor that pendulums could have. *idle
   counts them, from 0. */
void ranks_nap(int *idle, long most);

/* How many processes a launcher has started together; 1: no launcher, or a single one. */
static inline long ranks_started(void)
{
  static const char *const names[] = { "OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE",
                                       "SLURM_STEP_NUM_TASKS" };
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    const char *text = getenv(names[i]);
    const long n = text != NULL ? strtol(text, NULL, 10) : 0;
    if (n > 1) return n;
  }
  return 1;
}

#endif
