/* stage.c -- the stages of a run, each with its threads; see farm.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "farm/dispatch.h"
#include "farm/worker.h"

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
  if (needed) worker_run(h->pool, h->number);
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
  worker_run(c, 0);
  for (int i = 1; i < c->hired; i++) (void)pthread_join(helpers[i].thread, NULL);
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
      pool_collect(&c);
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
