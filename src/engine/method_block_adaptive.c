/* method_block_adaptive.c -- blocks on ARKODE, adaptive steps. */
#include "engine/flow.h"
#include "engine/method_block.h"

/* Adaptive steps go on from the step before: in a block that is made anew for each run, nothing
   depends on what the context did before. */
static pendres_status run(pendres_context *ctx, const pendres_strobe_job *job)
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
  if (status == PENDRES_OK) status = pendres_method_block_run(ctx, flow, 0, job);
  ctx->cost.rhs_evaluations += pendres_flow_evaluations(flow);
  ctx->cost.steps += pendres_flow_steps(flow);
  for (size_t i = 0; i < job->n; i++)
    job->lanes[pendres_strobe_which(job, i)].taken += pendres_flow_steps(flow) / (double)job->n;
  pendres_flow_free(flow);
  return status;
}

const pendres_method_functions pendres_method_block_adaptive = {
                                                                .run = run};
