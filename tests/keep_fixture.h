/*
 * keep_fixture.h -- what a computation keeps, and when it is killed: at so many states that it has
 * put. The next one, on a context that knows nothing of the others, goes on from the last.
 */
#ifndef KEEP_FIXTURE_H
#define KEEP_FIXTURE_H

#include "context_fixture.h"

#include <stdlib.h>
#include <string.h>

typedef struct keeper {
  unsigned char *state;  /* to be freed by free() */
  unsigned char *before; /* the one that is read meanwhile */
  size_t size;
  int puts, most;
} keeper;

static inline int keeper_due(void *arg, double done)
{
  (void)arg;
  assert_true(done > 0.0 && done < 1.0);
  return 1;
}

static inline void keeper_put(void *arg, const void *state, size_t size)
{
  keeper *k = arg;
  k->state = realloc(k->state, size);
  assert_non_null(k->state);
  memcpy(k->state, state, size);
  k->size = size;
  k->puts++;
}

static inline int keeper_kills(void *arg)
{
  const keeper *k = arg;
  return k->puts >= k->most;
}

/* Before a computation and after it. */
static inline void keeper_begin(keeper *k, pendres_context *ctx)
{
  k->before = k->state;
  k->state = NULL;
  k->puts = 0;
  pendres_context_set_keep(ctx, &(pendres_keep){keeper_due, keeper_put, k->before, k->size, k});
  pendres_context_set_interrupt(ctx, keeper_kills, k);
}

static inline void keeper_end(keeper *k)
{
  if (k->state == NULL) k->state = k->before;
  else free(k->before);
  k->before = NULL;
}

#endif
