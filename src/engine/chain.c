/* chain.c -- the chain rule over drive periods; see chain.h. */
#include "engine/chain.h"

#include <stdlib.h>
#include <string.h>

#include "engine/context_internal.h"
#include "engine/numbers.h"
#include "engine/threads.h"

/* Some of the periods, whose starts are noted. */
typedef struct part {
  pendres_context *ctx;
  const pendres_chain *of;
  double *y, *w; /* [period][n] */
} part;

/* Note the starts of some periods, and leave the states at their end in the first two rows. */
static pendres_status run_states(const part *p, int periods)
{
  const pendres_chain *c = p->of;
  const size_t n = c->n;
  double *y = c->rows, *w = y + n;
  pendres_block *b;
  pendres_status status = pendres_block_open(p->ctx, PENDRES_FLOW_STATE, c->steps, &b);
  if (status != PENDRES_OK) return status;
  pendres_block_resize(b, n);
  for (size_t i = 0; i < n; i++) pendres_block_load(b, i, &c->from[i].pendulum, y[i], w[i]);
  for (int k = 0; k < periods && status == PENDRES_OK; k++) {
    memcpy(p->y + (size_t)k * n, y, n * sizeof *y);
    memcpy(p->w + (size_t)k * n, w, n * sizeof *w);
    status = pendres_block_period(b);
    const pendres_rows rows = pendres_block_rows(b);
    for (size_t i = 0; i < n; i++) {
      y[i] = pendres_rows_get(&rows, PENDRES_ROW_Y, i);
      w[i] = pendres_rows_get(&rows, PENDRES_ROW_W, i);
    }
  }
  return status;
}

/* Multiply the derivatives of pendulum i by those of one more period, of this lane of a block. */
static void multiply(const pendres_chain *c, const pendres_rows *rows, size_t lane, size_t i)
{
  const size_t count = pendres_flow_kind_rows(c->kind);
  double m[2][2];
  pendres_rows_tangent(rows, lane, m);
  for (size_t row = PENDRES_ROWS_STATE; row < count; row += 2) {
    double *y = c->rows + row * c->n + i, *w = y + c->n, own[2] = {0.0, 0.0};
    const double before[2] = {*y, *w};
    if (row >= PENDRES_ROW_BY_PARAMETERS) pendres_rows_pair(rows, (int)row, lane, own);
    *y = m[0][0] * before[0] + m[0][1] * before[1] + own[0];
    *w = m[1][0] * before[0] + m[1][1] * before[1] + own[1];
  }
}

static pendres_status run_derivatives(const part *p, int periods)
{
  const pendres_chain *c = p->of;
  const size_t n = c->n, lanes = (size_t)periods * n;
  pendres_block *b;
  pendres_status status = pendres_block_open(p->ctx, c->kind, c->steps, &b);
  if (status != PENDRES_OK) return status;
  pendres_block_resize(b, lanes);
  for (size_t k = 0; k < lanes; k++)
    pendres_block_load(b, k, &c->from[k % n].pendulum, p->y[k], p->w[k]);
  status = pendres_block_period(b);
  const pendres_rows rows = pendres_block_rows(b);
  for (size_t k = 0; k < lanes && status == PENDRES_OK; k++) multiply(c, &rows, k, k % n);
  return status;
}

/* Before the first period. */
static void begin(const pendres_chain *c)
{
  const size_t n = c->n;
  memset(c->rows, 0, pendres_flow_kind_rows(c->kind) * n * sizeof *c->rows);
  for (size_t i = 0; i < n; i++) {
    c->rows[i] = c->from[i].y;
    c->rows[n + i] = c->from[i].w;
    c->rows[PENDRES_ROW_BY_Y * n + i] = c->rows[(PENDRES_ROW_BY_W + 1) * n + i] = 1.0;
  }
}

/* All periods of a chain's pendulums. */
static pendres_status run_all(pendres_context *ctx, const pendres_chain *c)
{
  pendres_block *b;
  pendres_status status = pendres_block_open(ctx, c->kind, c->steps, &b);
  if (status != PENDRES_OK || c->n == 0) return status;
  const size_t most = pendres_block_capacity(b) / c->n;
  const int some = most < (size_t)c->periods ? (int)most : c->periods;
  const size_t starts = (size_t)some * c->n;
  double *y = malloc(2 * starts * sizeof *y);
  if (y == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %d periods", some);
  const part p = {.ctx = ctx, .of = c, .y = y, .w = y + starts};
  begin(c);
  for (int done = 0; done < c->periods && status == PENDRES_OK; done += some) {
    const int next = c->periods - done < some ? c->periods - done : some;
    status = run_states(&p, next);
    if (status == PENDRES_OK) status = run_derivatives(&p, next);
  }
  free(y);
  return status;
}

/* The same for some of them. */
static pendres_status run_some(pendres_context *ctx, size_t first, size_t count, void *arg)
{
  const pendres_chain *whole = arg;
  const size_t rows = pendres_flow_kind_rows(whole->kind);
  pendres_chain some = *whole;
  some.n = count;
  some.from = whole->from + first;
  some.rows = malloc(rows * count * sizeof *some.rows);
  if (some.rows == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu orbits", count);
  const pendres_status status = run_all(ctx, &some);
  for (size_t row = 0; row < rows && status == PENDRES_OK; row++)
    memcpy(whole->rows + row * whole->n + first, some.rows + row * count,
           count * sizeof *some.rows);
  free(some.rows);
  return status;
}

pendres_status pendres_chain_run(pendres_context *ctx, const pendres_chain *c)
{
  const size_t threads = (size_t)ctx->options.threads;
  const double work = (double)c->n * c->periods * c->steps;
  if (threads == 1 || c->n < 2 || work < chain_worth_threads) return run_all(ctx, c);
  return pendres_threads_run(ctx, c->n, (c->n + threads - 1) / threads, run_some, (void *)c);
}
