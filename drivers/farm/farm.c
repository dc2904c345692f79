/* farm.c -- tasks on threads; see farm.h. */
#define _GNU_SOURCE /* sched_getaffinity */
#include "farm/farm.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct farm {
  farm_options options;
  int threads;
  int short_of;              /* threads that could be had, when there were fewer; else 0 */
  pendres_context **context; /* one a thread, made at its first task */
  char message[512];
};

/* The tasks of one farm_run; whatever changes does so under the lock alone, but for `limit`. */
typedef struct crew {
  farm *farm;
  int hired;            /* threads that work; those with higher numbers go home */
  pthread_mutex_t lock;
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

/* The processors that this process may use. */
static int processors(void)
{
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
  const long online = sysconf(_SC_NPROCESSORS_ONLN); /* more than the set has room for */
  return online > 0 && online <= FARM_MOST_THREADS ? (int)online : 1;
}

pendres_status farm_create(const farm_options *options, farm **out)
{
  farm *f = calloc(1, sizeof *f);
  *out = NULL;
  if (f == NULL) return PENDRES_OUT_OF_MEMORY;
  f->options = *options;
  f->threads = options->threads > 0 ? options->threads : processors();
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
  pthread_mutex_lock(&c->lock);
  const int taken = c->next < atomic_load(&c->limit) && !farm_stop(c->farm);
  if (taken) *task = c->next++;
  pthread_mutex_unlock(&c->lock);
  return taken;
}

/* Is it this thread's turn to collect? Only under the lock. */
static int may_collect(const crew *c)
{
  return c->collected < atomic_load(&c->limit) && c->done[c->collected];
}

/* Note a task's end, and collect what has become ready while nobody else does. */
static void finish(crew *c, size_t task, pendres_status status, const char *message)
{
  pthread_mutex_lock(&c->lock);
  if (status != PENDRES_OK) {
    fail(c, task, status, message);
  } else {
    c->done[task] = 1;
    progress_step(c->farm->options.progress, ++c->finished);
  }
  const int mine = !c->collecting && may_collect(c);
  if (mine) c->collecting = 1;
  while (mine && c->collecting) {
    pthread_mutex_unlock(&c->lock); /* others go on with their tasks meanwhile */
    const pendres_status collected =
      c->collect != NULL ? c->collect(c->arg, c->collected) : PENDRES_OK;
    pthread_mutex_lock(&c->lock);
    if (collected != PENDRES_OK) fail(c, c->collected, collected, "");
    else c->collected++;
    c->collecting = may_collect(c);
  }
  pthread_mutex_unlock(&c->lock);
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

/* A thread beside the calling one. */
typedef struct hand {
  crew *crew;
  int number;
  pthread_t thread;
} hand;

static void *hand_work(void *arg)
{
  const hand *h = arg;
  pthread_mutex_lock(&h->crew->lock); /* until it is known how many there are */
  const int needed = h->number < h->crew->hired;
  pthread_mutex_unlock(&h->crew->lock);
  if (needed) work(h->crew, h->number);
  return NULL;
}

/* A thread with a stack of FARM_STACK bytes, whatever the limits of the process; 0 or an errno. */
static int start_thread(pthread_t *thread, void *(*run)(void *), void *arg)
{
  pthread_attr_t attributes;
  int error = pthread_attr_init(&attributes);
  if (error != 0) return error;
  error = pthread_attr_setstacksize(&attributes, FARM_STACK);
  if (error == 0) error = pthread_create(thread, &attributes, run, arg);
  (void)pthread_attr_destroy(&attributes);
  return error;
}

/*
 * Work with `threads` threads, or with fewer where there cannot be so many: the results are the
 * same. As a rule it is memory that there is no more of: half of them leave theirs to the rest.
 */
static void work_together(crew *c, int threads, hand *hands)
{
  int started = 1, error = 0;
  pthread_mutex_lock(&c->lock);
  while (started < threads && error == 0) {
    hands[started] = (hand){ .crew = c, .number = started };
    error = start_thread(&hands[started].thread, hand_work, &hands[started]);
    if (error == 0) started++;
  }
  c->hired = error == 0 ? started : (started + 1) / 2;
  pthread_mutex_unlock(&c->lock);
  for (int i = c->hired; i < started; i++) (void)pthread_join(hands[i].thread, NULL);
  if (error != 0) {
    progress_note(c->farm->options.progress, "going on with %d of %d threads: %s", c->hired,
                  threads, strerror(error));
    c->farm->short_of = c->hired;
  }
  work(c, 0);
  for (int i = 1; i < c->hired; i++) (void)pthread_join(hands[i].thread, NULL);
}

typedef struct errand {
  int (*run)(void *arg);
  void *arg;
  int result;
} errand;

static void *errand_run(void *arg)
{
  errand *e = arg;
  e->result = e->run(e->arg);
  return NULL;
}

int farm_errand(int (*run)(void *arg), void *arg)
{
  errand e = { run, arg, 0 };
  pthread_t thread;
  if (start_thread(&thread, errand_run, &e) != 0) return run(arg);
  (void)pthread_join(thread, NULL);
  return e.result;
}

pendres_status farm_run(farm *f, const char *what, size_t tasks, farm_task *task,
                        farm_collect *collect, void *arg)
{
  crew c = { .farm = f, .tasks = tasks, .task = task, .collect = collect, .arg = arg };
  const int most = f->short_of > 0 ? f->short_of : f->threads;
  const int threads = tasks < (size_t)most ? (int)tasks : most;
  f->message[0] = '\0';
  if (tasks == 0) return PENDRES_OK;
  atomic_init(&c.limit, tasks);
  c.done = calloc(tasks, 1);
  hand *hands = calloc((size_t)threads, sizeof *hands);
  if (c.done == NULL || hands == NULL || pthread_mutex_init(&c.lock, NULL) != 0) {
    free(c.done);
    free(hands);
    snprintf(f->message, sizeof f->message, "out of memory for %zu %s", tasks, what);
    return PENDRES_OUT_OF_MEMORY;
  }
  progress_start(f->options.progress, what, tasks);
  work_together(&c, threads, hands);
  progress_end(f->options.progress);
  (void)pthread_mutex_destroy(&c.lock);
  free(c.done);
  free(hands);
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

static void add_cost(pendres_cost *sum, const pendres_cost *one)
{
  sum->pendulum_periods += one->pendulum_periods;
  sum->rhs_evaluations += one->rhs_evaluations;
  sum->steps += one->steps;
  sum->newton_steps += one->newton_steps;
  sum->settled_pendulums += one->settled_pendulums;
}

void farm_cost(const farm *f, pendres_cost *cost)
{
  *cost = (pendres_cost){ 0 };
  for (int i = 0; i < f->threads; i++) {
    pendres_cost one = { 0 };
    if (f->context[i] == NULL) continue;
    pendres_context_cost(f->context[i], &one);
    add_cost(cost, &one);
  }
}
