/* state.c -- states of a task that is not finished yet; see pool_internal.h. */
#include "farm/pool_internal.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "farm/trial.h"
#include "system/clock.h"

static int due(void *arg, double done)
{
  const task_state *s = arg;
  struct farm_trial *t = s->pool->farm->trial;
  if (t != NULL) t->share = done;
  return t == NULL && s->pool->journal != NULL && clock_wall() >= s->next;
}

/* The longer a task takes the less often, and never so often that writing takes long. */
static void put(void *arg, const void *state, size_t size)
{
  task_state *s = arg;
  char words[JOURNAL_WORDS]; /* the finished task's record will say why none can be written */
  const double before = clock_wall();
  const farm_record kept = { .data = (void *)(uintptr_t)state, .size = size };
  (void)journal_append(s->pool->journal, s->pool->number, s->task | JOURNAL_STATE, &kept, words);
  const double now = clock_wall();
  s->next = now + fmax(fmax(state_every, state_share * (now - s->begun)),
                       (now - before) / state_share);
}

void state_begin(task_state *s, pool *c, size_t task, pendres_context *ctx)
{
  const double now = clock_wall();
  *s = (task_state){ .pool = c, .task = task, .begun = now, .next = now + state_every };
  if (c->journal != NULL)
    (void)journal_read(c->journal, c->number, task | JOURNAL_STATE, &s->last); /* or anew */
  pendres_context_set_keep(ctx, &(pendres_keep){ due, put, s->last.data, s->last.size, s });
}

void state_end(task_state *s, pendres_context *ctx)
{
  pendres_context_set_keep(ctx, NULL);
  free(s->last.data);
}
