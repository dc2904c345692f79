/* farm.c -- tasks on OpenMP threads; see farm.h. */
#include "farm.h"

#include <omp.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

struct farm {
  farm_options options;
  int threads;
  pendres_context **context; /* one a thread, made at its first task */
  char message[512];
};

/* The tasks of one farm_run; whatever is not const changes inside `critical(farm)` alone. */
typedef struct crew {
  farm *farm;
  size_t tasks;
  farm_task *task;
  farm_collect *collect;
  void *arg;
  size_t next;          /* not yet taken */
  size_t finished;
  size_t collected;     /* tasks 0 .. collected-1 */
  int collecting;       /* a thread is at it */
  char *done;
  atomic_size_t limit;  /* the first task that failed; tasks, while there is none */
  pendres_status status;
} crew;

/* A thread at a task, for the question whether to go on with it. */
typedef struct worker {
  const crew *crew;
  size_t task;
} worker;

static int farm_stop(const farm *f)
{
  return f->options.stop != NULL && f->options.stop(f->options.stop_arg);
}

int farm_stopped(void *f)
{
  return farm_stop(f);
}

/* Stop at a signal, and where an earlier task has failed already. */
static int worker_stop(void *arg)
{
  const worker *w = arg;
  return farm_stop(w->crew->farm) || w->task > atomic_load(&w->crew->limit);
}

pendres_status farm_create(const farm_options *options, farm **out)
{
  farm *f = calloc(1, sizeof *f);
  *out = NULL;
  if (f == NULL) return PENDRES_OUT_OF_MEMORY;
  f->options = *options;
  f->threads = options->threads > 0 ? options->threads : omp_get_max_threads();
  f->context = calloc((size_t)f->threads, sizeof(pendres_context *));
  if (f->context == NULL) {
    free(f);
    return PENDRES_OUT_OF_MEMORY;
  }
  *out = f;
  return PENDRES_OK;
}

void farm_free(farm *f)
{
  if (f == NULL) return;
  for (int i = 0; i < f->threads; i++) pendres_context_free(f->context[i]);
  free(f->context);
  free(f);
}

/* The context of a thread; only that thread asks for it. */
static pendres_status context_of(farm *f, int thread, pendres_context **out)
{
  pendres_status status = PENDRES_OK;
  if (f->context[thread] == NULL)
    status = pendres_context_create(&f->options.library, &f->context[thread]);
  *out = f->context[thread];
  return status;
}

static void fail(crew *c, size_t task, pendres_status status, const char *message)
{
  if (task >= atomic_load(&c->limit)) return;
  atomic_store(&c->limit, task);
  c->status = status;
  snprintf(c->farm->message, sizeof c->farm->message, "%s",
           message[0] != '\0' ? message : pendres_status_message(status));
}

static int take(crew *c, size_t *task)
{
  int taken = 0;
#pragma omp critical(farm)
  if (c->next < atomic_load(&c->limit) && !farm_stop(c->farm)) {
    *task = c->next++;
    taken = 1;
  }
  return taken;
}

/* Is it this thread's turn to collect? Only inside the critical section. */
static int may_collect(const crew *c)
{
  return c->collected < atomic_load(&c->limit) && c->done[c->collected];
}

/* Note a task's end, and collect what has become ready while nobody else does. */
static void finish(crew *c, size_t task, pendres_status status, const char *message)
{
  int mine = 0;
#pragma omp critical(farm)
  {
    if (status != PENDRES_OK) {
      fail(c, task, status, message);
    } else {
      c->done[task] = 1;
      progress_step(c->farm->options.progress, ++c->finished);
    }
    mine = !c->collecting && may_collect(c);
    if (mine) c->collecting = 1;
  }
  while (mine) {
    const pendres_status collected =
      c->collect != NULL ? c->collect(c->arg, c->collected) : PENDRES_OK;
#pragma omp critical(farm)
    {
      if (collected != PENDRES_OK) fail(c, c->collected, collected, "");
      else c->collected++;
      mine = may_collect(c);
      c->collecting = mine;
    }
  }
}

static void work(crew *c, int thread)
{
  pendres_context *ctx = NULL;
  worker w = { .crew = c };
  while (take(c, &w.task)) {
    pendres_status status = context_of(c->farm, thread, &ctx);
    if (status == PENDRES_OK) {
      pendres_context_set_interrupt(ctx, worker_stop, &w);
      status = c->task(c->arg, w.task, ctx);
    }
    finish(c, w.task, status, pendres_context_message(ctx));
  }
  if (ctx != NULL) pendres_context_set_interrupt(ctx, farm_stopped, c->farm);
}

pendres_status farm_run(farm *f, const char *what, size_t tasks, farm_task *task,
                        farm_collect *collect, void *arg)
{
  crew c = { .farm = f, .tasks = tasks, .task = task, .collect = collect, .arg = arg };
  const int threads = tasks < (size_t)f->threads ? (int)tasks : f->threads;
  f->message[0] = '\0';
  if (tasks == 0) return PENDRES_OK;
  atomic_init(&c.limit, tasks);
  c.done = calloc(tasks, 1);
  if (c.done == NULL) {
    snprintf(f->message, sizeof f->message, "out of memory for %zu %s", tasks, what);
    return PENDRES_OUT_OF_MEMORY;
  }
  progress_start(f->options.progress, what, tasks);
#pragma omp parallel num_threads(threads) default(none) shared(c)
  work(&c, omp_get_thread_num());
  progress_end(f->options.progress);
  free(c.done);
  if (c.status == PENDRES_OK && c.collected < tasks) {
    snprintf(f->message, sizeof f->message, "interrupted after %zu of %zu %s", c.collected, tasks,
             what);
    c.status = PENDRES_INTERRUPTED;
  }
  return c.status;
}

const char *farm_message(const farm *f)
{
  return f->message;
}

pendres_context *farm_context(farm *f)
{
  pendres_context *ctx = NULL;
  if (context_of(f, 0, &ctx) == PENDRES_OK)
    pendres_context_set_interrupt(ctx, farm_stopped, f);
  return ctx;
}

int farm_threads(const farm *f)
{
  return f->threads;
}

void farm_cost(const farm *f, pendres_cost *cost)
{
  *cost = (pendres_cost){ 0 };
  for (int i = 0; i < f->threads; i++) {
    pendres_cost one = { 0 };
    if (f->context[i] == NULL) continue;
    pendres_context_cost(f->context[i], &one);
    cost->pendulum_periods += one.pendulum_periods;
    cost->rhs_evaluations += one.rhs_evaluations;
    cost->steps += one.steps;
    cost->newton_steps += one.newton_steps;
    cost->settled_pendulums += one.settled_pendulums;
  }
}
