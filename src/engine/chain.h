/*
 * chain.h -- derivatives over many drive periods, by the chain rule.
 *
 * Owns: blocks of derivatives over several periods whose lanes are the periods themselves. The
 * states go first, period after period, which is cheap; the derivatives of all periods then follow
 * side by side, from each period's start, and are multiplied. A single orbit of many periods so
 * fills a block, of which it would use one lane.
 */
#ifndef PENDRES_CHAIN_H
#define PENDRES_CHAIN_H

#include "engine/block.h"
#include "engine/kernels/kernels.h"
#include "engine/sundials/lanes_shape.h"

/* A pendulum at the start of its first period. */
typedef struct pendres_chain_start {
  pendres_pendulum pendulum;
  double y, w;
} pendres_chain_start;

/* n pendulums with kernels of one model, at most as many as the context's block of the kind holds,
   over some periods; rows[row n + lane] takes what comes of it. */
typedef struct pendres_chain {
  pendres_flow_kind kind;
  int steps, periods;
  size_t n;
  const pendres_chain_start *from;
  double *rows;
} pendres_chain;

/* What a lane gets does not depend on the others. */
pendres_status pendres_chain_run(pendres_context *ctx, const pendres_chain *c);

/* Whether periods are better chained, which is always the same for one number of periods: where
   those of a single orbit fill a vector of the kernels. */
static inline int pendres_chain_worth(int periods)
{
  return periods >= PENDRES_LANES_MULTIPLE;
}

#endif
