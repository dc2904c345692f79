/* method_block_adaptive.c -- blocks on ARKODE, adaptive steps. */
#include "engine/flow.h"
#include "engine/method_block.h"

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

static pendres_status run(pendres_context *ctx, size_t n, pendres_strobe_lane *lanes,
                          pendres_strobe_visit *visit, void *arg)
{
  forget_adaptive_block(ctx);
  return pendres_method_block_run(ctx, PENDRES_FLOW_ADAPTIVE, n, lanes, visit, arg);
}

const pendres_method_functions pendres_method_block_adaptive = {.name = "block_adaptive",
                                                                .run = run};
