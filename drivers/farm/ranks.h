/*
 * ranks.h -- processes that an MPI launcher has started together, numbered from 0.
 *
 * Owns: everything of MPI. ranks_mpi.c and ranks_serial.c have the same functions, the latter for
 * one process; which of them is built in, `make MPI=1` decides. Any thread may send and receive.
 *
 * Ranks are more than shards that are merged at the end: tasks are dealt as ranks become free,
 * since the slowest takes ten times as long as the mean, and records that later stages read go to
 * all ranks. Shards divide the first stage alone: of `response` with temperatures, whose work is in
 * the last one, "rank r does shard r" would gain nothing.
 */
#ifndef RANKS_H
#define RANKS_H

#include <stddef.h>
#include <stdlib.h>

enum { RANKS_WORDS = 256 };

/* To be called first, on the main thread. 0 on failure, with the reason in words[RANKS_WORDS]: for
   instance where a launcher has started several processes that are not connected by MPI. */
int ranks_start(int *argc, char ***argv, char words[RANKS_WORDS]);

/* To be called last, on the main thread. */
void ranks_end(void);

int ranks_own(void);   /* from 0 */
int ranks_count(void); /* 1: no others */

/* Copy what rank 0 has in data[size] to all ranks, which all call this. */
void ranks_broadcast(void *data, size_t size);

/* Whether the condition holds on all ranks; all of them call this. */
int ranks_all(int yes);

/* Send bytes with a tag from 0 to 32000; messages with the same tag between two ranks keep their
   order. The function becomes the owner of `data` in any case, and frees it when it has been sent;
   it returns immediately unless much is waiting to be sent. 0 on failure. */
int ranks_send(int to, int tag, void *data, size_t size);

/* Wait until everything has been sent: messages make progress only while this process calls MPI. */
void ranks_flush(void);

/* Receive a message with a tag, from any rank: 1 and data that are to be freed; 0: none has
   arrived, or no memory. Never waits. */
typedef struct ranks_parcel {
  int from;
  size_t size;
  void *data;
} ranks_parcel;
int ranks_receive(int tag, ranks_parcel *out);

/* Sleep between two attempts to receive, longer after each that has received nothing, but at most
   `most` microseconds: a sleep costs up to 25 microseconds of processor time. *idle counts the
   sleeps, from 0. */
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
