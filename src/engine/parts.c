/*
 * parts.c -- work on several threads, each with a context of its own; see <pendres/parts.h>.
 *
 * The calling thread works, too: if no others can be started, it does everything. Parts begin
 * in ascending order, so that all before a failed one have begun and end, and the first failed part
 * does not depend on which thread was faster.
 */
#define _GNU_SOURCE /* sched_getaffinity */
#include <pendres/parts.h>

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include "engine/numbers.h"

enum { PARTS_EACH = 4096 };

typedef struct pool {
  const pendres_parts *how;
  pendres_status (*work)(pendres_context *ctx, size_t first, size_t count, void *arg);
  void *arg;
  size_t each, parts;
  pthread_mutex_t lock; /* of all below */
  size_t next;          /* the next part to be begun */
  size_t failed;        /* part of the status and the message */
  pendres_status status;
  char *message;
  size_t size;
} pool;

static void say(char *message, size_t size, const char *text)
{
  if (size > 0) (void)snprintf(message, size, "%s", text);
}

/* Take the next part; 0 if there is none left, or one has failed. */
static int begin(pool *c, size_t *part)
{
  (void)pthread_mutex_lock(&c->lock);
  const int some = c->status == PENDRES_OK && c->next < c->parts;
  if (some) *part = c->next++;
  (void)pthread_mutex_unlock(&c->lock);
  return some;
}

static void fail(pool *c, size_t part, pendres_status status, const char *why)
{
  (void)pthread_mutex_lock(&c->lock);
  if (c->status == PENDRES_OK || part < c->failed) {
    c->status = status;
    c->failed = part;
    if (c->size > 0)
      (void)snprintf(c->message, c->size, "part from %zu on: %s", part * c->each,
                     why != NULL && why[0] != '\0' ? why : pendres_status_message(status));
  }
  (void)pthread_mutex_unlock(&c->lock);
}

/* Do parts until there are none. Of a thread's own failures only the lack of a context is
   reported. */
static pendres_status labour(pool *c)
{
  pendres_context *ctx = NULL;
  size_t part = 0;
  const pendres_status status = pendres_context_create(&c->how->options, &ctx);
  if (status != PENDRES_OK) return status;
  while (begin(c, &part)) {
    const size_t first = part * c->each, left = c->how->n - first;
    const pendres_status outcome = c->work(ctx, first, left < c->each ? left : c->each, c->arg);
    if (outcome != PENDRES_OK) fail(c, part, outcome, pendres_context_message(ctx));
  }
  pendres_context_free(ctx);
  return PENDRES_OK;
}

/* A thread without a context leaves the parts to the others. */
static void *hand(void *arg)
{
  (void)labour(arg);
  return NULL;
}

int pendres_parts_threads(void)
{
  enum { MOST_PROCESSORS = 1 << 20 };
  /* A set of the usual size has room for 1024. The system tells that a set is too small for it. */
  for (size_t room = CPU_SETSIZE; room <= MOST_PROCESSORS; room *= 2) {
    cpu_set_t *set = CPU_ALLOC(room);
    if (set == NULL) break;
    const size_t size = CPU_ALLOC_SIZE(room);
    const int told = sched_getaffinity(0, size, set) == 0;
    const int count = told ? CPU_COUNT_S(size, set) : 0;
    CPU_FREE(set);
    if (told) return count < PARTS_MOST_THREADS ? count : PARTS_MOST_THREADS;
  }
  return 1;
}

static size_t threads_of(const pool *c)
{
  const size_t threads =
    (size_t)(c->how->threads > 0 ? c->how->threads : pendres_parts_threads());
  return threads < c->parts ? threads : c->parts;
}

static void run(pool *c)
{
  const size_t most = threads_of(c);
  pthread_t *threads = calloc(most + 1, sizeof *threads);
  sigset_t all, before;
  size_t hired = 0;
  (void)sigfillset(&all);
  (void)pthread_sigmask(SIG_SETMASK, &all, &before);
  while (threads != NULL && hired + 1 < most &&
         pthread_create(&threads[hired], NULL, hand, c) == 0)
    hired++;
  (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
  const pendres_status own = labour(c);
  for (size_t i = 0; i < hired; i++) (void)pthread_join(threads[i], NULL);
  if (own != PENDRES_OK && c->status == PENDRES_OK && c->next < c->parts)
    fail(c, c->parts, own, NULL); /* no thread had a context */
  free(threads);
}

pendres_status pendres_parts_run(const pendres_parts *how,
                                 pendres_status (*work)(pendres_context *ctx, size_t first,
                                                        size_t count, void *arg),
                                 void *arg, char *message, size_t size)
{
  const char *why = how == NULL || work == NULL ? "nothing to do"
                    : how->threads < 0 || how->threads > PARTS_MOST_THREADS
                      ? "the number of threads must be from 0 to 4096"
                      : pendres_options_check(&how->options);
  pool c = {.how = how, .work = work, .arg = arg, .message = message, .size = size};
  if (message == NULL && size > 0) return PENDRES_INVALID_ARGUMENT;
  say(message, size, why != NULL ? why : "");
  if (why != NULL) return PENDRES_INVALID_ARGUMENT;
  if (how->n == 0) return PENDRES_OK;
  c.each = how->each > 0 ? how->each : PARTS_EACH;
  c.parts = how->n / c.each + (how->n % c.each > 0);
  if (pthread_mutex_init(&c.lock, NULL) != 0) {
    say(message, size, "out of memory for threads");
    return PENDRES_OUT_OF_MEMORY;
  }
  run(&c);
  (void)pthread_mutex_destroy(&c.lock);
  return c.status;
}
