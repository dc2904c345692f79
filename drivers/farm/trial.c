/* trial.c -- a few tasks of each stage; see trial.h. */
#include "farm/trial.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "farm/worker.h"
#include "system/clock.h"

/* Of a task's record in the journal, beside its data. */
enum { ENTRY = sizeof(journal_entry) };

/* What tasks that came to their end have taken. */
typedef struct tally {
  double bytes, changes;
  pendres_cost cost;
} tally;

/* The tasks of a stage that are tried: those that the pool has done. Time is that of all threads:
   there are no others then. */
typedef struct stage_trial {
  pool pool;
  size_t count, cut;    /* that came to their end, and that the end of the trial cut short */
  size_t paths, known;  /* paths that came to their end, and those of which a share was done, too */
  double path_seconds;  /* of these, all of each */
  double seconds;       /* of both kinds, without paths */
  tally of_paths, of_others;
} stage_trial;

void farm_set_trial(farm *f, farm_trial *t)
{
  f->trial = t;
  if (t == NULL) return;
  t->start = clock_process();
  t->until = t->most;
}

double farm_trial_outside(const farm_trial *t)
{
  return clock_process() - t->start - t->spent;
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

static size_t stored_bytes(const farm_record *r)
{
  const char *data = r->data;
  size_t n = r->size;
  while (n > 0 && data[n - 1] == 0) n--;
  return n + ENTRY;
}

/* How many of the elements that end a record differ from the one before. */
static size_t changes_in(const farm_record *r, size_t element)
{
  const char *data = r->data;
  size_t n = 0;
  for (size_t end = r->size; element > 0 && end >= 2 * element; end -= element)
    n += memcmp(data + end - element, data + end - 2 * element, element) != 0;
  return n;
}

static pendres_status try_task(stage_trial *s, size_t task)
{
  pool *c = &s->pool;
  farm_record record = { 0 };
  const double start = clock_process();
  farm_trial *t = c->farm->trial;
  t->share = 0.0;
  const pendres_status status = worker_try(c, task, &record);
  const double seconds = clock_process() - start;
  const int path = task < c->stage->paths, known = path && t->share > 0.0;
  t->spent += seconds;
  t->periods += record.cost.pendulum_periods;
  if (status == PENDRES_OK) t->share = 1.0;
  if (known || (path && status == PENDRES_OK)) {
    s->known++;
    s->path_seconds += seconds / t->share;
    t->path += t->share / (double)c->stage->paths;
  } else {
    s->cut += status == PENDRES_INTERRUPTED;
    s->seconds += seconds;
  }
  if (status == PENDRES_OK) {
    s->paths += (size_t)path;
    s->count += (size_t)!path;
    tally *of = path ? &s->of_paths : &s->of_others;
    const double bytes = (double)stored_bytes(&record);
    of->bytes += bytes + (path ? farm_states(seconds, bytes) : 0.0);
    of->changes += (double)changes_in(&record, c->stage->element);
    of->cost.pendulum_periods += record.cost.pendulum_periods;
    of->cost.settled_pendulums += record.cost.settled_pendulums;
    pool_finish(c, task, status, &record);
  }
  free(record.data);
  return status != PENDRES_OK ? status : c->status;
}

static void add(farm_trial *t, double times, const tally *of)
{
  t->journal += times * of->bytes;
  t->changes += times * of->changes;
  t->cost.pendulum_periods += times * of->cost.pendulum_periods;
  t->cost.settled_pendulums += times * of->cost.settled_pendulums;
}

/* Extrapolate from the tasks that were tried to all of the stage. */
static void conclude(const stage_trial *s)
{
  const farm_stage *stage = s->pool.stage;
  farm_trial *t = s->pool.farm->trial;
  const double tasks = (double)(stage->tasks - s->known);
  const double all = (double)(stage->tasks - stage->paths) / fmax((double)s->count, 1.0);
  /* A task that was cut short takes at least the time that it has taken so far. */
  t->seconds += s->path_seconds;
  t->seconds += tasks / fmax((double)(s->count + s->cut), 1.0) * s->seconds;
  add(t, 1.0, &s->of_paths);
  add(t, all, &s->of_others);
  t->what = s->paths + s->count < stage->tasks ? stage->what : NULL;
  t->tried = s->known + s->count;
  t->cut = s->cut > 0;
}

/* Paths get half of the time, and tell by their shares what they take; whoever cannot is cut. */
static pendres_status try_paths(stage_trial *s)
{
  farm_trial *t = s->pool.farm->trial;
  const size_t paths = s->pool.stage->paths;
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < paths; k++) {
    if (s->pool.done[k]) continue;
    t->until = clock_process() - t->start + 0.5 * t->most / (double)paths;
    status = try_task(s, k);
    if (status != PENDRES_OK && status != PENDRES_INTERRUPTED) return status;
  }
  t->until = t->most;
  return PENDRES_OK;
}

/* Tasks of a chain go on from what was collected of the one before. */
static pendres_status try_stage(stage_trial *s)
{
  const farm_trial *t = s->pool.farm->trial;
  const farm_stage *stage = s->pool.stage;
  const size_t least = stage->chained ? 2 : t->least, others = stage->tasks - stage->paths;
  pendres_status status = try_paths(s);
  for (size_t k = 0; s->count < others && status == PENDRES_OK; k++) {
    const size_t task = stage->paths + (stage->chained ? k : spread(k, others));
    if (s->pool.done[task]) continue;
    if (s->count >= least && s->seconds > t->few) break;
    status = try_task(s, task);
  }
  conclude(s);
  const int all = s->paths + s->count == stage->tasks;
  return status == PENDRES_OK && !all ? PENDRES_INTERRUPTED : status;
}

pendres_status trial_run(farm *f, const farm_stage *stage)
{
  stage_trial s = { .count = 0 };
  f->trial->what = stage->what;
  f->trial->tasks = stage->tasks;
  f->trial->tried = 0;
  pendres_status status = pool_create(&s.pool, f, stage, 1);
  if (status == PENDRES_OK) {
    status = stage->timed ? PENDRES_INTERRUPTED : try_stage(&s);
    pool_free(&s.pool);
  }
  f->stages++;
  return status;
}
