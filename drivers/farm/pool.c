/* pool.c -- which tasks of a stage are done, and their records; see pool_internal.h. */
#include "farm/pool_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/clock.h"

/* Whether a task's record is there: in memory; in the journal alone, from this run or from an
   earlier one; or another shard's to compute. */
enum { NOT_DONE, DONE, KEPT, JOURNALED, OTHERS };

enum { FOREIGN = 500 /* room for what is said of a record that is refused */ };

long long pool_milliseconds(void)
{
  return (long long)(1e3 * clock_wall());
}

void pool_tell(pool *c, const char *words)
{
  pthread_mutex_lock(&c->lock);
  progress_note(c->farm->options.progress, "%s", words);
  pthread_mutex_unlock(&c->lock);
}

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
  if (status == PENDRES_OK && c->share != NULL) c->share(c, c->collected, &record);
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

void pool_collect(pool *c)
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
  pool_collect(c);
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
