/* pool.c -- the tasks of a stage on threads; see farm.h. */
#include "farm/pool_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "farm/dispatch.h"
#include "system/clock.h"

/* Whether a task's record is there: in memory; in the journal alone, from this run or from an
   earlier one; or another shard's to compute. */
enum { NOT_DONE, DONE, KEPT, JOURNALED, OTHERS };

enum { FOREIGN = 500 /* room for what is said of a record that is refused */ };

/* A thread with its task, for the check whether to continue it. */
typedef struct worker {
  pool *pool;
  size_t task;
  pendres_context *ctx; /* that its task computes with */
  farm_watch watch; /* of the point that it computes */
} worker;

long long pool_milliseconds(void)
{
  return (long long)(1e3 * clock_wall());
}

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

void pool_tell(pool *c, const char *words)
{
  pthread_mutex_lock(&c->lock);
  progress_note(c->farm->options.progress, "%s", words);
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

/* ---- a stage ------------------------------------------------------------------------------- */

static void fail(pool *c, size_t task, pendres_status status, const char *message)
{
  if (task >= atomic_load(&c->limit)) return;
  atomic_store(&c->limit, task);
  c->status = status;
  snprintf(c->farm->message, sizeof c->farm->message, "%s",
           message[0] != '\0' ? message : pendres_status_message(status));
}

int pool_take(pool *c, size_t *task)
{
  pthread_mutex_lock(&c->lock);
  while (c->next < c->stage->tasks && c->done[c->next] != NOT_DONE) c->next++;
  const int taken = c->next < atomic_load(&c->limit) && !farm_stop(c->farm);
  if (taken) *task = c->next++;
  pthread_mutex_unlock(&c->lock);
  return taken;
}

/* Is it this thread's turn to collect? Only under the lock. */
static int may_collect(const pool *c)
{
  const char done = c->collected < c->stage->tasks ? c->done[c->collected] : NOT_DONE;
  return c->collected < atomic_load(&c->limit) && done != NOT_DONE && done != OTHERS;
}

/* The only place where records are checked before they are used. A record that was never on disk is
   this program's own. */
static int fits(const pool *c, size_t task, const farm_record *record)
{
  const farm_stage *s = c->stage;
  if (c->journal == NULL) return 1;
  return s->check != NULL ? s->check(s->arg, task, record) : record->size == s->record_size;
}

/* A record that no run of this deck and build can have written. */
static void tell_foreign(const pool *c, size_t task, char words[FOREIGN])
{
  const char *file = journal_place(c->journal, c->number, task);
  snprintf(words, FOREIGN, "the record of %s number %zu in '%.200s' is of another size, or numbers "
           "in it are out of range: it was not written by a run of this deck; without that file it "
           "is computed again", c->stage->what, task, file != NULL ? file : "memory");
}

/* Pass the next record to collect(), without the lock: other threads continue their tasks. */
static pendres_status collect_next(pool *c, char words[FOREIGN])
{
  kept *k = &c->record[c->collected];
  farm_record record = { .data = k->data, .size = k->size };
  pendres_status status = PENDRES_OK;
  if (c->done[c->collected] != DONE) {
    status = journal_read(c->journal, c->number, c->collected, &record);
    if (status != PENDRES_OK) return status;
    if (c->done[c->collected] == JOURNALED) farm_spend(c->farm, &record.cost);
  }
  if (!fits(c, c->collected, &record)) status = PENDRES_INVALID_ARGUMENT;
  if (status == PENDRES_OK) dispatch_share(c, c->collected, &record);
  if (status == PENDRES_OK && c->stage->collect != NULL)
    status = c->stage->collect(c->stage->arg, c->collected, &record);
  if (status == PENDRES_INVALID_ARGUMENT && c->journal != NULL)
    tell_foreign(c, c->collected, words);
  free(record.data);
  *k = (kept){ 0 };
  return status;
}

/*
 * Keep a finished task's record on disk; 0 if it is not there. Then the run goes on without, but
 * not as a shard, of which the journal is all that stays. What a budget has ended is to be computed
 * again, and so is what has read it.
 */
static int keep(pool *c, size_t task, farm_record *record, pendres_status *status)
{
  char words[JOURNAL_WORDS];
  if (c->journal == NULL || record->lost > 0 || (c->stage->chained && c->farm->lost > 0)) return 0;
  if (journal_append(c->journal, c->number, task, record, words) == PENDRES_OK) return 1;
  if (c->others > 0) {
    *status = PENDRES_IO;
    snprintf(record->message, sizeof record->message, "%.500s", words);
  }
  if (c->others == 0 && words[0] != '\0') farm_tell_unkept(c->farm, &c->lock, words);
  return 0;
}

/* Note a finished task's record: in memory, unless it would wait there for long. Under the lock. */
static void note_record(pool *c, size_t task, farm_record *record, int on_disk)
{
  const int long_way = c->others > 0 || c->waiting + record->size > FARM_MOST_WAITING;
  c->farm->lost += record->lost;
  c->done[task] = on_disk && long_way && task != c->collected ? KEPT : DONE;
  if (c->done[task] == DONE) {
    c->record[task] = (kept){ record->data, record->size };
    c->waiting += record->size;
    record->data = NULL;
  }
  progress_step(c->farm->options.progress, ++c->finished);
}

/* Collect what has become ready unless another thread does. */
static void collect_ready(pool *c)
{
  pthread_mutex_lock(&c->lock);
  const int mine = !c->collecting && may_collect(c);
  if (mine) c->collecting = 1;
  while (mine && c->collecting) {
    const size_t size = c->record[c->collected].size;
    char words[FOREIGN] = "";
    pthread_mutex_unlock(&c->lock);
    const pendres_status collected = collect_next(c, words);
    pthread_mutex_lock(&c->lock);
    c->waiting -= size;
    if (collected != PENDRES_OK) fail(c, c->collected, collected, words);
    else c->collected++;
    c->collecting = may_collect(c);
  }
  pthread_mutex_unlock(&c->lock);
}

void pool_finish(pool *c, size_t task, pendres_status status, farm_record *record)
{
  const int on_disk = status == PENDRES_OK && keep(c, task, record, &status);
  pthread_mutex_lock(&c->lock);
  if (status != PENDRES_OK) fail(c, task, status, record->message);
  else note_record(c, task, record, on_disk);
  pthread_mutex_unlock(&c->lock);
  collect_ready(c);
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

pendres_status pool_try(pool *c, size_t task, farm_record *record)
{
  worker w = { .pool = c, .task = task, .watch = { .pool = c } };
  return run_on(c, &w, record);
}

static void work(pool *c, int thread)
{
  worker w = { .pool = c, .watch = { .pool = c, .thread = thread } };
  while (dispatch_take(c, thread, &w.task)) {
    farm_record record = { 0 };
    const pendres_status status = run_on(c, &w, &record);
    dispatch_finish(c, w.task, status, &record);
    free(record.data);
  }
}

/* A thread beside the calling one. */
typedef struct helper {
  pool *pool;
  int number;
  pthread_t thread;
} helper;

static void *run_helper(void *arg)
{
  const helper *h = arg;
  pthread_mutex_lock(&h->pool->lock); /* until it is known how many there are */
  const int needed = h->number < h->pool->hired;
  pthread_mutex_unlock(&h->pool->lock);
  if (needed) work(h->pool, h->number);
  return NULL;
}

/*
 * Work with `threads` threads, or with fewer if not all can be started: the results are the
 * same. Usually memory is exhausted: half of the threads then end, and leave theirs to the others.
 */
static void run_together(pool *c, int threads, helper *helpers)
{
  int started = 1, error = 0;
  pthread_mutex_lock(&c->lock);
  while (started < threads && error == 0) {
    helpers[started] = (helper){ .pool = c, .number = started };
    error = farm_start_thread(&helpers[started].thread, run_helper, &helpers[started]);
    if (error == 0) started++;
  }
  c->hired = error == 0 ? started : (started + 1) / 2;
  pthread_mutex_unlock(&c->lock);
  for (int i = c->hired; i < started; i++) (void)pthread_join(helpers[i].thread, NULL);
  if (error != 0) {
    progress_note(c->farm->options.progress, "going on with %d of %d threads: %s", c->hired,
                  threads, strerror(error));
    c->farm->short_of = c->hired;
  }
  work(c, 0);
  for (int i = 1; i < c->hired; i++) (void)pthread_join(helpers[i].thread, NULL);
}

/* What is in the journal already, and what is left to other shards. */
static void look_up(pool *c)
{
  const farm_share *s = &c->farm->share;
  const int apart = !c->stage->cheap && !c->stage->timed && !c->stage->chained;
  const int shared = s->shards > 1 && apart;
  for (size_t i = 0; i < c->stage->tasks; i++) {
    if (journal_has(c->journal, c->number, i)) c->done[i] = JOURNALED;
    else if (shared && (i + c->farm->slice) % s->shards != s->shard) c->done[i] = OTHERS;
    c->finished += c->done[i] == JOURNALED;
    c->others += c->done[i] == OTHERS;
  }
}

/* Where shards are put together, they must have completed the first stage that was divided; records
   of later stages are used if they exist. */
static pendres_status check_complete(pool *c)
{
  const size_t tasks = c->stage->tasks;
  if (!c->farm->share.complete || c->stage->cheap) return PENDRES_OK;
  c->farm->share.complete = 0;
  if (c->finished == tasks) return PENDRES_OK;
  snprintf(c->farm->message, sizeof c->farm->message, "%zu of %zu %s are in no journal: some "
           "shard has not finished. Run it again with --resume, or compute what is missing with "
           "--merge --resume", tasks - c->finished, tasks, c->stage->what);
  return PENDRES_NOT_FOUND;
}

/* How a stage has ended. */
static pendres_status outcome(pool *c)
{
  farm *f = c->farm;
  if (atomic_load(&c->ended)) return dispatch_outcome(c);
  if (c->status != PENDRES_OK || c->collected == c->stage->tasks) return c->status;
  f->left = c->others > 0 && c->finished + c->others == c->stage->tasks;
  snprintf(f->message, sizeof f->message, "interrupted after %zu of %zu %s", c->finished,
           c->stage->tasks, c->stage->what);
  return PENDRES_INTERRUPTED;
}

pendres_status pool_create(pool *c, farm *f, const farm_stage *stage, int threads)
{
  *c = (pool){ .farm = f, .stage = stage,
               .number = journal_stage(f->stages, stage->what, stage->tasks, stage->record_size),
               .journal = stage->timed || f->lost > 0 ? NULL : f->journal };
  atomic_init(&c->limit, stage->tasks);
  c->done = calloc(stage->tasks, 1);
  c->record = calloc(stage->tasks, sizeof *c->record);
  c->bench = calloc((size_t)threads, sizeof *c->bench);
  c->threads = threads;
  if (c->done != NULL && c->record != NULL && c->bench != NULL &&
      pthread_mutex_init(&c->lock, NULL) == 0) {
    look_up(c);
    return PENDRES_OK;
  }
  free(c->done);
  free(c->record);
  free(c->bench);
  return PENDRES_OUT_OF_MEMORY;
}

void pool_free(pool *c)
{
  for (size_t i = c->collected; i < c->stage->tasks; i++) free(c->record[i].data);
  free(c->record);
  free(c->done);
  free(c->bench);
  (void)pthread_mutex_destroy(&c->lock);
}

/* As many threads as are of use to a stage. */
static int threads_for(const farm *f, const farm_stage *stage)
{
  const int most = f->short_of > 0 ? f->short_of : f->threads;
  if (stage->timed || stage->chained) return 1;
  return stage->tasks < (size_t)most ? (int)stage->tasks : most;
}

pendres_status farm_run(farm *f, const farm_stage *of)
{
  pool c;
  farm_stage own = *of;
  const farm_stage *stage = &own;
  const int threads = threads_for(f, stage);
  if (f->more) own.last = 0;
  f->message[0] = '\0';
  if (stage->tasks == 0) return PENDRES_OK;
  if (f->trial != NULL) return trial_run(f, stage);
  helper *helpers = calloc((size_t)threads, sizeof *helpers);
  if (helpers == NULL || pool_create(&c, f, stage, threads) != PENDRES_OK) {
    free(helpers);
    snprintf(f->message, sizeof f->message, "out of memory for %zu %s", stage->tasks, stage->what);
    return PENDRES_OUT_OF_MEMORY;
  }
  pendres_status status = check_complete(&c);
  if (status == PENDRES_OK) {
    progress_start(f->options.progress, stage->what, stage->tasks - c.others, c.finished);
    status = dispatch_begin(&c);
    if (status == PENDRES_OK) {
      collect_ready(&c);
      run_together(&c, threads, helpers);
      dispatch_end(&c);
      status = outcome(&c);
    }
    progress_end(f->options.progress);
  }
  pool_free(&c);
  free(helpers);
  f->stages++;
  return status;
}
