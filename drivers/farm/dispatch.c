/* dispatch.c -- the distribution of tasks among the ranks of a run; see dispatch.h. */
#include "farm/dispatch.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "farm/numbers.h"
#include "farm/ranks.h"

/* Tags: to rank 0, requests apart since a thread waits for the answer; from rank 0 to all threads
   of a rank, and to thread number t of a rank. */
enum { QUESTION, TO_ROOT, TO_ALL, TO_THREAD };

typedef enum kind {
  ASK,    /* for a task */
  TELL,   /* the user: the words are the message */
  RESULT, /* of a task: its record follows, and the words of a failure */
  TASK,   /* to be computed */
  NONE,   /* there is none any more */
  SHARE,  /* a record that all ranks collect follows */
  HALT,   /* no more is wanted of the stage */
  END,    /* of the stage, with its status */
  QUIT    /* of the run */
} kind;

/* What stands before the data of every parcel. */
typedef struct note {
  int32_t kind, thread, status, unused;
  uint64_t run, stage, task, size, lost;
  pendres_cost cost;
  char message[512];
} note;

static note note_of(const pool *c, kind what)
{
  return (note){ .kind = (int32_t)what, .run = c->farm->run, .stage = c->number };
}

static int is_of(const pool *c, const note *n)
{
  return n->run == c->farm->run && n->stage == c->number;
}

/* Send a note and what follows it, in one parcel. Others wait for a note: without memory it is
   tried again. */
static int send_note(int to, int tag, const note *n, const void *data)
{
  const size_t size = data != NULL ? (size_t)n->size : 0;
  for (int idle = 0; idle < (size > 0 ? 1 : WAIT_PATIENCE); ranks_nap(&idle, WAIT_SELDOM)) {
    char *bytes = malloc(sizeof *n + size);
    if (bytes == NULL) continue;
    memcpy(bytes, n, sizeof *n);
    if (size > 0) memcpy(bytes + sizeof *n, data, size);
    if (ranks_send(to, tag, bytes, sizeof *n + size)) return 1;
  }
  return 0;
}

static void send_to_others(const note *n, const void *data)
{
  for (int r = 1; r < ranks_count(); r++) (void)send_note(r, TO_ALL, n, data);
}

/* ---- rank 0 -------------------------------------------------------------------------------- */

/* A record that came from another rank. */
static void take_result(pool *c, const note *n, const char *data)
{
  farm_record record = { .cost = n->cost, .lost = (size_t)n->lost };
  pendres_status status = (pendres_status)n->status;
  snprintf(record.message, sizeof record.message, "%s", n->message);
  if (status == PENDRES_OK && farm_record_resize(&record, (size_t)n->size) == NULL)
    status = PENDRES_OUT_OF_MEMORY;
  if (status == PENDRES_OK) memcpy(record.data, data, (size_t)n->size);
  farm_spend(c->farm, &n->cost);
  pool_finish(c, (size_t)n->task, status, &record);
  free(record.data);
}

/* Answer one parcel; returns the number of tasks that it adds to those computed elsewhere. */
static int answer(pool *c, const ranks_parcel *p)
{
  const note *n = p->data;
  const char *data = (const char *)p->data + sizeof *n;
  size_t task = 0;
  if (p->size < sizeof *n || p->size != sizeof *n + n->size) return 0;
  if (n->kind == RESULT) {
    if (!is_of(c, n)) return 0;
    take_result(c, n, data);
    return -1;
  }
  if (n->kind == TELL) {
    pool_tell(c, n->message);
    return 0;
  }
  note reply = { .kind = NONE, .run = n->run, .stage = n->stage };
  if (is_of(c, n) && pool_take(c, &task)) {
    reply.kind = TASK;
    reply.task = task;
  }
  if (send_note(p->from, TO_THREAD + n->thread, &reply, NULL)) return reply.kind == TASK;
  if (reply.kind == TASK) pool_finish(c, task, PENDRES_OUT_OF_MEMORY, &(farm_record){ 0 });
  return 0;
}

/* Until all tasks that were sent out have come back, and no thread of this rank works. */
static void *serve(void *arg)
{
  pool *c = arg;
  int under_way = 0, halted = 0, idle = 0;
  while (under_way > 0 || !atomic_load(&c->idle)) {
    ranks_parcel p;
    if (ranks_receive(QUESTION, &p) || ranks_receive(TO_ROOT, &p)) {
      under_way += answer(c, &p);
      free(p.data);
      idle = 0;
      continue;
    }
    const int failed = atomic_load(&c->limit) < c->stage->tasks;
    if (!halted && (failed || farm_stop(c->farm))) {
      const note n = note_of(c, HALT);
      send_to_others(&n, NULL);
      halted = 1;
    }
    ranks_nap(&idle, atomic_load(&c->idle) ? WAIT_OFTEN : WAIT_SELDOM);
  }
  return NULL;
}

/* A record that later stages read goes to all ranks. */
static void share(pool *c, size_t task, const farm_record *record)
{
  note n = note_of(c, SHARE);
  n.task = task;
  n.size = record->size;
  send_to_others(&n, record->data);
}

/* ---- the others ---------------------------------------------------------------------------- */

/* Collect what rank 0 has collected. */
static void collect_shared(pool *c, const note *n, char *data)
{
  const farm_record record = { .data = data, .size = (size_t)n->size };
  if (c->stage->collect == NULL || n->task != c->collected) return;
  const pendres_status status = c->stage->collect(c->stage->arg, (size_t)n->task, &record);
  if (status == PENDRES_OK) c->collected++;
}

