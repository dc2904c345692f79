/* keep.c -- states of long computations; see keep.h. */
#include "engine/keep.h"

#include <stdlib.h>
#include <string.h>

/* Before the question. */
typedef struct head {
  char name[16];
  double tolerance, exponent_error; /* the options that results depend on */
  int64_t method, table, steps, periods;
  uint64_t seed;
  uint64_t question; /* its bytes */
  pendres_cost cost; /* so far */
} head;

pendres_keeping pendres_keeping_begin(pendres_context *ctx, const char *name,
                                      pendres_bytes question)
{
  pendres_keeping k = {.ctx = ctx, .to = ctx->keep};
  head h;
  ctx->keep = (pendres_keep){.due = NULL};
  if (k.to.due == NULL || question.status != PENDRES_OK) {
    k.question.status = question.status;
    free(question.bytes);
    return k;
  }
  pendres_context_cost(ctx, &k.before);
  memset(&h, 0, sizeof h);
  strncpy(h.name, name, sizeof h.name - 1);
  const pendres_options *o = &ctx->options;
  h.tolerance = o->tolerance;
  h.exponent_error = o->exponent_error;
  h.method = o->method;
  h.table = o->table;
  h.steps = o->steps_per_period;
  h.periods = o->period_budget;
  h.seed = o->seed;
  h.question = question.size;
  pendres_bytes_pass(&k.question, 1, sizeof h, &h);
  pendres_bytes_pass(&k.question, 1, question.size, question.bytes);
  free(question.bytes);
  return k;
}

int pendres_keeping_found(pendres_keeping *k)
{
  head own, there;
  const size_t n = k->question.size, after = n - sizeof own;
  if (k->to.due == NULL || k->question.status != PENDRES_OK || k->to.state == NULL ||
      k->to.size < n)
    return 0;
  memcpy(&own, k->question.bytes, sizeof own);
  memcpy(&there, k->to.state, sizeof there);
  own.cost = there.cost;
  if (memcmp(&own, &there, sizeof own) != 0 ||
      memcmp(k->question.bytes + sizeof own, (const char *)k->to.state + sizeof own, after) != 0)
    return 0;
  k->state = pendres_bytes_read(k->to.size, k->to.state);
  k->state.at = n;
  return 1;
}

void pendres_keeping_taken(pendres_keeping *k)
{
  head h;
  memcpy(&h, k->to.state, sizeof h);
  pendres_cost_add(&k->ctx->cost, 1.0, &h.cost);
}

int pendres_keeping_due(pendres_keeping *k, double done)
{
  pendres_guard *g = &k->ctx->guard;
  if (k->to.due == NULL) return 0;
  pendres_guard_ask(g, 1);
  const int due = k->to.due(k->to.arg, done);
  pendres_guard_ask(g, 0);
  return due && k->question.status == PENDRES_OK;
}

pendres_bytes *pendres_keeping_write(pendres_keeping *k)
{
  head h;
  k->state = (pendres_bytes){.reads = 0};
  memcpy(&h, k->question.bytes, sizeof h);
  pendres_context_cost(k->ctx, &h.cost);
  pendres_cost_add(&h.cost, -1.0, &k->before);
  pendres_bytes_pass(&k->state, 1, sizeof h, &h);
  pendres_bytes_pass(&k->state, 1, k->question.size - sizeof h, k->question.bytes + sizeof h);
  return &k->state;
}

void pendres_keeping_put(pendres_keeping *k)
{
  pendres_guard *g = &k->ctx->guard;
  if (k->state.status == PENDRES_OK) {
    pendres_guard_ask(g, 1);
    k->to.put(k->to.arg, k->state.bytes, k->state.size);
    pendres_guard_ask(g, 0);
  }
  free(k->state.bytes);
  k->state = (pendres_bytes){.reads = 0};
}

void pendres_keeping_end(pendres_keeping *k)
{
  free(k->question.bytes);
  k->ctx->keep = k->to;
}
