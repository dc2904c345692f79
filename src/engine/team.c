/* team.c -- one call's work on several threads; see team.h. */
#include "engine/team.h"

#include <pthread.h>
#include <stdlib.h>

#include <pendres/parts.h>

#include "engine/context_internal.h"

typedef struct team {
  pendres_context *of;
  pendres_status (*work)(pendres_context *ctx, size_t first, size_t count, void *arg);
  void *arg;
  pthread_mutex_t lock; /* of the caller's function for interrupts, and of the cost */
  pendres_cost cost;    /* sums of whole numbers, in whatever order */
} team;

static int stops(void *arg)
{
  team *t = arg;
  (void)pthread_mutex_lock(&t->lock);
  const int stopped = pendres_context_stops(t->of);
  (void)pthread_mutex_unlock(&t->lock);
  return stopped;
}

/* Some items, with a context that computes as the caller's does: in its units, if a door is
   open. */
static pendres_status do_some(pendres_context *ctx, size_t first, size_t count, void *arg)
{
  team *t = arg;
  pendres_cost cost;
  ctx->options = t->of->options;
  ctx->options.threads = 1;
  ctx->tolerance_given = t->of->tolerance_given;
  ctx->canonical = t->of->canonical;
  ctx->stop = stops;
  ctx->stop_arg = t;
  pendres_context_cost_reset(ctx);
  const pendres_status status = t->work(ctx, first, count, t->arg);
  pendres_context_cost(ctx, &cost);
  (void)pthread_mutex_lock(&t->lock);
  t->cost.pendulum_periods += cost.pendulum_periods;
  t->cost.rhs_evaluations += cost.rhs_evaluations;
  t->cost.steps += cost.steps;
  t->cost.newton_steps += cost.newton_steps;
  t->cost.settled_pendulums += cost.settled_pendulums;
  (void)pthread_mutex_unlock(&t->lock);
  return status;
}

static pendres_status run_alone(pendres_context *ctx, size_t n, size_t each, const team *t)
{
  pendres_status status = PENDRES_OK;
  for (size_t first = 0; first < n && status == PENDRES_OK; first += each)
    status = t->work(ctx, first, n - first < each ? n - first : each, t->arg);
  return status;
}

pendres_status pendres_team_run(pendres_context *ctx, size_t n, size_t each,
                                pendres_status (*work)(pendres_context *ctx, size_t first,
                                                       size_t count, void *arg),
                                void *arg)
{
  char why[PENDRES_MESSAGE_LENGTH] = "";
  team t = {.of = ctx, .work = work, .arg = arg};
  const pendres_parts how = {.n = n, .each = each, .threads = ctx->options.threads};
  if (how.threads == 1 || n <= each || pthread_mutex_init(&t.lock, NULL) != 0)
    return run_alone(ctx, n, each, &t);
  const pendres_status status = pendres_parts_run(&how, do_some, &t, why, sizeof why);
  (void)pthread_mutex_destroy(&t.lock);
  ctx->cost.pendulum_periods += t.cost.pendulum_periods;
  ctx->cost.rhs_evaluations += t.cost.rhs_evaluations;
  ctx->cost.steps += t.cost.steps;
  ctx->cost.newton_steps += t.cost.newton_steps;
  ctx->cost.settled_pendulums += t.cost.settled_pendulums;
  return status == PENDRES_OK ? status : pendres_context_fail(ctx, status, "%s", why);
}