/* Receive what rank 0 sends to all, until the end. */
static void *listen(void *arg)
{
  pool *c = arg;
  int idle = 0;
  for (int ended = 0; !ended;) {
    ranks_parcel p;
    if (!ranks_receive(TO_ALL, &p)) {
      ranks_nap(&idle, atomic_load(&c->idle) ? WAIT_OFTEN : WAIT_SELDOM);
      continue;
    }
    if (atomic_load(&c->idle)) idle = 0; /* records that are shared wait well */
    const note *n = p.data;
    if (n->run == c->farm->run && n->kind == QUIT) {
      c->status = PENDRES_INTERRUPTED;
      c->farm->dismissed = 1;
      ended = 1;
    } else if (is_of(c, n) && n->kind == SHARE) {
      collect_shared(c, n, (char *)p.data + sizeof *n);
    } else if (is_of(c, n) && n->kind == END) {
      c->status = (pendres_status)n->status;
      ended = 1;
    }
    if (ended || (is_of(c, n) && n->kind == HALT)) atomic_store(&c->halted, 1);
    free(p.data);
    atomic_store(&c->ended, ended);
  }
  return NULL;
}

/* Rank 0 answers every request until it ends the stage, and waits for the tasks that it has sent
   out: an answer is awaited even after a halt. Tasks that are run one at a time stay on rank 0. */
static int ask(pool *c, int thread, size_t *task)
{
  note n = note_of(c, ASK);
  int idle = 0;
  n.thread = thread;
  if (c->stage->timed || c->stage->chained || farm_stop(c->farm)) return 0;
  if (!send_note(0, QUESTION, &n, NULL)) return 0;
  while (!atomic_load(&c->ended)) {
    ranks_parcel p;
    if (!ranks_receive(TO_THREAD + thread, &p)) {
      ranks_nap(&idle, WAIT_OFTEN);
      continue;
    }
    memcpy(&n, p.data, sizeof n);
    free(p.data);
    if (!is_of(c, &n)) continue; /* to a request of an earlier stage */
    *task = (size_t)n.task;
    return n.kind == TASK;
  }
  return 0;
}

/* The record of a task; without it, as where it is too long to be sent, why. */
static void hand_in(pool *c, size_t task, pendres_status status, const farm_record *record)
{
  note n = note_of(c, RESULT);
  n.task = task;
  n.status = (int32_t)status;
  n.cost = record->cost;
  n.lost = record->lost;
  snprintf(n.message, sizeof n.message, "%s", record->message);
  n.size = status == PENDRES_OK ? record->size : 0;
  if (send_note(0, TO_ROOT, &n, record->data)) return;
  n.size = 0;
  n.status = (int32_t)PENDRES_OUT_OF_MEMORY;
  (void)send_note(0, TO_ROOT, &n, NULL);
}

pendres_status dispatch_outcome(pool *c)
{
  if (c->status == PENDRES_OK && !c->stage->last && c->collected == c->stage->tasks)
    return PENDRES_OK;
  c->farm->left = 1;
  return PENDRES_INTERRUPTED;
}

/* ---- all ------------------------------------------------------------------------------------ */

int dispatch_take(pool *c, int thread, size_t *task)
{
  return ranks_own() == 0 ? pool_take(c, task) : ask(c, thread, task);
}

void dispatch_finish(pool *c, size_t task, pendres_status status, farm_record *record)
{
  if (ranks_own() == 0) pool_finish(c, task, status, record);
  else hand_in(c, task, status, record);
}

void dispatch_tell(pool *c, const char *words)
{
  note n = note_of(c, TELL);
  if (ranks_own() == 0) {
    pool_tell(c, words);
    return;
  }
  snprintf(n.message, sizeof n.message, "%s", words);
  (void)send_note(0, TO_ROOT, &n, NULL);
}

pendres_status dispatch_begin(pool *c)
{
  if (ranks_count() == 1) return PENDRES_OK;
  if (ranks_own() == 0 && !c->stage->last) c->share = share;
  const int error =
    farm_start_thread(&c->server, ranks_own() == 0 ? serve : listen, c);
  return error == 0 ? PENDRES_OK : PENDRES_OUT_OF_MEMORY;
}

void dispatch_end(pool *c)
{
  if (ranks_count() == 1) return;
  atomic_store(&c->idle, 1);
  (void)pthread_join(c->server, NULL);
  if (ranks_own() != 0) return;
  note n = note_of(c, END);
  n.status = (int32_t)(c->status == PENDRES_OK && c->collected < c->stage->tasks
                       ? PENDRES_INTERRUPTED
                       : c->status);
  send_to_others(&n, NULL);
  ranks_flush();
}

/* Rank 0 is informed that another rank has ended, if it is in a stage. */
static void tell_of_failure(const farm *f, const char *words)
{
  note n = { .kind = TELL, .run = f->run };
  snprintf(n.message, sizeof n.message, "going on without rank %d: %.480s", ranks_own(), words);
  (void)send_note(0, TO_ROOT, &n, NULL);
}

void farm_dismiss(farm *f, const char *words)
{
  const note quit = { .kind = QUIT, .run = f->run };
  int idle = 0;
  if (ranks_count() == 1) return;
  if (ranks_own() == 0) {
    send_to_others(&quit, NULL);
    ranks_flush();
    return;
  }
  if (words != NULL && !f->dismissed) tell_of_failure(f, words);
  while (!f->dismissed) {
    ranks_parcel p;
    if (!ranks_receive(TO_ALL, &p)) {
      ranks_nap(&idle, WAIT_SELDOM);
      continue;
    }
    const note *n = p.data;
    f->dismissed = n->run == f->run && n->kind == QUIT;
    free(p.data);
    idle = 0;
  }
}
