/* contexts.c -- a farm, its contexts and costs; see farm.h. stage.c runs its tasks. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "farm/internal.h"
#include "farm/ranks.h"
#include "farm/trial.h"
#include "system/clock.h"

int farm_stop(const farm *f)
{
  const farm_trial *t = f->trial;
  if (t != NULL && clock_process() - t->start > t->until) return 1;
  return f->options.stop != NULL && f->options.stop(f->options.stop_arg);
}

int farm_stopped(void *f)
{
  return farm_stop(f);
}

pendres_status farm_create(const farm_options *options, farm **out)
{
  farm *f = calloc(1, sizeof *f);
  *out = NULL;
  if (f == NULL) return PENDRES_OUT_OF_MEMORY;
  f->options = *options;
  f->run = options->run;
  f->threads = options->threads > 0 ? options->threads : pendres_parts_threads();
  f->context = calloc((size_t)f->threads + 1, sizeof(pendres_context *));
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
  for (int i = 0; i <= f->threads; i++) pendres_context_free(f->context[i]);
  free(f->context);
  (void)pthread_mutex_destroy(&f->lock);
  free(f);
}

pendres_status farm_context_of(farm *f, int thread, pendres_context **out)
{
  pendres_status status = PENDRES_OK;
  pendres_options library = f->options.library;
  if (thread == f->threads) library.threads = f->threads;
  if (f->context[thread] == NULL)
    status = pendres_context_create(&library, &f->context[thread]);
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

void farm_spend(farm *f, const pendres_cost *cost)
{
  pthread_mutex_lock(&f->lock);
  add_cost(&f->spent, cost);
  pthread_mutex_unlock(&f->lock);
}

int farm_start_thread(pthread_t *thread, void *(*run)(void *), void *arg)
{
  pthread_attr_t attributes;
  int error = pthread_attr_init(&attributes);
  if (error != 0) return error;
  error = pthread_attr_setstacksize(&attributes, FARM_STACK);
  if (error == 0) error = pthread_create(thread, &attributes, run, arg);
  (void)pthread_attr_destroy(&attributes);
  return error;
}

typedef struct call_on_thread {
  int (*run)(void *arg);
  void *arg;
  int result;
} call_on_thread;

static void *run_on_thread(void *arg)
{
  call_on_thread *e = arg;
  e->result = e->run(e->arg);
  return NULL;
}

int farm_run_on_thread(int (*run)(void *arg), void *arg)
{
  call_on_thread e = { run, arg, 0 };
  pthread_t thread;
  if (farm_start_thread(&thread, run_on_thread, &e) != 0) return run(arg);
  (void)pthread_join(thread, NULL);
  return e.result;
}

void farm_set_journal(farm *f, journal *j)
{
  f->journal = j;
}

void farm_set_share(farm *f, farm_share share)
{
  f->share = share;
  f->complete = share.complete;
}

void farm_begin_slice(farm *f, size_t slice, int more)
{
  f->slice = slice;
  f->stages = slice * FARM_SLICE_STAGES;
  f->more = more;
  f->share.complete = f->complete;
}

int farm_sides(const farm *f)
{
  const int alone = ranks_count() == 1 && f->trial == NULL;
  return alone && f->journal != NULL && f->options.budget == 0.0 && !f->complete ? f->threads : 1;
}

farm *farm_aside(const farm *f)
{
  farm *aside = NULL;
  farm_options options = f->options;
  options.threads = 1;
  options.progress = NULL;
  if (farm_create(&options, &aside) != PENDRES_OK) return NULL;
  farm_set_journal(aside, f->journal);
  farm_set_share(aside, f->share);
  return aside;
}

int farm_left_to_shards(const farm *f)
{
  return f->left && f->share.shards > 1;
}

int farm_left(const farm *f)
{
  return f->left;
}

const char *farm_message(const farm *f)
{
  return f->message;
}

/* Asked between stages, when no tasks run; maybe by several threads of the library. */
static int stopped_between(void *arg)
{
  farm *f = arg;
  if (pthread_mutex_trylock(&f->lock) == 0) {
    progress_wait(f->options.progress);
    pthread_mutex_unlock(&f->lock);
  }
  return farm_stop(f);
}

void farm_doing(farm *f, const char *what)
{
  pthread_mutex_lock(&f->lock);
  progress_doing(f->options.progress, what);
  pthread_mutex_unlock(&f->lock);
}

pendres_context *farm_context(farm *f)
{
  pendres_context *ctx = NULL;
  if (farm_context_of(f, f->threads, &ctx) == PENDRES_OK)
    pendres_context_set_interrupt(ctx, stopped_between, f);
  return ctx;
}

int farm_threads(const farm *f)
{
  return f->threads;
}

double farm_budget(const farm *f)
{
  return f->options.budget;
}

size_t farm_points_lost(const farm *f)
{
  return f->lost;
}

void farm_cost(const farm *f, pendres_cost *cost)
{
  *cost = f->spent;
  for (int i = 0; i <= f->threads; i++) {
    pendres_cost one = { 0 };
    if (f->context[i] == NULL) continue;
    pendres_context_cost(f->context[i], &one);
    add_cost(cost, &one);
  }
}
