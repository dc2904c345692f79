/* block_alone.c -- periods without ARKODE; see block_internal.h. */
#include "engine/block.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "base/grow.h"
#include "base/instructions.h"
#include "engine/block_internal.h"

int pendres_block_nystrom_prepare(pendres_nystrom_steps *s, int steps)
{
  enum { STAGES = PENDRES_NYSTROM_STAGES };
  if (s->steps == steps) return 0;
  s->steps = 0;
  if (!pendres_regrow(&s->cosine, (size_t)steps * STAGES, sizeof *s->cosine)) return -1;
  for (int k = 0; k < STAGES * steps; k++)
    s->cosine[k] = cos(two_pi * (k / STAGES + pendres_nystrom_node[k % STAGES] / 20.0) / steps);
  s->steps = steps;
  return 0;
}

int pendres_block_run_nystrom(pendres_block *b, int single)
{
  const pendres_lanes_shape *s = &b->shape;
  const int tangents = b->load == PENDRES_FLOW_TANGENTS;
  if (b->drive.steps < 1 || s->rows != PENDRES_ROWS_STATE ||
      (single && !pendres_nystrom_may_single(s->model)))
    return PENDRES_BLOCK_CANNOT;
  if (pendres_block_nystrom_prepare(&b->nystrom, b->drive.steps) != 0) return PENDRES_BLOCK_STARVED;
  const pendres_nystrom_lanes lanes = {.lanes = s->stride, .model = s->model, .y = b->rows,
                                       .w = b->rows + s->stride, .k = s->coefficients,
                                       .off = s->off,
                                       .tangent_y = tangents ? s->tangent.y[0] : NULL,
                                       .tangent_w = tangents ? s->tangent.w[0] : NULL};
  const pendres_kernels_nystrom *kernels = PENDRES_INSTRUCTIONS_BEST(pendres_kernels_nystrom);
  (single ? kernels->run_single : kernels->run)(&b->nystrom, &lanes);
  if (tangents) {
    memcpy(s->tangent.y[1], s->tangent.y[0], s->stride * sizeof(double));
    memcpy(s->tangent.w[1], s->tangent.w[0], s->stride * sizeof(double));
  }
  return b->drive.steps * PENDRES_NYSTROM_STAGES;
}

void pendres_block_alone_free(pendres_block *b)
{
  free(b->nystrom.cosine);
}
