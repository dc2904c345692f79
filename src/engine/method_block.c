/* method_block.c -- blocks on ARKODE, whose lanes are retired and refilled at the strobe. */
#include <stdlib.h>

#include "engine/context_internal.h"
#include "engine/flow.h"
#include "engine/coordinates.h"
#include "engine/method.h"
#include "engine/rank.h"

typedef struct block {
  pendres_context *ctx;
  pendres_flow *flow;
  const pendres_strobe_job *job;
  size_t *slot; /* the lane that is in a slot of the block */
  size_t filled;
  int carry; /* errors */
  int in_float; /* this class of steps, in single precision */
} block;

/* Put what runs as number i into a slot. */
static void put(block *b, size_t slot, size_t i)
{
  const size_t index = pendres_strobe_which(b->job, i);
  const pendres_strobe_lane *l = &b->job->lanes[index];
  b->slot[slot] = index;
  pendres_flow_set_lane(b->flow, slot, l->pendulum, l->y, l->w);
  if (b->carry) pendres_flow_set_error(b->flow, slot, &l->off, l->added);
}

/* Take the states over from the block after a period; returns whether the lane is done. */
static int look(block *b, size_t slot)
{
  pendres_strobe_lane *l = &b->job->lanes[b->slot[slot]];
  const pendres_rows rows = pendres_flow_rows(b->flow);
  l->y = pendres_rows_get(&rows, PENDRES_ROW_Y, slot);
  l->w = pendres_rows_get(&rows, PENDRES_ROW_W, slot);
  l->period++;
  pendres_coordinates_arrive(l->pendulum, &l->y, &l->w, &l->turns);
  pendres_flow_put_state(b->flow, slot, l->y, l->w);
  if (b->carry) {
    l->off = pendres_flow_get_error(b->flow, slot);
    const double off = l->off.yy + l->off.ww;
    /* An error that is NaN counts as infinite. */
    if (!(off <= l->worst)) l->worst = off;
  }
  return b->job->visit(b->job->arg, b->slot[slot], l);
}

/* Run all lanes of one class of steps, queue[0..n). */
static pendres_status run_class(block *b, const pendres_rank *queue, size_t n)
{
  size_t next = 0;
  const size_t capacity = pendres_flow_capacity(b->flow);
  pendres_status status = PENDRES_OK;
  pendres_flow_clear(b->flow);
  if (queue[0].steps > 0) status = pendres_flow_set_steps(b->flow, queue[0].steps);
  if (status != PENDRES_OK) return pendres_context_flow_failed(b->ctx, b->flow, status);
  b->in_float = queue[0].in_float;

  b->filled = n < capacity ? n : capacity;
  pendres_flow_resize(b->flow, b->filled);
  while (next < b->filled) {
    put(b, next, queue[next].index);
    next++;
  }
  while (b->filled > 0) {
    status = pendres_context_poll(b->ctx);
    if (status != PENDRES_OK) return status;
    status = b->in_float ? pendres_flow_period_float(b->flow) : pendres_flow_period(b->flow);
    if (status != PENDRES_OK) return pendres_context_flow_failed(b->ctx, b->flow, status);
    b->ctx->cost.pendulum_periods += (double)b->filled;

    for (size_t slot = 0; slot < b->filled;) {
      if (!look(b, slot)) {
        slot++;
      } else if (next < n) {
        put(b, slot++, queue[next++].index);
      } else {
        /* No lane waits for this slot: the last lane, which is still to be visited, takes it. */
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
 * Run lanes as pendres_method_functions says, in a block of states: with each lane's own steps if
 * they are fixed. Lanes with the same number of steps share blocks; a lane that is done is replaced
 * immediately. Errors are propagated if steps are fixed and the first lane has `added` > 0.
 */
static pendres_status run_block(pendres_context *ctx, pendres_flow *flow, int fixed,
                                const pendres_strobe_job *job)
{
  const size_t n = job->n;
  const pendres_strobe_lane *lanes = job->lanes;
  pendres_status status = PENDRES_OK;
  block b = {.ctx = ctx, .flow = flow, .job = job,
             .carry = fixed && lanes[pendres_strobe_which(job, 0)].added > 0.0};
  pendres_rank *queue = malloc(n * sizeof *queue);
  b.slot = malloc(pendres_flow_capacity(flow) * sizeof *b.slot);
  if (queue == NULL || b.slot == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu lanes", n);
    goto done;
  }
  for (size_t i = 0; i < n; i++) {
    const size_t index = pendres_strobe_which(job, i);
    queue[i] = (pendres_rank){.steps = fixed ? lanes[index].steps : 0,
                              .model = pendres_model_kind(lanes[index].pendulum),
                              .in_float = b.carry && lanes[index].in_float,
                              .index = i};
  }
  pendres_rank_order(n, queue);

  if (b.carry) status = pendres_flow_carry(b.flow, PENDRES_FLOW_ERRORS);
  if (status != PENDRES_OK)
    (void)pendres_context_fail(ctx, status, "out of memory for the errors of %zu lanes", n);
  for (size_t first = 0; first < n && status == PENDRES_OK;) {
    size_t last = first;
    while (last < n && pendres_rank_equal(&queue[last], &queue[first])) last++;
    status = run_class(&b, queue + first, last - first);
    first = last;
  }
  if (b.carry) (void)pendres_flow_carry(b.flow, PENDRES_FLOW_NOTHING);
done:
  free(queue);
  free(b.slot);
  return status;
}

/* ---- block_fixed: fixed steps, reset every period; the default ------------------------------ */

static pendres_status run_fixed(pendres_context *ctx, const pendres_strobe_job *job)
{
  pendres_flow *flow = NULL;
  const pendres_status status = pendres_context_flow(ctx, PENDRES_FLOW_STATE, &flow);
  return status == PENDRES_OK ? run_block(ctx, flow, 1, job) : status;
}

const pendres_method_functions pendres_method_block_fixed = {.fixed_steps = 1, .run = run_fixed};

/* ---- block_adaptive ------------------------------------------------------------------------- */

/* Adaptive steps go on from the step before: in a block that is made again for each run, nothing
   depends on what the context did before. */
static pendres_status run_adaptive(pendres_context *ctx, const pendres_strobe_job *job)
{
  pendres_flow *flow = NULL;
  double longest = 0.0;
  pendres_status status = pendres_context_flow_adaptive(ctx, job->tolerance, &flow);
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < job->n; i++) {
    const double own = job->lanes[pendres_strobe_which(job, i)].longest;
    if (longest == 0.0 || (own > 0.0 && own < longest)) longest = own;
  }
  status = pendres_flow_set_longest_step(flow, longest);
  if (status == PENDRES_OK) status = run_block(ctx, flow, 0, job);
  ctx->cost.rhs_evaluations += pendres_flow_evaluations(flow);
  ctx->cost.steps += pendres_flow_steps(flow);
  for (size_t i = 0; i < job->n; i++)
    job->lanes[pendres_strobe_which(job, i)].taken += pendres_flow_steps(flow) / (double)job->n;
  pendres_flow_free(flow);
  return status;
}

const pendres_method_functions pendres_method_block_adaptive = {.run = run_adaptive};
