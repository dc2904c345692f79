/* langevin_moving.c -- trajectories while parameters move; see langevin_internal.h. */
#include "noise/langevin_internal.h"

pendres_status pendres_langevin_moving_accept(pendres_context *ctx,
                                              const pendres_langevin_moving *run, double time)
{
  const pendres_pendulum p = run->motion(run->arg, time);
  return pendres_langevin_accept(ctx, &p, run->x, run->v, run->steps, 0);
}

static void load(pendres_langevin_block *b, size_t first, const pendres_langevin_moving *run)
{
  const pendres_pendulum p = run->motion(run->arg, 0.0);
  pendres_langevin_block_resize(b, run->n - first < b->capacity ? run->n - first : b->capacity);
  for (size_t i = 0; i < b->count; i++)
    pendres_langevin_block_load(b, i, &p, run->first_id + first + i, run->x, run->v);
  pendres_langevin_block_finish(b);
}

static pendres_status follow(pendres_context *ctx, pendres_langevin_block *b, size_t first,
                             const pendres_langevin_moving *run)
{
  for (long k = 0; k < run->periods; k++) {
    pendres_status status = pendres_context_poll(ctx);
    if (status == PENDRES_OK)
      status = pendres_langevin_block_moving(b, (uint32_t)k, run->motion, run->arg);
    if (status != PENDRES_OK) return status;
    pendres_langevin_count(ctx, b);
    if (pendres_langevin_show(ctx, b, first, k + 1, run->observer) == PENDRES_LANGEVIN_STOP)
      return pendres_context_fail(ctx, PENDRES_INTERRUPTED, "interrupted by the observer");
  }
  return run->may_leave ? PENDRES_OK : pendres_langevin_check_ends(ctx, b, first);
}

pendres_status pendres_langevin_move(pendres_context *ctx, const pendres_langevin_moving *run)
{
  pendres_langevin_block b = {0};
  pendres_status status = pendres_langevin_open(ctx, run->n, run->steps, &b);
  b.harmonics = run->observer->harmonics;
  for (size_t first = 0; first < run->n && status == PENDRES_OK; first += b.count) {
    load(&b, first, run);
    status = follow(ctx, &b, first, run);
  }
  pendres_langevin_block_clear(&b);
  return status;
}
