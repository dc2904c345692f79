/* strobe_run.c -- lanes of a block, retired and refilled at the strobe; see strobe_run.h. */
#include "engine/strobe_run.h"

#include <math.h>
#include <stdlib.h>

#include "engine/context_internal.h"
#include "engine/flow.h"
#include "engine/flow_naive.h"
#include "engine/flow_single.h"
#include "engine/passage.h"

pendres_strobe_lane pendres_strobe_lane_at(const pendres_pendulum *p, double x, double v)
{
  const pendres_place s = pendres_passage_in(p, x, v);
  return (pendres_strobe_lane){.pendulum = p, .y = s.y, .w = s.w, .turns = s.turns};
}

void pendres_strobe_lane_out(const pendres_strobe_lane *l, double *x, double *v)
{
  const pendres_place s = {.y = l->y, .w = l->w, .turns = l->turns};
  pendres_passage_out(l->pendulum, &s, x, v);
}

double pendres_strobe_doubt(double distance)
{
  return distance < 0.1 ? 2.0 * distance : INFINITY;
}

pendres_status pendres_strobe_lost(pendres_context *ctx, const pendres_pendulum *p, long period)
{
  return pendres_context_fail(ctx, PENDRES_INTEGRATION_FAILED,
                              "damping %g, drive amplitude %g, drive frequency %g: within %ld "
                              "periods the state went beyond what double precision can say",
                              p->damping, p->drive_amplitude, p->drive_frequency, period);
}

static int by_steps(const void *a, const void *b)
{
  const pendres_strobe_rank *p = a, *q = b;
  if (p->steps != q->steps) return p->steps < q->steps ? -1 : 1;
  return p->index < q->index ? -1 : p->index > q->index;
}

void pendres_strobe_order(size_t n, pendres_strobe_rank *rank)
{
  size_t i = 1;
  while (i < n && rank[i - 1].steps <= rank[i].steps) i++;
  if (i < n) qsort(rank, n, sizeof *rank, by_steps);
}

typedef struct block {
  pendres_context *ctx;
  pendres_flow *flow;
  pendres_strobe_lane *lanes;
  size_t *slot; /* which lane sits in a slot of the block */
  size_t filled;
  int carry; /* errors */
  pendres_strobe_visit *visit;
  void *arg;
} block;

static void put(block *b, size_t slot, size_t index)
{
  const pendres_strobe_lane *l = &b->lanes[index];
  b->slot[slot] = index;
  pendres_flow_set_lane(b->flow, slot, l->pendulum, l->y, l->w);
  if (b->carry) pendres_flow_set_error(b->flow, slot, &l->off, l->added);
}

/* Take the states over from the block after a period; returns whether the lane is done. */
static int look(block *b, size_t slot)
{
  pendres_strobe_lane *l = &b->lanes[b->slot[slot]];
  const pendres_rows rows = pendres_flow_rows(b->flow);
  l->y = pendres_rows_get(&rows, PENDRES_ROW_Y, slot);
  l->w = pendres_rows_get(&rows, PENDRES_ROW_W, slot);
  l->period++;
  pendres_passage_arrive(l->pendulum, &l->y, &l->w, &l->turns);
  pendres_flow_put_state(b->flow, slot, l->y, l->w);
  if (b->carry) {
    l->off = pendres_flow_get_error(b->flow, slot);
    const double off = l->off.yy + l->off.ww;
    if (!(off <= l->worst)) l->worst = off; /* no number is no error to live with */
  }
  return b->visit(b->arg, b->slot[slot], l);
}

