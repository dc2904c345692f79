/* method_block_fixed.c -- blocks on ARKODE, fixed steps, reset every period: the default. */
#include "engine/method_block.h"

static pendres_status run(pendres_context *ctx, const pendres_strobe_job *job)
{
  pendres_flow *flow = NULL;
  const pendres_status status = pendres_context_flow(ctx, PENDRES_FLOW_STATE, &flow);
  return status == PENDRES_OK ? pendres_method_block_run(ctx, flow, 1, job) : status;
}

const pendres_method_functions pendres_method_block_fixed = {
  .fixed_steps = 1, .run = run};
