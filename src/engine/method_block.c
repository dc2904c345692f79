/* method_block.c -- blocks on ARKODE, whose lanes are retired and refilled at the strobe. */
#include "engine/block.h"
#include "engine/kernels/coordinates.h"
#include "engine/method.h"
#include "engine/kernels/rank.h"
#include "engine/room.h"

typedef struct filling {
  pendres_block *block;
  const pendres_strobe_job *job;
  size_t *slot; /* the lane that is in a slot of the block */
  size_t filled;
  const pendres_rank *next, *end; /* the lanes that wait, */
  size_t taken;                   /* and how many of the first rank do not any more */
  int fixed; /* steps */
  int carry; /* errors, in this class */
  pendres_flow_way way; /* of this class */
} filling;

/* Put the next lane that waits into a slot. */
static void put(filling *f, size_t slot)
{
  const size_t index = pendres_strobe_which(f->job, f->next->index + f->taken);
  pendres_strobe_lane *l = &f->job->lanes[index];
  if (++f->taken == f->next->count) {
    f->next++;
    f->taken = 0;
  }
  f->slot[slot] = index;
  pendres_block_load(f->block, slot, l->pendulum, l->y, l->w);
  if (f->carry)
    pendres_block_set_error(f->block, slot, &l->off, l->added);
}

/* Take the states over from the block after a period; returns whether the lane is done. */
static int look(filling *f, size_t slot)
{
  pendres_strobe_lane *l = &f->job->lanes[f->slot[slot]];
  const pendres_rows rows = pendres_block_rows(f->block);
  l->y = pendres_rows_get(&rows, PENDRES_ROW_Y, slot);
  l->w = pendres_rows_get(&rows, PENDRES_ROW_W, slot);
  l->period++;
  pendres_coordinates_arrive(l->pendulum, &l->y, &l->w, &l->turns);
  pendres_block_put_state(f->block, slot, l->y, l->w);
  if (f->carry) {
    l->off = pendres_block_get_error(f->block, slot);
    const double off = l->off.yy + l->off.ww;
    /* An error that is NaN counts as infinite. */
    if (!(off <= l->worst)) l->worst = off;
  }
  return f->job->visit(f->job->arg, f->slot[slot], l);
}

/* Run all lanes of one class of steps, first..end. */
static pendres_status run_class(filling *f, const pendres_rank *first, const pendres_rank *end)
{
  size_t n = 0;
  const size_t capacity = pendres_block_capacity(f->block);
  for (const pendres_rank *r = first; r < end; r++) n += r->count;
  f->next = first;
  f->end = end;
  f->taken = 0;
  f->way = first->way;
  f->filled = n < capacity ? n : capacity;
  f->carry = first->carries;
  pendres_block_clear(f->block);
  pendres_status status =
    pendres_block_carry(f->block, f->carry ? PENDRES_FLOW_ERRORS : PENDRES_FLOW_NOTHING);
  if (status == PENDRES_OK && first->steps > 0)
    status = pendres_block_set_steps(f->block, first->steps);
  if (status != PENDRES_OK) return status;

  pendres_block_resize(f->block, f->filled);
  for (size_t slot = 0; slot < f->filled; slot++) put(f, slot);
  while (f->filled > 0) {
    status = pendres_block_period_by(f->block, f->way);
    if (status != PENDRES_OK) return status;
    for (size_t slot = 0; slot < f->filled;) {
      if (!look(f, slot)) {
        slot++;
      } else if (f->next < f->end) {
        put(f, slot++);
      } else {
        /* No lane waits for this slot: the last lane, which is still to be visited, takes it. */
        f->filled--;
        if (slot < f->filled) {
          f->slot[slot] = f->slot[f->filled];
          pendres_block_move_lane(f->block, f->filled, slot);
        }
      }
    }
    if (f->filled > 0) pendres_block_resize(f->block, f->filled);
  }
  return PENDRES_OK;
}

/* Gather the lanes of a job that may share a block and lie one after another; returns how many
   such ranks there are. ranks: NULL, to count them. */