/* Run all lanes of one class of steps, queue[0..n). */
static pendres_status run_class(block *b, const pendres_strobe_rank *queue, size_t n)
{
  size_t next = 0;
  const size_t capacity = pendres_flow_capacity(b->flow);
  pendres_status status = PENDRES_OK;
  if (b->ctx->options.method == PENDRES_BLOCK_FIXED)
    status = pendres_flow_set_steps(b->flow, queue[0].steps);
  if (status != PENDRES_OK) return pendres_context_flow_failed(b->ctx, b->flow, status);

  b->filled = n < capacity ? n : capacity;
  pendres_flow_resize(b->flow, b->filled);
  while (next < b->filled) {
    put(b, next, queue[next].index);
    next++;
  }
  while (b->filled > 0) {
    status = pendres_context_poll(b->ctx);
    if (status != PENDRES_OK) return status;
    status = pendres_flow_period(b->flow);
    if (status != PENDRES_OK) return pendres_context_flow_failed(b->ctx, b->flow, status);
    b->ctx->cost.pendulum_periods += (double)b->filled;

    for (size_t slot = 0; slot < b->filled;) {
      if (!look(b, slot)) {
        slot++;
      } else if (next < n) {
        put(b, slot++, queue[next++].index);
      } else {
        /* Nobody waits: close the gap with the last lane, which is yet to be looked at. */
        b->filled--;
        if (slot < b->filled) {
          b->slot[slot] = b->slot[b->filled];
          pendres_flow_move_lane(b->flow, b->filled, slot);
        }
      }
    }
    if (b->filled > 0) pendres_flow_resize(b->flow, b->filled);
  }
  return PENDRES_OK;
}

/*
 * Adaptive steps go on from the step before, and their block has the tolerance that it was made
 * with. Made anew for each run, nothing depends on what the context did before.
 */
static void forget_adaptive_block(pendres_context *ctx)
{
  pendres_flow **flow = &ctx->flows[PENDRES_FLOW_ADAPTIVE];
  if (*flow == NULL) return;
  ctx->cost.rhs_evaluations += pendres_flow_evaluations(*flow);
  ctx->cost.steps += pendres_flow_steps(*flow);
  pendres_flow_free(*flow);
  *flow = NULL;
}

static pendres_status run_blocks(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                 pendres_strobe_visit *visit, void *arg)
{
  block b = {.ctx = ctx, .lanes = lanes, .visit = visit, .arg = arg};
  pendres_strobe_rank *queue = NULL;
  const int adaptive = ctx->options.method == PENDRES_BLOCK_ADAPTIVE;
  if (adaptive) forget_adaptive_block(ctx);
  pendres_status status =
    pendres_context_flow(ctx, adaptive ? PENDRES_FLOW_ADAPTIVE : PENDRES_FLOW_STATE, &b.flow);
  if (status != PENDRES_OK) return status;

  queue = malloc(n * sizeof *queue);
  b.slot = malloc(pendres_flow_capacity(b.flow) * sizeof *b.slot);
  if (queue == NULL || b.slot == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu lanes", n);
    goto done;
  }
  for (size_t i = 0; i < n; i++)
    queue[i] = (pendres_strobe_rank){.steps = adaptive ? 1 : lanes[i].steps, .index = i};
  pendres_strobe_order(n, queue);

  b.carry = !adaptive && lanes[0].added > 0.0;
  if (b.carry) status = pendres_flow_carry(b.flow, 1);
  if (status != PENDRES_OK)
    (void)pendres_context_fail(ctx, status, "out of memory for the errors of %zu lanes", n);
  for (size_t first = 0; first < n && status == PENDRES_OK;) {
    size_t last = first;
    while (last < n && queue[last].steps == queue[first].steps) last++;
    status = run_class(&b, queue + first, last - first);
    first = last;
  }
  if (b.carry) (void)pendres_flow_carry(b.flow, 0);
done:
  free(queue);
  free(b.slot);
  return status;
}

pendres_status pendres_strobe_run(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                                  pendres_strobe_visit *visit, void *arg)
{
  if (n == 0) return PENDRES_OK;
  if (ctx->options.method == PENDRES_BLOCK_FIXED || ctx->options.method == PENDRES_BLOCK_ADAPTIVE)
    return run_blocks(ctx, n, lanes, visit, arg);
  if (ctx->options.method == PENDRES_NAIVE)
    return pendres_flow_naive_run(ctx, n, lanes, visit, arg);
  return pendres_flow_single_run(ctx, n, lanes, visit, arg);
}
