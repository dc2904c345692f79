/*
 * ranks_mpi.c -- processes that MPI knows of; see ranks.h.
 *
 * One thread at a time calls MPI (no higher level of thread support is required), and none waits
 * inside: MPI libraries wait by polling, on a processor that could compute. MPI is started only
 * where a launcher has started several processes.
 */
#define _POSIX_C_SOURCE 200809L /* nanosleep */
#include "farm/numbers.h"
#include "farm/ranks.h"
#include "farm/record.h"

#include <limits.h>
#include <mpi.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int own = 0, all = 1, started = 0;

/* Sent, and not known to have left: first in, first out. Guarded by `lock`. */
typedef struct letter {
  MPI_Request request;
  void *data;
  size_t size;
  struct letter *next;
} letter;
static letter *oldest = NULL, *newest = NULL;
static size_t unsent = 0;

/* Sleeps grow by 50 us each, so that after a silence of t they are sqrt(100 us * t) long: the cost
   of polling and the delay are then balanced, whatever the time between messages. */
void ranks_nap(int *idle, long most)
{
  const long wanted = *idle < 1000 ? 50L * (*idle + 1) : most;
  const struct timespec t = { 0, 1000L * (wanted < most ? wanted : most) };
  ++*idle;
  (void)nanosleep(&t, NULL);
}

/* Let go of letters that have left. Under the lock; 1: there are none any more. */
static int drop_sent(void)
{
  for (int done = 1; oldest != NULL;) {
    letter *l = oldest;
    if (MPI_Test(&l->request, &done, MPI_STATUS_IGNORE) == MPI_SUCCESS && !done) return 0;
    oldest = l->next;
    unsent -= l->size;
    free(l->data);
    free(l);
  }
  newest = NULL;
  return 1;
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
  if (started) ranks_flush();
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
  int done = 0, idle = 0;
  for (;;) {
    pthread_mutex_lock(&lock);
    const int code = MPI_Test(request, &done, MPI_STATUS_IGNORE);
    pthread_mutex_unlock(&lock);
    if (code != MPI_SUCCESS || done) return code == MPI_SUCCESS;
    ranks_nap(&idle, WAIT_OFTEN);
  }
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

int ranks_all(int yes)
{
  MPI_Request request;
  int mine = yes != 0, least = 0;
  if (all == 1) return mine;
  pthread_mutex_lock(&lock);
  const int code =
    MPI_Iallreduce(&mine, &least, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD, &request);
  pthread_mutex_unlock(&lock);
  return code == MPI_SUCCESS && wait_for(&request) && least;
}

/* The letter is on its way, or is freed: 0. Under the lock. */
static int post(letter *l, int to, int tag)
{
  if (MPI_Isend(l->data, (int)l->size, MPI_BYTE, to, tag, MPI_COMM_WORLD, &l->request) !=
      MPI_SUCCESS) {
    free(l->data);
    free(l);
    return 0;
  }
  if (newest != NULL) newest->next = l;
  else oldest = l;
  newest = l;
  unsent += l->size;
  return 1;
}

int ranks_send(int to, int tag, void *data, size_t size)
{
  letter *l = malloc(sizeof *l);
  if (l == NULL || size > INT_MAX) {
    free(l);
    free(data);
    return 0;
  }
  *l = (letter){ .data = data, .size = size };
  for (int idle = 0;; ranks_nap(&idle, WAIT_OFTEN)) {
    pthread_mutex_lock(&lock);
    const int now = drop_sent() || unsent + size <= FARM_MOST_WAITING;
    const int sent = now && post(l, to, tag);
    pthread_mutex_unlock(&lock);
    if (now) return sent;
  }
}

void ranks_flush(void)
{
  for (int idle = 0;; ranks_nap(&idle, WAIT_OFTEN)) {
    pthread_mutex_lock(&lock);
    const int all_left = drop_sent();
    pthread_mutex_unlock(&lock);
    if (all_left) return;
  }
}

int ranks_receive(int tag, ranks_parcel *out)
{
  MPI_Status status;
  MPI_Request request;
  int there = 0, size = 0, code = MPI_SUCCESS;
  *out = (ranks_parcel){ 0 };
  pthread_mutex_lock(&lock);
  (void)drop_sent();
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
