/*
 * ranks_mpi.c -- processes that MPI knows of; see ranks.h.
 *
 * One thread at a time calls MPI, which is all that is asked of the library, and none waits inside:
 * a library that waits does so at full speed, on a processor that pendulums could have. MPI is
 * started only where a launcher has started several processes; a single one does without.
 */
#define _POSIX_C_SOURCE 200809L /* nanosleep */
#include "farm/ranks.h"

#include <limits.h>
#include <mpi.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "farm/ranks_started.h"

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int own = 0, all = 1, started = 0;

static void nap(void)
{
  const struct timespec t = { 0, 100000 };
  (void)nanosleep(&t, NULL);
}

int ranks_start(int *argc, char ***argv, char words[RANKS_WORDS])
{
  int level = MPI_THREAD_SINGLE;
  const long wanted = ranks_started();
  if (wanted == 1) return 1;
  if (MPI_Init_thread(argc, argv, MPI_THREAD_SERIALIZED, &level) != MPI_SUCCESS) {
    snprintf(words, RANKS_WORDS, "MPI cannot be started");
    return 0;
  }
  started = 1;
  (void)MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &own);
  (void)MPI_Comm_size(MPI_COMM_WORLD, &all);
  if (all > 1 && level >= MPI_THREAD_SERIALIZED) return 1;
  if (all > 1)
    snprintf(words, RANKS_WORDS, "this MPI has no support of threads (MPI_THREAD_SERIALIZED)");
  else
    snprintf(words, RANKS_WORDS, "a launcher has started %ld processes that know nothing of each "
             "other: it is not that of the MPI which this program was built with", wanted);
  return 0;
}

void ranks_end(void)
{
  if (started) (void)MPI_Finalize();
  started = 0;
}

int ranks_own(void)
{
  return own;
}

int ranks_count(void)
{
  return all;
}

/* Wait for what was begun, with naps, so that others may call MPI meanwhile. */
static int wait_for(MPI_Request *request)
{
  for (int done = 0; !done; nap()) {
    pthread_mutex_lock(&lock);
    const int code = MPI_Test(request, &done, MPI_STATUS_IGNORE);
    pthread_mutex_unlock(&lock);
    if (code != MPI_SUCCESS) return 0;
    if (done) break;
  }
  return 1;
}

void ranks_broadcast(void *data, size_t size)
{
  MPI_Request request;
  if (all == 1 || size > INT_MAX) return;
  pthread_mutex_lock(&lock);
  const int code = MPI_Ibcast(data, (int)size, MPI_BYTE, 0, MPI_COMM_WORLD, &request);
  pthread_mutex_unlock(&lock);
  if (code == MPI_SUCCESS) (void)wait_for(&request);
}

int ranks_send(int to, int tag, const void *data, size_t size)
{
  MPI_Request request;
  if (size > INT_MAX) return 0;
  pthread_mutex_lock(&lock);
  const int code = MPI_Isend(data, (int)size, MPI_BYTE, to, tag, MPI_COMM_WORLD, &request);
  pthread_mutex_unlock(&lock);
  return code == MPI_SUCCESS && wait_for(&request);
}

int ranks_receive(int tag, ranks_parcel *out)
{
  MPI_Status status;
  MPI_Request request;
  int there = 0, size = 0, code = MPI_SUCCESS;
  *out = (ranks_parcel){ 0 };
  pthread_mutex_lock(&lock);
  code = MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &status);
  if (code == MPI_SUCCESS && there) code = MPI_Get_count(&status, MPI_BYTE, &size);
  if (code == MPI_SUCCESS && there) out->data = malloc((size_t)size + 1);
  if (out->data != NULL)
    code = MPI_Irecv(out->data, size, MPI_BYTE, status.MPI_SOURCE, tag, MPI_COMM_WORLD, &request);
  pthread_mutex_unlock(&lock);
  if (out->data == NULL) return 0;
  if (code == MPI_SUCCESS && wait_for(&request)) {
    out->from = status.MPI_SOURCE;
    out->size = (size_t)size;
    return 1;
  }
  free(out->data);
  out->data = NULL;
  return 0;
}
