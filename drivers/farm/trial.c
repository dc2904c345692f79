/* trial.c -- a few tasks of each stage; see trial.h. */
#include "farm/trial.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "farm/internal.h"
#include "system/clock.h"

/* Of a task's record in the journal, beside its data. */
enum { ENTRY = sizeof(journal_entry) };

/* The record of a task that was tried. */
typedef struct trial_record {
  void *data;
  size_t size;
} trial_record;

/* The tasks of a stage that are tried. Time is that of all threads: there are no others then. */
typedef struct stage_trial {
  farm *farm;
  const farm_stage *stage;
  trial_record *record; /* of each task */
  char *tried;
  size_t count, cut;    /* that came to their end, and that the end of the trial cut short */
  double seconds, bytes, changes; /* seconds of both kinds */
  pendres_cost cost;
} stage_trial;

void farm_set_trial(farm *f, farm_trial *t)
{
  f->trial = t;
  t->start = clock_process();
}

double farm_trial_outside(const farm_trial *t)
{
  return clock_process() - t->start - t->spent;
}

int trial_over(const farm_trial *t)
{
  return clock_process() - t->start > t->most;
}

/* Number k of the tasks in an order of which every beginning is spread evenly: k's bits mirrored at
   the point (van der Corput), which starts in the middle. */
static size_t spread(size_t k, size_t tasks)
{
  double place = 0.0, part = 0.5;
  for (k++; k > 0; k >>= 1, part *= 0.5)
    if (k & 1) place += part;
  return (size_t)(place * (double)tasks);
}

static size_t stored_bytes(const trial_record *r)
{
  const char *data = r->data;
  size_t n = r->size;
  while (n > 0 && data[n - 1] == 0) n--;
  return n + ENTRY;
}

/* How many of the elements that end a record differ from the one before. */
static size_t changes_in(const trial_record *r, size_t element)
{
  const char *data = r->data;
  size_t n = 0;
  for (size_t end = r->size; element > 0 && end >= 2 * element; end -= element)
    n += memcmp(data + end - element, data + end - 2 * element, element) != 0;
  return n;
}

static pendres_status try_task(stage_trial *s, size_t task)
{
  farm_record record = { 0 };
  pendres_context *ctx = farm_context(s->farm);
  if (ctx == NULL || farm_record_resize(&record, s->stage->record_size) == NULL)
    return PENDRES_OUT_OF_MEMORY;
  pendres_cost before, after;
  pendres_context_cost(ctx, &before);
  const double start = clock_process();
  const pendres_status status = s->stage->task(s->stage->arg, task, ctx, &record);
  const double seconds = clock_process() - start;
  pendres_context_cost(ctx, &after);
  s->farm->trial->spent += seconds;
  s->record[task] = (trial_record){ record.data, record.size };
  s->cut += status == PENDRES_INTERRUPTED;
  s->seconds += seconds;
  if (status != PENDRES_OK) return status;
  s->tried[task] = 1;
  s->count++;
  s->bytes += (double)stored_bytes(&s->record[task]);
  s->changes += (double)changes_in(&s->record[task], s->stage->element);
  s->cost.pendulum_periods += after.pendulum_periods - before.pendulum_periods;
  s->cost.settled_pendulums += after.settled_pendulums - before.settled_pendulums;
  return PENDRES_OK;
}

/* Extrapolate from the tasks that were tried to all of the stage. */
static void conclude(const stage_trial *s)
{
  farm_trial *t = s->farm->trial;
  const double tasks = (double)s->stage->tasks, all = tasks / fmax((double)s->count, 1.0);
  /* A task that was cut short takes at least the time that it has taken so far. */
  t->seconds += tasks / fmax((double)(s->count + s->cut), 1.0) * s->seconds;
  t->journal += all * s->bytes;
  t->changes += all * s->changes;
  t->cost.pendulum_periods += all * s->cost.pendulum_periods;
  t->cost.settled_pendulums += all * s->cost.settled_pendulums;
  t->what = s->count < s->stage->tasks ? s->stage->what : NULL;
  t->tasks = s->stage->tasks;
  t->tried = s->count;
  t->cut = s->cut > 0;
}

static pendres_status collect(const stage_trial *s, size_t task)
{
  const farm_record record = { .data = s->record[task].data, .size = s->record[task].size };
  if (s->stage->collect == NULL) return PENDRES_OK;
  return s->stage->collect(s->stage->arg, task, &record);
}

/* Tasks of a chain go on from what was collected of the one before. */
static pendres_status try_chain(stage_trial *s)
{
  pendres_status status = PENDRES_OK;
  for (size_t task = 0; task < s->stage->tasks && status == PENDRES_OK; task++) {
    if (s->count >= 2 && s->seconds > s->farm->trial->few) break;
    status = try_task(s, task);
    if (status == PENDRES_OK) status = collect(s, task);
  }
  return status;
}

static pendres_status try_some(stage_trial *s)
{
  const farm_trial *t = s->farm->trial;
  const size_t tasks = s->stage->tasks;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; s->count < tasks && status == PENDRES_OK; k++) {
    const size_t task = spread(k, tasks);
    if (s->tried[task]) continue;
    if (s->count >= t->least && s->seconds > t->few) break;
    status = try_task(s, task);
  }
  return status;
}

static pendres_status try_stage(stage_trial *s)
{
  const size_t tasks = s->stage->tasks;
  pendres_status status = s->stage->chained ? try_chain(s) : try_some(s);
  conclude(s);
  if (status != PENDRES_OK) return status;
  if (s->count < tasks) return PENDRES_INTERRUPTED;
  for (size_t i = 0; i < tasks && status == PENDRES_OK && !s->stage->chained; i++)
    status = collect(s, i);
  return status;
}

pendres_status trial_run(farm *f, const farm_stage *stage)
{
  const size_t tasks = stage->tasks;
  stage_trial s = { .farm = f, .stage = stage };
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  s.record = calloc(tasks, sizeof *s.record);
  s.tried = calloc(tasks, 1);
  f->trial->what = stage->what;
  f->trial->tasks = tasks;
  f->trial->tried = 0;
  if (s.record != NULL && s.tried != NULL)
    status = stage->timed ? PENDRES_INTERRUPTED : try_stage(&s);
  for (size_t i = 0; i < tasks && s.record != NULL; i++) free(s.record[i].data);
  free(s.record);
  free(s.tried);
  f->stages++;
  return status;
}