static size_t gather(const pendres_strobe_job *job, int fixed, pendres_rank *ranks)
{
  size_t count = 0;
  const pendres_strobe_lane *before = NULL;
  pendres_rank last = {.count = 0};
  for (size_t i = 0; i < job->n; i++) {
    const pendres_strobe_lane *l = &job->lanes[pendres_strobe_which(job, i)];
    const int steps = fixed ? l->steps : 0;
    const pendres_flow_way way = fixed ? l->way : PENDRES_FLOW_TABLE;
    const int carries = fixed && l->added > 0.0;
    if (before != NULL && l->pendulum == before->pendulum && steps == last.steps &&
        way == last.way && carries == last.carries) {
      last.count++;
    } else {
      last = (pendres_rank){.steps = steps, .model = pendres_model_kind(l->pendulum),
                            .way = way, .carries = carries, .index = i, .count = 1};
      count++;
    }
    before = l;
    if (ranks != NULL) ranks[count - 1] = last;
  }
  return count;
}

/*
 * Run lanes as pendres_method_functions says, in a block of states: with each lane's own steps if
 * they are fixed. Lanes with the same number of steps share blocks; a lane that is done is replaced
 * immediately. With fixed steps errors are propagated where lanes have `added` > 0.
 */
static pendres_status run_block(pendres_context *ctx, pendres_block *block, int fixed,
                                const pendres_strobe_job *job)
{
  pendres_room room = pendres_room_open(ctx, "lanes");
  filling f = {.block = block, .job = job, .fixed = fixed};
  const size_t n = gather(job, fixed, NULL);
  pendres_rank *ranks = pendres_room_take(&room, n, sizeof *ranks);
  f.slot = pendres_room_take(&room, pendres_block_capacity(block), sizeof *f.slot);
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  (void)gather(job, fixed, ranks);
  pendres_rank_order(n, ranks);
  pendres_status status = PENDRES_OK;
  for (size_t first = 0; first < n && status == PENDRES_OK;) {
    size_t last = first;
    while (last < n && pendres_rank_equal(&ranks[last], &ranks[first])) last++;
    status = run_class(&f, ranks + first, ranks + last);
    first = last;
  }
  (void)pendres_block_carry(f.block, PENDRES_FLOW_NOTHING);
  return pendres_room_close(&room, status);
}

/* ---- block_fixed: fixed steps, reset every period; the default ------------------------------ */

static pendres_status run_fixed(pendres_context *ctx, const pendres_strobe_job *job)
{
  pendres_block *block = NULL;
  const pendres_status status = pendres_block_of(ctx, PENDRES_FLOW_STATE, &block);
  return status == PENDRES_OK ? run_block(ctx, block, 1, job) : status;
}

const pendres_method_functions pendres_method_block_fixed = {.fixed_steps = 1, .run = run_fixed};

/* ---- block_adaptive ------------------------------------------------------------------------- */

/* Adaptive steps go on from the step before: in a block that is made again for each run, nothing
   depends on what the context did before. */
static pendres_status run_adaptive(pendres_context *ctx, const pendres_strobe_job *job)
{
  pendres_block *block = NULL;
  double longest = 0.0;
  pendres_status status = pendres_block_create(ctx, PENDRES_ROWS_STATE, job->tolerance, &block);
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < job->n; i++) {
    const double own = job->lanes[pendres_strobe_which(job, i)].longest;
    if (longest == 0.0 || (own > 0.0 && own < longest)) longest = own;
  }
  status = pendres_block_set_longest_step(block, longest);
  if (status == PENDRES_OK) status = run_block(ctx, block, 0, job);
  ctx->cost.rhs_evaluations += pendres_block_evaluations(block);
  ctx->cost.steps += pendres_block_steps(block);
  for (size_t i = 0; i < job->n; i++)
    job->lanes[pendres_strobe_which(job, i)].taken += pendres_block_steps(block) / (double)job->n;
  pendres_block_free(block);
  return status;
}

const pendres_method_functions pendres_method_block_adaptive = {.run = run_adaptive};
