/* method_block_fixed.c -- blocks on ARKODE, fixed steps, reset every period: the default. */
#include "engine/method_block.h"

static pendres_status run(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                          pendres_strobe_visit *visit, void *arg)
{
  return pendres_method_block_run(ctx, PENDRES_FLOW_STATE, n, lanes, visit, arg);
}

const pendres_method_functions pendres_method_block_fixed = {
  .name = "block_fixed", .fixed_steps = 1, .run = run};
