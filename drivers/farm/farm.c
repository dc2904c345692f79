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

#include "farm/journal.h"

struct farm {
  farm_options options;
  int threads;
  int short_of;              /* threads that could be had, when there were fewer; else 0 */
  pthread_mutex_t lock;      /* of `spent` */
  pendres_cost spent;        /* but for what the contexts have in their own books */
  pendres_context **context; /* one a thread, made at its first task */
  journal *journal;          /* NULL: none */
  size_t stages;             /* that were run */
  char message[512];
};

/* A record that waits for its turn to be collected. */
typedef struct kept {
  void *data;
  size_t size;
} kept;

/* Whether a task's record is there: in memory, or in the journal alone. */
enum { NOT_DONE, DONE, JOURNALED };

/* The tasks of one farm_run; whatever changes does so under the lock alone, but for `limit`. */
typedef struct crew {
  farm *farm;
  const farm_stage *stage;
  size_t number;        /* of the stage */
  journal *journal;     /* of the stage's records; NULL: none */
  int hired;            /* threads that work; those with higher numbers go home */
  pthread_mutex_t lock;
  size_t next;          /* not yet taken */
  size_t finished;
  size_t collected;     /* tasks 0 .. collected-1 */
  int collecting;       /* a thread is at it */
  char *done;           /* NOT_DONE, ... */
  kept *record;         /* of tasks that are done and not yet collected */
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
  if (f->context == NULL || pthread_mutex_init(&f->lock, NULL) != 0) {
    free(f->context);
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
  (void)pthread_mutex_destroy(&f->lock);
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

/* ---- costs --------------------------------------------------------------------------------- */

static void add_cost(pendres_cost *sum, const pendres_cost *one)
{
  sum->pendulum_periods += one->pendulum_periods;
  sum->rhs_evaluations += one->rhs_evaluations;
  sum->steps += one->steps;
  sum->newton_steps += one->newton_steps;
  sum->settled_pendulums += one->settled_pendulums;
}

static void spend(farm *f, const pendres_cost *cost)
{
  pthread_mutex_lock(&f->lock);
  add_cost(&f->spent, cost);
  pthread_mutex_unlock(&f->lock);
}

/* What a context has spent outside of tasks goes to the farm's sum: the next is a task's. */
static void settle_books(farm *f, pendres_context *ctx)
{
  pendres_cost cost;
  pendres_context_cost(ctx, &cost);
  pendres_context_cost_reset(ctx);
  spend(f, &cost);
}

/* ---- a stage ------------------------------------------------------------------------------- */

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
  while (c->next < c->stage->tasks && c->done[c->next] != NOT_DONE) c->next++;
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

/* Hand the next record over, without the lock: others go on with their tasks meanwhile. */
static pendres_status collect_next(crew *c)
{
  kept *k = &c->record[c->collected];
  farm_record record = { .data = k->data, .size = k->size };
  pendres_status status = PENDRES_OK;
  if (c->done[c->collected] == JOURNALED) {
    status = journal_read(c->journal, c->number, c->collected, &record);
    if (status != PENDRES_OK) return status;
    spend(c->farm, &record.cost);
  }
  if (c->stage->collect != NULL) status = c->stage->collect(c->stage->arg, c->collected, &record);
  free(record.data);
  *k = (kept){ 0 };
  return status;
}

/* Keep a finished task's record on disk; where that fails the run goes on without. */
static void keep(crew *c, size_t task, const farm_record *record)
{
  char words[JOURNAL_WORDS];
  if (c->journal == NULL) return;
  const pendres_status status = journal_append(c->journal, c->number, task, record, words);
  if (status == PENDRES_OK || words[0] == '\0') return;
  pthread_mutex_lock(&c->lock);
  progress_error(c->farm->options.progress, "%s; what is computed from now on is not kept if the "
                   "run is stopped", words);
  pthread_mutex_unlock(&c->lock);
}

/* Collect what has become ready while nobody else does. */
static void collect_ready(crew *c)
{
  pthread_mutex_lock(&c->lock);
  const int mine = !c->collecting && may_collect(c);
  if (mine) c->collecting = 1;
  while (mine && c->collecting) {
    pthread_mutex_unlock(&c->lock);
    const pendres_status collected = collect_next(c);
    pthread_mutex_lock(&c->lock);
    if (collected != PENDRES_OK) fail(c, c->collected, collected, "");
    else c->collected++;
    c->collecting = may_collect(c);
  }
  pthread_mutex_unlock(&c->lock);
}

/* Note a task's end. */
static void finish(crew *c, size_t task, pendres_status status, farm_record *record)
{
  if (status == PENDRES_OK) keep(c, task, record);
  pthread_mutex_lock(&c->lock);
  if (status != PENDRES_OK) {
    fail(c, task, status, record->message);
  } else {
    c->record[task] = (kept){ record->data, record->size };
    record->data = NULL;
    c->done[task] = DONE;
    progress_step(c->farm->options.progress, ++c->finished);
  }
  pthread_mutex_unlock(&c->lock);
  collect_ready(c);
}

/* Run a task; its record then holds what it has cost, and why it failed. */
static pendres_status run_task(crew *c, worker *w, pendres_context *ctx, farm_record *record)
{
  *record = (farm_record){ 0 };
  if (farm_record_resize(record, c->stage->record_size) == NULL) return PENDRES_OUT_OF_MEMORY;
  settle_books(c->farm, ctx);
  pendres_context_set_interrupt(ctx, worker_stop, w);
  const pendres_status status = c->stage->task(c->stage->arg, w->task, ctx, record);
  pendres_context_cost(ctx, &record->cost);
  pendres_context_cost_reset(ctx);
  spend(c->farm, &record->cost);
  if (status != PENDRES_OK && record->message[0] == '\0')
    snprintf(record->message, sizeof record->message, "%s", pendres_context_message(ctx));
  return status;
}

static void work(crew *c, int thread)
{
  pendres_context *ctx = NULL;
  worker w = { .crew = c };
  while (take(c, &w.task)) {
    farm_record record = { 0 };
    pendres_status status = context_of(c->farm, thread, &ctx);
    if (status == PENDRES_OK) status = run_task(c, &w, ctx, &record);
    finish(c, w.task, status, &record);
    free(record.data);
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

/* Room for the records of a stage; free it in any case. */
static pendres_status crew_create(crew *c, farm *f, const farm_stage *stage)
{
  *c = (crew){ .farm = f, .stage = stage, .number = f->stages,
               .journal = stage->timed ? NULL : f->journal };
  atomic_init(&c->limit, stage->tasks);
  c->done = calloc(stage->tasks, 1);
  c->record = calloc(stage->tasks, sizeof *c->record);
  if (c->done != NULL && c->record != NULL && pthread_mutex_init(&c->lock, NULL) == 0) {
    for (size_t i = 0; i < stage->tasks; i++) {
      if (!journal_has(c->journal, c->number, i)) continue;
      c->done[i] = JOURNALED;
      c->finished++;
    }
    return PENDRES_OK;
  }
  free(c->done);
  free(c->record);
  return PENDRES_OUT_OF_MEMORY;
}

static void crew_free(crew *c)
{
  for (size_t i = c->collected; i < c->stage->tasks; i++) free(c->record[i].data);
  free(c->record);
  free(c->done);
  (void)pthread_mutex_destroy(&c->lock);
}

/* As many threads as are of use to a stage. */
static int threads_for(const farm *f, const farm_stage *stage)
{
  const int most = f->short_of > 0 ? f->short_of : f->threads;
  if (stage->timed) return 1;
  return stage->tasks < (size_t)most ? (int)stage->tasks : most;
}

pendres_status farm_run(farm *f, const farm_stage *stage)
{
  crew c;
  const int threads = threads_for(f, stage);
  f->message[0] = '\0';
  if (stage->tasks == 0) return PENDRES_OK;
  hand *hands = calloc((size_t)threads, sizeof *hands);
  if (hands == NULL || crew_create(&c, f, stage) != PENDRES_OK) {
    free(hands);
    snprintf(f->message, sizeof f->message, "out of memory for %zu %s", stage->tasks, stage->what);
    return PENDRES_OUT_OF_MEMORY;
  }
  progress_start(f->options.progress, stage->what, stage->tasks, c.finished);
  collect_ready(&c);
  work_together(&c, threads, hands);
  progress_end(f->options.progress);
  if (c.status == PENDRES_OK && c.collected < stage->tasks) {
    snprintf(f->message, sizeof f->message, "interrupted after %zu of %zu %s", c.collected,
             stage->tasks, stage->what);
    c.status = PENDRES_INTERRUPTED;
  }
  crew_free(&c);
  free(hands);
  f->stages++;
  return c.status;
}

void farm_set_journal(farm *f, journal *j)
{
  f->journal = j;
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
  *cost = f->spent;
  for (int i = 0; i < f->threads; i++) {
    pendres_cost one = { 0 };
    if (f->context[i] == NULL) continue;
    pendres_context_cost(f->context[i], &one);
    add_cost(cost, &one);
  }
}
