/* state.c -- states of a task that is not finished yet; see internal.h. */
#include "farm/internal.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "farm/trial.h"
#include "system/clock.h"

static int due(void *arg, double done)
{
  const task_state *s = arg;
  farm_trial *trial = s->farm->trial;
  if (trial != NULL) trial->share = done;
  return trial == NULL && s->journal != NULL && clock_wall() >= s->next;
}

/* States grow as the work does, first every half second, then by a tenth from one to the next; the
   journal leaves out what there is of them beside twice the last one, and a little. */
double farm_states(double seconds, double bytes)
{
  const double even = state_every / state_share; /* seconds */
  const double times = seconds < even ? 0.5 * seconds / state_every
                                      : 1.0 / state_share * (1.0 - 0.5 * even / seconds);
  return fmin(times * bytes, 2.0 * bytes + JOURNAL_DEAD);
}

void farm_tell_unkept(farm *f, pthread_mutex_t *lock, const char *words)
{
  pthread_mutex_lock(lock);
  progress_error(f->options.progress, "%s; what is computed from now on is not kept if the run is "
                 "stopped", words);
  pthread_mutex_unlock(lock);
}

/* The longer a task takes the less often, and never so often that writing takes long. */
static void put(void *arg, const void *state, size_t size)
{
  task_state *s = arg;
  char words[JOURNAL_WORDS];
  const double before = clock_wall();
  const farm_record kept = { .data = (void *)(uintptr_t)state, .size = size };
  (void)journal_append(s->journal, s->stage, s->task | JOURNAL_STATE, &kept, words);
  if (words[0] != '\0') farm_tell_unkept(s->farm, s->lock, words);
  const double now = clock_wall();
  s->next = now + fmax(fmax(state_every, state_share * (now - s->begun)),
                       (now - before) / state_share);
}

void state_begin(task_state *s, pendres_context *ctx)
{
  s->begun = clock_wall();
  s->next = s->begun + state_every;
  s->last = (farm_record){ 0 };
  if (s->journal != NULL)
    (void)journal_read(s->journal, s->stage, s->task | JOURNAL_STATE, &s->last); /* or anew */
  pendres_context_set_keep(ctx, &(pendres_keep){ due, put, s->last.data, s->last.size, s });
}

void state_end(task_state *s, pendres_context *ctx)
{
  pendres_context_set_keep(ctx, NULL);
  free(s->last.data);
}

void farm_keep_begin(farm *f, pendres_context *ctx, const char *what)
{
  f->outside = (task_state){ .farm = f, .lock = &f->lock,
                             .journal = f->trial == NULL ? f->journal : NULL,
                             .stage = journal_stage(f->stages, what, 1, 0) };
  state_begin(&f->outside, ctx);
}

void farm_keep_end(farm *f, pendres_context *ctx)
{
  state_end(&f->outside, ctx);
}
