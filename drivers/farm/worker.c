/* worker.c -- a thread with its context and task; see worker.h. */
#include "farm/worker.h"

#include <stdio.h>
#include <stdlib.h>

#include "farm/dispatch.h"

/* A thread with its task, for the check whether to continue it. */
typedef struct worker {
  pool *pool;
  size_t task;
  pendres_context *ctx; /* that its task computes with */
  farm_watch watch; /* of the point that it computes */
} worker;

/* A long task moves as the drive periods do that it has taken; those on other threads count when
   they are done. */
static void tick(progress *p, size_t finished, at_work *w, double seconds)
{
  char name[POINT_NAME + 40];
  const long long periods = atomic_load(&w->periods);
  snprintf(name, sizeof name, "%s", w->name);
  if (periods > 0)
    snprintf(name, sizeof name, "%s (%.3g drive periods)", w->name, (double)periods);
  progress_tick(p, finished, name, seconds);
}

/* If nothing has been reported for a long time, report what is being computed. */
static void look_at_clock(pool *c, long long t)
{
  progress *p = c->farm->options.progress;
  if (p == NULL || t < atomic_load(&c->look)) return;
  pthread_mutex_lock(&c->lock);
  at_work *first = NULL;
  for (int i = 0; i < c->threads; i++) {
    at_work *w = &c->bench[i];
    if (w->since > 0 && (first == NULL || w->since < first->since)) first = w;
  }
  if (first != NULL && t >= atomic_load(&c->look))
    tick(p, c->finished, first, 1e-3 * (double)(t - first->since));
  atomic_store(&c->look, t + (p->every < 4.0 ? 1 : 1000));
  pthread_mutex_unlock(&c->lock);
}

/* A thread begins a task, or has ended it: since is 0. */
static void note_work(pool *c, int thread, size_t task, long long since)
{
  pthread_mutex_lock(&c->lock);
  at_work *w = &c->bench[thread];
  w->since = since;
  atomic_store(&w->periods, 0);
  snprintf(w->name, sizeof w->name, "number %zu", task);
  pthread_mutex_unlock(&c->lock);
}

/* Stop at a signal, where an earlier task has failed already, and where a budget has come to its
   end. */
static int worker_stop(void *arg)
{
  worker *w = arg;
  pool *c = w->pool;
  const long long now = pool_milliseconds();
  pendres_cost cost;
  pendres_context_cost(w->ctx, &cost);
  if (cost.pendulum_periods >= 0.0) /* NaN: asked on another thread than the context's */
    atomic_store(&c->bench[w->watch.thread].periods, (long long)cost.pendulum_periods);
  look_at_clock(c, now);
  return farm_stop(c->farm) || w->task > atomic_load(&c->limit) || atomic_load(&c->halted) ||
         point_over(&w->watch, now);
}

/* What a context has spent outside of tasks goes to the farm's sum: the next is a task's. */
static void settle_books(farm *f, pendres_context *ctx)
{
  pendres_cost cost;
  pendres_context_cost(ctx, &cost);
  pendres_context_cost_reset(ctx);
  farm_spend(f, &cost);
}

/* Run a task; its record then holds what it has cost, and why it failed. */
static pendres_status run_task(pool *c, worker *w, pendres_context *ctx, farm_record *record)
{
  task_state state = { .farm = c->farm, .lock = &c->lock, .journal = c->journal,
                       .stage = c->number, .task = w->task };
  *record = (farm_record){ 0 };
  if (farm_record_resize(record, c->stage->record_size) == NULL) return PENDRES_OUT_OF_MEMORY;
  settle_books(c->farm, ctx);
  w->ctx = ctx;
  record->watch = c->farm->trial == NULL ? &w->watch : NULL;
  pendres_context_set_interrupt(ctx, worker_stop, w);
  state_begin(&state, ctx);
  const pendres_status status = c->stage->task(c->stage->arg, w->task, ctx, record);
  state_end(&state, ctx);
  point_end(&w->watch);
  record->watch = NULL;
  pendres_context_cost(ctx, &record->cost);
  pendres_context_cost_reset(ctx);
  farm_spend(c->farm, &record->cost);
  if (status != PENDRES_OK && record->message[0] == '\0')
    snprintf(record->message, sizeof record->message, "%s", pendres_context_message(ctx));
  return status;
}

/* The same on a thread of the pool, with its context; a task that has all threads for itself with
   the one that may use them. */
static pendres_status run_on(pool *c, worker *w, farm_record *record)
{
  pendres_context *ctx = NULL;
  const int alone = c->threads == 1 && !c->stage->timed;
  const int number = alone ? c->farm->threads : w->watch.thread;
  pendres_status status = farm_context_of(c->farm, number, &ctx);
  note_work(c, w->watch.thread, w->task, pool_milliseconds());
  if (status == PENDRES_OK) status = run_task(c, w, ctx, record);
  note_work(c, w->watch.thread, w->task, 0);
  if (ctx != NULL) pendres_context_set_interrupt(ctx, farm_stopped, c->farm);
  return status;
}

pendres_status worker_try(pool *c, size_t task, farm_record *record)
{
  worker w = { .pool = c, .task = task, .watch = { .pool = c } };
  return run_on(c, &w, record);
}

void worker_run(pool *c, int thread)
{
  worker w = { .pool = c, .watch = { .pool = c, .thread = thread } };
  while (dispatch_take(c, thread, &w.task)) {
    farm_record record = { 0 };
    const pendres_status status = run_on(c, &w, &record);
    dispatch_finish(c, w.task, status, &record);
    free(record.data);
  }
}
