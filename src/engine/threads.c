/* threads.c -- one call's work on several threads; see threads.h. */
#define _POSIX_C_SOURCE 200809L /* pthread_sigmask */
#include "engine/threads.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include "engine/context_internal.h"
#include "engine/sundials/lanes.h"

typedef struct job {
  pendres_context *of;
  pendres_status (*work)(pendres_context *ctx, size_t first, size_t count, void *arg);
  void *arg;
  size_t n, each;
  double left;          /* evaluations of the slope that may still be made; INFINITY: any number */
  pthread_mutex_t lock; /* of the caller's function for interrupts, and of all below */
  size_t next;          /* the next item */
  size_t failed;        /* item of the status and the message */
  pendres_status status;
  char message[PENDRES_MESSAGE_LENGTH];
} job;

static int stops(void *arg)
{
  job *j = arg;
  (void)pthread_mutex_lock(&j->lock);
  const int stopped = pendres_context_stops(j->of);
  (void)pthread_mutex_unlock(&j->lock);
  return stopped;
}

/* Take the next items, in ascending order, so that the first failure is always the same; 0 if there
   are none left, or some have failed. */
static int begin(job *j, size_t *first)
{
  (void)pthread_mutex_lock(&j->lock);
  const int some = j->status == PENDRES_OK && j->next < j->n;
  *first = j->next;
  if (some) j->next += j->each;
  (void)pthread_mutex_unlock(&j->lock);
  return some;
}

static void fail(job *j, size_t first, pendres_status status, const char *why)
{
  (void)pthread_mutex_lock(&j->lock);
  if (j->status == PENDRES_OK || first < j->failed) {
    j->status = status;
    j->failed = first;
    (void)snprintf(j->message, sizeof j->message, "%s",
                   why != NULL && why[0] != '\0' ? why : pendres_status_message(status));
  }
  (void)pthread_mutex_unlock(&j->lock);
}

/* Let a context compute as the caller's does: in its units, if a door is open. */
static void configure(job *j, pendres_context *ctx)
{
  ctx->options = j->of->options;
  ctx->options.threads = 1;
  ctx->tolerance_given = j->of->tolerance_given;
  ctx->canonical = j->of->canonical;
  ctx->stop = stops;
  ctx->stop_arg = j;
  pendres_context_cost_reset(ctx);
  ctx->most_slopes = pendres_context_slopes(ctx) + j->left;
}

/* What it has spent is the caller's: sums of whole numbers, in whatever order. */
static void account(const pendres_context *ctx, pendres_cost *to)
{
  pendres_cost cost;
  pendres_context_cost(ctx, &cost);
  pendres_cost_add(to, 1.0, &cost);
}

/* One of the threads. */
typedef struct worker {
  job *of;
  pendres_context *ctx;
  pthread_t thread;
} worker;

/* Do items until there are none. */
static void *run_worker(void *arg)
{
  const worker *w = arg;
  job *j = w->of;
  for (size_t first; begin(j, &first);) {
    const size_t left = j->n - first;
    const pendres_status status =
      j->work(w->ctx, first, left < j->each ? left : j->each, j->arg);
    /* A context may still have the message of an earlier failure that ended nothing. */
    const int said = w->ctx->guard.said == status;
    if (status != PENDRES_OK)
      fail(j, first, status, said ? pendres_context_message(w->ctx) : NULL);
  }
  return NULL;
}

static pendres_status run_alone(pendres_context *ctx, const job *j)
{
  pendres_status status = PENDRES_OK;
  for (size_t first = 0; first < j->n && status == PENDRES_OK; first += j->each)
    status = j->work(ctx, first, j->n - first < j->each ? j->n - first : j->each, j->arg);
  return status;
}

/* Provide contexts for as many threads as are of use; fewer, if memory is short. They are kept:
   what they have found out of steps, and their blocks, serve the next time. */
static int provide(pendres_context *ctx, size_t parts)
{
  const size_t most = (size_t)ctx->options.threads;
  const int wanted = (int)(parts < most ? parts : most);
  pendres_options usual = {.block_lanes = ctx->options.block_lanes};
  if (wanted > ctx->workers) {
    pendres_context **grown = realloc(ctx->worker, (size_t)wanted * sizeof *grown);
    if (grown != NULL) ctx->worker = grown;
    while (grown != NULL && ctx->workers < wanted &&
           pendres_context_create(&usual, &ctx->worker[ctx->workers]) == PENDRES_OK)
      ctx->workers++;
  }
  return ctx->workers < wanted ? ctx->workers : wanted;
}

/* The calling thread works, too: if no others can be started, it does everything. */
static void run_together(job *j, int threads, worker *workers)
{
  sigset_t all, before;
  int started = 1;
  for (int i = 0; i < threads; i++) {
    workers[i] = (worker){.of = j, .ctx = j->of->worker[i]};
    configure(j, workers[i].ctx);
  }
  (void)sigfillset(&all);
  (void)pthread_sigmask(SIG_SETMASK, &all, &before);
  while (started < threads &&
         pthread_create(&workers[started].thread, NULL, run_worker, &workers[started]) == 0)
    started++;
  (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
  (void)run_worker(&workers[0]);
  for (int i = 1; i < started; i++) (void)pthread_join(workers[i].thread, NULL);
  for (int i = 0; i < threads; i++) account(workers[i].ctx, &j->of->cost);
}

pendres_status pendres_threads_run(pendres_context *ctx, size_t n, size_t each,
                                   pendres_status (*work)(pendres_context *ctx, size_t first,
                                                          size_t count, void *arg),
                                   void *arg)
{
  job j = {.of = ctx, .work = work, .arg = arg, .n = n, .each = each,
           .left = ctx->most_slopes - pendres_context_slopes(ctx)};
  const int threads =
    ctx->options.threads > 1 && n > each ? provide(ctx, n / each + (n % each > 0)) : 1;
  worker *workers = threads > 1 ? malloc((size_t)threads * sizeof *workers) : NULL;
  if (workers == NULL || pthread_mutex_init(&j.lock, NULL) != 0) {
    free(workers);
    return run_alone(ctx, &j);
  }
  run_together(&j, threads, workers);
  (void)pthread_mutex_destroy(&j.lock);
  free(workers);
  return j.status == PENDRES_OK ? j.status
                                : pendres_context_fail(ctx, j.status, "%s", j.message);
}

size_t pendres_threads_share(const pendres_context *ctx, size_t n)
{
  const size_t threads = (size_t)ctx->options.threads;
  const size_t vectors = (n + PENDRES_LANES_MULTIPLE - 1) / PENDRES_LANES_MULTIPLE;
  return PENDRES_LANES_MULTIPLE * ((vectors + threads - 1) / threads);
}
