/* team.c -- one call's work on several threads; see team.h. */
#define _POSIX_C_SOURCE 200809L /* pthread_sigmask */
#include "engine/team.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include "engine/context_internal.h"
#include "engine/lanes.h"

typedef struct team {
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
} team;

static int stops(void *arg)
{
  team *t = arg;
  (void)pthread_mutex_lock(&t->lock);
  const int stopped = pendres_context_stops(t->of);
  (void)pthread_mutex_unlock(&t->lock);
  return stopped;
}

/* Take the next items, in ascending order, so that the first failure is always the same; 0 if there
   are none left, or some have failed. */
static int begin(team *t, size_t *first)
{
  (void)pthread_mutex_lock(&t->lock);
  const int some = t->status == PENDRES_OK && t->next < t->n;
  *first = t->next;
  if (some) t->next += t->each;
  (void)pthread_mutex_unlock(&t->lock);
  return some;
}

static void fail(team *t, size_t first, pendres_status status, const char *why)
{
  (void)pthread_mutex_lock(&t->lock);
  if (t->status == PENDRES_OK || first < t->failed) {
    t->status = status;
    t->failed = first;
    (void)snprintf(t->message, sizeof t->message, "%s",
                   why != NULL && why[0] != '\0' ? why : pendres_status_message(status));
  }
  (void)pthread_mutex_unlock(&t->lock);
}

/* Let a context compute as the caller's does: in its units, if a door is open. */
static void instruct(team *t, pendres_context *mate)
{
  mate->options = t->of->options;
  mate->options.threads = 1;
  mate->tolerance_given = t->of->tolerance_given;
  mate->canonical = t->of->canonical;
  mate->stop = stops;
  mate->stop_arg = t;
  pendres_context_cost_reset(mate);
  mate->most_slopes = pendres_context_slopes(mate) + t->left;
}

/* What it has spent is the caller's: sums of whole numbers, in whatever order. */
static void account(const pendres_context *mate, pendres_cost *to)
{
  pendres_cost cost;
  pendres_context_cost(mate, &cost);
  pendres_cost_add(to, 1.0, &cost);
}

/* One of the threads. */
typedef struct hand {
  team *of;
  pendres_context *mate;
  pthread_t thread;
} hand;

/* Do items until there are none. */
static void *labour(void *arg)
{
  const hand *h = arg;
  team *t = h->of;
  for (size_t first; begin(t, &first);) {
    const size_t left = t->n - first;
    const pendres_status status =
      t->work(h->mate, first, left < t->each ? left : t->each, t->arg);
    /* A mate may still have the message of an earlier failure that ended nothing. */
    const int said = h->mate->guard.said == status;
    if (status != PENDRES_OK)
      fail(t, first, status, said ? pendres_context_message(h->mate) : NULL);
  }
  return NULL;
}

static pendres_status run_alone(pendres_context *ctx, const team *t)
{
  pendres_status status = PENDRES_OK;
  for (size_t first = 0; first < t->n && status == PENDRES_OK; first += t->each)
    status = t->work(ctx, first, t->n - first < t->each ? t->n - first : t->each, t->arg);
  return status;
}

/* Provide contexts for as many threads as are of use; fewer, if memory is short. They are kept:
   what they have found out of steps, and their blocks, serve the next time. */
static int provide(pendres_context *ctx, size_t parts)
{
  const size_t most = (size_t)ctx->options.threads;
  const int wanted = (int)(parts < most ? parts : most);
  pendres_options usual = {.block_lanes = ctx->options.block_lanes};
  if (wanted > ctx->mates) {
    pendres_context **grown = realloc(ctx->mate, (size_t)wanted * sizeof *grown);
    if (grown != NULL) ctx->mate = grown;
    while (grown != NULL && ctx->mates < wanted &&
           pendres_context_create(&usual, &ctx->mate[ctx->mates]) == PENDRES_OK)
      ctx->mates++;
  }
  return ctx->mates < wanted ? ctx->mates : wanted;
}

/* The calling thread works, too: if no others can be started, it does everything. */
static void work_together(team *t, int threads, hand *hands)
{
  sigset_t all, before;
  int hired = 1;
  for (int i = 0; i < threads; i++) {
    hands[i] = (hand){.of = t, .mate = t->of->mate[i]};
    instruct(t, hands[i].mate);
  }
  (void)sigfillset(&all);
  (void)pthread_sigmask(SIG_SETMASK, &all, &before);
  while (hired < threads &&
         pthread_create(&hands[hired].thread, NULL, labour, &hands[hired]) == 0)
    hired++;
  (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
  (void)labour(&hands[0]);
  for (int i = 1; i < hired; i++) (void)pthread_join(hands[i].thread, NULL);
  for (int i = 0; i < threads; i++) account(hands[i].mate, &t->of->cost);
}

pendres_status pendres_team_run(pendres_context *ctx, size_t n, size_t each,
                                pendres_status (*work)(pendres_context *ctx, size_t first,
                                                       size_t count, void *arg),
                                void *arg)
{
  team t = {.of = ctx, .work = work, .arg = arg, .n = n, .each = each,
            .left = ctx->most_slopes - pendres_context_slopes(ctx)};
  const int threads =
    ctx->options.threads > 1 && n > each ? provide(ctx, n / each + (n % each > 0)) : 1;
  hand *hands = threads > 1 ? malloc((size_t)threads * sizeof *hands) : NULL;
  if (hands == NULL || pthread_mutex_init(&t.lock, NULL) != 0) {
    free(hands);
    return run_alone(ctx, &t);
  }
  work_together(&t, threads, hands);
  (void)pthread_mutex_destroy(&t.lock);
  free(hands);
  return t.status == PENDRES_OK ? t.status
                                : pendres_context_fail(ctx, t.status, "%s", t.message);
}

size_t pendres_team_share(const pendres_context *ctx, size_t n)
{
  const size_t threads = (size_t)ctx->options.threads;
  const size_t vectors = (n + PENDRES_LANES_MULTIPLE - 1) / PENDRES_LANES_MULTIPLE;
  return PENDRES_LANES_MULTIPLE * ((vectors + threads - 1) / threads);
}
